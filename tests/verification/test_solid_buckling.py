"""Buckling of solids against closed forms: columns, a strip bent in its plane, plates on pins."""

import math
import tomllib
from types import SimpleNamespace

import numpy as np
import pytest
import solid_meshes
from euler_column import euler_load

from alula.fea.check.run import check_case
from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.fea.common.verdict import LINKAGE, Quantity, Subject
from alula.fea.refine.link_buckling import link_buckling
from alula.fea.solid.buckling_factor import BucklingProblem
from alula.fea.solid.solution import solve_solid
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.geometry.parts.part import Body, Pin, Plate, Ring
from alula.loads.case.case_file import validate
from alula.loads.records.bearing import WIDE
from alula.reports.sentences import told

E = 2000.0
X, Y, Z, TURN_X, TURN_Y, TURN_Z = range(6)


def conditions(*held):
    """One row for every (place, motion) that is held."""
    return np.array([np.eye(12)[6 * place + motion] for place, motion in held])


BUILT_IN = conditions(*((0, motion) for motion in range(6)))
ON_PINS = conditions((0, X), (0, Y), (0, Z), (0, TURN_X), (1, Y), (1, Z))


def pushed_box(size, counts, wrench, nu=0.0):
    """A box under a wrench at its far end, balanced at the near one: its solution, its loads and the places of both."""
    mesh = solid_meshes.box((0.0, -size[1] / 2, -size[2] / 2), (size[0], size[1] / 2, size[2] / 2), counts)
    far = np.array([*wrench, 0.0, 0.0, 0.0])[:6]
    near = -far - np.array([0.0, 0.0, 0.0, *np.cross([size[0], 0.0, 0.0], far[:3])])
    ends = {"end:0": (np.zeros(3), near), "end:1": (np.array([size[0], 0.0, 0.0]), far)}
    loads = LinkLoads(
        name="push",
        ends=tuple(EndLoad(name=name[-1], point=point, wrench=own) for name, (point, own) in ends.items()),
    )
    material = {"E": E, "nu": nu}
    solved = solve_solid(mesh, **material, density=1e-9, loads=[loads], line=("end:0", "end:1"), laws=[WIDE])
    return solved, loads, {name: point for name, (point, _) in ends.items()}


def box_factor(size, counts, wrench, held):
    """Factor of a box on a wrench at its far end."""
    solved, loads, places = pushed_box(size, counts, wrench)
    problem = BucklingProblem(solved.space, places, E=solved.E, nu=solved.nu, halved=False)
    return problem.least(problem.prestress(solved.cases[0].displacement, loads), held).factor


@pytest.mark.parametrize(("wide", "tall"), [(6.0, 3.0), (3.0, 6.0)])
@pytest.mark.parametrize(("held", "effective"), [(ON_PINS, 1.0), (BUILT_IN, 2.0)])
def test_a_column_buckles_about_its_weaker_axis_at_eulers_load(wide, tall, held, effective):
    """Shear takes π² E I/(L² G A/1.2) of it, 0.6 % on pins."""
    found = box_factor((60.0, wide, tall), (12, 2, 2), (-1.0, 0.0, 0.0), held)
    inertia = wide * tall * min(wide, tall) ** 2 / 12.0
    assert found == pytest.approx(euler_load(E, inertia, 60.0, effective), rel=0.01)


FIXED_AND_PINNED = np.vstack([BUILT_IN, conditions((1, Y), (1, Z))])
FIXED = np.vstack([FIXED_AND_PINNED, conditions((1, TURN_Y), (1, TURN_Z))])


