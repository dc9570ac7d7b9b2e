"""Verdicts and checks in words, for console and page alike."""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from alula.fea.asked.tiers import TierVerdict, tiers_of
from alula.fea.common.verdict import CheckOutcome, Quantity, Sense, Verdict, deciding
from alula.loads.text.caveat import Caveat, Heading
from alula.reports.sentences import told
from alula.reports.sentences.caveats import by_heading
from alula.reports.words.numbers import band, digits_beside, joined, measured, number, plain, sentence
from alula.reports.words.terminal import KEPT

if TYPE_CHECKING:
    from alula.fea.outcomes.result import CheckResult, SectionComparison
    from alula.loads.case.case import Case
    from alula.loads.states.case_motion import CaseMotion

HAND_AGREEMENT = 0.03
"""Largest difference between hand calculation and solid model that needs no explanation."""


def apart(compared: Sequence["SectionComparison"]) -> list["SectionComparison"]:
    """Return the sections at which hand calculation and solid model differ by more than ``HAND_AGREEMENT``.

    Parameters
    ----------
    compared : sequence of SectionComparison

    Returns
    -------
    list of SectionComparison
    """
    return [c for c in compared if abs(c.difference) > HAND_AGREEMENT]


def agreement(compared: Sequence["SectionComparison"]) -> str:
    """Say how well hand calculation and solid model agree over some sections.

    Parameters
    ----------
    compared : sequence of SectionComparison

    Returns
    -------
    str
    """
    if apart(compared):
        return f"they differ by more than {100.0 * HAND_AGREEMENT:g} %"
    most = max(abs(c.difference) for c in compared)
    return f"they agree within {math.ceil(1000.0 * most - 1e-9) / 10.0:.1f} %"


def checks_of(result: "CheckResult") -> tuple[CheckOutcome, ...]:
    """Return all checks of all load cases.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of CheckOutcome
    """
    return tuple(check for load_case in result.load_cases.values() for check in load_case.checks)


BRIEF = 320
"""Characters of a verdict and its reason, four lines of a terminal, beyond which checks are counted alone."""


def headline(result: "CheckResult") -> str:
    """Return the verdict, what decides it and what no check looks at.

    Parameters
    ----------
    result : CheckResult
        All outcomes of a check.

    Returns
    -------
    str
        A few sentences, such as ``Fail: the linkage gives way at 20 % of its load.``
    """
    return " ".join(first_lines(result))


def first_lines(result: "CheckResult") -> tuple[str, ...]:
    """Return the paragraphs of a headline: the verdict and what decides it, its tiers, what no check looks at.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of str
    """
    told = opening(result.case, result.verdict, checks_of(result), several=len(result.load_cases) > 1)
    return tuple(filter(None, (*told, besides(result.caveats))))


def opening(
    case: "Case", verdict: Verdict, checks: Sequence[CheckOutcome], *, several: bool, short: bool = False
) -> tuple[str, ...]:
    """Return a verdict and what decides it, then a line for each of its tiers.

    Parameters
    ----------
    case : Case
    verdict : Verdict
    checks : sequence of CheckOutcome
        All of them.
    several : bool
        Whether there are several load cases, which are then named.
    short : bool, optional
        True for counts in place of many names.

    Returns
    -------
    tuple of str
    """
    tiers = tiers_of(case, checks)
    return (brief if short else decision)(verdict, checks, several=several, tiers=tiers), *tier_lines(
        tiers, several=several
    )


MOST_NAMED = 3
"""Unasked links that the line of a tier names, at its end; how many are asked stands first, where no screen cuts it."""
_MISSED = {Sense.AT_LEAST: "<", Sense.AT_MOST: ">"}


def tier_lines(tiers: Iterable[TierVerdict], *, several: bool) -> tuple[str, ...]:
    """Return a line for each tier of a verdict: its verdict and what decides it, or what asks for it.

    Parameters
    ----------
    tiers : iterable of TierVerdict
    several : bool
        Whether there are several load cases, which are then named.

    Returns
    -------
    tuple of str
        Such as ``Stays elastic: FAIL, safety factor of crank 0.812 (0.704 to 0.922) < 1.5.``
    """
    return tuple(f"{sentence(one.tier)[:-1]}: {_of_tier(one, several=several)}" for one in tiers)


def _of_tier(one: TierVerdict, *, several: bool) -> str:
    check = one.decides
    if check is None and not one.links:
        return "not asked of links that break before they yield."
    if check is None:
        return f"not asked; a check of type {one.asks} asks for it."
    stands, asked = _stands(check, several=several), len(one.links) - len(one.unasked)
    if not one.unasked or check.verdict is Verdict.FAIL:
        return f"{check.verdict.upper()}, {stands}."
    if not asked and check.verdict is Verdict.PASS:
        return f"not asked of whole links (add a {one.asks} check); all else passes, {stands}."
    extent = " for" if check.verdict is Verdict.PASS else ", asked of"
    names = f"; not asked of {joined(one.unasked)}" if len(one.unasked) <= MOST_NAMED else ""
    return f"{check.verdict.upper()}{extent} {asked or 'none'} of {len(one.links)} links: {stands}{names}."


