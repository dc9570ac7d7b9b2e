"""Pins in slots between layers: with a clearance, slot and hole bear couples as two holes do, but none along it.

A crank of 30 mm turns a lever by a pin in its slot, whose drive and pivot are tight in all links. A force F of 30 N
crosses from the mid-plane of the lever to that of the crank, 5 mm below. A hole or slot 4 mm long bears up to F t/2 of
that couple while its pin does not tilt by c/t, which here is more than the links give: the other link has the rest.
"""

import tomllib
from typing import Any

import numpy as np
import pytest

from alula.fea.pins.clearances import clearances_of, gap_over_diameter
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.joint_forces import JointForces
from alula.fea.vibration.over_motion import case_frequencies
from alula.fea.vibration.running_holes import running_holes
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.applied import shifted

LEVER = """
schema_version = 1
title = "A crank in the slot of a lever"
layer_spacing = "5 mm"
links.base = { ground = true, layer = 0, thickness = "6 mm", points = { A = ["0 mm", "0 mm"], O = ["0 mm", "-70 mm"] } }
links.crank = { layer = 1, part = "bar", points = { A = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] } }
joints.A = { links = ["base", "crank"], pin_diameter = "3 mm", tight_in = ["base", "crank"] }
joints.O = { links = ["base", "lever"], pin_diameter = "3 mm", tight_in = ["base", "lever"] }
drive = { link = "crank", joint = "A" }
pose = { coordinate = "crank", angle = "30 deg", near = { lever = "70 deg" } }
load_cases.push = { forces = [{ link = "lever", at = "P", force = ["20 N", "0 N"] }] }
[links.lever]
layer = 2
part = "bar"
points = { O = ["0 mm", "0 mm"], P = ["140 mm", "0 mm"], S = ["70 mm", "0 mm"] }
slots.S = { first = "35 mm", last = "105 mm" }
[joints.S]
type = "pin-in-slot"
links = ["lever", "crank"]
points = ["S", "B"]
pin_diameter = "3 mm"
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "10 mm"
thickness = "4 mm"
fillet_radius = "2 mm"
"""


def lever(slot: str | None = "0 mm", **joint: Any) -> Case:
    data = tomllib.loads(LEVER)
    data["joints"]["S"] |= joint
    if slot is not None:
        data["links"]["lever"]["slots"]["S"]["clearance"] = slot
    return validate(data)


def solved(case: Case) -> JointForces:
    return solve_case_statics(case).forces["push"]


def borne(forces: JointForces) -> tuple[float, float, float]:
    """Force of the pin in the slot, and the couples that lever and crank bear of it [N, N mm]."""
    on_crank = forces.reactions.joints["S"].wrench
    on_lever = shifted(-on_crank, np.array([0.0, 0.0, -5.0]))
    return tuple(float(np.hypot(*part)) for part in (on_crank[:2], on_lever[3:5], on_crank[3:5]))


def test_what_a_seated_pin_does_not_bear_the_other_link_bears():
    """150 N mm in all: tight pins share it by what the links give, a wide hole leaves 90 to the slot, and so back."""
    force, on_lever, on_crank = borne(solved(lever(tight_in="crank")))
    assert (force, on_lever + on_crank) == pytest.approx((30.1, 150.6), rel=1e-3)
    assert 60.3 < on_lever < 80.0
    assert borne(solved(lever(clearance="0.1 mm"))) == pytest.approx((force, 3.0 * force, 2.0 * force), rel=1e-6)
    assert borne(solved(lever("0.1 mm", tight_in="crank"))) == pytest.approx(
        (force, 2.0 * force, 3.0 * force), rel=1e-6
    )


def test_both_tilt_where_neither_bears_the_couple_seated():
    """2 x 60 N mm are less than 150: the pin tilts in both by as much until their far rims bear what is left."""
    force, on_lever, on_crank = borne(solved(lever("0.1 mm", clearance="0.1 mm")))
    assert on_lever + on_crank == pytest.approx(5.0 * force, rel=1e-6)
    assert min(on_lever, on_crank) > 2.0 * force


def test_nothing_presses_along_a_slot():
    """Whatever its clearance, a pin bears neither a force along it nor a couple about the way across."""
    case = lever("0.1 mm", clearance="0.05 mm")
    [along] = np.exp(1j * np.array([case.solve_pose().angles["lever"]]))
    wrench = solved(case).reactions.joints["S"].wrench
    across = np.array([-along.imag, along.real])
    assert wrench[:2] @ [along.real, along.imag] == pytest.approx(0.0, abs=1e-6)
    assert wrench[3:5] @ across == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("link", "slot", "joint"), [("crank", "0 mm", {}), ("lever", None, {"tight_in": "crank"})])
