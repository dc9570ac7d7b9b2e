"""A test of a level with several states of load: stress of each row, cycles and Miner's sum against hand calculations.

The pylon is a tube of 34 and 26 mm, clamped at (0, 80) mm and loaded at (0, 380) mm over a rigid lever. Forward is x,
up is y, outward -z. Cut at a height y, it bears N = F·u along itself and M = (p - c) × F about the point c of its axis,
with the unit vector u and any point p of the load line.
"""

import math

import numpy as np
import pytest
from levels import BOTTOM, TOP, pylon

from alula.fea.level.check_level import check_level
from alula.fea.motion.envelope import envelope_case
from alula.fea.outcomes.fatigue import LinkFatigue
from alula.fea.refine.refinement import Effort
from alula.loads.case.level_case import over_states
from alula.loads.compose.stated_case import StatedCase

ROWS = [(0, 0, -15), (100, 900, -15), (150, 300, -15), (200, 700, -15), (300, 0, 0), (400, 800, 20), (500, 0, 40)]
"""Time [ms], force [N], tilt [deg]: two humps on the heel, one on the toe."""
ABOUT = {"forward": "10 mm", "outward": "5 mm", "up": "80 mm"}
AREA, INERTIA = math.pi / 4.0 * (34.0**2 - 26.0**2), math.pi / 64.0 * (34.0**4 - 26.0**4)
CARD = {"stress": "90 MPa", "cycles": 1e6, "exponent": 5.0, "stress_ratio": -1.0, "source": "invented"}
ULTIMATE = 300.0


def checked(tests, folder, **options):
    case = pylon(level={"tests": tests}, materials={"alloy": card()})
    case["parts"]["tube"]["material"] = "alloy"
    return check_level(StatedCase.from_dict(case, folder=folder).record, **options)


def over_profile(test, folder):
    """Return the envelope of the pylon over a test."""
    case = pylon(level={"test": "roll", "tests": {"roll": test}}, materials={"alloy": card()})
    case["parts"]["tube"]["material"] = "alloy"
    variant = over_states(StatedCase.from_dict(case, folder=folder).record)
    return envelope_case(variant, effort=Effort(max_unknowns=1000)).links["pylon"]


def card():
    source = dict.fromkeys(
        ("density", "youngs_modulus", "poissons_ratio", "yield_strength", "ultimate_strength"), "made up"
    )
    return {
        "title": "An alloy",
        "density": "2700 kg/m^3",
        "youngs_modulus": "70 GPa",
        "poissons_ratio": 0.33,
        "yield_strength": "250 MPa",
        "ultimate_strength": f"{ULTIMATE} MPa",
        "strength": "yield",
        "minimum_safety_factor": 1.5,
        "fatigue": CARD,
        "sources": source,
        "status": dict.fromkeys(source, "assumed"),
    }


def rolled(folder, **step):
    (folder / "roll.csv").write_text(
        "\n".join(["time [ms],force [N],tilt [deg]", *(f"{t},{f},{g}" for t, f, g in ROWS)])
    )
    return {"top": TOP, "bottom": BOTTOM, "tilts_about": ABOUT, "steps": [{"profile": "roll.csv", **step}]}


def load(force, tilt):
    """Return a point of the load line and the force, by turning both ends in the plane of forward and up by hand."""
    ends, turn = [], math.radians(tilt)
    for forward, outward, up in ((50.0, -20.0, 400.0), (-40.0, 10.0, 0.0)):
        a, b = forward - 10.0, up - 80.0
        x = 10.0 + a * math.cos(turn) - b * math.sin(turn)
        y = 80.0 + a * math.sin(turn) + b * math.cos(turn)
        ends.append(np.array([x, y, -outward]))
    along = ends[1] - ends[0]
    return ends[0], force * along / np.linalg.norm(along)


