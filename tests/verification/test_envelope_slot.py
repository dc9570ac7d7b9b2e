"""A pin that travels in its slot over a motion: stress by unit loads against direct solutions at single poses."""

import numpy as np
import pytest
from edited_cases import PLANAR

from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.space import displacement_space
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.motion.link_history import link_histories
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.superposition.unit_solutions import solve_units
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.slot_pressure import SlotPressure
from alula.geometry.base.errors import CaseError
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.case.case_file import read_case
from alula.loads.records.bearing import NARROW, WIDE
from alula.loads.states.case_motion import solve_case_motion

LINK, LAWS = "lever-right", (WIDE, NARROW)
EXACT = 5e-3
"""Largest difference of stress, of the largest on the link."""


@pytest.fixture(scope="module")
def case():
    return read_case("ornithopter", [PLANAR, "motion.poses=61"])


@pytest.fixture(scope="module")
def history(case) -> LinkLoads:
    found = {h.name: h for h in link_histories(solve_case_motion(case), LINK)}
    return found["wings-12"]


@pytest.fixture(scope="module")
def mesh(case):
    return mesh_body(case.body(LINK), MeshSettings().scaled(2.0))


def direct(mesh, history: LinkLoads, pose: int, material):
    solution = solve_solid(
        mesh, E=material.youngs_modulus, nu=material.poissons_ratio, density=material.density,
        loads=[history.chosen(pose)], line=("bore:slot", "bore:R"), laws=LAWS, threads=1,
    )  # fmt: skip
    assert max(one.imbalance for one in solution.cases) < 1e-4
    return [
        stress_field(solution.space, one.displacement, E=material.youngs_modulus, nu=material.poissons_ratio)
        for one in solution.cases
    ]


def test_the_pin_travels_and_pushes_either_flank(history: LinkLoads) -> None:
    slot = history.pins[0]
    place, force = slot.centre[:, 0], slot.wrench
    assert (slot.name, slot.slotted) == ("slot", True)
    assert np.ptp(place) == pytest.approx(7.67791399574 - 7.06755709747, abs=0.01)
    assert place.min() == pytest.approx(-7.67791399574, abs=1e-9)
    assert force[:, 1].min() < 0.0 < force[:, 1].max()
    assert np.all(force[:, [0, 2, 4, 5]] == 0.0)


def test_stress_at_every_place_of_the_pin_equals_a_direct_solution() -> None:
    """With friction, of the pin in its slot and of the one in its bore."""
    case = read_case(
        "ornithopter", [PLANAR, "motion.poses=61", "joints.slot-right.friction=0.3", "joints.R.friction=0.3"]
    )
    history = {h.name: h for h in link_histories(solve_case_motion(case), LINK)}["wings-12"]
    slot = history.pins[0]
    assert np.abs(slot.friction) == pytest.approx(0.3 * np.abs(slot.wrench[:, 1]))
    assert np.array_equal(slot.wrench[:, 0], slot.friction)
    mesh = mesh_body(case.body(LINK), MeshSettings(halves=False).scaled(2.0))  # node by node, so that both are whole
    material, space = case.material_of(LINK), displacement_space(mesh)
    units = LinkTractions.of(space, [history], density=material.density)
    columns = np.hstack([units.coefficients(history, law, None) for law in LAWS])
    solved = solve_units(
        units, columns, np.tile(history.size(14.0), 2),
        E=material.youngs_modulus, nu=material.poissons_ratio, threads=1,
    )  # fmt: skip
    assert solved.imbalance.max() < 1e-9
    assert solved.reaction.max() < 1e-6
    [places] = [load.places[NARROW] for load in units.loads if isinstance(load, SlotPressure)]
    for pose in (4, 12, 33):
        gap = np.abs(places - history.pins[0].centre[pose, 0]).min()
        assert gap > 1e-4  # between the places of the unit loads, not at one of them
        for number, field in enumerate(direct(mesh, history, pose, material)):
            whole = np.einsum("nim,m->ni", solved.stress, solved.combination[:, number * history.poses + pose])
            slotted = space.nodes[: len(whole), 0] < -5.5
            for where in (slotted, ~slotted):
                off = np.abs(whole - field.nodal)[where].max()
                assert off < EXACT * np.abs(field.nodal)[where].max(), (pose, number)


def test_the_envelope_of_a_slotted_link_has_its_direct_peaks(case, mesh, history: LinkLoads) -> None:
    material = case.material_of(LINK)
    found = LinkMotion(
        displacement_space(mesh), link=LINK, body=case.body(LINK), material=material, histories=[history],
        evaluated=np.ones(history.poses, dtype=bool), stated="eye-faces", returns=True,
    ).envelope()  # fmt: skip
    for pose in (found.worst.pose, 9, 21):
        for field, variant in zip(direct(mesh, history, pose, material), found.worst.variants, strict=True):
            assert variant.transfer is None
            assert variant.stress[pose] == pytest.approx(float(field.principal.max()), rel=EXACT)


def test_a_slot_that_ends_before_the_pin_is_named() -> None:
    short = read_case("ornithopter", ['links.lever-right.slots.slot.last="-7.2 mm"', "motion.poses=13"])
    with pytest.raises(CaseError, match=r"lever-right.slots.slot: over .* to -7.06\d* mm.*lengthen"):
        link_histories(solve_case_motion(short), LINK)
