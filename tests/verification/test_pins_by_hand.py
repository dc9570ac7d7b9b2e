"""Pins in their holes by hand: lap joints, pressed and running pins, a stub, three links on one pin, a clevis.

A coupler of steel lies at the height h beside its crank and stays parallel to it, held by the pins of both its ends
along their axes. The pin at A, far softer than the links, is then a beam whose ends turn only as far as its holes let
it: with the force F across it, the turns θ1 and θ2 of its ends against the links and the shear of a beam left alone
(which bends nothing),

    M1 = F h/2 + E I (θ1 + θ2)/h ,   M2 = F h/2 - E I (θ1 + θ2)/h ,   M1 + M2 = F h ,

where θ2 turns the pin as M2 bends it and θ1 against M1. (Timoshenko, Strength of Materials I, 3rd ed., chapter 5.) A
hole of length t bears up to F t/2 without any tilt, beyond it more only where the pin has tilted by c/t.
"""

import itertools
import math
import tomllib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tilting_pins import checked, four_bar

from alula.fea.asked.asked import asked
from alula.fea.check.run import check_case
from alula.fea.common.scatter import Scatter
from alula.fea.common.sought import sought
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import Quantity, Subject
from alula.fea.judging.bearing import bearing_outcome, in_own_eyes, pressing
from alula.fea.outcomes.pins import pin_growth, stress_at
from alula.fea.pins.clearances import HoleClearance, loose_holes, radii_of
from alula.fea.pins.states import PinStates
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.joint_forces import JointForces
from alula.geometry.base.errors import CaseError
from alula.geometry.joints.fits import RUNNING, fit
from alula.loads.case.case import Case
from alula.loads.case.layers import pin_stretches
from alula.loads.records.check_spec import BearingCheck
from alula.loads.statics.statics import Reactions

HIGH, SOFT = 10.0, 1000.0
BENDING = SOFT * math.pi * 3.0**4 / 64.0
"""E I of the pin at A [N mm²]."""
LAP = """
schema_version = 1
title = "A coupler beside its crank"
links.base = { ground = true, z = "0 mm", points = { O2 = ["0 mm", "0 mm"], O4 = ["100 mm", "0 mm"] } }
links.crank = { part = "crank", z = "0 mm", points = { O2 = ["0 mm", "0 mm"], A = ["40 mm", "0 mm"] } }
links.rocker = { part = "crank", z = "0 mm", points = { O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"] } }
joints.O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
joints.O4 = { links = ["base", "rocker"], pin_diameter = "8 mm" }
drive = { link = "crank", joint = "O2" }
pose = { coordinate = "crank", angle = "90 deg", near = { coupler = "0 deg", rocker = "90 deg" } }
parts.crank = { shape = "bar", material = "hard", width = "20 mm", thickness = "6 mm", fillet_radius = "2 mm" }
parts.coupler = { shape = "bar", material = "hard", width = "20 mm", thickness = "12 mm", fillet_radius = "2 mm" }
[links.coupler]
part = "coupler"
z = "10 mm"
points = { A = ["0 mm", "0 mm"], M = ["50 mm", "0 mm"], B = ["100 mm", "0 mm"] }
[joints.A]
links = ["crank", "coupler"]
pin_diameter = "3 mm"
pin_material = "soft"
[joints.B]
links = ["coupler", "rocker"]
pin_diameter = "8 mm"
clearance = { coupler = "0 mm", rocker = "0 mm" }
[load_cases]
l = { forces = [{ link = "coupler", at = "M", force = ["20 N", "0 N"] }] }
"""


def material(young: float) -> dict[str, Any]:
    card = {
        "title": "one",
        "youngs_modulus": f"{young} MPa",
        "poissons_ratio": 0.33,
        "density": "1 kg/m^3",
        "strength": "yield",
        "yield_strength": "240 MPa",
    }
    entries = ("youngs_modulus", "poissons_ratio", "density", "yield_strength")
    return card | {table: dict.fromkeys(entries, "assumed") for table in ("sources", "status")}


