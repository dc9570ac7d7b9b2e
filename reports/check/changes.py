"""What would change a verdict: factors on loads, strengths, sources of the band, the command that finds a size."""

import math
import shlex
from collections.abc import Sequence
from typing import Any

from alula.fea.check.deciding import BY_HAND
from alula.fea.common.change import MaterialChange, VerdictChange, rounded
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import UNLOADED_QUANTITIES, CheckOutcome, Quantity, Verdict
from alula.fea.outcomes.result import CheckResult, HandResult
from alula.reports.sections.data import entries
from alula.reports.sections.section import Command, Items, Part, Section
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import named
from alula.reports.words.numbers import joined, number, plain, sentence

_NARROWED: dict[SourceKind, str] = {
    SourceKind.DISCRETISATION: "finer meshes (--accuracy, --max-unknowns; of frames solid.mesh_size)",
    SourceKind.CALIBRATION: "a solid model (--fidelity solid)",
    SourceKind.EYES: "a solid model (--fidelity solid)",
    SourceKind.LOAD: "a narrower scatter of the load case",
    SourceKind.STRENGTH: "a narrower strength range on the material's card",
    SourceKind.MODULUS: "a narrower youngs_modulus range on the material's card",
    SourceKind.GROWTH: "a narrower scatter of load and modulus",
    SourceKind.COUPLES: "fits of the joints (fit, or clearance by link), which say how pins sit in their holes",
    SourceKind.PLAY: "a smaller clearance of the joints",
    SourceKind.AIR: "a narrower normal_coefficient_range of the load case's air",
    SourceKind.FRICTION: "a narrower friction_range of the joints",
    SourceKind.POSES: "more poses of the motion",
    SourceKind.BUILD: "build_direction of the part",
}
"""What narrows a source of error, of those that an entry of the case or an option narrows."""


def changes_section(result: CheckResult) -> Section:
    """Return what would change the verdict of the checks that decide it.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
    """
    records, parts = change_records(result), list[Part]()
    for record in records:
        title = f"{sentence(record['title'])[:-1]} ({record['verdict']})"
        parts.append(Items(((title, " ".join(record["sentences"])),)))
        if record["command"]:
            parts.append(Command("Find the size:", record["command"]))
    return Section(key="changes", title="What would change it", parts=tuple(parts), data={"changes": records})


def first_change(sections: Sequence[Section], *, said: str) -> tuple[str, str]:
    """Return what would change the check that decides, but for what was said, and the command that finds its size.

    Parameters
    ----------
    sections : sequence of Section
        Of a check.
    said : str
        The verdict and its reason.

    Returns
    -------
    tuple of (str, str)
        Each "" where there is none.
    """
    records = next(section for section in sections if section.key == "changes").data["changes"]
    for change in records[:1]:
        fresh = [text for text in change["sentences"] if text[1:] not in said]
        text = f"What would change it ({change['title']}): {' '.join(fresh)}" if fresh else ""
        return text, change["command"] or ""
    return "", ""


def change_records(result: CheckResult) -> list[dict[str, Any]]:
    """Return what would change the verdict of the checks that decide it, as entries of ``result.json``.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    list of dict
    """
    several = len(result.load_cases) > 1
    return [
        {
            **entries(change.check, "name link load_case quantity verdict margin"),
            "load_factor": change.load,
            "faster": change.faster,
            "linear_until": change.until,
            "material": None if change.material is None else entries(change.material, "what material stated needed"),
            "widest": [source.kind.name.lower() for source in change.widest],
            "size": None if change.size is None else entries(change.size, "entry first last"),
            "title": change_title(change, several=several),
            "sentences": change_sentences(change, result),
            "command": size_command(change, result) or None,
        }
        for change in result.changes
    ]


def change_title(change: VerdictChange, *, several: bool) -> str:
    """Return which check a change is about, such as ``safety factor of AE, load case lift``.

    Parameters
    ----------
    change : VerdictChange
    several : bool
        True where the case has several load cases.

    Returns
    -------
    str
    """
    own = several and not change.check.shared
    return named(change.check) + (f", load case {change.check.load_case}" if own else "")


def change_sentences(change: VerdictChange, result: CheckResult) -> list[str]:
    """Return what would change the verdict of a check, one sentence each; without the command for its size.

    Parameters
    ----------
    change : VerdictChange
    result : CheckResult

    Returns
    -------
    list of str
    """
    check = change.check
    found = [*_of_load(change, result), *_of_material(change.material, result, passes=check.verdict is Verdict.PASS)]
    if change.refuted and not found:
        found.append("Other loads and materials were tried by hand calculation; with none within reach does it pass.")
    elif check.verdict is Verdict.UNDECIDED and not found:
        known = change.widest and check.quantity is Quantity.FREQUENCY_RATIO
        found.append(_of_itself(check) if known else sentence(told(check.reason)))
    if change.widest:
        found.append(_of_sources(change, result))
    if not found:
        alone = check.quantity in (Quantity.DRIVE_SPEED, *UNLOADED_QUANTITIES)
        grows = "All loads may hardly grow." if change.load is not None else _without_factor(check, result)
        found.append(_of_itself(check) if alone else grows)
    return found


