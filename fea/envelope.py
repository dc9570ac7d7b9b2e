"""The whole motion of a case: the least safety factor of each link over all poses and load cases, where and when."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fea.band import Band
from fea.check import DRIVEN_HOLDS, PINNED_HOLDS
from fea.critical import critical_node
from fea.fatigue import LIFE_FACTOR, STRESS_FACTOR, FatigueLife, fatigue_life, missing_data, strength_at
from fea.link_history import LinkHistory, link_histories
from fea.outcomes import least_safety_factor, reason_for
from fea.peaks import Peaks, principal_peaks, von_mises_peaks
from fea.solid import IMBALANCE_LIMIT, REACTION_LIMIT, LineReference
from fea.space import DisplacementSpace, displacement_space
from fea.stress import StressField, stress_field
from fea.supports import rigid_motions
from fea.threads import bounded
from fea.traction import Transfer
from fea.unit_loads import TRANSFERS, load_scale, unit_loads
from fea.unit_solutions import UnitSolutions, solve_units
from fea.verdict import SAFETY_FACTOR, CheckOutcome, Verdict, at_least, overall
from geometry.errors import CannotRunError, CaseError
from geometry.material import Material
from geometry.mesh import MeshSettings, mesh_bodies
from geometry.tagged_mesh import TaggedMesh
from loads.bearing import NARROW, WIDE, PressureLaw, Span
from loads.case import Case
from loads.case_motion import CaseMotion, solve_case_motion
from loads.check_spec import SafetyFactorCheck
from loads.statics import Drive

Real = NDArray[np.float64]
Progress = Callable[[str], None]

TORQUE_GROWTH = 20.0
"""Of the drive torque towards a dead point, beside that at the best leverage, beyond which poses are left out."""
FATIGUE_STRESS = "fatigue strength over stress"
FATIGUE_LIFE = "life over repetitions"
LAWS = (WIDE, NARROW)


@dataclass(frozen=True, kw_only=True, eq=False)
class VariantCurve:
    """The decisive stress over the motion under one model of pin pressure and one of torque transfer.

    stress    (n,) largest of all nodes at each pose [MPa]; NaN where the pose was left out
    node      (n,) where; -1 where the pose was left out
    first     number of its first load in the link's ``UnitSolutions``
    """

    span: Span
    transfer: Transfer | None
    stress: Real
    node: NDArray[np.int64]
    first: int

    @property
    def peak(self) -> float:
        """Largest stress of the motion [MPa]."""
        return float(np.nanmax(self.stress))


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkFatigue:
    """Fatigue of a link under one load case, the motion repeated for ever.

    location     (3,) of the critical node in the link's frame [mm]
    history      (n,) its signed stress over the motion [MPa]
    life         of the variant that governs
    stress       band of the equivalent peak stress [MPa]
    wanted       repetitions that are asked for
    strength     peak stress borne for as many cycles [MPa]; None where the card does not tell
    repetitions  band of the life; None where the card has no exponent
    """

    location: Real
    history: Real
    life: FatigueLife
    stress: Band
    wanted: float
    strength: float | None
    repetitions: Band | None


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadCaseEnvelope:
    """A link over the motion under one load case.

    value, low, high  (n,) decisive stress at each pose and its band [MPa]; NaN where the pose was left out
    stress, safety_factor  of the worst pose, with their bands over the whole motion
    pose, location    when and where: number of the pose, place (3,) in the link's frame [mm]
    """

    name: str
    variants: tuple[VariantCurve, ...]
    governing: VariantCurve
    value: Real
    low: Real
    high: Real
    stress: Band
    safety_factor: Band
    pose: int
    location: Real
    fatigue: LinkFatigue | None


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkEnvelope:
    """A link over the motion under every load case that loads it.

    measure   the decisive stress: "von Mises" or "largest principal"
    strength  what it is set against [MPa]
    units, modes  unit loads, and solutions that span the motion's loads
    field, displacement  stress and displacements (nodes, 3) [mm] of the worst pose under the worst load case
    no_fatigue  why there is no fatigue calculation; empty where there is one
    """

    link: str
    measure: str
    strength: float
    load_cases: Mapping[str, LoadCaseEnvelope]
    elements: int
    unknowns: int
    units: int
    modes: int
    solver: str
    reaction: float
    imbalance: float
    field: StressField
    displacement: Real
    no_fatigue: str
    notes: tuple[str, ...]

    @property
    def worst(self) -> LoadCaseEnvelope:
        """The load case with the least safety factor, by the low end of its band."""
        return min(self.load_cases.values(), key=lambda found: (found.safety_factor.low, found.safety_factor.value))


@dataclass(frozen=True, kw_only=True, eq=False)
class EnvelopeResult:
    """The envelope of a case.

    angles       (n,) of the motion's coordinate [rad]
    drive_angles (n,) of the driven link [rad]
    evaluated    (n,) False where a pose was left out
    idle         links on which nothing acts
    checks       outcome of every check, for every link and load case
    """

    name: str
    case: Case
    moved: CaseMotion
    drive: Drive
    angles: Real
    drive_angles: Real
    evaluated: NDArray[np.bool_]
    links: Mapping[str, LinkEnvelope]
    idle: tuple[str, ...]
    checks: tuple[CheckOutcome, ...]
    verdict: Verdict
    warnings: tuple[str, ...]
    timings: Mapping[str, float]


def envelope_case(
    case: Case,
    *,
    name: str = "",
    threads: int = 2,
    repetitions: float | None = None,
    growth: float = TORQUE_GROWTH,
    progress: Progress = lambda message: None,
) -> EnvelopeResult:
    """Check every link of a case over its motion, under every load case.

    name         path or built-in name of the case, for the report
    repetitions  of the motion that are wanted, for fatigue; the cycles of the material's card when left out
    growth       of the drive torque towards a dead point, beyond which poses are left out

    Raises ``CaseError`` for a case without motion, drive or part, ``CannotRunError`` where a stage fails.
    """
    begin = time.perf_counter()
    if not case.checked_links:
        raise CaseError("envelope: no moving link has a part, so there is no stress; give a link a part")
    moved = solve_case_motion(case)
    evaluated = evaluated_poses(moved, growth)
    if not evaluated.any():
        raise CannotRunError(
            f"envelope: no pose is left, since the drive torque grows beyond {growth:g} times everywhere; drive "
            "another link or allow a larger growth"
        )
    histories = {link: tuple(h for h in link_histories(moved, link) if _acts(h)) for link in case.checked_links}
    loaded = {link: found for link, found in histories.items() if found}
    timings = {"motion": time.perf_counter() - begin}
    progress(f"Meshing {len(loaded)} links ...")
    begin = time.perf_counter()
    settings = MeshSettings(curved=case.solid.curved).scaled(case.solid.mesh_size)
    meshes = mesh_bodies({link: case.body(link) for link in loaded}, settings)
    timings["meshing"] = time.perf_counter() - begin
    links = {}
    begin = time.perf_counter()
    for link, found in loaded.items():
        count = int(evaluated.sum())
        progress(f"Solving {link}: {len(meshes[link].cells)} elements, {count} poses, {len(found)} load cases ...")
        with bounded(threads):
            links[link] = link_envelope(
                meshes[link],
                link=link,
                material=case.material_of(link),
                histories=found,
                evaluated=evaluated,
                stated=case.drive.transfer if case.drive else None,
                returns=moved.motion.returns,
                repetitions=repetitions,
                threads=threads,
            )
    timings["solid models"] = time.perf_counter() - begin
    complete = bool(evaluated.all())
    checks = tuple(_outcomes(case, links, complete=complete))
    return EnvelopeResult(
        name=name,
        case=case,
        moved=moved,
        drive=moved.drive,
        angles=moved.motion.angles,
        drive_angles=moved.motion.angle(moved.drive.link),
        evaluated=evaluated,
        links=links,
        idle=tuple(link for link in histories if link not in loaded),
        checks=checks,
        verdict=overall(check.verdict for check in checks),
        warnings=tuple(_warnings(case, moved, evaluated, growth)),
        timings=timings,
    )


def evaluated_poses(moved: CaseMotion, growth: float = TORQUE_GROWTH) -> NDArray[np.bool_]:
    """Poses (n,) whose stress means something.

    Near a dead point of the driven link the torque that a load asks for grows as one over the leverage.
    Where the motion holds such a point, poses are left out whose leverage is less than one ``growth``-th of
    the best one; and in any motion those at which there is no torque at all.
    """
    good = np.ones(len(moved.motion.angles), dtype=np.bool_)
    for solved in moved.forces.values():
        good &= np.isfinite(solved.torque)
        if moved.dead_points:
            good &= solved.leverage * growth >= solved.leverage.max()
    return good


def link_envelope(
    mesh: TaggedMesh,
    *,
    link: str,
    material: Material,
    histories: Sequence[LinkHistory],
    evaluated: NDArray[np.bool_],
    stated: Transfer | None,
    returns: bool,
    repetitions: float | None = None,
    threads: int | None = None,
) -> LinkEnvelope:
    """Solve one link over a motion.

    histories  its loads, one record per load case
    evaluated  (n,) the poses that count
    stated     how the drive torque enters, by the case; the other way stands in the band
    returns    True where the last pose is the first again; else the motion goes there and back

    Raises ``CannotRunError`` for loads that do not balance, supports that react, or a failing solver.
    """
    space = displacement_space(mesh)
    chosen = [_at(history, evaluated) for history in histories]
    units = unit_loads(space, chosen, density=material.density)
    size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))
    names: list[tuple[int, PressureLaw, Transfer | None]] = []
    columns, scales = [], []
    for i, history in enumerate(chosen):
        torque = any(np.any(t != 0.0) for t in (*history.couples.values(), *(p[:, 2] for p in history.pins.values())))
        scale = load_scale(history, size)
        for law in LAWS:
            for transfer in TRANSFERS if torque else (None,):
                names.append((i, law, transfer))
                columns.append(units.coefficients(history, law, transfer))
                scales.append(np.where(scale > 0.0, scale, scale.max()))
    solved = solve_units(
        units,
        np.hstack(columns),
        np.concatenate(scales),
        E=material.youngs_modulus,
        nu=material.poissons_ratio,
        threads=threads,
    )
    _balanced(link, solved)
    peaks = (principal_peaks if material.brittle else von_mises_peaks)(solved.stress, solved.combination)
    lacking = missing_data(material)
    if not lacking and not evaluated.all():
        lacking = "poses near a dead point are left out, so the stress history is not closed"
    poses = int(evaluated.sum())
    found = {}
    for i, history in enumerate(chosen):
        variants = [
            _curve(law, transfer, peaks, number * poses, evaluated)
            for number, (case, law, transfer) in enumerate(names)
            if case == i
        ]
        own = [v for v in variants if v.transfer in (None, stated)]
        fatigue = None if lacking else _fatigue(solved, material, variants, own, poses, returns, repetitions)
        found[history.load_case] = _load_case(space.nodes, history.load_case, material, variants, own, fatigue)
    worst = min(found.values(), key=lambda f: (f.safety_factor.low, f.safety_factor.value))
    number = worst.governing.first + int(np.count_nonzero(evaluated[: worst.pose]))
    pins = histories[0].body.pins
    raw = solved.field(number)
    return LinkEnvelope(
        link=link,
        measure="largest principal" if material.brittle else "von Mises",
        strength=material.allowable,
        load_cases=found,
        elements=len(space.cells),
        unknowns=space.unknowns,
        units=solved.units,
        modes=len(solved.combination),
        solver=solved.solver,
        reaction=float(solved.reaction.max()),
        imbalance=float(solved.imbalance.max()),
        field=stress_field(space, raw, E=material.youngs_modulus, nu=material.poissons_ratio),
        displacement=_relative(space, (f"bore:{pins[0].name}", f"bore:{pins[-1].name}"), raw),
        no_fatigue=lacking,
        notes=mesh.notes,
    )


def _acts(history: LinkHistory) -> bool:
    """Return True if anything but zeros acts on the link at some pose."""
    loads = (*history.pins.values(), *history.couples.values(), *history.ends.values())
    inert = history.mass is not None and np.any(history.acceleration != 0.0)
    return bool(inert or history.lines or any(np.any(np.nan_to_num(load) != 0.0) for load in loads))


def _at(history: LinkHistory, poses: NDArray[np.bool_]) -> LinkHistory:
    """Return the history at the chosen poses alone."""
    return replace(
        history,
        pins={name: loads[poses] for name, loads in history.pins.items()},
        couples={name: torque[poses] for name, torque in history.couples.items()},
        ends={name: loads[poses] for name, loads in history.ends.items()},
        lines=tuple(replace(line, intensity=line.intensity[poses]) for line in history.lines),
        acceleration=history.acceleration[poses],
    )


def _balanced(link: str, solved: UnitSolutions) -> None:
    """Refuse loads that do not balance and supports that react."""
    for what, values, limit in (
        ("the loads leave a resultant", solved.imbalance, IMBALANCE_LIMIT),
        ("the supports of the free body react", solved.reaction, REACTION_LIMIT),
    ):
        if not values.max() <= limit:
            raise CannotRunError(
                f"{link}: {what} of {values.max():.2%} of the load (at most {limit:.1%}): load and stress do not "
                "balance"
            )


def _relative(space: DisplacementSpace, line: tuple[str, str], field: Real) -> Real:
    """Displacements relative to the line through the link's first and last pin."""
    motions = rigid_motions(space.nodes, space.nodes.mean(axis=0))
    return LineReference(space, motions, line).relative(field)


