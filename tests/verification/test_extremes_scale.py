"""The same part in any size, under any load, of any modulus: dimensionless results agree to 1e-9; runs repeat."""

import re
import tomllib

import numpy as np
import pytest
from arm_case import ARM
from edited_cases import edited

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.links.solid_result import link_task
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field, von_mises
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.bearing import WIDE

MATERIAL = """
[materials.own]
title = "A material"
density = "1e-9 tonne/mm^3"
youngs_modulus = "{young} MPa"
poissons_ratio = 0.38
yield_strength = "{strength} MPa"
strength = "yield"
sources = {{ density = "made up", youngs_modulus = "made up", poissons_ratio = "made up", yield_strength = "made up" }}
status = {{ density = "assumed", youngs_modulus = "assumed", poissons_ratio = "assumed", yield_strength = "assumed" }}
"""
BAR = 'shape = "bar"\nwidth = "4 mm"\nthickness = "3 mm"'
COARSE = MeshSettings(size=1.0, bore_elements=8, turn_elements=6, fillet_size=1.5, growth=1.0)


def arm(size, force, young):
    """The case file, every length ``size`` times as long; the strength follows the stress."""
    text = ARM.format(part=BAR, fillet=1.0, force=repr(-force), minimum=3.0, thickness=3.0)
    text = text.replace('part = "arm"\n', 'part = "arm"\nend_patch = "5 mm"\n', 1).replace("pvc-paredes-2018", "own")
    text = re.sub(r'"(-?[0-9.]+) mm"', lambda found: f'"{float(found[1]) * size!r} mm"', text)
    return validate(tomllib.loads(text + MATERIAL.format(young=repr(young), strength=repr(50.0 * force / size**2))))


def by_hand(size, force, young):
    """Joint force, stress and displacement of the arm by the whole check of hand calculation, without dimensions."""
    found = check_case(arm(size, force, young), fidelity="beam").load_cases["tip"]
    link = found.links["arm"]
    joint = np.linalg.norm(found.forces.reactions.joints["B"].force)
    stress, moved = link.beam.worst.equivalent, link.displacement_max.value
    return np.array([joint / force, stress * size**2 / force, moved * young * size / force])


def by_solid(size=1.0, force=1.0, young=2900.0, threads=1):
    """Peak stress and displacement of the arm's solid on one mesh, without dimensions."""
    case = arm(size, force, young)
    statics = solve_case_statics(case)
    loads = link_loads("tip", "arm", case.body("arm"), statics.reactions["tip"], statics.loads["tip"])
    task = link_task(case, "arm", [loads])
    solid = solve_solid(
        mesh_body(task.body, COARSE), E=task.E, nu=task.nu, density=task.density, loads=task.loads, line=task.line,
        laws=(WIDE,), threads=threads,
    )  # fmt: skip
    own = solid.cases[0]
    peak = von_mises(stress_field(solid.space, own.displacement, E=young, nu=task.nu).nodal).max()
    return np.array([peak * size**2 / force, own.displacement_max * young * size / force])


@pytest.fixture(scope="module")
def solid():
    return by_solid()


@pytest.mark.parametrize(
    ("size", "force", "young"),
    [(1e-3 / 30.0, 1e-12, 1e-3), (1e6 / 30.0, 1e9, 1e6)],
    ids=["micrometre, 1e-12 N, 1 kPa", "kilometre, 1e9 N, 1 TPa"],
)
def test_solid_in_any_scale(solid, size, force, young):
    np.testing.assert_allclose(by_solid(size, force, young), solid, rtol=1e-9)


@pytest.mark.parametrize("size", [1e-3 / 30.0, 1.0 / 30.0, 1e3 / 30.0, 1e6 / 30.0])
@pytest.mark.parametrize("force", [1e-12, 1e9])
@pytest.mark.parametrize("young", [1e-3, 1e6])
def test_whole_check_by_hand_in_any_scale(size, force, young):
    np.testing.assert_allclose(by_hand(size, force, young), by_hand(1.0, 1.0, 2900.0), rtol=1e-9)


def four_bar(force):
    """Verdicts of the built-in case's checks, displacements over the force, and factors times it."""
    overrides = [f'load_cases.lift.forces=[{{link="rocker", at="P", force=["0 N", "{-force!r} N"]}}]']
    case = read_case("four-bar", [*overrides, "load_cases.lift.own_weight=false"])
    found = check_case(case, fidelity="beam").load_cases["lift"]
    moves = {Quantity.DEFLECTION: 1.0 / force}
    values = [one.value.value * moves.get(one.quantity, force) for one in found.checks]
    return [one.verdict for one in found.checks], values


def test_factors_of_a_linkage_are_in_proportion_however_small_its_load():
    verdicts, values = four_bar(1e-3)
    assert Verdict.PASS in verdicts
    for force in (1e-9, 1e-10):
        found = four_bar(force)
        assert found[0] == verdicts
        assert found[1] == pytest.approx(values, rel=1e-3, nan_ok=True)


def test_one_thread_repeats_to_the_last_bit_and_two_to_rounding(solid):
    np.testing.assert_array_equal(by_solid(), solid)
    np.testing.assert_allclose(by_solid(threads=2), solid, rtol=1e-9)


LAYERED = (
    'layer_spacing="6 mm"',
    *(f"links.{link}.layer={layer}" for link, layer in (("base", 0), ("crank", 1), ("coupler", 0), ("rocker", 1))),
    "load_cases.lift.own_weight=false",
)


def pressed(force):
    return edited(
        "four-bar", (*LAYERED, f'load_cases.lift.forces=[{{link="rocker", at="P", force=["0 N", "-{force}"]}}]')
    )


def test_small_loads_on_layers_stress_links_in_proportion():
    """Links hardly deform, so that pins stand as the clearances let them, whatever the load."""
    found = {}
    for force, newton in (("0.1 mN", 1e-4), ("0.1 uN", 1e-7)):
        links = check_case(pressed(force), fidelity="beam").load_cases["lift"].links
        found[force] = [1.0 / (link.safety_factor.low * newton) for link in links.values()]
    assert len(found["0.1 uN"]) == 3
    np.testing.assert_allclose(found["0.1 uN"], found["0.1 mN"], rtol=0.015)


@pytest.mark.parametrize("force", ["0.01 uN", "5e-12 N"])
def test_loads_that_rounding_hides_between_layers_are_refused(force):
    with pytest.raises(CannotRunError, match="loads are too small for it"):
        check_case(pressed(force), fidelity="beam")


def test_no_load_between_layers_is_none():
    link = check_case(pressed("0 N"), fidelity="beam").load_cases["lift"].links["crank"]
    assert link.safety_factor.low == np.inf