def lap(
    clearances: dict[str, float],
    *,
    force: float = 20.0,
    crank: float = 6.0,
    coupler: float = 12.0,
    heads: tuple[float, float] | None = None,
) -> dict:
    """The data of the lap joint: clearances at A, the force, thicknesses, diameter and gap of heads at A [mm, N]."""
    data = tomllib.loads(LAP)
    data["materials"] = {"hard": material(210000.0), "soft": material(SOFT)}
    data["joints"]["A"]["clearance"] = {link: f"{size} mm" for link, size in clearances.items()}
    data["load_cases"]["l"]["forces"][0]["force"] = [f"{force} N", "0 N"]
    for name, thickness in (("crank", crank), ("coupler", coupler)):
        data["parts"][name]["thickness"] = f"{thickness} mm"
    if heads is not None:
        data["joints"]["A"]["heads"] = dict(zip(("diameter", "gap"), (f"{size} mm" for size in heads), strict=True))
    return data


def forces_of(case: Case) -> JointForces:
    return solve_case_statics(case).forces["l"]


def couples(case: Case, joint: str) -> tuple[float, float]:
    """Sizes of what the pin bears at its first link and at its second, about y under a force along x."""
    wrench = forces_of(case).reactions.joints[joint].wrench
    return abs(wrench[4] + case.linkage.rise(joint) * wrench[0]), abs(wrench[4])


@pytest.mark.parametrize("clearance", [0.0, 0.01, 0.1, 1.0])
def test_two_plates_of_one_thickness_share_the_couple_alike(clearance):
    """Turned by half a turn about the line of the force, a lap joint is itself: each hole bears F h/2."""
    case = checked(lap(dict.fromkeys(("crank", "coupler"), clearance), crank=9.0, coupler=9.0))
    assert couples(case, "A") == pytest.approx((20.0 * HIGH / 2.0,) * 2, rel=2e-3)


@pytest.mark.parametrize("clearance", [0.01, 0.1, 1.0])
def test_a_running_pin_stays_seated_below_half_its_force_times_the_hole(clearance):
    """In 12 mm it bears up to 6 F without tilt, and has to bear F h/2 = 5 F."""
    case = checked(lap({"crank": 0.0, "coupler": clearance}))
    assert couples(case, "A") == pytest.approx((100.0, 100.0), rel=2e-3)
    forces = forces_of(case)
    assert forces.pins is not None
    [[low, high]] = forces.pins.value.reshape(-1, 2, 2)
    assert np.hypot(*low) == pytest.approx(clearance / 2.0, rel=1e-4)
    assert high == pytest.approx(low, abs=1e-3 * clearance)  # shifted, not tilted


@pytest.mark.parametrize("clearance", [0.01, 0.1, 0.3])
def test_a_running_pin_tilts_by_its_clearance_over_the_hole_and_the_pressed_plate_bears_the_rest(clearance):
    """In 6 mm it would bear 3 F without tilt; tilted by c/6 it bears F h/2 - E I c/(6 h)."""
    case = checked(lap({"crank": 0.0, "coupler": clearance}, crank=12.0, coupler=6.0))
    less = BENDING * clearance / 6.0 / HIGH
    assert 100.0 - less > 60.0
    assert couples(case, "A") == pytest.approx((100.0 + less, 100.0 - less), rel=2e-3)


def test_a_running_pin_tilts_about_one_rim_until_it_meets_the_other():
    """Of the 2 F of its couple beyond F t/2 the pin rids itself by a tilt that the clearance has room for."""
    case = checked(lap({"crank": 0.0, "coupler": 0.1}, force=1.0, crank=12.0, coupler=6.0))
    tilt = (HIGH / 2.0 - 6.0 / 2.0) * HIGH / BENDING
    assert tilt < 0.1 / 6.0
    assert couples(case, "A") == pytest.approx((HIGH - 3.0, 3.0), rel=2e-3)
    pins = forces_of(case).pins
    assert pins is not None
    [[low, high]] = pins.value.reshape(-1, 2, 2)
    assert abs(high[0] - low[0]) == pytest.approx(tilt * 6.0, rel=1e-2)


