import tomllib
from importlib.resources import files
from typing import Any

import pytest
from pydantic import ValidationError

from alula.geometry.materials.material import Fatigue, Material, library
from alula.geometry.materials.temperature import covered, factor_at

KNOWN = ("density", "youngs_modulus", "poissons_ratio", "yield_strength", "ultimate_strength")
CARD: dict[str, Any] = {
    "title": "a plastic",
    "density": "1450 kg/m^3",
    "youngs_modulus": "2.4 GPa",
    "poissons_ratio": 0.38,
    "yield_strength": "41.4 MPa",
    "ultimate_strength": "52 MPa",
    "strength": "yield",
    "sources": dict.fromkeys(KNOWN, "a book"),
    "status": dict.fromkeys(KNOWN, "handbook"),
}


def test_a_card_in_alulas_units() -> None:
    card = Material.model_validate(CARD)
    assert card.density == pytest.approx(1.45e-9)
    assert card.youngs_modulus == 2400.0
    assert card.allowable == 41.4
    assert not card.brittle
    assert card.shear_modulus == pytest.approx(2400 / 2.76)


def test_a_brittle_card_uses_the_ultimate_strength() -> None:
    card = Material.model_validate({k: v for k, v in CARD.items() if k != "yield_strength"} | {"strength": "ultimate"})
    assert card.allowable == 52.0
    assert card.brittle


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"yield_strength": "60 MPa"}, "yield_strength 60 MPa is above ultimate_strength 52 MPa.*check the units"),
        ({"yield_strength": "414 MPa"}, "above ultimate_strength"),  # the source's slip: ten times too high
        ({"yield_strength": None}, "strength = .yield. needs yield_strength; add it"),
        ({"strength": "ultimate", "ultimate_strength": None}, "strength = .ultimate. needs ultimate_strength"),
        ({"poissons_ratio": 0.5}, "less than 0.5"),
        ({"poissons_ratio": -1.0}, "greater than -1"),
        ({"poissons_ratio": float("nan")}, "finite"),
        ({"density": "0 kg/m^3"}, "greater than zero"),
        ({"density": "1450"}, "needs its unit"),
        ({"density": "1450 MPa"}, "not a unit of density"),
        ({"youngs_modulus": "-1 GPa"}, "greater than zero"),
        ({"youngs_modulus_range": ["3 GPa", "2 GPa"]}, "must not exceed the second; swap"),
        ({"strength_range": ["0 MPa", "2 MPa"]}, "greater than zero"),
        ({"strength_range": ["1 MPa"]}, "Field required"),
        ({"temperature_factors": [[23, 1.0]]}, "needs its unit"),
        ({"temperature_factors": [["30 degC", 0.9], ["23 degC", 1.0]]}, "rise in temperature; sort"),
        ({"temperature_factors": [["30 degC", 0.9], ["30 degC", 1.0]]}, "rise in temperature"),
        ({"temperature_factors": [["30 degC", 0.0]]}, "greater than 0"),
        # values of which one contradicts another
        ({"temperature_factors": [["23 degC", 1.0], ["500 degC", 3.0]]}, "grow from 1 at 23 degC to 3 at 500 degC"),
        ({"temperature_factors": [["20 degC", 0.5], ["100 degC", 0.4]]}, "are 0.5 at 20 degC, where"),
        ({"modulus_temperature_factors": [["0 degC", 1.0], ["23 degC", 1.1]]}, "are 1.1 at 23 degC, where"),
        ({"temperature_factors": [["-20 degC", 1.3], ["60 degC", 1.1]]}, "grow from 1 at 23 degC to 1.1 at 60 degC"),
        ({"temperature_factors": [["40 degC", 0.7], ["60 degC", 0.8]]}, "grow from 0.7 at 40 degC to 0.8 at 60 degC"),
        ({"sustained_stress": "60 MPa"}, "sustained_stress is 60 MPa, above yield_strength, 41.4 MPa"),
        ({"sustained_modulus": "2.5 GPa"}, "sustained_modulus is 2500 MPa, above youngs_modulus, 2400 MPa"),
        ({"youngs_modulus_range": ["2.5 GPa", "3 GPa"]}, "leaves out youngs_modulus, 2400 MPa; correct one"),
        ({"strength_range": ["30 MPa", "41 MPa"]}, "leaves out yield_strength, 41.4 MPa"),
        ({"strength": "ultimate", "strength_range": ["30 MPa", "50 MPa"]}, "leaves out ultimate_strength, 52 MPa"),
        ({"sources": {"densty": "a book"}}, "'densty'.*no such entry; correct"),
        ({"status": {"densty": "handbook"}}, "'densty'.*no such entry"),
        ({"status": {"density": "guessed"}}, "'measured', 'datasheet', 'handbook' or 'assumed'"),
        ({"minimum_safety_factor": 0.0}, "greater than 0"),
        ({"colour": "red"}, "Extra inputs"),
        ({"title": "\x1b[2J"}, "control characters"),
    ],
)
def test_cards_that_cannot_be(change: dict[str, Any], words: str) -> None:
    with pytest.raises(ValidationError, match=words):
        Material.model_validate(CARD | change)


