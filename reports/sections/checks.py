"""Checks against their limits, and how they are decided: of a pose, of a motion, of anything with outcomes."""

from collections import Counter
from collections.abc import Iterable, Sequence

from alula.fea.asked.tiers import tiers_of
from alula.fea.common.verdict import (
    UNLOADED_QUANTITIES,
    CheckOutcome,
    Quantity,
    Verdict,
    by_nearness,
    reason_for,
    what_decides,
    worst_of_each,
)
from alula.loads.case.case import Case
from alula.reports.sections.data import entries
from alula.reports.sections.markup import bold, link
from alula.reports.sections.section import Folded, Items, Part, Section, Text, say
from alula.reports.sections.table import Column, Mark, Number, Table, words
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import inapplicable, named
from alula.reports.words.numbers import digits_beside, joined, sentence

MOST = 8
"""Checks that the first screen of a page shows; the others stand below."""
_MEANING = {
    Verdict.PASS: "{where} and under these loads every check keeps its limit, even at the unfavourable end of its "
    "error band.",
    Verdict.FAIL: "At least one check misses its limit, even at the favourable end of its error band.",
    Verdict.UNDECIDED: "At least one check is open: its limit lies inside its error band, or no model that ran can "
    "decide it. This is neither a pass nor a fail.",
}
JUDGED = (
    Column("value (band)", role="value"),
    Column("limit", role="limit"),
    words("verdict", role="found"),
)
_TELLING = (Quantity.DRIVE_POWER, Quantity.LAYERS, Quantity.LAYER_GAP, Quantity.DISPLACEMENT, *UNLOADED_QUANTITIES)
"""Quantities whose reasons say more than their values."""
_READ = (
    f"The {bold('safety factor')} n is strength over stress: yield strength over von Mises stress for ductile "
    "materials, ultimate strength over the largest principal stress for brittle ones. The "
    f"{bold('displacement')} of a link is relative to the line through its first and last pin, or to the mouth of its "
    "clamp, since a free link has no other reference. The verdict is decided on the whole "
    f"{bold('band')}, not on the value: pass if all of the band keeps the limit, fail if none of it does, undecided "
    "otherwise."
)


def check_records(checks: Iterable[CheckOutcome]) -> list[dict[str, object]]:
    """Return outcomes of checks as entries of ``result.json``; the unit of a pure number is ``"1"``.

    Parameters
    ----------
    checks : iterable of CheckOutcome

    Returns
    -------
    list of dict
    """
    names = "name link load_case quantity value limit margin verdict applies reason"
    return [entries(check, names) | {"unit": check.unit or "1"} for check in checks]


def tier_records(case: Case, checks: Sequence[CheckOutcome]) -> list[dict[str, object]]:
    """Return the verdicts of the tiers as entries of ``result.json``.

    Parameters
    ----------
    case : Case
    checks : sequence of CheckOutcome
        All of them.

    Returns
    -------
    list of dict
    """
    return [
        entries(one, "tier verdict asks")
        | {"decides": None if one.decides is None else entries(one.decides, "name link load_case quantity")}
        | {"not_asked_of": list(one.unasked)}
        for one in tiers_of(case, checks)
    ]


def check_table(checks: Sequence[CheckOutcome], *, several: bool, key: str = "") -> Table:
    """Return a table of checks in their order, with the reason of each that its row does not show.

    Parameters
    ----------
    checks : sequence of CheckOutcome
    several : bool
        Whether there are several load cases, which have a column then.
    key : str, optional
        Of the table.

    Returns
    -------
    Table
    """
    alike = Counter((check.quantity, check.link, check.load_case) for check in checks)
    reasons = _reasons(checks)
    below = {
        i: reason for i, reason in enumerate(reasons) if reason and (i + 1 == len(checks) or reasons[i + 1] != reason)
    }
    return Table.of(
        (
            words("check", hidden=True),
            words("quantity", role="what"),
            words("link", role="who"),
            words("load case", role="under", hidden=not several),
            *JUDGED,
        ),
        [
            (
                check.name,
                str(check.quantity)
                if alike[check.quantity, check.link, check.load_case] == 1 or check.name in check.quantity
                else f"{check.name}: {check.quantity}",
                check.link,
                "any" if check.shared else check.load_case,
                *against(check),
                Mark(check.answer, check.verdict.value if check.applies else ""),
            )
            for check in checks
        ],
        key=key,
        below=below,
        kind="checks",
    )


