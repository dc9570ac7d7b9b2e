"""How far a point moves with the links' solids: known answers, and the linkage put together from its links' bores.

* A flat bar, 14 mm wide with round ends, 4 mm thick, with holes of 5 and 6.5 mm 70 mm apart, pulled by 850 N (cosine
  pressure, E 68,900 MPa, ν 0.33): the mean motions of its bores part by 0.01912 mm on a fine solid mesh,
  by 0.019134 mm in plane stress. Centre lines read F L/(E A) = 0.01543 mm.
* A tube of 5 over 3 mm with solid eyes of 9 by 7.5 mm, 88 mm from bore to bore of 2.5 mm (E 2400 MPa, ν 0.38), one
  clamped, the other under 1 N across (cosine pressure): the mean motion of the loaded bore is 3.2264 mm by CalculiX
  with 159,786 unknowns, every node of the clamped bore held, and 3.2221 mm with 77,841. Centre lines read 3.56 mm.
* A plate of 3 mm about pins A (0, 0), B (60, 0) and C (22, 34) mm, the hull of circles of radius 7, 6 and 8 mm, with
  holes of 5, 4 and 6 mm (E 2900 MPa, ν 0.38): joint forces (-97.0588, -45), (40, 25) and (57.0588, 20) N by cosine
  pressure move the bores of A and B apart by 0.03725 mm, in the mean.
"""

import re
import tomllib
from functools import cache

import numpy as np
import pytest
import rocker_case

from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.outcomes.result import CheckResult
from alula.fea.solid.bore_motion import mean_motion
from alula.loads.case.case_file import validate
from alula.reports.sentences import told as in_words

CLAMPED = 3.2264
"""Of the tube [mm]."""
MATERIAL = """
[materials.{name}]
title = "Test"
youngs_modulus = "{young} MPa"
poissons_ratio = {poisson}
density = "2700 kg/m^3"
yield_strength = "1000 MPa"
strength = "yield"
minimum_safety_factor = 1.0
[materials.{name}.sources]
youngs_modulus = "test"
poissons_ratio = "test"
density = "test"
yield_strength = "test"
[materials.{name}.status]
youngs_modulus = "assumed"
poissons_ratio = "assumed"
density = "assumed"
yield_strength = "assumed"
"""
FLAT = """
schema_version = 1
title = "A flat bar, pulled; its second pin slides along a slot of the ground"
links.frame = { ground = true, points = { A = ["0 mm", "0 mm"], G = ["70 mm", "0 mm"] } }
links.bar = { part = "flat", points = { A = ["0 mm", "0 mm"], B = ["70 mm", "0 mm"] } }
joints.A = { links = ["frame", "bar"], pin_diameter = "5 mm" }
joints.B = { links = ["frame", "bar"], type = "pin-in-slot", points = ["G", "B"], pin_diameter = "6.5 mm" }
pose.near = { bar = "0 deg" }
load_cases.pull = { forces = [{ link = "bar", at = "B", force = ["850 N", "0 N"] }] }
checks.stiff = { type = "displacement", link = "bar", at = "B", maximum = "1 mm" }
solid = { mesh_size = 2.0 }
[parts.flat]
shape = "bar"
material = "aluminium"
width = "13.99 mm"
thickness = "4 mm"
eye_diameter = "14 mm"
eye_thickness = "4 mm"
fillet_radius = "0 mm"
"""


