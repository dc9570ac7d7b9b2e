"""A check of links in layers: its bands, what narrows them, what its report says."""

import re
from functools import cache

import pytest
from edited_cases import edited
from tilting_pins import ALUMINIUM, four_bar
from tilting_pins import checked as four_bar_case
from told import not_covered

from alula.fea.check.run import check_case
from alula.fea.common.source import COUPLES
from alula.fea.outcomes.result import CheckResult
from alula.reports.sentences import told as in_words

LINKS = ("AG", "GF", "AE", "CF", "CH", "ED")
OFF = ['layer_spacing="7.5 mm"', 'large_displacement="off"']
LAYERS = [*OFF, *(f"links.{link}.layer={layer}" for link, layer in zip(LINKS, (-1, 0, 0, 1, 0, 1), strict=True))]
FLAT = [*OFF, *(f"links.{link}.layer=0" for link in LINKS), 'layer_spacing="0 mm"']
IN = ("AG", "CF", "CF", "ED", "ED", "CF", "AG")
TIGHT = [f'joints.{joint}.tight_in="{link}"' for joint, link in zip("ABCDEFG", IN, strict=True)]


@cache
def checked(*further: str) -> CheckResult:
    return check_case(
        edited("owl-wing-static", [*LAYERS, *further], bare=True), name="owl-wing-static", fidelity="beam"
    )


def test_bands_hold_how_pins_share_the_couples() -> None:
    links = checked().load_cases["weight"].links
    assert set(COUPLES) <= set(links["GF"].safety_factor.sources)
    assert links["GF"].safety_factor.low < 0.5 * links["GF"].safety_factor.value


def test_a_pin_that_is_stated_tight_in_one_link_narrows_them() -> None:
    """GF's pins are tight in its neighbours, so that it bears little of their couples."""
    free, tight = (checked(*more).load_cases["weight"].links["GF"].safety_factor for more in ((), tuple(TIGHT)))
    assert tight.low > 1.5 * free.low
    assert tight.high / tight.low < free.high / free.low


def test_the_plane_has_the_forces_that_it_has_without_layers() -> None:
    flat = check_case(edited("owl-wing-static", FLAT, bare=True), name="owl-wing-static", fidelity="beam")
    one, other = (result.load_cases["weight"].forces.reactions for result in (flat, checked()))
    assert one.drive_torque == pytest.approx(other.drive_torque, rel=1e-9)
    for name, joint in one.joints.items():
        assert joint.wrench[:2] == pytest.approx(other.joints[name].wrench[:2], rel=1e-9, abs=1e-12)
    assert all(not joint.wrench[2:5].any() for joint in one.joints.values())


def test_what_passes_all_the_same_is_told_no_fit() -> None:
    """Which fits would decide an open check is tried in ``tests/validation/test_pins_in_holes.py``."""
    assert not any("stress of GF" in in_words(text) for text in checked().warnings)
    assert dict(not_covered(checked())).keys() >= {"Layers"}


def test_what_would_narrow_them_is_said_once_of_each_link() -> None:
    """Of two load cases together, not once for each; of the four-bar two links are asked for.

    No fit is recommended where none decides: the limit lies near the factor of the crank, 6.99, and in the band of the
    coupler, 1.22 to 57.
    """
    checks = {"s": {"type": "safety-factor", "minimum": 7.0, "links": ["crank", "coupler"]}}
    data = four_bar(tight={}, checks=checks, large_displacement="off")
    data["materials"]["m"] |= ALUMINIUM
    data["load_cases"]["again"] = data["load_cases"]["l"]
    result = check_case(four_bar_case(data), fidelity="beam")
    told = [text for text in map(in_words, result.warnings) if "how pins share the couples" in text]
    links = [link for text in told for link in re.findall(r"stress of (\S+) ", text)]
    assert links == ["crank", "coupler"]
    assert all(text.startswith("load cases l, again: ") for text in told)
    for text, joint in zip(told, ("O2", "B"), strict=True):
        assert text.endswith(
            f"no fit of its pins alone would decide its check; that of joint {joint} narrows its band most"
        )


def test_who_has_stated_all_fits_is_not_told_that_none_decides() -> None:
    """Nothing is tried there: the sentence said that no fit would decide, where narrower ones may."""
    checks = {"s": {"type": "safety-factor", "minimum": 7.0, "links": ["crank", "coupler"]}}
    data = four_bar(play="0.1 mm", checks=checks, large_displacement="off")
    data["materials"]["m"] |= ALUMINIUM
    for joint in data["joints"].values():
        joint["clearance"] = ["0.05 mm", "0.15 mm"]
    result = check_case(four_bar_case(data), fidelity="beam")
    told = [text for text in map(in_words, result.warnings) if "how pins share the couples" in text]
    assert told
    assert all(text.endswith("the fits of its pins are stated; narrower ones leave less of that") for text in told)
