"""Speeds, accelerations, momentum and energy of links, of points, and of the linkage as a whole."""

from collections.abc import Iterator, Mapping
from typing import Any

from alula.fea.findings.rates import QUANTITIES, Rates
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.charts import chart
from alula.reports.motion.extremes import SIZES, every_extreme, extremes_table, rate_cells, rate_columns
from alula.reports.sections.section import (
    Cell,
    Column,
    Folded,
    Group,
    Number,
    Part,
    Picture,
    Section,
    Table,
    Text,
    words,
)
from alula.reports.sentences.verdicts import told_speed

_INERTIAL = ("momentum", "angular_momentum", "kinetic_energy")
_LINK = ("angular_speed", "angular_acceleration", *_INERTIAL)
_WHOLE = {
    "momentum": "momentum",
    "angular_momentum": "angular momentum about {about}",
    "kinetic_energy": "kinetic energy",
    "potential_energy": "potential energy of the weights",
    "shaking_force": "shaking force",
    "shaking_moment": "shaking moment about {about}",
    "ground_force": "force on the ground, of all loads",
    "ground_moment": "moment on the ground about {about}, of all loads",
}


def rates_section(moved: CaseMotion, rates: Mapping[str, Rates]) -> Section:
    """Return speeds, momentum and energy.

    Parameters
    ----------
    moved : CaseMotion
    rates : mapping of str to Rates
        Load case -> at its speed; those with a speed.

    Returns
    -------
    Section
        Without parts where nothing has a speed.
    """
    records = {name: rates_record(found) for name, found in rates.items()}
    return Section(
        key="rates",
        title="Speeds, momentum and energy",
        short="Speeds and energy",
        parts=tuple(_parts(moved, rates, records)) if rates else (),
        data={"load_cases": {name: {"rates": records.get(name)} for name in moved.torque}},
    )


def rates_record(found: Rates) -> dict[str, Any]:
    """Return the rates of a motion at the speed of a load case as an entry of ``result.json``.

    Parameters
    ----------
    found : Rates

    Returns
    -------
    dict
    """
    whole = (*_INERTIAL, "potential_energy", "shaking_force", "shaking_moment")
    return {
        "about": {"joint": found.about, "place": [found.place.real, found.place.imag]},
        "links": {
            name: {"mass": found.masses.get(name)} | dict.fromkeys(_LINK) | every_extreme(found.motion, values)
            for name, values in found.links.items()
        },
        "points": {label: every_extreme(found.motion, values) for label, values in found.points.items()},
        "whole": dict.fromkeys(whole) | every_extreme(found.motion, found.whole),
    }


def _parts(moved: CaseMotion, rates: Mapping[str, Rates], records: Mapping[str, Mapping[str, Any]]) -> Iterator[Part]:
    yield Text(
        "Of all poses: the smallest and the largest value, of a vector its largest size. Angular momentum of a link is "
        "about its own centroid. The shaking force and moment are what inertia alone does to the ground. N·mm is mJ, "
        "and mN·s is g·m/s.",
        "note",
    )
    written: dict[str, Mapping[str, Any]] = {}
    for i, (name, record) in enumerate(records.items()):
        shared = {key: record[key] for key in ("links", "points")}
        same = next((other for other, one in written.items() if one == shared), None)
        tables = (_links(moved, name, record["links"]), _points(moved, name, record["points"]))
        parts: list[Part] = list(tables)
        if same is None:
            written[name] = shared
            if len(written) == 1:
                parts += _speeds(rates[name], f"load case {name}, at {told_speed(moved, name)}")
        else:
            parts = [Text(f"Links and points move as in load case {same}."), Folded("The same numbers here", tables)]
        if record["whole"]["momentum"] is None:
            left = "Momentum and energy of the links are left out: no load case asks for their weight or inertia."
            parts.append(Text(left))
        energy = "energy" if len(records) == 1 else f"energy-{i + 1}"
        parts += [_energy(moved, name, record), _energy_picture(moved, name, rates[name], energy)]
        yield Group(f"Load case {name}", tuple(parts), remark=f"at {told_speed(moved, name)}")


def _links(moved: CaseMotion, load_case: str, rows: Mapping[str, Mapping[str, Any]]) -> Table:
    weighed = any(row["mass"] is not None for row in rows.values())
    columns = [words("link"), Column("mass", "g", hidden=not weighed)]
    for key in _LINK:
        columns += rate_columns(key, moved.motion.progress_unit, told=weighed or key not in _INERTIAL)
    cells: list[tuple[Cell, ...]] = [
        (link, Number(row["mass"]), *(cell for key in _LINK for cell in rate_cells(key, row[key])))
        for link, row in rows.items()
    ]
    return Table(key="links", columns=tuple(columns), rows=tuple(cells), under=(("load case", load_case),))


def _points(moved: CaseMotion, load_case: str, rows: Mapping[str, Mapping[str, Any]]) -> Table:
    at = moved.motion.progress_unit
    columns = [
        Column(f"{key}, largest{more}", unit)
        for key in SIZES[:2]
        for more, unit in (("", QUANTITIES[key]), (" at", at))
    ]
    cells: list[tuple[Cell, ...]] = [
        (label, *(cell for key in SIZES[:2] for cell in _size(row[key]))) for label, row in rows.items()
    ]
    return Table(key="points", columns=(words("point"), *columns), rows=tuple(cells), under=(("load case", load_case),))


def _size(row: Mapping[str, Any]) -> tuple[Number, Number]:
    return Number(row["largest"]), Number(row["largest_at"] if row["largest"] > 0.0 else None, decimals=1)


def _energy(moved: CaseMotion, load_case: str, record: Mapping[str, Any]) -> Table:
    about, whole = record["about"]["joint"] or "the global origin", record["whole"]
    known = [(key, name) for key, name in _WHOLE.items() if whole[key] is not None]
    rows = ((name.format(about=about), QUANTITIES[key], whole[key]) for key, name in known)
    caption = "The linkage as a whole; of a vector, the largest size"
    return extremes_table("energy", load_case, rows, moved.motion.progress_unit, ends=False, caption=caption)


def _figures() -> Any:
    from alula.reports.figures.motion import rate_figures

    return rate_figures


def _speeds(rates: Rates, title: str) -> Iterator[Picture]:
    """Yield what moves at a speed: links and points."""
    links, points = "Angular speeds and accelerations of the links", "Speeds and accelerations of the points, as sizes"
    yield chart("link-speeds", links, lambda: _figures().speeds_figure(rates, "links", title))
    yield chart("point-speeds", points, lambda: _figures().speeds_figure(rates, "points", title))


def _energy_picture(moved: CaseMotion, load_case: str, rates: Rates, name: str) -> Picture:
    title = f"Energies, power of the drive and force on the ground, load case {load_case}"
    return chart(name, title, lambda: _figures().energy_figure(moved, load_case, rates))