def size_command(change: VerdictChange, result: CheckResult) -> str:
    """Return the command that finds the size that would do; "" where no size stands for the check.

    Parameters
    ----------
    change : VerdictChange
    result : CheckResult

    Returns
    -------
    str
    """
    if change.size is None or not result.name:
        return ""
    size = change.size
    vary = f'{shlex.quote(size.entry)}="{size.first}..{size.last}"'
    words = ["alula", "size", shlex.quote(result.name), "--vary", vary]
    if result.fidelity in BY_HAND:
        words += ["--fidelity", "beam"]
    for path, value in result.case.changes:
        if path != size.entry:
            words += ["--set", shlex.quote(f"{path}={value}")]
    return " ".join(words)


def _without_factor(check: CheckOutcome, result: CheckResult) -> str:
    """Say why no factor on the loads takes a check to its limit."""
    told = "No factor on the loads is told"
    if check.value.least_alone:
        return f"{told}: only a least value of the number is known."
    if result.case.sprung:
        why = "springs act"
    elif check.quantity is Quantity.FATIGUE_STRESS:
        why = "mean stress counts"
    elif check.quantity is Quantity.PERMANENT_SET:
        why = "links yield"
    elif any(source.kind is SourceKind.PLAY for source in check.value.sources):
        why = "play of pins, which no load makes less, is part of it"
    elif result.load_cases[check.load_case].large_displacement.state == "off":
        why = "large displacement was not looked at"
    else:
        why = "the shape of the deformed linkage counts"
    return f"{told}: the number is not in proportion to them, since {why}."


def _of_itself(check: CheckOutcome) -> str:
    """Say of a number that no load changes by what it would have to shrink."""
    if check.quantity is Quantity.FREQUENCY_RATIO:
        return "It goes with one over the speed of the drive, and with the root of stiffness over mass."
    told = "It does not depend on the loads"
    if check.at_least or check.verdict is Verdict.PASS or not 0.0 < check.margin < 1.0:
        return f"{told}."
    return f"{told}; it passes at {_rounded(check.margin, up=False)} times what it is."


def _of_load(change: VerdictChange, result: CheckResult) -> list[str]:
    """Return by which factor the loads may grow or must fall, as a sentence."""
    check, load = change.check, change.load
    if load is None:
        return []
    stated = result.case.load_cases[check.load_case]
    along = [word for word, acts in (("own weight", stated.own_weight), ("inertia", stated.speed)) if acts]
    every = f"all loads{f' ({joined(along)} included)' if along else ''}"
    factor = _rounded(load, up=False)
    if check.quantity in (Quantity.LOAD_SHARE, Quantity.LIMIT_LOAD):
        factor = f"about {factor}"  # the path to it is followed in steps
    if check.verdict is not Verdict.PASS:
        return [f"It passes with {factor} times {every}{', maybe with more' if change.faster else ''}."]
    if rounded(load, up=False) <= 1.0:
        return []
    less = "less than " if change.faster else ""
    if load > change.until:
        linear = _rounded(change.until, up=False)
        enough = f"By linear theory, which is enough up to {linear} times the load"
        return [f"{enough}, {every} may grow to {less}{factor} times."]
    return [f"It passes until {every} are {less}{factor} times as large."]


def _of_material(change: MaterialChange | None, result: CheckResult, *, passes: bool) -> list[str]:
    """Return which strength or modulus would do, as a sentence."""
    if change is None:
        return []
    verb = "would still do" if passes else "would do"
    if not change.material:
        return [f"All moduli {_rounded(change.needed, up=True)} times as large {verb}."]
    title = result.case.all_materials[change.material].title
    needed, stated = rounded(change.needed, up=True), float(f"{change.stated:.4g}")
    if math.isclose(needed, stated):
        return []
    article = "An" if change.what[0] in "aeiou" else "A"
    return [f"{article} {change.what} of {plain(needed)} MPa in place of {plain(stated)} MPa ({title}) {verb}."]


def _of_sources(change: VerdictChange, result: CheckResult) -> str:
    """Return where most of a band comes from, and what narrows it."""
    kinds = list(dict.fromkeys(source.kind for source in change.widest))
    narrowed = list(dict.fromkeys(_NARROWED[kind] for kind in kinds if _narrows(kind, change.check, result)))
    remedy = f"narrower by {joined(narrowed)}" if narrowed else "which no entry of the case and no option narrows"
    together = " together" if len(kinds) > 1 else ""
    return f"Most of its band comes from {joined([str(kind) for kind in kinds])}{together}, {remedy}."


def _narrows(kind: SourceKind, check: CheckOutcome, result: CheckResult) -> bool:
    """Whether what narrows a source does so here: no scatter that is not stated, no solids where all links are some."""
    if kind is SourceKind.GROWTH:
        return any(source.kind in (SourceKind.LOAD, SourceKind.MODULUS) for source in check.value.sources)
    if kind is SourceKind.EYES:
        links = result.load_cases[check.load_case].links.values()
        return any(isinstance(link, HandResult) for link in links)
    return kind in _NARROWED


def _rounded(value: float, *, up: bool) -> str:
    """Return a number as it was tried."""
    return number(rounded(value, up=up, digits=3), 3)