def _curve(
    law: PressureLaw, transfer: Transfer | None, peaks: Peaks, first: int, evaluated: NDArray[np.bool_]
) -> VariantCurve:
    stress, node = np.full(len(evaluated), np.nan), np.full(len(evaluated), -1)
    part = slice(first, first + int(evaluated.sum()))
    stress[evaluated], node[evaluated] = peaks.value[part], peaks.node[part]
    return VariantCurve(span=law.span, transfer=transfer, stress=stress, node=node, first=first)


def _load_case(
    nodes: Real,
    name: str,
    material: Material,
    variants: Sequence[VariantCurve],
    own: Sequence[VariantCurve],
    fatigue: LinkFatigue | None,
) -> LoadCaseEnvelope:
    governing = max(own, key=lambda v: v.peak)
    pose = int(np.nanargmax(governing.stress))
    every = np.array([v.stress for v in variants])
    holds = PINNED_HOLDS if governing.transfer is None else DRIVEN_HOLDS
    # No tension anywhere makes no stress that breaks a brittle part.
    peak = Band.around(max(governing.peak, 0.0), tuple(max(v.peak, 0.0) for v in variants), *holds)
    return LoadCaseEnvelope(
        name=name,
        variants=tuple(variants),
        governing=governing,
        value=np.array([v.stress for v in own]).max(axis=0),
        low=every.min(axis=0),
        high=every.max(axis=0),
        stress=peak,
        safety_factor=peak.inverse(material.allowable),
        pose=pose,
        location=nodes[governing.node[pose]].copy(),
        fatigue=fatigue,
    )


