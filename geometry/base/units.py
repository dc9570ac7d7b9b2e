"""Quantities with units at the border, plain floats inside.

Inside alula lengths are mm, forces N, masses tonne, times s, angles rad, temperatures °C; hence
stresses are MPa and densities tonne/mm³. At the border (case files, the Python API, ``--set``)
every number with a dimension is text with its unit, such as ``"125 mm"``; a bare number is refused.

The types below (``Length``, ``Angle``, ...) are floats for the type checker and parse such text
when they stand in a pydantic model.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any

from pydantic import Field, ValidationInfo
from pydantic_core import PydanticCustomError, core_schema

from alula.geometry.base.model import refusal
from alula.geometry.base.usual_units import CELSIUS, USUAL

INTERNAL_UNITS = {
    "length": "mm",
    "area": "mm^2",
    "volume": "mm^3",
    "angle": "rad",
    "force": "N",
    "moment": "N*mm",
    "line load": "N/mm",
    "stiffness": "N/mm",
    "torsional stiffness": "N*mm/rad",
    "stress": "MPa",
    "fracture toughness": "MPa*mm^0.5",
    "mass": "tonne",
    "density": "tonne/mm^3",
    "time": "s",
    "speed": "mm/s",
    "acceleration": "mm/s^2",
    "angular speed": "rad/s",
    "angular acceleration": "rad/s^2",
    "power": "N*mm/s",
    "temperature": "degC",
    "voltage": "V",
    "current": "A",
    "memory": "B",
}
EXAMPLES = {
    "length": "125 mm",
    "area": "20 mm^2",
    "volume": "800 mm^3",
    "angle": "30 deg",
    "force": "0.25 N",
    "moment": "130 N*mm",
    "line load": "0.9 N/m",
    "stiffness": "0.5 N/mm",
    "torsional stiffness": "12 N*mm/rad",
    "stress": "2.4 GPa",
    "fracture toughness": "1.0 MPa*m^0.5",
    "mass": "25 g",
    "density": "1450 kg/m^3",
    "time": "10 year",
    "speed": "22 m/s",
    "acceleration": "9.81 m/s^2",
    "angular speed": "3500 rpm",
    "angular acceleration": "15 rad/s^2",
    "power": "1 W",
    "temperature": "23 degC",
    "voltage": "6 V",
    "current": "170 mA",
    "memory": "4 GB",
}
LEAST, LARGEST = 1e-20, 1e20
"""Sizes in alula's units beyond which a quantity is taken for a mistake. Nothing that is built comes near, and what is
computed from sizes between them stays finite (measured: statics, motion and hand calculation with one to three
quantities at either end)."""
LARGEST_ANGLE = 1e6
"""Up to it [rad] a double tells a direction within 1e-9 rad, to which poses and stops are held."""
BODY_WEIGHT = "body_weight"
"""The unit of force that is the weight of the body whose mass a case states, and its key in a validation's context."""
STANDARD_GRAVITY = 9806.65
"""By definition (3rd CGPM, 1901) [mm/s²]."""
_LONGEST_TEXT = 64
_UNIT_NAME = r"[A-Za-zµμ°Ω]+(?:(?:\^|\*\*)-?(?:[01]\.5|[1-4]))?"
TYPOGRAPHY = str.maketrans(
    {"·": "*", "⋅": "*", "×": "*", "²": "^2", "³": "^3", "⁴": "^4", "−": "-"} | dict.fromkeys("\u00a0\u2009\u202f", " ")
)
"""Signs that people paste from books and word processors, as pint writes them."""


@cache
def registry() -> Any:
    """Return the one pint registry (made at first use: importing pint is slow)."""
    import pint

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)


