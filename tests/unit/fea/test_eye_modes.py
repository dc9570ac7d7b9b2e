"""Strengths of eyes against published worked examples, geometry drawn anew, and what their directions make."""

import math
from dataclasses import replace

import numpy as np
import pytest

from alula.fea.common.band import Band
from alula.fea.modes.eye_modes import EyeMode, EyeStrength, RoundEye, asme_bth_1, en_1993_1_8

LUG = RoundEye(radius=1.5, hole=0.875, pin=0.75, thickness=0.75, wall=0.75)
"""In inches, of A36 steel with 36 and 58 ksi."""


def test_a_worked_example_of_asme_bth_1():
    """A published sheet of the 2014 edition, with N_d = 3: 19.3343 kip through the hole, 17.0312 kip beyond it."""
    found = asme_bth_1(LUG, 36.0, 58.0)
    assert LUG.loose == pytest.approx(0.8583533, rel=1e-6)
    assert found[EyeMode.NET_SECTION] / (1.20 * 3.0) == pytest.approx(19.3343, rel=1e-5)
    assert found[EyeMode.FRACTURE] / (1.20 * 3.0) == pytest.approx(17.0312, rel=1e-5)
    assert found[EyeMode.BEARING] / (3.0 * 0.75 * 0.75) == pytest.approx(15.0)  # ksi on the pin's projected area


def test_a_worked_example_of_shear_to_a_round_edge():
    """A published sheet of the 2005 edition, N_d = 2: planes of 3.512 in less 0.028 in, 88.41 kip together."""
    eye = RoundEye(radius=4.15625, hole=1.6875, pin=1.375, thickness=0.75, wall=0.75)
    assert eye.shear_plane == pytest.approx(3.512 - 0.028, abs=1e-3)
    assert asme_bth_1(eye, 36.0, 58.0)[EyeMode.SHEAR_OUT] / (1.20 * 2.0) == pytest.approx(88.41, rel=1e-3)


def test_the_shear_plane_runs_from_pin_to_edge():
    """Drawn: the pin touches the hole's far side, and a line along the force leaves it at φ = 55° D_p/D_h off that."""
    angle = math.radians(55.0 * 0.75 / 0.875)
    centre = (0.875 - 0.75) / 2.0
    start = centre + 0.375 * math.cos(angle)
    assert LUG.shear_plane == pytest.approx(math.sqrt(1.5**2 - (0.375 * math.sin(angle)) ** 2) - start)


def test_a_thin_eye_dishes_and_a_snug_pin_takes_nothing_off():
    assert replace(LUG, pin=0.79).loose == 1.0
    thin = asme_bth_1(replace(LUG, thickness=0.2, wall=0.1), 36.0, 58.0)
    assert thin[EyeMode.DISHING] == pytest.approx(LUG.loose * 2.0 * (4.0 * 0.1) * 0.2 * 58.0)
    assert thin[EyeMode.DISHING] < thin[EyeMode.NET_SECTION]


def test_a_material_that_hardens_little_tears_in_less_than_its_width():
    """b_eff = b · 0.6 (F_u/F_y) √(D_h/b), and b at most."""
    eye = RoundEye(radius=3.0, hole=2.0, pin=2.0, thickness=1.0, wall=1.0)
    assert asme_bth_1(eye, 100.0, 100.0)[EyeMode.NET_SECTION] == pytest.approx(100.0 * 2.0 * 2.0 * 0.6)
    assert asme_bth_1(eye, 40.0, 100.0)[EyeMode.NET_SECTION] == pytest.approx(100.0 * 2.0 * 2.0)


@pytest.mark.parametrize(("mode", "share"), [(EyeMode.END, 2.0 / 3.0), (EyeMode.SIDE, 1.0 / 3.0)])
def test_an_eye_has_just_the_distances_that_en_1993_asks_for_under_its_strength(mode, share):
    force = en_1993_1_8(LUG, 36.0, 50.0)[mode]
    assert force / (2.0 * 0.75 * 36.0) + share * 0.875 == pytest.approx(1.5 - 0.875 / 2.0)
    assert en_1993_1_8(replace(LUG, radius=0.5), 36.0, 50.0)[mode] == 0.0


