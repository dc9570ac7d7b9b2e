"""What a motion tells on the console."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from alula.fea.findings.of_motion import MotionFindings
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.play import drive_line, motion_play_record, play_lines
from alula.reports.motion.rate_rows import link_columns, point_columns, told_speed, whole_sentences
from alula.reports.sections.air import drive_in_air
from alula.reports.sections.assembly import clearance_text
from alula.reports.sections.friction import motion_friction_lines
from alula.reports.sections.markup import as_plain
from alula.reports.sections.springs import motion_springs
from alula.reports.tables.frames import motion_linkage_line
from alula.reports.tables.mechanism import design_lines


def motion_lines(found: MotionFindings, data: Mapping[str, Any]) -> Iterator[str]:
    """Yield the result of a motion line by line.

    Parameters
    ----------
    found : MotionFindings
    data : mapping
        From ``alula.reports.motion.record.record``.

    Yields
    ------
    str
    """
    result = found.moved
    yield from _summary(result, data["motion"])
    yield from _dead_points(result, data["drive"], data["motion"]["unit"])
    play = motion_play_record(found)
    yield from () if play is None else play_lines(result, play)
    if design := design_lines(result.case):
        yield from ("", *design)
    if found.clearance is not None:
        yield from ("", as_plain(clearance_text(found.clearance).text))
    for told, values in motion_springs(result):
        ends = [float(f"{value:.4g}") for value in (values[0], values[-1], values.min(), values.max())]
        yield from ("", "Spring {}: {:g} -> {:g}; min {:g}, max {:g}".format(told, *ends))
    written: dict[str, Mapping[str, Any]] = {}
    for load_case, row in data["load_cases"].items():
        yield from _load_case(found, load_case, row, play)
        if row["rates"] is not None:
            yield from _rates(result, load_case, row["rates"], written)


def _summary(result: CaseMotion, motion: Mapping[str, Any]) -> Iterator[str]:
    yield result.case.title
    duration = "" if motion["duration"] is None else f", {motion['duration']:.4g} s"
    yield (
        f"{motion['coordinate']} from {motion['first']:.6g} to {motion['last']:.6g} {motion['unit']}: "
        f"{motion['poses']} poses{duration}; largest gap of a loop {motion['closure_residual']:.1g} of the longest link"
    )
    if motion["returns_to_start"]:
        yield "The linkage returns to its start."
    width = max(map(len, motion["links"]))
    yield from ("", "Link directions [deg]")
    for link, row in motion["links"].items():
        yield (
            f"  {link:<{width}}  {row['first']:9.3f} -> {row['last']:9.3f}   "
            f"(between {row['smallest']:.3f} and {row['largest']:.3f})"
        )


def _dead_points(result: CaseMotion, drive: Mapping[str, Any], unit: str) -> Iterator[str]:
    for angle in drive["dead_points"]:
        yield ""
        yield (
            f"Dead point of the driven link {drive['link']} at {result.motion.coordinate} = {angle:.4f} {unit}: "
            f"{drive['link']} reverses its direction there; drive {result.effort[0]} and joint forces grow without "
            "bound."
        )
    if not drive["dead_points"]:
        way = drive["way_to_dead_point"]
        beyond = "none was met beyond" if way is None else f"the nearest is {way:.4g} {unit} beyond"
        yield ""
        yield (
            f"No dead point of {drive['link']} in the range, {beyond}; least distance (a ratio) "
            f"{drive['least_distance']:.3g}"
        )


def _load_case(
    found: MotionFindings, load_case: str, row: Mapping[str, Any], play: dict[str, Any] | None
) -> Iterator[str]:
    """Yield what drives the linkage in a load case, and its joint forces."""
    result = found.moved
    at = told_speed(result, load_case)
    yield from ("", f"Load case {load_case} ({f'with inertia at {at}' if row['inertia'] else 'without inertia'})")
    (what, unit), over = result.effort, result.motion.unit
    if load_case in found.linkage:
        yield f"  {motion_linkage_line(result, found.linkage[load_case])}"
    told = _ends(row[f"drive_{what}"], unit, over)
    yield f"  drive {what} on {result.drive.link} at {result.drive.joint}: {told}"
    if play is not None:
        yield f"  {drive_line(result, play, load_case)}"
    if result.rubbing:
        yield from (f"  {line}" for line in motion_friction_lines(result, found.work[load_case], load_case))
    if "drive_power" in row:
        power = _ends(row["drive_power"], "W", over)
        yield f"  drive power at {at}: {power}; energy imbalance {row['energy_imbalance']:.1g} of the largest power"
    yield from (
        f"  {line}"
        for line in ([as_plain(drive_in_air(load_case, row["flapping"]).text)] if row.get("flapping") else ())
    )
    if row["joints"] is None:
        yield "  the linkage is statically indeterminate, so equilibrium alone does not give the joint forces"
    for joint, extremes in (row["joints"] or {}).items():
        yield f"  joint {joint}: {_ends(extremes, 'N', over)}"


def _rates(
    result: CaseMotion, load_case: str, rates: Mapping[str, Any], written: dict[str, Mapping[str, Any]]
) -> Iterator[str]:
    """Yield the rates of a load case; those of links and points once for load cases that share them."""
    unit, shared = result.motion.unit, {key: rates[key] for key in ("links", "points")}
    same = next((name for name, other in written.items() if other == shared), None)
    if same is None:
        written[load_case] = shared
        for columns in (link_columns(rates), point_columns(rates, unit)):
            yield from ("", *_table(columns))
        yield ""
    else:
        yield f"  speeds, accelerations and momentum of links and points: as in load case {same}"
    yield from (f"  {line}" for line in whole_sentences(rates, unit))


def _table(columns: Sequence[tuple[str, Sequence[str]]]) -> Iterator[str]:
    """Yield a table, the names of its rows to the left; the unit of a column stands below its name."""
    cells = [(*name.partition(" [")[::2], *column) for name, column in columns]
    cells = [(name, f"[{unit}" if unit else "", *column) for name, unit, *column in cells]
    widths = [max(map(len, column)) for column in cells]
    for line in zip(*cells, strict=True):
        first, *others = (cell for cell in line)
        row = [first.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(others, widths[1:], strict=True))]
        yield f"  {'  '.join(row)}".rstrip()


def _ends(row: Mapping[str, Any], unit: str, at: str) -> str:
    keys = ("first", "last", "smallest", "largest")
    scale = max((abs(row[key]) for key in keys if row[key] is not None), default=0.0)
    first, last, smallest, largest = (_text(row[key], scale) for key in keys)
    ends = f"{first} -> {last} {unit}"
    if row["unbounded"]:
        return ends
    least = f"min {smallest} {unit} at {row['smallest_at']:.1f} {at}"
    return f"{ends}; {least}, max {largest} {unit} at {row['largest_at']:.1f} {at}"


def _text(value: float | None, scale: float) -> str:
    """Four digits; what is rounding beside ``scale`` is zero."""
    if value is None:
        return "unbounded"
    return f"{value:.4g}" if abs(value) > 1e-12 * scale else "0"
