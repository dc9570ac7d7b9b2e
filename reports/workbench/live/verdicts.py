"""The verdict by hand on the text of a case while it is edited, as plain data: so far by linear theory, then whole."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import count

from alula.fea.check.run import check_case
from alula.fea.common.verdict import CheckOutcome, Subject, Tier, Verdict, by_nearness, deciding, overall
from alula.fea.findings.of_check import with_findings
from alula.fea.outcomes.result import CheckResult
from alula.fea.sizing.section import following, larger, stated
from alula.geometry.base.errors import AlulaError, CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import keys_of
from alula.reports.check.changes import change_records
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import checks_of, first_lines, named, opening
from alula.reports.words.numbers import joined, sentence
from alula.reports.workbench.editing.document import Document
from alula.reports.workbench.live.answers import Plain, Stage, case_of

_SO_FAR = (
    "So far by linear theory of the loads as stated: large displacement, buckling of the linkage, its limit load and "
    "other numbers of it as a whole are still to come, and so are play, air, friction and pins that tilt in the bands."
)


def linear_answer(text: str, name: str) -> Plain:
    """Answer the verdict by hand so far: what linear theory says of the loads as stated.

    It leaves out what takes long (``linear`` of ``alula.fea.check.run.check_case``): numbers of the linkage as a whole,
    its buckling, limit load and deformed shape, and in bands play, air, friction and how pins may stand in their holes.
    Bands are narrower for that: the whole verdict may leave open what passes or fails so far. Of the 16 built-in cases
    13 have the same verdict. Two that are open then fail, since the linkage gives way (owl-wing-static and -anchor),
    and slider-crank is open then, by its bands. Values are those of the whole check but on a deformed shape, where
    single checks that fail so far may be open then, as in owl-wing-braking and -flight.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name.

    Returns
    -------
    dict
        As ``whole_answer``, of stage ``linear``; without warnings, and ``changes`` is None: the whole verdict has them.
    """
    start = time.perf_counter()
    try:
        return verdict_of(check_case(case_of(text, name), name=name, threads=1, linear=True), "linear", start)
    except AlulaError as error:
        return _open("linear", str(error), start)


def whole_answer(text: str, name: str, early: Callable[[Plain], None] | None = None) -> Plain:
    """Answer the whole verdict by hand, as ``alula check --fidelity beam`` gives it.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name.
    early : callable, optional
        Is told the same before a section that passes is sought, which takes several checks: ``changes`` is None then.

    Returns
    -------
    dict
        ``stage`` whole; ``verdict``; ``sentences``, the verdict in words; ``checks``, with value, band and limit in
        their unit, None for what is not known or has no end; ``links``: link -> ``use``, the band of the share
        of strength that it takes, without an upper end (None) where a number of it has no band, or None where no check
        tells, and ``verdict``;
        ``changes``, each with ``text``, ``command`` and ``operations``, edits that make it, None where it is no single
        entry; ``warnings``; ``ms``.
    """
    start = time.perf_counter()
    try:
        result = check_case(case_of(text, name), name=name, fidelity="beam", threads=1)
        soon = verdict_of(result, "whole", start)
        if early is not None:
            early(soon)
        found = with_findings(result)
        return verdict_of(found, "whole", start) | {"changes": _changes(found, text), "ms": soon["ms"]}
    except AlulaError as error:
        return _open("whole", str(error), start)


def verdict_of(result: CheckResult, stage: str, start: float) -> Plain:
    """Return a verdict as plain data.

    Parameters
    ----------
    result : CheckResult
    stage : {"linear", "whole", "solids"}
        What it is of.
    start : float
        When it was begun, by ``time.perf_counter`` [s].

    Returns
    -------
    dict
        As ``whole_answer``.
    """
    checks, several = checks_of(result), len(result.load_cases) > 1
    sentences = first_lines(result)
    if stage == "linear":
        sentences = (*opening(result.case, result.verdict, checks, several=several), _SO_FAR)
    if stage != "solids" and result.verdict is Verdict.UNDECIDED:
        outside = {part: sizes for part in result.case.parts if (sizes := following(result.case, part))}
        wanted = "Hand calculation is not calibrated for links of part {}: it would be with {}."
        sentences = (*(wanted.format(part, _sizes(result.case, outside[part])) for part in outside), *sentences)
    first = deciding(checks)[0] if checks else None
    why = f" {sentence(f'{named(first)}: {told(first.reason)}')}" if first else ""  # the page has it beside the checks
    return {
        "stage": stage,
        "verdict": result.verdict.value,
        "sentences": [_here(one.removesuffix(why)) for one in sentences],
        "checks": [_check(check) for check in by_nearness(checks)],
        "links": {
            link: _of_link([one for one in checks if one.subject == Subject.link(link)])
            for link in result.case.checked_links
        },
        "changes": [] if stage == "solids" else None,
        "warnings": [_here(sentence(told(warning))) for warning in result.warnings],
        "ms": 1e3 * (time.perf_counter() - start),
    }


def _open(stage: str, problem: str, start: float) -> Plain:
    """Return the verdict on a case that cannot be checked."""
    nothing: Plain = {"checks": [], "links": {}, "changes": [], "warnings": []}
    ms = 1e3 * (time.perf_counter() - start)
    return {"stage": stage, "verdict": Verdict.UNDECIDED.value, "sentences": [problem], **nothing, "ms": ms}


def _check(check: CheckOutcome) -> Plain:
    return {
        "check": check.name,
        "quantity": str(check.quantity),
        "subject": str(check.subject),
        "load_case": check.load_case,
        "value": _known(check.value.value),
        "low": _known(check.value.low),
        "high": _known(check.value.high),
        "limit": _known(check.limit),
        "unit": check.unit,
        "verdict": check.answer,
        "text": _here(sentence(told(check.reason))),
    }


def _here(text: str) -> str:
    """Return a sentence that names what the page has in place of an option of the command line."""
    return text.replace("--fidelity solid", "'Check with solids'")


def _known(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _of_link(checks: Sequence[CheckOutcome]) -> Plain:
    """Return the verdict of a link, and the band of the largest share of strength that it takes: one over a margin."""
    uses = []
    for one in (check for check in checks if check.applies and check.quantity.tier is not Tier.NEITHER):
        _, least, most = one.quantity.margins(one.value.value, one.value.low, one.value.high, one.limit)
        if least > 0.0:
            uses.append((1.0 / most, math.inf if one.value.without else 1.0 / least))
    use = [_known(max(ends)) for ends in zip(*uses, strict=True)] or None
    return {"use": use, "verdict": overall(one.verdict for one in checks).value}


def _changes(result: CheckResult, text: str) -> list[Plain]:
    """Return what would change the verdict: sizes that can be set at once first, then what reports tell besides."""
    found = [*_offers(result, text)]
    if not found and result.verdict is not Verdict.PASS:
        found = [_change("No section that was tried passes by hand.")]
    for one, change in zip(change_records(result), result.changes, strict=True):
        if one["sentences"] != [sentence(told(change.check.reason))]:  # which stands beside the check
            title = sentence(one["title"])[:-1]
            found.append(_change(_here(f"{title}: {' '.join(one['sentences'])}"), command=one["command"]))
    return found


def _change(text: str, *, command: str | None = None, operations: Sequence[Plain] | None = None) -> Plain:
    return {"text": text, "command": command, "operations": operations}


def _offers(result: CheckResult, text: str) -> Iterator[Plain]:
    """Yield sizes that follow a section, so that it can be judged by hand, or else those with which the case passes."""
    case, name, checks = result.case, result.name, checks_of(result)
    follow = {part: sizes for part in case.parts if (sizes := following(case, part))}
    for part, sizes in follow.items():
        yield _offer(f"Hand calculation is calibrated for links of part {part} with", case, sizes)
    if follow or result.verdict is Verdict.PASS or not result.changes:
        return
    link = result.changes[0].check.subject.name
    if (size := result.changes[0].size) is not None:
        yield _offer("It passes with", case, {size.entry: size.last})
    elif sizes := larger(case, name, checks):
        yield _offer("It passes with another section", case, sizes)
    elif link in case.checked_links and [one.part for one in case.links.values()].count(case.links[link].part) > 1:
        document, part = Document(text), str(case.links[link].part)
        own = next(free for k in count(2) if (free := f"{part}-{k}") not in case.parts)
        alone = [
            {"op": "set", "path": ["parts", own], "value": document.tables()["parts"][part]},
            {"op": "set", "path": ["links", link, "part"], "value": own},
        ]
        with suppress(CaseError):  # a table that sets these entries, or a text that takes no edit
            document.apply(alone, None)
            changed = case_of(document.text, name)
            if sizes := larger(changed, name, checks):
                yield _offer(f"It passes with a part of its own for {link}, {own}", changed, sizes, alone)


def _offer(title: str, case: Case, sizes: Mapping[str, str], first: Sequence[Plain] = ()) -> Plain:
    """Return what sets some sizes after other edits."""
    operations = [*first, *({"op": "set", "path": keys_of(path), "value": size} for path, size in sizes.items())]
    return _change(f"{title}: {_sizes(case, sizes)}.", operations=operations)


def _sizes(case: Case, sizes: Mapping[str, str]) -> str:
    """Return sizes that are to be changed in words, with what they are now."""
    told_of = []
    for path, was, now in stated(case, sizes):
        _, name, entry = map(str, keys_of(path))
        told_of.append(f"{entry.replace('_', ' ')} of {name} {now} (now {was})")
    return joined(told_of)


STAGES: Mapping[str, Stage] = {
    "linear": lambda text, name, tell: tell("verdict", linear_answer(text, name)),
    "whole": lambda text, name, tell: tell("verdict", whole_answer(text, name, partial(tell, "verdict"))),
}
"""What a process may be asked, one after the other: each tells events with their data."""