def closed_history(history: Real, *, returns: bool) -> Real:
    """Return one repetition (n,) of a motion's history: a full turn, or there and back."""
    return history[:-1] if returns else np.concatenate([history, history[-2:0:-1]])


def _fatigue(
    solved: UnitSolutions,
    material: Material,
    variants: Sequence[VariantCurve],
    own: Sequence[VariantCurve],
    poses: int,
    returns: bool,
    repetitions: float | None,
) -> LinkFatigue:
    assert material.fatigue is not None
    lives, places = {}, {}
    for variant in variants:
        part = solved.combination[:, variant.first : variant.first + poses]
        places[id(variant)] = critical_node(solved.stress, part, material)
        lives[id(variant)] = fatigue_life(closed_history(places[id(variant)][1], returns=returns), material)
    governing = max(own, key=lambda v: lives[id(v)].stress)
    life, (node, history) = lives[id(governing)], places[id(governing)]
    holds = PINNED_HOLDS if governing.transfer is None else DRIVEN_HOLDS
    wanted = material.fatigue.cycles if repetitions is None else repetitions
    counts = [found.repetitions for found in lives.values() if found.repetitions is not None]
    band = None if life.repetitions is None else Band.around(life.repetitions, tuple(counts), *holds)
    return LinkFatigue(
        location=solved.space.nodes[node].copy(),
        history=history,
        life=life,
        stress=Band.around(life.stress, tuple(found.stress for found in lives.values()), *holds),
        wanted=wanted,
        strength=strength_at(material.fatigue, wanted),
        repetitions=band,
    )