def test_yield_at_the_ultimate_strength_is_allowed() -> None:
    assert Material.model_validate(CARD | {"yield_strength": "52 MPa"}).allowable == 52.0


def test_temperatures_with_their_unit() -> None:
    card = Material.model_validate(CARD | {"temperature_factors": [["23 degC", 1.0], ["313.15 K", 0.7]]})
    assert card.temperature_factors[1] == (pytest.approx(40.0), 0.7)


def test_fatigue() -> None:
    point = Fatigue.model_validate({"stress": "10.9 MPa", "cycles": 1e6, "source": "x"})
    assert (point.stress, point.stress_ratio, point.exponent) == (10.9, 0.0, None)
    for change in ({"cycles": 0}, {"stress": "0 MPa"}, {"stress_ratio": 1.0}, {"exponent": -1.0}):
        with pytest.raises(ValidationError):
            Fatigue.model_validate({"stress": "10.9 MPa", "cycles": 1e6, "source": "x"} | change)


@pytest.mark.parametrize("exponent", [-0.085, 0.085, 2000.0])
def test_basquins_slope_in_place_of_the_exponent_is_refused(exponent: float) -> None:
    with pytest.raises(ValidationError, match="state 1/b"):
        Fatigue.model_validate({"stress": "10.9 MPa", "cycles": 1e6, "source": "x", "exponent": exponent})


def test_the_pvc_of_the_owl_wing() -> None:
    """Paredes (2018), table 1: 1450 kg/m³, 2.4 GPa, 52 MPa, 4.14e7 Pa; ν is assumed."""
    card = library()["pvc-paredes-2018"]
    assert card.density == pytest.approx(1.45e-9, rel=1e-12)
    assert (card.youngs_modulus, card.yield_strength, card.ultimate_strength) == (2400.0, 41.4, 52.0)
    assert card.status["poissons_ratio"] == "assumed"


def test_every_value_of_the_library_has_a_source_and_a_status() -> None:
    cards = tomllib.loads(files("alula.geometry.materials").joinpath("materials.toml").read_text(encoding="utf-8"))
    assert cards.keys() == library().keys()
    assert len(cards) >= 5
    own = {"title", "strength", "sources", "status", "fatigue", "fatigue_across_layers"}
    for name, card in cards.items():
        for entry in card.keys() - own:
            # A range stands beside its value, and a limit is a choice: both carry a source, not always a status.
            where = entry.removesuffix("_range")
            assert {entry, where} & card["sources"].keys() or entry.endswith(("_range", "_tested")), (name, entry)
        for entry in ("density", "youngs_modulus", "poissons_ratio"):
            assert entry in card["status"], (name, entry)
        low, high = library()[name].youngs_modulus_range or (0.0, 1e9)
        assert low <= library()[name].youngs_modulus <= high
        low, high = library()[name].strength_range or (0.0, 1e9)
        assert low <= library()[name].allowable <= high


def test_cards_are_frozen() -> None:
    with pytest.raises(ValidationError, match="frozen"):
        Material.model_validate(CARD).density = 1.0