TUBE = """
schema_version = 1
title = "A tube with solid eyes, held by a drive at one and bent by a rod at the other"
links.frame = { ground = true, points = { A = ["0 mm", "0 mm"], C = ["88 mm", "40 mm"] } }
links.tube = { part = "tube", points = { A = ["0 mm", "0 mm"], B = ["88 mm", "0 mm"] } }
links.rod = { points = { B = ["0 mm", "0 mm"], C = ["40 mm", "0 mm"] } }
joints.A = { links = ["frame", "tube"], pin_diameter = "2.5 mm" }
joints.B = { links = ["tube", "rod"], pin_diameter = "2.5 mm" }
joints.C = { links = ["frame", "rod"], type = "pin-in-slot", points = ["C", "C"], direction = "90 deg" }
pose = { coordinate = "tube", angle = "0 deg", near = { rod = "90 deg" } }
drive = { link = "tube", joint = "A" }
load_cases.bend = { forces = [{ link = "rod", at = "C", force = ["0 N", "FORCE N"] }] }
checks.stiff = { type = "displacement", link = "tube", at = "B", maximum = "50 mm" }
solid = { mesh_size = 2.0 }
[parts.tube]
shape = "tube"
material = "plastic"
outer_diameter = "5 mm"
inner_diameter = "3 mm"
eye_diameter = "9 mm"
eye_thickness = "7.5 mm"
fillet_radius = "1 mm"
"""
PLATE = """
schema_version = 1
title = "A plate with three pins: A stands, B slides along AB, and a hook, which bears nothing itself, pulls at C"
links.frame = { ground = true, points = { A = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"], D = ["22 mm", "50 mm"] } }
links.hook = { points = { C = ["0 mm", "0 mm"], D = ["16 mm", "0 mm"] } }
joints.A = { links = ["frame", "plate"], pin_diameter = "5 mm" }
joints.B = { links = ["frame", "plate"], type = "pin-in-slot", points = ["B", "B"], pin_diameter = "4 mm" }
joints.C = { links = ["plate", "hook"], pin_diameter = "6 mm" }
joints.D = { links = ["frame", "hook"], type = "pin-in-slot", points = ["D", "D"], direction = "90 deg" }
pose.near = { plate = "0 deg", hook = "90 deg" }
checks.stiff = { type = "displacement", link = "plate", at = "B", maximum = "1 mm" }
solid = { mesh_size = 1.5 }
load_cases.pull.forces = [
    { link = "plate", at = "B", force = ["40 N", "0 N"] },
    { link = "hook", at = "C", force = ["57.0588 N", "20 N"] },
]
[links.plate]
part = "plate"
points = { A = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"], C = ["22 mm", "34 mm"] }
eyes = { A = { diameter = "14 mm" }, B = { diameter = "12 mm" }, C = { diameter = "16 mm" } }
[parts.plate]
shape = "plate"
material = "plastic"
thickness = "3 mm"
eye_diameter = "14 mm"
"""
ROCKER = (
    rocker_case.TOML.replace("links.crank = {", 'links.crank = { part = "bar",')
    .replace("links.coupler = {", 'links.coupler = { part = "bar",')
    .replace(
        'load_cases.turn = { moments = [{ link = "rocker", at = "P", moment = "20 N*mm" }] }',
        """load_cases.turn = { forces = [{ link = "rocker", at = "P", force = ["0.2 N", "-0.3 N"] }] }
checks.stiff = { type = "displacement", link = "rocker", at = "P", maximum = "1 mm" }""",
    )
)


@cache
def checked(text: str, fidelity: str = "solid") -> CheckResult:
    return check_case(validate(tomllib.loads(text)), fidelity=fidelity, threads=1)


def displacement(result: CheckResult) -> CheckOutcome:
    (load_case,) = result.load_cases.values()
    (found,) = (check for check in load_case.checks if check.quantity == Quantity.DISPLACEMENT)
    return found


def test_a_flat_bar_stretches_as_its_solid_does():
    text = FLAT + MATERIAL.format(name="aluminium", young=68900, poisson=0.33)
    by_solid, by_beam = (displacement(checked(text, fidelity)) for fidelity in ("solid", "beam"))
    assert by_solid.value.value == pytest.approx(0.01912, rel=0.01)
    assert by_beam.value.value == pytest.approx(850.0 * 70.0 / (68900.0 * 13.99 * 4.0), rel=1e-6)
    for found in (by_solid, by_beam):
        assert found.value.low < 0.01912 < found.value.high
    assert by_solid.value.low > 0.9 * 0.01912
    assert by_solid.value.high < 1.15 * 0.01912
    assert in_words(by_solid.reason).startswith("by the solid model of bar, by linear theory: ")
    assert in_words(by_beam.reason).startswith("by the frame of the linkage, by linear theory: ")
    kinds = [{source.kind for source in found.value.sources} for found in (by_solid, by_beam)]
    assert SourceKind.EYES in kinds[1] - kinds[0]
    assert {SourceKind.DISCRETISATION, SourceKind.PIN_PRESSURE} <= kinds[0] - kinds[1]


