"""The holes of a linkage's pins between layers: how a pin stands at the rims of one, and what the frame makes of that.

Both rims of a hole hold the pin's centre in a disc. Where it stands there is a shift of the pin's end on its link and a
tilt against it, further deformations of the pins' beams (``alula.fea.frame.linear``). With the unit deformations D of
all rims, the forces q0 of tight pins and those S that unit deformations make, the forces at the rims are

    Q = Dᵀ (q0 + S D v),

the slope of the frame's energy with respect to v (Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapter 8:
structural modification by the force method).
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.section_stress import equivalent_stress
from alula.fea.frame.linear import FactorisedFrame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameModel
from alula.fea.frame.system import natural_deformations
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.parts.part import Section
from alula.loads.case.case import Case
from alula.loads.case.forks import eye_of
from alula.loads.case.heights import thickness
from alula.loads.case.layers import Eye

Real = NDArray[np.float64]
WITHIN = (0.5, 0.75)
"""Shares of the way through an eye, from where a pin ends, at which its moment counts beside that at the face."""
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


@dataclass(frozen=True, kw_only=True)
class EyeFace:
    """Where an eye at an end of a pin's beam ends, of the way from its start to its stop.

    Attributes
    ----------
    near : float
        On the beam, from 0 to 1.
    far : float
        Where the pin ends; NaN where it goes on, and of an eye of several walls.
    """

    near: float
    far: float


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamEnds:
    """What bears on sections at both ends of all stretches of links' beams, and of pins between eyes: plain stresses.

    Attributes
    ----------
    owners : tuple of tuple of (str, str)
        Of each of e ends: "link" or "pin", and the name of the link or joint.
    elements : ndarray of int, shape (e,)
    unit : ndarray, shape (e, 4, 6)
        Stresses that a unit of each of an element's natural forces makes there [1/mm², 1/mm³].
    tight : ndarray, shape (e, 4)
        N/A, bending stress in the plane and out of it, and √3 times shear stress of the torque, with tight pins [MPa].
    by_rims : ndarray, shape (e, 4, 4 h)
        The same by the variables; 0 where there is nothing but by rounding.
    round : ndarray of bool, shape (e,)
        Where the section has no corners.
    within : ndarray of bool, shape (e,)
        Where it is no end but a place within the eye in which a pin ends; these stand last.
    """

    owners: tuple[tuple[str, str], ...]
    elements: NDArray[np.int64]
    unit: Real
    tight: Real
    by_rims: Real
    round: NDArray[np.bool_]
    within: NDArray[np.bool_]

    def of(self, ends: NDArray[np.int64]) -> "BeamEnds":
        """Return some of the ends.

        Parameters
        ----------
        ends : ndarray of int
            Their numbers.

        Returns
        -------
        BeamEnds
        """
        return BeamEnds(
            owners=tuple(self.owners[k] for k in ends),
            elements=self.elements[ends],
            unit=self.unit[ends],
            tight=self.tight[ends],
            by_rims=self.by_rims[ends],
            round=self.round[ends],
            within=self.within[ends],
        )

    def parts(self, natural: Real) -> Real:
        """Return the stresses that add up to those of plain sections.

        Parameters
        ----------
        natural : ndarray, shape (m, 6, ...)
            Natural forces of all elements.

        Returns
        -------
        ndarray, shape (e, 4, ...)
            As ``tight``.
        """
        return _stresses(self.unit, natural[self.elements])

    def stresses(self, parts: Real) -> Real:
        """Return the stress of plain sections.

        Parameters
        ----------
        parts : ndarray, shape (..., e, 4)
            As ``tight``.

        Returns
        -------
        ndarray, shape (..., e)
            [MPa]
        """
        axial, inside, across, shear = np.moveaxis(np.abs(parts), -1, 0)
        return np.asarray(np.hypot(axial + np.where(self.round, np.hypot(inside, across), inside + across), shear))


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
    ends : ndarray, shape (p, 12, 4 h)
        How the variables shift and turn both ends of each pin's beam on its nodes, global axes, in the order of
        ``frame.pin_beams``.
    opened : ndarray, shape (u, 4 h)
        Scaled unknowns of the frame by the variables.
    couples : ndarray, shape (c, r)
        Thrusts of all pins, and couples along and across links without a beam, from natural forces of pins' beams.
    tight : ndarray, shape (r,)
        These natural forces with tight pins.
    by_rims : ndarray, shape (r, 4 h)
        The same by the variables.
    K : ndarray, shape (4 h, 4 h)
        Stiffness [N/mm].
    g : ndarray, shape (4 h,)
        Forces at the rims with tight pins [N].
    faces : mapping of str to tuple of 2 EyeFace
        Joint -> where the eyes at both ends of its pin's beam end; left out where that is not known.
    """

    frame: LinkageFrame
    solved: FactorisedFrame
    holes: tuple[Hole, ...]
    ends: Real
    opened: Real
    couples: Real
    tight: Real
    by_rims: Real
    K: Real
    g: Real
    faces: Mapping[str, tuple[EyeFace, EyeFace]]

    @cached_property
    def beam_ends(self) -> BeamEnds:
        """Of all pins, and links with a beam."""
        return _beam_ends(self.frame, self.solved, self.opened, self.faces)

    @property
    def noise(self) -> float:
        """Couple by a unit at a rim below which there is none but by rounding, as in an open chain [N]."""
        return _noise(self.frame)

    @classmethod
    def of(
        cls,
        frame: LinkageFrame,
        rims: Mapping[tuple[str, str], tuple[float, float]],
        faces: Mapping[str, tuple[EyeFace, EyeFace]] = MappingProxyType({}),
    ) -> "RimFrame":
        """Condense a frame to the rims of its holes.

        Parameters
        ----------
        frame : LinkageFrame
            With pins that are tight in both links.
        rims : mapping of (str, str) to tuple of 2 float
            Joint and link -> z of the rims of the hole, from the link's mid-plane [mm]; those left out are tight.
        faces : mapping of str to tuple of 2 EyeFace, optional
            As of the attribute.

        Returns
        -------
        RimFrame
        """
        solved = FactorisedFrame(frame.model)
        linkage = frame.pose.linkage
        names: dict[tuple[Eye, str], list[tuple[str, str]]] = {}  # hole -> joints there, and the link
        for name in frame.pin_beams:
            for link in linkage.joints[name].links:
                eye = link, linkage.point_of(name, link)
                names.setdefault(_hole_of(linkage, name, eye), []).append((name, link))
        # A pin of several joints is tight in a link where one of them says so.
        holed = [hole for hole, each in names.items() if all(one in rims for one in each)]
        rows = np.array([6 * i + row for i in frame.pin_beams.values() for row in range(6)], dtype=np.int64)
        beam_ends = [
            (k, _hole_of(linkage, name, eye), end)
            for k, name in enumerate(frame.pin_beams)
            for end, eye in enumerate(frame.pin_eyes[name])
        ]
        ends, holes = np.zeros((len(frame.pin_beams), 12, 4 * len(holed))), []
        for k, hole in enumerate(holed):
            low, high = rims[names[hole][0]]
            for beam, _, end in (one for one in beam_ends if one[1] == hole):
                ends[beam, 6 * end : 6 * end + 6, 4 * k : 4 * k + 4] = _stands(low, high)
            own = tuple(name for name, _ in names[hole])
            holes.append(Hole(link=hole[0][0], joints=own, low=low, high=high))
        pins = list(frame.pin_beams.values())
        deformed = natural_deformations(solved.system.lengths[pins]) @ solved.system.matrices[pins]
        opening = -(deformed @ ends).reshape(len(rows), -1)
        opened = solved.opened(rows) @ opening
        tight, by_rims = solved.natural_forces(rows, solved.own), solved.natural_forces(rows, opened)
        K = -opening.T @ by_rims
        return cls(
            frame=frame,
            solved=solved,
            holes=tuple(holes),
            ends=ends,
            opened=opened,
            couples=_couples(frame),
            tight=tight,
            by_rims=by_rims,
            K=(K + K.T) / 2.0,
            g=opening.T @ tight,
            faces=faces,
        )

    def divided(self, model: FrameModel, parents: NDArray[np.int64]) -> "RimFrame":
        """Return the same of the frame with divided beams.

        Parameters
        ----------
        model : FrameModel
            With pins that are not divided.
        parents : ndarray of int, shape (m,)
            Element of the frame that each one is part of.

        Returns
        -------
        RimFrame
            Its variables are the same.
        """
        pins = {name: int(np.flatnonzero(parents == i)[0]) for name, i in self.frame.pin_beams.items()}
        rims = {(name, hole.link): (hole.low, hole.high) for hole in self.holes for name in hole.joints}
        beams = {k: self.frame.beams[i] for k, i in enumerate(parents.tolist()) if i in self.frame.beams}
        return RimFrame.of(replace(self.frame, model=model, pin_beams=pins, beams=beams), rims, self.faces)


