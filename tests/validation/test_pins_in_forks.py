"""Pins of joints in one layer, forks among them, stand at the rims of their holes: against another way to solve it."""

import itertools

import numpy as np
import pytest
from rims_by_penalty import InHoles
from tilting_pins import ALUMINIUM, PLA, checked, in_one_layer

from alula.fea.beam.cut_free import beam_loads, link_loads
from alula.fea.beam.theory import internal_forces
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity
from alula.fea.frame import build
from alula.fea.nonlinear.on_rims import divided
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.forks import eye_of

WIDE = dict.fromkeys(("base", "crank", "coupler", "rocker"), "0.1 mm")
HOLES = [
    dict.fromkeys(("O2", "A", "B", "O4"), WIDE),
    {
        "O2": {"base": "0 mm", "crank": "0.03 mm"},
        "A": {"crank": "0 mm", "coupler": "0.05 mm"},
        "B": {"coupler": "0.02 mm", "rocker": "0.08 mm"},
        "O4": {"base": "0.1 mm", "rocker": "0 mm"},
    },
]


def with_clearances(clearances, force, *, material=ALUMINIUM, forks=True):
    checks = {
        "s": {"type": "safety-factor", "minimum": 2.0},
        "p": {"type": "pins", "minimum": 1.0},
        "d": {"type": "displacement", "at": "P", "maximum": "2 mm"},
    }
    data = in_one_layer(forks=forks, checks=checks)
    data["materials"]["m"] |= material
    data["load_cases"]["l"]["forces"][0]["force"] = list(force)
    for name, joint in data["joints"].items():
        joint["clearance"] = {link: clearances[name][link] for link in joint["links"]}
    return checked(data)


def holes_of(case):
    found = {}
    for name, joint in case.joints.items():
        for link in joint.links:
            rims = (-2.5, 2.5)
            if case.links[link].part is not None:
                ring = eye_of(case, name, link)
                rims = ring.low, ring.high
            found[name, link] = case.linkage.pin_holes(name)[link].high, rims
    return found


def stress(case, reactions, statics, link):
    """As the other way has it: by the forces at the ends of plain beams."""
    body, part = case.body(link), case.part_of(link).section
    acting = link_loads("l", link, body, reactions, statics.loads["l"])
    forces = internal_forces(beam_loads(acting, body, case.material_of(link).density))
    over = np.array([part.area, part.i_y / part.half_z, part.i_z / part.half_y])
    places = sorted(x for x, _ in case.links[link].points.values())
    ends = [x for a, b in itertools.pairwise(places) for x in (a + 1e-6, b - 1e-6)]
    return max(float((np.abs(forces.at(x)[[0, 4, 5]]) / over).sum()) for x in ends)


@pytest.mark.parametrize("force", [("0 N", "-10 N", "2 N"), ("3 N", "-20 N", "-0.2 N")])
@pytest.mark.parametrize("clearances", HOLES)
@pytest.mark.parametrize("forks", [True, False])
def test_links_bear_what_rigid_pins_between_springs_say(clearances, force, forks):
    case = with_clearances(clearances, force, forks=forks)
    statics, holes = solve_case_statics(case), holes_of(case)
    forces = statics.forces["l"]
    acting = {("rocker", "P"): np.array([float(one.split()[0]) for one in force])}
    other = InHoles(case, acting, holes)
    tight = InHoles(case, acting, {hole: (0.0, rims) for hole, (_, rims) in holes.items()})
    moved, plain = other.solved(), tight.solved()
    links = case.linkage.moving
    expected = other.stresses(case, moved)
    assert {link: stress(case, forces.reactions, statics, link) for link in links} == pytest.approx(expected, rel=2e-3)
    of_tight = tight.stresses(case, plain)
    found = {link: stress(case, forces.on_tight_pins, statics, link) for link in links}
    assert found == pytest.approx(of_tight, rel=1e-3)
    assert max(abs(expected[link] / of_tight[link] - 1.0) for link in links) > 0.02  # tight pins would not do
    assert forces.pins is not None
    assert forces.frame is not None
    at = forces.frame.points["rocker", "P"]
    place = forces.pins.answer(forces.pins.value).displacements[at, :3]
    assert place == pytest.approx(moved[other.nodes["rocker", "P"] :][:3], abs=0.02)  # springs at rims give


def test_bands_hold_all_that_clearances_may_be():
    """Of a fork whose holes are known by ranges: two checks of links, pins, and the point."""
    ranges = {name: {key: ["0.02 mm", "0.1 mm"] for key in WIDE} for name in ("O2", "A", "B", "O4")}
    force = ("0 N", "-4 N", "0.8 N")
    case = with_clearances(ranges, force, material=PLA)
    bands = check_case(case, fidelity="beam").load_cases["l"]
    acting, holes = {("rocker", "P"): np.array([0.0, -4.0, 0.8])}, holes_of(case)
    draws, lengths, sizes = np.random.default_rng(3), list[float](), list[dict[str, float]]()
    for _ in range(12):
        drawn = {hole: (float(draws.uniform(0.02, 0.1)), rims) for hole, (_, rims) in holes.items()}
        one = InHoles(case, acting, drawn)
        u = one.solved()
        sizes.append(one.stresses(case, u))
        lengths.append(float(np.linalg.norm(u[one.nodes["rocker", "P"] :][:3])))
    statics = solve_case_statics(case)
    states = (statics.forces["l"].reactions, *statics.forces["l"].sharings)
    for link in case.linkage.moving:
        ends = [stress(case, one, statics, link) for one in states]
        left = 0.1 * (max(ends) - min(ends))
        assert max(size[link] for size in sizes) <= max(ends) + left + 1e-3 * max(ends)
        assert min(size[link] for size in sizes) >= min(ends) - left - 1e-3 * max(ends)
    [point] = [check.value for check in bands.checks if check.quantity is Quantity.DISPLACEMENT]
    assert point.low - 0.02 <= min(lengths)
    assert max(lengths) <= point.high + 0.02


