"""The result of a check on the terminal: verdict, links, checks, hand calculations, warnings."""

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

from alula.fea.check.anchor import anchor_loads
from alula.fea.common.verdict import UNLOADED_QUANTITIES, CheckOutcome, Quantity, Verdict, by_nearness, worst_of_each
from alula.fea.outcomes.result import CheckResult, LoadCaseResult, SolidResult
from alula.loads.records.aero import AirForces
from alula.loads.statics.rounding import without_rounding
from alula.reports.sentences import told
from alula.reports.tables.data import change_records
from alula.reports.tables.frames import frame_lines
from alula.reports.tables.friction import friction_sentence
from alula.reports.tables.layers import build_directions_of
from alula.reports.tables.second_opinion import say_opinions
from alula.reports.tables.springs import holding_sentence, spring_sentences
from alula.reports.words.numbers import band, fixed, joined, measured, number, percent, plain, sentence, turning
from alula.reports.words.terminal import KEPT, height, say, say_command, say_table, shortened
from alula.reports.words.wording import agreement, apart, besides, brief, checks_of, headline, inapplicable

if TYPE_CHECKING:
    from rich.console import Console

VERDICT_COLOURS = {Verdict.PASS: "green", Verdict.FAIL: "red", Verdict.UNDECIDED: "yellow"}


def print_result(result: CheckResult, console: "Console") -> None:
    """Print the result of a check.

    Parameters
    ----------
    result : CheckResult
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    """
    verdict_line(result.verdict, result.case.title, console)
    say(console, headline(result))
    _say_change(_change(result, said=headline(result)), console)
    several = len(result.load_cases) > 1
    for case in result.load_cases.values():
        say(console, "")
        if several:
            say(console, f"Load case {case.name}", style="bold")
        for air in result.case.air_forces(case.name):
            say(console, _air(air))
        say(console, _statics(case))
        for line in frame_lines(result, case):
            say(console, line)
        say(console, _anchor(case))
        _links(case, console)
        if case.checks:
            say_checks(case.checks, console)
        for check in case.checks:
            if check.quantity is Quantity.DRIVE_POWER:
                say(console, f"Motor: {told(check.reason)}.")
            elif check.quantity is Quantity.DISPLACEMENT and check.applies:
                say(console, f"Displacement of {check.subject}: {told(check.reason)}.")
            elif check.quantity in (Quantity.LAYER_GAP, *UNLOADED_QUANTITIES) and check.applies:
                say(console, sentence(f"{check.quantity}: {told(check.reason)}"))
        for line in _hand(case):
            say(console, line)
    for layers in build_directions_of(result).values():
        say(console, f"Layers of {layers.sentence}.")
    for name, hand in result.hand.items():
        say(
            console,
            f"Hand calculation {name}: cantilever, M {number(hand.moment)} N·mm, "
            f"bending stress {number(hand.stress)} MPa, safety factor {number(hand.safety_factor)}.",
        )
    if result.audit is not None:
        wrong = [str(row.number) for row in result.audit.rows if not row.valid]
        found = f"equations {joined(wrong)} are not equilibrium equations" if wrong else "all are equilibrium equations"
        say(console, f"Published statics ({result.audit.source}): {found} of this linkage.")
    if result.second_opinions:
        say_opinions(result.second_opinions, console)
    for warning in result.warnings:
        say(console, f"Warning: {told(warning)}", style="yellow")


SCREEN = 23
"""Lines of a check on a terminal of 25: one is that of its progress, one says where the report is."""
MATTER = 5
"""Checks, and warnings, of which a screen tells."""
_LEAST = 2
"""Checks of which it tells before warnings."""
_REASON, _CHANGE, _BESIDES, _WARNING = 5, 4, 3, 3
"""Lines of a screen that a text may take."""


