"""The check of fatigue in a pose: by hand, on solids, beside the envelope, and where nothing is known."""

import math
import tomllib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from eye_case import EYES
from rocker_case import TOML as ROCKER

from alula.fea.asked.asked import asked
from alula.fea.asked.lasting import fatigue_caveats
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity, Subject, Verdict
from alula.fea.judging.fatigue import asked_fatigue, judge_fatigue, link_fatigue_outcomes, pulsating
from alula.fea.links.link_by_hand import cut_link
from alula.fea.motion.envelope import envelope_case
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.outcomes.fatigue import LinkFatigue, borne, borne_repeated, borne_scatter, notch_factors, signed_stress
from alula.fea.outcomes.limits import stress_limits
from alula.fea.refine.refinement import Effort
from alula.geometry.base.errors import CaseError
from alula.geometry.materials.material import Fatigue, library
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import FatigueCheck
from alula.reports.check.displacement import displacement_section
from alula.reports.sentences import told

CARD = {"stress": "90 MPa", "cycles": 1e6, "exponent": 6.0, "stress_ratio": -1.0, "source": "made up"}
SU = 260.0
PULL, LIFT = ["500 N", "0 N"], ["300 N", "300 N"]


def repeated(fatigue=None, *, change=lambda tables: None, **conditions):
    """Two bars: pulled, the level one bears 500 N; lifted, the rising one bears 300 √2 N and the level one nothing."""
    tables = tomllib.loads(EYES)
    tables["parts"]["bar"] |= {
        "thickness": "4 mm",
        "eye_thickness": "4 mm",
        "fillet_radius": "1.2 mm",
        "eye_diameter": "12.6 mm",
    }
    tables["checks"] = {"fatigue": {"type": "fatigue", "minimum": 1.5}}
    tables["conditions"] = {"cycles": 1e5, **conditions}
    tables["load_cases"]["lift"] = {"forces": [{"link": "level", "at": "B", "force": LIFT}]}
    tables["solid"] = {"mesh_size": 2.5}
    change(tables)
    case, name = validate(tables), "aluminium-6061-t6"
    if fatigue is None:
        return case
    card = case.all_materials[name].model_copy(update={"fatigue": Fatigue.model_validate({**CARD, **fatigue})})
    return case.model_copy(update={"materials": {**case.materials, name: card}})


def found(result, load_case, link):
    [one] = [x for x in result.load_cases[load_case].checks if x.name == "fatigue" and x.link == link]
    return one


def factor(stress, least=0.0):
    """By hand: Goodman's reversed amplitude of a cycle from a share of it, under Basquin's line at 1e5 cycles."""
    amplitude = (1.0 - least) / 2.0 * stress / (1.0 - (1.0 + least) / 2.0 * stress / SU)
    return 90.0 * 10.0 ** (1.0 / 6.0) / amplitude


@pytest.fixture(scope="module")
def by_hand():
    return check_case(repeated({}), fidelity="beam")


def test_each_load_case_has_its_worst_link(by_hand):
    """The link that bears more fatigues first; the other one, on which nothing acts, lasts."""
    for load_case, worse, other in (("pull", "level", "rising"), ("lift", "rising", "level")):
        stress = by_hand.load_cases[load_case].links[worse].decisive
        outcome = found(by_hand, load_case, worse)
        assert outcome.quantity is Quantity.FATIGUE_STRESS
        assert outcome.value.value == pytest.approx(factor(stress.value))
        assert outcome.value.low == pytest.approx(factor(stress.high))
        assert found(by_hand, load_case, other).value.low == math.inf
        assert told(found(by_hand, load_case, other).reason) == "nothing acts on it"
    assert found(by_hand, "pull", "level").value.value < found(by_hand, "lift", "rising").value.value


def test_it_tells_how_often_the_load_is_borne(by_hand):
    life = by_hand.load_cases["pull"].of_links(LinkFatigue)["level"]
    assert life.wanted == 1e5
    assert life.repetitions.value == pytest.approx(1e5 * found(by_hand, "pull", "level").value.value ** 6.0)
    assert "of 1.00·10⁵ cycles" in told(found(by_hand, "pull", "level").reason)


def test_each_load_case_goes_back_to_its_own_share():
    """One that reverses has no mean; one that states what is left of it goes back to that."""

    def held(tables):
        tables["load_cases"]["pull"]["least"] = 0.4

    result = check_case(repeated({}, change=held, reverses=True), fidelity="beam")
    for load_case, link, least in (("pull", "level", 0.4), ("lift", "rising", -1.0)):
        stress = result.load_cases[load_case].links[link].decisive
        outcome = found(result, load_case, link)
        assert outcome.value.value == pytest.approx(factor(stress.value, least))
        assert outcome.value.low == pytest.approx(factor(stress.high, least))


