"""The cheapest model that decides a link: hand calculation, else a solid model.

The bands of hand calculation are calibrated against solid models (``alula.fea.beam.calibration``). It decides a link
only where no limit on the link, with its stated scatter, lies in them. A solid is solved where it may tell more: not
under loads whose checks are open for other causes wherever in its bands the stress lies
(``alula.fea.refine.beyond_meshes``).
"""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

from alula.fea.beam.calibration import Calibration, Factors, calibration_of, uncalibrated
from alula.fea.beam.critical_locations import CriticalLocation, critical_locations, displacement_estimate
from alula.fea.beam.theory import BeamCheck
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import CONTACT, Source, SourceKind
from alula.fea.refine.beyond_meshes import Ends, OpenRanges, is_open, mesh_may_decide, none_decides
from alula.fea.refine.link_series import PeakQuantity
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import Effort, Progress, RefinedSolid, Told, Watch, refine_links
from alula.fea.solid.layers import in_worst_direction
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.body import extent, reference_line
from alula.geometry.bodies.eyes import eye_reach
from alula.geometry.meshing.mesh import MeshSettings
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.parts.part import Body

Model = Literal["beam", "solid"]


@dataclass(frozen=True, kw_only=True)
class LocationBand:
    """A critical location with the bounds of its stress by hand.

    Attributes
    ----------
    location : CriticalLocation
    von_mises, principal : Band
        Largest von Mises and largest principal stress [MPa].
    """

    location: CriticalLocation
    von_mises: Band
    principal: Band


@dataclass(frozen=True, kw_only=True)
class HandBands:
    """Peaks of a link under one load case by calibrated hand calculation.

    Attributes
    ----------
    von_mises, principal : Band
        Largest von Mises and largest principal stress [MPa].
    displacement : Band
        The largest [mm].
    locations : tuple of LocationBand
        All places, the most stressed first.
    outside : Reason, str or None
        Why the calibration does not hold for this link; None where it does. Then all bands are unknown.
    """

    von_mises: Band
    principal: Band
    displacement: Band
    locations: tuple[LocationBand, ...]
    outside: Reason | str | None

    def deciding(self, *, brittle: bool) -> Band:
        """Return the stress that counts: the principal one of brittle materials.

        Parameters
        ----------
        brittle : bool

        Returns
        -------
        Band
            [MPa]
        """
        return self.principal if brittle else self.von_mises


@dataclass(frozen=True, kw_only=True)
class Decision:
    """Which model decided a link under all load cases, and why.

    Attributes
    ----------
    model : {"beam", "solid", ""}
        "" where hand calculation was asked for and cannot decide.
    why : Reason or str
    next_cost : Reason or None
        What a solid would have cost; None where it ran.
    """

    model: Model | Literal[""]
    why: Reason | str
    next_cost: Reason | None


@dataclass(frozen=True, kw_only=True, eq=False)
class DecidedLink:
    """The decision on one link, and what it stands on.

    Attributes
    ----------
    decision : Decision
    hands : mapping of str to HandBands
        Load case -> bands by hand; empty where none were asked for.
    solid : RefinedSolid or None
        The link's solutions; None where hand calculation decided.
    left : mapping of str to Decision
        Names of loads that no solid was solved under, since it would not change a verdict -> the decision on them.
    """

    decision: Decision
    hands: Mapping[str, HandBands] = field(default_factory=dict)
    solid: RefinedSolid | None = None
    left: Mapping[str, Decision] = field(default_factory=dict)


