"""A material at a temperature: what the tables of its card say of strength and modulus, and what they do not say."""

from functools import cache

import pytest
from edited_cases import edited
from materials import with_material

import alula
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.frame.build import build_frame
from alula.fea.outcomes.unchecked import Topic, caveats
from alula.geometry.base.errors import CaseError
from alula.geometry.materials.material import library
from alula.reports.sentences import told

FOUR_BAR = "four-bar"
IN_PVC = ('parts.bar.material="pvc-u"',)


@cache
def checked(*entries, modulus=True, strength=True):
    """The four-bar by hand, in PVC whose card may lack one of its tables."""
    card = library()["pvc-u"]
    lost = {} if modulus else {"modulus_temperature_factors": ()}
    lost |= {} if strength else {"temperature_factors": ()}
    case = with_material(edited(FOUR_BAR, [*IN_PVC, *entries]), "pvc-u", card.model_copy(update=lost))
    return check_case(case, fidelity="beam")


def of(result, quantity):
    return [c for c in result.load_cases["lift"].checks if c.quantity is quantity]


def test_in_the_warmth_links_give_more_and_buckle_earlier():
    """PVC at 40 °C has 0.862 of its modulus: deflection goes with one over it, a column's factor with it."""
    cold, warm = checked(), checked('conditions.temperature="40 degC"')
    factor = 0.88 - 0.18 * (40.0 - 37.8) / (60.0 - 37.8)
    for here, there in zip(of(cold, Quantity.DEFLECTION), of(warm, Quantity.DEFLECTION), strict=True):
        assert there.value.value == pytest.approx(here.value.value / factor, rel=0.02)
        assert there.value.value > 1.1 * here.value.value
    for here, there in zip(of(cold, Quantity.BUCKLING_FACTOR), of(warm, Quantity.BUCKLING_FACTOR), strict=True):
        assert there.value.value == pytest.approx(here.value.value * factor, rel=0.05)


@pytest.mark.parametrize(("temperature", "side"), [("-40 degC", "below 20 degC"), ("41 degC", "above 40 degC")])
def test_outside_the_table_no_strength_is_known(temperature, side):
    found = checked(f'conditions.temperature="{temperature}"')
    assert found.verdict is Verdict.UNDECIDED
    for outcome in of(found, Quantity.SAFETY_FACTOR):
        assert (outcome.verdict, outcome.value.unknowable) == (Verdict.UNDECIDED, True)
        assert side in told(outcome.reason)
        assert "temperature_factors" in told(outcome.reason)
    assert any(side in told(said) and "numbers are those of room temperature" in told(said) for said in found.warnings)


def test_what_needs_a_modulus_that_no_card_tells_is_undecided():
    """And the strength of links whose forces do not need it counts."""
    light = "load_cases.lift.forces.0.force=['0 N','-0.05 N']"
    found = checked('conditions.temperature="40 degC"', light, modulus=False)
    assert found.load_cases["lift"].large_displacement.state == "small"
    for quantity in (Quantity.DEFLECTION, Quantity.BUCKLING_FACTOR):
        assert of(found, quantity)
        for outcome in of(found, quantity):
            assert (outcome.verdict, outcome.value.unknowable) == (Verdict.UNDECIDED, True)
            assert "states no modulus_temperature_factors, so its modulus at 40 degC is not known" in told(
                outcome.reason
            )
    warm, cold = of(found, Quantity.SAFETY_FACTOR), of(checked(light), Quantity.SAFETY_FACTOR)
    assert [c.verdict for c in warm] == [c.verdict for c in cold]
    assert [c.verdict for c in warm][:2] == [Verdict.PASS] * 2
    assert [c.value.low for c in warm] == pytest.approx([0.7 * c.value.low for c in cold])
    bent = of(checked('conditions.temperature="40 degC"', modulus=False), Quantity.SAFETY_FACTOR)
    assert {c.verdict for c in bent} == {Verdict.UNDECIDED}, "forces are those of the deformed shape"


def test_no_strength_of_any_kind_is_known_without_a_table():
    found = checked('conditions.temperature="40 degC"', 'checks.bearing={type="bearing"}', strength=False)
    for outcome in of(found, Quantity.SAFETY_FACTOR):
        assert outcome.verdict is Verdict.UNDECIDED
        assert "states no temperature_factors" in told(outcome.reason)
    assert {str(c.subject)[:3] for c in of(found, Quantity.SAFETY_FACTOR)} == {"cra", "cou", "roc", "pin"}
    moved = [[c.verdict for c in of(one, Quantity.DEFLECTION)] for one in (found, checked())]
    assert moved[0] == moved[1]
    assert Verdict.PASS in moved[0]


def test_natural_frequencies_go_with_the_root_of_the_modulus():
    """And where no card tells the modulus, there are none."""
    entries = [*IN_PVC, 'motion={range=["40 deg","50 deg"],poses=3}', "load_cases.lift.forces=[]"]
    warm = edited(FOUR_BAR, [*entries, 'conditions.temperature="37.8 degC"'])
    low = [alula.frequencies(case, poses=2, count=1).result for case in (edited(FOUR_BAR, entries), warm)]
    first, second = (found.histories["lift"].frequencies[:, 0] for found in low)
    assert second == pytest.approx(first * 0.88**0.5, rel=1e-4), "its own weight tightens it a little"
    hot = edited(FOUR_BAR, [*entries, 'conditions.temperature="61 degC"'])
    with pytest.raises(CaseError, match=r"61 degC is above 60 degC, where the modulus_temperature_factors of"):
        alula.frequencies(hot)


@pytest.mark.parametrize(
    ("pin", "verdict"), [("steel-wire", Verdict.PASS), ("steel-s235", Verdict.PASS), ("pvc-u", Verdict.UNDECIDED)]
)
def test_pins_are_as_warm_as_links(pin, verdict):
    """Without a table, as of wire, a pin counts cold and the verdict says so; beyond one it is undecided."""
    entries = [f'joints.{j}.pin_material="{pin}"' for j in ("O2", "A", "B", "O4")]
    entries += ['parts.bar.material="steel-s235"', 'checks={pins={type="pins"}}', 'conditions.temperature="90 degC"']
    result = check_case(edited(FOUR_BAR, entries), fidelity="beam")
    assert {c.verdict for c in of(result, Quantity.SAFETY_FACTOR)} == {verdict}
    said = [told(one.what) for one in caveats(result.case) if one.topic is Topic.TEMPERATURE]
    assert said == ["thermal expansion", *(["pins at 90 degC"] if pin == "steel-wire" else [])]


def test_pins_between_layers_bend_by_their_modulus_at_the_temperature():
    stacked = [f"links.{link}.layer={i}" for i, link in enumerate(("base", "crank", "coupler", "rocker"))]
    entries = ['layer_spacing="5 mm"', *stacked, *(f'joints.{j}.pin_material="steel-s235"' for j in ("O2", "A", "B"))]
    soft = edited(FOUR_BAR, [*entries, 'parts.bar.material="steel-s235"', 'conditions.temperature="200 degC"'])
    frame = build_frame(soft, soft.solve_pose(), (), held=soft.pinned_drive)
    pins = [frame.model.elements[i] for i in frame.pin_beams.values() if not frame.model.elements[i].rigid]
    assert [e.young for e in pins[:2]] == pytest.approx([0.9 * 210e3] * 2)
