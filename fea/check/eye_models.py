"""A link decided by submodels of the few eyes and holes that matter, hand calculation excluding every other place."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from fea.beam.spots import Spot
from fea.beam.theory import BeamCheck
from fea.check.solid_result import PINNED_HOLDS
from fea.check.submodel import Submodel, eye_submodel, hole_submodel
from fea.common.band import Band
from fea.refine.discretisation import holds
from fea.refine.link_series import CasePrecision, Quantity
from fea.refine.refinement import LinkTask, RefinedSolid
from fea.solid.stress import stress_field

HOLDS = ("eyes and holes as solids of their own, cut where the section's stress is linear (2 %)", *PINNED_HOLDS)

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
    found: list[Submodel] = []
    for spot in sorted(wanted, key=lambda spot: spot.kind):  # eyes first, whose submodels cover holes beside them
        if any(covers(cut, spot) for cut in found):
            continue
        cut = None
        if spot.kind == "eye":
            cut = eye_submodel(task, beams, next(p.name for p in task.body.pins if p.x == spot.x))
        elif spot.kind == "hole":
            cut = hole_submodel(task, beams, spot.x)
        if cut is None:
            return ()
        found.append(cut)
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
        if not (precision.known("von_mises") and precision.known("principal")):
            return None
        field = stress_field(solution.space, case.displacement, E=solution.E, nu=solution.nu)
        inside = cut.covered[0] <= field.peak.location[0] <= cut.covered[1]
        found.setdefault(case.load, []).append((precision, inside))
    return {
        load: EyePeaks(von_mises=_band(rows, "von_mises"), principal=_band(rows, "principal"))
        for load, rows in found.items()
    }


def _band(rows: Sequence[tuple[CasePrecision, bool]], quantity: Quantity) -> Band:
    value = max(found.series(quantity).value for found, _ in rows)
    low = min(found.low(quantity) if inside else 0.0 for found, inside in rows)
    high = max(value, *(found.high(quantity) for found, _ in rows))
    meshes = tuple(dict.fromkeys(holds(found.series(quantity)) for found, _ in rows))
    return Band(
        value=value,
        low=min(low, value) * (1.0 - CUT_ERROR),
        high=high * (1.0 + CUT_ERROR),
        holds=(*HOLDS, *meshes),
    )