def decide(
    tasks: Mapping[str, LinkTask],
    beams: Mapping[str, Mapping[str, BeamCheck]],
    start: MeshSettings,
    effort: Effort,
    *,
    fidelity: str,
    first: Mapping[str, TaggedMesh] | None = None,
    lost: Collection[str] = (),
    doubted: Mapping[str, Mapping[str, OpenRanges]] | None = None,
    threads: int | None = None,
    told: Told | None = None,
    watch: Watch = lambda link, found: None,
    progress: Progress = lambda message: None,
) -> dict[str, DecidedLink]:
    """Decide every link by hand where that can, else by a solid.

    Under loads that the linkage gives way to no link passes, and the solid of a link would not change the verdict; nor
    does it where other causes leave its checks open.

    Parameters
    ----------
    tasks : mapping of str to LinkTask
        Link -> what is to be solved; the links on which something acts.
    beams : mapping of str to mapping of str to BeamCheck
        Link -> load case -> its hand calculation.
    start : MeshSettings
        Of the first mesh of a solid.
    effort : Effort
        Accuracy of the solids and what it may cost; where it is stated, solids are taken at once.
    fidelity : {"auto", "solid"}
        "solid" takes solids at once.
    first : mapping of str to TaggedMesh, optional
        First meshes that are there already.
    lost : collection of str, optional
        Names of loads that the linkage gives way to. Solids are not solved under them unless all solids were asked for.
    doubted : mapping of str to mapping of str to OpenRanges, optional
        Link -> name of loads -> within what numbers by hand its checks are open; by default the ``open_ranges`` of its
        task, which leave out loads under which meshes are made finer all the same.
    threads : int, optional
    told, watch : callable, optional
        As of ``refine_links``.
    progress : callable

    Returns
    -------
    dict of str to DecidedLink
        In the order of ``tasks``.

    Raises
    ------
    CannotRunError
        Where a mesh or a solution fails.
    """
    hands: dict[str, dict[str, HandBands]] = {}
    reasons: dict[str, Reason | None] = {}
    found: dict[str, DecidedLink] = {}
    rest: dict[str, LinkTask] = {}
    left: dict[str, dict[str, Decision]] = {}
    for link, task in tasks.items():
        rest[link], left[link] = task, {}
        if fidelity == "solid" or effort.stated or task.beyond_peak:
            asked_for = reason("solid_requested" if fidelity == "solid" else "accuracy_requested")
            reasons[link] = reason("field_requested") if task.beyond_peak and fidelity != "solid" else asked_for
            continue
        hands[link] = _hands(task, beams[link])
        ranges = (doubted or {}).get(link, task.open_ranges)
        decision, reasons[link] = decided_by_hand(task, [*hands[link].values()], ranges)
        beyond = _open_anyway(task, hands[link])
        for names, why in ((lost, left_out), (beyond, left_open)):
            own = [loads.name for loads in rest[link].loads if loads.name in names]
            if decision is not None or not own:
                continue
            without = why(task.body)
            left[link] |= dict.fromkeys(own, without)
            rest[link] = less = rest[link].without(own)
            decision = without
            if less.loads:
                own_hands = [hands[link][loads.name] for loads in less.loads]
                decision, reasons[link] = decided_by_hand(less, own_hands, ranges)
        if decision is not None:
            del rest[link]
            found[link] = DecidedLink(decision=decision, hands=hands[link], left=left[link])
    solids = refine_links(rest, start, effort, first=first, threads=threads, told=told, watch=watch, progress=progress)
    for link, solid in solids.items():
        decision = Decision(model="solid", why=reasons[link] or "", next_cost=None)
        found[link] = DecidedLink(decision=decision, hands=hands.get(link, {}), solid=solid, left=left[link])
    return {link: found[link] for link in tasks}


def _open_anyway(task: LinkTask, hands: Mapping[str, HandBands]) -> frozenset[str]:
    """Names of the loads under which all checks of a link are open wherever in its bands the stress by hand lies."""
    return frozenset(name for name, hand in hands.items() if task.holding is None and _beyond_meshes(task, name, hand))


def _open_for_doubts(task: LinkTask, hands: Sequence[HandBands], ranges: Mapping[str, OpenRanges]) -> Reason | None:
    """Return which limit lies in the band of a stress or displacement once doubts widen it, where a solid may tell."""
    for loads, hand in zip(task.loads, hands, strict=True):
        if loads.name in ranges:
            open_by_hand = ranges[loads.name]
            of_solid = _limited(task, task.open_ranges.get(loads.name, open_by_hand), hand)
            for (band, limit, what, unit), (_, left, *_) in zip(
                _limited(task, open_by_hand, hand), of_solid, strict=True
            ):
                ends = [(band.low, band.high)]
                if is_open(ends, limit) and mesh_may_decide(ends, left):
                    return reason("limit_within", what=what, low=band.low, high=band.high, limit=limit, unit=unit)
    return None


def _limited(task: LinkTask, ranges: OpenRanges, hand: HandBands) -> Iterator[tuple[Band, Ends, str, str]]:
    """Yield the numbers of a link under some loads by hand with the ranges that other causes make of their limits."""
    limits = ranges.limits
    bands: dict[PeakQuantity, tuple[Band, str, str]] = {
        task.measures[0]: (hand.deciding(brittle=task.brittle), "peak stress", "MPa"),
        "displacement": (hand.displacement, "displacement", "mm"),
    }
    for quantity, (band, what, unit) in bands.items():
        yield from ((band, limit, what, unit) for limit in limits.get(quantity, ()))


