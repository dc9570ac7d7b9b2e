"""The table of a cycle read into a case: its loads and its angle at one instant, and at every row."""

import re
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import BODY_WEIGHT, as_text, parse, weight_of
from alula.loads.records.cycle_spec import CycleMotion, CycleSpec, states
from alula.loads.records.load_case import LoadCase
from alula.loads.records.settings import PoseSpec
from alula.loads.text.explain import printable, sentence
from alula.loads.text.number_table import NumberTable, read_number_table

Real = NDArray[np.float64]
Path = tuple[str | int, ...]

ENTRIES = ("force", "moment", "pressure", "total", "from", "to")
"""Entries of loads that may name a column; names of links and titles may begin with the same word."""
OF_MOTION = ("coordinate", "inertia", "instant_centre", "against")
"""Entries of ``[motion]`` that a cycle leaves to the case."""
_COLUMN = re.compile(r"\s*([-−+]?)\s*column\s+(\S.*?)\s*")
_WHOLE = 100.0
_SAME = 1e-9
"""Share of a column's span, or of the cycle, that is rounding."""


class ColumnReference(NamedTuple):
    """An entry that names a column: where it stands, the sign before it and the column."""

    path: Path
    sign: float
    column: str

    @property
    def entry(self) -> str:
        """The path as sentences have it."""
        return ".".join(map(str, self.path))


@dataclass(frozen=True, kw_only=True, eq=False)
class Cycle:
    """A cycle and what it makes of the tables of a case.

    Attributes
    ----------
    tables : dict
        The case at the instant at which it is checked.
    rows : mapping of str to tuple of LoadCase
        Load case that names a column -> as it is at every instant.
    states : CycleMotion
        The motion; a structure stays where it is.
    entered : float or None
        Value of the coordinate at which ``pose.near`` chooses the branch [rad, mm]; None where the pose states none.
    """

    tables: dict[str, Any]
    rows: Mapping[str, tuple[LoadCase, ...]]
    states: CycleMotion
    entered: float | None


def read_cycle(data: dict[str, Any], folder: str) -> Cycle | None:
    """Read the cycle of a case.

    Parameters
    ----------
    data : dict of str to object
        The case as nested tables, not validated; they stay as they are.
    folder : str
        Where its file is sought.

    Returns
    -------
    Cycle or None
        None where the case states none.

    Raises
    ------
    CaseError
        For a table that is malformed or does not fit the case.
    """
    references = tuple(_references(data.get("load_cases"), ("load_cases",)))
    if "cycle" not in data:
        if references:
            raise CaseError(
                f"{references[0].entry}: it names a column, but the case states no table of a cycle; add [cycle] with "
                "its file"
            )
        return None
    for name in ("cycle", "pose"):
        if not isinstance(data.get(name, {}), dict):
            raise CaseError(
                f"{name}: it must be a table of entries; write it as [{name}] with one entry per line below"
            )
    try:
        spec = CycleSpec.model_validate(data["cycle"])
        pose = PoseSpec.model_validate(data.get("pose", {}))
    except ValidationError as error:
        wrong = "cycle" if error.title == "CycleSpec" else "pose"
        raise CaseError(f"{wrong}.{sentence(error, CycleSpec if wrong == 'cycle' else PoseSpec)}") from None
    if spec.angle is None and not references:
        raise CaseError('cycle: nothing names a column of it; state its angle, or a force such as "column Fy"')
    try:
        table, period = _read(spec, folder)
        sign, angle = spec.signed_angle
        used = dict.fromkeys([*([table.column(angle)] if angle else []), *(table.column(x.column) for x in references)])
        _require_steps(table, angle)
        table = _whole(spec, table, tuple(used), angle)
        table, values = _at_instants(spec, table, _values(spec, table, pose, sign, angle))
    except CaseError as error:
        raise CaseError(f"cycle: {error}") from None
    percent = table.values[_CYCLE]
    now = table.between(_CYCLE, np.array([_instant(spec, percent)]))
    mass = _body_mass(data, table, references)
    tables = _stated(data, references, now, 0, mass)
    tables |= _moved(data, pose, values, float(np.interp(now.values[_CYCLE][0], percent, values)))
    every: dict[str, tuple[LoadCase, ...]] = {}
    for name in dict.fromkeys(str(one.path[1]) for one in references):
        own = tuple(one for one in references if one.path[1] == name)
        every[name] = tuple(_row(data, name, own, table, i, mass) for i in range(len(percent)))
    return Cycle(
        tables=tables,
        rows=every,
        states=states(percent, values, period, periodic=spec.periodic),
        entered=(pose.angle if pose.travel is None else pose.travel)
        if {"angle", "travel"} & pose.model_fields_set
        else None,
    )