def resultants(force, tilt, y):
    """Return normal force, moments about x and z, and torque at a height."""
    point, pushed = load(force, tilt)
    moment = np.cross(point - [0.0, y, 0.0], pushed)
    return pushed[1], moment[0], moment[2], moment[1]


def test_a_positive_tilt_brings_the_lower_end_forward():
    """As where the shank leans forward: seen from it, the force then comes from behind and goes to the toe."""
    assert load(1.0, 20.0)[1][0] > load(1.0, 0.0)[1][0] > load(1.0, -15.0)[1][0]


def test_stress_at_each_row_is_that_of_a_cantilever_under_a_tilted_force(tmp_path):
    test = rolled(tmp_path) | {"elastic": True}
    result = checked(
        {"roll": test, "half": test | {"steps": [test["steps"][0] | {"scale": 0.5}]}}, tmp_path, fidelity="beam"
    )
    for name, scale in (("roll", 1.0), ("half", 0.5)):
        load_cases = result.tests[name].result.load_cases
        assert list(load_cases) == [f"row {k + 2}" for k, row in enumerate(ROWS) if row[1]]
        for k, (_, force, tilt) in enumerate(ROWS):
            if force == 0:
                continue
            beam = load_cases[f"row {k + 2}"].links["pylon"].beam
            for i in np.flatnonzero(beam.bending > 0.0):
                n, mx, mz, torque = (scale * part for part in resultants(force, tilt, 80.0 + beam.x[i]))
                assert beam.axial[i] == pytest.approx(n / AREA, rel=1e-9)
                assert beam.bending[i] == pytest.approx(math.hypot(mx, mz) * 17.0 / INERTIA, rel=1e-9)
                assert abs(beam.t[i]) == pytest.approx(abs(torque), rel=1e-9)
    stresses = [abs(x.links["pylon"].decisive.value) for x in result.tests["roll"].result.load_cases.values()]
    [elastic, _] = result.tests["roll"].statements
    assert (
        elastic.decides.load_case == list(result.tests["roll"].result.load_cases)[int(np.argmax(stresses))] == "row 3"
    )


def test_stress_of_the_solid_is_that_of_the_tilted_force_at_each_row(tmp_path):
    """Halfway between clamp and load, where neither matters: bending, normal force and torque, on a coarse mesh."""
    along = over_profile(rolled(tmp_path, cycles=1e6) | {"lasts": True}, tmp_path).load_cases["roll"].along
    edges = np.linspace(along.first, along.last, along.stress.shape[1] + 1)
    middle = int(np.searchsorted(edges, 150.0)) - 1
    for pose, stress in zip(along.poses, along.stress[:, middle], strict=True):
        hand = []
        for x in edges[middle : middle + 2]:
            n, mx, mz, torque = resultants(*ROWS[pose][1:], 80.0 + x)
            pulled = abs(n / AREA) + math.hypot(mx, mz) * 17.0 / INERTIA
            hand.append(math.hypot(pulled, math.sqrt(3.0) * torque * 17.0 / (2.0 * INERTIA)))
        assert stress == pytest.approx(max(hand), rel=0.05)
    assert len(along.poses) == len(ROWS)


def by_hand(cycles):
    """Return Miner's sum of (range, mean, count), by Goodman's line for reversed stress and the card's power law."""
    found = []
    for size, mean, count in cycles:
        reversed_stress = size / 2.0 / (1.0 - max(mean, 0.0) / ULTIMATE)
        found.append(count / (1e6 * (reversed_stress / 90.0) ** -5.0))
    return sum(found), found