def test_a_share_that_is_left_needs_cycles():
    def once(tables):
        tables["load_cases"]["pull"]["least"] = 0.0
        tables["conditions"], tables["checks"] = {}, {}

    with pytest.raises(CaseError, match=r"load_cases\.pull\.least: it says how cycles go, but none are stated"):
        repeated(change=once)


def test_the_band_holds_load_and_strength():
    def scattered(tables):
        tables["load_cases"]["pull"]["scatter"] = [0.8, 1.25]

    plain = check_case(repeated({}), fidelity="beam")
    result = check_case(repeated({"strength_range": ["60 MPa", "135 MPa"]}, change=scattered), fidelity="beam")
    outcome = found(result, "pull", "level")
    stress = plain.load_cases["pull"].links["level"].decisive
    assert outcome.value.low == pytest.approx(factor(1.25 * stress.high) * 60.0 / 90.0, rel=5e-3)
    assert outcome.value.high >= 1.5 * factor(0.8 * stress.low)
    assert {SourceKind.LOAD, SourceKind.STRENGTH} <= {source.kind for source in outcome.value.sources}
    life = result.load_cases["pull"].of_links(LinkFatigue)["level"].repetitions
    assert life.low == pytest.approx(1e5 * outcome.value.low**6.0)


@pytest.mark.parametrize(("least", "opens"), [(1.02, False), (0.98, True)])
def test_a_cycle_that_may_yield_at_the_weakest_strength_never_passes(least, opens):
    """The yield strength as stated is twice the stress; the weakest is a little above or below it."""
    largest = check_case(repeated({}), fidelity="beam").load_cases["pull"].of_links(LinkFatigue)["level"].largest
    case = repeated({"stress": "250 MPa"}, cycles=10.0)
    name = "aluminium-6061-t6"
    card = case.all_materials[name].model_copy(
        update={"yield_strength": 2.0 * largest, "strength_range": (least * largest, 3.0 * largest)}
    )
    result = check_case(case.model_copy(update={"materials": {**case.materials, name: card}}), fidelity="beam")
    outcome = found(result, "pull", "level")
    assert outcome.verdict is (Verdict.UNDECIDED if opens else Verdict.PASS)
    assert ("does not stay linear" in told(outcome.reason)) is opens


@pytest.mark.parametrize(("stress", "low"), [(100.0, 0.7), (20.0, 0.9), (38.0, 0.7 * 40.0 / 38.0), (30.0, 0.9)])
def test_the_tensile_strength_of_a_brittle_material_ends_and_scatters_what_it_bears(stress, low):
    data = {**CARD, "stress": f"{stress} MPa", "strength_range": [f"{0.9 * stress} MPa", f"{1.1 * stress} MPa"]}
    card = library()["resin-405nm"].model_copy(
        update={"ultimate_strength": 40.0, "strength_range": (28.0, 50.0), "fatigue": Fatigue.model_validate(data)}
    )
    found = borne_scatter(card, borne(card, 1e6))
    assert found.low == pytest.approx(low)
    assert found.high == pytest.approx(1.25 if stress > 40.0 else 1.1)


@pytest.mark.parametrize(("rule", "least"), [("goodman", None), ("peak-stress", math.inf)])
def test_by_hand_a_pressed_link_may_do_better(rule, least):
    """Beam theory tells the size of a peak, not its sign; under pure compression it counts as a pull."""

    def pushed(tables):
        tables["load_cases"]["pull"]["forces"][0]["force"] = ["-500 N", "0 N"]

    result = check_case(repeated({"rule": rule}, change=pushed), fidelity="beam")
    outcome, stress = found(result, "pull", "level"), result.load_cases["pull"].links["level"].decisive
    if rule == "goodman":
        assert outcome.value.low == pytest.approx(factor(stress.high))
        assert outcome.value.high == pytest.approx(90.0 * 10.0 ** (1.0 / 6.0) / (stress.low / 2.0))
    else:
        assert outcome.value.high == least