def test_the_pin_of_a_fork_bears_the_couples_of_all_states():
    """The band reaches from the least to the largest of what each state makes of it."""
    ranges = {name: {key: ["0 mm", "0.1 mm"] for key in WIDE} for name in ("O2", "A", "B", "O4")}
    wide, known = (
        check_case(with_clearances(one, ("0 N", "-10 N", "2 N")), fidelity="beam").load_cases["l"].pins
        for one in (ranges, HOLES[0])
    )
    for name in ("A", "B"):
        assert wide[name].moment.low <= known[name].moment.low
        assert wide[name].moment.high >= known[name].moment.high
        assert wide[name].moment.high > 1.05 * wide[name].moment.value


def test_in_the_plane_a_fork_is_as_it_was():
    """No couple, no frame: equilibrium alone has the forces."""
    case = with_clearances(HOLES[0], ("0 N", "-10 N"))
    forces = solve_case_statics(case).forces["l"]
    assert forces.frame is None
    assert forces.sharings == ()


@pytest.mark.parametrize("times", [0.25, 4.0])
def test_how_long_the_element_of_a_pin_is_changes_no_stability(monkeypatch, times):
    """It stands for a pin of no length between its links: two forks, with rims that touch on one side and on both."""

    def factors():
        for force in (("0 N", "-10 N", "1 N"), ("0 N", "-20 N", "0.2 N")):
            pins = solve_case_statics(with_clearances(HOLES[0], force)).forces["l"].pins
            assert pins is not None
            path = divided(pins, 1)
            yield path.extended(pins.tangent(pins.radii.value, pins.value)).factor()

    plain = [*factors()]
    monkeypatch.setattr(build, "ALONG_PINS", times * build.ALONG_PINS)
    assert [*factors()] == pytest.approx(plain, rel=1e-4)


def test_how_rigid_the_element_of_a_pin_is_hides_no_couple(monkeypatch):
    """What counts as none by rounding goes with what bends: pins between layers, or links where no pin does."""
    force = ("0 N", "-10 N", "2 N")

    def noises():
        for forks in (True, False):
            pins = solve_case_statics(with_clearances(HOLES[0], force, forks=forks)).forces["l"].pins
            yield pins.rims.noise, pins.aims.count

    plain = [*noises()]
    assert all(count > 0 for _, count in plain)
    monkeypatch.setattr(build, "RIGID", 1e3 * build.RIGID)
    assert [*noises()] == plain


@pytest.mark.parametrize("first", [True, False])
def test_a_dyad_without_load_on_the_pin_of_a_fork_changes_no_force(first):
    """Crank, coupler and rod have one pin in one layer, whichever of its two joints comes first; one hole of three."""
    force = ("0 N", "-10 N", "2 N")
    data = in_one_layer()
    data["load_cases"]["l"]["forces"][0]["force"] = list(force)
    for joint in data["joints"].values():
        joint["clearance"] = dict.fromkeys(joint["links"], "0.1 mm")
    alone = solve_case_statics(checked(data)).forces["l"].reactions.joints
    data["links"]["base"]["points"]["D"] = ["20 mm", "-60 mm"]
    for link, points in {"rod": ("A", "C"), "arm": ("D", "C")}.items():
        data["links"][link] = {"part": "bar", "points": {points[0]: ["0 mm", "0 mm"], points[1]: ["55 mm", "0 mm"]}}
    data["pose"]["near"] |= {"rod": "-20 deg", "arm": "60 deg"}
    further = {"A2": ["crank", "rod"], "C": ["rod", "arm"], "D": ["base", "arm"]}
    dyad = {name: {"links": pair, "pin_diameter": "3 mm", "clearance": WIDE["base"]} for name, pair in further.items()}
    dyad["A2"] |= {"points": ["A", "A"], "clearance": dict.fromkeys(["crank", "rod"], "0.1 mm")}
    data["joints"] = dyad | data["joints"] if first else data["joints"] | dyad
    forces = solve_case_statics(checked(data)).forces["l"]
    for name, joint in forces.reactions.joints.items():
        assert joint.wrench == pytest.approx(alone[name].wrench if name in alone else 0.0, abs=1e-3)
    assert forces.pins is not None
    [shared] = [set(hole.joints) for hole in forces.pins.rims.holes if len(hole.joints) > 1]
    assert shared == {"A", "A2"}