@pytest.mark.parametrize(
    ("clearance", "heads", "tilt"),
    [
        (0.3, (8.0, 0.1), 0.1 / 8.0),  # heads before the second rim
        (0.3, (4.0, 0.1), 0.1 / 4.0),
        (0.3, (8.0, 0.0), 0.0),  # as a pressed pin
        (0.05, (8.0, 0.1), 0.05 / 6.0),  # the second rim before heads
        (0.3, (50.0, 0.64), 0.64 / 32.0),  # faces no larger than the eye of 32 mm
    ],
)
def test_heads_stop_the_tilt_at_their_gap_over_their_diameter(clearance, heads, tilt):
    """As rims do at c/6: what a pin tilted by θ leaves of its couple, F h/2 - E I θ/h, rims and heads bear together."""
    case = checked(lap({"crank": 0.0, "coupler": clearance}, crank=12.0, coupler=6.0, heads=heads))
    less = BENDING * tilt / HIGH
    assert couples(case, "A") == pytest.approx((100.0 + less, 100.0 - less), rel=3e-4)


@pytest.mark.parametrize(("gap", "tilt"), [(0.016, 0.002), (0.08, (HIGH / 2.0 - 3.0) * HIGH / BENDING)])
def test_heads_bear_what_a_pin_beyond_its_seat_has_no_room_to_tilt_from(gap, tilt):
    """On one rim it bears F t/2 and tilts by 0.005: heads let it have 0.002 of that, or more than all."""
    data = lap({"crank": 0.0, "coupler": 0.1}, force=1.0, crank=12.0, coupler=6.0, heads=(8.0, gap))
    less = BENDING * tilt / HIGH
    assert couples(checked(data), "A") == pytest.approx((HIGH / 2.0 + less, HIGH / 2.0 - less), rel=5e-4)


def test_a_seated_pin_does_not_touch_its_heads():
    """In 12 mm it bears up to 6 F without tilt; the gap is open, and all but the stop is as without heads."""
    plain, held = (lap({"crank": 0.0, "coupler": 0.1}, heads=heads) for heads in (None, (8.0, 0.05)))
    one, other = (forces_of(checked(data)).pins for data in (plain, held))
    assert one is not None
    assert other is not None
    assert other.value == pytest.approx(one.value, abs=1e-7)
    assert (
        one.tangent(one.radii.value, one.value).touching == other.tangent(other.radii.value, other.value).touching == 2
    )


def test_the_longer_hole_of_two_with_one_clearance_bears_more():
    """Both could tilt; the one of 6 mm does, by c/6, and that of 12 mm stays seated below 6 F."""
    case = checked(lap({"crank": 0.01, "coupler": 0.01}))
    less = BENDING * 0.01 / 6.0 / HIGH
    assert couples(case, "A") == pytest.approx((100.0 - less, 100.0 + less), rel=2e-3)


STUB = """
schema_version = 1
title = "A lever on a stub"
links.base = { ground = true, z = "0 mm", thickness = "8 mm", points = { O = ["0 mm", "0 mm"] } }
links.lever = { part = "bar", z = "7 mm", points = { O = ["0 mm", "0 mm"], P = ["60 mm", "0 mm"] } }
joints.O = { links = ["base", "lever"], pin_diameter = "3 mm", clearance = { base = "0 mm", lever = "0.12 mm" } }
drive = { link = "lever", joint = "O" }
pose = { coordinate = "lever", angle = "0 deg" }
parts.bar = { shape = "bar", material = "hard", width = "10 mm", thickness = "4 mm", fillet_radius = "2 mm" }
load_cases = { l = { forces = [{ link = "lever", at = "P", force = ["0 N", "-5 N"] }] } }
checks = { d = { type = "displacement", at = "P", maximum = "5 mm" } }
"""


