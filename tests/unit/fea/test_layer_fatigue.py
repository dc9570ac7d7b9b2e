"""Fatigue of the layers of printed parts, against closed forms and searches of everything."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import Verdict
from alula.fea.motion import layer_envelope
from alula.fea.motion.envelope_outcomes import layer_fatigue_outcomes
from alula.fea.motion.envelope_result import LayerEnvelope, LayerFatigue
from alula.fea.motion.layer_envelope import _lacking
from alula.fea.motion.layer_fatigue import LayerCycle, critical_layer, smallest_circle
from alula.fea.solid.layers import Layers
from alula.geometry.materials.material import Fatigue, library
from alula.reports.sentences import told

RNG = np.random.default_rng(11)
TURN = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
STILL = np.zeros_like(TURN)
STRENGTH = 20.0
CARD = library()["pla-fdm-xy"]


def data(**changed):
    return Fatigue.model_validate(
        {"stress": "6 MPa", "cycles": 1e6, "exponent": 8.0, "stress_ratio": -1.0, "source": "made up"} | changed
    )


def all_circles(points):
    """Least radius of the circles through two or three points that hold all."""
    found = []
    for i, j in itertools.combinations(range(len(points)), 2):
        found.append(((points[i] + points[j]) / 2.0, np.linalg.norm(points[i] - points[j]) / 2.0))
    for chosen in itertools.combinations(range(len(points)), 3):
        p, q, r = points[list(chosen)]
        a, b, c = np.linalg.norm(q - r), np.linalg.norm(r - p), np.linalg.norm(p - q)
        weights = np.array([a**2 * (b**2 + c**2 - a**2), b**2 * (c**2 + a**2 - b**2), c**2 * (a**2 + b**2 - c**2)])
        centre = weights @ np.array([p, q, r]) / weights.sum()  # barycentric
        found.append((centre, np.linalg.norm(p - centre)))
    return min(radius for centre, radius in found if np.linalg.norm(points - centre, axis=1).max() <= radius + 1e-9)


def test_the_smallest_circle():
    for count in (3, 5, 12):
        for _ in range(20):
            points = RNG.normal(size=(count, 2)) * (3.0, RNG.uniform(0.01, 3.0)) + (5.0, -2.0)
            centre, radius = smallest_circle(points)
            assert radius == pytest.approx(all_circles(points))
            assert np.linalg.norm(points - centre, axis=1).max() == pytest.approx(radius)
    triangle = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
    assert smallest_circle(triangle)[1] == pytest.approx(1.0 / np.sqrt(3.0))
    line = np.outer(np.linspace(-1.0, 3.0, 9), [3.0, 4.0])
    assert smallest_circle(line) == (pytest.approx([3.0, 4.0]), pytest.approx(10.0))
    assert smallest_circle(np.full((5, 2), 1.25)) == (pytest.approx([1.25, 1.25]), 0.0)
    centre, radius = smallest_circle(1e6 + 1e-7 * RNG.normal(size=(60, 2)))  # nothing but rounding
    assert radius < 1e-6
    assert centre == pytest.approx([1e6, 1e6])


@pytest.mark.parametrize("ratio", [-1.0, 0.0, 0.1, 0.5])
@pytest.mark.parametrize("rule", ["goodman", "peak-stress"])
def test_a_cycle_like_the_tests_own_stands_for_itself(ratio, rule):
    """Tension, shear and both in phase: Rn/Rt τ has the same fatigue strength as tension, and both add by squares."""
    wave = 4.0 * ((1.0 + ratio) / 2.0 + (1.0 - ratio) / 2.0 * np.cos(TURN))
    fatigue = data(stress_ratio=ratio, rule=rule)
    for traction, peak in (
        ([wave, STILL, STILL], 4.0),
        ([STILL, 0.6 * wave, -0.8 * wave], 4.0),
        ([wave, 0.6 * wave, -0.8 * wave], 4.0 * np.sqrt(2.0)),
    ):
        cycle = LayerCycle.of(np.array(traction))
        assert cycle.count == 1
        assert cycle.stress(fatigue, STRENGTH) == pytest.approx(peak)
        assert cycle.repetitions(fatigue, STRENGTH) == pytest.approx(1e6 * (6.0 / peak) ** 8)


def test_mean_and_amplitude_by_hand():
    """Reversed tests, Goodman's line to 20 MPa: 3 / (1 - 5/20) = 4 in tension, 2 / (1 - 12/20) = 5 in shear."""
    cycle = LayerCycle.of(np.array([5.0 + 3.0 * np.cos(TURN), 12.0 + 2.0 * np.cos(TURN), 2.0 * np.sin(TURN)]))
    assert (cycle.tension, cycle.shear) == (pytest.approx((5.0, 3.0)), pytest.approx((12.0, 2.0)))
    assert cycle.stress(data(), STRENGTH) == pytest.approx(np.hypot(4.0, 5.0))
    assert cycle.stress(data(), STRENGTH, 2.0) == pytest.approx(np.inf)  # a mean of 24 MPa in shear
    assert data().exponent == 8.0
    assert cycle.repetitions(data(exponent=None), STRENGTH) is None


def test_compression_beyond_a_reversed_cycle_neither_helps_nor_harms():
    for low, high, stress in ((-3.0, 3.0, 3.0), (-50.0, 3.0, 3.0), (-50.0, -1.0, 0.0), (-1.0, 3.0, 2.0 / (1 - 1 / 20))):
        wave = (high + low) / 2.0 + (high - low) / 2.0 * np.cos(TURN)
        assert LayerCycle.of(np.array([wave, STILL, STILL])).stress(data(), STRENGTH) == pytest.approx(stress)


