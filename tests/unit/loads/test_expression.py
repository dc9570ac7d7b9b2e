import math
import time

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from alula.geometry.base.errors import CaseError
from alula.loads.sources.expression import LONGEST, evaluate, evaluate_number
from alula.loads.sources.quantity import _USUAL, Value, _by_pint

LENGTHS = {("a",): Value.of(3, "mm"), ("link", "whole-wing"): Value.of(4, "cm"), ("kind",): "open"}


def number(text: str, unit: str = "") -> float:
    return evaluate_number(text, LENGTHS.__getitem__).to(unit)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2 + 3 * 4", 14),
        ("(2 + 3) * 4", 20),
        ("2 - 3 - 4", -5),
        ("12 / 3 / 2", 2),
        ("2**3**2", 512),
        ("-2**2", -4),
        ("2^-1", 0.5),
        ("--3", 3),
        ("1.5e-3*.5e3", 0.75),
        ("sqrt(16) + abs(-3) + min(4, 2, 3) + max(1, 5)", 14),
        ("hypot(3, 4)", 5),
        ("mod(-90, 360)", 270),
        ("cos(60 deg) + sin(30 deg) + tan(45 deg)", 2),
        ("pi", math.pi),
        ("52.9 %", 0.529),
    ],
)
def test_arithmetic(text, expected):
    assert number(text) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("41.4 MPa / 11.37 MPa", "", 3.641160949868074),
        ("0.27 m * 0.92593 N/m", "N", 0.2500011),
        ("1450 kg/m^3 * 2 m^3", "t", 2.9),
        ("7.7 cm*sin(90 deg)", "mm", 77),
        ("2 mm * a", "mm^2", 6),
        ("2 kg·m²/s²", "J", 2),
        ("(0.0025 m)^4", "mm^4", 39.0625),
        ("sqrt(9 mm^2)", "mm", 3),
        ("atan2(1 mm, -1 mm)", "deg", 135),
        ("asin(0.5)", "deg", 30),
        ("180 deg - 0.5 turn", "deg", 0),
        ('a + link."whole-wing"', "mm", 43),
        ("500/(10 s)*360 deg", "rpm", 3000),
    ],
)
def test_units(text, unit, expected):
    assert number(text, unit) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_usual_units_are_those_of_pint():
    assert len(_USUAL) > 40
    for unit, known in _USUAL.items():
        assert _by_pint(unit) == known, unit


def test_angles_are_exact():
    assert number("360 deg", "turn") == 1.0
    assert number("cos(180 deg)") == -1.0


def test_words():
    assert evaluate("kind", LENGTHS.__getitem__) == "open"
    assert evaluate("below(1 mm, 1 cm)") == "yes"
    assert evaluate("below(1 cm, 1 mm)") == "no"
    with pytest.raises(CaseError, match="'open' cannot be calculated with"):
        evaluate("kind + 1", LENGTHS.__getitem__)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "it ends too early"),
        ("2 +", "it ends too early"),
        ("2 * * 3", "a number is missing before"),
        ("(2", "a bracket is not closed"),
        ("2 3", "is not understood here"),
        ("1 mm + 1 N", "it adds meter and gram meter second"),
        ("1 deg + 1", "it adds radian and pure numbers"),
        ("sin(0.5)", "sin needs an angle with its unit"),
        ("asin(1 mm)", "asin needs a pure number"),
        ("max(1 mm, 1 N)", "max needs arguments of one dimension"),
        ("asin(2)", "asin has no value there"),
        ("sqrt(-1)", "sqrt has no value there"),
        ("mod(1, 0)", "mod has no value there"),
        ("sin(1 deg, 2 deg)", "sin does not take 2"),
        ("1 / 0", "it divides by zero"),
        ("0**-1", "a power is no finite number"),
        ("(-8)**0.5", "a root of a negative number"),
        ("9**9**9", "a power must be a pure number of at most 16"),
        ("2**1 mm", "a power must be a pure number"),
        ("(1 mm)**0.123", "a quantity with unit cannot be raised"),
        ("1e300 * 1e300", "a result is no finite number"),
        ("1e999", "a result is no finite number"),
        ("(1 mm^4)**16", "a unit gets too high a power"),
        ("3 furlongs_per_moon", "is not understood here"),
        ("2 N*x", "is no unit"),
        ("20 degC", "has a zero of its own"),
        ("3 dB", "has a zero of its own"),
        ("x + 1", "only numbers may stand here"),
        ("__import__('os')", "'__import__' is no function"),
        ("().__class__", "a number is missing before"),
        ("1 .__class__", "is not understood here"),
        ("a.b.__class__", "only numbers may stand here"),
        ("lambda: 1", "only numbers may stand here"),
        ("'a' * 9", "a number is missing before"),
        ("[1]", "a number is missing before"),
        ("(" * 40 + "1" + ")" * 40, "nested too deeply"),
        ("-" * 400 + "1", "nested too deeply"),
        ("1+" * LONGEST + "1", "at most"),
        ("\x1b[2J", "a number is missing before"),
    ],
)
def test_refusals(text, sentence):
    with pytest.raises(CaseError, match=r"^[^\n]*$") as error:
        evaluate(text)
    assert sentence in str(error.value)
    assert "\x1b" not in str(error.value)


def test_a_wrong_unit_is_refused():
    with pytest.raises(CaseError, match="cannot be given in N"):
        evaluate_number("3 mm").to("N")


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.one_of(
        st.text(max_size=80),
        st.text(alphabet="0123456789.eE+-*/^() ,abcmNPk%°\"_[]{}:;@\\'\n\t", max_size=80),
        st.lists(
            st.sampled_from(
                ["9", "1e308", "**", "*", "/", "(", ")", " ", "mm", "N/m", "sqrt", "atan2", ",", "-", "^", "x.y", "deg"]
            ),
            max_size=60,
        ).map("".join),
    )
)
@example("9**9**9**9")
@example("10**16**16")
@example('x."' + "a" * 90 + '"')
@example("1" * 500)
@example("1 " + "m*" * 240 + "m")
@example("9" * 20 + " mm" + "**9")
def test_hostile_text_ends_in_a_number_or_in_one_sentence(text):
    start = time.perf_counter()
    try:
        value = evaluate(text, lambda path: Value.of(2.0, "mm"))
    except CaseError as error:
        sentence, finite = str(error), True
    else:
        sentence, finite = "", isinstance(value, str) or math.isfinite(value.magnitude)
    assert finite
    assert "\n" not in sentence
    assert len(sentence) < 400
    assert time.perf_counter() - start < 2.0


@given(
    st.recursive(
        st.floats(0.1, 10).map(repr),
        lambda inner: st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        max_leaves=12,
    )
)
def test_it_agrees_with_python(text):
    try:
        expected = eval(text)
    except ZeroDivisionError:
        return
    assert number(text) == expected
