"""Pins between layers weigh what cylinders from face to face do, and move with the link in which they are tight."""

import math

import numpy as np
import pytest
from bars_in_layers import four_bars, parallel_bars

from alula.loads.case.case import Case
from alula.loads.case.layers import pin_masses
from alula.loads.states.actions import acting_loads
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.masses import all_carried, laden_masses, part_masses
from alula.loads.statics.statics import solve_statics
from alula.reports.check.statics import weight_sentence

PER_LENGTH = 7.8e-9 * math.pi * 8.0**2 / 4.0
"""Steel wire of 8 mm [tonne/mm]."""
LONG = 16.0
"""Of a pin between two bars of 6 mm, whose mid-planes are 10 mm apart [mm]."""


def weighing(**joints: str) -> Case:
    """Parallel bars under their own weight, with ``tight_in`` of joints."""
    case = parallel_bars()
    stated = {name: (link,) for name, link in joints.items()}
    tight = {name: joint.model_copy(update={"tight_in": stated.get(name, ())}) for name, joint in case.joints.items()}
    heavy = {"lift": case.load_cases["lift"].model_copy(update={"own_weight": True, "forces": ()})}
    return case.model_copy(update={"joints": tight, "load_cases": heavy})


def torque(case: Case) -> float:
    pose = case.solve_pose()
    loads = acting_loads(case, case.load_cases["lift"], pose.placement, part_masses(case))
    return float(solve_statics(pose, case.pinned_drive, loads).drive_torque)


def test_the_drive_lifts_the_pins() -> None:
    """Bars 120 mm long at 60 degrees stay parallel, so that the pins at both tips rise alike."""
    case = weighing()
    lifted = torque(case) - torque(case.in_one_plane())
    assert lifted == pytest.approx(2.0 * PER_LENGTH * LONG * 9810.0 * 120.0 * math.cos(math.pi / 3.0), rel=1e-9)


def test_a_pin_moves_with_the_link_in_which_it_is_tight() -> None:
    found = pin_masses(weighing())
    assert {name: (pin.link, pin.at) for name, pin in found.items()} == {"B": ("crank", "B"), "C": ("coupler", "C")}
    found = pin_masses(weighing(A="crank", B="coupler", C="rocker"))
    assert {name: pin.link for name, pin in found.items()} == {"A": "crank", "B": "coupler", "C": "rocker"}
    assert found["A"].mass == pytest.approx(13.0 * PER_LENGTH)  # from the bare base's plane to the crank's far face
    assert torque(weighing(A="crank", B="coupler", C="rocker")) == pytest.approx(torque(weighing()), rel=1e-12)


def test_masses_of_links_hold_their_pins_and_one_plane_has_none() -> None:
    case = weighing()
    own, flat = part_masses(case), case.in_one_plane()
    both = (sum(one.mass for one in laden_masses(which, own).values()) for which in (case, flat))
    assert next(both) - next(both) == pytest.approx(2.0 * LONG * PER_LENGTH)
    assert pin_masses(flat) == {}
    assert all_carried(case, stated=False) == all_carried(case)
    assert "pins weigh 6.27 g at B on crank and 6.27 g at C on coupler" in weight_sentence(case, "lift")
    assert "pins" not in weight_sentence(flat, "lift")


def test_pins_of_three_links_on_one_axis_are_one() -> None:
    more = """
[links.other]
part = "bar"
layer = 3
points.C = ["0 mm", "0 mm"]
points.E = ["50 mm", "0 mm"]
[joints.C2]
links = ["coupler", "other"]
points = ["C", "C"]
pin_diameter = "8 mm"
[joints.E]
links = ["other", "stay"]
pin_diameter = "8 mm"
[links.stay]
layer = 1
points.E = ["0 mm", "0 mm"]
points.S = ["80 mm", "0 mm"]
[joints.S]
type = "slider"
links = ["base", "stay"]
points = ["D", "S"]
"""
    bars = {"start": 60.0, "end": 50.0}
    case = four_bars((0, 1, 2, 1), (120.0, 100.0, 120.0, 100.0), near=(0.0, 60.0), more=more, **bars)
    assert pin_masses(case)["C"].mass == pytest.approx(26.0 * PER_LENGTH)  # layers 1 to 3
    assert "C2" not in pin_masses(case)


def test_energy_balances_in_motion_with_pins() -> None:
    case = weighing()
    moving = case.motion.model_copy(update={"speed": 10.0, "inertia": True, "poses": 9})  # type: ignore[union-attr]
    moved = solve_case_motion(case.model_copy(update={"motion": moving}))
    flat = solve_case_motion(case.in_one_plane().model_copy(update={"motion": moving}))
    for found in (moved, flat):
        solved = found.forces["lift"]
        assert np.abs(solved.imbalance).max() < 1e-9 * np.abs(solved.drive_power).max()
    # the pins at the tips of bars that turn evenly: weight alone, since their acceleration points at the pivots
    angles = moved.motion.angles
    more = moved.torque["lift"] - flat.torque["lift"]
    assert more == pytest.approx(2.0 * PER_LENGTH * LONG * 9810.0 * 120.0 * np.cos(angles), rel=1e-9)