def flat_bar(limit: str, fidelity: str) -> tuple[CheckOutcome, int]:
    """The outcome of a limit on the flat bar, and the number of meshes."""
    text = FLAT.replace('"1 mm" }', f'"{limit}" }}') + MATERIAL.format(name="aluminium", young=68900, poisson=0.33)
    result = checked(text, fidelity)
    meshes = getattr(result.load_cases["pull"].links["bar"], "discretisation", None)
    return displacement(result), 0 if meshes is None else len(meshes.meshes)


def test_a_limit_inside_the_band_of_meshes_is_decided_by_finer_ones():
    (found, meshes), (clear, one) = flat_bar("0.021 mm", "solid"), flat_bar("1 mm", "solid")
    assert clear.value.low < 0.021 < clear.value.high
    assert (found.verdict, one) == ("pass", 1)
    assert meshes > 1
    assert found.value.low < 0.01912 < found.value.high < 0.021
    assert found.value.value == pytest.approx(0.01912, rel=2e-3)


def test_no_mesh_is_made_for_a_limit_between_the_pressures_of_the_pin():
    found, meshes = flat_bar("0.0195 mm", "solid")
    assert (found.verdict, meshes) == ("undecided", 1)
    assert in_words(found.reason).endswith("; finer meshes would not decide it")


def test_what_pins_sink_is_told_beside_the_band():
    """Twice the strain energy is the work of the pins' own pressures; F times what the bores' means part by is less."""
    text = FLAT.replace('"1 mm" }', '"0.025 mm" }') + MATERIAL.format(name="aluminium", young=68900, poisson=0.33)
    result = checked(text)
    found, solution = displacement(result), result.load_cases["pull"].links["bar"].solution
    narrow = next(case for case in solution.cases if case.span == 90)
    means = [
        mean_motion(surface_quadrature(solution.space, f"bore:{pin}"), np.array([x, 0.0, 0.0]), narrow.displacement)[0]
        for pin, x in (("A", 0.0), ("B", 70.0))
    ]
    assert found.verdict == "pass"
    told = re.search(r"could add up to (\S+) mm, .* and which would miss the limit", in_words(found.reason))
    assert float(told.group(1)) == pytest.approx(2.0 * narrow.strain_energy / 850.0 - (means[1] - means[0]), abs=5e-4)


def test_a_limit_inside_the_band_of_beams_is_left_to_solids():
    by_beam, _ = flat_bar("0.04 mm", "beam")
    assert (by_beam.verdict, flat_bar("0.04 mm", "auto")[0].verdict) == ("undecided", "pass")
    assert in_words(by_beam.reason).endswith("; solid models of all links (--fidelity solid) have a narrower band")


def bent_tube(force: str, fidelity: str) -> CheckOutcome:
    text = TUBE.replace("FORCE", force) + MATERIAL.format(name="plastic", young=2400, poisson=0.38)
    return displacement(checked(text, fidelity))


def test_a_tube_bends_as_its_solid_does():
    by_solid, by_beam = (bent_tube("1", fidelity) for fidelity in ("solid", "beam"))
    assert by_beam.value.value == pytest.approx(88.0**3 / (3.0 * 2400.0 * 26.7035), rel=5e-3)
    for found in (by_solid, by_beam):
        assert found.value.low < CLAMPED < found.value.high
    assert abs(by_solid.value.value - CLAMPED) < 0.2 * abs(by_beam.value.value - CLAMPED)


def test_a_plate_gives_as_its_solid_does():
    text = PLATE + MATERIAL.format(name="plastic", young=2900, poisson=0.38)
    result = checked(text, "auto")
    forces = {pin: result.load_cases["pull"].reactions.joints[pin].wrench[:2] for pin in "AB"}
    assert forces["A"] == pytest.approx([-97.0588, -45.0], abs=1e-3)
    assert forces["B"] == pytest.approx([0.0, 25.0], abs=1e-3)
    found = displacement(result)
    assert found.value.value == pytest.approx(0.03725, rel=0.01)
    assert found.value.low < 0.03725 < found.value.high
    by_hand = displacement(checked(text, "beam"))
    assert by_hand.value.unknowable
    assert in_words(by_hand.reason).endswith("its solid model does: run --fidelity solid")