def nearest(checks: Sequence[CheckOutcome], *, several: bool, all_below: bool) -> Section:
    """Return the checks of the first screen: each under its worst load case, the nearest to its limit first.

    Parameters
    ----------
    checks : sequence of CheckOutcome
    several : bool
        Whether there are several load cases.
    all_below : bool
        Whether the page has a table of all checks.

    Returns
    -------
    Section
    """
    worst = worst_of_each(checks)
    if not checks:
        return Section(key="nearest", title="What was checked", parts=(Text("The case contains no check."),))
    rows = [
        (
            f"{sentence(named(check))[:-1]}{f', {check.load_case}' if several and not check.shared else ''}",
            *against(check),
            Mark(check.verdict.value, check.verdict.value),
        )
        for check in worst[:MOST]
    ]
    columns = (words("check", role="what"), *JUDGED)
    order = "Nearest to its limit first, by the unfavourable end of its band over the limit."
    if len(worst) > MOST:
        order = f"The {MOST} of {len(worst)} checks that decide or are nearest to their limits."
    if len(worst) < sum(check.applies for check in checks):
        order += " Each stands with the worst load case in which it can be judged."
    more = link("All checks and their reasons" if all_below else "How they are decided", "#checks")
    return Section(
        key="nearest",
        title="What was checked",
        parts=(
            *((Table(columns=columns, rows=tuple(rows), kind="checks"),) if rows else ()),
            *(Text(line, "small") for line in inapplicable(checks)),
            Text(f"{order} {more}", "small"),
        ),
    )


def checks_section(case: Case, checks: Sequence[CheckOutcome], verdict: Verdict, where: str) -> Section:
    """Return all checks and how they are decided.

    Parameters
    ----------
    case : Case
    checks : sequence of CheckOutcome
    verdict : Verdict
        Of all of them.
    where : str
        Where it was looked at, such as ``In this pose``.

    Returns
    -------
    Section
        Its table ``checks`` has every check, each check with its worst load case above where there are several.
    """
    ordered, worst, several = by_nearness(checks), worst_of_each(checks), len(case.load_cases) > 1
    meaning = _MEANING[verdict].format(where=where)
    if verdict is Verdict.PASS:
        meaning += " “What the verdict does not cover” lists what the model leaves out."
    parts: list[Part] = [Text(meaning, "note")]
    whole = check_table(ordered, several=several, key="checks")
    if len(worst) == len(checks):
        parts += [whole] if checks else []
    else:
        if len(worst) < sum(check.applies for check in checks):
            parts.append(Text("Each check with the worst load case in which it can be judged:", "note"))
        parts += [check_table(worst, several=several)] if worst else []
        parts += [Text(line, "small") for line in inapplicable(checks)]
        under = ", under each load case" if several else ""
        parts.append(Folded(f"All {len(checks)} checks{under}", (whole,), told=True))
    parts.append(Text(_READ, "note"))
    if held := _held(checks):
        parts.append(Folded("Sources of error in the band of each check", (Items(held),)))
    return Section(
        key="checks",
        title="All checks" if has_all(checks) else "How checks are decided",
        short="Checks",
        parts=tuple(parts),
        data={"checks": check_records(checks), "tiers": tier_records(case, checks)},
    )


def has_all(checks: Sequence[CheckOutcome]) -> bool:
    """Return True where the table of all checks says more than that of the first screen.

    Parameters
    ----------
    checks : Sequence[CheckOutcome]

    Returns
    -------
    bool
    """
    return len(checks) > MOST or any(_reasons(checks))


def against(check: CheckOutcome) -> tuple[Number, Number]:
    """Return value and limit of a check as cells of a table.

    Parameters
    ----------
    check : CheckOutcome

    Returns
    -------
    tuple of 2 Number
    """
    sense, digits = check.quantity.sense.value, digits_beside(check.value, check.limit)
    return Number(check.value, check.unit, digits), Number(check.limit, check.unit, stated=True, sense=sense)


def _held(checks: Sequence[CheckOutcome]) -> tuple[str, ...]:
    """Return the kinds of sources of error in the bands of each check, each kind once."""
    wide = {check.name for check in checks if check.value.low < check.value.high}
    found: dict[str, dict[str, None]] = {}
    for check in checks:
        texts = [str(source.kind) for source in check.value.sources] if check.name in wide else []
        if check.value.without:
            texts.append(f"{'no error of the model' if texts else 'nothing'} ({told(check.value.without)})")
        for text in texts:
            found.setdefault(check.name, {})[text] = None
    return tuple(f"{name}: {joined(list(texts))}." for name, texts in found.items())


def _reasons(checks: Sequence[CheckOutcome]) -> list[str]:
    """Return the reason of each check; of what its row says as well only what would decide it."""
    return [_beside_row(check) for check in checks]


def _beside_row(check: CheckOutcome) -> str:
    why, number = check.reason, (check.value, check.limit, check.quantity)
    if check.quantity not in _TELLING and not check.value.unknowable:
        if check.verdict is Verdict.PASS:
            return ""
        if why == reason_for(*number):
            why = what_decides(*number)
    return say("{why}", why=why).text if why else ""
