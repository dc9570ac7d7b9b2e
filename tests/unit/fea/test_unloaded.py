"""A check of which nothing is asked is undecided: loads of zero, or that cancel at one point; others are a load."""

import tomllib
from importlib.resources import files

import pytest
from edited_cases import edited

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.motion.envelope import envelope_case
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

STARTER = files("alula.loads") / "cases" / "four-bar.toml"
MOTION = ["motion.turn=true", "motion.poses=13"]
PINS = 'checks.pins={type="pins", minimum=2.0}'


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "four-bar.toml"
    path.write_text(STARTER.read_text(encoding="utf-8"), encoding="utf-8")
    return str(path)


def loaded(**stated):
    """The starter's load case with these loads alone, each as TOML."""
    entries = ", ".join(f"{kind} = {loads}" for kind, loads in stated.items())
    return f"load_cases.lift={{{entries}}}"


def force(x, y, at="P", link="rocker", axes="global"):
    return f'{{link="{link}", at="{at}", force=["{x} N", "{y} N"], axes="{axes}"}}'


def moment(size, at="P"):
    return f'{{link="rocker", at="{at}", moment="{size} N*mm"}}'


def spread(size, start, end):
    return f'{{link="rocker", start="{start}", end="{end}", total=["0 N", "{size} N"]}}'


NOTHING = {
    "zero force": loaded(forces=f"[{force(0, 0)}]"),
    "no load at all": loaded(title='"empty"'),
    "two forces at one point": loaded(forces=f"[{force(3, 5)}, {force(-3, -5)}]"),
    "three forces whose sum is rounding": loaded(forces=f"[{force(0.1, 0)}, {force(0.2, 0)}, {force(-0.3, 0)}]"),
    "two moments at one point": loaded(moments=f"[{moment(100)}, {moment(-100)}]"),
    "two spread loads on one stretch": loaded(spread=f"[{spread(4, 'O4', 'P')}, {spread(-4, 'P', 'O4')}]"),
    "a spread load in two halves against the whole": loaded(
        spread=f"[{spread(4, 'O4', 'B')}, {spread(2, 'B', 'P')}, {spread(-6, 'O4', 'P')}]"
    ),
    "weight without gravity": loaded(own_weight="true", gravity='"0 m/s^2"'),
    "zero spread": loaded(spread=f"[{spread(0, 'O4', 'P')}]"),
    "air without lift or drag": loaded(
        air='[{drag="0 N", stream=[1, 0, 0], spread=[{link="rocker", start="O4", end="P"}]}]'
    ),
}
SOMETHING = {
    "pulled apart between a pin and its end": loaded(
        forces=f"[{force(5, 0, 'B', axes='link')}, {force(-5, 0, 'P', axes='link')}]"
    ),
    "a moment and a force at different points": loaded(
        moments=f"[{moment(100)}]", forces=f"[{force(0, -5, 'B', axes='link')}]"
    ),
    "spread loads that overlap in part": loaded(spread=f"[{spread(4, 'O4', 'P')}, {spread(-4, 'B', 'P')}]"),
    "a force of a micronewton": loaded(forces=f"[{force(0, '1e-6')}]"),
    "weight alone": loaded(own_weight="true"),
    "speed alone": loaded(speed='"60 rpm"'),
}


@pytest.mark.parametrize("load_case", NOTHING.values(), ids=NOTHING)
def test_no_check_passes_without_a_load(path, load_case):
    result = check_case(edited(path, [load_case, PINS]), fidelity="beam")
    [found] = result.load_cases.values()
    assert found.checks
    assert {check.verdict for check in found.checks} == {Verdict.UNDECIDED}
    assert all("nothing acts inside any link under load case 'lift'" in told(check.reason) for check in found.checks)
    assert result.verdict is Verdict.UNDECIDED
    assert result.warnings[0] == found.checks[0].reason


IDLE = ("strength", "layers")
"""Checks of each link by itself, of which some bear nothing."""