def of_cycle(table: str, stated: object) -> bool:
    """Return True for a table of a case that its cycle completes.

    Parameters
    ----------
    table : str
        Its name.
    stated : object
        What stands in it.

    Returns
    -------
    bool
        Of load cases that name columns, and of a motion that says no more than ``OF_MOTION``.
    """
    if table == "load_cases":
        return next(_references(stated, (table,)), None) is not None
    return table == "motion" and isinstance(stated, dict) and bool(stated) and set(stated) <= set(OF_MOTION)


_CYCLE, _TIME = "cycle", "time"


def _references(value: object, path: Path) -> Iterator[ColumnReference]:
    """Yield the entries of load cases that name a column."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        here = (*path, key)
        if isinstance(inner, dict | list):
            yield from _references(inner, here)
        elif isinstance(inner, str) and (match := _COLUMN.fullmatch(inner)) and _entry(here) in ENTRIES:
            yield ColumnReference(here, -1.0 if match[1] in ("-", "−") else 1.0, match[2])


def _entry(path: Path) -> str:
    """Return the entry that a place in tables and lists belongs to."""
    return next((key for key in reversed(path) if isinstance(key, str)), "")


def _read(spec: CycleSpec, folder: str) -> tuple[NumberTable, float | None]:
    """Return the table with a column ``cycle`` in per cent, and how long a cycle takes [s]."""
    table = read_number_table(folder, spec.file)
    found = [name for name in (_CYCLE, _TIME) if name in table.units]
    if len(found) != 1:
        raise CaseError(
            f"'{table.name}' needs one column that says when its rows are, 'cycle [%]' or 'time [s]', but has "
            f"{'both' if found else 'neither'}; {'remove one' if found else 'add one'}"
        )
    table.rising(found[0])
    if len(table.rows) < 3:
        raise CaseError(f"'{table.name}' has {len(table.rows)} rows, but speeds take at least 3; add some")
    period = spec.period
    if found[0] == _TIME:
        times = table.quantity(_TIME, "time")
        span = float(times[-1] - times[0])
        period = span if period is None else period
        percent = _WHOLE * (times - times[0]) / period
    elif table.units[_CYCLE] != "%":
        raise CaseError(
            f"'{table.name}', column cycle: its unit is {printable(table.units[_CYCLE])}, but it counts in per cent; "
            "write cycle [%], or time [s]"
        )
    else:
        percent = table.values[_CYCLE]
    if percent[-1] - percent[0] > _WHOLE * (1.0 + _SAME):
        raise table.wrong(
            table.rows[-1],
            found[0],
            f"the table goes on beyond one cycle, by {percent[-1] - percent[0] - _WHOLE:.4g} %; "
            "end it there" + (", or state a longer period" if found[0] == _TIME else ""),
        )
    units = {_CYCLE: "%"} | {name: unit for name, unit in table.units.items() if name != found[0]}
    values = {name: percent if name == _CYCLE else table.values[name] for name in units}
    return replace(table, units=units, values=values), period


def _whole(spec: CycleSpec, table: NumberTable, used: tuple[str, ...], angle: str) -> NumberTable:
    """Return the table of a periodic cycle with its first row at its end."""
    if not spec.periodic:
        return table
    percent = table.values[_CYCLE]
    if percent[-1] - percent[0] < _WHOLE * (1.0 - _SAME):
        values = {name: np.append(of, of[0]) for name, of in table.values.items()}
        values[_CYCLE][-1] = percent[0] + _WHOLE
        if angle:
            values[angle][-1] += _turns(table, angle)
        return replace(table, values=values, rows=(*table.rows, table.rows[0]))
    for name in used:
        of = table.values[name]
        off, turn = float(of[-1] - of[0]), _turn(table, name) if name == angle else 0.0
        off -= turn * round(off / turn) if turn else 0.0
        if abs(off) > _SAME * max(float(np.ptp(of)), float(np.abs(of).max())):
            raise table.wrong(
                table.rows[-1],
                name,
                f"{of[-1]:g} at the end of the cycle is not {of[0]:g} at its beginning, in row "
                f"{table.rows[0]}; make them equal, leave the last row out, or write periodic = false",
            )
    return table


def _require_steps(table: NumberTable, angle: str) -> None:
    """Refuse an angle that jumps by more than half a turn, which way round it goes is not known then."""
    turn = _turn(table, angle) if angle else 0.0
    steps = np.diff(table.values[angle]) if turn else np.zeros(0)
    for row, step in zip(table.rows[1:], steps, strict=False):
        if abs(step) > 0.5 * turn * (1.0 + _SAME):
            unit = printable(table.units[angle])
            raise table.wrong(
                row,
                angle,
                f"it jumps by {step:g} {unit}, more than half a turn; let it go on beyond a full turn, {turn:g}, "
                "or add rows between",
            )


def _turns(table: NumberTable, angle: str) -> float:
    """Return by how much the first row's angle has grown where it comes again, in whole turns the way that it goes."""
    values, turn = table.values[angle], _turn(table, angle)
    grown = turn * round((values[-1] - values[0]) / turn) if turn else 0.0
    if grown and (values[0] + grown - values[-1]) * (values[-1] - values[-2]) < 0.0:
        unit = printable(table.units[angle])
        raise table.wrong(
            table.rows[-1],
            angle,
            f"whether it comes back from {values[-1]:g} to {values[0]:g} or goes on to {values[0] + grown:g} {unit} is "
            "not known; add the row at the end of the cycle",
        )
    return grown


