"""Frequencies with hinges at holes in which pins may run: a four-bar that is known, bars on two pins, verdicts."""

import math
import tomllib
from functools import cache
from typing import Any

import numpy as np
import pytest
from tilting_pins import checked, four_bar, in_one_layer

from alula.fea.check.run import check_case
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Verdict
from alula.fea.frame.build import build_frame
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import stiffness_parts
from alula.fea.vibration.frequency_outcomes import asked_frequencies, frequency_outcomes
from alula.fea.vibration.link_modes import link_modes
from alula.fea.vibration.linkage_modes import SUBDIVISIONS, divide, frame_modes
from alula.fea.vibration.mass_matrix import mass_matrix
from alula.fea.vibration.modes import frequency
from alula.fea.vibration.running_holes import running_holes, with_hinges
from alula.geometry.joints.joint import Joint
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.states.masses import part_masses
from alula.reports.sentences import told as in_words

PLASTIC = {"youngs_modulus": "2500 MPa", "poissons_ratio": 0.36, "yield_strength": "50 MPa"}
TURNING = {"forces": [{"link": "rocker", "at": "P", "force": ["0 N", "-0.001 N"]}], "speed": "1200 rpm"}


def plastic(*, bonded: tuple[str, ...] = (), **further: Any) -> Case:
    """The four-bar of a plastic, under a drive at 20 Hz, with some joints bonded."""
    data = four_bar(tight={}, **further)
    data["materials"]["m"] |= PLASTIC
    data["load_cases"] = {"l": TURNING, "slow": {**TURNING, "speed": "60 rpm"}}
    data["checks"] = {"f": {"type": "frequency", "minimum": 2.0}}
    for name in bonded:
        data["joints"][name]["bonded"] = True
    return checked(data)


def lowest(case: Case, *holes: tuple[str, str]) -> float:
    """Lowest frequency of a case without loads, with hinges in holes."""
    frame = build_frame(case, case.solve_pose(), (), held=case.pinned_drive)
    divided, parents = divide(frame, SUBDIVISIONS)
    model = with_hinges(frame, divided, parents, holes)
    path = EquilibriumPath(model)
    K, _ = stiffness_parts(path, np.zeros((len(model.elements), 2, 6)), np.zeros(0))
    mass = mass_matrix(case, frame, model, parents, part_masses(case))
    return frequency(float(frame_modes(path, K, mass, 4).values[0]))


def test_a_single_running_hole_lowers_the_frequency_as_is_known():
    """A frame of its own has 57.5 Hz with tight pins and 20.9 Hz with a hinge about both axes at O4."""
    case = plastic()
    tight = lowest(case)
    assert tight == pytest.approx(57.5, rel=0.05)
    for link in ("base", "rocker"):
        assert lowest(case, ("O4", link)) == pytest.approx(20.9, rel=0.02)
    for holes in ([("A", "crank")], [("A", "coupler")], [("B", "rocker")], [("O2", "base")]):
        assert lowest(case, *holes) < tight
    assert lowest(case, ("O2", "base"), ("O4", "base")) == pytest.approx(0.0, abs=1e-2)  # it swings about a line


@pytest.mark.parametrize(("link", "length", "shear"), [("coupler", 120.0, 0.02), ("crank", 40.0, 0.06)])
def test_a_link_by_itself_bends_between_running_pins_as_a_bar_on_two_supports(link, length, shear):
    """f = π/2 √(E I/(ρ A)) / L² across the plane, less what shear takes; tight pins build it in."""
    [mode] = link_modes(plastic(), link, count=1).modes
    known = math.pi / 2.0 * math.sqrt(2500.0 * 4.0**2 / 12.0 / 1.2e-9) / length**2
    assert mode.frequency.low == pytest.approx(known, rel=shear)
    assert mode.frequency.low < 0.6 * mode.frequency.value


@cache
def outcomes(*bonded: str) -> list[CheckOutcome]:
    return list(frequency_outcomes(asked_frequencies(plastic(bonded=bonded))))


def test_pins_that_nobody_states_to_be_tight_leave_the_frequency_open():
    found = {one.load_case: one for one in outcomes() if one.subject == LINKAGE}
    assert found["l"].verdict is Verdict.UNDECIDED
    assert found["l"].value.low == pytest.approx(0.0, abs=1e-3)
    assert found["slow"].verdict is Verdict.UNDECIDED
    told = "the low end has hinges in holes at O2, A, B, O4, where pins may run: nothing states that they are tight"
    assert all(told in in_words(one.reason) for one in found.values())
    links = [one for one in outcomes() if one.subject != LINKAGE]
    assert {one.verdict for one in links} == {Verdict.PASS}  # by themselves they bend far above the drive
    assert any("hinges in holes at A, B, where pins may run" in in_words(one.reason) for one in links)