def print_screen(result: CheckResult, console: "Console") -> None:
    """Print what decides a check on one screen: verdict, why, what would change it, checks that matter, warnings.

    Parameters
    ----------
    result : CheckResult
    console : rich.console.Console
        The screen has ``SCREEN`` lines of 80 columns.
    """
    checks, several = checks_of(result), len(result.load_cases) > 1
    why = shortened(console, brief(result.verdict, checks, several=several), _REASON)
    besides_it = shortened(console, besides(result.caveats), _BESIDES)
    change, command = _change(result, said=why)
    change = shortened(console, change, _CHANGE)
    taken = 1 + sum(height(console, text) for text in (why, change, besides_it) if text) + 2 * bool(command)
    left = SCREEN - taken - 1  # the last line counts what is not told
    rows, warnings = worst_of_each(checks)[:MATTER], list[str]()
    least = _table_height(rows[:_LEAST], console, several=several)
    for warning in (shortened(console, f"Warning: {told(text)}", _WARNING) for text in result.warnings[:MATTER]):
        if height(console, warning) <= left - least:
            warnings.append(warning)
            left -= height(console, warning)
    while len(rows) > _LEAST and _table_height(rows, console, several=several) > left:
        rows.pop()
    badge = f" {result.verdict.value}  "
    verdict_line(result.verdict, shortened(console, f"{badge}{result.case.title}", 1)[len(badge) :], console)
    say(console, why)
    _say_change((change, command), console)
    if rows:
        _check_table(rows, console, several=several)
    if besides_it:
        say(console, besides_it)
    for warning in warnings:
        say(console, warning, style="yellow")
    more = [
        f"{count} more {what}{'s' if count > 1 else ''}"
        for count, what in ((len(checks) - len(rows), "check"), (len(result.warnings) - len(warnings), "warning"))
        if count
    ]
    say(console, f"{sentence(joined([*more, 'all numbers']))[:-1]}: --verbose")


def _table_height(checks: Sequence[CheckOutcome], console: "Console", *, several: bool) -> int:
    """Return how many lines the table of checks takes, whose rows a narrow terminal breaks."""
    with console.capture() as printed:
        _check_table(checks, console, several=several)
    return len(printed.get().splitlines())


def verdict_line(verdict: Verdict, title: str, console: "Console") -> None:
    """Print the verdict, in its colour, and the title of the case.

    Parameters
    ----------
    verdict : Verdict
    title : str
    console : rich.console.Console
    """
    from rich.text import Text

    badge = (f" {verdict.value.upper()} ", f"bold reverse {VERDICT_COLOURS[verdict]}")
    say(console, Text.assemble(badge, f" {title}"))


def _say_change(told: tuple[str, str], console: "Console") -> None:
    """Print what would change a check, and the command that finds its size; each may be empty."""
    change, command = told
    if change:
        say(console, change)
    if command:
        say_command(console, "Find the size:", command)


def _change(result: CheckResult, *, said: str) -> tuple[str, str]:
    """Return what would change the check that decides, but for what was said, and the command that finds its size."""
    for change in change_records(result)[:1]:
        fresh = [text for text in change["sentences"] if text[1:] not in said]
        told = f"What would change it ({change['title']}): {' '.join(fresh)}" if fresh else ""
        return told, change["command"] or ""
    return "", ""


def _statics(case: LoadCaseResult) -> str:
    reactions = without_rounding(case.reactions)
    forces = "  ".join(f"{name}{KEPT}{number(joint.magnitude)}" for name, joint in reactions.joints.items())
    drive, torque = reactions.drive, reactions.drive_torque
    driven = "" if drive is None else f"\nDrive torque on {drive.link}: {number(torque)} N·mm ({turning(torque)})"
    if drive is not None and drive.pushes(reactions.pose.linkage):
        driven = f"\nDrive force on {drive.link}: {number(reactions.drive_force)} N along {drive.joint}"
    if held := holding_sentence(case.standing):
        driven = f"\n{held}."
    if case.work is not None:
        driven += f"\n{friction_sentence(case.work, case.reactions)}"
    springs = "".join(f"\n{line}." for line in spring_sentences(case.standing))
    return f"Joint forces [N]: {forces}{driven}{springs}"


def _air(air: AirForces) -> str:
    lift, drag = ("", "")
    if air.coefficients:
        lift, drag = (f" (C_{x} {number(c, 3)})" for x, c in zip("LD", air.coefficients, strict=True))
    pressure = "" if air.pressure is None else f", q {number(air.pressure * 1e6, 3)} Pa"
    return f"Air: lift {number(air.lift)} N{lift}, drag {number(air.drag)} N{drag}{pressure}"


