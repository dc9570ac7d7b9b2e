"""What a search for a size found: of one entry, or of several the best combination."""

from collections.abc import Iterator, Mapping, Sequence
from math import prod
from typing import Any

from alula.fea.sizing.candidates import Place
from alula.fea.sizing.least import Sized
from alula.fea.sizing.lightest import Gain, Lightest
from alula.fea.study.margin import margin, nearest
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.reports.sections.data import entries
from alula.reports.sections.section import Column, Folded, Mark, Number, Part, Section, Table, Text, say, words
from alula.reports.sentences.verdicts import besides
from alula.reports.study.rows import checked, number_text, shown_unit
from alula.reports.words.numbers import percent, sentence

SOLVED = "solved"
"""Name of the table of all that the model that decides solved."""


def size_section(found: Sized | Lightest) -> Section:
    """Return what a search for a size found.

    Parameters
    ----------
    found : Sized or Lightest

    Returns
    -------
    Section
        Its title is the answer.
    """
    title, parts = _least(found) if isinstance(found, Sized) else _best(found)
    if left := besides(found.caveats):
        parts.append(Text(left))
    record = _sized_record(found) if isinstance(found, Sized) else _lightest_record(found)
    caveats = {"caveats": [entries(one, "heading topic what why") for one in found.caveats]}
    return Section(key="size", title=title, parts=tuple(parts), data=record | caveats)


def _least(found: Sized) -> tuple[str, list[Part]]:
    least, most = ("Least", "greatest") if found.rising else ("Greatest", "least")
    values, parts = found.values, list[Part]()
    span = f"{values[0]} to {values[-1]}"
    if found.passing is None:
        title = f"No value of {found.path} from {span} passes over its whole band."
    else:
        title = f"{least} {found.path} that passes: {values[found.passing]}."
        if found.passing == (0 if found.rising else len(values) - 1):
            parts.append(Text("The range begins with it; values beyond may pass, too."))
    failing = f"None from {span} fails" if found.failing is None else f"The {most} that fails: {values[found.failing]}"
    parts.append(Text(sentence(failing)))
    opened, turns = (", ".join(str(values[step]) for step in steps) for steps in (found.opened, found.turns))
    if opened:
        parts.append(Text(sentence(f"Undecided: {opened}")))
    if turns:
        told = f"The verdict turns more than once: {turns} fails again. Choose from alula study with this range."
        parts.append(Text(told))
    # Where none passes, the undecided step on the passing side.
    nearly = max(found.opened, key=lambda step: step if found.rising else -step, default=None)
    best = found.passing if found.passing is not None else nearly
    for step in dict.fromkeys((best, found.failing)):
        parts += _limited(found, step)
    solved = [({found.path: values[step]}, result) for step, result in sorted(found.results.items())]
    return title, [*parts, Folded("Values that were solved", (_table(solved),))]


def _limited(found: Sized, step: int | None) -> Iterator[Text]:
    """Yield what limits a value, if anything is known to."""
    limit = None if step is None else found.limit(step)
    if step is None or limit is None:
        return
    gain = found.gain(step)
    facts: dict[str, Any] = {"at": found.values[step], **checked(limit)}
    told = "At {at} {what} {value} ({limit}) limits it"
    if gain is not None and step < len(found.values) - 1:
        verb = "raises" if gain >= 0.0 else "lowers"
        other = found.values[step + (1 if found.rising else -1)]
        share = Number(abs(gain), "%", digits=2, factor=100.0, derived=True)
        told, facts = (
            told + f"; {{other}} {verb} its margin by some {{share}}",
            facts | {"other": other, "share": share},
        )
    yield say(told, **facts)