def test_on_the_deformed_shape_the_frame_is_as_soft_as_the_solids():
    """Twice the load moves the tube by 7 % of its span; frame and solids go there in the same proportion."""
    (solid, beam), (far_solid, far_beam) = (
        [bent_tube(force, fidelity) for fidelity in ("solid", "beam")] for force in ("1", "2")
    )
    assert in_words(far_solid.reason).startswith("by the solid model of tube, on its deformed shape: ")
    assert far_beam.value.value < 1.999 * beam.value.value
    ratios = [one.value.value / other.value.value for one, other in ((solid, beam), (far_solid, far_beam))]
    assert ratios[1] == pytest.approx(ratios[0], rel=3e-3)
    assert far_solid.value.low < far_solid.value.value < far_solid.value.high
    assert far_solid.value.high - far_solid.value.low < far_beam.value.high - far_beam.value.low


def test_virtual_work_is_how_the_links_fit_together_at_their_bores():
    """Rigid motions of the links are solved so that mean motions of bores agree, and the crank's faces do not turn."""
    result = checked(ROCKER)
    (load_case,) = result.load_cases.values()
    case, pose = result.case, result.pose
    links, moved = ("crank", "coupler", "rocker"), {}
    for link in links:
        solution = load_case.links[link].solution
        found = next(c for c in solution.cases if c.span == 180 and c.transfer in (None, "eye-faces"))
        for name, surface in ((s.partition(":")[2], s) for s in solution.space.surfaces if s[:4] in ("bore", "end:")):
            place = np.array([*case.linkage.links[link].points[name], 0.0])
            at = surface_quadrature(solution.space, surface)
            moved[link, name] = mean_motion(at, place, found.displacement)[:2]
        if link == "crank":
            faces = surface_quadrature(solution.space, *solution.space.flat_faces("O2"))
            field = np.einsum("qb,kbi->kqi", faces.phi, found.displacement[faces.nodes])
            arm = faces.x - faces.centroid
            turned = float(
                (faces.w * np.cross(arm, field)[..., 2]).sum() / (faces.w * (arm[..., :2] ** 2).sum(-1)).sum()
            )

    def rows(link: str, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of a point in global axes: linear in the links' rigid motions, and what the solid adds."""
        turn, (x, y) = pose.rotation(link), case.linkage.links[link].points[name]
        matrix = np.zeros((2, 9))
        matrix[:, 3 * links.index(link) :][:, :3] = turn @ np.array([[1.0, 0.0, -y], [0.0, 1.0, x]])
        return matrix, turn @ moved[link, name]

    equations, right = [np.eye(9)[2:3]], [np.array([-turned])]
    for name, joint in case.linkage.joints.items():
        ends = [rows(link, name) for link in joint.links if link in links]
        first, second = (*ends, (np.zeros((2, 9)), np.zeros(2)))[:2]
        equations.append(first[0] - second[0])
        right.append(second[1] - first[1])
    rigid = np.linalg.solve(np.vstack(equations), np.concatenate(right))
    matrix, own = rows("rocker", "P")
    by_bores = float(np.linalg.norm(matrix @ rigid + own))
    assert displacement(result).value.value == pytest.approx(by_bores, rel=1e-4)


def test_links_decided_by_hand_add_what_their_beams_do():
    mixed, solids = displacement(checked(ROCKER, "auto")), displacement(checked(ROCKER))
    assert "by the solid models of crank, rocker and of the frame's beams of coupler" in in_words(mixed.reason)
    assert in_words(solids.reason).startswith("by the solid models of crank, coupler, rocker, by linear theory")
    assert mixed.value.value == pytest.approx(solids.value.value, rel=0.02)
    assert mixed.value.low < solids.value.value < mixed.value.high
    eyes = [any(s.kind is SourceKind.EYES for s in found.value.sources) for found in (mixed, solids)]
    assert eyes == [True, False]
    limit = (solids.value.high + mixed.value.high) / 2.0
    closer = displacement(checked(ROCKER.replace('"1 mm" }', f'"{limit} mm" }}'), "auto"))
    assert closer.verdict == "pass"
    assert "by the solid models of crank, coupler, rocker, by linear theory" in in_words(closer.reason)