def test_a_stub_pressed_in_the_ground_bears_the_couple_alone():
    """Equilibrium of the lever: its hole bears none, whatever its clearance, and the ground F h."""
    case = checked(tomllib.loads(STUB) | {"materials": {"hard": material(210000.0)}})
    forces = forces_of(case)
    wrench = forces.reactions.joints["O"].wrench
    assert np.abs(wrench[3:5]).max() < 1e-8
    assert np.hypot(*wrench[:2]) == pytest.approx(5.0)
    for one in forces.sharings:
        assert one.joints["O"].wrench == pytest.approx(wrench, abs=1e-8)
    [check] = [
        one for one in check_case(case, fidelity="beam").load_cases["l"].checks if one.quantity is Quantity.DISPLACEMENT
    ]
    # The lever's tip rises and sinks by the tilt c/t over its length, and goes with the pin by c/2 in the plane.
    assert check.value.high == pytest.approx(math.hypot(60.0 * 0.12 / 4.0, 0.06), rel=0.1)
    assert check.value.high >= 60.0 * 0.12 / 4.0


def test_heads_bound_how_far_the_end_of_a_lever_on_a_stub_moves():
    """By its length times the tilt: c/t in its hole, or g/D between heads, where that is less."""
    found = []
    for heads in ({}, {"heads": {"diameter": "8 mm", "gap": "0.04 mm"}}):
        data = tomllib.loads(STUB) | {"materials": {"hard": material(210000.0)}}
        data["joints"]["O"] |= heads
        pins = forces_of(checked(data)).pins
        assert pins is not None
        found.append(float(pins.reaches(pins.radii.largest)[0]))
    assert found[0] == pytest.approx(math.hypot(60.0 * 0.12 / 4.0, 0.06), rel=0.1)
    assert found[1] == pytest.approx(60.0 * 0.04 / 8.0, rel=0.1)
    drawn = furthest_drawn(pins)
    assert 0.9 * found[1] < drawn <= found[1]


def furthest_drawn(pins: PinStates) -> float:
    """The furthest that a point moves as pins stand anywhere in the discs of one hole between heads."""
    [(low, high)] = pins.radii.ties
    radii = pins.radii.of(pins.radii.value[None])[0][0]
    stop = radii[-1] / 2.0
    turns = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (500, 2))
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=2)
    mean, tilt = (radii[low] - stop) * ways[:, 0], stop * ways[:, 1]
    v = np.zeros((len(turns), len(pins.rims.g)))
    v[:, 2 * low : 2 * low + 2], v[:, 2 * high : 2 * high + 2] = mean - tilt, mean + tilt
    still = pins.answer(np.zeros_like(v[0])).displacements[:, :3]
    return max(float(np.linalg.norm(pins.answer(one).displacements[:, :3] - still, axis=1).max()) for one in v)


def three(
    joints: dict[str, list[str]],
    clearances: dict[str, str],
    *,
    lower: float = 20.0,
    upper: float = 20.0,
    heads: dict[str, dict[str, str]] | None = None,
    silent: str = "",
    plain: str | None = None,
    checks: dict[str, dict[str, str]] | None = None,
):
    """A crank between two couplers on one pin, each with a rocker of its own; forces along both couplers [N].

    One joint may say nothing of the crank's hole, and both may state a clearance alone.
    """
    data = lap({})
    points = data["links"]["coupler"]["points"]
    del data["links"]["coupler"], data["joints"]["A"], data["joints"]["B"]
    for name, z in (("lower", -HIGH), ("upper", HIGH)):
        data["links"][name] = {"part": "coupler", "z": f"{z} mm", "points": points}
    data["links"]["other"] = data["links"]["rocker"]
    stiff = {"pin_diameter": "8 mm"}
    data["joints"]["O5"] = stiff | {"links": ["base", "other"], "points": ["O4", "O4"]}
    for name, pair in (("B", ["upper", "rocker"]), ("C", ["lower", "other"])):
        data["joints"][name] = stiff | {"links": pair, "points": ["B", "B"]}
        data["joints"][name]["clearance"] = dict.fromkeys(pair, "0 mm")
    for name, pair in joints.items():
        own = {link: clearances.get(link, "0 mm") for link in pair if (name, link) != (silent, "crank")}
        data["joints"][name] = {"links": pair, "points": ["A", "A"], "pin_diameter": "3 mm", "clearance": plain or own}
        data["joints"][name] |= {"pin_material": "soft", **({"heads": heads[name]} if heads else {})}
    data["pose"]["near"] = {"lower": "0 deg", "upper": "0 deg", "rocker": "90 deg", "other": "90 deg"}
    data["parts"]["crank"]["thickness"], data["parts"]["coupler"]["thickness"] = "6 mm", "12 mm"
    forces = {"lower": lower, "upper": upper}
    data["load_cases"]["l"]["forces"] = [
        {"link": link, "at": "M", "force": [f"{force} N", "0 N"]} for link, force in forces.items()
    ]
    return checked(data | {"checks": checks or {}})


