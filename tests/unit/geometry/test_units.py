import builtins
import math
import operator
import os
import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from alula.geometry.base import units
from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import EXAMPLES, INTERNAL_UNITS, NOT_NEGATIVE, POSITIVE, parse
from alula.geometry.base.usual_units import CELSIUS, USUAL

# (dimension, text, value in alula's unit), worked out by hand from the definitions of the units.
KNOWN = [
    ("length", "125 mm", 125.0),
    ("length", "1 in", 25.4),
    ("length", "\t5\u00a0mm\n", 5.0),
    ("length", "0.27 m", 270.0),
    ("length", "+1e-1 cm", 1.0),
    ("length", "3 µm", 0.003),
    ("area", "2 cm^2", 200.0),
    ("area", "20 mm²", 20.0),
    ("volume", "0.8 cm^3", 800.0),
    ("fracture toughness", "2 MPa*m^0.5", 2.0 * math.sqrt(1000.0)),
    ("fracture toughness", "2 N/mm^1.5", 2.0),
    ("angle", "180 deg", math.pi),
    ("angle", "90°", math.pi / 2),
    ("angle", "-0.5 rad", -0.5),
    ("angle", "1 turn", 2 * math.pi),
    ("force", "0.25 N", 0.25),
    ("force", "1 kgf", 9.80665),
    ("force", "−2 kN", -2000.0),
    ("moment", "130 N·mm", 130.0),
    ("moment", "0.13 N m", 130.0),
    ("line load", "0.9 N/m", 0.0009),
    ("stiffness", "500 N/m", 0.5),
    ("torsional stiffness", "0.012 N*m/rad", 12.0),
    ("torsional stiffness", "1 N*mm/deg", 180.0 / math.pi),
    ("stress", "2.4 GPa", 2400.0),
    ("stress", "41.4 N/mm²", 41.4),
    ("mass", "25 g", 25e-6),
    ("density", "1450 kg/m^3", 1.45e-9),
    ("density", "1.45 g/cm³", 1.45e-9),
    ("time", "2 h", 7200.0),
    ("speed", "22 m/s", 22000.0),
    ("acceleration", "9.81 m/s^2", 9810.0),
    ("angular speed", "3500 rpm", 3500 * 2 * math.pi / 60),
    ("angular speed", "180 deg/s", math.pi),
    ("angular acceleration", "15 rad/s²", 15.0),
    ("power", "1 W", 1000.0),
    ("temperature", "23 degC", 23.0),
    ("temperature", "23 °C", 23.0),
    ("temperature", "296.15 K", 23.0),
    ("temperature", "-40 degF", -40.0),
    ("voltage", "6 V", 6.0),
    ("current", "170 mA", 0.17),
    ("memory", "4 GB", 4e9),
    ("memory", "1.5 GiB", 1.5 * 2**30),
]


@pytest.mark.parametrize(("dimension", "text", "value"), KNOWN)
def test_known_conversions(dimension: str, text: str, value: float) -> None:
    assert parse(text, dimension) == pytest.approx(value, rel=1e-9, abs=1e-12)


def test_usual_units_are_those_of_pint() -> None:
    """To the last digit: a case gives the same numbers whichever of both reads it."""
    assert set(USUAL) | {"temperature"} == set(INTERNAL_UNITS)
    for dimension, known in USUAL.items():
        for unit, (factor, _) in known.items():
            assert units._conversion(unit, dimension) == (factor, 0.0), (dimension, unit)
    assert {units._conversion(unit, "temperature") for unit in CELSIUS} == {(1.0, 0.0)}


def test_every_dimension_is_tested_and_its_example_and_unit_parse() -> None:
    assert {dimension for dimension, _, _ in KNOWN} == set(INTERNAL_UNITS) == set(EXAMPLES)
    for dimension, unit in INTERNAL_UNITS.items():
        assert parse(f"1.5 {unit}", dimension) == pytest.approx(1.5, rel=1e-15)
        assert math.isfinite(parse(EXAMPLES[dimension], dimension))


@pytest.mark.parametrize("dimension", INTERNAL_UNITS)
def test_the_unit_of_any_other_dimension_is_refused(dimension: str) -> None:
    for unit in INTERNAL_UNITS.values():
        if unit != INTERNAL_UNITS[dimension]:  # a stiffness and a line load share theirs
            with pytest.raises(PydanticCustomError, match=f"is not a unit of {dimension}"):
                parse(f"1 {unit}", dimension)


@pytest.mark.parametrize(
    ("dimension", "text"),
    [
        ("angle", "50 percent"),  # pint would give 0.5 rad
        ("angle", "0.5 mm/mm"),
        ("length", "5 mm*deg"),  # pint would give 0.087 mm
        ("angular speed", "58 Hz"),  # pint would give 58 rad/s, but 58 turns a second are meant
        ("moment", "1 N*mm*rad"),
        ("force", "1 kg"),
        ("stress", "1 mpa"),
        ("temperature", "1 delta_degC"),
        ("length", "5 nan"),
        ("length", "5 mm mm"),
        ("length", "5 "),
        ("length", "5 3 mm"),
        ("length", "5 mm + 3 mm"),
        ("length", "5 mm^9"),
        ("length", "5 m^99999999"),
        ("length", "5 (mm)"),
        ("length", "5 mm.__class__"),
        ("length", "0x10 mm"),
        ("length", "1e5e5 mm"),
        ("length", "5 /mm"),
    ],
)
def test_a_unit_of_the_wrong_kind_is_refused(dimension: str, text: str) -> None:
    with pytest.raises(PydanticCustomError):
        parse(text, dimension)


