import math

import numpy as np
import pytest
from pydantic import ValidationError

from alula.fea.motion.critical import critical_node
from alula.fea.motion.link_envelope import _harm
from alula.fea.outcomes.fatigue import (
    LinkFatigue,
    borne,
    cycles_to_failure,
    equivalent_peak,
    fatigue_life,
    life_scatter,
    missing_data,
    rainflow,
    repeated_cycles,
    reversed_amplitude,
    signed_stress,
    strength_at,
    turning_points,
)
from alula.fea.superposition.peaks import of_stress
from alula.geometry.materials.material import Fatigue, library
from alula.reports.sentences import told

PVC = library()["pvc-u"]
RESIN = library()["resin-405nm"]


def counted(cycles):
    found = {}
    for size, _, count in cycles.tolist():
        found[size] = found.get(size, 0.0) + count
    return found


def steel(**entries):
    card = {"stress": "300 MPa", "cycles": 1e6, "exponent": 8.0, "stress_ratio": -1.0, "source": "made up", **entries}
    return library()["steel-wire"].model_copy(
        update={"fatigue": Fatigue.model_validate(card), "ultimate_strength": 800.0}
    )


def test_rainflow_counts_the_example_of_the_standard():
    # ASTM E1049-85, figure 6: peaks and valleys A to I, and its table of cycles.
    history = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    assert counted(rainflow(history)) == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def test_rainflow_finds_the_means_too():
    history = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    full = [row for row in rainflow(history).tolist() if row[2] == 1.0]
    assert full == [[4.0, 1.0, 1.0]]


