"""Linkages with slots against closed forms: swinging on a drive that gives, play across the slot, and its ends.

A crank a turns about A, and its pin B stands r from O in the slot of a lever about O, or in the upright slot of a yoke
along x. With the angle p of lever to crank the lever turns by a cos(p)/r per turn of the crank, and the yoke moves by
a sin(angle) (speeds across the slot). Virtual work gives the drive torque and the mass that swings.
"""

import math
import tomllib
from typing import Any

import pytest
from materials import stiff

from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.vibration.over_motion import case_frequencies
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

STIFF = f"""
[parts.bar]
shape = "bar"
material = "stiff"
width = "5 mm"
thickness = "3 mm"
eye_diameter = "6 mm"
fillet_radius = "0.3 mm"
{stiff(density="0.0001 g/cm^3", young="YOUNG GPa", strength="900 GPa")}
"""
CRANK = """
schema_version = 1
title = "A crank with its pin in a slot"
links.crank = { part = "bar", points = { A = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] } }
joints.A = { links = ["base", "crank"], pin_diameter = "2 mm" }
drive = { link = "crank", joint = "A", stiffness = "20 N*m/rad" }
load_cases.own = { own_weight = false }
"""
LEVER = (
    CRANK
    + """
links.base = { ground = true, points = { A = ["0 mm", "0 mm"], O = ["0 mm", "-60 mm"] } }
links.lever = { points = { O = ["0 mm", "0 mm"], E = ["150 mm", "0 mm"] } }
joints.O = { links = ["base", "lever"], pin_diameter = "2 mm" }
joints.S = { type = "pin-in-slot", links = ["lever", "crank"], points = ["O", "B"], pin_diameter = "2 mm" }
carried = [{ link = "lever", at = "E", mass = "60 g" }]
pose = { coordinate = "crank", angle = "30 deg", near = { lever = "70 deg" } }
"""
)
YOKE = (
    CRANK
    + """
links.base = { ground = true, points = { A = ["0 mm", "0 mm"] } }
links.yoke = { points = { Y = ["0 mm", "0 mm"], Z = ["60 mm", "8 mm"] } }
joints.G = { type = "slider", links = ["base", "yoke"], points = ["A", "Y"] }
joints.S.type = "pin-in-slot"
joints.S.links = ["yoke", "crank"]
joints.S.points = ["Y", "B"]
joints.S.direction = "90 deg"
joints.S.pin_diameter = "2 mm"
carried = [{ link = "yoke", at = "Z", mass = "60 g" }]
pose = { coordinate = "crank", angle = "30 deg", near = { yoke = "0 deg" } }
"""
)
TURN = math.radians(30.0)
DRIVE = 20e3  # N mm/rad
MASS = 60e-6  # tonne


def case_of(text: str, young: float = 9e5, **tables: Any) -> Case:
    return validate({**tomllib.loads(text + STIFF.replace("YOUNG", repr(young))), **tables})


def lever_at(offset: float = 0.0) -> tuple[float, float]:
    """Angle of the lever [rad], and its turn per turn of the crank, with the pin ``offset`` beside the slot's line."""
    across, up = 30.0 * math.cos(TURN), 30.0 * math.sin(TURN) + 60.0
    away = math.hypot(across, up)
    angle = math.atan2(up, across) - math.asin(offset / away)
    return angle, 30.0 * math.cos(TURN - angle) / math.sqrt(away**2 - offset**2)


def hertz(stiffness: float, mass: float) -> float:
    return math.sqrt(stiffness / mass) / (2.0 * math.pi)


def lowest(case: Case) -> float:
    [history] = case_frequencies(case, count=1).histories.values()
    return history.lowest.modes[0].frequency.value


@pytest.mark.parametrize(
    ("text", "moved"), [(LEVER, 150.0 * lever_at()[1]), (YOKE, 30.0 * math.sin(TURN))], ids=["lever", "yoke"]
)
def test_rigid_links_swing_on_their_drive(text, moved):
    assert lowest(case_of(text)) == pytest.approx(hertz(DRIVE, MASS * moved**2), rel=1e-3)


@pytest.mark.parametrize("play", [0.1, 1.0])
def test_play_stands_across_the_slot_alone(play):
    """A couple on the lever: its drive bears that times the lever's turn per turn of the crank."""
    data = tomllib.loads(LEVER)["joints"]
    data["S"]["clearance"] = f"{play} mm"
    case = case_of(
        LEVER,
        joints=data,
        load_cases={"push": {"own_weight": False, "moments": [{"link": "lever", "at": "E", "moment": "-900 N*mm"}]}},
    )
    found = solve_case_statics(case).forces["push"].play
    ends = sorted(900.0 * lever_at(s * play / 2.0)[1] for s in (-1.0, 1.0))
    assert (found.effort.low, found.effort.high) == pytest.approx(ends, rel=2e-3 * play)
    assert found.effort.low <= ends[0] * (1.0 + 1e-9)
    assert found.effort.high >= ends[1] * (1.0 - 1e-9)