def _noise(frame: LinkageFrame) -> float:
    model = frame.model
    every = [(model.elements[i], model.length(i)) for i in frame.pin_beams.values()]
    every = [one for one in every if not one[0].rigid] or [
        (e, model.length(i)) for i, e in enumerate(model.elements) if not e.rigid
    ]
    return NOTHING * max((e.young * e.section.i_y / length**2 for e, length in every), default=1.0)


def _couples(frame: LinkageFrame) -> Real:
    """Thrusts of all pins, and couples along and across links without a beam, by natural forces of pins' beams."""
    beams, found = {beam.link for beam in frame.beams.values()}, list[Real]()
    starts, stops = frame.model.all_ends
    for k, (name, i) in enumerate(frame.pin_beams.items()):
        turned = -1.0 if stops[i][2] > starts[i][2] else 1.0  # local y of a pin that rises lies against y
        found.append(_row(frame, {6 * k: 1.0}))
        for end, (link, _) in enumerate(frame.pin_eyes[name]):
            if link not in beams:
                along, across = np.cos(frame.pose.angles[link]), np.sin(frame.pose.angles[link])
                about_x, about_y = 6 * k + 1 + end, 6 * k + 3 + end  # about a pin's local z, along x, and its local y
                found.append(_row(frame, {about_x: along, about_y: turned * across}))
                found.append(_row(frame, {about_x: -across, about_y: turned * along}))
    return np.array(found)