def _beyond_meshes(task: LinkTask, name: str, hand: HandBands) -> bool:
    if name not in task.open_ranges or hand.outside or _layers_open(task, {name: hand}, task.open_ranges):
        return False
    return none_decides(
        [([(band.low, band.high)], limit) for band, limit, *_ in _limited(task, task.open_ranges[name], hand)]
    )


def left_open(body: Body) -> Decision:
    """Return the decision on a link whose checks are open for other causes than its stress by hand.

    Parameters
    ----------
    body : Body

    Returns
    -------
    Decision
        By hand.
    """
    return Decision(model="beam", why=reason("open_whatever_solid_tells"), next_cost=_solid_cost(body))


def left_out(body: Body) -> Decision:
    """Return the decision on a link whose solid cannot change the verdict.

    Parameters
    ----------
    body : Body

    Returns
    -------
    Decision
        By no model.
    """
    return Decision(model="", why=reason("left_out_of_what_gives_way"), next_cost=_solid_cost(body))


def by_hand(task: LinkTask, beams: Mapping[str, BeamCheck]) -> DecidedLink:
    """Return a link by hand alone, where that was asked for; no model decides it where it has no bands.

    Parameters
    ----------
    task : LinkTask
    beams : mapping of str to BeamCheck
        Load case -> its hand calculation.

    Returns
    -------
    DecidedLink
    """
    hands = _hands(task, beams)
    outside = next((hand.outside for hand in hands.values() if hand.outside), None)
    if outside:
        why = reason("run_solid_of_uncalibrated", outside=outside)
        return DecidedLink(decision=Decision(model="", why=why, next_cost=None), hands=hands)
    why = reason("hand_requested")
    return DecidedLink(decision=Decision(model="beam", why=why, next_cost=None), hands=hands)


def _hands(task: LinkTask, beams: Mapping[str, BeamCheck]) -> dict[str, HandBands]:
    return {loads.name: hand_bands(task, loads, beams[loads.name]) for loads in task.loads}


def hand_bands(task: LinkTask, loads: LinkLoads, beam: BeamCheck) -> HandBands:
    """Return the calibrated bands of a link under one load case.

    Parameters
    ----------
    task : LinkTask
    loads : LinkLoads
    beam : BeamCheck
        The hand calculation of these loads.

    Returns
    -------
    HandBands
    """
    body = task.body
    outside = uncalibrated(body, task.nu)
    found: tuple[CriticalLocation, ...] = ()
    acting, forces = loads.chosen(None), beam.forces.state(None)
    if not outside:
        try:
            found = critical_locations(body, acting, forces, task.nu)
        except CannotRunError as error:
            outside = str(error)
    if outside:
        nothing = Band.unknown(reason("uncalibrated"))
        return HandBands(von_mises=nothing, principal=nothing, displacement=nothing, locations=(), outside=outside)
    calibration = calibration_of(body.part)
    sources = (_source(calibration),)
    rows = [
        LocationBand(
            location=location,
            von_mises=_at_location(location, calibration.factors(location.kind, brittle=False), sources),
            principal=_at_location(location, calibration.factors(location.kind, brittle=True), sources),
        )
        for location in found
    ]
    line = reference_line(body)
    moved = displacement_estimate(body, acting, forces, beam.section, young=task.E, poisson=task.nu, line=line)
    rows.sort(key=lambda row: row.von_mises.high, reverse=True)
    return HandBands(
        von_mises=Band.largest([row.von_mises for row in rows]),
        principal=Band.largest([row.principal for row in rows]),
        displacement=_band(float(moved[0]), calibration.displacement, sources),
        locations=tuple(rows),
        outside=None,
    )


def undecided(task: LinkTask, stresses: Sequence[Band], displacements: Sequence[Band]) -> Reason | None:
    """Return which limit lies in a band of any load case.

    Parameters
    ----------
    task : LinkTask
        Its limits.
    stresses, displacements : sequence of Band
        Of every load case [MPa], [mm].

    Returns
    -------
    Reason or None
        None where all limits are clear of all bands.
    """
    for what, unit, bands, limits in (
        ("peak stress", "MPa", stresses, task.stress_limits),
        ("displacement", "mm", displacements, task.displacement_limits),
    ):
        for limit in limits:
            for band in bands:
                if band.unknowable or (band.low <= limit[1] and limit[0] <= band.high):
                    return reason("limit_within", what=what, low=band.low, high=band.high, limit=limit, unit=unit)
    return None


