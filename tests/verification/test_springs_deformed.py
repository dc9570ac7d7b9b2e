"""Springs and tendons of a frame in large displacement: tangent, buckling, and what acts on the deformed shape."""

import math
import tomllib

import numpy as np
import pytest
from scipy.optimize import brentq

from alula.fea.frame.build import build_frame
from alula.fea.judging.linkage_numbers import left_stops
from alula.fea.nonlinear.corotational import subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath, State
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.nonlinear.stability import linkage_factor
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

ARM = """
schema_version = 1
title = "An arm that its drive holds, with a spring at its tip"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], S = ["200 mm", "300 mm"], E = ["120 mm", "-60 mm"] } }
links.arm = { part = "bar", points = { O = ["0 mm", "0 mm"], M = ["100 mm", "0 mm"], P = ["200 mm", "0 mm"] } }
joints.O = { links = ["base", "arm"], pin_diameter = "3 mm" }
pose = { coordinate = "arm", angle = "0 deg" }
drive = { link = "arm", joint = "O" }
[parts.bar]
shape = "bar"
material = "pvc-u"
width = "8 mm"
thickness = "30 mm"
fillet_radius = "1 mm"
ends = "square"
overhang = "8 mm"
"""
ELBOW = """
schema_version = 1
title = "A four-bar with springs of all kinds"
links.base.ground = true
links.base.points = { A = ["0 mm", "0 mm"], D = ["90 mm", "0 mm"], S = ["30 mm", "80 mm"], E = ["60 mm", "-20 mm"] }
links.crank = { part = "bar", points = { A = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] } }
links.coupler = { part = "bar", points = { B = ["0 mm", "0 mm"], P = ["40 mm", "0 mm"], C = ["80 mm", "0 mm"] } }
links.rocker = { part = "bar", points = { D = ["0 mm", "0 mm"], Q = ["40 mm", "0 mm"], C = ["60 mm", "0 mm"] } }
joints.A = { links = ["base", "crank"], pin_diameter = "3 mm" }
joints.B = { links = ["crank", "coupler"], pin_diameter = "3 mm" }
joints.C = { links = ["coupler", "rocker"], pin_diameter = "3 mm" }
joints.D = { links = ["base", "rocker"], pin_diameter = "3 mm" }
pose = { coordinate = "crank", angle = "60 deg", near = { coupler = "20 deg", rocker = "90 deg" } }
drive = { link = "crank", joint = "A" }
load_cases.tip = { forces = [{ link = "rocker", at = "Q", force = ["3 N", "1 N"] }] }
springs.hinge = { joint = "C", stiffness = "1500 N*mm/rad", preload = "-40 N*mm" }
springs.foot = { joint = "D", stiffness = "90 N*mm/rad", preload = "70 N*mm" }
tendons.pull = { through = [{ link = "base", at = "S" }, { link = "rocker", at = "C" }], tension = "2.5 N" }
[springs.line]
between = [{ link = "coupler", at = "P" }, { link = "base", at = "S" }]
stiffness = "0.3 N/mm"
free_length = "25 mm"
[tendons.cord]
through = [{ link = "base", at = "E" }, { link = "rocker", at = "Q" }, { link = "coupler", at = "P" }]
stiffness = "0.4 N/mm"
free_length = "60 mm"
[parts.bar]
shape = "bar"
material = "pvc-u"
width = "6 mm"
thickness = "3 mm"
fillet_radius = "1 mm"
"""
TIP, GROUND = {"link": "arm", "at": "P"}, {"link": "base", "at": "S"}
YOUNG, INERTIA, LENGTH = 2800.0, 30.0 * 8.0**3 / 12.0, 200.0


def arm(force, **tables):
    load = {"tip": {"forces": [{"link": "arm", "at": "P", "force": [f"{x} N" for x in force]}]}}
    return validate({**tomllib.loads(ARM), "load_cases": load, **tables})