def _row(frame: LinkageFrame, entries: Mapping[int, float]) -> Real:
    found = np.zeros(6 * len(frame.pin_beams))
    found[list(entries)] = list(entries.values())
    return found


def _beam_ends(
    frame: LinkageFrame, solved: FactorisedFrame, opened: Real, faces: Mapping[str, tuple[EyeFace, EyeFace]]
) -> BeamEnds:
    ends = [(i, ("link", beam.link), _at(at)) for i, beam in frame.beams.items() for at in (0.0, 1.0)]
    unknown = EyeFace(near=0.0, far=np.nan), EyeFace(near=1.0, far=np.nan)
    known = {name: faces.get(name, unknown) for name in frame.pin_beams}
    ends += [(i, ("pin", name), _at(face.near)) for name, i in frame.pin_beams.items() for face in known[name]]
    count = len(ends)
    inner = [(i, name, face) for name, i in frame.pin_beams.items() for face in known[name] if not np.isnan(face.far)]
    ends += [(i, ("pin", name), _within(face, share)) for i, name, face in inner for share in WITHIN]
    elements, moments = np.array([i for i, _, _ in ends], dtype=np.int64), np.array([own for _, _, own in ends])
    sections = [frame.model.elements[i].section for i in elements]
    shares = np.zeros((len(ends), 4, 6))
    shares[:, 0, 0] = shares[:, 3, 5] = 1.0
    for row, moment in ((1, 1), (2, 3)):
        shares[:, row, moment : moment + 2] = moments
    unit = shares * np.array([_unit_stresses(section) for section in sections]).reshape(-1, 4, 1)
    rows = np.arange(6 * len(frame.model.elements), dtype=np.int64)
    tight, by_rims = solved.natural_forces(rows, solved.own), solved.natural_forces(rows, opened)
    by_rims[np.abs(by_rims).max(axis=1, initial=0.0) <= _noise(frame)] = 0.0
    return BeamEnds(
        owners=tuple(owner for _, owner, _ in ends),
        elements=elements,
        unit=unit,
        tight=_stresses(unit, tight.reshape(-1, 6)[elements]),
        by_rims=_stresses(unit, by_rims.reshape(-1, 6, by_rims.shape[1])[elements]),
        round=np.array([section.round for section in sections], dtype=bool),
        within=np.arange(len(ends)) >= count,
    )