@pytest.mark.parametrize("number", [125, 0, 1.5, True, math.nan, math.inf, "125", "0", " 1.5 "])
def test_a_bare_number_asks_for_its_unit(number: object) -> None:
    with pytest.raises(PydanticCustomError, match=r'needs its unit.* "125 mm"'):
        parse(number, "length")


@pytest.mark.parametrize(
    "text",
    [
        *["", " ", "mm", "nan mm", "inf mm", "-inf mm", "1e999 mm", "1_000 mm", "١ mm", "--1 mm"],
        *["1 mm" + " " * 100, "9" * 100 + " mm", None, [], {}, b"1 mm", ("1 mm",)],
    ],
)
def test_nonsense_is_refused_with_an_example(text: object) -> None:
    with pytest.raises(PydanticCustomError, match=r'write for example "125 mm"'):
        parse(text, "length")


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("1,5 mm", 'use a decimal point: "1.5 mm"'),
        ("-0,25 mm", 'use a decimal point: "-0.25 mm"'),
        ("1,500 mm", 'use a decimal point: "1.500 mm", or leave out the separator: "1500 mm"'),
        ("1,234.5 mm", 'leave out the separator: "1234.5 mm"'),
        ("1,234,567 mm", 'leave out the separator: "1234567 mm"'),
        ("1,23,4 mm", 'write for example "125 mm"'),
        ("1.234,5 mm", 'write for example "125 mm"'),
    ],
)
def test_a_comma_is_answered_with_how_to_write_the_number(text: str, remedy: str) -> None:
    with pytest.raises(PydanticCustomError) as caught:
        parse(text, "length")
    assert caught.value.message() == f"the length must be one finite number and its unit; {remedy}"


@pytest.mark.parametrize(("text", "dimension"), [("1e308 km", "length"), ("1e306 GPa", "stress")])
def test_a_number_that_overflows_in_the_conversion_is_refused(text: str, dimension: str) -> None:
    with pytest.raises(PydanticCustomError, match=r"at most 1e\+20"):
        parse(text, dimension)


def test_the_range_of_sizes() -> None:
    """No star is 1e17 m thick, and rounding in a script leaves 1e-17: sizes of 1e-20 to 1e20 and zero are accepted."""
    for text, value in (("0 N", 0.0), ("-1e20 N", -1e20), ("1e-20 N", 1e-20), ("-6e-17 N", -6e-17)):
        assert parse(text, "force") == value
    with pytest.raises(
        PydanticCustomError, match=r"force must be at most 1e\+20 N in size; check the number and its unit$"
    ):
        parse("-1e18 kN", "force")
    with pytest.raises(PydanticCustomError, match=r"the length must be at least 1e-20 mm in size; .*, or write 0$"):
        parse("1e-24 m", "length")
    with pytest.raises(PydanticCustomError, match=r"must be at most 1e\+20 degC"):
        parse("1e300 kelvin", "temperature")


def test_nothing_is_evaluated_and_no_file_is_reached(monkeypatch: pytest.MonkeyPatch, tmp_path: object) -> None:
    parse("1 mm", "length")  # whatever is imported late is imported now
    reached = []
    for module, name in [(os, "system"), (subprocess, "Popen"), (builtins, "open"), (builtins, "eval"), (os, "stat")]:
        monkeypatch.setattr(module, name, lambda *a, **k: reached.append(a))
    for text in [
        "1 __import__('os').system('true')",
        "__import__('os').system('true') mm",
        "1 eval(1)",
        "1 /etc/passwd",
        "1 @import/etc/passwd",
        "1 ../../etc/passwd",
        "1 file:///etc/passwd",
        "9**9**9 mm",
        "1 mm**9**9**9",
        "1 1e9999",
    ]:
        with pytest.raises(PydanticCustomError):
            parse(text, "length")
    monkeypatch.undo()
    assert reached == []


@given(st.text(max_size=80))
def test_any_text_is_a_finite_number_or_a_refusal(text: str) -> None:
    for dimension in ("length", "angle", "temperature"):
        try:
            value = parse(text, dimension)
        except PydanticCustomError:
            continue
        assert math.isfinite(value)


SIZES = st.floats(min_value=1e-16, max_value=1e16)


@given(st.one_of(st.just(0.0), SIZES, SIZES.map(operator.neg)))
def test_numbers_survive(number: float) -> None:
    assert parse(f"{number!r} mm", "length") == number
    assert parse(f"{number!r} mm", "length") == pytest.approx(1000.0 * parse(f"{number!r} µm", "length"), rel=1e-12)


class _Sizes(CaseModel):
    positive: units.Annotated[units.Length, POSITIVE] = 1.0
    not_negative: units.Annotated[units.Length, NOT_NEGATIVE] = 0.0


def test_signs_are_checked_in_models() -> None:
    assert _Sizes(positive="1 cm", not_negative="0 mm").positive == 10.0  # type: ignore[arg-type]
    with pytest.raises(ValidationError, match="greater than zero"):
        _Sizes(positive="0 mm")  # type: ignore[arg-type]
    with pytest.raises(ValidationError, match="must not be negative"):
        _Sizes(not_negative="-1e-9 mm")  # type: ignore[arg-type]


def test_the_json_schema_says_text_with_a_unit() -> None:
    schema = _Sizes.model_json_schema()["properties"]["positive"]
    assert schema["type"] == "string"
    assert schema["examples"] == ["125 mm"]
