"""What a card may state of notches, and what follows from it."""

import pytest
from pydantic import ValidationError

from alula.geometry.materials.brittle_notch import notch_strengths
from alula.geometry.materials.material import Material, library
from alula.loads.records.conditions import Conditions, at_temperature

CARD = {
    "title": "Resin",
    "density": "1150 kg/m^3",
    "youngs_modulus": "2 GPa",
    "poissons_ratio": 0.38,
    "ultimate_strength": "40 MPa",
    "strength": "ultimate",
    "sources": {},
    "status": {},
}
TOUGH = {"inherent_strength": "50 MPa", "fracture_toughness": "1 MPa*m^0.5"}


def card(**entries):
    return Material.model_validate(CARD | entries)


def test_the_critical_distance_follows_from_the_toughness():
    stated, weakest, strongest = notch_strengths(card(**TOUGH))
    assert stated == weakest == strongest
    assert stated.distance == pytest.approx(1000.0 / 50.0**2 / 3.14159265)
    assert (stated.inherent, stated.ultimate) == (50.0, 40.0)


def test_a_stated_distance_stands():
    both = card(**TOUGH, critical_distance="0.13 mm", critical_distance_range=["0.1 mm", "0.2 mm"])
    assert [one.distance for one in notch_strengths(both)] == [0.13, 0.1, 0.2]


def test_ranges_make_the_weakest_and_the_strongest():
    found = notch_strengths(
        card(
            **TOUGH,
            strength_range=["30 MPa", "60 MPa"],
            inherent_strength_range=["45 MPa", "60 MPa"],
            fracture_toughness_range=["0.9 MPa*m^0.5", "1.2 MPa*m^0.5"],
        )
    )
    assert [(one.inherent, one.ultimate) for one in found] == [(50.0, 40.0), (45.0, 30.0), (60.0, 60.0)]
    assert [one.distance for one in found[1:]] == pytest.approx(
        [810.0 / 45.0**2 / 3.14159265, 1440.0 / 60.0**2 / 3.14159265]
    )


@pytest.mark.parametrize("length", [{"fracture_toughness": "1 MPa*m^0.5"}, {"critical_distance": "0.127 mm"}])
def test_without_a_range_the_inherent_strength_scatters_as_the_tensile_one(length):
    spread = {"inherent_strength": "50 MPa", "strength_range": ["20 MPa", "60 MPa"], **length}
    found = notch_strengths(card(**spread))
    assert [(one.inherent, one.ultimate) for one in found] == [(50.0, 40.0), (25.0, 20.0), (75.0, 60.0)]
    if "fracture_toughness" in length:
        assert found[1].distance == pytest.approx(4.0 * found[0].distance)
    else:
        assert {one.distance for one in found} == {0.127}


@pytest.mark.parametrize(
    ("entries", "says"),
    [
        ({"inherent_strength": "50 MPa"}, "needs critical_distance or fracture_toughness"),
        ({"critical_distance": "0.2 mm"}, "critical_distance needs inherent_strength"),
        ({**TOUGH, "inherent_strength": "39 MPa"}, "below ultimate_strength"),
        ({**TOUGH, "critical_distance": "0.15 mm"}, "0.127 mm follow"),
        ({"weibull_modulus": 10.0}, "need each other"),
        ({"fracture_toughness_range": ["1 MPa*m^0.5", "2 MPa*m^0.5"]}, "needs fracture_toughness"),
        ({**TOUGH, "inherent_strength_range": ["51 MPa", "60 MPa"]}, "leaves out inherent_strength"),
        ({**TOUGH, "strength": "yield", "yield_strength": "30 MPa"}, "of a brittle material"),
    ],
)
def test_what_does_not_fit_is_refused(entries, says):
    with pytest.raises(ValidationError, match=says):
        card(**entries)


def test_warmth_leaves_the_critical_distance():
    warm = at_temperature(card(**TOUGH, temperature_factors=[["40 degC", 0.8]]), Conditions(temperature="40 degC"))
    [cold, *_], [found, *_] = notch_strengths(card(**TOUGH)), notch_strengths(warm)
    assert found.distance == pytest.approx(cold.distance)
    assert (found.inherent, found.ultimate) == (40.0, 32.0)


def test_the_library_states_no_inherent_strength_above_a_tensile_one():
    """None that could be read: so far notches are judged on the safe side of it."""
    known = {name: one for name, one in library().items() if one.inherent_strength is not None}
    assert set(known) == {"resin-405nm", "pla-fdm-xy"}
    for one in known.values():
        assert one.inherent_strength == one.ultimate_strength
        assert one.status["inherent_strength"] == "assumed"
        assert 0.2 < notch_strengths(one)[0].distance < 0.35