@pytest.mark.parametrize("alone", [(FIXED_AND_PINNED, BUILT_IN), (BUILT_IN, FIXED_AND_PINNED)])
def test_a_column_has_the_least_factor_of_all_ways_in_which_its_joints_may_move(alone):
    """At 40 N: on pins 1.85, fixed at one end 3.8, free at the other 0.46, and fixed at both 7.4 at its best."""
    solved, loads, places = pushed_box((60.0, 6.0, 3.0), (12, 2, 2), (-40.0, 0.0, 0.0))
    holding = SimpleNamespace(places=places, value=ON_PINS, alone=alone, most=FIXED, how="on pins")
    task = SimpleNamespace(holding=holding, loads=(loads,))
    found = link_buckling(solved, task, chord=0.0)["push"]
    expected = [euler_load(E, 6.0 * 27.0 / 12.0, 60.0, k) / 40.0 for k in (1.0, 2.0, 0.5)]
    assert (found.value, found.least, found.most) == pytest.approx(tuple(expected), rel=0.03)
    assert found.error < 0.5
    free = SimpleNamespace(holding=SimpleNamespace(**{**vars(holding), "alone": ()}), loads=(loads,))
    assert link_buckling(solved, free, chord=0.0)["push"].least == found.value


FORKED = np.vstack([ON_PINS, conditions((1, TURN_X))])
KEPT = np.vstack([FORKED, conditions((0, TURN_Y), (1, TURN_Y))])


@pytest.mark.parametrize(
    ("wrench", "held", "closed"),
    [
        ((0.0, -1.0, 0.0), BUILT_IN, 4.013 / 100.0**2),
        ((0.0, 0.0, 0.0, 0.0, 0.0, 10.0), FORKED, math.pi / 1000.0),
        ((0.0, 0.0, 0.0, 0.0, 0.0, 10.0), KEPT, 2.0 * math.pi / 1000.0),
    ],
)
def test_a_strip_bent_in_its_plane_buckles_sideways(wrench, held, closed):
    """Prandtl's cantilever under a force at its end, and an even moment (Timoshenko & Gere, sections 6.1 and 6.3)."""
    length, deep, thick = 100.0, 10.0, 1.0
    inertia, torsion = deep * thick**3 / 12.0, deep * thick**3 / 3.0 * (1.0 - 0.63 * thick / deep)
    found = box_factor((length, deep, thick), (24, 3, 1), wrench, held)
    assert found == pytest.approx(closed * math.sqrt(E * inertia * E / 2.0 * torsion), rel=0.04)


def test_tension_buckles_nothing():
    assert box_factor((60.0, 6.0, 3.0), (8, 2, 1), (1.0, 0.0, 0.0), ON_PINS) == math.inf


def strip(thickness, eye, hole, length):
    """A plate on two pins, pressed together."""
    sizes = {"shape": "plate", "material": "resin", "thickness": f"{thickness} mm", "eye_diameter": f"{eye} mm"}
    ring = Ring(diameter=eye, low=-thickness / 2.0, high=thickness / 2.0)
    pins = [Pin(name=name, x=x, y=0.0, diameter=hole, ring=ring) for name, x in (("A", 0.0), ("B", length))]
    body = Body(part=Plate.model_validate(sizes), pins=tuple(pins), ends=(), holes=())
    acting = [
        PinLoad(name=pin.name, centre=np.array([pin.x, 0.0, 0.0]), diameter=hole,
                wrench=np.array([sign, 0.0, 0.0, 0.0, 0.0, 0.0]))
        for pin, sign in zip(pins, (1.0, -1.0), strict=True)
    ]  # fmt: skip
    return body, LinkLoads(name="push", pins=tuple(acting))


def plate_factors(thickness, eye, hole, length, settings):
    """Factor of such a plate by half of its body, and by the whole."""
    body, loads = strip(thickness, eye, hole, length)
    material = {"E": E, "nu": 0.3}
    solved = solve_solid(
        mesh_body(body, settings), **material, density=1e-9, loads=[loads], line=("bore:A", "bore:B"), laws=[WIDE]
    )
    places = {f"bore:{pin.name}": np.array([pin.x, 0.0, 0.0]) for pin in body.pins}
    found = []
    for halved in (True, False):
        problem = BucklingProblem(solved.space, places, **material, halved=halved)
        found.append(problem.least(problem.prestress(solved.cases[0].displacement, loads), ON_PINS).factor)
    return found