def _outcomes(case: Case, links: Mapping[str, LinkEnvelope], *, complete: bool) -> list[CheckOutcome]:
    found = []
    for name, check in case.all_checks.items():
        if isinstance(check, SafetyFactorCheck):
            for link in (x for x in check.links or case.checked_links if x in links):
                limit = least_safety_factor(name, check.minimum, case.material_of(link), link)
                for title, load_case in links[link].load_cases.items():
                    found.append(
                        _outcome(name, link, title, SAFETY_FACTOR, load_case.safety_factor, limit, complete=complete)
                    )
    for link, envelope in links.items():
        for title, load_case in envelope.load_cases.items():
            fatigue = load_case.fatigue
            if fatigue is None:
                continue
            if fatigue.strength is not None:
                factor = fatigue.stress.inverse(fatigue.strength)
                found.append(_outcome("fatigue", link, title, FATIGUE_STRESS, factor, STRESS_FACTOR))
            if fatigue.repetitions is not None:
                share = _scaled(fatigue.repetitions, 1.0 / fatigue.wanted)
                found.append(_outcome("fatigue", link, title, FATIGUE_LIFE, share, LIFE_FACTOR))
    return found


def _scaled(band: Band, factor: float) -> Band:
    return Band(value=factor * band.value, low=factor * band.low, high=factor * band.high, holds=band.holds)