ONE_PIN = [
    {"A": ["lower", "crank"], "A2": ["lower", "upper"]},  # from the lowest to the highest
    {"A": ["crank", "lower"], "A2": ["crank", "upper"]},  # from the middle to both sides
    {"A": ["crank", "lower"], "A2": ["upper", "lower"]},  # listed against each other
    {"A": ["lower", "crank"], "A2": ["crank", "upper"]},  # from one to the next
]


def borne_by(case: Case, state: Reactions | None = None) -> dict[str, float]:
    """Couple about y that the pin puts on each of the three links, by what its joints put on them."""
    found = dict.fromkeys(("lower", "crank", "upper"), 0.0)
    reactions = (state or forces_of(case).reactions).joints
    for name in ("A", "A2"):
        first, second = case.joints[name].links
        wrench = reactions[name].wrench
        found[second] += wrench[4]
        found[first] -= wrench[4] + case.linkage.rise(name) * wrench[0]
    return found


def bent(case: Case) -> dict[str, tuple[float, float]]:
    """Largest moment and shear of the pin between the lowest two of the three links, and between the upper two.

    By sums over thin slices of what presses along the three eyes, even and linear, forces along x.
    """
    reactions, step = forces_of(case).reactions.joints, 1e-3
    force = dict.fromkeys(("lower", "crank", "upper"), 0.0)
    for name in ("A", "A2"):
        first, second = case.joints[name].links
        force[second] += reactions[name].wrench[0]
        force[first] -= reactions[name].wrench[0]
    z = np.arange(-HIGH - 6.0, HIGH + 6.0, step) + step / 2.0
    pressure = np.zeros_like(z)
    for (link, couple), (middle, length) in zip(
        borne_by(case).items(), ((-HIGH, 12.0), (0.0, 6.0), (HIGH, 12.0)), strict=True
    ):
        here = np.abs(z - middle) < length / 2.0
        pressure -= here * (force[link] / length + 12.0 * couple * (z - middle) / length**3)
    shear = np.cumsum(pressure) * step
    moment = np.cumsum(shear) * step
    parts = {"below": z < 3.0, "above": z > -3.0}
    return {side: (np.abs(moment[own]).max(), np.abs(shear[own]).max()) for side, own in parts.items()}


@pytest.mark.parametrize("joints", ONE_PIN)
@pytest.mark.parametrize("forces", [(20.0, 20.0), (-20.0, 20.0), (5.0, 30.0)])
def test_what_bends_a_pin_of_three_links_is_what_all_of_them_press(joints, forces):
    """Each joint by itself would put the crank's eye under one force alone: up to 2.4 times off."""
    case = three(joints, {"crank": "0.02 mm"}, lower=forces[0], upper=forces[1])
    expected, reactions = bent(case), forces_of(case).reactions.joints
    for name, stretch in pin_stretches(case).items():
        if name not in joints:
            continue
        side = "below" if any(link == "lower" for link, _ in stretch) else "above"
        found = stress_at(case, name, reactions)
        sheared = found.shear / (3.66 / 2.66 * 4.0 / (math.pi * 9.0))  # Love's, of Poisson's ratio 0.33
        assert (found.moment.value, sheared) == pytest.approx(expected[side], rel=5e-3)