@pytest.mark.parametrize("command", [solve_case_statics, case_frequencies])
def test_a_pin_beyond_the_end_of_its_slot_is_refused(command):
    text = LEVER.replace("E = [", 'S = ["60 mm", "0 mm"], E = [').replace('points = ["O", "B"]', 'points = ["S", "B"]')
    data = tomllib.loads(text + STIFF.replace("YOUNG", "70.0"))
    for last, beyond in (("79 mm", True), ("80 mm", False)):
        data["links"]["lever"] |= {"part": "bar", "slots": {"S": {"first": "41 mm", "last": last}}}
        if beyond:
            with pytest.raises(CaseError, match=r"stands at x = 79\.3725 mm, but the slot runs from 41 to 79 mm"):
                command(validate(data))
        else:
            assert command(validate(data))


def test_a_linkage_that_is_let_go_does_not_leave_its_slot():
    """A push down takes the lever to the tangent on the circle of B, sqrt(60² - 30²) from O."""
    text = LEVER.replace("E = [", 'S = ["60 mm", "0 mm"], E = [').replace('points = ["O", "B"]', 'points = ["S", "B"]')
    data = tomllib.loads(text + STIFF.replace("YOUNG", "70.0"))
    del data["drive"], data["carried"]
    data["pose"]["equilibrium"] = True
    data["load_cases"]["own"]["forces"] = [{"link": "lever", "at": "E", "force": ["0 N", "-8 N"]}]
    for first, beyond in (("52.5 mm", True), ("51.5 mm", False)):
        data["links"]["lever"] |= {"part": "bar", "slots": {"S": {"first": first, "last": "85 mm"}}}
        if beyond:
            with pytest.raises(CaseError, match=r"stands at x = 51\.9615 mm, but the slot runs from 52\.5 to 85 mm"):
                solve_case_statics(validate(data))
        else:
            assert solve_case_statics(validate(data))


STRUT = f"""
schema_version = 1
title = "A long lever without part stands on a short strut"
carried = [{{ link = "lever", at = "E", mass = "100 g" }}]
links.base = {{ ground = true, points = {{ O = ["0 mm", "0 mm"], G = ["30 mm", "-25 mm"] }} }}
links.strut = {{ part = "bar", points = {{ G = ["0 mm", "0 mm"], B = ["20 mm", "0 mm"] }} }}
links.lever = {{ points = {{ O = ["0 mm", "0 mm"], E = ["500 mm", "0 mm"] }} }}
joints.O = {{ links = ["base", "lever"], pin_diameter = "2 mm" }}
joints.G = {{ links = ["base", "strut"], pin_diameter = "2 mm" }}
joints.B = {{ type = "pin-in-slot", links = ["lever", "strut"], points = ["O", "B"], pin_diameter = "2 mm" }}
drive = {{ link = "strut", joint = "G" }}
pose = {{ coordinate = "strut", angle = "50 deg", near = {{ lever = "0 deg" }} }}
load_cases.hang = {{ own_weight = false, forces = [{{ link = "lever", at = "E", force = ["0 N", "-0.01 N"] }}] }}
{STIFF.replace("YOUNG", "70")}
"""


def test_a_link_without_part_does_not_give_however_long_it_is():
    """The strut bends, is pressed and sheared (Cowper's κ) by a force across the lever; the lever alone would sag."""
    B = 30.0 + 20.0 * math.cos(math.radians(50.0)), -25.0 + 20.0 * math.sin(math.radians(50.0))
    across = math.atan2(B[1], B[0]) + math.pi / 2.0 - math.radians(50.0)
    young, poisson, area, inertia = 70e3, 0.3, 5.0 * 3.0, 3.0 * 5.0**3 / 12.0
    kappa, shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson), young / 2.0 / (1.0 + poisson)
    bent = 20.0**3 / 3.0 / young / inertia + 20.0 / kappa / shear / area
    gives = math.sin(across) ** 2 * bent + math.cos(across) ** 2 * 20.0 / young / area
    expected = math.hypot(*B) / 500.0 / math.sqrt(gives * 1e-4) / 2.0 / math.pi
    [history] = case_frequencies(validate(tomllib.loads(STRUT)), count=2).histories.values()
    first, second = (mode.frequency.value for mode in history.lowest.modes)
    assert first == pytest.approx(expected, rel=5e-3)
    assert second > 10.0 * first
