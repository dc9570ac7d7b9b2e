"""What a synthesis of a four-bar found: lengths, precision points, lock-up poses and defects."""

import math
from typing import Any

from alula.geometry.mechanisms.synthesis import DRIVES, LockUp, PrecisionPoint, Synthesis
from alula.reports.sections.data import entries
from alula.reports.sections.section import Column, Group, Items, Number, Part, Section, Table, Text, say, words
from alula.reports.words.four_bar import ANGLES, seen, unit_of

POINTS = "points"
"""Name of the table of the precision points."""


def synthesis_section(synthesis: Synthesis) -> Section:
    """Return what a synthesis found.

    Parameters
    ----------
    synthesis : Synthesis

    Returns
    -------
    Section
    """
    unit, factor = unit_of(synthesis)
    lengths = {
        name: Number(getattr(synthesis.four_bar, name), unit, 10, factor=1.0 / factor, stated=name == "d")
        for name in "abcd"
    }
    drives = [words(f"branch, {drive} driven") for drive in DRIVES]
    points = Table(
        key=POINTS,
        caption="Precision points; branch as seen from each link that may be driven",
        columns=(words("point"), *(Column(name, "deg") for name in ("theta, of b", "psi, of c", "phi, of a")), *drives),
        rows=tuple(
            (str(i), *map(_degrees, (point.theta, point.psi, point.phi)), *(seen(point, drive) for drive in DRIVES))
            for i, point in enumerate(synthesis.points, start=1)
        ),
    )
    parts: list[Part] = [
        Text("Loop a·e^(jφ) + b·e^(jθ) − c·e^(jψ) − d = 0: φ turns with link a, θ with b, ψ with c."),
        say(
            "Ratios K1 = {k1}, K2 = {k2}, K3 = {k3}; condition number of the 3×3 system: {condition}",
            **{f"k{i}": Number(float(ratio), decimals=6) for i, ratio in enumerate(synthesis.K, start=1)},
            condition=Number(synthesis.condition),
        ),
        say("Link lengths: a = {a}, b = {b}, c = {c}, d = {d}", **lengths),
        points,
    ]
    if synthesis.lock_ups:
        parts.append(_lock_ups(synthesis.lock_ups))
    # Lock-ups stand in their table.
    found = [(one.kind, _in_unit(one.sentence, synthesis)) for one in synthesis.findings if one.kind != "lock-up"]
    title = "Four-bar through three precision points (Freudenstein)"
    parts.append(Group("Findings", (Items(tuple(found)),)))
    return Section(key="synthesis", title=title, parts=tuple(parts), data=_record(synthesis))


def _lock_ups(found: tuple[LockUp, ...]) -> Table:
    return Table(
        key="lock-ups",
        caption="Lock-up poses: beyond them the driven link cannot turn",
        columns=(
            words("driven"),
            *(Column(name, "deg") for name in ("phi, of a", "theta, of b", "psi, of c")),
            words("other two links"),
        ),
        rows=tuple(
            (f"{lock.drive} ({ANGLES[lock.drive]})", *map(_degrees, (lock.phi, lock.theta, lock.psi)), lock.kind)
            for lock in found
        ),
    )


def _degrees(angle: float) -> Number:
    return Number(math.degrees(angle), decimals=4)


def _in_unit(text: str, synthesis: Synthesis) -> str:
    """Name the unit of the sums in Grashof's sentence, which come in the unit of d."""
    grashof = synthesis.four_bar.grashof
    unit, factor = unit_of(synthesis)
    for value in (grashof.shortest_plus_longest, grashof.other_two):
        text = text.replace(f"{value:.10g}", f"{value / factor:.10g} {unit}")
    return text


def _record(synthesis: Synthesis) -> dict[str, Any]:
    bar = synthesis.four_bar
    return {
        "units": {"length": "mm", "angle": "deg"},
        "coefficients": dict(zip(("K1", "K2", "K3"), map(float, synthesis.K), strict=True)),
        "condition": synthesis.condition,
        "lengths": entries(bar, "a b c d"),
        "turned": {"b": synthesis.b_turned, "c": synthesis.c_turned},
        "grashof": entries(bar.grashof, "satisfied relation inversion shortest_plus_longest other_two"),
        "points": [
            _angles(point, "theta psi phi") | {"residual": point.residual, "branches": dict(point.branches)}
            for point in synthesis.points
        ],
        "lock_ups": [
            {"drive": lock.drive} | _angles(lock, "phi theta psi") | {"kind": lock.kind} for lock in synthesis.lock_ups
        ],
        "findings": [entries(finding, "kind drive sentence") for finding in synthesis.findings],
    }


def _angles(pose: PrecisionPoint | LockUp, names: str) -> dict[str, float]:
    return {name: math.degrees(getattr(pose, name)) for name in names.split()}
