"""Which numbers of a case its tolerances let vary: one independent variable for each."""

import itertools
from collections.abc import Callable, Iterator, Mapping, Sized
from dataclasses import dataclass
from typing import Literal

from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.loads.case.core import CoreCase
from alula.loads.records.tolerances import Distribution, Tolerance
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.explain import printable, require
from alula.loads.text.reason import reason

PINS = "pins"
STRENGTHS = ("yield_strength", "ultimate_strength", "strength_across_layers")
MODULUS = "youngs_modulus"
KNOWN = (
    "pins, links.NAME.points.NAME, pose.angle, pose.travel, load_cases.NAME, load_cases.NAME.forces.0 (or load_lines, "
    "moments, spread), "
    "materials.NAME with yield_strength, ultimate_strength, strength_across_layers or youngs_modulus, and sizes: "
    "a length of parts.NAME, joints.NAME.pin_diameter, links.NAME.eyes.NAME.diameter or links.NAME.holes.0.diameter"
)
Kind = Literal["place", "pose", "load", "force", "material", "size"]


@dataclass(frozen=True, kw_only=True)
class Variable:
    """One number that varies by itself.

    Attributes
    ----------
    tolerance : str
        The entry that is toleranced; both coordinates of a place share it.
    kind : {"place", "pose", "load", "force", "material", "size"}
    target : tuple
        Place: link, point, axis. Load: load case, number among its load lines and then its other stated loads (-1: all
        that acts). Force: load case, number, component. Material: its name, entry. Size: the path of its entry.
    half : float
        Half the width: [mm, rad, N], of loads and materials a share.
    nominal : float
        Of a size, its value [mm].
    distribution : str
        As the case states it.
    """

    tolerance: str
    kind: Kind
    target: tuple[str | int, ...] = ()
    half: float
    nominal: float = 0.0
    distribution: Distribution


def toleranced(case: CoreCase) -> tuple[Variable, ...]:
    """Return what varies by the tolerances of a case.

    Parameters
    ----------
    case : CoreCase

    Returns
    -------
    tuple of Variable
        A place that is stated by itself has that tolerance in place of that of all pins.

    Raises
    ------
    CaseError
        For an entry that the case lacks or that cannot be toleranced.
    """
    found: list[Variable] = []
    own = {path for path in case.tolerances if path.startswith("links.")}
    for path, tolerance in case.tolerances.items():
        if path == PINS:
            for link, point in _pins(case):
                if f"links.{link}.points.{point}" not in own:
                    found += _place(f"links.{link}.points.{point}", link, point, tolerance, path)
        else:
            found += _entry(case, path, tolerance)
    return tuple(found)


def _pins(case: CoreCase) -> dict[tuple[str, str], None]:
    pairs = (
        pair
        for name, joint in case.joints.items()
        for pair in zip(joint.links, case.linkage.joint_points(name), strict=True)
    )
    return dict.fromkeys(pairs)


def _entry(case: CoreCase, path: str, tolerance: Tolerance) -> Iterator[Variable]:
    entry = f"tolerances.{printable(path)}"
    match path.split("."):
        case ["links", link, "points", point]:
            require(entry, link, case.links, "is no link")
            require(entry, point, case.links[link].points, f"is no point of link {link}")
            yield from _place(path, link, point, tolerance, path)
        case ["pose", "angle"] if case.pose.coordinate is not None and case.pose.travel is None:
            half = _half(entry, tolerance, "angle", case.pose.angle)
            yield Variable(tolerance=path, kind="pose", half=half, distribution=tolerance.distribution)
        case ["pose", "travel"] if case.pose.travel is not None:
            half = _half(entry, tolerance, "length", case.pose.travel)
            yield Variable(tolerance=path, kind="pose", half=half, distribution=tolerance.distribution)
        case ["load_cases", load_case, *rest]:
            require(entry, load_case, case.load_cases, "is no load case")
            yield _load(case, entry, path, load_case, rest, tolerance)
        case ["materials", material, field] if field in (*STRENGTHS, MODULUS):
            used = {case.part_of(link).material for link in case.checked_links}
            used |= {joint.pin_material for joint in case.joints.values()}
            require(entry, material, sorted(used), "is no material of a part or a pin")
            value = getattr(case.all_materials[material], field)
            if value is None:
                raise CaseError(f"{entry}: the card of '{material}' states no {field}; tolerance another entry")
            half = _half(entry, tolerance, "stress", value) / value
            if half >= 1.0:
                raise CaseError(f"{entry}: it is as large as the {field} itself; state a smaller tolerance")
            yield Variable(
                tolerance=path,
                kind="material",
                target=(material, field),
                half=half,
                distribution=tolerance.distribution,
            )
        case ["parts", _, *_] | ["joints", _, "pin_diameter"] | ["links", _, "eyes" | "holes", *_]:
            yield _size(case, entry, path, tolerance)
        case _:
            raise CaseError(f"{entry}: this entry cannot have a tolerance; choose one of {KNOWN}")


