"""Values of a material that are unusual for what it is are named; usual ones draw no word."""

import pytest

from alula.geometry.materials.material import Material, library
from alula.geometry.materials.plausible import class_of, untold, unusual

# Published typical values, each from a maker's or standard's sheet: kg/m3, GPa, MPa yield, MPa ultimate.
USUAL = {
    "7075-T6": ("Aluminium 7075-T6", 2810, 71.7, 503, 572),
    "al-6061": ("Aluminum 6061-T6", 2700, 68.9, 276, 310),
    "s235": ("Structural steel S235", 7850, 210, 235, 360),
    "1.4310": ("Stainless spring steel", 7900, 185, 1300, 1500),
    "ti": ("Titanium Ti-6Al-4V", 4430, 113.8, 880, 950),
    "cuzn39": ("Brass CuZn39Pb3", 8470, 97, 250, 430),
    "az31": ("Magnesium AZ31B", 1770, 45, 200, 260),
    "pa12": ("Polyamide 12, sintered", 930, 1.65, 40, 48),
    "pom-c": ("Acetal copolymer", 1410, 2.8, 65, 67),
    "pa-gf": ("Nylon 66 with 30 % glass", 1370, 9.0, 120, 180),
    "cf-tube": ("Carbon fibre tube", 1550, 130, 600, 1200),
    "spruce": ("Spruce along the grain", 450, 11, 40, 80),
    "balsa": ("Balsa", 160, 3.4, 10, 15),
    "alumina": ("Al2O3 ceramic", 3900, 380, 300, 350),
    "al2o3": ("Aluminium oxide, 96 %, sintered", 3720, 320, 200, 200),
    "sic": ("Silicon carbide", 3150, 410, 380, 380),
    "cual10ni5fe4": ("Aluminium bronze", 7600, 120, 270, 600),
    "az91": ("Magnesium aluminium zinc AZ91D", 1810, 45, 160, 230),
    "almg3": ("Aluminium magnesium alloy AlMg3", 2660, 70, 80, 190),
    "bronzefill": ("PLA, filled with bronze", 3900, 2.5, 20, 25),
    "alfoam": ("Aluminium foam", 500, 5, 5, 5),
    "glass": ("Soda-lime glass", 2500, 70, 30, 40),
    "tungsten": ("W", 19300, 400, 900, 1000),
    "rubber": ("Silicone", 1150, 0.005, 4, 8),
}


def card(title, density, modulus, yields, breaks, across=None):
    return Material.model_construct(
        title=title,
        density=density * 1e-12,
        youngs_modulus=modulus * 1e3,
        yield_strength=yields,
        ultimate_strength=breaks,
        strength_across_layers=across,
    )


@pytest.mark.parametrize("name", USUAL)
def test_usual_values_draw_no_word(name):
    assert unusual(name, card(*USUAL[name])) == ()


def test_nothing_of_the_library_is_unusual():
    assert [said for one in library().items() for said in (*unusual(*one), *untold(*one))] == []


@pytest.mark.parametrize("name", ["7075-T6", "s235", "ti", "cuzn39", "az31", "pom-c", "alumina", "tungsten"])
@pytest.mark.parametrize(("place", "entry"), [(1, "density"), (2, "youngs_modulus")])
@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_a_slip_of_a_unit_is_named(name, place, entry, factor):
    values = [v * factor if i == place else v for i, v in enumerate(USUAL[name][1:], start=1)]
    assert any(said.startswith(f"materials.{name}.") for said in unusual(name, card(USUAL[name][0], *values)))


def test_a_sentence_names_entry_value_and_the_usual_range():
    [said] = unusual("al", card("aluminium 7075", 2810, 0.0717, 503, 572))
    assert said == (
        "materials.al.youngs_modulus is 0.0717 GPa, but an aluminium alloy usually has 65 to 85 GPa; "
        "check the value and its unit"
    )


def test_a_strength_ten_times_too_high_for_its_plastic():
    """The slip of the owl wing's source: 414 MPa, where PVC has 41.4."""
    [said] = unusual("pvc", card("Rigid PVC", 1450, 2.4, 414, None))
    assert said.startswith("materials.pvc.yield_strength is 414 MPa, but a plastic usually has 5 to 200 MPa")


def test_a_slip_in_the_strength_across_layers():
    [said] = unusual("pla", card("PLA", 1240, 2.5, None, 33, 1200))
    assert said.startswith("materials.pla.strength_across_layers is 1200 MPa, but a plastic usually has 5 to 200 MPa")


@pytest.mark.parametrize(
    ("name", "title", "told"),
    [
        ("x", "carbon steel", "steel"),
        ("x", "nylon, glass filled", "a filled or fibre-reinforced plastic"),
        ("x", "nylon with glass", "a filled or fibre-reinforced plastic"),
        ("x", "aluminium oxide", "a ceramic"),
        ("x", "aluminium bronze", "a bronze or brass"),
        ("pvc-bush", "replaces one of steel", "a plastic"),
        ("pla-fdm", "", "a plastic"),
        ("x", "plate of something", "a material lighter than 2300 kg/m³"),  # pla is no word of it
    ],
)
def test_the_class_by_name(name, title, told):
    assert class_of(name, card(title, 1200, 2.0, 30, 40)).title == told