def _outcome(
    name: str, link: str, load_case: str, quantity: str, value: Band, limit: float, *, complete: bool = True
) -> CheckOutcome:
    verdict = at_least(value, limit)
    reason = reason_for(value, limit, verdict)
    if verdict is Verdict.PASS and not complete:
        verdict = Verdict.UNDECIDED
        reason = "poses near a dead point of the driven link were left out, where its torque grows without bound"
    return CheckOutcome(
        name=name,
        link=link,
        load_case=load_case,
        quantity=quantity,
        unit="",
        value=value,
        limit=limit,
        verdict=verdict,
        reason=reason,
    )


def _warnings(case: Case, moved: CaseMotion, evaluated: NDArray[np.bool_], growth: float) -> list[str]:
    found = []
    left_out = int(np.count_nonzero(~evaluated))
    if moved.dead_points:
        at = ", ".join(f"{math.degrees(angle):.2f}" for angle in moved.dead_points)
        found.append(
            f"the driven link {moved.drive.link} turns back at {at} deg of {moved.motion.coordinate}, so it cannot "
            f"drive the linkage through there; {left_out} of {len(evaluated)} poses are left out, where the torque is "
            f"more than {growth:g} times what it would be at the best leverage"
        )
    elif left_out:
        found.append(f"{left_out} of {len(evaluated)} poses are left out, since no drive torque holds them")
    others = [name for name, check in case.all_checks.items() if not isinstance(check, SafetyFactorCheck)]
    if others:
        found.append(f"checks {', '.join(others)} are about single poses or the motor: alula check decides them")
    if case.large_displacement != "off":
        found.append("links are taken as rigid in the motion: equilibrium is that of the undeformed linkage")
    return found