def _place(path: str, link: str, point: str, tolerance: Tolerance, stated: str) -> Iterator[Variable]:
    half = _half(f"tolerances.{printable(stated)}", tolerance, "length", 0.0)
    for axis in (0, 1):
        yield Variable(
            tolerance=path, kind="place", target=(link, point, axis), half=half, distribution=tolerance.distribution
        )


def _load(case: CoreCase, entry: str, path: str, load_case: str, rest: list[str], tolerance: Tolerance) -> Variable:
    record = case.load_cases[load_case]
    lists: dict[str, Sized] = {"load_lines": record.load_lines, "forces": record.forces, "moments": record.moments}
    lists |= {"pressures": record.pressures, "spread": record.spread}
    make: Callable[..., Variable] = lambda **more: Variable(  # noqa: E731
        tolerance=path, distribution=tolerance.distribution, **more
    )
    if not rest:
        return make(kind="load", target=(load_case, -1), half=_half(entry, tolerance, None, 1.0))
    if rest[0] not in lists or rest[0] == "pressures":
        raise CaseError(f"{entry}: this entry cannot have a tolerance; choose one of {KNOWN}")
    loads = lists[rest[0]]
    if len(rest) < 2 or not rest[1].isdecimal() or int(rest[1]) >= len(loads):
        raise CaseError(f"{entry}: it names none of the {len(loads)} {rest[0]}; count them from 0")
    before = itertools.takewhile(lambda one: one != rest[0], lists)
    number = sum(len(lists[one]) for one in before) + int(rest[1])
    match rest[2:]:
        case []:
            return make(kind="load", target=(load_case, number), half=_half(entry, tolerance, None, 1.0))
        case ["force", ("0" | "1") as component] if rest[0] == "forces":
            nominal = record.forces[int(rest[1])].force[int(component)]
            half = _half(entry, tolerance, "force", nominal, case.body_weight)
            return make(kind="force", target=(load_case, number, int(component)), half=half)
        case ["from" | "to", *_] if rest[0] == "load_lines":
            varied = f'alula study --vary "{printable(path)}=10 mm, 20 mm"'
            raise CaseError(f"{entry}: places of load lines have no tolerance; vary them with {varied}")
    raise CaseError(f"{entry}: this entry cannot have a tolerance; choose one of {KNOWN}")


def _size(case: CoreCase, entry: str, path: str, tolerance: Tolerance) -> Variable:
    """Return the variable of a size of a part, a pin, an eye or a hole."""
    value: object = case
    for step in path.split("."):
        if isinstance(value, Mapping):
            value = value.get(step)
        elif isinstance(value, tuple):
            value = value[int(step)] if step.isdecimal() and int(step) < len(value) else None
        else:
            value = getattr(value, step, None) if step in getattr(type(value), "model_fields", ()) else None
    if not isinstance(value, float) or value <= 0.0:
        raise CaseError(f"{entry}: the case has no such size above zero; choose one of {KNOWN}")
    half = _half(entry, tolerance, "length", value)
    if half >= value:
        raise CaseError(f"{entry}: it is as large as the size itself, {value:g} mm; state a smaller tolerance")
    return Variable(
        tolerance=path, kind="size", target=(path,), half=half, nominal=value, distribution=tolerance.distribution
    )


def _half(
    entry: str, tolerance: Tolerance, dimension: str | None, nominal: float, body_weight: float | None = None
) -> float:
    try:
        return tolerance.half_width(dimension, nominal, body_weight)
    except PydanticCustomError as error:
        raise CaseError(f"{entry}: it is '{printable(tolerance.plus_minus)}', but {error.message()}") from None


def tolerance_caveats(case: CoreCase) -> Iterator[Caveat]:
    """Yield the tolerances, which only ``alula tolerance`` looks at.

    Parameters
    ----------
    case : CoreCase

    Yields
    ------
    Caveat
    """
    if case.tolerances:
        yield Caveat(topic=Topic.TOLERANCES, what=reason("tolerances"), why=reason("tolerance_looks_at_them"))