def _best(found: Lightest) -> tuple[str, list[Part]]:
    quantity, parts = found.objective.quantity, list[Part]()
    if found.best is None:
        title = "No combination that was solved passes over its whole band."
    else:
        point = ", ".join(f"{path} = {value}" for path, value in found.point(found.best).items())
        sought = "Greatest" if found.objective.largest else "Least"
        title = f"{sought} {quantity} that passes: {_cost(found, found.best) or ''} with {point}."
        if found.limit is not None:
            gains = "".join(_gained(found, gain) for gain in found.gains)
            parts.append(say("There {what} {value} ({limit}) limits it{gains}", gains=gains, **checked(found.limit)))
    parts.append(
        say(
            "Of {total} combinations {by_hand} were calculated by hand, and {solved} solved by the model that decides",
            total=prod(len(axis.values) for axis in found.axes),
            by_hand=found.by_hand,
            solved=len(found.solved),
        )
    )
    if not found.complete:
        told = "The search did not end within these: go on with a larger --most and the same folder."
        parts.append(Text(told, "apart"))
    ordered = sorted(found.solved, key=lambda place: found.objective.cost(found.solved[place]))
    solved = [(found.point(place), found.solved[place]) for place in ordered]
    return title, [*parts, _table(solved, quantity, [_cost(found, place) for place in ordered])]


def _cost(found: Lightest, place: Place) -> Number | None:
    cost = found.objective.number(found.solved[place])
    return None if cost is None else Number(cost.value, shown_unit(cost))


def _gained(found: Lightest, gain: Gain) -> str:
    model = ", by hand calculation" if gain.by_hand else ""
    changes = f"changes its margin by {percent(gain.share)} and the {found.objective.quantity} by {percent(gain.cost)}"
    return f"; {gain.path} = {gain.value} {changes}{model}"


def _table(
    solved: Sequence[tuple[Mapping[str, object], VariantResult]],
    quantity: str = "",
    costs: Sequence[Number | None] = (),
) -> Table:
    """Return what was solved; ``margin`` is 1 where the worse end of a band is at its limit, more on the safe side."""
    rows = []
    for i, (point, result) in enumerate(solved):
        limit = nearest(result)
        verdict = Mark(str(result.verdict or result.state), "" if result.verdict is None else result.verdict.value)
        told = ("", result.sentence) if limit is None else (f"{limit.quantity} of {limit.subject}", number_text(limit))
        cost = costs[i] if costs else None
        rows.append((*map(str, point.values()), cost, verdict, Number(None if limit is None else margin(limit)), *told))
    columns = (
        *(words(path) for path in (solved[0][0] if solved else ())),
        Column(quantity) if quantity else None,
        words("verdict"),
        Column("margin", hidden=True),
        words("nearest", hidden=True),
        words("nearest to its limit", wraps=True),
    )
    return Table.of(columns, rows, key=SOLVED)


def _sized_record(found: Sized) -> dict[str, Any]:
    def value(step: int | None) -> object:
        return None if step is None else found.values[step]

    return {
        "entry": found.path,
        "passing": value(found.passing),
        "failing": value(found.failing),
        "undecided": [value(step) for step in found.opened],
        "fails_beyond": [value(step) for step in found.turns],
        "solved": [{"value": value(step), **_outcome(result)} for step, result in sorted(found.results.items())],
    }


def _lightest_record(found: Lightest) -> dict[str, Any]:
    return {
        "entries": [axis.path for axis in found.axes],
        "objective": {"quantity": found.objective.quantity, "largest": found.objective.largest},
        "best": None if found.best is None else found.point(found.best),
        "complete": found.complete,
        "combinations_by_hand": found.by_hand,
        "limit": _plain(found.limit),
        "gains": [gain.__dict__ for gain in found.gains],
        "solved": [
            {"values": found.point(place), **_outcome(result, objective=_plain(found.objective.number(result)))}
            for place, result in found.solved.items()
        ],
    }


def _outcome(result: VariantResult, **more: object) -> dict[str, Any]:
    return {**entries(result, "state verdict sentence"), **more, "limit": _plain(nearest(result))}


def _plain(number: VariantNumber | None) -> dict[str, Any] | None:
    return None if number is None else dict(number.__dict__)
