"""The instant centre of a link over a motion, and where the load on that link runs past it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.loads.states.case_motion import CaseMotion

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

_COUPLE = 1e-9
"""Force times the longest link, over the moment, below which a load is a couple: the force that is left is rounding."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LineOfAction:
    """The line of action of all that acts on a link, at n poses; NaN where nothing acts, and of a couple.

    Attributes
    ----------
    foot : complex array (n,)
        A point of the line, nearest to the origin of the link [mm].
    along : complex array (n,)
        Direction of the force in the plane, a unit vector.
    ahead : array (n,)
        Distance from the instant centre [mm]: positive where the load turns the link against the motion, and so holds
        it back, negative where it turns it on. The motion of a cycle is that in which its column of the angle grows,
        at every row, whichever way the link turns there. NaN where the centre lies at infinity.
    """

    foot: Complex
    along: Complex
    ahead: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class InstantCentre:
    """The point about which a link turns against another, at the n poses of a motion.

    Attributes
    ----------
    link, against : str
        The two links.
    path : complex array (n,)
        Its place x + iy [mm], NaN where it lies at infinity.
    lines : mapping of str to LineOfAction
        Load case -> the line of what acts on ``link``.
    """

    link: str
    against: str
    path: Complex
    lines: Mapping[str, LineOfAction]


def instant_centre(moved: CaseMotion) -> InstantCentre | None:
    """Return the instant centre for which a case asks.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    InstantCentre or None
        None where it asks for none.

    Notes
    -----
    The moment of the load about the centre is its virtual work by the angle between the two links. With no other load
    on moving links, and against the ground, it is that of the drive, reversed: derived so, and tested so.
    """
    motion, spec = moved.motion, moved.case.motion
    if spec is None or spec.instant_centre is None:
        return None
    link, against = spec.instant_centre, spec.against or motion.linkage.ground
    place, path = motion.placement, motion.virtual.instant_centre(link, against)
    cycle = moved.case.cycle
    sense = motion.angles[-1] - motion.angles[0] if cycle is None else cycle.signed_angle[0]
    onward = np.sign((motion.virtual.spin(link) - motion.virtual.spin(against)) * sense)
    lines = {}
    for name, loads in moved.loads.items():
        wrench = sum((load.resultant(place) for load in loads if load.link == link), np.zeros((*place.shape, 6)))
        force, moment = wrench[:, 0] + 1j * wrench[:, 1], wrench[:, 5]
        size = np.abs(force)
        size = np.where(size * motion.linkage.longest > _COUPLE * np.abs(moment), size, np.nan)
        along, arm = np.asarray(force * (1.0 / size), dtype=complex), place.origin(link) - path
        about = moment / size + arm.real * along.imag - arm.imag * along.real
        foot = place.origin(link) - 1j * along * (moment / size)
        lines[name] = LineOfAction(foot=foot, along=along, ahead=-onward * about)
    return InstantCentre(link=link, against=against, path=path, lines=lines)
