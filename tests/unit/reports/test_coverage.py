"""What a report says that it does not cover follows from what ran and from what the case states."""

import tomllib
from dataclasses import replace
from importlib.resources import files

import pytest
import solved
from told import flat, not_covered, printed, render

from alula.fea.common.band import Band
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, Quantity
from alula.loads.case.case_file import read_text, validate


def told(result):
    return dict(not_covered(result))


@pytest.fixture
def wing():
    return solved.by_hand("owl-wing-static")


def test_the_error_of_the_mesh_is_said_of_the_links_that_have_one(result):
    """The report once said of every case that the error of the mesh is in no band."""
    text = told(result)["Bands"]
    assert text.startswith("The discretisation error in the bands of GF is an estimate")
    assert "AE, CF, CH and ED have no band for model error (nothing)" in text
    assert "is not in the bands" not in render(result, {})


def test_links_by_calibrated_hand_calculation_have_the_bands_of_other_solids(wing):
    assert told(wing)["Bands"].startswith("GF, AE, CF, CH and ED were not meshed: the bands come from solid models")


def test_buckling_is_not_called_left_out_where_it_is_judged(wing, result):
    judged = {
        c.subject for case in wing.load_cases.values() for c in case.checks if c.quantity is Quantity.BUCKLING_FACTOR
    }
    assert {subject.name for subject in judged - {LINKAGE}} == {"GF", "AE", "CF", "CH"}
    assert told(wing)["Buckling"].startswith("GF, AE, CF and CH were checked as straight elastic columns")
    assert told(result)["Buckling"].startswith("No link is in compression")  # its checks are of strength alone


@pytest.mark.parametrize(
    ("ranged", "loads", "words"),
    [
        (False, False, "scatter of strength, modulus and the loads, for which the case states no range"),
        (True, False, "scatter of the loads, for which the case states no range"),
        (False, True, "scatter of strength and modulus, for which the case states no range"),
        (True, True, "notches and scatter of dimensions. Stated ranges are part of the bands."),
    ],
)
def test_scatter_that_is_stated_is_not_called_left_out(wing, ranged, loads, words):
    tree = tomllib.loads(read_text("owl-wing-static")[0])
    if ranged:
        cards = tomllib.loads(files("alula.geometry.materials").joinpath("materials.toml").read_text(encoding="utf-8"))
        [name] = {part["material"] for part in tree["parts"].values()}
        ranges = {"strength_range": ["40 MPa", "43 MPa"], "youngs_modulus_range": ["2 GPa", "3 GPa"]}
        tree["materials"] = {"ranged": cards[name] | ranges}
        for part in tree["parts"].values():
            part["material"] = "ranged"
    if loads:
        tree["load_cases"]["weight"]["scatter"] = "20 %"
    assert words in told(replace(wing, case=validate(tree)))["Manufacture and scatter"]


def test_a_load_that_turns_with_its_link_is_told_apart_from_the_deformation(wing):
    """The case file says that such a load turns with its link, the report that loads keep their direction."""
    assert wing.load_cases["weight"].large_displacement.followed
    assert "link axes" not in told(wing)["Large displacements"]
    tree = tomllib.loads(read_text("owl-wing-static")[0])
    tree["load_cases"]["weight"]["forces"][0]["axes"] = "link"
    turned = replace(wing, case=validate(tree))
    assert told(turned)["Large displacements"].endswith(
        "a load in link axes turns with the pose of its link, but not with the deformation."
    )


def test_conditions_that_are_stated_are_told(wing):
    assert "the case states no conditions" in told(wing)["Creep, temperature, moisture, ageing"]
    warm = wing.case.conditions.model_copy(update={"temperature": 40.0})
    warmed = replace(wing, case=wing.case.model_copy(update={"conditions": warm}))
    assert (
        "strengths and moduli are short-term values at the stated temperature"
        in told(warmed)["Creep, temperature, moisture, ageing"]
    )


