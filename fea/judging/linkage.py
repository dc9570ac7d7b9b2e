"""The linkage as a whole: equilibrium that was followed on the deformed shape, else buckling by linear theory.

Sway of the whole linkage is the lowest factor on all loads at which its linear frame becomes unstable
(``alula.fea.nonlinear.stability.buckling_factor``). It leaves out how the frame moves before that, by which a toggle
snaps through at a linear factor of 5.2 (same module): the lower end of its band. Where equilibrium was followed on the
deformed shape (``alula.fea.nonlinear.large_displacement``), as it is below a factor of 10, that answer rules and is the
only outcome: the share of the load that is held, which is the limit-load factor up to 1, with its band. A link that is
no beam is a strip in the frame, and may buckle by itself before it does (``alula.fea.judging.solid_buckling``): then
the lesser factor counts.

Between layers the value has pins as they stand in their holes (``alula.fea.nonlinear.on_rims``), the low end as they
may stand where they hold the linkage least, and the upper end tight ones.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

from alula.fea.asked.asked import Asked
from alula.fea.beam.theory import BeamCheck
from alula.fea.buckling.buckling import asked_of, beyond_strength
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Verdict
from alula.fea.nonlinear.large_displacement import LEAST_FACTOR, LEAST_LINEAR, LargeDisplacement
from alula.fea.nonlinear.on_rims import RimFactors
from alula.fea.nonlinear.stability import ON_RIMS, SNAP, growth

NAME = "large displacement"
NO_EQUILIBRIUM = reason("no_equilibrium")


def linkage_outcomes(
    load_case: str,
    moved: LargeDisplacement,
    beams: Mapping[str, BeamCheck],
    solids: Mapping[str, tuple[float, float]] | None = None,
) -> Iterator[CheckOutcome]:
    """Yield the one outcome of the linkage as a whole; none where its frame never buckles.

    Parameters
    ----------
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it.
    beams : mapping of str to BeamCheck
        Link -> its hand calculation, which says where material gives way first.
    solids : mapping of str to tuple of 2 float, optional
        Link -> the least and the largest factor at which it buckles as a solid. The frame knows it as a strip along x,
        so that the linkage holds no more than this.

    Yields
    ------
    CheckOutcome
    """
    value, least = moved.buckling, moved.factor
    weakest = min(solids, key=lambda link: solids[link][0]) if solids else ""
    own = solids[weakest] if solids else (math.inf, math.inf)
    if moved.followed:
        found = _followed(load_case, moved, beyond_strength(beams))
        soft = found.verdict is Verdict.PASS and own[0] < LEAST_LINEAR
        yield found.left_open(_by_itself(weakest, own[0])) if soft else found
    elif value is not None and least is not None and own[0] < least:
        how = _by_itself(weakest, own[0])
        found = by_linear_theory(
            load_case, own[0], max(own[0], min(value, own[1])), moved.scatter, how, rims=moved.rims
        )
        yield found.because(together(found.reason, beyond_strength(beams)))
    elif value is not None and least is not None and not (math.isinf(value) and _held(moved)):
        how = reason("unstable_by_linear_theory", factor=value)
        if least < value:
            how = reason("dead_point_by_linear_theory", factor=least)
        found = by_linear_theory(load_case, least, value, moved.slack, how, rims=moved.rims)
        yield found.because(together(found.reason, beyond_strength(beams)))


def _held(moved: LargeDisplacement) -> bool:
    assert moved.factor is not None
    return min(moved.factor, math.inf if moved.rims is None else moved.rims.low) >= LEAST_FACTOR


def _by_itself(link: str, factor: float) -> Reason:
    return reason("link_buckles_by_itself", link=link, factor=factor)


def by_linear_theory(
    load_case: str,
    least: float,
    factor: float,
    slack: Scatter,
    how: Reason | str,
    remedy: Reason | None = None,
    rims: RimFactors | None = None,
) -> CheckOutcome:
    """Return the outcome of the linkage by its linear frame.

    The band goes from what a shallow toggle holds to linear theory's factor, each with what load over stiffness may be.

    Parameters
    ----------
    load_case : str
        Its name.
    least : float
        The lesser of ``factor`` and the factor on the displacements that takes the linkage to a dead point.
    factor : float
        On all loads, at which the linear frame becomes unstable.
    slack : Scatter
        Of load over stiffness.
    how : Reason or str
        What happens at ``least``.
    remedy : Reason, optional
        What tells more; by default following its deformed shape.
    rims : RimFactors, optional
        Factors with pins that stand in their holes; none where none may run.

    Returns
    -------
    CheckOutcome
    """
    sources = (*slack.sources, Source(kind=SourceKind.SNAP_THROUGH, detail=reason("linear_theory_too_high")))
    low, holds = least, least / SNAP / slack.high >= 1.0
    if rims is not None and rims.low < least:
        low, sources, how = rims.low, (*sources, ON_RIMS), together(how, on_rims(rims))
        least = min(least, rims.value)
    band = Band(value=least, low=low / SNAP / slack.high, high=factor / slack.low, sources=sources)
    found = asked_of(LINKAGE).outcome(load_case, band, how)
    if found.verdict is Verdict.FAIL:
        return found.because(reason("so_linkage_gives_way", how=how))
    if found.verdict is Verdict.UNDECIDED:
        remedy = remedy or reason("follow_deformed_shape")
        if holds:
            return found.because(together(how, reason("state_fits")))
        return found.because(reason("may_snap_through", how=how, factor=low / SNAP, remedy=remedy))
    if least < LEAST_FACTOR:
        return found.because(reason("displacements_grow", how=how, times=growth(least)))
    return found


def on_rims(rims: RimFactors) -> Reason:
    """Tell at which factors a linkage becomes unstable with pins that stand in their holes.

    Parameters
    ----------
    rims : RimFactors

    Returns
    -------
    Reason
    """
    if rims.value == 0.0:
        return reason("on_rims_leans")
    if rims.low == 0.0:
        return reason("on_rims_may_lean", value=rims.value)
    return reason("on_rims", value=rims.value, low=rims.low)


def no_equilibrium(moved: LargeDisplacement) -> Reason:
    """Tell why there is no equilibrium to judge.

    Parameters
    ----------
    moved : LargeDisplacement
        That gives way.

    Returns
    -------
    Reason
    """
    return reason("equilibrium_unfollowed") if moved.unfollowed else NO_EQUILIBRIUM


def unless_it_gives_way(
    outcomes: Sequence[CheckOutcome], lost: Mapping[str, Reason] | None = None
) -> list[CheckOutcome]:
    """Return outcomes of which none passes that rests on an equilibrium which the linkage does not have.

    Parameters
    ----------
    outcomes : sequence of CheckOutcome
        Of one or several load cases.
    lost : mapping of str to Reason, optional
        Load cases of which no stable equilibrium is known, each with ``no_equilibrium``, besides those under which the
        linkage as a whole fails.

    Returns
    -------
    list of CheckOutcome
        Under these load cases links, pins and gaps between layers that passed are not applicable, nor are points.
        What fails or is open in the undeformed pose stays so. Motors are judged on a rigid linkage and stay.
    """
    why = {**(lost or {}), **{one.load_case: NO_EQUILIBRIUM for one in outcomes if one.gives_way}}
    return [
        _in_no_equilibrium(one, why[one.load_case]) if one.load_case in why and _rests_on_it(one) else one
        for one in outcomes
    ]


def _rests_on_it(outcome: CheckOutcome) -> bool:
    if outcome.subject == LINKAGE:
        return outcome.quantity in (Quantity.LAYER_GAP, Quantity.PERMANENT_SET)
    return outcome.quantity.origin == "loads"


def _in_no_equilibrium(outcome: CheckOutcome, why: Reason) -> CheckOutcome:
    if outcome.verdict is Verdict.PASS or (outcome.subject.kind == "point" and outcome.value.unknowable):
        return outcome.not_applicable(why)
    return outcome.because(together(outcome.reason, why))


def _followed(load_case: str, moved: LargeDisplacement, beyond: Reason | None) -> CheckOutcome:
    """Outcome of the linkage where its equilibrium was followed on the deformed shape: its one limit load."""
    share = moved.held_share
    one = Asked(name=NAME, subject=LINKAGE, quantity=Quantity.LOAD_SHARE, limit=1.0)
    found = one.outcome(load_case, share, share.without)
    linear, rims = moved.buckling is not None and math.isfinite(moved.buckling), moved.rims
    return found.because(
        together(
            moved.reason,
            found.reason if found.verdict is Verdict.UNDECIDED else None,
            None if moved.softness is None else reason("softer_by_solids", times=moved.softness.value),
            reason("linear_buckling_factor", factor=moved.buckling) if linear else None,
            on_rims(rims) if rims is not None and rims.low < (moved.buckling or 0.0) else None,
            beyond,
        )
    )
