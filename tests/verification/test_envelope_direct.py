"""The stress of a whole motion from unit loads, against direct solutions at single poses."""

from copy import copy
from dataclasses import replace

import numpy as np
import pytest
import solid_meshes
from scipy.optimize import minimize
from turning_load import BODY, POSES, RHO, L, history

from alula.fea.elements.space import displacement_space
from alula.fea.motion.layer_envelope import layer_envelopes
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.superposition.peaks import largest, of_stress
from alula.fea.superposition.unit_solutions import solve_units
from alula.fea.tractions import pin_pressure
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.traction import TRANSFERS
from alula.geometry.materials.material import Fatigue, library
from alula.geometry.meshing.mirror import mirrored
from alula.loads.records.bearing import NARROW, WIDE

MATERIAL = library()["pvc-u"]
E, NU = MATERIAL.youngs_modulus, MATERIAL.poissons_ratio
VARIANTS = [(law, transfer) for law in (WIDE, NARROW) for transfer in TRANSFERS]
EXACT = 5e-3
"""Largest difference of a peak that the requirement allows."""


@pytest.fixture(scope="module")
def mesh():
    return solid_meshes.bar(around=16, radial=3, along=4, layers=1, tail=4.0)


@pytest.fixture(scope="module")
def space(mesh):
    return displacement_space(mesh)


@pytest.fixture(scope="module")
def solved(space):
    loads = history(space)
    units = LinkTractions.of(space, [loads], density=RHO)
    columns = np.hstack([units.coefficients(loads, law, transfer) for law, transfer in VARIANTS])
    scale = np.tile(loads.size(30.0), len(VARIANTS))
    return solve_units(units, columns, scale, E=E, nu=NU, threads=1)


@pytest.mark.parametrize("pose", [0, 5, 10, 14, 21])
def test_fields_and_peaks_equal_a_direct_solution(mesh, space, solved, pose):
    peaks = largest(of_stress(solved.stress, brittle=False), solved.combination)
    direct = solve_solid(
        mesh, E=E, nu=NU, density=RHO, loads=[history(space).chosen(pose)], line=("bore:A", "bore:B"), threads=1
    )
    assert [(c.span, c.transfer) for c in direct.cases] == [(law.span, transfer) for law, transfer in VARIANTS]
    for number, case in enumerate(direct.cases):
        load = number * POSES + pose
        field = stress_field(space, case.displacement, E=E, nu=NU)
        assert peaks.value[load] == pytest.approx(field.peak.value, rel=EXACT)
        whole = np.einsum("nim,m->ni", solved.stress, solved.combination[:, load])
        assert np.abs(whole - field.nodal).max() < 2.0 * EXACT * field.peak.value


def test_the_upper_half_of_a_body_tells_all_its_stress():
    mirror = mirrored(solid_meshes.half_bar(around=12, radial=2, along=2, layers=1, tail=4.0))
    found = []
    for mesh in (mirror, replace(mirror, mirror=None)):
        space = displacement_space(mesh)
        loads = history(space)
        units = LinkTractions.of(space, [loads], density=RHO)
        found.append(
            solve_units(units, units.coefficients(loads, NARROW, TRANSFERS[0]), loads.size(30.0), E=E, nu=NU, threads=1)
        )
    half, whole = found
    assert len(whole.nodes) == len(whole.space.nodes) > 1.6 * len(half.nodes)
    fields = [np.einsum("nim,ml->lni", one.stress, one.combination[:, ::7]) for one in found]
    assert np.abs(fields[0] - fields[1][:, half.nodes]).max() < 1e-9 * np.abs(fields[1]).max()
    peaks = [largest(of_stress(one.stress, brittle=False), one.combination) for one in found]
    assert peaks[0].value == pytest.approx(peaks[1].value, rel=1e-9)


def test_supports_do_not_react_although_single_unit_loads_do_not_balance(solved):
    assert solved.imbalance.max() < 1e-6
    assert solved.reaction.max() < 1e-6


def test_peaks_converge_to_the_direct_ones_with_the_order(mesh, space, monkeypatch):
    """What is left out are high orders of the pressure: more of them, less difference."""
    loads = history(space)
    direct = solve_solid(
        mesh, E=E, nu=NU, density=RHO, loads=[loads.chosen(5)], line=("bore:A", "bore:B"), laws=[NARROW],
        transfers=["eye-faces"], threads=1,
    )  # fmt: skip
    exact = stress_field(space, direct.cases[0].displacement, E=E, nu=NU)
    missed = []
    for highest in (4, 8, 16):
        monkeypatch.setattr(pin_pressure, "HIGHEST_ORDER", highest)
        units = LinkTractions.of(space, [loads], density=RHO)
        found = solve_units(
            units, units.coefficients(loads, NARROW, "eye-faces"), loads.size(30.0), E=E, nu=NU, threads=1
        )
        whole = np.einsum("nim,m->ni", found.stress, found.combination[:, 5])
        missed.append(np.abs(whole - exact.nodal).max() / exact.peak.value)
    assert missed[2] < 0.7 * missed[1] < 0.7 * missed[0]


