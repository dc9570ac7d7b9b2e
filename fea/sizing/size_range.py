"""Which size to seek with ``alula size``, in a range with a value that passes by hand calculation.

A pass keeps its size at one end, and the range goes down from it. Else values above are tried, twice the size and then
up to four times it, or what the case's own rules take of that. The check must pass there, and all others of the case:
so nothing is tried where a link leaves what hand calculation was calibrated for.
"""

import math
from collections.abc import Iterable, Iterator
from itertools import takewhile

from alula.fea.common.change import SizeRange
from alula.fea.common.verdict import MOTOR_QUANTITIES, UNLOADED_QUANTITIES, CheckOutcome, Quantity, Verdict
from alula.fea.frame.displacement_band import shares_of_work
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.sizing.tried import Resized, Trials
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case

REACHES = ((2.0, 1.8, 1.6, 1.4, 1.2), (4.0, 3.5, 3.0, 2.5))
"""Ratios of the ends of the range of a size: of each step the widest that the case's own rules take."""
HOPELESS = 0.5
"""Margin at the end of the next step, by the power law of the last one, below which that step is not tried."""
_DOUBLED = math.log(2.0)
_FARTHEST = REACHES[-1][0] ** -4
"""Margin that no size takes to 1: the most, a second moment of area, goes with its fourth power."""


def size_range(trials: Trials, check: CheckOutcome) -> SizeRange | None:
    """Return the size that bears on a check, with a range in which a value passes.

    Parameters
    ----------
    trials : Trials
        Of the result with the check.
    check : CheckOutcome

    Returns
    -------
    SizeRange or None
        None where no size bears on it, or none that was tried passes.
    """
    found = _entry(trials, check)
    if found is None:
        return None
    case, (path, size) = trials.result.case, found
    if check.verdict is Verdict.PASS:
        below = next(_taken(case, path, [size / reach for reach in REACHES[0]]), None)
        kept = next(_taken(case, path, [size]), None)
        return None if below is None or kept is None else SizeRange(entry=path, first=below, last=_text(size))
    margin, value = check.margin, check.value
    if check.quantity.margins(value.value, value.low, value.high, check.limit)[0] < _FARTHEST:
        return None
    stated = (next(_taken(case, path, [size * reach for reach in step]), "") for step in REACHES)
    larger = [Resized(entry=path, value=text) for text in takewhile(bool, stated)]
    while larger and trials.beyond(check.load_case, larger[-1]):
        larger.pop()
    for step in larger:
        now = trials.expected(check, step)
        if now >= 1.0 and trials.holds(step):
            return SizeRange(entry=path, first=_text(size), last=step.value)
        # By the power law of this step, doubled again.
        if (
            now < 1.0
            and margin > 0.0
            and now * (now / margin) ** (_DOUBLED / math.log(_number(step.value) / size)) < HOPELESS
        ):
            return None
    return None


def _entry(trials: Trials, check: CheckOutcome) -> tuple[str, float] | None:
    """Return the entry of the size that bears on a check, and the size as it is [mm]."""
    case, subject = trials.result.case, check.subject
    if check.quantity in (*MOTOR_QUANTITIES, *UNLOADED_QUANTITIES, Quantity.LAYER_GAP, Quantity.PERMANENT_SET):
        return None
    if subject.kind in ("pin", "joint"):
        path, size = f"joints.{subject.name}.pin_diameter", case.joints[subject.name].pin_diameter
    else:
        moved = trials.result.load_cases[check.load_case].large_displacement
        link = subject.name if subject.kind == "link" else _softest(case, moved)
        part = case.part_of(link) if link else None
        if part is None or not part.main_size:
            return None
        path, size = f"parts.{case.links[link].part}.{part.main_size}", getattr(part, part.main_size)
    return (path, size) if size else None


def _softest(case: Case, moved: LargeDisplacement) -> str:
    """Return the link that takes up most of the work of the loads, of those with a size; "" where no frame tells."""
    if moved.frame is None or moved.solution is None:
        return ""
    works = shares_of_work(case, moved.frame, moved.solution)
    sized = [link for link in works if case.part_of(link).main_size]
    return max(sized, key=lambda link: works[link], default="")


def _text(size: float) -> str:
    return f"{size:g} mm"


def _number(text: str) -> float:
    return float(text.split()[0])


def _taken(case: Case, path: str, sizes: Iterable[float]) -> Iterator[str]:
    """Yield those sizes that the rules of the case take, to two digits; with the one as it is they make a range."""
    for size in sizes:
        text = _text(float(f"{size:.2g}"))
        try:
            case.with_values({path: text})
        except CaseError:
            continue
        yield text