def _stands(check: CheckOutcome, *, several: bool) -> str:
    """Return how a check stands to its limit, such as ``safety factor of AE (dive) 2.5 (2.1 to 2.9) ≥ 2``."""
    if not check.applies:
        return f"{named(check)} is not applicable"
    if check.quantity is Quantity.LOAD_SHARE and check.verdict is Verdict.FAIL:
        return "the linkage gives way"
    sense, under = check.quantity.sense, f" ({check.load_case})" if several and not check.shared else ""
    sign = {Verdict.PASS: f" {sense.value}", Verdict.FAIL: f" {_MISSED[sense]}"}.get(
        check.verdict, f", limit {sense.value}"
    )
    value = band(check.value, digits_beside(check.value, check.limit))
    return f"{named(check)}{under} {value}{sign}{KEPT}{plain(check.limit)} {check.unit}".rstrip()


def besides(found: Iterable[Caveat], of: str = "") -> str:
    """Return what a verdict stands on besides as sentences; empty where there is nothing.

    Parameters
    ----------
    found : iterable of Caveat
    of : str, optional
        Behind each heading, of what it is, such as `` (proof)``.

    Returns
    -------
    str
        Such as ``Assumed: pins of steel-wire (no pin_material stated). Not checked: vibration (no check).``
    """
    order = (Heading.ASSUMED, Heading.UNUSUAL, Heading.NOT_CHECKED)
    by_order = sorted(found, key=lambda one: order.index(one.heading))
    return " ".join(f"{heading}{of}: {told}" for heading, told in by_heading(by_order, short=True))


def decision(
    verdict: Verdict,
    checks: Sequence[CheckOutcome],
    *,
    several: bool,
    names: bool = True,
    tiers: Sequence[TierVerdict] = (),
) -> str:
    """Return a verdict and what decides it.

    Parameters
    ----------
    verdict : Verdict
    checks : sequence of CheckOutcome
        All of them.
    several : bool
        Whether there are several load cases, which are then named.
    names : bool
        Whether the checks that decide are named.
    tiers : sequence of TierVerdict
        That are told beside it: what decides one of them is not told twice.

    Returns
    -------
    str
        A sentence or two, such as ``Undecided: 1 of 2 checks is open: safety factor of rod. Safety factor of rod: its
        band 1.9 to 2.2 straddles the limit 2.``
    """
    if not checks:
        return "Undecided: the case contains no check."
    count, found = len(checks), deciding(checks)
    chosen, first = {id(check) for check in found}, found[0]
    besides_them = not any(first is one.decides for one in tiers)
    if verdict is Verdict.PASS:
        kept = "the only check keeps its limit" if count == 1 else f"all {count} checks keep their limits"
        closest = f" Closest to its limit: {_with_limit(first, several=several)}." if besides_them else ""
        return f"Pass: {kept} over the whole error band.{closest}"
    named_all = f": {_all_named(check for check in checks if id(check) in chosen)}" if names else ""
    share = f"{len(found)} of {count} checks"
    if verdict is Verdict.UNDECIDED:
        verb = "is" if len(found) == 1 else "are"
        return f"Undecided: {share} {verb} open{named_all}. {sentence(f'{named(first)}: {told(first.reason)}')}"
    missed = f"{share} {'misses its limit' if len(found) == 1 else 'miss their limits'} over the whole error band"
    if first.quantity is Quantity.LOAD_SHARE:
        return f"Fail: {_under(first, several=several)}{gives_way(first)}. {missed}{named_all}."
    worst = f" Worst: {_with_limit(first, several=several)}." if besides_them else ""
    return f"Fail: {missed}{named_all}.{worst}"


def brief(verdict: Verdict, checks: Sequence[CheckOutcome], *, several: bool, tiers: Sequence[TierVerdict] = ()) -> str:
    """Return a verdict and what decides it, without the names of all checks that do where they are many.

    Parameters
    ----------
    verdict : Verdict
    checks : sequence of CheckOutcome
    several, tiers
        As for ``decision``.

    Returns
    -------
    str
    """
    told = decision(verdict, checks, several=several, tiers=tiers)
    return told if len(told) <= BRIEF else decision(verdict, checks, several=several, tiers=tiers, names=False)