def frame_of(case):
    statics = solve_case_statics(case)
    return build_frame(case, statics.pose, statics.loads["tip"], held=case.pinned_drive)


ALL = {
    "springs": {
        "line": {"between": [GROUND, TIP], "stiffness": "0.05 N/mm", "preload": "1.5 N"},
        "turn": {"joint": "O", "stiffness": "900 N*mm/rad", "preload": "300 N*mm"},
    },
    "tendons": {
        "cord": {"through": [{"link": "base", "at": "E"}, {"link": "arm", "at": "M"}, GROUND], "stiffness": "0.08 N/mm",
                 "free_length": "350 mm"},
        "pull": {"through": [{"link": "base", "at": "E"}, TIP], "tension": "2 N"},
        "slack": {"through": [GROUND, TIP], "stiffness": "5 N/mm", "free_length": "400 mm"},
    },
}  # fmt: skip


def test_a_redundant_linkage_balances_by_virtual_work():
    """Three parallel links of 50 mm carry one bar: k (90 deg - t) + 50 (-1 sin t - 10 cos t) = 0."""
    links = {
        "base": {"ground": True, "points": {p: [f"{x} mm", "0 mm"] for p, x in (("A", 0), ("B", 40), ("C", 80))}},
        "top": {"part": "bar", "points": {p: [f"{x} mm", "0 mm"] for p, x in (("D", 0), ("E", 40), ("F", 80))}},
    }
    joints = {}
    for one, foot, head in (("l1", "A", "D"), ("l2", "B", "E"), ("l3", "C", "F")):
        links[one] = {"part": "bar", "points": {foot: ["0 mm", "0 mm"], head: ["50 mm", "0 mm"]}}
        joints[foot] = {"links": ["base", one], "pin_diameter": "3 mm"}
        joints[head] = {"links": [one, "top"], "pin_diameter": "3 mm"}
    near = {"l2": "80 deg", "l3": "80 deg", "top": "0 deg"}
    tables = {
        "links": links,
        "joints": joints,
        "pose": {"coordinate": "l1", "angle": "80 deg", "near": near, "equilibrium": True},
        "springs": {"s": {"joint": "A", "stiffness": "4000 N*mm/rad", "free_angle": "90 deg"}},
        "load_cases": {"w": {"forces": [{"link": "top", "at": "E", "force": ["1 N", "-10 N"]}]}},
    }
    statics = solve_case_statics(validate({**{k: v for k, v in tomllib.loads(ARM).items() if k != "drive"}, **tables}))
    angle = brentq(
        lambda t: 4000.0 * (math.pi / 2.0 - t) - 50.0 * (math.sin(t) + 10.0 * math.cos(t)), 0.5, 2.0, xtol=1e-15
    )
    assert statics.pose.angles["l2"] == pytest.approx(angle, abs=1e-10)
    assert statics.reactions["w"].drive_torque == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("factor", [0.0, 0.6])
def test_the_tangent_is_the_derivative(factor):
    """Central differences of the out-of-balance forces in a bent state of a four-bar, whose hinge turns."""
    model = subdivide(frame_of(validate(tomllib.loads(ELBOW))).model, 2)
    assert len(model.springs) == 5
    path = EquilibriumPath(model)
    rng = np.random.default_rng(5)
    count = path.chain.count

    def state(change):
        return State(
            displacements=path._displacements(change),
            rotations=path.chain.turned(np.tile(np.eye(3), (len(model.nodes), 1, 1)), change[:count]),
            guide_forces=change[count:],
        )

    planar = np.abs(path.chain.axes(path.state.rotations)[:, 2]) > 0.5
    start = rng.standard_normal(path.size) * path.unit * 0.02 * model.size
    start[:count][path.chain.is_turn & ~planar] = 0.0  # in the linkage's plane, where these springs act
    heights = {int(n) for n in path.chain.translations[:, 2] if n >= 0}
    start[list(heights)] = 0.0
    here = state(start)
    tangent = path.balance(here, factor)[1]
    for k in range(count):
        if k in heights or (path.chain.is_turn[k] and not planar[k]):
            continue
        step = np.zeros(path.size)
        step[k] = 1e-5 * path.unit[k]
        ahead, behind = (
            State(
                displacements=here.displacements + path._displacements(sign * step),
                rotations=path.chain.turned(here.rotations, sign * step[:count]),
                guide_forces=here.guide_forces,
            )
            for sign in (1.0, -1.0)
        )
        slope = (path.balance(ahead, factor)[0] - path.balance(behind, factor)[0]) / (2.0 * step[k])
        size = np.abs(tangent[:, k] * path.unit).max()
        assert np.abs((slope - tangent[:, k]) * path.unit).max() < 1e-7 * size


