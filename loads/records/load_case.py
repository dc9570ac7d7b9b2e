"""Load cases as a user states them: forces, moments, spread loads, air, weight and speed."""

import math
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Field, PlainValidator, PrivateAttr, ValidationInfo, WithJsonSchema, model_validator

from alula.geometry.base.model import CaseModel, Name, Text, refusal
from alula.geometry.base.units import (
    NOT_NEGATIVE,
    Acceleration,
    Angle,
    AngularSpeed,
    Force,
    Length,
    Stress,
    parse,
    weight_in,
)
from alula.loads.records.aero import AirLoad
from alula.loads.records.attachment import Attachment
from alula.loads.records.flapping import Flapping
from alula.loads.text.shares import LoadScatter

Vector = Annotated[tuple[Force, ...], Field(min_length=2, max_length=3)]
Place = Annotated[tuple[Length, ...], Field(min_length=2, max_length=3)]
Axes = Literal["global", "link"]


def _moment(stated: object, info: ValidationInfo) -> tuple[float, float, float]:
    weight = weight_in(info)
    if not isinstance(stated, list | tuple):
        return 0.0, 0.0, parse(stated, "moment", weight)
    if len(stated) != 3:
        raise refusal('it must be one moment about z or three about x, y and z; write for example "130 N*mm"')
    x, y, z = (parse(component, "moment", weight) for component in stated)
    return x, y, z


MomentVector = Annotated[
    tuple[float, float, float],
    PlainValidator(_moment),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "format": "moment", "examples": ["130 N*mm"]},
                {"type": "array", "items": {"type": "string", "format": "moment"}, "minItems": 3, "maxItems": 3},
            ]
        }
    ),
]


class PointForce(CaseModel):
    """A force at a point of a link."""

    link: Name
    """The link on which it acts."""
    at: Name
    """The point of that link: a pin or a load point."""
    force: Vector
    """Its components along x and y, or x, y and z."""
    axes: Axes = "global"
    """Axes of the components: global, or the link's own, so that the force turns with the link from pose to pose. While
    the linkage deforms in a pose, the force keeps its direction either way."""


class PointMoment(CaseModel):
    """A moment at a point of a link, in global axes: about z, counter-clockwise positive, or about x, y and z."""

    link: Name
    """The link on which it acts."""
    at: Name
    """The point of that link."""
    moment: MomentVector
    """One moment about z, or three about x, y and z."""


class FacePressure(CaseModel):
    """A pressure on a named face of a link's part, from outside against the material."""

    link: Name
    """The link whose part has the face."""
    at: Name
    """The point that stands for the face (``faces`` of the part)."""
    pressure: Stress
    """Force per area; a negative one pulls."""


class SpreadForce(CaseModel):
    """A force spread evenly along the axis of a link between two of its points."""

    link: Name
    """The link on which it acts."""
    start: Name
    """The point at which it begins."""
    end: Name
    """The point at which it ends."""
    total: Vector
    """Components of the whole force along x and y, or x, y and z."""
    axes: Axes = "global"
    """Axes of the components: global, or the link's own, so that the force turns with the link from pose to pose. While
    the linkage deforms in a pose, the force keeps its direction either way."""


_SHORTEST = 1e-9
"""Length of a load line over its largest coordinate below which its direction is but rounding."""


class LoadLine(CaseModel):
    """A force along a line through two points in space, which enters a link over a rigid lever."""

    from_: Place = Field(alias="from")
    """Where the force begins, x, y and z; the rigid lever to the link starts here. Without z both ends lie in the
    mid-planes of the links that they load."""
    to: Place
    """The point that it goes towards, with as many coordinates."""
    force: Force
    """Its size; a negative one goes from ``to`` towards ``from``."""
    link: Name
    """The link that it enters."""
    at: Name
    """The point of that link at which the lever is fastened."""
    axes: Axes = "global"
    """Axes of both points: global, so that the line stays in space while the linkage moves, or those of ``link``, so
    that it moves with this link. While the linkage deforms in a pose, the levers move along and the force keeps its
    direction either way."""
    leaves: Attachment | None = None
    """Where the opposite force enters, over a rigid lever that starts at ``to``; the ground bears it where left out."""

    @model_validator(mode="after")
    def _fits(self) -> "LoadLine":
        if len(self.from_) != len(self.to):
            raise refusal("one of from and to has no z; state two coordinates for both, or three")
        start, end = vector3(self.from_), vector3(self.to)
        if np.linalg.norm(end - start) <= _SHORTEST * max(np.abs([start, end]).max(), 1.0):
            raise refusal("from and to are the same point, which gives the force no direction; state two points")
        if self.leaves is not None and (self.leaves.link, self.leaves.at) == (self.link, self.at):
            raise refusal("its force enters and leaves at one point, so that nothing is left of it; name another point")
        return self


class Block(NamedTuple):
    """States of a load that follow each other, the first after the last, and how often in each cycle that is asked for.

    Attributes
    ----------
    states : tuple of int
        Their numbers, in their order.
    share : float
        How often they are gone through in each cycle; a block of 1e6 cycles among 2e6 has 0.5.
    """

    states: tuple[int, ...]
    share: float


