"""A link decided by submodels of the few eyes that matter, every other place being excluded by hand calculation."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from fea.band import Band
from fea.beam import BeamCheck
from fea.link_series import CasePrecision
from fea.refinement import LinkTask, RefinedSolid
from fea.spots import Spot
from fea.stress import stress_field
from fea.submodel import Submodel, submodel

HOLDS = (
    "eyes as solids of their own, cut where the section's stress is linear (2 %)",
    "pin pressure over 180° and over 90°",
)

CUT_ERROR = 0.02
"""What the cut changes of the peak at most: tests/verification/test_submodel.py holds it to that."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EyePeaks:
    """Peaks of one submodel under one load case [MPa]."""

    von_mises: Band
    principal: Band


def plan(
    task: LinkTask,
    beams: Sequence[BeamCheck],
    spots: Sequence[Spot],
    critical: Callable[[Spot], bool],
    cost: Callable[[Submodel], float],
    allowed: float,
) -> tuple[Submodel, ...]:
    """Return the submodels that cover every critical spot; none where they cannot, or would cost more than allowed.

    beams      of the task's load cases; ``spots`` of one of them, since their places are the same in all
    cost       of a submodel, in the unit of ``allowed``
    """
    wanted = [spot for spot in spots if critical(spot)]
    if any(spot.kind == "section" for spot in wanted):
        return ()
    found = []
    for spot in wanted:
        if spot.kind == "eye":
            pin = next(p.name for p in task.body.pins if p.x == spot.x)
            cut = submodel(task, beams, pin)
            if cut is None:
                return ()
            found.append(cut)
    if not all(any(covers(cut, spot) for cut in found) for spot in wanted):
        return ()
    return tuple(found) if sum(map(cost, found)) <= allowed else ()


def covers(cut: Submodel, spot: Spot) -> bool:
    """Whether a spot's stress can be read off a submodel."""
    if spot.kind == "eye":
        return any(pin.x == spot.x for pin in cut.body.pins)
    return spot.kind == "hole" and cut.covered[0] <= spot.low and spot.high <= cut.covered[1]


def peaks(cut: Submodel, refined: RefinedSolid) -> Mapping[str, EyePeaks] | None:
    """Return load case -> peaks of a solved submodel; None where a peak has no limit.

    A peak that lies at a cut, where the load enters, is still an upper bound, but no lower one.
    """
    found: dict[str, list[tuple[CasePrecision, bool]]] = {}
    solution = refined.solution
    for case, precision in zip(solution.cases, refined.precision, strict=True):
        series = (precision.von_mises, precision.principal)
        if precision.sharp is not None or any(s.kind == "growing" for s in series):
            return None
        field = stress_field(solution.space, case.displacement, E=solution.E, nu=solution.nu)
        inside = cut.covered[0] <= field.peak.location[0] <= cut.covered[1]
        found.setdefault(case.load, []).append((precision, inside))
    return {
        load: EyePeaks(von_mises=_band(rows, "von_mises"), principal=_band(rows, "principal"))
        for load, rows in found.items()
    }


def _band(rows: Sequence[tuple[CasePrecision, bool]], quantity: str) -> Band:
    series = [(getattr(precision, quantity), inside) for precision, inside in rows]
    value = max(s.value for s, _ in series)
    low = min(max(s.low, 0.0) if inside else 0.0 for s, inside in series)
    high = max(value, *(s.high for s, _ in series))
    return Band(value=value, low=min(low, value) * (1.0 - CUT_ERROR), high=high * (1.0 + CUT_ERROR), holds=HOLDS)