def test_a_repeating_history_has_whole_cycles_wherever_it_begins():
    # ASTM E1049-85, figure 7: the same history begun at its largest peak.
    history = np.array([1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    for shift in range(len(history)):
        cycles = repeated_cycles(np.roll(history, shift))
        assert counted(cycles) == {3.0: 1.0, 4.0: 1.0, 7.0: 1.0, 9.0: 1.0}
        assert cycles[:, 2].sum() == 4.0


def test_points_on_slopes_do_not_count():
    history = 3.0 * np.sin(np.linspace(0.0, 4.0 * math.pi, 401)) + 1.0
    assert len(turning_points(history)) == 6
    assert repeated_cycles(history[:-1]) == pytest.approx(np.array([[6.0, 1.0, 2.0]]))


def test_no_variation_no_cycles():
    assert len(repeated_cycles(np.full(5, 7.0))) == 0
    life = fatigue_life(np.full(5, 7.0), steel())
    assert (life.repetitions, life.stress, life.stress_range) == (math.inf, 0.0, 0.0)


def test_goodman_by_hand():
    # Shigley, chapter 6: Goodman's line solved for the reversed amplitude: 100 / (1 − 200/800) = 133.3; compression
    # counts as none.
    cycles = np.array([[200.0, 200.0, 1.0], [200.0, -200.0, 1.0], [200.0, 900.0, 1.0]])
    assert reversed_amplitude(cycles, 800.0) == pytest.approx([400.0 / 3.0, 100.0, np.inf])


@pytest.mark.parametrize("ratio", [-1.0, 0.0, 0.1, 0.5])
def test_a_cycle_like_the_tests_own_stands_for_itself(ratio):
    fatigue = steel(stress_ratio=ratio).fatigue
    peak = 240.0
    cycle = np.array([[peak * (1.0 - ratio), peak * (1.0 + ratio) / 2.0, 1.0]])
    assert equivalent_peak(cycle, fatigue, 800.0) == pytest.approx([peak])


def test_peak_stress_rule_ignores_the_range():
    cycles = np.array([[10.0, 5.0, 1.0], [4.0, 8.0, 1.0], [4.0, -8.0, 1.0]])
    assert told(PVC.fatigue.rule) == "peak-stress"
    assert equivalent_peak(cycles, PVC.fatigue, PVC.ultimate_strength).tolist() == [10.0, 10.0, 0.0]


@pytest.mark.parametrize("stress", [6.8, 10.9])
def test_vinsons_law_for_pvc(stress):
    psi = stress / 0.00689476
    assert cycles_to_failure(np.array([stress]), PVC.fatigue) == pytest.approx([5.05e21 * psi**-4.906], rel=0.03)


def test_basquins_line_with_surface_and_endurance_limit():
    """Strength at two points by hand, 0.8 (300) 10^(2/8) and 0.8 (300); from 1e7 cycles on that of 1e7."""
    data = steel(surface_factor=0.8, endurance_cycles=1e7).fatigue
    assert strength_at(data, 1e4) == pytest.approx(426.8, rel=1e-4)
    assert strength_at(data, 1e6) == pytest.approx(240.0)
    assert strength_at(data, 1e9) == strength_at(data, 1e7) == pytest.approx(179.97, rel=1e-4)
    assert cycles_to_failure(np.array([426.8, 240.0]), data) == pytest.approx([1e4, 1e6], rel=1e-3)
    assert cycles_to_failure(np.array([179.9, 100.0]), data).tolist() == [math.inf, math.inf]
    # One stress above the limit, and the lower one harms too (Miner's elementary rule).
    assert cycles_to_failure(np.array([240.0, 120.0]), data) == pytest.approx([1e6, 2.56e8])
    assert strength_at(steel(exponent=None, endurance_cycles=1e6).fatigue, 1e9) == 300.0


def test_nothing_bears_more_than_its_static_strength():
    assert borne(steel(), 1.0) == 800.0
    assert borne(steel(), 1e6) == 300.0
    assert strength_at(steel().fatigue, 1.0) > 1600.0


def test_structural_steel_bears_nine_tenths_of_its_strength_a_thousand_times():
    """In bending; 0.85 of that when it is pulled (Shigley, 9th ed., table 6-11)."""
    card = library()["steel-s235"]
    assert strength_at(card.fatigue, 1e3) == pytest.approx(0.85 * 0.84 * 0.9 * 360.0, rel=1e-3)
    assert strength_at(card.fatigue, 1e9) == pytest.approx(0.85 * 0.84 * 0.5 * 360.0)


def test_the_scatter_of_the_strength_is_in_the_life_to_the_power_of_the_exponent():
    scatter = life_scatter(steel(strength_range=["270 MPa", "330 MPa"]).fatigue)
    assert (scatter.low, scatter.high) == (pytest.approx(0.9**8), pytest.approx(1.1**8))
    with pytest.raises(ValidationError, match="leaves out its stress"):
        steel(strength_range=["310 MPa", "330 MPa"])


def test_the_endurance_limit_goes_with_the_strength():
    """Endless below the limit of the stated strength, and not below that of a weaker one; where lives end as before."""
    card = steel(exponent=5.0, endurance_cycles=1e7, strength_range=["200 MPa", "400 MPa"])
    weaker, low, high = (steel(exponent=5.0, endurance_cycles=1e7, stress=f"{x} MPa") for x in (200.0, 250.0, 290.0))
    limit = strength_at(card.fatigue, 1e7)
    below, above = (np.array([-share * limit, share * limit]) for share in (0.8, 1.5))
    found = fatigue_life(below, card)
    assert found.repetitions == math.inf
    ends = LinkFatigue.of([found], found, below, np.zeros(3), (), material=card, repetitions=None).repetitions
    assert ends.low == pytest.approx(fatigue_life(below, weaker).repetitions)
    assert ends.low < 1e7
    assert (ends.value, ends.high) == (math.inf, math.inf)
    short = fatigue_life(above, card)
    for other, by in ((low, 250.0 / 300.0), (high, 290.0 / 300.0)):
        assert short.with_strength(card, by) == pytest.approx(fatigue_life(above, other).repetitions)
        assert short.with_strength(card, by) == pytest.approx(short.repetitions * by**5)


def test_miners_sum_of_two_blocks():
    # One cycle of 300 MPa costs 1e-6, two of 150 MPa cost 2/(1e6 2^8), all reversed.
    history = np.array([300.0, -300.0, 150.0, -150.0, 150.0, -150.0])
    life = fatigue_life(history, steel())
    assert life.repetitions == pytest.approx(1.0 / (1e-6 + 2e-6 / 2**8))
    assert life.cycles == ((600.0, 0.0, 1.0), (300.0, 0.0, 2.0))
    assert life.stress == 300.0
    assert life.count == pytest.approx(1.0 + 2.0 / 2**8)


def test_what_is_stressed_beyond_all_numbers_has_no_life():
    life = fatigue_life(np.array([1e20, 0.0]), steel())
    assert (life.stress, life.repetitions) == (math.inf, 0.0)
    assert _harm(life) == (math.inf, math.inf)


def test_ripples_are_left_out():
    """Below 5 % of the largest range, which is 600 MPa; a cycle of 6 % harms by Goodman's line and is counted."""
    for valley, kept in ((271.0, ()), (264.0, ((36.0, 282.0, 1.0),))):
        life = fatigue_life(np.array([300.0, valley, 300.0, -300.0]), steel())
        assert life.cycles == ((600.0, 0.0, 1.0), *kept)


def test_doubled_stress_shortens_life_by_the_exponent():
    history = np.array([5.0, 0.0])
    ratio = fatigue_life(history, PVC).repetitions / fatigue_life(2.0 * history, PVC).repetitions
    assert ratio == pytest.approx(2.0**4.906)


def test_one_point_gives_no_life_but_a_strength_up_to_it():
    life = fatigue_life(np.array([5.0, 0.0]), RESIN)
    assert life.repetitions is None
    assert life.stress == pytest.approx(5.0)
    assert strength_at(RESIN.fatigue, 1e6) == 5.7
    assert strength_at(RESIN.fatigue, 2e6) is None
    assert strength_at(PVC.fatigue, 1e7) == pytest.approx(6.8, rel=0.005)


def test_missing_data_is_named():
    assert "no fatigue data" in told(missing_data(library()["steel-wire"]))
    assert "ultimate_strength" in told(missing_data(steel().model_copy(update={"ultimate_strength": None})))
    assert missing_data(PVC) is None
    assert missing_data(RESIN) is None


def test_signed_stress_has_the_sign_of_the_largest_principal_stress():
    stress = np.array([[5.0, 0, 0, 0, 0, 0], [-5.0, 0, 0, 0, 0, 0], [2.0, -6.0, 0, 0, 0, 0]])
    assert signed_stress(stress, brittle=True) == pytest.approx([5.0, -5.0, -6.0])
    assert signed_stress(stress, brittle=False) == pytest.approx([5.0, -5.0, -math.sqrt(52.0)])


@pytest.mark.parametrize("material", [PVC, RESIN, steel()])
def test_critical_node_is_that_of_all_nodes(material):
    rng = np.random.default_rng(5)
    stress = rng.normal(size=(900, 6, 4)) * rng.uniform(0.1, 1.0, size=(900, 1, 1))
    angle = np.linspace(0.0, 2.0 * math.pi, 40, endpoint=False)
    combination = np.array([np.cos(angle), np.sin(angle), 0.5 * np.cos(2 * angle), np.ones(40)])
    modes = of_stress(stress, brittle=material.brittle)
    node, history = critical_node(modes, stress, combination, material)
    signed = signed_stress(np.einsum("nim,mp->npi", stress, combination), brittle=material.brittle)
    size, mean = np.ptp(signed, axis=1), (signed.max(axis=1) + signed.min(axis=1)) / 2.0
    harm = equivalent_peak(np.column_stack([size, mean, mean]), material.fatigue, material.ultimate_strength)
    assert node == int(np.argmax(harm))
    assert history == pytest.approx(signed[node])
