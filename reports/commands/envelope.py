"""Output of ``alula envelope``: the least safety factor of each link over the motion, and its curve."""

import csv
import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import UNLOADED_QUANTITIES
from alula.fea.motion.envelope_result import EnvelopeResult, LinkEnvelope, LinkFatigue, LoadCaseEnvelope
from alula.fea.motion.fatigue import LIFE_FACTOR, STRESS_FACTOR
from alula.fea.outcomes.unchecked import caveats
from alula.geometry.base.version import result_stamp
from alula.geometry.materials.material import Material
from alula.reports.check.links import solver_record
from alula.reports.page.motion_pages import envelope_headline
from alula.reports.page.output import MARK, write_folder
from alula.reports.renderers.record import finite
from alula.reports.sections.checks import check_records
from alula.reports.sections.data import data, entries
from alula.reports.sections.friction import motion_friction_lines, motion_friction_record
from alula.reports.sentences import told
from alula.reports.sentences.caveats import not_checked
from alula.reports.tables.console import say_checks, verdict_line
from alula.reports.tables.frames import motion_linkage_line, motion_linkage_record
from alula.reports.words.numbers import band, fixed, number, sentence
from alula.reports.words.terminal import say, say_table

if TYPE_CHECKING:
    from rich.console import Console

Real = NDArray[np.float64]

UNITS = {"angle": "deg", "length": "mm", "stress": "MPa"}
CURVES = "envelope.csv"
FIGURE = "envelope.png"


def drive_angle(result: EnvelopeResult, pose: int) -> float:
    """Return the direction of the driven link at a pose [degrees].

    Parameters
    ----------
    result : EnvelopeResult
    pose : int
        Its number.

    Returns
    -------
    float
    """
    return math.degrees(float(result.drive_angles[pose]))


def write_envelope(
    result: EnvelopeResult, target: Path, *, progress: Callable[[str], None] = lambda message: None
) -> None:
    """Write ``envelope.html``, ``result.json``, ``envelope.csv`` and ``envelope.png``, VTU files and stress plots.

    VTU file and picture show the worst pose under the worst load case.

    Parameters
    ----------
    result : EnvelopeResult
    target : Path
        The output folder; the files go to its subfolder ``envelope``.
    progress : callable, optional
        Receives messages.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_folder``.
    """
    from alula.reports.figures.motion.envelope_figures import envelope_figure, stress_pictures
    from alula.reports.page.export import write_vtu
    from alula.reports.page.motion_pages import ENVELOPE, envelope_page

    def fill(folder: Path) -> None:
        (folder / MARK).write_text(as_json(result) + "\n", encoding="utf-8")
        write_curves(result, folder / CURVES)
        progress("Drawing the envelope ...")
        curves = envelope_figure(result)
        (folder / FIGURE).write_bytes(curves.png())
        progress("Rendering the stress plots ...")
        plots, warnings = stress_pictures(result, result.links)
        for warning in warnings:
            progress(f"Warning: {warning}")
        (folder / "pictures").mkdir()
        for name, plot in plots.items():
            (folder / "pictures" / f"stress-{name}.png").write_bytes(plot.png())
        (folder / ENVELOPE).write_text(envelope_page(result, curves, plots), encoding="utf-8")
        (folder / "vtu").mkdir()
        for name, link in result.links.items():
            write_vtu(folder / "vtu" / f"{name}.vtu", link.displacement, link.field)

    write_folder(target, "envelope", fill)


def write_curves(result: EnvelopeResult, path: Path) -> None:
    """Write the curves over the motion as CSV, one load case below the other; omitted poses have empty fields.

    Parameters
    ----------
    result : EnvelopeResult
    path : Path
    """
    angles = {
        f"{result.moved.motion.coordinate} angle [deg]": np.degrees(result.angles),
        f"{result.drive.link} angle [deg]": np.degrees(result.drive_angles),
    }
    header = ["load case", *angles]
    for link, envelope in result.links.items():
        header += [f"{link} {envelope.measure} stress{end} [MPa]" for end in ("", " low", " high")]
        header += [f"{link} safety factor{end} [1]" for end in ("", " low", " high")]
        header += [f"{link} signed stress at the critical point [MPa]"]
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(header)
        for name in result.case.load_cases:
            columns = list(angles.values())
            for envelope in result.links.values():
                columns += _columns(envelope, name, len(result.angles))
            for row in np.column_stack(columns).tolist():
                writer.writerow([name, *(f"{v:.9g}" if math.isfinite(v) else "" for v in row)])


