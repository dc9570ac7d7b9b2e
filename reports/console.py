"""The result on the terminal: verdict first, then links, checks, hand calculations, warnings."""

from typing import TYPE_CHECKING

from fea.anchor import anchor_loads
from fea.result import CheckResult, LoadCaseResult
from fea.verdict import DRIVE_POWER, Verdict
from loads.aero import AirForces
from reports.frames import frame_lines
from reports.second_opinion import opinion_table
from reports.wording import AGREEMENT, band, fixed, headline, joined, number, percent, plain, turning

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

COLOURS = {Verdict.PASS: "green", Verdict.FAIL: "red", Verdict.UNDECIDED: "yellow"}


def print_result(result: CheckResult, console: "Console") -> None:
    """Print a compact account of a check, readable at 80 columns."""
    from rich.text import Text

    colour = COLOURS[result.verdict]
    console.print(
        Text.assemble((f" {result.verdict.value.upper()} ", f"bold reverse {colour}"), f" {result.case.title}")
    )
    console.print(Text(headline(result)))
    several = len(result.load_cases) > 1
    for case in result.load_cases.values():
        console.print()
        if several:
            console.print(Text(f"Load case {case.name}", style="bold"))
        for air in result.case.air_forces(case.name):
            console.print(Text(_air(air)))
        console.print(Text(_statics(case)))
        for line in frame_lines(result, case):
            console.print(Text(line))
        console.print(Text(_anchor(case)))
        console.print(_links(case))
        if case.checks:
            console.print(_checks(case))
        for check in case.checks:
            if check.quantity == DRIVE_POWER:
                console.print(Text(f"Motor: {check.reason}."))
        for line in _hand(case):
            console.print(Text(line))
    for name, hand in result.hand.items():
        console.print(
            Text(
                f"Hand calculation {name}: cantilever, M {number(hand.moment)} N·mm, "
                f"bending stress {number(hand.stress)} MPa, n {number(hand.safety_factor)}."
            )
        )
    if result.audit is not None:
        wrong = [str(row.number) for row in result.audit.rows if not row.valid]
        found = (
            f"equations {joined(wrong)} are no equilibrium equations" if wrong else "every equation is an equilibrium"
        )
        console.print(Text(f"Published statics ({result.audit.source}): {found} of this linkage."))
    if result.second_opinions:
        console.print(opinion_table(result.second_opinions))
    for warning in result.warnings:
        console.print(Text(f"Warning: {warning}", style="yellow"))


def _statics(case: LoadCaseResult) -> str:
    largest = max((joint.magnitude for joint in case.reactions.joints.values()), default=0.0)
    forces = "  ".join(
        f"{name} {number(joint.magnitude, beside=largest)}" for name, joint in case.reactions.joints.items()
    )
    torque = case.reactions.drive_torque
    drive = case.reactions.drive
    driven = "" if drive is None else f"\nDrive torque on {drive.link}: {number(torque)} N·mm ({turning(torque)})"
    if drive is not None and drive.pushes(case.reactions.pose.linkage):
        driven = f"\nDrive force on {drive.link}: {number(case.reactions.drive_force)} N along {drive.joint}"
    return f"Joint forces [N]: {forces}{driven}"


def _air(air: AirForces) -> str:
    lift, drag = (f" (C {number(c, 3)})" for c in air.coefficients) if air.coefficients else ("", "")
    pressure = "" if air.pressure is None else f", q {number(air.pressure * 1e6, 3)} Pa"
    return f"Air: lift {number(air.lift)} N{lift}, drag {number(air.drag)} N{drag}{pressure}"


def _anchor(case: LoadCaseResult) -> str:
    anchor = anchor_loads(case)
    rows = {**anchor.joints, f"all, about {anchor.about}": anchor.total}
    undeformed = ", undeformed (no stable equilibrium beyond)" if anchor.unstable else ""
    shape = ", deformed" if anchor.deformed else undeformed
    lines = [f"On the ground{shape}: force x, y, z [N]; moment x, y, z [N·mm]"]
    for name, wrench in rows.items():
        force, moment = (", ".join(number(float(x)) for x in part) for part in (wrench[:3], wrench[3:]))
        lines.append(f"  {name}: {force}; {moment}")
    return "\n".join(lines)


def _table(*columns: tuple[str, bool]) -> "Table":
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
    for title, right in columns:
        table.add_column(title, justify="right" if right else "left", vertical="bottom")
    return table


def _links(case: LoadCaseResult) -> "Table":
    table = _table(
        ("link", False),
        ("model", False),
        ("von Mises\n[MPa]", True),
        ("safety factor n\n(band)", True),
        ("displacement\n[mm]", True),
        ("worst at x\n[mm]", True),
    )
    for name, link in case.links.items():
        table.add_row(
            name,
            link.decided_by or link.fidelity,
            number(link.von_mises_max.value, 3),
            band(link.safety_factor),
            number(link.displacement_max.value, 3),
            fixed(float(link.location[0]), 1),
        )
    return table


def _checks(case: LoadCaseResult) -> "Table":
    from rich.text import Text

    table = _table(("check", False), ("link", False), ("value (band)", True), ("limit", True), ("verdict", False))
    for check in case.checks:
        unit = f" {check.unit}" if check.unit else ""
        sign = "≥" if check.at_least else "≤"
        table.add_row(
            check.name,
            check.link,
            band(check.value) + unit,
            f"{sign} {plain(check.limit)}{unit}",
            Text(check.verdict.value, style=COLOURS[check.verdict]),
        )
    return table


def _hand(case: LoadCaseResult) -> list[str]:
    """Where hand calculation and solid model agree, and by how much they differ where they do not."""
    compared = {name: link.comparisons for name, link in case.links.items() if link.comparisons}
    if not compared:
        return []
    worst = {name: max(found, key=lambda c: abs(c.difference)) for name, found in compared.items()}
    apart = {name: c for name, c in worst.items() if abs(c.difference) > AGREEMENT}
    sections = sum(len(found) for found in compared.values())
    most = max(abs(c.difference) for c in worst.values())
    lines = [
        f"Hand calculation against solid model at {sections} sections: "
        + (
            f"they agree within {100.0 * most:.1f} %."
            if not apart
            else f"more than {100.0 * AGREEMENT:.0f} % apart on {joined(list(apart))}."
        )
    ]
    for name, c in apart.items():
        lines.append(
            f"  {name}, {c.kind} stress at x = {c.x:.1f} mm: hand {number(c.hand)} MPa, "
            f"solid {number(c.solid)} MPa ({percent(c.difference)})"
        )
    return lines