@pytest.mark.parametrize("stiffness", [0.1, 1.0])
def test_a_cantilever_on_a_spring_buckles_as_it_should(stiffness):
    """tan u = u - u³ E I/(k L³), u² = P L²/(E I): built in at one end, an elastic support across at the other."""
    spring = {"side": {"between": [GROUND, TIP], "stiffness": f"{stiffness} N/mm", "preload": "0 N"}}
    factor = linkage_factor(frame_of(arm([-1.0, 0.0], springs=spring)))
    share = YOUNG * INERTIA / (stiffness * LENGTH**3)

    def lacks(u: float) -> float:
        return math.sin(u) - math.cos(u) * (u - u**3 * share)

    root = brentq(lacks, 0.5 * math.pi + 1e-9, 1.5 * math.pi - 1e-3)
    assert factor == pytest.approx(root**2 * YOUNG * INERTIA / LENGTH**2, rel=0.01)
    alone = linkage_factor(frame_of(arm([-1.0, 0.0])))
    assert alone == pytest.approx(math.pi**2 * YOUNG * INERTIA / (4.0 * LENGTH**2), rel=0.01)


def test_tension_in_a_cord_to_the_foot_of_a_column_does_not_bend_it_as_a_dead_load_does():
    """A cord from the tip to the foot keeps its line there: it buckles at π² E I/L², four times the dead load's."""
    cord = {"stay": {"through": [{"link": "base", "at": "O"}, TIP], "tension": "1 N"}}
    factor = linkage_factor(frame_of(arm([0.0, 0.0], tendons=cord)))
    assert factor == pytest.approx(math.pi**2 * YOUNG * INERTIA / LENGTH**2, rel=0.01)


def test_forces_on_the_deformed_shape_are_those_of_the_springs_there():
    """The same shape under dead forces that equal the springs' on it, at the points where they act."""
    case = arm([0.0, -60.0], **ALL)
    statics = solve_case_statics(case)
    moved = examine(case, "tip", statics.forces["tip"], statics.loads["tip"])
    assert moved.state == "deformed"
    place = {p: np.array([x, 0.0]) + moved.points["arm", p][:2] for p, x in (("M", 100.0), ("P", 200.0))}
    fixed = {"S": np.array([200.0, 300.0]), "E": np.array([120.0, -60.0])}
    force = {"M": np.zeros(2), "P": np.array([0.0, -60.0])}

    def pull(size: float, on: str, to: np.ndarray) -> None:
        force[on] = force[on] + size * (to - place[on]) / np.linalg.norm(to - place[on])

    apart = {key: float(np.linalg.norm(place[key[0]] - fixed[key[1]])) for key in (("P", "S"), ("M", "E"), ("M", "S"))}
    pull(1.5 + 0.05 * (apart["P", "S"] - 300.0), "P", fixed["S"])
    for end in ("E", "S"):
        pull(max(0.08 * (apart["M", "E"] + apart["M", "S"] - 350.0), 0.0), "M", fixed[end])
    pull(2.0, "P", fixed["E"])
    assert apart["P", "S"] < 400.0  # the slack one stays so
    dead = {"tip": {"forces": [{"link": "arm", "at": p, "force": [f"{x!r} N" for x in map(float, f)]}
                               for p, f in force.items()]}}  # fmt: skip
    held = validate({**tomllib.loads(ARM), "load_cases": dead})
    same = solve_case_statics(held)
    other = examine(held, "tip", same.forces["tip"], same.loads["tip"])
    assert other.state == "deformed"
    for point in ("M", "P"):
        assert other.points["arm", point] == pytest.approx(moved.points["arm", point], abs=1e-6)
    assert float(np.linalg.norm(moved.points["arm", "P"])) > 10.0
    for found in (moved, other):
        assert found.reactions is not None
    one, two = moved.reactions, other.reactions
    assert one.joints["O"].force == pytest.approx(two.joints["O"].force, abs=1e-6)
    for end, twin in zip(moved.links["arm"].ends, other.links["arm"].ends, strict=True):
        assert end.wrench == pytest.approx(twin.wrench, abs=1e-5)


