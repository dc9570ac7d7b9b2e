"""What springs and tendons do: an effort that follows from a size, along which it acts.

With a size s(x) of the places x of its ends (a length, an angle), its gradient g, and the effort T(s) with which it
shortens or turns back,

    force -T g,    energy ∫ T ds,    tangent T'(s) g gᵀ + T d²s.

On the deformed shape of a frame, which λ times all loads bring about, the effort is λ T(s0) + T(s) - T(s0), where s0 is
the size as the frame stands, and T of a cord is none where it is negative.
"""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.linkage.placement import Placement
from alula.loads.acting.acting import Acting, ActingMark, End, MarkKind
from alula.loads.acting.sizes import Angle, Length, places
from alula.loads.records.applied import PointLoad
from alula.loads.records.attachment import Attachment

Real = NDArray[np.float64]

_COINCIDE = 1e-9
"""Length of a piece over the longest link below which its direction is not known."""


@dataclass(frozen=True, kw_only=True)
class Law:
    """How an effort rises with its size: a straight line. Others derive from it.

    Attributes
    ----------
    size, effort : float
        A size [mm, rad] and the effort there [N, N mm].
    stiffness : float
        By which it rises [N/mm, N mm/rad].
    pulls : bool
        True where it is never negative.
    """

    size: float = 0.0
    effort: float = 0.0
    stiffness: float = 0.0
    pulls: bool = False

    def wanted(self, size: Real | float) -> Real:
        """Return the effort, of a slack cord what it would be if it could push.

        Parameters
        ----------
        size : array (...)
            [mm, rad]

        Returns
        -------
        array (...)
            [N, N mm]
        """
        return np.asarray(self.effort + self.stiffness * (size - self.size))

    def slope(self, size: float) -> float:
        """Return the derivative of ``wanted``.

        Parameters
        ----------
        size : float
            [mm, rad]

        Returns
        -------
        float
            [N/mm, N mm/rad]
        """
        return self.stiffness

    def borne(self, size: Real) -> Real:
        """Return the effort.

        Parameters
        ----------
        size : array (...)
            [mm, rad]

        Returns
        -------
        array (...)
            [N, N mm]
        """
        return np.maximum(self.wanted(size), 0.0) if self.pulls else self.wanted(size)


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringState:
    """A spring or tendon at one pose or at n.

    Attributes
    ----------
    name : str
    kind : {"spring", "tendon"}
    size : array (...)
        Its length [mm], or the angle of its joint [rad].
    effort : array (...)
        Its pull [N], negative where it pushes; or its moment on the joint's second link [N mm].
    turns : bool
        True for a spring about a joint.
    joint : str
        That joint; "" for others.
    """

    name: str
    kind: str
    size: Real
    effort: Real
    turns: bool = False
    joint: str = ""


@dataclass(frozen=True, kw_only=True)
class Sprung(Acting):
    """A spring or tendon in a linkage.

    Attributes
    ----------
    name : str
    kind : {"spring", "tendon"}
    along : Length or Angle
    law : Law
    """

    lasting: ClassVar[bool] = True
    name: str
    kind: str = "spring"
    along: Length | Angle
    law: Law

    @property
    def ends(self) -> tuple[End, ...]:
        """On what it acts."""
        return self.along.ends

    def state(self, place: Placement) -> SpringState:
        """Return its size and its effort.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        SpringState
        """
        size, joint = self.along.of(place), self.along.joint if isinstance(self.along, Angle) else ""
        effort = (-1.0 if self.along.turns else 1.0) * self.law.borne(size)
        return SpringState(
            name=self.name, kind=self.kind, size=size, effort=effort, turns=self.along.turns, joint=joint
        )

    def loads(self, place: Placement) -> tuple[PointLoad, ...]:
        """Return what it does to each of its ends, the ground included.

        Parameters
        ----------
        place : Placement
            Where the links stand.

        Returns
        -------
        tuple of PointLoad

        Raises
        ------
        CaseError
            Where two of its points coincide, so that its direction is not known.
        """
        effort, at = self.law.borne(self.along.of(place)), places(place, self.ends)
        for i, near in enumerate(self.along.meeting(at, _COINCIDE * place.linkage.longest)):
            if np.any(near & (effort != 0.0)):
                one, other = (f"'{point}' of link '{link}'" for link, point in self.ends[i : i + 2])
                raise CaseError(
                    f"{self.kind}s.{self.name}: points {one} and {other} coincide, so the direction of its force is "
                    "not known; move one of them, or change the pose"
                )
        wrenches = np.zeros((*at.shape, 6))
        wrenches[..., [0, 1, 5]] = -effort[..., None] * self.along.gradient(at)
        ends = zip(self.ends, wrenches, strict=True)
        return tuple(PointLoad(link=link, point=point, wrench=wrench) for (link, point), wrench in ends)

    def bent(self, at: NDArray[np.complex128], effort: float, slope: float) -> Real:
        """Return its tangent where its ends are anywhere.

        Parameters
        ----------
        at : complex array (k,)
            Where they stand [mm].
        effort : float
            There [N, N mm].
        slope : float
            By which it rises with the size.

        Returns
        -------
        array (3 k, 3 k)
            [N/mm, N, N mm]
        """
        ways = self.along.gradient(at).ravel()
        return np.asarray(effort * self.along.bend(at) + slope * np.outer(ways, ways))

    def marks(self, place: Placement) -> tuple[ActingMark, ...]:
        """As ``Acting.marks``: a coil, a cord, or a spiral about its joint."""
        effort, turns = float(self.state(place).effort), self.along.turns
        kind: MarkKind = "spiral" if turns else "cord" if self.law.pulls else "coil"
        ends = self.ends[:1] if turns else self.ends
        return (ActingMark(name=self.name, kind=kind, ends=ends, effort=effort, turns=turns),)


class SprungRecord(CaseModel):
    """A spring or tendon as a user states it; each kind is one class."""

    @property
    def fastened(self) -> Mapping[str, Attachment]:
        """Entry -> point of a link at which it is fastened, from one end to the other."""
        return {}

    @property
    def hinge(self) -> str | None:
        """The revolute joint about which it turns; None where it turns about none."""
        return None

    @abstractmethod
    def acting(self, name: str, stated: Placement) -> Sprung:
        """Return what it does in a linkage.

        Parameters
        ----------
        name : str
            Its own.
        stated : Placement
            The stated pose.

        Returns
        -------
        Sprung
        """

    def standing(self, effort: float) -> Self:
        """Return the same as seen from another pose, which is then the stated one.

        Parameters
        ----------
        effort : float
            What it does there, as ``SpringState`` has it [N, N mm].

        Returns
        -------
        SprungRecord
            Itself, where nothing of it is counted from the stated pose.
        """
        return self

    def route(self) -> Length:
        """Return the line through the points at which it is fastened.

        Returns
        -------
        Length
        """
        return Length(tuple((one.link, one.at) for one in self.fastened.values()))