def _columns(link: LinkEnvelope, load_case: str, count: int) -> list[Real]:
    if load_case not in link.load_cases:
        return [np.full(count, np.nan)] * 7
    envelope = link.load_cases[load_case]
    with np.errstate(divide="ignore"):
        factors = [link.strength / np.maximum(stress, 0.0) for stress in (envelope.value, envelope.high, envelope.low)]
    history = np.full(count, np.nan) if envelope.fatigue is None else envelope.fatigue.history
    return [envelope.value, envelope.low, envelope.high, *factors, history]


def as_json(result: EnvelopeResult) -> str:
    """Return the result as JSON text.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    str
    """
    return json.dumps(record(result), indent=2, allow_nan=False)


def record(result: EnvelopeResult) -> dict[str, Any]:
    """Return the result as plain data.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    dict
        Angles in degrees; infinite and unknown numbers are None.
    """
    motion, left = result.moved.motion, caveats(result.case, over_motion=True)
    friction = {name: motion_friction_record(result.moved, work, name) for name, work in result.work.items()}
    envelope = {
        **result_stamp(),
        "case": result.name,
        "title": result.case.title,
        "verdict": result.verdict.value,
        "units": UNITS,
        "motion": {
            "coordinate": motion.coordinate,
            "first": math.degrees(float(result.angles[0])),
            "last": math.degrees(float(result.angles[-1])),
            "poses": len(result.angles),
            "evaluated": int(result.evaluated.sum()),
            "returns_to_start": motion.returns,
            "drive": {"link": result.drive.link, "joint": result.drive.joint},
            "dead_points": [math.degrees(angle) for angle in result.moved.dead_points],
        },
        "links": {name: _link_record(result, link) for name, link in result.links.items()},
        "linkage": {name: motion_linkage_record(result.moved, over) for name, over in result.linkage.items()},
        **({"friction": friction} if friction else {}),
        "idle_links": list(result.idle),
        "not_checked": not_checked(left),
        "caveats": [entries(one, "heading topic what why") for one in left],
        "checks": check_records(result.checks),
        "warnings": data(result.warnings),
        "timings_s": dict(result.timings),
    }
    return dict(finite(envelope, {}))


def _link_record(result: EnvelopeResult, link: LinkEnvelope) -> dict[str, Any]:
    material = result.case.material_of(link.link)
    return entries(link, "measure strength elements unknowns imbalance notes") | {
        "worst_load_case": link.worst.name,
        "load_cases": {
            name: _load_case_record(result, envelope, material) for name, envelope in link.load_cases.items()
        },
        "no_fatigue": data(link.no_fatigue),
        "unit_loads": link.units,
        "solutions": link.modes,
        **solver_record(link),
        "support_reaction": link.reaction,
    }


def _load_case_record(result: EnvelopeResult, envelope: LoadCaseEnvelope, material: Material) -> dict[str, Any]:
    return {
        **entries(envelope, "stress safety_factor"),
        "at": {
            "pose": envelope.pose,
            "coordinate": math.degrees(float(result.angles[envelope.pose])),
            "drive": drive_angle(result, envelope.pose),
            "location": envelope.location.tolist(),
            "pin_pressure_span": envelope.governing.span,
            "transfer": envelope.governing.transfer,
        },
        "fatigue": None if envelope.fatigue is None else _fatigue_record(envelope.fatigue, material),
    }


def _fatigue_record(fatigue: LinkFatigue, material: Material) -> dict[str, Any]:
    assert material.fatigue is not None
    life = fatigue.life
    return {
        "measure": measure_of(material),
        "rule": material.fatigue.rule,
        "location": fatigue.location.tolist(),
        "smallest": life.smallest,
        "largest": life.largest,
        "range": life.stress_range,
        "cycles": [{"range": size, "mean": mean, "count": count} for size, mean, count in life.cycles],
        "equivalent_peak_stress": data(fatigue.stress),
        "wanted_repetitions": fatigue.wanted,
        "strength_at_wanted": fatigue.strength,
        "repetitions": data(fatigue.repetitions),
        "scatter": scatter_of(material),
        "source": material.fatigue.source,
    }


def measure_of(material: Material) -> str:
    """Return the stress whose cycles count for fatigue.

    Parameters
    ----------
    material : Material

    Returns
    -------
    str
    """
    if material.brittle:
        return "the principal stress of largest magnitude"
    return "the von Mises stress with the sign of the principal stress of largest magnitude"