ON_GROUND = """
schema_version = 1
title = "A thin and a thick lever on one pin of a ground without part"
layer_spacing = "7 mm"
links.base = { ground = true, layer = 0, points = { O = ["0 mm", "0 mm"], R = ["0 mm", "-60 mm"] } }
links.near = { part = "thin", layer = 1, points = { O = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"] } }
links.far = { part = "thick", layer = 2, points = { O = ["0 mm", "0 mm"], D = ["60 mm", "0 mm"] } }
links.low = { part = "thin", layer = 1, points = { R = ["0 mm", "0 mm"], D = ["60 mm", "0 mm"] } }
links.high = { part = "thin", layer = 3, points = { R = ["0 mm", "0 mm"], B = ["84.85281374 mm", "0 mm"] } }
pose.near = { near = "0 deg", far = "-30 deg", low = "30 deg", high = "45 deg" }
parts.thin = { shape = "bar", material = "steel-s235", width = "8 mm", thickness = "2 mm", fillet_radius = "1 mm" }
parts.thick = { shape = "bar", material = "steel-s235", width = "8 mm", thickness = "6 mm", fillet_radius = "1 mm" }
[joints]
O = { links = ["base", "near"], pin_diameter = "5 mm" }
O2 = { links = ["base", "far"], points = ["O", "O"], pin_diameter = "5 mm" }
B = { links = ["near", "high"], pin_diameter = "5 mm" }
D = { links = ["far", "low"], pin_diameter = "5 mm" }
R = { links = ["base", "low"], pin_diameter = "5 mm" }
R2 = { links = ["base", "high"], points = ["R", "R"], pin_diameter = "5 mm" }
[[load_cases.l.forces]]
link = "near"
at = "B"
force = ["100 N", "50 N"]
[[load_cases.l.forces]]
link = "far"
at = "D"
force = ["-60 N", "110 N"]
"""


@pytest.mark.parametrize("turned", [False, True])
def test_a_hole_of_a_ground_without_part_is_as_long_as_the_shortest_on_its_pin(turned):
    """In either order of the joints: the longer of both gave the pin O a third less stress."""
    tables = tomllib.loads(ON_GROUND)
    if turned:
        tables["joints"] = dict(reversed(tables["joints"].items()))
    known = tomllib.loads(ON_GROUND)
    known["links"]["base"]["thickness"] = "2 mm"
    reactions = forces_of(checked(known)).reactions.joints
    for name in ("O", "O2"):
        found, expected = (stress_at(checked(one), name, reactions).equivalent.value for one in (tables, known))
        assert found == pytest.approx(expected)


@pytest.mark.parametrize("joints", ONE_PIN)
@pytest.mark.parametrize(("lower", "crank"), [(20.0, 40.0), (-20.0, 0.0), (-5.0, 15.0)])
def test_an_eye_bears_what_all_joints_of_its_pin_press(joints, lower, crank):
    case = three(joints, {"crank": "0.02 mm"}, lower=lower)
    reactions = forces_of(case).reactions.joints
    every = {link: one for name in joints for link, one in in_own_eyes(case, name, reactions).items()}
    borne = {link: float(pressing(case, link, one)) for link, one in every.items()}
    assert borne == pytest.approx({"lower": abs(lower), "crank": crank, "upper": 20.0}, abs=0.01)


@pytest.mark.parametrize("lower", [20.0, -5.0])
def test_the_forces_of_all_joints_of_a_pin_may_grow_on_it(lower):
    """That of A by 10 % and that of A2 by 20 %, each by itself or both: on the pin, and in the crank's eye."""
    case = three(ONE_PIN[1], {"crank": "0.02 mm"}, lower=lower, checks={"eyes": {"type": "bearing"}})
    reactions, source = forces_of(case).reactions.joints, (Source(kind=SourceKind.PLAY),)
    by = {"A": Scatter(high=1.1, sources=source), "A2": Scatter(high=1.2, sources=source)}
    [eye] = asked(case, BearingCheck, subject=Subject.pin("A"))
    band = bearing_outcome(case, "l", eye, [reactions], lambda name: by.get(name, Scatter())).value
    for factors in itertools.product((1.0, 1.1), (1.0, 1.2)):
        grown = {
            name: replace(reactions[name], wrench=reactions[name].wrench * factor)
            for name, factor in zip(ONE_PIN[1], factors, strict=True)
        }
        for name in ONE_PIN[1]:
            stress, plain = (stress_at(case, name, of).equivalent.value for of in (grown, reactions))
            found = pin_growth(case, name, reactions, by.__getitem__)
            assert found.low * plain <= stress <= found.high * plain * (1.0 + 1e-9)
        borne = float(pressing(case, "crank", in_own_eyes(case, "A", grown)["crank"]))
        assert band.low <= 240.0 / (borne / (3.0 * 6.0)) * (1.0 + 1e-9)