@pytest.mark.parametrize("least", [0.0, -1.0, 0.4])
@pytest.mark.parametrize("changed", [{}, {"rule": "peak-stress"}, {"stress_ratio": 0.1}])
def test_meshes_are_refined_for_the_stress_at_which_the_limit_is_met(changed, least):
    def back(tables):
        tables["load_cases"]["lift"]["least"] = least

    case = repeated(changed, change=back)
    limit = borne_repeated(case.material_of("level"), 1e5, 1.5, *case.repeated("lift"))
    assert (limit, limit) in stress_limits(case, "level")
    if not changed:
        assert factor(limit, least) == pytest.approx(1.5)


@pytest.mark.parametrize(("cycles", "strength"), [(1e6, None), (1.1e6, math.nan)])
def test_a_card_of_one_point_knows_nothing_beyond_it(cycles, strength):
    result = check_case(repeated({"exponent": None}, cycles=cycles), fidelity="beam")
    value = found(result, "pull", "level").value
    assert value.unknowable is (strength is not None)


def test_what_yields_does_not_pass():
    def hard(tables):
        tables["load_cases"]["pull"]["forces"][0]["force"] = ["2000 N", "0 N"]
        tables["checks"]["fatigue"]["minimum"] = 0.5

    result = check_case(repeated({}, change=hard, cycles=10.0, reverses=True), fidelity="beam")
    outcome = found(result, "pull", "level")
    assert outcome.value.low > 0.5
    assert outcome.verdict is Verdict.UNDECIDED
    assert "does not stay linear" in told(outcome.reason)
    assert found(result, "lift", "rising").verdict is Verdict.PASS


@pytest.mark.parametrize(("loose", "tight"), [("O", "B"), ("B", "O")])
def test_the_pin_that_presses_hardest_in_a_loose_hole_is_told(loose, tight):
    def seated(tables):
        tables["joints"][loose]["clearance"] = "0.5 mm"
        tables["joints"][tight]["clearance"] = "0.01 mm"
        tables["load_cases"] = {"pull": {"forces": [{"link": "level", "at": "B", "force": ["500 N", "-400 N"]}]}}

    outcome = found(check_case(repeated({"stress": "20 MPa"}, change=seated), fidelity="beam"), "pull", "level")
    assert f"the pin at {loose} presses with up to" in told(outcome.reason)
    assert "presses" not in told(found(check_case(repeated({}), fidelity="beam"), "pull", "level").reason)


def test_over_a_motion_cycles_count_by_rainflow_times_those_of_the_conditions():
    tables = tomllib.loads(ROCKER)
    tables["conditions"] = {"cycles": 2e4}
    tables["checks"] = {"life": {"type": "fatigue", "minimum": 1.25}, "sf": {"type": "safety-factor"}}
    tables["parts"]["bar"]["material"] = "pvc-u"
    result = envelope_case(validate(tables), effort=Effort(max_unknowns=1000))
    over = result.links["rocker"].load_cases["turn"].fatigue
    [outcome] = [one for one in result.checks if one.quantity in (Quantity.FATIGUE_STRESS, Quantity.FATIGUE_LIFE)]
    assert (outcome.name, outcome.limit, over.wanted) == ("life", 1.25, 2e4)
    strength = 10.9 * (2e4 * over.life.count / 1e6) ** (-1.0 / 4.906)
    assert outcome.value.value == pytest.approx(min(strength, 48.3) / over.stress.value)
    assert "it lasts" in told(outcome.reason)
    assert "of 20000 cycles" in told(outcome.reason)


def test_neither_beams_beyond_their_calibration_nor_layers_pass():
    def thin(tables):
        tables["parts"]["bar"]["thickness"] = tables["parts"]["bar"]["eye_thickness"] = "2 mm"

    outcome = found(check_case(repeated({}, change=thin), fidelity="beam"), "pull", "level")
    assert outcome.verdict is Verdict.UNDECIDED
    assert "is not calibrated for this link" in told(outcome.reason)

    def printed(tables):
        tables["parts"]["bar"]["material"] = "pla-fdm-xy"
        tables["load_cases"]["pull"]["forces"][0]["force"] = ["5 N", "0 N"]

    outcome = found(check_case(repeated(change=printed), fidelity="beam"), "pull", "level")
    assert outcome.value.low > 1.5
    assert outcome.verdict is Verdict.UNDECIDED
    assert "fatigue of its layers is not judged in a pose" in told(outcome.reason)


