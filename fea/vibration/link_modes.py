"""Natural frequencies and shapes of one link by itself, by its beams or by its solid.

The link is held as its joints hold it (``link_holding``), with pins that may run in holes both tight and tilting, and
bears what it carries. Loads are left out: what they pull
or press would raise or lower the frequencies of the beams and of the solid alike, by some half of the load's share of
the one that buckles it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, compliance_scatter
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.common.threads import bounded_run
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import stiffness_parts
from alula.fea.vibration.flexibility_doubt import FlexibilityDoubt, stiffest
from alula.fea.vibration.link_frame import link_frame
from alula.fea.vibration.link_holding import LinkHolding, link_holding
from alula.fea.vibration.link_solid import LinkSolid, first_mesh, refined_modes
from alula.fea.vibration.linkage_modes import BASIS, SUBDIVISIONS, divide, frame_modes, node_motions
from alula.fea.vibration.mass_matrix import mass_matrix
from alula.fea.vibration.modes import Mode, frequency
from alula.fea.vibration.running_holes import running_holes, with_low_ends
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.states.actions import needs_masses
from alula.loads.states.masses import all_carried, part_mass, part_masses
from alula.loads.states.standing import stand

Real = NDArray[np.float64]
NO_BEAM = reason("frame_takes_ground_for_rigid")


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkModes:
    """The lowest natural modes of a link by itself.

    Attributes
    ----------
    link : str
    model : str
        "beam" or "solid".
    held : Reason
        How its joints hold it, for people.
    modes : tuple of Mode
        The lowest frequency first; shapes at ``nodes``, of beams (n, 6) and of solids (n, 3), in the link's axes.
    nodes : ndarray, shape (n, 3)
        In the link's frame [mm].
    pieces : ndarray of int, shape (m, 2) or (m, 3)
        Nodes at the ends of the beams, or at the corners of the solid's outer faces.
    """

    link: str
    model: str
    held: Reason
    modes: tuple[Mode, ...]
    nodes: Real
    pieces: NDArray[np.int64]


@bounded_run
def link_modes(
    case: Case, link: str, *, count: int = 4, solid: bool = False, threads: int = 2, carried: bool = True
) -> LinkModes:
    """Return the lowest natural modes of a link by itself, in the pose of the case's first load case.

    Parameters
    ----------
    case : Case
    link : str
        With a part.
    count : int, optional
        How many.
    solid : bool, optional
        Whether by its solid; else by beams.
    threads : int, optional
        Of the solver.
    carried : bool, optional
        False to leave out what the case states as carried; pins that stand in the link are always there.

    Returns
    -------
    LinkModes
        A single mode of unknown frequency where beams do not stand for the link.

    Raises
    ------
    CaseError
        For a link without part, or a pose that cannot be assembled.
    CannotRunError
        Where mesher or solver fail.
    """
    if link not in case.checked_links:
        raise CaseError(
            f"links.{link}: no link of that name has a part, and so a natural frequency of its own; choose one of "
            f"{', '.join(case.checked_links) or 'none'}"
        )
    case, pose = _standing(case)

    def held(holding: LinkHolding) -> LinkModes:
        if solid:
            return _by_solid(case, link, holding, count, carried, threads)
        return _by_beams(case, link, pose, holding, count, carried)

    tight = link_holding(case, link, pose)
    found, running = held(tight), {name for name, _ in running_holes(case) if link in case.joints[name].links}
    if not running or link == case.linkage.ground:
        return found
    loose = link_holding(case, link, pose, running=running)
    hinged = held(loose).modes
    if len(loose.places) == 1:
        hinged = _with_flapping(found.modes, hinged, loose.free - tight.free)
    return replace(found, modes=with_low_ends(found.modes, hinged))


def _with_flapping(modes: Sequence[Mode], hinged: Sequence[Mode], free: int) -> tuple[Mode, ...]:
    """Modes with hinges beside those with tight pins, of a link on a single pin, which may flap out of the plane on it.

    So many ways to flap have frequency 0, and are not among the modes with hinges. A link on two pins may roll about
    the line through these, which neighbours and washers hinder.
    """
    still = replace(hinged[0], frequency=Band.exact(0.0))
    across = [*[still] * free, *(mode for mode in hinged if mode.in_plane < 0.5)]
    ways = {True: iter([mode for mode in hinged if mode.in_plane >= 0.5]), False: iter(across)}
    return tuple(next(ways[mode.in_plane >= 0.5], still) for mode in modes)


def _standing(case: Case) -> tuple[Case, Pose]:
    """Case and pose as the first load case finds them, with what holds it there."""
    if not (case.pose.equilibrium or case.stops):
        return case, case.stated_pose
    found = stand(case, next(iter(case.load_cases)), part_masses(case) if needs_masses(case) else {})
    return found.case, found.pose


def _by_solid(case: Case, link: str, holding: LinkHolding, count: int, carried: bool, threads: int) -> LinkModes:
    borne = [one for one in all_carried(case, stated=carried) if one.link == link]
    solid = LinkSolid.of(case, link, holding, borne)
    try:
        found = refined_modes(solid, first_mesh(case), count, threads)
    except CaseError as error:
        raise CaseError(f"{link}: {error}") from None
    scatter = compliance_scatter(solid.material)
    modes = tuple(
        Mode(frequency=_scattered(band, scatter), shape=_scaled(shape), in_plane=float(share))
        for band, shape, share in zip(found.frequencies, found.modes.shapes, found.modes.in_plane, strict=True)
    )
    return LinkModes(
        link=link,
        model="solid",
        held=holding.how,
        modes=modes,
        nodes=found.space.nodes,
        pieces=found.space.boundary[:, :3],
    )


def _scattered(band: Band, compliance: Scatter) -> Band:
    """Return the band of a frequency, which goes with the root of the modulus."""
    low, high = band.low / np.sqrt(compliance.high), band.high / np.sqrt(compliance.low)
    sources = [replace(one, width=float(np.sqrt(one.width))) for one in compliance.told]
    return replace(band, low=float(low), high=float(high), sources=distinct(band.sources, tuple(sources)))


def _by_beams(case: Case, link: str, pose: Pose, holding: LinkHolding, count: int, carried: bool) -> LinkModes:
    if link == case.linkage.ground:
        unknown = Mode(frequency=Band.unknown(NO_BEAM), shape=np.zeros((0, 6)), in_plane=1.0)
        return LinkModes(
            link=link,
            model="beam",
            held=holding.how,
            modes=(unknown,),
            nodes=np.zeros((0, 3)),
            pieces=np.zeros((0, 2), dtype=np.int64),
        )
    frame = link_frame(case, link, pose, holding)
    model, parents = divide(frame, SUBDIVISIONS)
    path = EquilibriumPath(model)
    K, _ = stiffness_parts(path, np.zeros((len(model.elements), 2, 6)), np.zeros(len(model.guides)))
    known = {link: part_mass(case, link)}
    mass, even = (mass_matrix(case, frame, model, parents, known, carried=carried, rims=rims) for rims in (True, False))
    found, free = frame_modes(path, K, mass, holding.free + count + BASIS), holding.free
    found = replace(found, values=found.values[free:], vectors=found.vectors[:, free:])
    spread = frame_modes(path, K, even, free + count).values[free:]
    path.elements.stiffness = stiffest(case, frame, model, parents)
    K, _ = stiffness_parts(path, np.zeros((len(model.elements), 2, 6)), np.zeros(len(model.guides)))
    highest = frame_modes(path, K, mass, free + count).values[free:]
    shapes = node_motions(path, found.vectors)
    bands = FlexibilityDoubt(case, frame, model, parents).bands(model, found, shapes, count)
    turn = pose.placement.axes(link)
    modes = []
    for shape, band, most, other in zip(shapes, bands, highest, spread, strict=False):
        band = _weighed(replace(band, high=max(band.high, frequency(float(most)))), frequency(float(other)))
        whole, plane = mass.energies(shape)
        own = np.hstack([shape[:, :3] @ turn, shape[:, 3:] @ turn])
        modes.append(Mode(frequency=band, shape=_scaled(own), in_plane=plane / whole))
    origin = np.array([*pose.origins[link], case.linkage.heights.get(link, 0.0)])
    return LinkModes(
        link=link,
        model="beam",
        held=holding.how,
        modes=tuple(modes),
        nodes=(model.nodes - origin) @ turn,
        pieces=np.array([element.nodes for element in model.elements]),
    )


def _weighed(band: Band, other: float) -> Band:
    """Return the band of a frequency that is another where what fillets weigh is spread along the beams."""
    low, high = sorted((1.0, other / band.value))
    if low == high or not math.isfinite(band.high):
        return band
    source = Source(kind=SourceKind.MASS, detail=reason("at_rims_or_along_beams"), width=high / low)
    return replace(band, low=band.low * low, high=band.high * high, sources=distinct(band.sources, (source,)))


def _scaled(shape: Real) -> Real:
    """Return a shape with the largest displacement 1 mm."""
    return np.asarray(shape / np.linalg.norm(shape[:, :3], axis=1).max())
