"""Growth with pins in their holes, against equilibrium on the deformed shape that is solved directly."""

from dataclasses import replace

import numpy as np
import pytest
from running_pins import RunningPins, in_small_motions

from alula.fea.check.load_case import LoadCaseByHand
from alula.fea.common.scatter import Scatter
from alula.fea.doubts.force_doubt import rim_doubt
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.nonlinear.on_rims import divided
from alula.fea.nonlinear.rim_growth import rim_growth
from alula.fea.nonlinear.stability import COARSE_SUBDIVISIONS
from alula.fea.outcomes.point_displacement import PointDisplacement
from alula.fea.outcomes.point_shares import LoadedLinkage
from alula.fea.pins.programme import least_in_discs
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import validate
from benchmarks import draws

MOST = 1.2
"""Largest load over what is stated."""


def in_layers(seed, times):
    """A drawn linkage with clearances of 0.1 mm at most, under a number of times its load."""
    data = draws.tables(seed)
    del data["large_displacement"], data["checks"]
    force = data["load_cases"]["l"]["forces"][0]
    force["force"] = [f"{times * float(part.split()[0])!r} N" for part in force["force"]]
    data["load_cases"]["l"]["scatter"] = ["0.8", str(MOST)]
    for joint in data["joints"].values():
        stated = joint.get("clearance", None if "fit" in joint else ["0.02 mm", "0.08 mm"])
        if isinstance(stated, dict):
            joint["clearance"] = {link: [least(x) for x in each] for link, each in stated.items()}
        elif stated is not None:
            joint["clearance"] = [least(x) for x in stated]
    return validate(data)


def least(size):
    return f"{min(float(size.split()[0]), 0.1)} mm"


@pytest.fixture(scope="module")
def leaning():
    """A linkage 14 times as far from buckling with tight pins, which pins in their holes bring within 3.8 times."""
    case = in_layers(413, 2.38447)
    statics = solve_case_statics(case)
    return case, statics, rim_growth(statics.forces["l"].pins, MOST)


def worst_places(case, pins, links):
    """Link -> radii, and where pins stand by them, where it bears most in small motions."""
    ends, (radii, stood) = pins.rims.beam_ends, pins.standing
    each = np.array([ends.stresses(ends.tight + ends.by_rims @ v) for v in stood])
    for link in links:
        own = [k for k, owner in enumerate(ends.owners) if owner == ("link", link)]
        k = int(each[:, own].max(axis=1).argmax())
        yield link, np.maximum(radii[k], 1e-7), stood[k]


@pytest.mark.converged
def test_bands_hold_what_links_bear_on_the_deformed_shape_with_pins_in_their_holes(leaning):
    """With tight growth alone the rocker bears 8 % more than its band."""
    case, statics, _ = leaning
    forces, loads = statics.forces["l"], statics.loads["l"]
    moved = examine(case, "l", forces, loads)
    hand, told = LoadCaseByHand.of(statics, "l", moved, []), rim_doubt(case, "l", moved, forces, loads)
    direct, beyond = RunningPins(case, "l", statics, MOST), []
    for link, radii, _ in worst_places(case, forces.pins, ("coupler", "rocker")):
        high = max(one.worst[1].equivalent for _, one in hand.plates[link])
        for share in (hand.uneven.stress.get(link, Scatter()), hand.shared.stress.get(link, Scatter())):
            high *= share.high
        found = direct.stresses(radii)[link]  # moduli are divided by what the load may be times as large
        assert found <= high
        beyond.append(found * told.stress.get(link, Scatter()).high / high)
    assert max(beyond) > 1.05


def alike(pins, size):
    """The same pins with one clearance in every hole that is not pressed, so that they have one state."""
    own = [replace(one, low=size, value=size, high=size) if one.high > 0.0 else one for one in pins.radii.clearances]
    return replace(pins, radii=replace(pins.radii, clearances=tuple(own)))


