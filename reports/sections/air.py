"""Lift and drag as stated, and air on wings that flap: forces, coefficients, drive with and without it."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import CheckResult
from alula.fea.whole.motor import demand
from alula.geometry.base.units import as_text
from alula.geometry.linkage.placement import Placement
from alula.loads.case.case import Case
from alula.loads.records.aero import shares
from alula.loads.records.applied import LineLoad
from alula.loads.records.load_case import LoadCase
from alula.loads.states.case_motion import AirRange, CaseMotion
from alula.loads.states.flapping import flapping_loads, wing_reynolds, wing_span
from alula.reports.sections.data import entries
from alula.reports.sections.markup import bold, sub
from alula.reports.sections.section import Items, Part, Picture, Section, Text, paragraph
from alula.reports.sections.table import Column, Number, Table, numbers, words
from alula.reports.sentences import told
from alula.reports.words.numbers import joined, number, plain, sentence

Real = NDArray[np.float64]
_AT = ("without", "least", "stated", "largest")
"""Air of a drive: none, and the least, the stated and the largest C_N."""
_NUMBERS = (
    (Column("V", "m/s"), "speed", 1e-3),
    (Column("q", "Pa"), "dynamic_pressure", 1e6),
    (Column("S", "m²"), "area", 1e-6),
    (Column(f"C{sub('L')}"), "lift_coefficient", 1.0),
    (Column(f"C{sub('D')}"), "drag_coefficient", 1.0),
    (Column("L", "N"), "lift", 1.0),
    (Column("D", "N"), "drag", 1.0),
)
"""Numbers of an air load: column, entry of ``result.json``, factor on it."""
_WINGS = (
    "All force of the air acts on the axis of {links}: what turns a wing about that axis, the chordwise twist of wing "
    "and link, and the give of the wing's plate are not modelled."
)


def air_section(result: CheckResult) -> Section:
    """Return lift and drag of every load case.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts where no load case states air.
    """
    records = {name: air_records(result, name) for name in result.load_cases}
    stated = {name: found for name, found in records.items() if found}
    return Section(
        key="air",
        title="Lift and drag",
        short="Lift and drag",
        parts=tuple(_parts(stated)) if stated else (),
        data={"load_cases": {name: {"air": found} for name, found in records.items()}},
    )


def _parts(stated: dict[str, list[dict[str, Any]]]) -> Iterator[Part]:
    yield Text(
        f"Dynamic pressure q = ρV²/2; lift L = q S C{sub('L')} normal to the stream, drag D = q S C{sub('D')} along "
        "it. Given forces are converted to coefficients. A lift coefficient above 2 is an error; drag above lift, and "
        "a lift-to-drag ratio above 20, give a warning.",
        "note",
    )
    every = [(name, row) for name, rows in stated.items() for row in rows]
    rows = [row for _, row in every]
    yield Table.by_columns(
        {
            words("load case"): [name for name, _ in every],
            words("given as"): ["forces" if row["given"] else "coefficients" for row in rows],
            **{column: numbers((row[key] for row in rows), factor=factor) for column, key, factor in _NUMBERS},
            **{
                Column(f"force {axis}", "N"): [
                    Number(row["force"][i], beside=1e3 * (abs(row["lift"]) + abs(row["drag"]))) for row in rows
                ]
                for i, axis in enumerate("xyz")
            },
        },
        key="air",
    )
    yield Items(tuple(_spread(name, row) for name, row in every), "small")


def _spread(name: str, row: dict[str, Any]) -> str:
    """Return on which links the force of an air load acts, and its warnings."""
    patches = []
    for patch in row["spread"]:
        where = f"at {patch['where']}" if patch["shape"] == "point" else f"{patch['shape']}, {patch['where']}"
        if patch["span"]:
            where += f": {plain(patch['span'][0])} to {plain(patch['span'][1])} of the span"
        patches.append(f"{number(100.0 * patch['share'], 3)} % on {patch['link']} ({where})")
    title = f", {row['title']}" if row["title"] else ""
    text = f"{name}{title}: {'; '.join(patches)}."
    return " ".join([text, *(bold(sentence(told(warning))) for warning in row["warnings"])])


def air_records(result: CheckResult, name: str) -> list[dict[str, Any]]:
    """Return lift and drag of every air load of a load case, with coefficients and places.

    Parameters
    ----------
    result : CheckResult
    name : str
        Of the load case.

    Returns
    -------
    list of dict
        As plain data.
    """
    points = result.case.link_points
    found = []
    for air, forces in zip(result.case.load_cases[name].air, result.case.air_forces(name), strict=True):
        lift, drag = forces.coefficients or (None, None)
        spread = [
            {
                "link": patch.link,
                "where": patch.at or f"{patch.start} to {patch.end}",
                "shape": "point" if patch.at else patch.shape,
                "span": list(patch.span) if patch.at is None and patch.shape == "elliptic" else None,
                "share": share,
            }
            for patch, share in zip(air.spread, shares(air, points), strict=True)
        ]
        found.append(
            entries(air, "title speed density area")
            | entries(forces, "given lift drag lift_direction drag_direction warnings")
            | {"dynamic_pressure": forces.pressure, "lift_coefficient": lift, "drag_coefficient": drag}
            | {"force": forces.total.tolist(), "spread": spread}
        )
    return found


def flapping_section(result: CheckResult) -> Section:
    """Return what the air does to wings that flap, over the motion.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts where no load case has air on wings.
    """
    airs, case = result.in_air, result.case
    records = case_air_record(airs)
    flapping = [name for name in result.load_cases if case.load_cases[name].flapping is not None]
    links = joined(list(dict.fromkeys(wing.link for wing in case.wings)))
    return Section(
        key="flapping",
        title="Air on wings that flap",
        short="Air on wings",
        parts=() if airs is None or not records else tuple(flapping_parts(airs, records)),
        data={"flapping": records or None},
        not_covered=(("Wings", _WINGS.format(links=links)),) if flapping else (),
    )


def flapping_parts(airs: AirRange, records: dict[str, dict[str, Any]]) -> Iterator[Part]:
    """Yield what the air does to wings that flap.

    Parameters
    ----------
    airs : AirRange
    records : dict of str to dict
        Load case -> what ``result.json`` has of it.

    Yields
    ------
    Part
    """
    yield Text(
        f"Strip by strip, a force ½ ρ C{sub('N')} c v² per length against the speed v across the wing, and the added "
        f"mass ρ π c²/4. C{sub('N')} is known within a wide range; bands hold it. The stream of flight, tip vortices, "
        "the wings' own bending and other wings are left out.",
        "note",
    )
    for name, record in records.items():
        yield drive_in_air(name, record)
        yield Picture(
            name=f"air-{name}",
            alt=f"Drive torque and power over the motion with and without air, load case {name}",
            caption=f"Load case “{name}”: drive torque and power over the motion without air (dashed) and with it; the "
            f"band is that of C{sub('N')}.",
            draw=lambda name=name: _figure(airs, name),  # type: ignore[misc]
        )
    yield wing_table(records)


def drive_in_air(name: str, record: dict[str, Any]) -> Text:
    """Return coefficient, force and drive power of a load case with air on wings.

    Parameters
    ----------
    name : str
        Of the load case.
    record : dict
        What ``result.json`` has of it.

    Returns
    -------
    Text
    """
    low, high = record["normal_coefficient_range"]
    drive, wide = record["drive"], low != high
    text: list[str | Number] = [
        f"{name}: C{sub('N')} {record['normal_coefficient']:g}{f' ({low:g} to {high:g})' if wide else ''}, at most ",
        Number(max(wing["largest_force"] for wing in record["wings"]), "N", 3),
        " on a wing, Reynolds number up to ",
        Number(max(wing["reynolds"] for wing in record["wings"]), "", 2),
    ]
    for what, key in (("on average", "mean_power"), ("at most", "peak_power")):
        without, least, told, largest = (Number(drive[at][key], "W", 3) for at in _AT)
        text += [f"; drive power {what} ", without, " without air, ", told, " with it"]
        text += [" (", least, " to ", largest, ")"] if wide else []
    return paragraph(*text)


def wing_table(records: dict[str, dict[str, Any]]) -> Table:
    """Return the wings over the motion.

    Parameters
    ----------
    records : dict of str to dict
        Load case -> what ``result.json`` has of it.

    Returns
    -------
    Table
    """
    wings = [(name, wing) for name, record in records.items() for wing in record["wings"]]
    return Table.by_columns(
        {
            words("load case"): [name for name, _ in wings],
            words("link"): [wing["link"] for _, wing in wings],
            Column("span, along x", "mm"): [" to ".join(map(plain, wing["span"])) for _, wing in wings],
            Column("chord", "mm"): [" to ".join(map(plain, dict.fromkeys(wing["chord"]))) for _, wing in wings],
            Column("largest force", "N"): numbers((wing["largest_force"] for _, wing in wings), 3),
            Column("Reynolds number"): numbers((wing["reynolds"] for _, wing in wings), 2),
        },
        key="wings",
        caption="Wings over the motion",
    )


def _figure(airs: AirRange, name: str) -> Any:
    from alula.reports.figures.motion.air_figures import air_chart

    return air_chart(airs, name)


def motion_air_record(airs: AirRange | None, load_case: str) -> dict[str, Any] | None:
    """Return what the air does to the wings of a load case over a motion, and to its drive.

    Parameters
    ----------
    airs : AirRange or None
    load_case : str
        Its name.

    Returns
    -------
    dict or None
        ``docs/result.md`` describes it; None without air.
    """
    if airs is None:
        return None
    result = airs.stated
    case, stated, moved = result.case, result.case.load_cases[load_case], result.moved[load_case]
    air = stated.flapping
    if air is None or not np.any(moved.speed):
        return None
    wings = []
    for i, wing in enumerate(case.wings):
        force = wing_force(case, stated, moved.placement, i)
        first, last, chord = wing_span(wing, case)
        largest = int(np.argmax(np.abs(force)))
        wings.append(
            {
                "link": wing.link,
                "span": [first, last],
                "chord": list(chord),
                "largest_force": float(np.abs(force[largest])),
                "largest_at": float(moved.progress[largest]),
                "reynolds": wing_reynolds(case, air, wing, moved.placement),
            }
        )
    every = dict(zip(_AT, (airs.without, airs.least, result, airs.largest), strict=True))
    return {
        "density": as_text(air.density, "density"),
        "normal_coefficient": air.normal_coefficient,
        "normal_coefficient_range": list(air.ends),
        "added_mass": air.added_mass,
        "wings": wings,
        "drive": {name: _asked(one, load_case) for name, one in every.items()},
    }


def wing_force(case: Case, load_case: LoadCase, place: Placement, i: int) -> Real:
    """Return the force of the air on a wing, along its link's y axis.

    Parameters
    ----------
    case : Case
    load_case : LoadCase
    place : Placement
        With rates.
    i : int
        Number of the wing.

    Returns
    -------
    array (...)
        [N]
    """
    alone = case.model_copy(update={"wings": (case.wings[i],)})
    parts = [
        load.force if isinstance(load, LineLoad) else load.wrench for load in flapping_loads(alone, load_case, place)
    ]
    return np.asarray(sum(part[..., 1] for part in parts))


def _asked(moved: CaseMotion, load_case: str) -> dict[str, float]:
    times = moved.moved[load_case].times
    assert times is not None
    balanced = np.isfinite(moved.torque[load_case])
    power, effort = (values[balanced] for values in (moved.drive_power(load_case), moved.torque[load_case]))
    found = demand(power, effort, times[balanced])
    return {"peak_power": found.peak_power, "mean_power": found.mean_power, "peak_effort": found.peak_torque}


def case_air_record(airs: AirRange | None) -> dict[str, dict[str, Any]]:
    """Return what the air does over the motion of a case, for every load case that has air.

    Parameters
    ----------
    airs : AirRange or None

    Returns
    -------
    dict of str to dict
        Load case -> its record; empty without air, and without a motion.
    """
    found = {} if airs is None else {name: motion_air_record(airs, name) for name in airs.stated.torque}
    return {name: record for name, record in found.items() if record is not None}