def test_a_pin_that_passes_a_link_by_is_refused():
    data = lap({})
    points = data["links"]["coupler"]["points"]
    for k, name in enumerate(("one", "two")):
        data["links"][name] = {"part": "coupler", "z": f"{30.0 + 20.0 * k} mm", "points": points}
    for name, pair in (("A", ["crank", "one"]), ("A2", ["coupler", "two"]), ("A3", ["coupler", "one"])):
        data["joints"][name] = {"links": pair, "points": ["A", "A"], "pin_diameter": "3 mm", "pin_material": "soft"}
    said = r"^joints\.A3: its pin is that of joint 'A' as well .* let all joints there have one of crank, one, coupler"
    with pytest.raises(CaseError, match=said):
        checked(data)


@pytest.mark.parametrize("joints", ONE_PIN)
@pytest.mark.parametrize("clearance", ["0 mm", "0.02 mm", "0.2 mm"])
def test_pulled_alike_on_both_sides_the_middle_link_of_a_pin_bears_no_couple(joints, clearance):
    """Its hole lies in the plane of symmetry, where one beam keeps its slope; two pins would tilt in it, each alone."""
    found = borne_by(three(joints, {"crank": clearance}))
    assert abs(found["crank"]) < 0.1
    assert found["upper"] == pytest.approx(-found["lower"], rel=1e-3)
    assert abs(found["upper"]) == pytest.approx(20.0 * HIGH / 2.0, rel=5e-3)


@pytest.mark.parametrize("joints", ONE_PIN)
@pytest.mark.parametrize(
    ("clearance", "gaps", "tilt"),
    [
        ("0 mm", None, 0.0),
        ("0.02 mm", None, 0.02 / 6.0),
        ("2.9 mm", None, math.inf),
        ("2.9 mm", ("0.1 mm", "0.02 mm"), 0.12 / 8.0),  # of both joints on the pin, over the smaller face
    ],
)
def test_pulled_against_each_other_the_middle_link_bears_what_its_tilt_leaves(joints, clearance, gaps, tilt):
    """By halves beams of h: the crank bears F h - 2 E I θ/h, tilted by θ = c/t; none where a pin runs freely."""
    heads = gaps and {
        name: {"diameter": size, "gap": gap}
        for name, size, gap in zip(("A", "A2"), ("8 mm", "9 mm"), gaps, strict=True)
    }
    found = borne_by(three(joints, {"crank": clearance}, lower=-20.0, heads=heads))
    free = 20.0 * HIGH**2 / (2.0 * BENDING)
    less = 2.0 * BENDING * min(tilt, free) / HIGH
    assert abs(found["crank"]) == pytest.approx(20.0 * HIGH - less, rel=5e-3, abs=0.5)
    for link in ("lower", "upper"):
        assert abs(found[link]) == pytest.approx((20.0 * HIGH + less) / 2.0, rel=5e-3)
    assert sum(found.values()) == pytest.approx(math.copysign(2.0 * 20.0 * HIGH, sum(found.values())), rel=5e-3)


@pytest.mark.parametrize("clearances", [{"crank": "0.2 mm"}, {"crank": "0 mm", "upper": "0.1 mm", "lower": "0.2 mm"}])
@pytest.mark.parametrize("silent", ["A", "A2"])
def test_a_hole_that_one_joint_of_a_pin_states_is_so_for_the_other(silent, clearances):
    """The crank's hole is one: where the other joint of the pin says nothing of it, it is no running fit."""
    both, one = (three(ONE_PIN[1], clearances, lower=-20.0, silent=name) for name in ("", silent))
    assert borne_by(one) == pytest.approx(borne_by(both), rel=1e-6)
    assert loose_holes(one, silent) == loose_holes(both, silent)
    pins = forces_of(one).pins
    assert pins is not None
    assert not len(pins.radii.value)  # nothing is open


