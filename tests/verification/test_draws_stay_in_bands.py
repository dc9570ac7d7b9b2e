"""Clearances drawn from what a case leaves open, on random linkages in layers: bands hold them.

The linkages are those of ``benchmarks/draws.py``, which tells the same of 10,000 draws on 20 linkages. The ends of
bands are sought, and no bounds: of so many draws some left a band there, of the hundreds here none does.
"""

from dataclasses import replace

import numpy as np
import pytest
from tilting_pins import checked, four_bar

from alula.fea.check.run import check_case
from alula.fea.pins import programme
from alula.fea.standing.joint_forces import joint_forces
from alula.geometry.base.errors import CannotRunError
from alula.geometry.joints.heads import Heads
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from benchmarks import draws

LIMIT = {"type": "displacement", "at": "P", "maximum": "2 mm"}


def headed(case: Case) -> Case:
    """The same with heads on every pin, whose gap is open."""
    heads = Heads(diameter="8 mm", gap=["0.02 mm", "0.3 mm"])
    joints = {name: joint.model_copy(update={"heads": heads}) for name, joint in case.joints.items()}
    return case.model_copy(update={"joints": joints})


@pytest.mark.parametrize(
    ("seed", "heads"), [(1, False), pytest.param(5, False, marks=pytest.mark.converged), (11, False), (11, True)]
)
def test_no_state_that_is_drawn_lies_outside_the_bands(seed, heads):
    case = draws.linkage(seed)
    assert draws.outside(headed(case) if heads else case, 200, seed) == []


def test_between_eyes_of_unlike_thickness_pins_bear_most_at_a_face():
    """Sought at the mid-planes alone, a pin's stress left its band by 9 % in 3 % of the draws."""
    tables = draws.tables(11)
    tables["parts"]["thick"] = tables["parts"]["bar"] | {"thickness": "12 mm"}
    tables["links"]["coupler"]["part"] = "thick"
    assert draws.outside(draws.validate(tables | {"layer_spacing": "14 mm"}), 2000, 11) == []


def test_a_hole_whose_rims_do_not_touch_is_tried_at_both_ends():
    """Its slope is nothing there. By slopes and four times as many starts the ends fell short by 21 %."""
    statics = draws.solve_case_statics(read_case("flapping-wing-reference"), "flapping-wing-reference")
    pins = statics.forces["held"].pins
    assert pins is not None
    drawn, found = (pins.aims.values(pins.solved(x).v) for x in (draws.shares(pins, 1000, 1), pins.extremes))
    between = np.ptp(np.vstack([drawn, found]), axis=0)
    assert (drawn.max(axis=0) - found.max(axis=0) <= 0.01 * between).all()


@pytest.mark.parametrize("seed", [5, 8, 10])
def test_no_state_that_is_drawn_moves_a_point_less_than_its_band_says(seed):
    """Of ranges of every hole; the states in which links bear most and least move it by 9 % more than some drawn."""
    draw, data = np.random.default_rng(seed), four_bar(tight={}, checks={"d": LIMIT})
    for joint in data["joints"].values():
        ends = np.sort(3.0 * 10.0 ** draw.uniform(-3.0, -1.0, (2, 2)), axis=1).round(4)
        joint["clearance"] = {
            link: [f"{x} mm" for x in own] for link, own in zip(joint["links"], ends.tolist(), strict=True)
        }
    case = checked(data)
    forces = draws.solve_case_statics(case).forces["l"]
    pins, frame = forces.pins, forces.frame
    assert pins is not None
    assert frame is not None
    node, v = frame.points["rocker", "P"], pins.solved(draws.shares(pins, 400, seed)).v
    tight = pins.answer(np.zeros(v.shape[1])).displacements[node, :3]
    moved = np.linalg.norm(tight + v @ pins.moves(node).T, axis=1)
    [found] = [one for one in check_case(case, fidelity="beam").load_cases["l"].checks if one.name == "d"]
    assert found.value.low <= moved.min()
    assert moved.max() <= found.value.high