def _anchor(case: LoadCaseResult) -> str:
    anchor = anchor_loads(case)
    rows = {**anchor.joints, f"total, about {anchor.about}": anchor.total}
    undeformed = ", undeformed pose (the deformed one has no stable equilibrium)" if anchor.unstable else ""
    shape = ", deformed pose" if anchor.deformed else undeformed
    lines = [f"Load on the ground{shape}: force x, y, z [N]; moment x, y, z [N·mm]"]
    for name, wrench in rows.items():
        force, moment = (", ".join(number(float(x)) for x in part) for part in (wrench[:3], wrench[3:]))
        lines.append(f"  {name}: {force}; {moment}")
    return "\n".join(lines)


def _links(case: LoadCaseResult, console: "Console") -> None:
    measures = {link.measure for link in case.links.values()}
    mixed = len(measures) > 1
    columns = [
        ("link", False),
        ("model", False),
        ("decisive stress\n[MPa]" if mixed else f"{next(iter(measures), '')}\n[MPa]", True),
        ("safety factor n\n(band)", True),
        ("displacement\n[mm]", True),
        ("largest at x\n[mm]", True),
    ]
    rows = [
        (
            name,
            link.model,
            (f"{link.measure} " if mixed else "") + number(link.decisive.value, 3),
            band(link.safety_factor),
            number(link.displacement_max.value, 3, 1000.0 * case.reactions.pose.linkage.longest),
            fixed(float(link.location[0]), 1),
        )
        for name, link in case.links.items()
    ]
    if case.gives_way:
        say(console, "Links in the undeformed pose. The linkage gives way, so no link passes:")
    say_table(console, columns, rows)


def say_checks(checks: Sequence[CheckOutcome], console: "Console") -> None:
    """Print the checks with value, band, limit and verdict; those that are not applicable together below them.

    Parameters
    ----------
    checks : sequence of CheckOutcome
        The load case has a column if there are several; the name is shown where several have one quantity.
    console : rich.console.Console
    """
    _check_table(
        by_nearness(check for check in checks if check.applies),
        console,
        several=len({check.load_case for check in checks}) > 1,
    )
    for line in inapplicable(checks):
        say(console, line)


def _check_table(checks: Sequence[CheckOutcome], console: "Console", *, several: bool) -> None:
    """Print checks in their order; ``several`` load cases have a column."""
    from rich.text import Text

    alike = Counter((check.quantity, check.link, check.load_case) for check in checks)
    columns = [("check", False), ("link", False), *([("load case", False)] if several else [])]
    columns += [("value (band)", True), ("limit", True), ("verdict", False)]
    rows: list[tuple[str | Text, ...]] = []
    for check in checks:
        unit = f" {check.unit}" if check.unit else ""
        rows.append(
            (
                check.quantity
                if alike[check.quantity, check.link, check.load_case] == 1
                else f"{check.name}: {check.quantity}",
                check.link,
                *([check.load_case] if several else []),
                measured(check.value, check.unit),
                f"{check.quantity.sense.value}{KEPT}{plain(check.limit)}{unit}",
                Text(check.verdict.value, style=VERDICT_COLOURS[check.verdict]),
            )
        )
    say_table(console, columns, rows)


def _hand(case: LoadCaseResult) -> list[str]:
    """Return the agreement of hand calculation and solid model, and the largest difference of each link."""
    solids = {name: link for name, link in case.links.items() if isinstance(link, SolidResult)}
    compared = {name: link.comparisons for name, link in solids.items() if link.comparisons}
    if not compared:
        return []
    far = {name: max(found, key=lambda c: abs(c.difference)) for name, found in compared.items() if apart(found)}
    every = [c for found in compared.values() for c in found]
    told = agreement(every) if not far else f"{agreement(every)} on {joined(list(far))}"
    lines = [f"Hand calculation against solid model at {len(every)} sections: {told}."]
    for name, c in far.items():
        lines.append(
            f"  {name}, {c.kind} stress at x = {c.x:.1f} mm: hand {number(c.hand)} MPa, "
            f"solid {number(c.solid)} MPa ({percent(c.difference)})"
        )
    return lines