def test_without_data_and_without_cycles():
    def steel(tables):
        tables["parts"]["bar"]["material"] = "brass-cuzn39pb3"
        tables["checks"] = {}

    result = check_case(repeated(change=steel), fidelity="beam")
    outcome = found(result, "pull", "level")
    assert (outcome.verdict, outcome.limit) == (Verdict.UNDECIDED, 2.0)
    assert "no fatigue data" in told(outcome.reason)

    def endless(tables):
        del tables["conditions"]

    with pytest.raises(CaseError, match="needs the number of cycles"):
        repeated(change=endless)


def test_the_caveat_is_of_what_no_check_names():
    def one(tables):
        tables["checks"]["fatigue"]["links"] = ["level"]

    def alone(tables):
        del tables["load_cases"]["lift"]

    several = "fatigue under load cases that alternate or add up"
    for change, over_motion, names in (
        (one, False, [several, "fatigue of rising"]),
        (None, False, [several]),
        (None, True, [several]),
        (alone, False, []),
    ):
        case = repeated({}, **({"change": change} if change else {}))
        assert [told(x.what) for x in fatigue_caveats(case, over_motion=over_motion)] == names


def test_notch_sensitivity_of_holes_after_peterson():
    """Aluminium 0.51 mm and low-carbon steel 0.25 mm, as tables print them: q = 0.83 and 0.91 at r = 2.5 mm."""
    body = repeated().body("level")
    places = np.array([[0.0, 2.5, 0.3], [62.5, 0.0, 0.0], [57.6, 0.0, 0.0], [0.0, 3.5, 0.0], [30.0, 4.0, 0.0]])
    for length, q in ((0.51, 0.83056), (0.25, 0.90909)):
        data = Fatigue.model_validate({**CARD, "notch_length": f"{length} mm"})
        low, high = notch_factors(body, places, data)
        assert low == pytest.approx([q, q, q, 1.0, 1.0], abs=1e-5)
        assert high[:3] == pytest.approx(q + (1.0 - q) * 0.6, abs=1e-5)
        assert (high[3:] == 1.0).all()
    slotted = replace(body, pins=tuple(replace(pin, slot=4.0) for pin in body.pins))
    assert (notch_factors(slotted, places, data)[0] == 1.0).all()
    plain = notch_factors(body, places, Fatigue.model_validate(CARD))
    assert (np.concatenate(plain) == 1.0).all()


@pytest.fixture(scope="module")
def solved():
    return check_case(repeated({"notch_length": "0.51 mm"}), fidelity="solid")


def followed(solved, load_case, link, *shares):
    """The envelope of a link on its own mesh, over which the load of the pose has these shares."""
    case, of = solved.case, solved.load_cases[load_case]
    [loads] = cut_link(case, link, load_case, of.large_displacement, of.reactions, of.loads)
    repeats = loads.chosen(None).chosen([0] * len(shares))
    motion = LinkMotion(
        of.links[link].solution.space, link=link, body=case.body(link), material=case.material_of(link),
        histories=[repeats.with_wrenches([np.array(shares)[:, None] * wrench for _, wrench in repeats.wrenches])],
        evaluated=np.ones(len(shares), dtype=bool), stated=case.torque_transfer, returns=True,
    )  # fmt: skip
    return motion.envelope(repetitions=case.conditions.cycles).load_cases[load_case].fatigue


@pytest.mark.parametrize(("load_case", "link"), [("pull", "level"), ("lift", "rising")])
def test_a_motion_whose_load_comes_and_goes_agrees(solved, load_case, link):
    """The same link on the same mesh: loads of 0, 1 and ½ over an envelope are one cycle of the load of the pose."""
    over, pose = (
        followed(solved, load_case, link, 0.0, 1.0, 0.5, 0.0),
        solved.load_cases[load_case].of_links(LinkFatigue)[link],
    )
    assert pose.stress.value == pytest.approx(over.stress.value, rel=5e-3)
    assert pose.strength == over.strength
    assert np.abs(np.abs(pose.location) - np.abs(over.location))[:2].max() < 0.5
    assert over.life.count == pose.life.count == 1.0
    q = 1.0 / (1.0 + 0.51 / 2.5)
    assert over.stress.low < 0.98 * q / (q + 0.6 * (1.0 - q)) * over.stress.value


def test_two_cycles_of_one_repetition_leave_the_strength_at_twice_the_cycles(solved):
    once, twice = (
        followed(solved, "pull", "level", 0.0, 1.0, 0.0),
        followed(solved, "pull", "level", 0.0, 1.0, 0.0, 1.0, 0.0),
    )
    assert twice.stress.value == pytest.approx(once.stress.value)
    assert twice.strength == pytest.approx(once.strength * 2.0 ** (-1.0 / 6.0))
    assert twice.repetitions.value == pytest.approx(once.repetitions.value / 2.0)