def test_every_cycle_of_a_repetition_is_counted():
    cycle = LayerCycle.of(np.array([STILL, 4.0 * np.cos(2.0 * TURN + 0.1), STILL]))
    assert cycle.count == 2
    assert cycle.repetitions(data(), STRENGTH) == pytest.approx(1e6 * (6.0 / 4.0) ** 8 / 2.0, rel=0.05)
    resting = LayerCycle.of(np.full((3, 5), 2.0))
    assert (resting.stress(data(), STRENGTH), resting.repetitions(data(), STRENGTH)) == (0.0, np.inf)


@pytest.mark.parametrize("between", [None, 8.0])
@pytest.mark.parametrize("changed", [{}, {"stress_ratio": 0.1}, {"rule": "peak-stress"}])
def test_the_critical_node_is_that_of_all_nodes(between, changed):
    stress = RNG.normal(size=(700, 6, 4)) * RNG.uniform(0.1, 1.0, size=(700, 1, 1)) ** 3
    combination = np.array([np.cos(TURN), np.sin(TURN), 0.5 * np.cos(2.0 * TURN), np.ones_like(TURN)])
    layers = Layers(normal=(1.0, 2.0, -0.5), across=STRENGTH, between=between)
    node, traction = critical_layer(stress, combination, layers, data(**changed))
    parts = layers.parts(stress) @ combination
    assert traction == pytest.approx(parts[node])
    harm = [LayerCycle.of(part).stress(data(**changed), STRENGTH) for part in parts]
    assert node == np.argmax(harm)


def fatigued(low, high):
    return LayerFatigue(
        location=np.array([1.0, 2.0, 3.0]), tension=(1.0, 2.0), shear=(0.0, 0.5),
        stress=Band(value=(low + high) / 2.0, low=low, high=high), wanted=1e6, strength=6.0, repetitions=None,
    )  # fmt: skip


def outcome(fatigue, material, why=""):
    unknown = Band.unknown()
    layers = LayerEnvelope(safety_factor=unknown, pose=0, location=np.zeros(3), fatigue=fatigue, no_fatigue=why)
    return list(layer_fatigue_outcomes(material, "AE", "walk", layers))


@pytest.mark.parametrize(
    ("ends", "verdict"), [((1.0, 2.9), Verdict.PASS), ((2.0, 4.0), Verdict.UNDECIDED), ((3.1, 4.0), Verdict.FAIL)]
)
def test_the_band_over_the_strength_decides(ends, verdict):
    card = CARD.model_copy(update={"fatigue_across_layers": data(exponent=None)})
    [found] = outcome(fatigued(*ends), card)
    assert (found.name, found.verdict, found.limit) == ("fatigue of layers", verdict, 2.0)
    assert "1 ± 2 MPa across the layers, 0 ± 0.5 MPa of shear along them, at x = 1.0, y = 2.0" in told(found.reason)
    bare = card.model_copy(update={"shear_strength_between_layers": None})
    [found] = outcome(fatigued(*ends), bare)
    assert found.verdict is (Verdict.FAIL if verdict is Verdict.FAIL else Verdict.UNDECIDED)


@pytest.mark.parametrize(
    ("changed", "repetitions", "strength"),
    [({}, 1e6, 6.0 * 2.0 ** (-1 / 8)), ({}, None, 6.0), ({}, 1.0, STRENGTH), ({"exponent": None}, 1e6, None)],
)
def test_the_strength_is_that_at_all_cycles_and_at_most_the_static_one(monkeypatch, changed, repetitions, strength):
    cycle = LayerCycle.of(np.array([4.0 * np.cos(2.0 * TURN + 0.1), STILL, STILL]))
    assert cycle.count == 2
    monkeypatch.setattr(layer_envelope, "_critical", lambda *_: (cycle, np.zeros(3), (1.0, 1.0)))
    motion = SimpleNamespace(
        material=CARD.model_copy(update={"fatigue_across_layers": data(**changed)}),
        measure=SimpleNamespace(sides=[(Layers(normal=(0.0, 0.0, 1.0), across=STRENGTH, between=None), 1.0)]),
        stated=None,
    )
    found = layer_envelope._fatigue(motion, [SimpleNamespace(transfer=None)], Scatter(), repetitions)
    assert found.strength == (None if strength is None else pytest.approx(strength))


def test_without_data_it_is_undecided_where_it_is_asked_for():
    def lacking(material, repetitions=None, evaluated=(True, True)):
        return _lacking(SimpleNamespace(material=material, evaluated=np.array(evaluated)), repetitions)

    rigid = CARD.model_copy(update={"fatigue": None})
    assert lacking(rigid) is None
    assert outcome(None, rigid) == []
    assert lacking(rigid, 1e5) == lacking(CARD)
    assert "fatigue_across_layers" in told(lacking(CARD))
    [found] = outcome(None, CARD, lacking(CARD))
    assert (found.verdict, found.reason) == (Verdict.UNDECIDED, lacking(CARD))
    known = CARD.model_copy(update={"fatigue_across_layers": data()})
    assert lacking(known) is None
    assert "not closed" in told(lacking(known, evaluated=(True, False)))