def test_bearing_by_en_1993_is_on_the_weaker_of_pin_and_eye():
    assert en_1993_1_8(LUG, 36.0, 50.0)[EyeMode.BEARING] == pytest.approx(1.5 * 0.75 * 0.75 * 36.0)
    assert en_1993_1_8(LUG, 36.0, 20.0)[EyeMode.BEARING] == pytest.approx(1.5 * 0.75 * 0.75 * 20.0)


def strength(*shanks, **others):
    modes = {EyeMode.SHEAR_OUT: Band(value=10.0, low=8.0, high=12.0), EyeMode.BEARING: Band.exact(30.0)}
    return EyeStrength(name="A", modes=modes, shanks=shanks, across=0.25, **others)


@pytest.mark.parametrize(
    ("degrees", "least"),
    [(0.0, 8.0), (30.0, 7.0), (-30.0, 7.0), (90.0, 6.0), (120.0, 8.0 - 2.0 * math.sqrt(0.75)), (180.0, math.inf)],
)
def test_a_force_across_the_shank_takes_off_and_one_into_it_leaves_bearing(degrees, least):
    """Shank towards -x, two forces at once: the other is twice as large, straight off the shank."""
    at = math.radians(degrees)
    found, angle = strength((-1.0, 0.0)).factors(np.array([[math.cos(at), math.sin(at)], [2.0, 0.0]]))
    assert found[EyeMode.SHEAR_OUT][1] == pytest.approx([least, 4.0])
    assert found[EyeMode.SHEAR_OUT][0][1] == 5.0
    assert found[EyeMode.BEARING][1] == pytest.approx([30.0, 15.0])
    assert np.degrees(angle) == pytest.approx([abs(degrees), 0.0], abs=1e-9)


def test_as_a_force_turns_into_the_shank_factors_rise_without_a_step():
    """From 30° to its middle, what lies across counts: half of a force at asin(1/4). One degree moves it by few %."""
    at = np.radians([149.99, 150.01, 180.0 - math.degrees(math.asin(0.25))])
    forces = np.stack([np.cos(at), np.sin(at)], axis=-1)
    value, low, high = strength((-1.0, 0.0)).factors(forces)[0][EyeMode.SHEAR_OUT]
    assert value == pytest.approx([10.0, 10.0, 20.0], rel=1e-3)
    assert low == pytest.approx([7.0, 7.0, 16.0 * (1.0 - 0.25 / 4.0)], rel=1e-3)
    assert high == pytest.approx([12.0, 12.0, 24.0], rel=1e-3)
    # Of two shanks too, at right angles: the other one is across all the while.
    two = strength((-1.0, 0.0), (0.0, 1.0)).factors(forces)[0][EyeMode.SHEAR_OUT][1]
    assert two[:2] == pytest.approx([8.0 - 2.0 * math.sqrt(0.75)] * 2, rel=1e-3)


def test_where_no_shank_gives_relief_all_modes_stand():
    """Forces straight into the shank, and across: of a plate, and of a hole that material surrounds."""
    forces = np.array([[-1.0, 0.0], [0.0, 1.0]])
    assert strength((-1.0, 0.0)).factors(forces)[0][EyeMode.SHEAR_OUT][1] == pytest.approx([math.inf, 6.0])
    assert strength((-1.0, 0.0), relieved=False).factors(forces)[0][EyeMode.SHEAR_OUT][1] == pytest.approx([8.0, 6.0])
    assert strength().factors(forces)[0][EyeMode.SHEAR_OUT][1] == pytest.approx([8.0, 8.0])


@pytest.mark.parametrize("order", [1, -1])
def test_of_two_shanks_either_is_pressed_into(order):
    eye = strength(*[(-1.0, 0.0), (0.0, 1.0)][::order])
    found, angle = eye.factors(np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [0.0, 0.0]]))
    assert np.degrees(angle[:4]) == pytest.approx([0.0, 180.0, 180.0, 0.0])
    assert found[EyeMode.SHEAR_OUT][1] == pytest.approx([8.0, math.inf, math.inf, 8.0, math.inf])
    assert found[EyeMode.BEARING][1] == pytest.approx([30.0, 30.0, 30.0, 30.0, math.inf])
