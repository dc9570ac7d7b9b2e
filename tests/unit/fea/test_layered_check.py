"""A check of links in layers: its bands, what narrows them, what its report says."""

import re
from functools import cache

import pytest
from edited_cases import edited
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

GF_ALONE = 'checks.strength.links=["GF"]'
"""Fits are tried for every link that a check leaves open, by checks of their own."""


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


def test_the_report_says_which_fits_would_decide_an_open_check() -> None:
    """A limit that pins of which nothing is stated straddle, and running ones keep; what is told does decide it."""
    fits = [
        f'joints.{name}.fit={{ {a} = "running", {b} = "running" }}'
        for name, a, b in (("F", "GF", "CF"), ("G", "AG", "GF"))
    ]
    free, held = (checked(*more).load_cases["weight"].links["GF"].safety_factor for more in ((), tuple(fits)))
    asked = GF_ALONE, f"checks.strength.minimum={(free.low + held.low) / 2.0}"
    [text] = [text for text in map(in_words, checked(*asked).warnings) if "stress of GF" in text]
    [joints] = re.findall(r'fit = "running" of joints (.*) would decide its check$', text)
    stated = [fit for fit in fits if fit.split(".")[1] in joints.split(", ")]
    assert stated
    assert not any("stress of GF" in in_words(text) for text in checked(*asked, *stated).warnings)
    assert not any("stress of GF" in in_words(text) for text in checked().warnings)  # where it passes all the same
    assert dict(not_covered(checked())).keys() >= {"Layers"}


def test_what_would_narrow_them_is_said_once_of_each_link() -> None:
    """Of two load cases together, not once for each; two links are asked for.

    No fit is recommended where none decides: the limit lies in the band of GF's hand calculation itself.
    """
    value = checked().load_cases["weight"].links["GF"].safety_factor.value
    asked = 'checks.strength.links=["GF", "AE"]', f"checks.strength.minimum={value}"
    case = edited("owl-wing-static", [*LAYERS, *asked], bare=True)
    two = dict.fromkeys(("weight", "again"), case.load_cases["weight"])
    result = check_case(case.model_copy(update={"load_cases": two}), name="owl-wing-static", fidelity="beam")
    told = [text for text in map(in_words, result.warnings) if "how pins share the couples" in text]
    links = [link for text in told for link in re.findall(r"stress of (\S+) ", text)]
    assert "GF" in links
    assert len(links) == len(set(links))
    assert all(text.startswith("load cases weight, again: ") for text in told)
    [text] = [text for text in told if "stress of GF" in text]
    assert re.search(
        r"no fit of its pins alone would decide its check; that of joint [FG] narrows its band most$", text
    )