def scatter_of(material: Material) -> str:
    """Return the uncertainty of a fatigue life, in one sentence.

    Parameters
    ----------
    material : Material
        With data on fatigue.

    Returns
    -------
    str
    """
    fatigue = material.fatigue
    assert fatigue is not None
    asked = f"the required factors of {STRESS_FACTOR:g} on stress and {LIFE_FACTOR:g} on life must cover it"
    if fatigue.exponent is None:
        return f"the material card states one point of the S-N curve and no scatter; {asked}"
    return (
        f"the material card states no scatter; 10 % more stress shortens the life by a factor of "
        f"{1.1**fatigue.exponent:.2g}; {asked}"
    )


def print_envelope(result: EnvelopeResult, console: "Console") -> None:
    """Print the result of an envelope.

    Parameters
    ----------
    result : EnvelopeResult
    console : rich.console.Console
        On a narrow one, lines break at spaces.
    """
    verdict_line(result.verdict, result.case.title, console)
    say(console, envelope_headline(result))
    coordinate, (first, last) = result.moved.motion.coordinate, np.degrees(result.angles[[0, -1]])
    say(
        console,
        f"Motion: {coordinate} from {first:.6g} to {last:.6g} deg, driven at {result.drive.link}; "
        f"{int(result.evaluated.sum())} of {len(result.angles)} poses.",
    )
    _links(result, console)
    fatigued = {n: link for n, link in result.links.items() if any(c.fatigue for c in link.load_cases.values())}
    if fatigued:
        _fatigue(fatigued, console)
        for material in {result.case.part_of(n).material: result.case.material_of(n) for n in fatigued}.values():
            say(console, f"Fatigue of {material.title}: cycles of {measure_of(material)}; {scatter_of(material)}.")
    missing: dict[str, list[str]] = {}
    for name, link in result.links.items():
        if link.no_fatigue:
            missing.setdefault(told(link.no_fatigue), []).append(name)
    for why, names in missing.items():
        say(console, f"No fatigue of {', '.join(names)}: {why}.")
    for name, over in result.linkage.items():
        say(
            console,
            f"{f'Load case {name}: ' if len(result.linkage) > 1 else ''}{motion_linkage_line(result.moved, over)}",
        )
    for name, work in result.work.items():
        say(console, f"Load case {name}: {'; '.join(motion_friction_lines(result.moved, work, name))}.")
    say_checks(result.checks, console)
    for check in result.checks:
        if check.quantity in UNLOADED_QUANTITIES:
            say(console, sentence(f"{check.quantity}: {told(check.reason)}"))
    if result.idle:
        say(console, f"Links without load: {', '.join(result.idle)}.")
    for warning in result.warnings:
        say(console, f"Warning: {told(warning)}.", style="yellow")


def _links(result: EnvelopeResult, console: "Console") -> None:
    measures = {link.measure for link in result.links.values()}
    mixed = len(measures) > 1
    columns = (
        ("link", False),
        ("load case", False),
        ("least safety\nfactor (band)", True),
        ("decisive stress\n[MPa]" if mixed else f"{next(iter(measures), '')}\n[MPa]", True),
        (f"at {result.drive.link}\n[deg]", True),
        ("at x, y, z\n[mm]", True),
    )
    rows = [
        (
            name,
            load_case,
            band(envelope.safety_factor),
            (f"{link.measure} " if mixed else "") + number(envelope.stress.value, 3),
            fixed(drive_angle(result, envelope.pose), 1),
            ", ".join(fixed(float(v), 1) for v in envelope.location),
        )
        for name, link in result.links.items()
        for load_case, envelope in link.load_cases.items()
    ]
    say_table(console, columns, rows)


def _fatigue(links: Mapping[str, LinkEnvelope], console: "Console") -> None:
    columns = (
        ("link", False),
        ("load case", False),
        ("signed stress\n[MPa]", True),
        ("range\n[MPa]", True),
        ("repetitions to\nfailure (band)", True),
    )
    rows = [
        (
            name,
            load_case,
            f"{number(fatigue.life.smallest, 3)} to {number(fatigue.life.largest, 3)}",
            number(fatigue.life.stress_range, 3),
            "unknown, no exponent" if fatigue.repetitions is None else band(fatigue.repetitions, 2),
        )
        for name, link in links.items()
        for load_case, envelope in link.load_cases.items()
        if (fatigue := envelope.fatigue) is not None
    ]
    say_table(console, columns, rows)