def _turn(table: NumberTable, name: str) -> float:
    """Return a full turn in the unit of a column; 0 for one that holds no angles."""
    try:
        return 2.0 * np.pi / parse(f"1 {table.units[name]}", "angle")
    except PydanticCustomError:
        return 0.0


def _values(spec: CycleSpec, table: NumberTable, pose: PoseSpec, sign: float, angle: str) -> Real:
    """Return the values of the coordinate at every row [rad, mm]."""
    slides = pose.travel is not None
    if not angle:
        if spec.zero is not None:
            raise CaseError("zero is that of the angle's column, but none is stated; state angle, or leave zero out")
        held = pose.travel if pose.travel is not None else pose.angle
        return np.full(len(table.rows), held)
    if pose.coordinate is None or pose.equilibrium:
        why = "lets its pose balance by itself" if pose.equilibrium else "has no coordinate that could move"
        raise CaseError(f"angle: the case {why}; state pose.coordinate alone, or leave angle out")
    dimension = "length" if slides else "angle"
    try:
        zero = 0.0 if spec.zero is None else parse(spec.zero, dimension)
    except PydanticCustomError as error:
        raise CaseError(f"zero: {error.message()}") from None
    return zero + sign * table.quantity(angle, dimension)


def _at_instants(spec: CycleSpec, table: NumberTable, values: Real) -> tuple[NumberTable, Real]:
    """Return table and coordinate at evenly spaced instants, where the case asks for some."""
    if spec.instants is None:
        return table, values
    from scipy.interpolate import CubicSpline

    percent = table.values[_CYCLE]
    even = np.linspace(percent[0], percent[-1], spec.instants)
    steady = values - (values[-1] - values[0]) * (percent - percent[0]) / (percent[-1] - percent[0])
    steady[-1] = steady[0] if spec.periodic else steady[-1]
    smooth = CubicSpline(percent, steady, bc_type="periodic" if spec.periodic else "not-a-knot")(even)
    return table.between(_CYCLE, even), smooth + np.interp(even, percent, values - steady)