@pytest.mark.parametrize("load_case", SOMETHING.values(), ids=SOMETHING)
def test_what_acts_inside_a_link_is_a_load(path, load_case):
    [found] = check_case(edited(path, [load_case, PINS]), fidelity="beam").load_cases.values()
    assert not any("nothing acts" in told(check.reason) for check in found.checks if check.name not in IDLE)
    assert any(link.von_mises_max.value > 0.0 for link in found.links.values())


def test_a_force_straight_into_a_ground_pin_loads_that_pin_alone(path):
    """It enters link and pin at one point, so nothing is inside the link, but the pin bears it."""
    case = edited(path, [loaded(forces=f"[{force(0, -5, 'O4')}]"), PINS])
    [found] = check_case(case, fidelity="beam").load_cases.values()
    decided = {check.link for check in found.checks if check.verdict is not Verdict.UNDECIDED}
    assert decided == {"pin O4"}
    assert found.pins["O4"].equivalent.value > 0.0


def test_one_idle_load_case_leaves_the_others_alone(path):
    case = edited(path, [loaded(own_weight="true"), 'load_cases.idle={title="nothing"}', PINS])
    result = check_case(case, fidelity="beam")
    assert all(c.verdict is Verdict.UNDECIDED for c in result.load_cases["idle"].checks)
    pins = [c.verdict for c in result.load_cases["lift"].checks if c.name == "pins"]
    assert set(pins) == {Verdict.PASS}
    assert result.verdict is Verdict.UNDECIDED


@pytest.mark.parametrize("idle", ["zero force", "three forces whose sum is rounding", "weight without gravity"])
def test_an_envelope_passes_nothing_without_a_load(path, idle):
    result = envelope_case(edited(path, [*MOTION, NOTHING[idle], PINS]))
    assert result.verdict is Verdict.UNDECIDED
    assert {check.name for check in result.checks} == {"strength", "pins"}
    assert {check.verdict for check in result.checks} == {Verdict.UNDECIDED}
    assert "nothing acts inside any link under load case 'lift'" in told(result.warnings[0])


@pytest.mark.parametrize(
    "load",
    [
        'forces=[{link="base", at="O2", force=["0 N", "-5 N"]}]',
        'moments=[{link="base", at="O2", moment="5 N*mm"}]',
        'spread=[{link="base", start="O2", end="O4", total=["0 N", "-5 N"]}]',
    ],
)
def test_a_load_on_the_ground_is_refused(path, load):
    kind = load.partition("=")[0]
    with pytest.raises(CaseError, match=rf"load_cases.lift.{kind}.0.link: 'base' is not a moving link; choose one of"):
        edited(path, [f"load_cases.lift={{{load}}}"])


def test_an_arm_that_a_load_case_leaves_alone_is_undecided_there() -> None:
    """Held by one pin it has no second loaded place; the case could not be run for it."""
    arm = validate(
        tomllib.loads("""
schema_version = 1
title = "An arm"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], X = ["9 mm", "0 mm"] } }
links.arm = { part = "bar", end_patch = "2 mm", points = { O = ["0 mm", "0 mm"], W = ["30 mm", "0 mm"] } }
joints.O = { links = ["base", "arm"], pin_diameter = "4 mm" }
pose = { coordinate = "arm", angle = "0 deg" }
drive = { link = "arm", joint = "O" }
load_cases.lift = { forces = [{ link = "arm", at = "W", force = ["0 N", "-1 N"] }] }
load_cases.still = {}
parts.bar = { shape = "bar", material = "pla-fdm-xy", width = "10 mm", thickness = "3 mm", fillet_radius = "0 mm" }
""")
    )
    found = check_case(arm, fidelity="beam").load_cases
    [idle] = [one for one in found["still"].checks if one.quantity is Quantity.SAFETY_FACTOR]
    assert idle.verdict is Verdict.UNDECIDED
    assert "nothing acts inside any link" in told(idle.reason)
    # A force of 1 N at 30 mm on 10 by 3 mm, at the middle of the pin by beam theory: M / W = 30 / (3 * 10² / 6) MPa.
    assert found["lift"].links["arm"].beam.worst.equivalent == pytest.approx(0.6, rel=0.05)
