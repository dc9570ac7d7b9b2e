"""The holes of a linkage's pins between layers: how a pin stands at the rims of one, and what the frame makes of that.

Both rims of a hole hold the pin's centre in a disc. Where it stands there is a shift of the pin's end on its link and a
tilt against it, further deformations of the pins' beams (``alula.fea.frame.linear``). With the unit deformations D of
all rims, the forces q0 of tight pins and those S that unit deformations make, the forces at the rims are

    Q = Dᵀ (q0 + S D v),

the slope of the frame's energy with respect to v (Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapter 8:
structural modification by the force method).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.linear import FactorisedFrame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.system import natural_deformations
from alula.loads.case.case import Case
from alula.loads.case.forks import eye_of
from alula.loads.case.heights import thickness

Real = NDArray[np.float64]
NOTHING = 1e-9
"""Share of what a pin by itself bears below which there is nothing but by rounding."""


@dataclass(frozen=True, kw_only=True)
class Hole:
    """A hole in which a pin may run.

    Attributes
    ----------
    link : str
    joints : tuple of str
        Whose pin stands in it: several joints of one pin have one.
    low, high : float
        z of its rims, from the link's mid-plane [mm].
    """

    link: str
    joints: tuple[str, ...]
    low: float
    high: float


@dataclass(frozen=True, kw_only=True, eq=False)
class RimFrame:
    """A frame condensed to the rims of h holes.

    The variables are four of each hole: x and y at the lower rim, then at the upper one [mm].

    Attributes
    ----------
    frame : LinkageFrame
        With pins that are tight.
    solved : FactorisedFrame
        Of its model.
    holes : tuple of Hole
    opened : ndarray, shape (u, 4 h)
        Scaled unknowns of the frame by the variables.
    couples : ndarray, shape (c, r)
        The couples of all pins at both ends, along and across their links, from the natural forces of pins' beams.
    tight : ndarray, shape (r,)
        These natural forces with tight pins.
    by_rims : ndarray, shape (r, 4 h)
        The same by the variables.
    K : ndarray, shape (4 h, 4 h)
        Stiffness [N/mm].
    g : ndarray, shape (4 h,)
        Forces at the rims with tight pins [N].
    """

    frame: LinkageFrame
    solved: FactorisedFrame
    holes: tuple[Hole, ...]
    opened: Real
    couples: Real
    tight: Real
    by_rims: Real
    K: Real
    g: Real

    @property
    def noise(self) -> float:
        """Couple by a unit at a rim below which there is none but by rounding, as in an open chain [N]."""
        model = self.frame.model
        every = [(model.elements[i], model.length(i)) for i in self.frame.pin_beams.values()]
        return NOTHING * max(pin.young * pin.section.i_y / length**2 for pin, length in every)

    @classmethod
    def of(cls, frame: LinkageFrame, rims: Mapping[tuple[str, str], tuple[float, float]]) -> "RimFrame":
        """Condense a frame to the rims of its holes.

        Parameters
        ----------
        frame : LinkageFrame
            With pins that are tight in both links.
        rims : mapping of (str, str) to tuple of 2 float
            Joint and link -> z of the rims of the hole, from the link's mid-plane [mm]; those left out are tight.

        Returns
        -------
        RimFrame
        """
        solved = FactorisedFrame(frame.model)
        linkage = frame.pose.linkage
        names: dict[tuple[str, str], list[tuple[str, str]]] = {}  # link and point -> joints there, and the link
        for name in frame.pin_beams:
            for link in linkage.joints[name].links:
                names.setdefault((link, linkage.point_of(name, link)), []).append((name, link))
        # A pin of several joints is tight in a link where one of them says so.
        eyes = [eye for eye, each in names.items() if all(one in rims for one in each)]
        rows = np.array([6 * i + row for i in frame.pin_beams.values() for row in range(6)], dtype=np.int64)
        first = {name: 6 * k for k, name in enumerate(frame.pin_beams)}
        opening, holes = np.zeros((len(rows), 4 * len(eyes))), []
        for k, eye in enumerate(eyes):
            low, high = rims[names[eye][0]]
            stands = _stands(low, high)
            for name, end in ((x, end) for x, ends in frame.pin_eyes.items() for end in (0, 1) if ends[end] == eye):
                i = frame.pin_beams[name]
                deformed = natural_deformations(solved.system.lengths[i]) @ solved.system.matrices[i]
                own = deformed[:, 6 * end : 6 * end + 6] @ stands
                opening[first[name] : first[name] + 6, 4 * k : 4 * k + 4] -= own
            holes.append(Hole(link=eye[0], joints=tuple(name for name, _ in names[eye]), low=low, high=high))
        opened = solved.opened(rows) @ opening
        tight, by_rims = solved.natural_forces(rows, solved.own), solved.natural_forces(rows, opened)
        K = -opening.T @ by_rims
        return cls(
            frame=frame,
            solved=solved,
            holes=tuple(holes),
            opened=opened,
            couples=_couples(frame),
            tight=tight,
            by_rims=by_rims,
            K=(K + K.T) / 2.0,
            g=opening.T @ tight,
        )


def _couples(frame: LinkageFrame) -> Real:
    """Couples (4 pins, 6 pins) of all pins at both ends, along and across the link there, from natural forces."""
    found = np.zeros((4 * len(frame.pin_beams), 6 * len(frame.pin_beams)))
    for k, name in enumerate(frame.pin_beams):
        for end, (link, _) in enumerate(frame.pin_eyes[name]):
            angle = frame.pose.angles[link]
            about_x, about_y = 6 * k + 1 + end, 6 * k + 3 + end  # local z and y of a pin lie along x and y, or against
            found[4 * k + 2 * end, [about_x, about_y]] = np.cos(angle), np.sin(angle)
            found[4 * k + 2 * end + 1, [about_x, about_y]] = -np.sin(angle), np.cos(angle)
    return found


def _stands(low: float, high: float) -> Real:
    """Displacement and rotation (6, 4) of a pin at its link's mid-plane by its places at both rims."""
    found = np.zeros((6, 4))
    for axis in (0, 1):
        found[axis, [axis, 2 + axis]] = high / (high - low), -low / (high - low)
    # u_x grows along z with a turn about y, u_y against one about x.
    found[4, [0, 2]] = -1.0 / (high - low), 1.0 / (high - low)
    found[3, [1, 3]] = 1.0 / (high - low), -1.0 / (high - low)
    return found


