"""Lift and drag as stated, and air on wings that flap: forces, coefficients, drive with and without it."""

from collections.abc import Iterator
from typing import Any

from alula.fea.outcomes.result import CheckResult
from alula.loads.records.aero import shares
from alula.loads.states.case_motion import AirRange
from alula.reports.sections.data import entries
from alula.reports.sections.markup import bold, sub
from alula.reports.sections.section import Column, Items, Number, Part, Picture, Section, Table, Text, say, words
from alula.reports.sentences import told
from alula.reports.tables.loads import case_air_record
from alula.reports.words.numbers import joined, number, plain, sentence

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
    numbers = (
        (Column("V", "m/s"), "speed", 1e-3),
        (Column("q", "Pa"), "dynamic_pressure", 1e6),
        (Column("S", "m²"), "area", 1e-6),
        (Column(f"C{sub('L')}"), "lift_coefficient", 1.0),
        (Column(f"C{sub('D')}"), "drag_coefficient", 1.0),
        (Column("L", "N"), "lift", 1.0),
        (Column("D", "N"), "drag", 1.0),
    )
    yield Table(
        key="air",
        columns=(
            words("load case"),
            words("given as"),
            *(column for column, _, _ in numbers),
            *(Column(f"force {axis}", "N") for axis in "xyz"),
        ),
        rows=tuple(
            (
                name,
                "forces" if row["given"] else "coefficients",
                *(Number(row[key], factor=factor) for _, key, factor in numbers),
                *(Number(x, beside=1e3 * (abs(row["lift"]) + abs(row["drag"]))) for x in row["force"]),
            )
            for name, row in every
        ),
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
        found.append(
            entries(air, "title speed density area")
            | entries(forces, "given lift drag lift_direction drag_direction warnings")
            | {
                "dynamic_pressure": forces.pressure,
                "lift_coefficient": lift,
                "drag_coefficient": drag,
                "force": forces.total.tolist(),
                "spread": [
                    {
                        "link": patch.link,
                        "where": patch.at or f"{patch.start} to {patch.end}",
                        "shape": "point" if patch.at else patch.shape,
                        "span": list(patch.span) if patch.at is None and patch.shape == "elliptic" else None,
                        "share": share,
                    }
                    for patch, share in zip(air.spread, shares(air, points), strict=True)
                ],
            }
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
    drive = record["drive"]
    spread = f" ({low:g} to {high:g})" if low != high else ""
    text = f"{name}: C{sub('N')} {record['normal_coefficient']:g}{spread}, at most {{force}} on a wing, Reynolds "
    text += "number up to {reynolds}"
    facts: dict[str, object] = {
        "force": Number(max(wing["largest_force"] for wing in record["wings"]), "N", 3),
        "reynolds": Number(max(wing["reynolds"] for wing in record["wings"]), "", 2),
    }
    for what, key in (("on average", "mean_power"), ("at most", "peak_power")):
        text += f"; drive power {what} {{{key}_without}} without air, {{{key}_stated}} with it"
        facts |= {f"{key}_{at}": Number(drive[at][key], "W", 3) for at in ("without", "stated", "least", "largest")}
        text += f" ({{{key}_least}} to {{{key}_largest}})" if low != high else ""
    return say(text, **facts)


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
    return Table(
        key="wings",
        columns=(
            words("load case"),
            words("link"),
            Column("span, along x", "mm"),
            Column("chord", "mm"),
            Column("largest force", "N"),
            Column("Reynolds number"),
        ),
        rows=tuple(
            (
                name,
                wing["link"],
                " to ".join(map(plain, wing["span"])),
                " to ".join(map(plain, dict.fromkeys(wing["chord"]))),
                Number(wing["largest_force"], "", 3),
                Number(wing["reynolds"], "", 2),
            )
            for name, record in records.items()
            for wing in record["wings"]
        ),
        caption="Wings over the motion",
    )


def _figure(airs: AirRange, name: str) -> Any:
    from alula.reports.figures.motion.air_figures import air_chart

    return air_chart(airs, name)