def test_the_solid_counts_the_hole_by_its_radius(solved):
    of = solved.load_cases["pull"]
    life, result = of.of_links(LinkFatigue)["level"], of.links["level"]
    q = 1.0 / (1.0 + 0.51 / 2.5)
    largest = float(result.stress.von_mises.max())
    assert life.life.largest == pytest.approx((q + 0.6 * (1.0 - q)) * largest, rel=1e-6)
    assert found(solved, "pull", "level").value.value == pytest.approx(factor(life.life.largest))
    assert SourceKind.NOTCH in {source.kind for source in life.stress.sources}
    assert life.stress.low < 0.98 * q / (q + 0.6 * (1.0 - q)) * life.stress.value


def test_a_solid_whose_peak_yields_does_not_pass_for_its_notch(solved):
    life = replace(solved.load_cases["pull"].of_links(LinkFatigue)["level"], strength=1e4)
    raw = float(solved.load_cases["pull"].links["level"].stress.von_mises.max())
    assert life.largest == pytest.approx(raw * life.stress.high / life.life.stress)
    for share, verdict in ((0.97, Verdict.UNDECIDED), (1.01, Verdict.PASS)):
        card = solved.case.material_of("level").model_copy(update={"yield_strength": share * life.largest})
        case = solved.case.model_copy(update={"materials": {"aluminium-6061-t6": card}})
        [outcome] = link_fatigue_outcomes(case, asked_fatigue(case, "level"), "pull", life)
        assert outcome.verdict is verdict


def test_what_reverses_on_a_solid_with_pins_does_not_pass(solved):
    """Its pins press on the other side then; no less than the cycle from nothing is there."""
    once = solved.load_cases["pull"].of_links(LinkFatigue)["level"]

    def lax(tables):
        tables["checks"]["fatigue"]["minimum"] = 0.1

    case = repeated({"notch_length": "0.51 mm"}, reverses=True, change=lax)
    links = {"level": solved.load_cases["pull"].links["level"]}
    life = pulsating(case, "pull", "level", links["level"])
    assert life.stress.low == pytest.approx(once.stress.low)
    assert life.stress.value > 1.5 * once.stress.value
    outcome = judged(case, links)
    assert outcome.verdict is Verdict.UNDECIDED
    assert "on the other side of their holes" in told(outcome.reason)
    case = repeated({"notch_length": "0.51 mm"}, change=lax)
    assert judged(case, links).verdict is Verdict.PASS


def judged(case, links):
    idle = {name: SimpleNamespace(wrench=np.zeros(6)) for name in case.joints}
    here = SimpleNamespace(case=case, load_case="pull", links=links, ways=lambda: [SimpleNamespace(joints=idle)])
    [one] = asked(case, FatigueCheck, subject=Subject.link("level"))
    return judge_fatigue(here, one).outcome


def test_a_pressed_brittle_solid_counts_every_variant_and_the_wider_band(solved):
    """Two variants, 1.3 apart; the von Mises stress is open from 0.9 to 1.2 beyond them, tension by nothing."""
    of, case = solved.load_cases["pull"].links["level"], repeated({}, reverses=True)
    cases = [replace(of.governing_case, displacement=-x * of.governing_case.displacement) for x in (1.0, 1.3)]
    result = replace(
        of,
        brittle=True,
        solution=replace(of.solution, cases=cases),
        governing_case=cases[0],
        variants=[replace(of.governing, principal=x, von_mises=x) for x in (1.0, 1.3)],
        principal_max=Band(value=1.3, low=1.0, high=1.3),
        von_mises_max=Band(value=1.3, low=0.9, high=1.2 * 1.3),
    )
    push = float(signed_stress(of.stress.nodal, brittle=True).max())
    found = pulsating(case, "pull", "level", result)
    assert found.stress.value == pytest.approx(1.3 * push)
    assert found.stress.high == pytest.approx(1.2 * 1.3 * push)
    assert found.stress.low == pytest.approx(0.9 * push / 2.0)


def test_report_and_record_tell_it(by_hand):
    section = displacement_section(by_hand)
    record = section.data["load_cases"]["pull"]["fatigue"]["level"]
    assert record["wanted_repetitions"] == 1e5
    assert record["repetitions"]["value"] == pytest.approx(
        by_hand.load_cases["pull"].of_links(LinkFatigue)["level"].repetitions.value
    )
    assert "fatigue" in str(section.parts)