def _at(place: float) -> Real:
    """Moment (2,) at a place from 0 to 1 by those at both ends, which turn the same way: between them it is linear."""
    return np.array([1.0 - place, -place])


def _within(face: EyeFace, share: float) -> Real:
    """Moment (2,) within an eye, at a share of the way from where the pin ends, by those at both ends of its beam.

    The eye presses with what is linear along it, so that the moment is a cubic from nothing to that of its face.
    """
    shear = (face.near - face.far) * np.array([-1.0, -1.0])  # that of the beam, times the eye's length
    return (3.0 - 2.0 * share) * share**2 * _at(face.near) - share**2 * (1.0 - share) * shear


def _stresses(unit: Real, natural: Real) -> Real:
    """Stresses (e, 4, ...) by units (e, 4, 6) of natural forces (e, 6, ...)."""
    return np.asarray(np.einsum("efk,ek...->ef...", unit, natural))


def _unit_stresses(section: Section) -> tuple[float, float, float, float]:
    twisted = float(equivalent_stress(section, np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]]))[0])
    return 1.0 / section.area, section.half_y / section.i_z, section.half_z / section.i_y, twisted


def _hole_of(linkage: Linkage, joint: str, eye: Eye) -> tuple[Eye, str]:
    """Return what tells the hole of an eye from others; in a slot the pin of each joint stands by itself."""
    return eye, joint if eye[0] == linkage.joints[joint].slotted else ""


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


def faces_of(case: Case, frame: LinkageFrame) -> dict[str, tuple[EyeFace, EyeFace]]:
    """Return where the eyes at both ends of pins between layers end.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
        Of its linkage.

    Returns
    -------
    dict of str to tuple of 2 EyeFace
        As ``RimFrame.faces``, of pins between eyes that are known and lie side by side.
    """
    found, (starts, stops) = dict[str, tuple[EyeFace, EyeFace]](), frame.model.all_ends
    ending = Counter(eye for own in frame.pin_eyes.values() for eye in own)
    for name, i in frame.pin_beams.items():
        up, eyes = float(stops[i][2] - starts[i][2]), frame.pin_eyes[name]
        rims = [_known_at(case, *eye) for eye in eyes]
        if case.linkage.rise(name) == 0.0 or None in rims:
            continue
        (below, near), (other, above) = (
            (rim[0] / up, rim[1] / up) if up > 0.0 else (rim[1] / up, rim[0] / up) for rim in rims if rim
        )
        ends = [ending[eye] == 1 and len(_walls(case, *eye)) == 1 for eye in eyes]
        if 0.0 <= near <= 1.0 + other <= 1.0:
            found[name] = (
                EyeFace(near=near, far=below if ends[0] else np.nan),
                EyeFace(near=1.0 + other, far=1.0 + above if ends[1] else np.nan),
            )
    return found


def _walls(case: Case, link: str, point: str) -> Sequence[tuple[float, float]]:
    """Return the walls of the hole at a point of a link; one where no part tells."""
    if case.links[link].part is None:
        return ((0.0, 0.0),)
    return eye_of(case, case.linkage.joints_at(link, point)[0], link).walls


def _known_at(case: Case, link: str, point: str) -> tuple[float, float] | None:
    """Return the rims of the hole at a point of a link, as ``known_hole`` does."""
    return known_hole(case, case.linkage.joints_at(link, point)[0], link)


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