def test_a_link_balances_on_the_deformed_shape():
    """Joint forces, load, cord and pull on the rocker, taken where its points have moved to."""
    soft = tomllib.loads(ELBOW.replace('width = "6 mm"', 'width = "2 mm"').replace('"3 N", "1 N"', '"0.6 N", "0.2 N"'))
    case = validate(soft)
    statics = solve_case_statics(case)
    moved = examine(case, "tip", statics.forces["tip"], statics.loads["tip"])
    assert moved.state == "deformed", moved.reason
    assert moved.reactions is not None
    at = {(link, p): statics.pose.position(link, p) + moved.points.get((link, p), np.zeros(3))[:2]
          for link, points in case.link_points.items() for p in points}  # fmt: skip
    Q, C, P = at["rocker", "Q"], at["rocker", "C"], at["coupler", "P"]
    eye, top = at["base", "E"], at["base", "S"]
    assert np.linalg.norm(moved.points["coupler", "P"]) > 2.0

    def unit(way: np.ndarray) -> np.ndarray:
        return way / np.linalg.norm(way)

    cord = max(0.4 * (np.linalg.norm(Q - eye) + np.linalg.norm(P - Q) - 60.0), 0.0)
    total = np.array([0.6, 0.2]) + cord * (unit(eye - Q) + unit(P - Q)) + 2.5 * unit(top - C)
    total = total + moved.reactions.joints["C"].force[:2] + moved.reactions.joints["D"].force[:2]
    assert total == pytest.approx(np.zeros(2), abs=1e-6)
    assert moved.reactions.joints["C"].wrench[5] == pytest.approx(
        0.0, abs=1e-6
    )  # the hinge's spring is no pin's moment


@pytest.mark.parametrize(("preload", "leaves"), [("5000 N*mm", False), ("11900 N*mm", True)])
def test_a_stop_that_would_have_to_pull_is_told(preload, leaves):
    """60 N 200 mm are 12,000 N mm; the bent arm has less of a lever, so that 11,900 N mm lift it off its stop."""
    spring = {"up": {"joint": "O", "stiffness": "1 N*mm/rad", "preload": preload}}
    case = arm([0.0, -60.0], springs=spring, stops={"rest": {"joint": "O", "at_least": "0 deg"}})
    statics = solve_case_statics(case)
    assert statics.standing["tip"].stop == "rest"
    moved = {"tip": examine(statics.standing["tip"].case, "tip", statics.forces["tip"], statics.loads["tip"])}
    assert moved["tip"].state == "deformed"
    said = list(left_stops(statics, moved))
    assert bool(said) == leaves
    if leaves:
        lever = 200.0 + moved["tip"].points["arm", "P"][0]
        assert f"pull there with {11900.0 - 60.0 * lever:.3g} N·mm" in told(said[0])