@pytest.mark.parametrize(("thickness", "eye", "hole"), [(1.5, 8.0, 3.0), (5.0, 3.0, 1.5)])
def test_a_strut_on_pins_buckles_at_eulers_load_out_of_the_plane_and_in_it(thickness, eye, hole):
    """Bores soften it near its ends alone, where it does not bend; the force goes through the axes of the pins.

    If the pressure stayed on the same points of the walls, the factors would be 9 % and 6 % above Euler's.
    """
    half, whole = plate_factors(thickness, eye, hole, 60.0, MeshSettings(size=0.5, bore_elements=8))
    assert half == pytest.approx(whole, rel=1e-4)
    inertia = eye * thickness * min(eye, thickness) ** 2 / 12.0
    assert half == pytest.approx(euler_load(E, inertia, 60.0), rel=0.03)


CONVERGED = 0.4087
"""Factor of the plate below with E = 2900 MPa, by meshes of 10,412, 27,228 and 57,526 elements: 0.4101, 0.4090, 0.4087.
The weakest pinned strut along that side, as wide as an eye, has 0.205."""
KNEE = """
schema_version = 1
title = "A triangular plate, pressed along one side"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], Q = ["-60 mm", "0 mm"], R = ["100 mm", "0 mm"] } }
links.crank = { points = { Q = ["0 mm", "0 mm"], D = ["40 mm", "0 mm"] } }
links.coupler = { points = { D = ["0 mm", "0 mm"], C = ["65 mm", "0 mm"] } }
links.knee = { part = "knee", points = { O = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"], C = ["5 mm", "40 mm"] } }
links.one = { points = { B = ["0 mm", "0 mm"], F = ["36.0555 mm", "0 mm"] } }
links.other = { points = { R = ["0 mm", "0 mm"], F = ["36.0555 mm", "0 mm"] } }
joints.O = { links = ["base", "knee"], pin_diameter = "4 mm" }
joints.Q = { links = ["base", "crank"], pin_diameter = "4 mm" }
joints.R = { links = ["base", "other"], pin_diameter = "4 mm" }
joints.B = { links = ["knee", "one"], pin_diameter = "4 mm" }
joints.C = { links = ["coupler", "knee"], pin_diameter = "4 mm" }
joints.D = { links = ["crank", "coupler"], pin_diameter = "4 mm" }
joints.F = { links = ["one", "other"], pin_diameter = "4 mm" }
drive = { link = "crank", joint = "Q" }
checks.strength = { type = "safety-factor", minimum = 0.1 }
[pose]
coordinate = "crank"
angle = "90 deg"
near = { coupler = "0 deg", knee = "0 deg", one = "56 deg", other = "124 deg" }
[motion]
range = ["88 deg", "92 deg"]
poses = 3
[load_cases]
press = { forces = [{ link = "knee", at = "C", force = ["-12.40347 N", "-99.22779 N"] }] }
lift = { forces = [{ link = "knee", at = "C", force = ["0.1240347 N", "0.9922779 N"] }] }
[parts.knee]
shape = "plate"
material = "pvc-paredes-2018"
thickness = "1 mm"
eye_diameter = "14 mm"
"""


def buckling_of(case, fidelity):
    result = check_case(case, fidelity=fidelity, threads=1)
    return {
        (load_case, check.subject): check
        for load_case, found in result.load_cases.items()
        for check in found.checks
        if check.quantity is Quantity.BUCKLING_FACTOR
    }


def test_a_plate_pressed_along_one_side_buckles_by_its_solid():
    """A strip along x, as wide as an eye, has 12 times the factor of the plate, whose third pin bears nothing."""
    case = validate(tomllib.loads(KNEE))
    found = buckling_of(case, "auto")
    plate = found["press", Subject.link("knee")].value
    young = case.material_of("knee").youngs_modulus
    strut = euler_load(young, 14.0 / 12.0, math.hypot(5.0, 40.0)) / 100.0
    assert plate.low < strut < plate.value < 3.0 * strut
    finest = CONVERGED * young / 2900.0
    assert 0.9 * finest < 3.0 * plate.low <= finest <= plate.value
    linkage = found["press", LINKAGE].value
    assert linkage.value <= plate.value
    assert ("lift", Subject.link("knee")) not in found
    by_hand = buckling_of(case, "beam")["press", Subject.link("knee")]
    assert by_hand.value.unknowable
    assert "run the solid model" in told(by_hand.reason)