def test_the_fits_decide(monkeypatch):
    """With all pins tight but that of the ground at O2 even a hinge there passes; with all tight nothing is open."""
    assert {link for _, link in running_holes(checked(four_bar()))} == {"base", "coupler"}  # tight in the others
    assert {name for name, _ in running_holes(plastic(bonded=("A", "B")))} == {"O2", "O4"}
    lows = []
    for holes in ((("O2", "base"),), ()):
        runs = [(plastic().joints[name], link) for name, link in holes]
        monkeypatch.setattr(Joint, "is_tight_in", lambda joint, link, runs=runs: (joint, link) not in runs)
        assert running_holes(plastic()) == holes
        [found] = [one for one in linkage_outcomes() if one.load_case == "l"]
        assert found.verdict is Verdict.PASS
        assert ("hinges in holes at O2, where" in in_words(found.reason)) == bool(holes)
        lows.append(20.0 * found.value.low)
    assert lows[0] < 0.95 * lows[1] < 0.9 * 57.5


@pytest.mark.parametrize("tight", [False, True])
def test_pins_of_forks_may_run_although_no_link_lies_in_a_layer(tight):
    """Between four such holes the coupler rolls about its axis; the others, drawn as if in one place, are tight."""
    data = in_one_layer(checks={"f": {"type": "frequency", "minimum": 2.0}}, load_cases={"l": TURNING})
    data["materials"]["m"] |= PLASTIC
    for name in ("A", "B") if tight else ():
        data["joints"][name]["tight_in"] = data["joints"][name]["links"]
    case = checked(data)
    assert {name for name, _ in running_holes(case)} == (set() if tight else {"A", "B"})
    [found] = [one for one in frequency_outcomes(asked_frequencies(case)) if one.subject == LINKAGE]
    assert found.value.value > 2.0
    assert found.verdict is (Verdict.PASS if tight else Verdict.UNDECIDED)
    assert (found.value.low > 0.5 * found.value.value) == tight


def test_a_linkage_with_forks_swings_on_a_stiff_drive_as_on_a_rigid_one():
    """Where its drive gives it is let go, with the pins of its forks in their holes all the same: one runs, at B."""
    found = []
    for drive in ({}, {"stiffness": "1000 N*m/rad"}, {"stiffness": "1 N*m/rad"}):
        data = in_one_layer(checks={"f": {"type": "frequency", "minimum": 2.0}}, load_cases={"l": TURNING})
        data["materials"]["m"] |= PLASTIC
        data["joints"]["A"]["tight_in"], data["joints"]["B"]["tight_in"] = ["crank", "coupler"], "coupler"
        data["drive"] |= drive
        outcomes = frequency_outcomes(asked_frequencies(checked(data)))
        found += [one.value for one in outcomes if one.subject == LINKAGE]
    rigid, stiff, soft = found
    assert (stiff.low, stiff.value) == pytest.approx((rigid.low, rigid.value), rel=1e-2, abs=1e-3)
    assert soft.value < 0.9 * stiff.value
    assert 0.0 < rigid.low < 0.7 * rigid.value


def test_heads_without_a_gap_leave_no_hinge():
    """Faces that touch on both sides hold a link's tilt; with any gap, of which its range may be, it tilts in it."""
    data = four_bar(play="0.1 mm")
    for name, gap in {"O2": "0 mm", "A": ["0 mm", "0.02 mm"], "B": "0.02 mm", "O4": "0 mm"}.items():
        data["joints"][name]["heads"] = {"diameter": "7 mm", "gap": gap}
    assert {name for name, _ in running_holes(checked(data))} == {"A", "B"}


def linkage_outcomes() -> list[CheckOutcome]:
    return [one for one in frequency_outcomes(asked_frequencies(plastic())) if one.subject == LINKAGE]


ARM = """
schema_version = 1
title = "An arm on one pin"
layer_spacing = "6.5 mm"
links.base = { ground = true, layer = 0, points.O = ["0 mm", "0 mm"] }
links.arm = { part = "bar", layer = 1, points.O = ["0 mm", "0 mm"], points.P = ["120 mm", "0 mm"] }
joints.O = { links = ["base", "arm"], pin_diameter = "4.5 mm", fit = { arm = "press", base = "H8/f7" } }
pose = { coordinate = "arm", angle = "40 deg" }
drive = { link = "arm", joint = "O" }
load_cases.lift = { speed = "4000 rpm", own_weight = true }
checks.f = { type = "frequency", minimum = 4 }
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "8 mm"
thickness = "6 mm"
fillet_radius = "2 mm"
"""


@pytest.mark.parametrize("solid", [False, True])
def test_an_arm_on_one_running_pin_may_flap_and_swings_in_its_plane_as_held_by_the_drive(solid) -> None:
    """It tilts about two axes: its first two modes out of the plane begin at 0, those in the plane do not."""
    case = validate(tomllib.loads(ARM))
    modes = link_modes(case, "arm", solid=solid).modes
    out, inside = ([mode.frequency for mode in modes if (mode.in_plane < 0.5) is flaps] for flaps in (True, False))
    assert [band.low for band in out[:2]] == [0.0, 0.0]
    assert all(band.low > 0.8 * band.value for band in inside)
    assert len(inside) > 0
    found = check_case(case, name="arm", fidelity="solid" if solid else "beam")
    [own] = [one for one in found.load_cases["lift"].checks if str(one.subject) == "arm"]
    assert (own.value.low, own.verdict) == (0.0, Verdict.UNDECIDED)
