"""What every kind of part answers. A new kind derives from ``PartKind`` in a file of its own, and joins ``Part``."""

from abc import abstractmethod
from typing import ClassVar, Literal

from geometry.base.model import CaseModel
from geometry.parts.body import Body
from geometry.parts.kernel import Entity, Kernel
from geometry.parts.section import Section

Feature = Literal["slots", "arms", "rows of holes", "load points without a pin"]


class PartKind(CaseModel):
    """A kind of part: the sizes that a case states, as fields, and what follows from them.

    Its fields are ``shape`` (a literal, by which the case file names the kind), ``material`` and sizes. Fields or
    properties of its own are ``eye_diameter`` and ``eye_thickness`` (of the rings about its holes), and
    ``fillet_radius`` (between eyes and the rest; 0 where edges are sharp or there are none).
    """

    takes: ClassVar[frozenset[Feature]] = frozenset()
    """What a link of this kind may have besides pin holes."""
    is_beam: ClassVar[bool] = True
    """Whether beam theory holds between its eyes."""

    @property
    @abstractmethod
    def section(self) -> Section:
        """Cross-section between the eyes; of a part that is no beam, one through its middle."""

    @abstractmethod
    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """Build the part without its pin holes, slots and rows of holes.

        Parameters
        ----------
        kernel : Kernel
            The geometry kernel; sections are ten units across.
        body : Body
            The body, of which this is the part, in the kernel's unit.

        Returns
        -------
        Entity
            The solid.

        Raises
        ------
        FilletError
            Where a fillet does not fit.
        """

    @abstractmethod
    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """Return where elements must be smaller than elsewhere, pin holes and rows of holes apart.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.
        size : float
            Element edge elsewhere, in the unit of the body.
        share : float
            Element edge along a fillet over its radius.

        Returns
        -------
        list of tuple
            Element edge, and the distance from the place as a formula of the mesher in x, y and z.
        """

    def check(self, body: Body) -> None:
        """Refuse a body that this kind of part cannot be built for, by closed form.

        Parameters
        ----------
        body : Body
            The body, of which this is the part; what holds for all kinds has been checked.

        Raises
        ------
        CaseError
            With the entry, its value, the rule and a remedy.
        """

    def hand_section(self, body: Body) -> Section:
        """Return the section of which hand calculation takes the link to be made.

        Parameters
        ----------
        body : Body
            The body, of which this is the part.

        Returns
        -------
        Section
            The section between the eyes unless the kind knows better.
        """
        return self.section

    def largest_element(self) -> float:
        """Return the largest element edge that its round surfaces bear [unit of its sizes]."""
        return float("inf")
