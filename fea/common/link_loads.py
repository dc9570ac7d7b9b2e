"""All that acts on a link that is cut free, in the link's axes, at one pose or at n.

The input of hand calculation, of solid models and of envelopes. A leading axis of the arrays counts the poses where
there are several.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from alula.geometry.bodies.seat import Seat
from alula.loads.records.applied import BodyForce, LineLoad, chosen, shifted, together

Real = NDArray[np.float64]
ALONG = np.array([1.0, 0.0, 0.0])
"""The axis of a link, in its own axes."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PinLoad:
    """Load of the pin in a hole or slot on the link.

    Attributes
    ----------
    name : str
        Of the hole.
    centre : array (..., 3)
        Point on the pin's axis at the link's mid-plane [mm].
    diameter : float
        Of the hole; of the pin where it stands in a slot [mm].
    wrench : array (..., 6)
        Fx, Fy, Fz [N] and Mx, My, Mz [N mm] about ``centre``; Mz enters like a drive couple but for ``friction``.
    slotted : bool
        True for a pin in a slot along x, which carries neither a force along x nor a moment about z but by friction.
    friction : float or array (...)
        The part of the wrench that friction exerts: of Mz, which is shear in the bore [N mm]; in a slot, of Fx [N].
    seat : Seat, optional
        How the pin sits in its hole; None where nothing tells it.
    """

    VECTORS: ClassVar[tuple[str, ...]] = ("centre", "wrench")
    SCALARS: ClassVar[tuple[str, ...]] = ("friction",)
    name: str
    centre: Real
    diameter: float
    wrench: Real
    slotted: bool = False
    friction: Any = 0.0
    seat: Seat | None = None

    @property
    def place(self) -> Real:
        """Its centre (3,), which is the same in all states but in a slot [mm]."""
        return np.asarray(self.centre.reshape(-1, 3)[0])

    @property
    def torque(self) -> Any:
        """The moment about a pin in its bore (...) that does not enter by friction [N mm]."""
        return self.wrench[..., 5] - self.friction

    @property
    def rubbed(self) -> Any:
        """The moment about a pin in its slot (...) of its friction, which acts where it touches the flank [N mm]."""
        return -0.5 * self.diameter * np.sign(self.wrench[..., 1]) * self.friction


@dataclass(frozen=True, kw_only=True, eq=False)
class DriveCouple:
    """Drive torque on the link at a pin.

    Attributes
    ----------
    pin : str
        Name of its hole.
    torque : float or array (...)
        About z, counter-clockwise positive [N mm].
    """

    VECTORS: ClassVar[tuple[str, ...]] = ()
    SCALARS: ClassVar[tuple[str, ...]] = ("torque",)
    pin: str
    torque: Any