def test_cycles_of_a_profile_are_those_counted_by_hand_in_its_order(tmp_path):
    """Heel 900 N, back to 300, up to 700, then the toe: one large cycle from heel to toe, and one of 300 to 700 N."""
    test = rolled(tmp_path, cycles=1e6) | {"lasts": True}
    result = checked({"roll": test}, tmp_path, effort=Effort(max_unknowns=1000)).tests["roll"]
    [found] = [x for of in result.result.load_cases.values() for x in of.of_links(LinkFatigue).values()]
    heel, dip, hump, toe = (found.history[k] for k in (1, 2, 3, 5))
    counted = [(heel - toe, (heel + toe) / 2.0, 1.0), (hump - dip, (hump + dip) / 2.0, 1.0)]
    assert np.array(found.life.cycles) == pytest.approx(np.array(counted))
    assert heel > 0.0 > toe
    assert (dip / heel, hump / heel) == pytest.approx((300.0 / 900.0, 700.0 / 900.0))
    assert found.life.repetitions == pytest.approx(1.0 / by_hand(counted)[0])
    [lasts, _] = result.statements
    assert (len(lasts.outcomes), lasts.decides.load_case) == (1, "row 3")


@pytest.mark.parametrize("order", [1, -1])
def test_harm_of_steps_adds_up_with_the_way_to_a_force_that_is_held(order, tmp_path):
    """Of 1e6 cycles 0.9 go to 600 and 0.1 to 900 N; then 1500 N are held. The whole test counts once: from nothing to
    1500 N, and between its steps to 600 N and back to nothing, or to 900 N and back to 60."""
    blocks = [{"least": "60 N", "force": "600 N", "cycles": 9e5}, {"force": "900 N", "cycles": 1e5}]
    steps = [{"force": "100 N"}, *blocks[::order], {"force": "1500 N", "duration": "20 s"}]
    test = {"top": TOP, "bottom": BOTTOM, "steps": steps, "lasts": True, "elastic": True}
    result = checked({"two": test}, tmp_path, fidelity="beam").tests["two"].result
    links = result.load_cases["two"]
    life = links.of_links(LinkFatigue)["pylon"].life
    unit = links.links["pylon"].decisive.value / 1500.0
    assert result.case.load_cases["two"].load_lines[0].force == 1500.0
    shares = ((540.0, 330.0, 0.9), (900.0, 450.0, 0.1))
    inner = (600.0, 300.0) if order == 1 else (840.0, 480.0)
    once = [(1500.0, 750.0, 1e-6), (*inner, 1e-6)]
    expected = by_hand([(unit * size, unit * mean, n) for size, mean, n in (*shares, *once)])[0]
    assert life.repetitions == pytest.approx(1.0 / expected, rel=1e-9)
    harm = [by_hand([(unit * size, unit * mean, n)])[0] / expected for size, mean, n in shares[::order]]
    assert life.harm[:2] == pytest.approx(harm)
    assert sum(life.harm) == pytest.approx(1.0)


def test_of_steps_whose_harm_is_at_different_places_the_worse_place_decides_in_any_order(tmp_path):
    """On the toe few cycles of a large force, on the heel many of a smaller one, which do the harm."""
    for name, row in (("heel", "600,-15"), ("toe", "900,25")):
        (tmp_path / f"{name}.csv").write_text(f"time [ms],force [N],tilt [deg]\n0,0,0\n100,{row}\n200,0,0\n")
    steps = [{"profile": "heel.csv", "cycles": 1e6}, {"profile": "toe.csv", "cycles": 10}]
    test = {"top": TOP, "bottom": BOTTOM, "tilts_about": ABOUT, "lasts": True}
    tests = {"first": steps, "last": steps[::-1], "alone": steps[:1]}
    lives = {}
    for name, own in tests.items():
        over = over_profile(test | {"steps": own}, tmp_path)
        lives[name] = over.load_cases["roll"].fatigue.life
    first, last, alone = (lives[name] for name in ("first", "last", "alone"))
    assert first.repetitions == pytest.approx(last.repetitions, rel=0.01)
    assert first.repetitions <= 1.00001 * alone.repetitions  # of 1e6 and 10 cycles those ten do no good
    assert max(first.harm) == first.harm[0] > 0.9
    assert first.harm[:2] == pytest.approx(last.harm[1::-1], rel=0.05)