def test_growth_in_one_state_is_that_of_the_direct_solution(leaning):
    """Of all links, over the growth with tight pins: from 0.79 to 1.24, within 0.07.

    Points rest by up to 27 % farther from where tight pins leave them than in small motions, found within 3 %.
    """
    case, statics, _ = leaning
    forces, loads = statics.forces["l"], statics.loads["l"]
    pins = alike(forces.pins, 0.06)
    radii, stood = pins.standing
    assert np.ptp(stood, axis=0).max() < 1e-9
    direct, small = RunningPins(case, "l", statics, MOST), in_small_motions(case, "l", statics, stood[0])
    tight, small_tight = (
        direct.stresses(np.full_like(radii[0], 1e-7)),
        in_small_motions(case, "l", statics, 0 * stood[0]),
    )
    on_tight, found = direct.displacements, rim_growth(pins, MOST)
    running = direct.stresses(radii[0])
    rests, farther, linear = direct.displacements - on_tight, found.farther, pins.rims.solved.displacements
    loaded = LoadedLinkage(
        case=case, load_case="l", moved=examine(case, "l", forces, loads), links={}, free={}, forces=forces
    )
    displaced_there = direct.held_at(stood[0])  # where pins rest in small motions
    every = {(x, hole.link): 0.03 for hole in farther.holes for x in hole.joints}
    missed = beyond = 0.0
    for (link, point), node in forces.frame.points.items():
        own, size = farther.rests[farther.nodes[node]][0], float(np.linalg.norm(rests[node]))
        in_small = linear(pins.rims.opened)[node, :3] @ stood[0]
        assert own == pytest.approx(rests[node], abs=max(0.03 * size, 0.005))
        missed = max(missed, float(np.linalg.norm(in_small - rests[node])) / size)
        band = PointDisplacement.at(loaded, link, point).value
        assert 0.0 < band.low <= np.linalg.norm(on_tight[node] + rests[node]) <= band.high
        where = float(np.linalg.norm(displaced_there[node] - on_tight[node] - in_small))
        beyond = max(beyond, where)
        assert where <= farther.most(node, every) + 0.005
    assert missed > 0.2
    assert beyond > 0.1
    for link, one in found.links.items():
        grown = running[link] / small[link] / (tight[link] / small_tight[link])
        assert one.low * one.high == pytest.approx(grown, abs=0.07)
    assert max(one.high for one in found.links.values()) > 1.1


def test_pins_that_are_nearly_tight_grow_as_tight_ones(leaning):
    _, statics, _ = leaning
    found = rim_growth(alike(statics.forces["l"].pins, 1e-6), MOST)
    for one in (*found.links.values(), *found.pins.values()):
        assert (one.low, one.high) == pytest.approx((1.0, 1.0), abs=1e-4)


def test_a_frame_that_is_unstable_with_tight_pins_tells_nothing(leaning):
    _, statics, _ = leaning
    found = rim_growth(statics.forces["l"].pins, 20.0)
    assert all(one.high == np.inf for one in (*found.links.values(), *found.pins.values()))


def test_without_geometric_stiffness_condensing_gives_the_frame_of_the_rims(leaning):
    _, statics, _ = leaning
    pins = statics.forces["l"].pins
    found = divided(pins, COARSE_SUBDIVISIONS).condensed()
    assert pytest.approx(pins.rims.K, rel=1e-8, abs=1e-8 * np.abs(pins.rims.K).max()) == found.K
    assert found.g == pytest.approx(pins.rims.g, rel=1e-8, abs=1e-8 * np.abs(pins.rims.g).max())


def test_states_of_other_stiffness_are_solved_side_by_side(leaning):
    _, statics, _ = leaning
    pins = statics.forces["l"].pins
    radii, K = pins.standing[0][:2], np.array([pins.rims.K, 2.0 * pins.rims.K])
    both = least_in_discs(K, pins.rims.g, radii, ties=pins.radii.ties).v
    for k in (0, 1):
        alone = least_in_discs(K[k], pins.rims.g, radii[k : k + 1], ties=pins.radii.ties).v[0]
        assert both[k] == pytest.approx(alone, abs=1e-8)