@pytest.mark.parametrize("diameter", [3.0, 0.1])
def test_what_is_open_of_a_hole_is_what_is_stated_of_it(diameter):
    """Of one alone, of two together; and of what is not stated, a tenth of the pin, or what a running fit may have."""
    data = four_bar(tight={"O2": ["base", "crank"]})
    data["joints"]["A"]["clearance"] = {"crank": ["0.01 mm", "0.05 mm"], "coupler": "0.04 mm"}
    data["joints"]["B"]["clearance"] = ["0.02 mm", "0.1 mm"]
    data["joints"]["O4"]["pin_diameter"] = f"{diameter} mm"
    pins = forces_of(checked(data)).pins
    assert pins is not None
    most = pytest.approx(max(0.1 * diameter, fit(RUNNING, diameter).bounds[1]))
    found = {one.holes: (one.low, one.value, one.high) for one in pins.radii.clearances}
    assert found.pop((("O4", "base"),)) == (0.0, 0.0, most)  # of unknown length
    low, value, high = found.pop((("O4", "rocker"),))
    assert (low, high) == (0.0, most)
    assert 0.0 < value < 0.05  # a running fit
    assert found == {
        (("A", "crank"),): pytest.approx((0.01, 0.03, 0.05)),
        (("A", "coupler"),): pytest.approx((0.04, 0.04, 0.04)),
        (("B", "coupler"), ("B", "rocker")): pytest.approx((0.02, 0.06, 0.1)),
    }


def test_of_a_clearance_of_two_holes_the_known_one_leaves_the_rest():
    """Least less largest, and largest less least: 0.1 to 0.2 less 0.02 to 0.05."""
    known = HoleClearance(holes=(("A2", "crank"),), low=0.02, value=0.03, high=0.05)
    both = HoleClearance(holes=(("A", "crank"), ("A", "lower")), low=0.1, value=0.15, high=0.2)
    for stated in ([known, both], [both, known]):
        radii = radii_of(stated, [[("A", "crank"), ("A2", "crank")], [("A", "lower")]])
        found = {one.holes: (one.low, one.value, one.high) for one in radii.clearances}
        assert found == {
            (("A2", "crank"),): (0.02, 0.03, 0.05),
            (("A", "lower"),): pytest.approx((0.05, 0.12, 0.18)),
        }


def test_clearances_of_two_joints_on_one_pin_leave_open_which_holes_have_them():
    """0.2 mm of each joint: all in the crank's hole, which both have, or in those of both other links."""
    joints = {name: [*pair] for name, pair in ONE_PIN[1].items()}
    pins = forces_of(three(joints, {}, lower=-20.0, plain="0.2 mm")).pins
    assert pins is not None
    assert {hole.link: 2.0 * float(pins.radii.largest[0, 2 * k]) for k, hole in enumerate(pins.rims.holes)} == {
        "lower": 0.2, "crank": 0.2, "upper": 0.2,
    }  # fmt: skip
    found = [borne_by(three(joints, {}, lower=-20.0, plain="0.2 mm"), one) for one in pins.ends]
    for holes in (["crank"], ["lower", "upper"]):
        for link, borne in borne_by(three(joints, dict.fromkeys(holes, "0.2 mm"), lower=-20.0)).items():
            low, high = sought([one[link] for one in found])
            assert low <= borne <= high


@pytest.mark.parametrize("clearance", ["0 mm", "0.1 mm"])
def test_a_clevis_bears_no_couple(clearance):
    """Cheeks on either side, or plates of a pair: half of the force in each, and their rise is zero."""
    data = lap({})
    data["links"]["coupler"] |= {"z": "0 mm", "count": 2, "apart": "20 mm"}
    data["joints"]["A"]["clearance"] = {"crank": clearance, "coupler": clearance}
    forces = forces_of(checked(data))
    wrench = forces.reactions.joints["A"].wrench
    assert wrench[:2] == pytest.approx([-20.0, 0.0], abs=1e-9)
    assert np.abs(wrench[3:5]).max() < 1e-9
    assert forces.pins is None
