"""A lever from a file, with a slot in which the pin of a crank slides.

The lever is 12 mm wide and 4 mm thick, with a hub 8 mm high about its bore of 5 mm. Its slot of 4 mm has the centres of
its round ends 34 and 48 mm from the bore.
"""

import meshio
import numpy as np
import pytest
from imported_case import STEP

from alula.fea.beam.cut_free import link_loads
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import displacement_space
from alula.fea.tractions.slot_traction import DEGREE, slot_traction
from alula.geometry.base.errors import CaseError
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.loads.case.case_file import read_case
from alula.loads.records.bearing import NARROW, WIDE
from alula.loads.states.actions import acting_loads
from alula.loads.statics.statics import solve_statics

TOML = """
schema_version = 1
title = "A slotted lever from a file"
links.base = { ground = true, points = { O4 = ["0 mm", "0 mm"], O2 = ["41 mm", "0 mm"] } }
links.crank = { points = { O2 = ["0 mm", "0 mm"], S = ["6 mm", "0 mm"] } }
links.lever = { part = "lever", POINTS }
joints.O4 = { links = ["base", "lever"], pin_diameter = "5 mm" }
joints.O2 = { links = ["base", "crank"], pin_diameter = "3 mm" }
joints.S = { type = "pin-in-slot", links = ["lever", "crank"], pin_diameter = "3.8 mm" }
pose = { coordinate = "crank", angle = "60 deg", near = { lever = "7 deg" } }
drive = { link = "lever", joint = "O4" }
load_cases.push = { forces = [{ link = "crank", at = "S", force = ["0 N", "12 N"] }] }
parts.lever = { shape = "step", material = "pvc-paredes-2018", file = "lever.step", ENTRIES }
"""
STATED = """points = { O4 = ["0 mm", "0 mm"], S = ["40 mm", "0.02 mm"] },
  slots = { S = { first = "34.03 mm", last = "48.03 mm", clearance = "0.1 mm" } }""".replace("\n", "")
FROM_PART = 'points = "from-part"'
NAMED = 'bores = { O4 = "bore 1", S = "bore 2" }'


def lever_case(folder, points=STATED, entries=""):
    (folder / "lever.step").write_bytes((STEP / "lever.step").read_bytes())
    path = folder / "case.toml"
    text = TOML.replace("POINTS", points).replace(", ENTRIES", f", {entries}" if entries else "")
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return read_case(str(lever_case(tmp_path_factory.mktemp("lever"))))


@pytest.fixture(scope="module")
def mesh(case):
    return mesh_body(case.body("lever"), COARSE)


def check_placed(link, body):
    (x0, y0), ends = link.points["O4"], link.slots["S"]
    assert (ends.first - x0, ends.last - x0) == pytest.approx((34.0, 48.0), abs=1e-6)
    assert link.points["S"][1] == pytest.approx(y0, abs=1e-6)
    slot = body.pin("S")
    assert (slot.diameter, slot.slot, slot.pin_diameter) == pytest.approx((4.0, 14.0, 3.8))
    assert slot.span == pytest.approx((ends.first, ends.last))
    # Hub from 4 mm below to above its middle, slot half as long: the plane is halfway between both middles.
    heights = [(body.pin(name).ring.low, body.pin(name).ring.high) for name in ("O4", "S")]
    assert np.ptp(heights, axis=1) == pytest.approx([8.0, 4.0])
    assert sorted(abs(low + high) / 2.0 for low, high in heights) == pytest.approx([1.0, 1.0])


def test_bore_and_slot_tell_how_it_lies_and_the_stated_ends_move_to_those_of_the_part(case):
    check_placed(case.links["lever"], case.body("lever"))
    assert case.links["lever"].points["S"][0] == 40.0  # from where its travel counts


def test_points_and_slots_may_come_from_the_part(tmp_path):
    case = read_case(str(lever_case(tmp_path, FROM_PART, NAMED)))
    check_placed(case.links["lever"], case.body("lever"))


def test_a_mesh_has_the_same_slot(tmp_path, case, mesh):
    meshio.write(tmp_path / "lever.msh", meshio.Mesh(mesh.points, [("tetra10", mesh.cells)]), file_format="gmsh")
    path = lever_case(tmp_path)
    path.write_text(path.read_text().replace('"step"', '"mesh"').replace("lever.step", "lever.msh"), encoding="utf-8")
    found = read_case(str(path))
    check_placed(found.links["lever"], found.body("lever"))
    areas = mesh_body(found.body("lever"), COARSE).areas
    assert areas == pytest.approx({name: mesh.areas[name] for name in ("bore:O4", "bore:S")}, rel=3e-4)


@pytest.mark.parametrize("law", [WIDE, NARROW])
def test_the_pin_presses_where_it_stands(case, mesh, law):
    """Where it stands and how strongly it presses follow from the triangle of crank and lever by hand.

    About O2 the crank bears 12 N with an arm of 3 mm, and the lever's push across it. The slot's wall measures
    (π d + 2 · 14 mm) · 4 mm.
    """
    assert mesh.areas["bore:S"] == pytest.approx((np.pi * 4.0 + 28.0) * 4.0, rel=1e-4)
    pose = case.solve_pose()
    acting = acting_loads(case, case.load_cases["push"], pose.placement, {})
    loads = link_loads("push", "lever", case.body("lever"), solve_statics(pose, case.pinned_drive, acting), acting)
    [pin] = [pin for pin in loads.pins if pin.slotted]
    away = np.sqrt(41.0**2 + 6.0**2 + 2.0 * 41.0 * 6.0 * np.cos(np.radians(60.0)))
    assert pin.centre[0] - case.links["lever"].points["O4"][0] == pytest.approx(away, rel=1e-4)
    across = 6.0 * np.cos(np.radians(60.0) - np.arctan2(6.0 * np.sin(np.radians(60.0)), 44.0))
    assert pin.wrench[:2] == pytest.approx([0.0, 12.0 * 3.0 / across], rel=1e-3, abs=1e-9)
    wall = surface_quadrature(displacement_space(mesh), "bore:S", degree=DEGREE)
    pressure = slot_traction(wall, pin, law)
    assert wall.wrench(pressure, pin.centre) == pytest.approx(pin.wrench, abs=1e-9)
    pushed = np.abs(pressure).max(axis=2) > 1e-12
    assert np.abs(wall.x[pushed][:, 0] - pin.centre[0]).max() <= law.patch(3.8) / 2.0


@pytest.mark.parametrize(
    ("points", "entries", "said"),
    [
        (STATED.replace("48.03", "47"), "", "no parallel bores lie as the link's points do .* bore 2 .one end."),
        (STATED.replace("0.1 mm", "1 mm"), "", "no slot is within 0.3 mm .* at S, 3.8 mm and 1 mm of clearance"),
        (STATED.partition(",  slots")[0], "", "whose part needs a slot for it; add slots.S"),
        (STATED, 'bores = { S = "bore 1" }', "the pin at S slides in a slot, but bore 1 is a round bore"),
        (STATED, 'bores = { O4 = "bore 2" }', "the pin at O4 turns in a round bore, but bore 2 is a slot"),
    ],
)
def test_what_is_no_slot_is_one_sentence(tmp_path, points, entries, said):
    with pytest.raises(CaseError, match=said):
        read_case(str(lever_case(tmp_path, points, entries)))