def _instant(spec: CycleSpec, percent: Real) -> float:
    """Return where in the table the stated instant is."""
    at = spec.instant
    if spec.periodic and at < percent[0]:
        at += _WHOLE
    if not percent[0] - _SAME <= at <= percent[-1] + _SAME:
        raise CaseError(
            f"cycle.instant: {at:g} % is not in the table, from {percent[0]:g} to {percent[-1]:g} %; choose one there"
        )
    return at


def _body_mass(data: Mapping[str, Any], table: NumberTable, references: tuple[ColumnReference, ...]) -> float:
    """Return the mass of the body [kg], where a column that is used is per kilogram of it."""
    per = [one for one in references if table.units[one.column].endswith("/kg")]
    if not per:
        return 1.0
    if "body_mass" not in data:
        raise CaseError(
            f"{per[0].entry}: column {printable(per[0].column)} is in {printable(table.units[per[0].column])}, per "
            'mass of the body, which the case does not state; add body_mass, for example body_mass = "80 kg"'
        )
    try:
        return 1000.0 * parse(data["body_mass"], "mass")
    except PydanticCustomError as error:
        raise CaseError(f"body_mass: {error.message()}") from None


def _text(reference: ColumnReference, table: NumberTable, row: int, mass: float) -> str:
    """Return what stands for a reference at a row."""
    unit, value = table.units[reference.column], reference.sign * float(table.values[reference.column][row])
    if unit.endswith("/kg"):
        unit, value = unit.removesuffix("/kg"), mass * value
    return f"{value!r} {unit}"


def _stated(
    data: Mapping[str, Any], references: tuple[ColumnReference, ...], table: NumberTable, row: int, mass: float
) -> dict[str, Any]:
    """Return tables with the values of a row in place of the columns' names."""
    found = {**data, "load_cases": deepcopy(data["load_cases"])} if references else dict(data)
    for one in references:
        here: Any = found
        for key in one.path[:-1]:
            here = here[key]
        here[one.path[-1]] = _text(one, table, row, mass)
    return found


def _row(
    data: Mapping[str, Any], name: str, own: tuple[ColumnReference, ...], table: NumberTable, row: int, mass: float
) -> LoadCase:
    """Return a load case as it is at a row."""
    only, context = {"load_cases": {name: data["load_cases"][name]}}, {BODY_WEIGHT: weight_of(data.get("body_mass"))}
    try:
        return LoadCase.model_validate(_stated(only, own, table, row, mass)["load_cases"][name], context=context)
    except ValidationError as error:
        told = f"load_cases.{name}.{sentence(error, LoadCase)}"
        entry = told.partition(":")[0].partition(" ")[0]  # that of a column, or one in which it stands
        of = dict.fromkeys(one.column for one in own if f"{one.entry}.".startswith(f"{entry}."))
        raise (table.wrong(table.rows[row], " and ".join(of), told) if of else CaseError(told)) from None


def _moved(data: Mapping[str, Any], pose: PoseSpec, values: Real, at: float) -> dict[str, Any]:
    """Return pose and motion of the case at its instant."""
    stated = data.get("motion", {})
    others = [key for key in stated if key not in OF_MOTION] if isinstance(stated, dict) else []
    if others:
        raise CaseError(
            f"motion.{printable(str(others[0]))}: the table of the cycle says how the linkage moves; leave it out, or "
            "remove [cycle]"
        )
    if isinstance(stated, dict) and stated.get("coordinate", pose.coordinate) != pose.coordinate:
        raise CaseError(
            f"motion.coordinate: the cycle moves the coordinate of the pose, '{pose.coordinate}'; leave it out, or "
            "name the same"
        )
    if pose.coordinate is None:
        return {"motion": {**stated, "poses": len(values)}}
    slides = pose.travel is not None
    dimension = "length" if slides else "angle"

    def text(value: float) -> str:
        return f"{value!r} {'mm' if slides else 'rad'}" if value else as_text(0.0, dimension)

    ends = [text(float(values.min())), text(float(values.max()))]
    return {
        "pose": dict(data.get("pose", {})) | {"travel" if slides else "angle": text(at)},
        "motion": {**stated, "travel" if slides else "range": ends, "poses": len(values)},
    }