def known_hole(case: Case, joint: str, link: str) -> tuple[float, float] | None:
    """Return the rims of a joint's hole in one of its links.

    Parameters
    ----------
    case : Case
    joint, link : str

    Returns
    -------
    tuple of 2 float or None
        z of both, from the mid-plane of the link [mm]; None where neither a part nor a thickness of the link tells.
    """
    if case.links[link].part is not None:
        ring = eye_of(case, joint, link)
        return ring.low, ring.high
    height = thickness(case.links[link], case.parts)
    return None if height is None else (-height / 2.0, height / 2.0)


def rims_of(case: Case, joint: str, link: str) -> tuple[float, float]:
    """Return the rims of a joint's hole in one of its links; of an unknown one those of the shortest.

    Parameters
    ----------
    case : Case
        With a part whose holes are known.
    joint, link : str

    Returns
    -------
    tuple of 2 float
        z of both, from the mid-plane of the link [mm].
    """
    found = known_hole(case, joint, link)
    return found or (-shortest(case) / 2.0, shortest(case) / 2.0)


def shortest(case: Case) -> float:
    """Return the length of the shortest hole that is known.

    Parameters
    ----------
    case : Case

    Returns
    -------
    float
        [mm]
    """
    known = [
        hole for name, joint in case.joints.items() for link in joint.links if (hole := known_hole(case, name, link))
    ]
    return min(high - low for low, high in known)
