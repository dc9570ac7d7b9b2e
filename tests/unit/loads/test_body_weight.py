"""The weight of a stated body as a unit of forces and moments."""

import tomllib
from importlib.resources import files

import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse
from alula.loads.case.case_file import built_in_cases, read_case, validate
from alula.loads.case.toleranced import toleranced
from alula.loads.compose.stated_case import StatedCase
from alula.reports.workbench.live.answers import pose_answer

STARTER = (files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8")
LINE = {"from": ["0 mm", "90 mm"], "to": ["30 mm", "0 mm"], "force": "-0.5 body_weight", "link": "rocker", "at": "P"}
CORD = {"through": [{"link": "base", "at": "O2"}, {"link": "rocker", "at": "P"}], "tension": "0.25 body_weight"}
STAND = {
    "forces": [{"link": "rocker", "at": "P", "force": ["1.1 body_weight", "-20 N", "1e-1 body_weight"]}],
    "moments": [
        {"link": "rocker", "at": "P", "moment": "0.05 body_weight*m"},
        {"link": "rocker", "at": "P", "moment": ["2 body_weight*mm", "3 N*mm", "-1 body_weight cm"]},
    ],
    "spread": [{"link": "coupler", "start": "A", "end": "B", "total": ["0 N", "2 body_weight"]}],
    "load_lines": [LINE],
}


def tables(mass="80 kg", **changes):
    stated = tomllib.loads(STARTER) | {"body_mass": mass, "load_cases": {"stand": STAND}, "tendons": {"cord": CORD}}
    stated |= changes
    return {key: value for key, value in stated.items() if value is not None}


@pytest.mark.parametrize(("mass", "weight"), [("80 kg", 784.532), ("62500 g", 612.915625)])
def test_forces_and_moments_are_shares_of_the_weight(mass, weight):
    """m times 9.80665 m/s², whatever the unit of the mass and of the arm."""
    case = validate(tables(mass))
    stand = case.load_cases["stand"]
    assert stand.forces[0].force == pytest.approx((1.1 * weight, -20.0, 0.1 * weight), rel=1e-12)
    assert stand.moments[0].moment == pytest.approx((0.0, 0.0, 50.0 * weight), rel=1e-12)
    assert stand.moments[1].moment == pytest.approx((2.0 * weight, 3.0, -10.0 * weight), rel=1e-12)
    assert stand.spread[0].total == pytest.approx((0.0, 2.0 * weight), rel=1e-12)
    assert stand.load_lines[0].force == pytest.approx(-0.5 * weight, rel=1e-12)
    assert case.tendons["cord"].tension == pytest.approx(0.25 * weight, rel=1e-12)


def test_a_tolerance_in_body_weights():
    [found] = toleranced(validate(tables(tolerances={"load_cases.stand.forces.0.force.1": "0.1 body_weight"})))
    assert found.half == pytest.approx(78.4532, rel=1e-12)


def test_another_mass_is_another_case_with_the_same_text():
    case = StatedCase.from_dict(tables())
    heavy = case.with_values({"body_mass": "100 kg"})
    assert heavy.load_cases["stand"].spread[0].total[1] == pytest.approx(1961.33)
    assert case.load_cases["stand"].spread[0].total[1] == pytest.approx(1569.064)
    assert tomllib.loads(heavy.to_toml()) == tables("100 kg")
    added = case.with_load_case("step", forces=[{"link": "rocker", "at": "P", "force": ["0 N", "1 body_weight"]}])
    assert added.load_cases["step"].forces[0].force[1] == pytest.approx(784.532)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": None}, r"tendons\.cord\.tension \(it is '0.25 body_weight'\): no body is stated .* body_mass = "),
        ({"mass": None, "tendons": {}}, r"load_cases\.stand\.forces\.0\.force\.0 \(it is '1.1 body_weight'\): no body"),
        ({"mass": "0 kg"}, r"body_mass \(it is '0 kg'\): it must be greater than zero"),
        ({"mass": "80"}, r"body_mass \(it is '80'\): the mass needs its unit"),
        ({"mass": "80 N"}, r'body_mass.*"N" is not a unit of mass'),
        ({"mass": 80}, r"body_mass \(it is 80\): the mass needs its unit as text"),
    ],
)
def test_a_body_that_is_not_stated_is_asked_for(change, message):
    with pytest.raises(CaseError, match=message) as refused:
        validate(tables(**change))
    assert ("more problems" in str(refused.value)) == (change["mass"] is None), (
        "a mass that is none is the only problem"
    )


@pytest.mark.parametrize(
    ("text", "dimension"),
    [
        ("2 body_weight", "length"),
        ("2 body_weight*m", "force"),
        ("2 body_weight", "moment"),
        ("2 body_weight^2", "force"),
        ("2 body_weights", "force"),
        ("2 body_weight*body_weight", "force"),
        ("2 N*body_weight", "moment"),
    ],
)
def test_it_is_a_unit_of_force_alone(text, dimension):
    unit = text.split(" ", 1)[1]
    with pytest.raises(Exception, match="is not a unit of") as refused:
        parse(text, dimension, 700.0)
    assert f'"{unit}" is not a unit of {dimension}' in str(refused.value)


def test_what_cannot_be_calculated_yet_is_drawn_with_its_weight():
    text = STARTER.replace('force = ["0 N", "-5 N"]', 'force = ["0 N", "-1 body_weight"]')
    broken = text.replace("[drive]\n", "[drive]\ntransfer = 5\n")
    [force] = pose_answer(f'body_mass = "80 kg"\n{broken}', "x")["drawn"]["loads"]
    assert force["vector"] == pytest.approx([0.0, -784.532])
    assert "body_mass" in pose_answer(text, "x")["problem"]


def test_no_built_in_case_is_read_otherwise():
    assert all(read_case(name).body_mass is None for name in built_in_cases())