def _layers_open(task: LinkTask, hands: Mapping[str, HandBands], ranges: Mapping[str, OpenRanges]) -> bool:
    """Whether layers, in the direction that is the worst for them, might not keep their limits with all causes."""
    layers = task.layers
    if layers is None:
        return False
    if layers.between is None:
        return True
    ratio = layers.across / layers.between
    for name, hand in hands.items():
        limits = ranges[name].limits.get("layers", ()) if name in ranges else task.layer_limits
        worst = in_worst_direction(hand.principal.high, hand.von_mises.high, ratio)
        if any(worst > least for least, _ in limits):
            return True
    return False


def decided_by_hand(
    task: LinkTask, hands: Sequence[HandBands], doubted: Mapping[str, OpenRanges] | None = None
) -> tuple[Decision | None, Reason | None]:
    """Return the decision, if hand calculation can make it.

    Parameters
    ----------
    task : LinkTask
    hands : sequence of HandBands
        Of every load case.
    doubted : mapping of str to OpenRanges, optional
        Name of loads -> within what numbers their checks are open; by default the ``open_ranges`` of the task.

    Returns
    -------
    tuple of (Decision or None, Reason or None)
        The decision, and why there is none; None where there is one.
    """
    for hand in hands:
        if hand.outside:
            return None, reason("uncalibrated_since", outside=hand.outside)
    ranges = task.open_ranges if doubted is None else doubted
    named = {loads.name: hand for loads, hand in zip(task.loads, hands, strict=True)}
    if _layers_open(task, named, ranges):
        return None, reason("layers_open_by_hand")
    stresses = [hand.deciding(brittle=task.brittle) for hand in hands]
    open_limit = undecided(task, stresses, [hand.displacement for hand in hands]) or _open_for_doubts(
        task, hands, ranges
    )
    if open_limit:
        return None, reason("open_by_hand", open_limit=open_limit)
    worst = max(range(len(hands)), key=lambda i: stresses[i].high)
    band, location = stresses[worst], hands[worst].locations[0].location
    moved = Band.largest([hand.displacement for hand in hands]) if task.displacement_limits else None
    why = reason(
        "clear_by_hand",
        ends=(band.low, band.high),
        place=location.name,
        limits=tuple(task.stress_limits),
        displacement=None if moved is None else (moved.low, moved.high),
    )
    return Decision(model="beam", why=why, next_cost=_solid_cost(task.body)), None


def _solid_cost(body: Body) -> Reason:
    """Return what a link's first mesh would cost."""
    elements = expected_elements(body)
    return reason("cost_of_solid", elements=elements, seconds=max(1, round(SECONDS * elements)))


SECONDS = 1.0e-3
"""Of meshing, solving and judging per element, on one core."""


def expected_elements(body: Body) -> int:
    """Estimate the elements of a link's first mesh: per width of its length, per eye and per hole.

    Parameters
    ----------
    body : Body

    Returns
    -------
    int
        To two digits.
    """
    first, last = extent(body)
    width = min(body.part.section.width, body.part.section.height)
    plain = last - first - sum(2.0 * eye_reach(body, pin) for pin in body.pins)
    holes = sum(row.count for row in body.holes)
    number = PER_WIDTH * max(plain, 0.0) / width + PER_EYE * len(body.pins) + PER_HOLE * holes
    return int(float(f"{number:.2g}"))


PER_WIDTH, PER_EYE, PER_HOLE = 140.0, 2400.0, 320.0
"""Fitted to the first meshes of the owl wing's links: 5,613 elements of GF, 11,648 of AE, 14,419 of CF."""


def _source(calibration: Calibration) -> Source:
    detail = reason(
        "calibration", parts=calibration.parts, load_cases=calibration.cases, margin=calibration.margin - 1.0
    )
    return Source(kind=SourceKind.CALIBRATION, detail=detail)


def _at_location(location: CriticalLocation, factors: Factors, sources: tuple[Source, ...]) -> Band:
    """Band of the stress at a critical location."""
    return _band(location.estimate, factors, (*sources, CONTACT) if location.kind == "eye" else sources)


def _band(estimate: float, factors: Factors, sources: tuple[Source, ...]) -> Band:
    low, high = estimate * factors.low, estimate * factors.high
    others = math.prod(source.width for source in sources if not math.isnan(source.width))
    ends = factors.low / factors.typical, factors.high / factors.typical / others
    sources = tuple(
        replace(source, width=ends[1] / ends[0], ends=ends) if math.isnan(source.width) else source
        for source in sources
    )
    return Band(value=estimate * factors.typical, low=low, high=high, sources=sources)