def test_pins_that_were_checked_are_named(wing, result):
    assert "Checked pins: A, B, C, D, E, F and G." in told(wing)["Pins and contact"]
    bare = {name: replace(case, pins={}) for name, case in result.load_cases.items()}
    assert "No pin was checked." in told(replace(result, load_cases=bare))["Pins and contact"]


def headings(page):
    return [part.split("</th>")[0] for part in page.split('<thead><tr><th scope="col">')[1:]]


def test_a_link_is_headed_by_the_model_that_gave_its_numbers(result):
    """The numbers of another model once stood under "Hand calculation"."""
    case = result.load_cases["weight"]
    page = render(replace(result, load_cases={"weight": replace(case, links={"GF": case.links["GF"]})}), {})
    assert "Solid model" in headings(page)
    assert "Hand calculation" not in headings(page)


def test_the_stress_that_decides_is_shown_and_named(result):
    """The table of a brittle link once gave von Mises stress beside a factor from the principal one."""
    case = result.load_cases["weight"]
    link = replace(
        case.links["GF"],
        brittle=True,
        von_mises_max=Band.exact(206.4),
        principal_max=Band.exact(215.9),
        safety_factor=Band.exact(215.9).inverse(500.0),
    )
    page = " ".join(render(replace(result, load_cases={"weight": replace(case, links={"GF": link})}), {}).split())
    assert '<td>largest principal stress (decides n) [MPa]</td><td class="num">216</td>' in page
    assert "The largest principal stress is at x" in page


def test_console_and_page_give_the_same_difference_of_hand_and_solid(result):
    case = result.load_cases["weight"]
    near = tuple(replace(c, difference=0.0007) for c in case.links["GF"].comparisons)
    link = replace(case.links["GF"], comparisons=near)
    told = replace(result, load_cases={"weight": replace(case, links={"GF": link})})
    assert "They agree within 0.1 %." in flat(printed(told))
    assert "They agree within 0.1 %." in render(told, {})


def test_kinds_of_sources_are_told_without_particulars(result):
    case = result.load_cases["weight"]
    kinds = (SourceKind.FLYWHEEL, SourceKind.DISCRETISATION)
    sources = tuple(Source(kind=kind, detail="three meshes (of 9)") for kind in kinds)
    band = Band(value=2.0, low=1.0, high=3.0, sources=sources)
    checks = tuple(replace(check, value=band) for check in case.checks)
    page = render(replace(result, load_cases={"weight": replace(case, checks=checks)}), {})
    assert ": energy that a flywheel stores and discretisation." in page


def test_a_reason_for_no_band_begins_as_it_was_written(result):
    case = result.load_cases["weight"]
    checks = tuple(replace(check, value=Band.exact(2.0, "GF has no eyes")) for check in case.checks)
    page = render(replace(result, load_cases={"weight": replace(case, checks=checks)}), {})
    assert ": nothing (GF has no eyes)." in page


def test_shafts_slots_and_wings_are_said_where_the_case_has_them():
    ornithopter, starter = solved.by_hand("ornithopter"), solved.by_hand("four-bar-synthesis")
    found = told(ornithopter)
    drive = ornithopter.case.pinned_drive
    assert drive is not None
    assert f"the pins of {drive.joint} and the links that turn with them" in found["Torque at shafts"]
    assert found["Contact in slots"].startswith("Pins in slots at guide, slot-right and slot-left touch a flank")
    wings = list(dict.fromkeys(one.link for one in ornithopter.case.wings))
    assert len(wings) == 2
    assert all(link in found["Wings"] for link in wings)
    assert told(starter).keys() & {"Contact in slots", "Wings"} == set()
    assert "Torque at shafts" in told(starter)


def test_layers_say_how_wide_holes_are_taken_to_be():
    layers = told(solved.by_hand("slider-crank"))["Layers"]
    assert layers.startswith("Pins between layers are beams that touch their holes at the rims. Holes are as wide as")
    assert "how far running pins tilt" in layers