def parse(text: object, dimension: str, body_weight: float | None = None) -> float:
    """Convert text such as ``"2.4 GPa"`` to a float in alula's unit of its dimension.

    Parameters
    ----------
    text : object
        What stands in the case file.
    dimension : str
        A key of ``INTERNAL_UNITS``, such as ``"stress"``.
    body_weight : float, optional
        What the unit ``body_weight`` stands for [N]; it is refused where left out.

    Returns
    -------
    float
        The value in ``INTERNAL_UNITS[dimension]``.

    Raises
    ------
    PydanticCustomError
        For anything but text made of one finite number and one unit of the dimension; a model adds the entry's name.
    """
    example = f'write for example "{EXAMPLES[dimension]}"'
    if isinstance(text, bool | int | float):
        raise refusal(f"the {dimension} needs its unit as text; {example}")
    if not isinstance(text, str):
        raise refusal(f"the {dimension} must be text with a number and a unit; {example}")
    number, unit = _split(text)
    if number is None or not math.isfinite(number):
        raise refusal(f"the {dimension} must be one finite number and its unit; {_comma_remedy(text) or example}")
    if not unit:
        raise refusal(f"the {dimension} needs its unit; {example}")
    of_body = unit.startswith(BODY_WEIGHT) and unit[len(BODY_WEIGHT) :][:1] in ("", " ", "*", "/")
    known = unit.replace(BODY_WEIGHT, "N", 1) if of_body else unit
    conversion = _usual(known, dimension) or _conversion(known, dimension)
    if conversion is None:
        raise refusal(f'"{unit}" is not a unit of {dimension}; {example}')
    if of_body:
        if body_weight is None:
            raise refusal(
                'no body is stated that weighs so much; write for example body_mass = "80 kg" above all tables'
            )
        number *= body_weight
    factor, offset = conversion
    value = number * factor + offset
    largest = LARGEST_ANGLE if dimension == "angle" else LARGEST
    if value != 0.0 and not LEAST <= abs(value) <= largest:
        limit, zero = (f"at most {largest:g}", "") if abs(value) > largest else (f"at least {LEAST:g}", ", or write 0")
        size = f"{limit} {INTERNAL_UNITS[dimension]} in size"
        raise refusal(f"the {dimension} must be {size}; check the number and its unit{zero}")
    return value


def weight_of(body_mass: object) -> float | None:
    """Return the weight of a body, under standard gravity.

    Parameters
    ----------
    body_mass : object
        What stands in the case file.

    Returns
    -------
    float or None
        [N]; None where no mass is stated. Of what is no mass any, since that is refused by itself.
    """
    try:
        return None if body_mass is None else parse(body_mass, "mass") * STANDARD_GRAVITY
    except PydanticCustomError:
        return 1.0


def as_text(value: float, dimension: str) -> str:
    """Return text that ``parse`` reads as a value, in the unit in which people state its dimension.

    Parameters
    ----------
    value : float
        In alula's unit.
    dimension : str
        A key of ``INTERNAL_UNITS``.

    Returns
    -------
    str
        Such as ``"9.81 m/s^2"``.
    """
    unit = EXAMPLES[dimension].split(" ", 1)[1]
    one, zero = parse(f"1 {unit}", dimension), parse(f"0 {unit}", dimension)
    return f"{(value - zero) / (one - zero):.12g} {unit}"


def _comma_remedy(text: str) -> str:
    """Return how a number with commas is to be written; empty where commas are not what is wrong."""
    import re

    decimal, plain = text.replace(",", "."), re.sub(r"(?<=\d),(?=\d{3}(?!\d))", "", text, flags=re.ASCII)
    ways = {f'use a decimal point: "{decimal}"': decimal, f'leave out the separator: "{plain}"': plain}
    return ", or ".join(way for way, changed in ways.items() if changed != text and _split(changed)[0] is not None)