@dataclass(frozen=True, kw_only=True, eq=False)
class EndLoad:
    """Wrench on a loaded end, spread over the patch ``end:<name>``.

    Attributes
    ----------
    name : str
        Of the end.
    point : array (3,)
        [mm].
    wrench : array (..., 6)
        About ``point`` [N, N mm].
    clamped : bool
        True of an end of a tube or bar that a clamp holds; ``point`` is then at the mouth of the clamp.
    """

    VECTORS: ClassVar[tuple[str, ...]] = ("wrench",)
    SCALARS: ClassVar[tuple[str, ...]] = ()
    name: str
    point: Real
    wrench: Real
    clamped: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkLoads:
    """All loads of one load case on one link; together they must balance.

    Attributes
    ----------
    name, link : str
        Of the load case and the link.
    pins : tuple of PinLoad
        Joint forces and loads stated at pins.
    couples : tuple of DriveCouple
        The drive torque.
    ends : tuple of EndLoad
        Loads stated at ends.
    lines : tuple of LineLoad
        Spread loads, in the link's axes.
    inertia : BodyForce, optional
        Weight and inertia, in the link's axes; None where the link counts as massless.
    """

    name: str
    link: str = ""
    pins: tuple[PinLoad, ...] = ()
    couples: tuple[DriveCouple, ...] = ()
    ends: tuple[EndLoad, ...] = ()
    lines: tuple[LineLoad, ...] = ()
    inertia: BodyForce | None = None

    @property
    def poses(self) -> int:
        """Number of poses, where there is an axis of them."""
        vectors = [wrench for _, wrench in self.wrenches] + [line.at_start for line in self.lines]
        vectors += [np.atleast_1d(couple.torque) for couple in self.couples]
        vectors += [] if self.inertia is None else [self.inertia.specific_force]
        return max(map(len, vectors), default=1)

    @property
    def wrenches(self) -> tuple[tuple[Real, Real], ...]:
        """(place (..., 3), wrench (..., 6) about it) of pins and ends."""
        return (*((pin.centre, pin.wrench) for pin in self.pins), *((end.point, end.wrench) for end in self.ends))

    def chosen(self, poses: Any) -> "LinkLoads":
        """Return the loads at one or some of the poses alone.

        Parameters
        ----------
        poses : int, slice, numbers, mask (n,) or None
            Which poses; for a single number the result has no axis of poses. None gives loads at a single pose an axis.

        Returns
        -------
        LinkLoads
        """
        return replace(
            self,
            pins=tuple(chosen(pin, poses) for pin in self.pins),
            couples=tuple(chosen(couple, poses) for couple in self.couples),
            ends=tuple(chosen(end, poses) for end in self.ends),
            lines=tuple(chosen(line, poses) for line in self.lines),
            inertia=None if self.inertia is None else chosen(self.inertia, poses),
        )

    def with_wrenches(self, wrenches: Iterable[Real]) -> "LinkLoads":
        """Return the loads with other wrenches of pins and ends.

        Parameters
        ----------
        wrenches : iterable of ndarray, shape (..., 6)
            About the same places, in the order of ``LinkLoads.wrenches``.

        Returns
        -------
        LinkLoads
        """
        found = iter(wrenches)
        pins = tuple(replace(pin, wrench=next(found)) for pin in self.pins)
        return replace(self, pins=pins, ends=tuple(replace(end, wrench=next(found)) for end in self.ends))

    def parts(self) -> list[Real]:
        """Return the wrench (..., 6) of every load about the origin of the link's frame [N, N mm]."""
        found = [shifted(wrench, place) for place, wrench in self.wrenches]
        for couple in self.couples:
            torque = np.asarray(couple.torque, dtype=float)
            found.append(torque[..., None] * np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
        found += [line.about_origin(ALONG) for line in self.lines]
        if self.inertia is not None:
            found.append(self.on_mass)
        return found

    @property
    def on_mass(self) -> Real:
        """Weight and inertia (..., 6) about the origin of the link's frame; only where the link has a mass."""
        assert self.inertia is not None
        centroid = np.array([*self.inertia.mass.centroid, 0.0])
        return shifted(self.inertia.at_centroid(centroid), centroid)

    def resultant(self) -> Real:
        """Return the sum (..., 6) of all loads about the origin of the link's frame: zero where they balance."""
        return np.asarray(sum(self.parts(), np.zeros(6)))

    def size(self, length: float) -> Real:
        """Return the sum of the magnitudes of all forces, and of all moments over a length: the scale of a resultant.

        Parameters
        ----------
        length : float
            Such as the link's [mm].

        Returns
        -------
        array (...)
            In N.
        """
        total = np.zeros(())
        for wrench in [w for _, w in self.wrenches]:
            total = total + np.linalg.norm(wrench[..., :3], axis=-1) + np.linalg.norm(wrench[..., 3:], axis=-1) / length
        for couple in self.couples:
            total = total + np.abs(couple.torque) / length
        for line in self.lines:
            ends = np.linalg.norm([line.at_start, line.at_end], axis=-1)
            total = total + ends.mean(axis=0) * (line.end - line.start)
        if self.inertia is not None:
            assert self.inertia is not None
            force = self.inertia.at_centroid(np.array([*self.inertia.mass.centroid, 0.0]))
            total = total + np.linalg.norm(force[..., :3], axis=-1) + np.abs(force[..., 5]) / length
        return np.asarray(total)


def stacked(states: Sequence[LinkLoads]) -> list[tuple[list[int], LinkLoads]]:
    """Return the loads of a link in several states as few with an axis of states.

    Parameters
    ----------
    states : sequence of LinkLoads
        On the same link, in one state each.

    Returns
    -------
    list of tuple of (list of int, LinkLoads)
        Numbers of the states in which what acts stands at the same places, and all that acts on the link in these.
    """
    alike: dict[Any, list[int]] = {}
    for i, one in enumerate(states):
        pins, lines = (pin.centre.tobytes() for pin in one.pins), ((line.start, line.end) for line in one.lines)
        alike.setdefault((*pins, *lines, *(couple.pin for couple in one.couples)), []).append(i)
    return [(numbers, _stacked([states[i] for i in numbers])) for numbers in alike.values()]


def _stacked(states: Sequence[LinkLoads]) -> LinkLoads:
    first, inertia = states[0], [one.inertia for one in states]
    return replace(
        first,
        pins=tuple(map(together, zip(*(one.pins for one in states), strict=True))),
        couples=tuple(map(together, zip(*(one.couples for one in states), strict=True))),
        ends=tuple(map(together, zip(*(one.ends for one in states), strict=True))),
        lines=tuple(map(together, zip(*(one.lines for one in states), strict=True))),
        inertia=None if first.inertia is None else together(inertia),
    )


Plates = tuple[LinkLoads, ...]
"""What acts on a link, or on each plate of a pair, in one state."""