def test_two_forces_of_one_line_need_few_solutions(space):
    """A two-force link turns with its force: only its size changes over the motion."""
    size = np.linspace(-1.0, 2.0, POSES)
    along = np.column_stack([size, np.zeros(POSES), np.zeros(POSES)])
    loads = history(space, pins={"A": -along, "B": along}, couples={}, ends={}, lines=(), mass=None)
    units = LinkTractions.of(space, [loads], density=RHO)
    found = solve_units(units, units.coefficients(loads, WIDE, None), loads.size(30.0), E=E, nu=NU, threads=1)
    assert found.combination.shape[0] == 3  # the force, and the pressure of a pull and of a push


def test_envelope_of_a_link_finds_the_pose_of_the_largest_direct_peak(mesh, space):
    loads = history(space)
    found = LinkMotion(
        space, link="bar", body=BODY, material=MATERIAL.model_copy(update={"density": RHO}), histories=[loads],
        evaluated=np.ones(POSES, dtype=bool), stated="bore-shear", returns=True,
    ).envelope()  # fmt: skip
    worst = found.worst
    direct = []
    for pose in range(POSES):
        solution = solve_solid(
            mesh, E=E, nu=NU, density=RHO, loads=[loads.chosen(pose)], line=("bore:A", "bore:B"),
            laws=[WIDE if worst.governing.span == 180 else NARROW], transfers=["bore-shear"], threads=1,
        )  # fmt: skip
        direct.append(stress_field(space, solution.cases[0].displacement, E=E, nu=NU).peak)
    values = np.array([peak.value for peak in direct])
    assert worst.governing.stress == pytest.approx(values, rel=EXACT)
    assert worst.pose == int(np.argmax(values))
    assert worst.location == pytest.approx(direct[worst.pose].location)
    assert worst.safety_factor.value == pytest.approx(MATERIAL.allowable / values.max(), rel=EXACT)
    assert found.field.peak.value == pytest.approx(values.max(), rel=EXACT)
    assert abs(found.displacement).max() < L


@pytest.mark.parametrize("halves", [False, True])
def test_layers_over_a_motion_have_their_direct_peaks(mesh, halves):
    """Oblique layers: the lower half of a symmetric body is another part.

    Their fatigue by the peak-stress rule: largest tension, and mean and amplitude of shear by a search for the circle.
    """
    if halves:
        mesh = mirrored(solid_meshes.half_bar(around=12, radial=2, along=2, layers=1, tail=4.0))
    space, layers = displacement_space(mesh), Layers(normal=(1.0, 0.5, 1.0), across=12.0, between=5.0)
    loads = history(space)
    rule = Fatigue.model_validate({"stress": "3 MPa", "cycles": 1e6, "rule": "peak-stress", "source": "made up"})
    motion = LinkMotion(
        space, link="bar", body=BODY, histories=[loads], layers=layers,
        material=MATERIAL.model_copy(update={"density": RHO, "fatigue_across_layers": rule}),
        evaluated=np.ones(POSES, dtype=bool), stated="bore-shear", returns=True,
    )  # fmt: skip
    assert (len(motion.measure.solved.nodes) < len(space.nodes)) is halves
    [found] = layer_envelopes(motion, {}).values()
    fatigue, frame, tractions = found.fatigue, np.linalg.qr([[1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [1.0, 0.0, 1.0]])[0], {}
    at = int(np.argmin(np.linalg.norm(space.nodes - fatigue.location, axis=1)))
    direct = {}
    for pose in range(POSES):
        solution = solve_solid(
            mesh, E=E, nu=NU, density=RHO, loads=[loads.chosen(pose)], line=("bore:A", "bore:B"),
            transfers=["bore-shear"], threads=1,
        )  # fmt: skip
        for case in solution.cases:
            nodal = stress_field(space, case.displacement, E=E, nu=NU).nodal
            stress = layers.stress(nodal)
            xx, yy, zz, xy, yz, xz = nodal[at]
            turned = frame.T @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ frame[:, 0]
            tractions.setdefault(case.span, []).append(turned * (1.0, 12.0 / 5.0, 12.0 / 5.0))
            direct[pose, case.span] = stress.max(), space.nodes[int(np.argmax(stress))]
    worst = max(direct, key=lambda key: direct[key][0])
    assert found.safety_factor.value == pytest.approx(12.0 / direct[worst][0], rel=EXACT)
    assert found.pose == worst[0]
    assert found.location == pytest.approx(direct[worst][1])
    assert found.safety_factor.low < found.safety_factor.value < found.safety_factor.high
    link = replace(motion.measure.link, layers=replace(layers, between=None))
    unknown = copy(motion)
    unknown.measure = replace(motion.measure, link=link)
    assert layer_envelopes(unknown, {})["turn"].safety_factor.low == 0.0
    expected = []
    for span in tractions:
        tension, *shear = np.array(tractions[span]).T
        path = np.array(shear).T
        radius = minimize(
            lambda c, p=path: np.linalg.norm(p - c, axis=1).max(), path.mean(axis=0), method="Nelder-Mead"
        )
        expected.append(np.hypot(max(tension.max(), 0.0), np.linalg.norm(radius.x) + radius.fun))
    assert fatigue.stress.value == pytest.approx(max(expected), rel=EXACT)
    assert fatigue.stress.value >= (1.0 - EXACT) * direct[worst][0]  # no less than the static peak at any node
    assert fatigue.stress.low < fatigue.stress.value < fatigue.stress.high
    assert (fatigue.wanted, fatigue.strength, fatigue.repetitions) == (1e6, 3.0, None)