def _split(text: str) -> tuple[float | None, str]:
    """Split ``"2.4 GPa"`` into its number and its unit, without evaluating anything."""
    import re

    if len(text) > _LONGEST_TEXT:
        return None, ""
    plain = text.translate(TYPOGRAPHY)
    match = re.fullmatch(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", plain, re.ASCII)
    if not match or (match[2] and not match[2][0].isalpha() and match[2][0] not in "°/"):
        return None, ""
    return float(match[1]), match[2]


def _usual(unit: str, dimension: str) -> tuple[float, float] | None:
    """Return factor and offset of a unit of the table; None where it has none of this dimension."""
    if dimension == "temperature" and unit in CELSIUS:
        return 1.0, 0.0
    known = USUAL.get(dimension, {}).get(unit)
    return known and (known[0], 0.0)


@cache
def _conversion(unit: str, dimension: str) -> tuple[float, float] | None:
    """Return factor and offset from ``unit`` to alula's unit; None where it has another dimension.

    pint takes radians for pure numbers. So the root units are compared as well: "50 percent" is no
    angle, "5 mm*deg" no length, and "58 Hz" no angular speed (it would pass for 58 rad/s).
    """
    import re

    # Only unit names, powers, products and quotients reach pint: no numbers, no calls.
    if not re.fullmatch(rf"{_UNIT_NAME}(?:(?:\s*[*/]\s*|\s+){_UNIT_NAME})*", unit):
        return None
    units = registry()
    target = INTERNAL_UNITS[dimension]
    try:
        if units.get_root_units(unit)[1] != units.get_root_units(target)[1]:
            return None
        zero = float(units.Quantity(0.0, unit).to(target).magnitude)
        one = float(units.Quantity(1.0, unit).to(target).magnitude)
    except Exception:  # pint raises a dozen unrelated types for bad unit text
        return None
    return (one - zero, zero) if dimension == "temperature" else (one, 0.0)


def weight_in(info: ValidationInfo) -> float | None:
    """Return what ``body_weight`` stands for in a validation.

    Parameters
    ----------
    info : ValidationInfo
        Its context may have it.

    Returns
    -------
    float or None
        [N]
    """
    return (info.context or {}).get(BODY_WEIGHT)


class Dimensioned:
    """Tells pydantic to read a field as text with a number and a unit of the given dimension."""

    def __init__(self, dimension: str) -> None:
        self.dimension = dimension

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Parse text to a float in alula's unit."""
        return core_schema.with_info_plain_validator_function(
            lambda text, info: parse(text, self.dimension, weight_in(info))
        )

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        """Describe the field as text, with an example."""
        return {
            "type": "string",
            "format": self.dimension,
            "description": f"{self.dimension} with its unit",
            "examples": [EXAMPLES[self.dimension]],
        }


class Rule:
    """A rule on a value; the JSON Schema states it in words, since it has none for text with a unit."""

    def __init__(self, check: Callable[[float], float], words: str) -> None:
        self.check, self.words = check, words

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Check the value after it was read."""
        return core_schema.no_info_after_validator_function(self.check, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        """State the rule beside the value's own schema."""
        return {**handler(schema), "x-rule": self.words}


def _positive(value: float) -> float:
    if value <= 0.0:
        raise PydanticCustomError("not_positive", "it must be greater than zero")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise PydanticCustomError("negative", "it must not be negative")
    return value


def _sized(value: float) -> float:
    if not LEAST <= abs(value) <= LARGEST:
        raise refusal(f"it must be {LEAST:g} to {LARGEST:g}; check the number")
    return value


POSITIVE = Rule(_positive, "greater than zero")
NOT_NEGATIVE = Rule(_not_negative, "not negative")
SIZED = Rule(_sized, f"{LEAST:g} to {LARGEST:g}")

Number = Annotated[float, Field(gt=0), SIZED]
"""A pure number above zero, of a size that quantities may have: a limit, a factor, how often loads come and go."""

Length = Annotated[float, Dimensioned("length")]
Area = Annotated[float, Dimensioned("area")]
Volume = Annotated[float, Dimensioned("volume")]
Angle = Annotated[float, Dimensioned("angle")]
Force = Annotated[float, Dimensioned("force")]
Moment = Annotated[float, Dimensioned("moment")]
LineLoad = Annotated[float, Dimensioned("line load")]
Stiffness = Annotated[float, Dimensioned("stiffness")]
TorsionalStiffness = Annotated[float, Dimensioned("torsional stiffness")]
Stress = Annotated[float, Dimensioned("stress")]
Toughness = Annotated[float, Dimensioned("fracture toughness")]
Mass = Annotated[float, Dimensioned("mass")]
Density = Annotated[float, Dimensioned("density")]
Time = Annotated[float, Dimensioned("time")]
Speed = Annotated[float, Dimensioned("speed")]
Acceleration = Annotated[float, Dimensioned("acceleration")]
AngularSpeed = Annotated[float, Dimensioned("angular speed")]
AngularAcceleration = Annotated[float, Dimensioned("angular acceleration")]
Power = Annotated[float, Dimensioned("power")]
Temperature = Annotated[float, Dimensioned("temperature")]
Voltage = Annotated[float, Dimensioned("voltage")]
Current = Annotated[float, Dimensioned("current")]