def inapplicable(checks: Iterable[CheckOutcome]) -> list[str]:
    """Tell the checks that are not applicable together, in one line for each reason.

    Parameters
    ----------
    checks : iterable of CheckOutcome
        All of them; load cases are named where there are several.

    Returns
    -------
    list of str
        Such as ``Not applicable, 2 checks: the linkage gives way. Safety factor of AE; buckling factor of AE.``
    """
    checks = list(checks)
    several, groups = len({check.load_case for check in checks}) > 1, dict[str, list[CheckOutcome]]()
    for check in checks:
        if not check.applies:
            groups.setdefault(told(check.reason), []).append(check)
    return [
        f"Not applicable, {len(group)} check{'s' if len(group) > 1 else ''}: {reason}. "
        + sentence("; ".join(_gathered(group, several=several)))
        for reason, group in groups.items()
    ]


def _gathered(checks: Iterable[CheckOutcome], *, several: bool) -> Iterator[str]:
    """Yield each quantity with all that it is asked of; load cases that ask it of the same share a line."""
    asked: dict[tuple[Quantity, str], dict[str, None]] = {}
    for check in checks:
        asked.setdefault((check.quantity, check.load_case), {})[str(check.subject)] = None
    alike: dict[tuple[Quantity, tuple[str, ...]], list[str]] = {}
    for (quantity, load_case), names in asked.items():
        alike.setdefault((quantity, tuple(names)), []).append(load_case)
    for (quantity, subjects), load_cases in alike.items():
        yield f"{quantity} of {joined(subjects)}" + (f" under {joined(load_cases)}" if several else "")


def gives_way(check: CheckOutcome) -> str:
    """Return at which share of its load a linkage gives way, in words.

    Parameters
    ----------
    check : CheckOutcome
        Of the share of the load that a linkage holds.

    Returns
    -------
    str
    """
    value = check.value
    shown, low, high = (number(min(100.0 * share, 99.0), 2) for share in (value.value, value.low, value.high))
    return f"the linkage gives way at {shown} %{'' if low == high else f' ({low} to {high} %)'} of its load"


def named(check: CheckOutcome, *, long: bool = False) -> str:
    """Return what a check is about in a few words, such as ``safety factor of AE``.

    Parameters
    ----------
    check : CheckOutcome
    long : bool, optional
        True for ``safety factor of link AE``.

    Returns
    -------
    str
    """
    if check.quantity is Quantity.LOAD_SHARE:
        return "share of the load that the linkage holds"
    return f"{check.quantity} of {check.subject.long if long else check.subject}"


def _all_named(checks: Iterable[CheckOutcome]) -> str:
    """Return what checks are about, each quantity once, and the load cases of one that is asked under several.

    Such as ``safety factor of AE (dive, rest) and BC; buckling factor of AE``.
    """
    groups: dict[Quantity, dict[tuple[str, ...], dict[str, CheckOutcome]]] = {}
    asked: dict[tuple[Quantity, str], list[CheckOutcome]] = {}
    for check in checks:
        asked.setdefault((check.quantity, str(check.subject)), []).append(check)
    for (quantity, subject), found in asked.items():
        cases = tuple(dict.fromkeys(check.load_case for check in found))
        groups.setdefault(quantity, {}).setdefault(cases if len(cases) > 1 else (), {})[subject] = found[0]
    texts = []
    for quantity, alike in groups.items():
        own = [joined(list(names)) + (f" ({', '.join(cases)})" if cases else "") for cases, names in alike.items()]
        found = [check for names in alike.values() for check in names.values()]
        if len(found) == 1:
            texts.append(named(found[0]) + own[0].removeprefix(str(found[0].subject)))
        else:
            texts.append(f"{quantity} of {', '.join(own)}")
    return joined(texts) if len(texts) == len(asked) else "; ".join(texts)


def _under(check: CheckOutcome, *, several: bool) -> str:
    if check.shared or not several:
        return ""
    return f"under load case {check.load_case} "


def _with_limit(check: CheckOutcome, *, several: bool) -> str:
    """Return a check's quantity, its value with the band, and its limit."""
    unit = f" {check.quantity.unit}".rstrip()
    under, sign = f" {_under(check, several=several)}".rstrip(), check.quantity.sense.value
    value = measured(check.value, check.quantity.unit, digits_beside(check.value, check.limit))
    return f"{named(check, long=True)}{under}, {value}; limit {sign} {plain(check.limit)}{unit}"


def told_speed(moved: "CaseMotion", load_case: str) -> str:
    """Return the speed of the coordinate in a load case, from its least to its largest where it changes.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str

    Returns
    -------
    str
        In rpm, or in mm/s of a travel.
    """
    speed, slides = moved.moved[load_case].speed, moved.motion.coordinate.slides
    told = [
        number(end) if slides else plain(float(f"{end * 30.0 / math.pi:.4g}")) for end in (speed.min(), speed.max())
    ]
    return f"{' to '.join(dict.fromkeys(told))} {'mm/s' if slides else 'rpm'}"