@pytest.mark.parametrize("seed", [pytest.param(34, marks=pytest.mark.converged), 37])
def test_the_least_way_of_a_point_is_sought_from_every_end_of_the_other_searches(seed):
    """Which hole has a play that two share makes ends of its own: from the four least ones another was missed.

    By up to 4 % here, and by 29 % on a linkage with three links on one pin.
    """
    tables = draws.tables(seed)
    for joint in tables["joints"].values():
        for entry in ("fit", "tight_in"):
            joint.pop(entry, None)
        joint["clearance"] = "0.1 mm"
    forces = draws.solve_case_statics(draws.validate(tables)).forces["l"]
    pins, frame = forces.pins, forces.frame
    assert pins is not None
    assert frame is not None
    [check] = tables["checks"].values()
    node, v = frame.points[check["link"], check["at"]], pins.solved(draws.shares(pins, 4000, seed)).v
    tight = pins.answer(np.zeros(v.shape[1])).displacements[node, :3]
    drawn, found = (
        float(np.linalg.norm(tight + one @ pins.moves(node).T, axis=1).min())
        for one in (v, pins.nearest(node, tight[None]))
    )
    assert found <= 1.002 * drawn


def test_a_band_that_is_too_narrow_is_told(monkeypatch):
    """Where the search ends at once, draws leave the bands."""
    monkeypatch.setattr("alula.fea.pins.states.PinStates.extremes", property(lambda pins: pins.radii.value[None]))
    monkeypatch.setattr("alula.fea.pins.states.PinStates.nearest", lambda pins, node, tight: pins.value[None])
    found = draws.outside(draws.linkage(1), 100)
    assert max(one.excess for one in found) > 0.2
    assert {one.of.split()[0] for one in found} == {"thrust", "pin", "stress", "displacement"}


@pytest.mark.parametrize("seed", [11, 14])
def test_a_search_that_starts_where_one_of_a_like_pose_ended_finds_the_ends_without_draws(seed, monkeypatch):
    """As play shakes the linkage; ends differ by 1 % of what lies between them at most."""
    statics = draws.solve_case_statics(draws.linkage(seed))
    stated = statics.forces["l"]
    play, pins = stated.play, stated.pins
    assert play is not None
    assert pins is not None
    assert play.furthest is not None
    pose = play.pose(play.furthest, stated.reactions.pose)
    alone, like = (joint_forces(statics.case, pose, play.furthest.loads, known).pins for known in (None, pins))
    assert alone is not None
    assert like is not None
    full = alone.aims.values(alone.states)
    assert pins.extremes.shape[1] == alone.extremes.shape[1]
    monkeypatch.delattr("alula.fea.pins.states._drawn")
    found = alone.aims.values(like.states)
    assert ((full.max(axis=0) - found.max(axis=0)) / np.ptp(full, axis=0)).max() < 0.01
    other = replace(pins.radii, clearances=pins.radii.clearances[:-1])
    assert alone.beside(replace(pins, radii=other)) is alone  # of other holes nothing is known


def test_rounding_moves_no_end():
    """Processors differ by some 1e-16 at each step; here K, g and forces differ by 1e-12."""
    pins = draws.solve_case_statics(draws.linkage(14)).forces["l"].pins
    assert pins is not None
    draw = np.random.default_rng(14)

    def shaken(x):
        return x * (1.0 + 1e-12 * draw.uniform(-1.0, 1.0, x.shape))

    rims = pins.rims
    K = shaken(rims.K)
    rims = replace(rims, K=(K + K.T) / 2.0, g=shaken(rims.g), tight=shaken(rims.tight), by_rims=shaken(rims.by_rims))
    found, other = (one.aims.values(one.states).max(axis=0) for one in (pins, replace(pins, rims=rims)))
    assert other == pytest.approx(found, rel=1e-6, abs=1e-9 * np.abs(found).max())


def test_draws_lie_in_what_is_stated():
    pins = draws.solve_case_statics(draws.linkage(0)).forces["l"].pins
    assert pins is not None
    radii, _ = pins.radii.of(draws.shares(pins, 50, 0))
    for one, numbers in zip(pins.radii.clearances, pins.radii.numbers, strict=True):
        both = 2.0 * sum(radii[:, 2 * k] for k in numbers)
        assert np.all((one.low - 1e-12 <= both) & (both <= one.high + 1e-12))
        assert both.max() - both.min() == pytest.approx(one.high - one.low, rel=0.2)


def test_a_pair_that_comes_to_its_rim_too_soon_is_found(monkeypatch):
    """Of 10,000 draws of this linkage the first pace does not end one, since a pair could hardly go along its rim."""
    pins = draws.solve_case_statics(draws.linkage(105)).forces["l"].pins
    assert pins is not None
    shares = draws.shares(pins, 10_000, 105)[4616:4618]
    assert (pins.solved(shares).gap < 1e-9 * np.abs(pins.rims.g).max()).all()
    monkeypatch.setattr(programme, "PACES", programme.PACES[:1])
    with pytest.raises(CannotRunError, match="was not found"):
        pins.solved(shares)