class LoadCase(CaseModel):
    """One set of loads that act at the same time."""

    title: Text = ""
    """What the load case is, for the report."""
    own_weight: bool = False
    """True: every link weighs what its part's volume and density say and what it carries. False: links are
    massless, and a stated total weight stands among the forces. Where links carry masses it is to be stated, or
    gravity_direction, which makes it true."""
    gravity: Annotated[Acceleration, NOT_NEGATIVE] = 9810.0
    """Acceleration of gravity, for own weight and carried masses."""
    gravity_direction: Angle = -math.pi / 2
    """Direction of the weight, from the global x axis."""
    speed: AngularSpeed = 0.0
    """Constant angular speed of the pose's coordinate, counter-clockwise positive; that of the motion where left out,
    unless motion.inertia is false. The inertia of the parts and of what they carry acts at it; at 0 rpm the linkage
    stands still."""
    direction: Literal["both", "forward", "backward"] = "both"
    """Direction of the motion that friction at the joints opposes: forward where the coordinate of the pose (or of the
    motion) grows, backward where it falls. With both, each is a load case of its own. A speed gives it as well."""
    carried: bool = True
    """False: without the masses that the links carry."""
    scatter: LoadScatter = (1.0, 1.0)
    """How far all loads of this load case may be off together, such as "20 %", or { low = "90 %", high = "130 %" };
    the bands of all that they do hold it."""
    least: Annotated[float, Field(ge=-1.0, lt=1.0)] | None = None
    """What is left of the loads at the least point of each cycle of conditions.cycles in a pose, as a share of them: 0
    where they go to nothing, -1 to their opposite. When left out, 0, or -1 with conditions.reverses."""
    forces: tuple[PointForce, ...] = ()
    """Forces at points."""
    moments: tuple[PointMoment, ...] = ()
    """Moments at points."""
    pressures: tuple[FacePressure, ...] = ()
    """Pressures on named faces of imported parts."""
    spread: tuple[SpreadForce, ...] = ()
    """Forces spread along links."""
    load_lines: tuple[LoadLine, ...] = ()
    """Forces along lines in space, which enter links over rigid levers, as testing machines bring them in."""
    air: tuple[AirLoad, ...] = ()
    """Lift and drag of streams."""
    flapping: Flapping | None = None
    """Air at rest in which the wings flap; without it they meet none."""
    _rows: tuple["LoadCase", ...] = PrivateAttr(())
    _blocks: tuple[Block, ...] = PrivateAttr(())
    _shares: tuple[float, ...] = PrivateAttr(())

    @property
    def blocks(self) -> tuple[Block, ...]:
        """How its cycles are made of its states: rows, or ``shares``; empty where it does no more than come and go."""
        return self._blocks

    @property
    def shares(self) -> tuple[float, ...]:
        """What is left of the loads at each of the states that its cycles are made of, in a pose; empty for rows."""
        return self._shares

    @property
    def rows(self) -> tuple["LoadCase", ...]:
        """The load case at every instant of a cycle; empty where none of its loads changes over one."""
        return self._rows

    def over(
        self, rows: tuple["LoadCase", ...] = (), *, blocks: tuple[Block, ...] = (), shares: tuple[float, ...] = ()
    ) -> "LoadCase":
        """Return the load case with what it is at every instant of a cycle, and how often which instants follow.

        Parameters
        ----------
        rows : tuple of LoadCase, optional
        blocks, shares : tuple, optional
            As the properties.

        Returns
        -------
        LoadCase
        """
        found = self.model_copy()
        found._rows, found._blocks, found._shares = rows, blocks, shares
        return found


def force_size(load_case: LoadCase) -> float:
    """Return the size of the force that is all that a load case states, but for its own weight and its speed.

    Parameters
    ----------
    load_case : LoadCase
        With one force at a point, or one load line.

    Returns
    -------
    float
        [N]; zero where it states none, or other loads as well.
    """
    sizes = [float(np.linalg.norm(vector3(one.force))) for one in load_case.forces]
    sizes += [abs(line.force) for line in load_case.load_lines]
    others = load_case.moments or load_case.pressures or load_case.spread or load_case.air or load_case.flapping
    return sizes[0] if len(sizes) == 1 and not others else 0.0


def gravity(load_case: LoadCase) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the weight per mass of a load case.

    Parameters
    ----------
    load_case : LoadCase
        The load case.

    Returns
    -------
    array (3,)
        In global axes [mm/s²].
    """
    direction = load_case.gravity_direction
    return load_case.gravity * np.array([math.cos(direction), math.sin(direction), 0.0])


def vector3(components: tuple[float, ...]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return a stated vector with all components.

    Parameters
    ----------
    components : tuple of float
        Two or three components, in any unit.

    Returns
    -------
    array (3,)
        The same, with zero for what is missing.
    """
    return np.array([*components, 0.0][:3])