@pytest.mark.parametrize(
    "title",
    ["Carbon fibre plate, 2 mm", "CFRP", "carbon-plate", "carbonfiber tube", "Carbon", "High-modulus carbon fibre rod",
     "Carbon/epoxy laminate", "GFRP sheet"],
)  # fmt: skip
def test_a_laminate_is_refused(title: str) -> None:
    with pytest.raises(ValidationError, match=r"is a laminate of fibres.*choose an isotropic material"):
        Material.model_validate(CARD | {"title": title})


@pytest.mark.parametrize("title", ["Spruce", "Birch plywood, 4 mm", "balsa-wood", "Wooden rod"])
def test_wood_is_refused(title: str) -> None:
    with pytest.raises(ValidationError, match=r"is wood: its stiffness and strength depend on the direction"):
        Material.model_validate(CARD | {"title": title})


@pytest.mark.parametrize("factor", [1.0, 1.3])
def test_in_the_cold_a_strength_may_be_larger(factor: float) -> None:
    factors = [["-40 degC", factor], ["23 degC", 1.0], ["40 degC", 0.7]]
    assert Material.model_validate(CARD | {"temperature_factors": factors}).temperature_factors[0] == (-40.0, factor)


@pytest.mark.parametrize(
    "title",
    ["PLA, wood-filled", "Carbon steel plate", "steel, 0.4 % carbon, tube", "high-carbon strip", "Polycarbonate sheet",
     "Nylon with 15 % carbon fibre", "PLA, carbon-fibre filled", "ABS, carbon black", "Nylon 66 with 30 % glass",
     "Graphite, carbon, isotropic plate"],
)  # fmt: skip
def test_carbon_alone_is_no_laminate(title: str) -> None:
    assert Material.model_validate(CARD | {"title": title}).title == title


LAYERS = {"strength_across_layers": "12 MPa", "shear_strength_between_layers": "6 MPa"}


def test_strengths_of_layers_have_their_sources_and_ranges() -> None:
    told = {k: CARD[k] | dict.fromkeys(LAYERS, v) for k, v in (("sources", "a test"), ("status", "measured"))}
    card = Material.model_validate(CARD | LAYERS | told)
    assert (card.strength_across_layers, card.shear_strength_between_layers) == (12.0, 6.0)
    assert Material.model_validate(CARD | LAYERS).untold == {"sources": tuple(LAYERS), "status": tuple(LAYERS)}
    with pytest.raises(ValidationError, match="shear_strength_between_layers needs strength_across_layers"):
        Material.model_validate(CARD | told | {"shear_strength_between_layers": "6 MPa"})
    with pytest.raises(ValidationError, match="strength_across_layers_range needs strength_across_layers"):
        Material.model_validate(CARD | {"strength_across_layers_range": ["1 MPa", "2 MPa"]})


PUBLISHED = {  # density, E, strengths: kg/m3, GPa, MPa, MPa
    "aluminium-6061-t6": (2700, 68.9, 240, 260),
    "aluminium-7075-t6": (2810, 71.7, 460, 525),
    "steel-s235": (7850, 210, 235, 360),
    "steel-304": (8000, 193, 205, 515),
    "brass-cuzn39pb3": (8470, 96, 200, 430),
    "pa12-sintered": (930, 1.65, None, 43),
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_values_reach_the_library_in_its_units(name: str) -> None:
    """A slip of a unit or digit in a card would move these numbers, written down from the sources by themselves."""
    card, (density, modulus, yields, breaks) = library()[name], PUBLISHED[name]
    assert card.density == pytest.approx(density * 1e-12)
    assert card.youngs_modulus == pytest.approx(modulus * 1e3)
    assert (card.yield_strength, card.ultimate_strength) == (yields, breaks)


def test_room_temperature_has_the_stated_values_whatever_the_table_leaves_out() -> None:
    """A table from frost to heat without a point between them; one with a point there keeps it."""
    wide = ((-20.0, 1.2), (60.0, 0.5))
    assert [factor_at(wide, at) for at in (20.0, 21.0, 23.0)] == [1.0] * 3
    assert factor_at(wide, 0.0) == pytest.approx(1.1)
    assert factor_at(wide, 41.5) == pytest.approx(0.75)
    assert covered(wide) == (-20.0, 60.0)
    assert factor_at(((0.0, 1.1), (22.0, 1.0), (60.0, 0.5)), 11.0) == pytest.approx(1.05)
