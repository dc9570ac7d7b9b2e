"""A check and an envelope load a link alike: the same load vectors and peaks, under every kind of load at once."""

import numpy as np
import pytest
from every_load import BODY, RHO, every_load

from alula.fea.elements.space import displacement_space
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.superposition.peaks import largest, of_stress
from alula.fea.superposition.unit_solutions import solve_units
from alula.fea.tractions.link_tractions import KINDS, LinkTractions
from alula.fea.tractions.traction import TRANSFERS
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.records.bearing import NARROW, WIDE

E, NU = 2300.0, 0.36
VARIANTS = [(law, transfer) for law in (WIDE, NARROW) for transfer in TRANSFERS]


@pytest.fixture(scope="module")
def mesh():
    return mesh_body(BODY, MeshSettings(halves=False).scaled(2.0))


@pytest.fixture(scope="module")
def tractions(mesh):
    return LinkTractions.of(displacement_space(mesh), [every_load()], density=RHO)


def test_every_kind_of_load_is_there(tractions) -> None:
    assert {type(load) for load in tractions.loads} == set(KINDS)
    assert tractions.transfers(every_load()) == TRANSFERS


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("law", "transfer"), VARIANTS)
def test_fields_of_every_kind_sum_to_the_load_itself(tractions, kind, law, transfer) -> None:
    """What needs no series to rounding, pressures of pins within what their series leaves out; resultants always."""
    loads = every_load()
    for load in (load for load in tractions.loads if isinstance(load, kind)):
        summed, itself = load.fields @ load.coefficients(loads, law, transfer), load.exact(loads, law, transfer)
        off = np.linalg.norm(summed - itself, axis=0)
        assert (off <= (0.08 if load.local else 1e-12) * np.linalg.norm(itself, axis=0)).all()
        left = (summed - itself).reshape(-1, 3, loads.poses)
        moment = np.cross(tractions.space.nodes[:, None], left.transpose(0, 2, 1)).sum(axis=0)
        assert np.abs(left.sum(axis=0)).max() < 1e-10
        assert np.abs(moment).max() < 1e-8


def test_loads_of_every_variant_balance(tractions) -> None:
    loads = every_load()
    for law, transfer in VARIANTS:
        assert np.abs(tractions.wrenches @ tractions.coefficients(loads, law, transfer)).max() < 1e-8


@pytest.mark.converged
def test_peaks_of_an_envelope_are_those_of_checks(mesh, tractions) -> None:
    loads = every_load()
    columns = np.hstack([tractions.coefficients(loads, law, transfer) for law, transfer in VARIANTS])
    solved = solve_units(tractions, columns, np.tile(loads.size(40.0), len(VARIANTS)), E=E, nu=NU, threads=1)
    peaks = largest(of_stress(solved.stress, brittle=False), solved.combination)
    for pose in range(loads.poses):
        direct = solve_solid(
            mesh, E=E, nu=NU, density=RHO, loads=[loads.chosen(pose)], line=("bore:A", "bore:B"), threads=1
        )
        for number, case in enumerate(direct.cases):
            field = stress_field(direct.space, case.displacement, E=E, nu=NU)
            assert peaks.value[number * loads.poses + pose] == pytest.approx(field.peak.value, rel=5e-3)
            whole = np.einsum("nim,m->ni", solved.stress, solved.combination[:, number * loads.poses + pose])
            assert np.abs(whole - field.nodal).max() < 5e-2 * field.peak.value  # where a pressure turns along its bore


def test_a_thrust_pushes_on_the_flat_face_of_its_side(tractions) -> None:
    """Not in the bore, which has no shoulder."""
    loads, space = every_load(), tractions.space
    [thrust] = [load for load in tractions.loads if type(load).__name__ == "Thrust" and load.place == "B"]
    for pose, force in enumerate(loads.pins[2].wrench[:, 2]):
        nodal = thrust.exact(loads, WIDE, None)[:, pose].reshape(-1, 3)
        assert nodal.sum(axis=0) == pytest.approx([0.0, 0.0, force], abs=1e-12)
        for face, sign in (("bottom:B", 1.0), ("top:B", -1.0)):
            own = nodal[np.unique(space.faces(face)), 2].sum()
            assert own == pytest.approx(force if sign * force > 0.0 else 0.0, abs=1e-12)