def test_what_is_not_stated_is_open_where_a_pin_slides_too(link, slot, joint):
    """From a pressed pin to one that runs, in the hole or in the slot: the band of what the crank bears holds both."""
    case = lever(slot, **joint)
    found = solved(case)
    assert [(one.holes, one.stated) for one in clearances_of(case, found.frame)] == [((("S", link),), False)]
    couples = [float(np.hypot(*one.joints["S"].wrench[3:5])) for one in found.sharings]
    wide = lever("0.1 mm" if link == "lever" else slot, **(joint or {"clearance": "0.1 mm"}))
    ends = borne(solved(lever(tight_in="crank")))[2], borne(solved(wide))[2]
    assert (min(couples), max(couples)) == pytest.approx((min(ends), max(ends)), rel=1e-3)
    assert solved(lever(tight_in="crank")).pins is None


@pytest.mark.parametrize("point", ["S", "O"])
def test_a_slot_that_is_counted_from_a_pin_is_a_hole_of_its_own(point):
    """A lever without a part may state the travel of its slot from its pivot, whose hole has a clearance of its own."""
    data = tomllib.loads(LEVER)
    data["joints"]["O"] |= {"tight_in": "base", "clearance": "0.02 mm"}
    data["joints"]["S"] |= {"clearance": "0.1 mm", "points": [point, "B"]}
    for entry in ("part", "slots"):
        del data["links"]["lever"][entry]
    data["links"]["lever"]["thickness"] = "4 mm"
    found = solved(validate(data))
    assert {(hole.link, hole.joints) for hole in found.pins.rims.holes} == {("lever", ("O",)), ("crank", ("S",))}
    force, _, on_crank = borne(found)
    assert on_crank == pytest.approx(2.0 * force, rel=1e-6)


def test_a_slot_that_may_be_wider_has_a_hinge_in_frequencies():
    """One as wide as its pin holds that pin's tilt."""
    assert running_holes(lever(tight_in="crank")) == ()
    assert running_holes(lever(None, tight_in="crank")) == (("S", "lever"),)
    assert running_holes(lever("0.1 mm", tight_in="crank")) == (("S", "lever"),)
    assert running_holes(lever("0.1 mm")) == (("S", "lever"), ("S", "crank"))


@pytest.mark.parametrize("force", [0.01, 20.0])
def test_a_pin_between_slot_and_hinge_does_not_spin(force):
    """With all other holes tight the lever's sway hardly knows the tilt of the pin; a wider slot weighs less."""
    tight, loose = (lever(slot, tight_in="crank") for slot in ("0 mm", "0.1 mm"))
    found = []
    for case in (tight, loose):
        [load] = case.load_cases["push"].forces
        pushed = load.model_copy(update={"force": (force, 0.0)})
        push = case.load_cases["push"].model_copy(update={"forces": (pushed,), "own_weight": False})
        [history] = case_frequencies(case.model_copy(update={"load_cases": {"push": push}}), count=2).histories.values()
        found.append([mode.frequency for mode in history.lowest.modes])
    for held, tilts in zip(*found, strict=True):
        assert 0.9 * held.low < tilts.low < tilts.value < 1.01 * held.value


def test_heads_hold_no_link_at_its_slot():
    """Those of the pin hold the links that turn on it, the lever may slide off."""
    data = tomllib.loads(LEVER)
    data["links"]["base"]["points"]["Q"] = ["90 mm", "0 mm"]
    data["links"]["rod"] = {"layer": 0, "part": "bar", "points": {"B": ["0 mm", "0 mm"], "C": ["40 mm", "0 mm"]}}
    data["links"]["rocker"] = {"layer": 1, "part": "bar", "points": {"Q": ["0 mm", "0 mm"], "C": ["40 mm", "0 mm"]}}
    heads = {"diameter": "7 mm", "gap": "0.1 mm"}
    data["joints"]["B"] = {"links": ["crank", "rod"], "pin_diameter": "3 mm", "heads": heads}
    data["joints"] |= {name: {"links": links, "pin_diameter": "3 mm"} for name, links in
                       (("C", ["rocker", "rod"]), ("Q", ["base", "rocker"]))}  # fmt: skip
    data["pose"]["near"] |= {"rod": "0 deg", "rocker": "120 deg"}
    case = validate(data)
    assert gap_over_diameter(case, "S", "lever") is None
    assert gap_over_diameter(case, "S", "crank") == pytest.approx((0.1 / 7.0, 0.1 / 7.0))
