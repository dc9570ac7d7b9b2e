"""What would change a verdict, in sentences, on the page, in the console and in result.json."""

import io
import shlex
from dataclasses import replace

import pytest
from html_pages import Page
from rich.console import Console
from told import print_result, render, result_record

from alula.fea.common.band import Band
from alula.fea.common.change import MaterialChange, SizeRange, VerdictChange
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, Quantity, Verdict
from alula.loads.text.revisable import Origin
from alula.reports.check.changes import change_sentences, change_title, size_command

STRONGER = MaterialChange(what="yield strength", material="pvc-paredes-2018", stated=41.4, needed=45.2001)


def told(result, change):
    return " ".join(change_sentences(change, result))


@pytest.fixture(scope="module")
def check(result):
    return next(c for c in result.load_cases["weight"].checks if c.quantity is Quantity.SAFETY_FACTOR)


def test_factors_are_rounded_to_the_safe_side(result, check):
    failed = replace(check, verdict=Verdict.FAIL)
    text = told(result, VerdictChange(check=failed, load=0.82759, material=STRONGER))
    assert "It passes with 0.827 times all loads." in text
    faster = told(result, VerdictChange(check=failed, load=0.82759, faster=True))
    assert "It passes with 0.827 times all loads, maybe with more." in faster
    assert "A yield strength of 45.3 MPa in place of 41.4 MPa (Rigid PVC" in text
    assert text.endswith("would do.")
    passed = replace(check, verdict=Verdict.PASS)
    assert "until all loads are less than 1.06 times as large" in told(
        result, VerdictChange(check=passed, load=1.069, faster=True)
    )
    assert "enough up to 2.47 times the load, all loads may grow to 3.50 times" in told(
        result, VerdictChange(check=passed, load=3.5, until=2.4757)
    )
    assert "would still do" in told(result, VerdictChange(check=passed, material=STRONGER))


def test_own_weight_is_named_where_it_is_part_of_the_load(result, check):
    case = result.case
    heavy = case.load_cases["weight"].model_copy(update={"own_weight": True})
    other = replace(result, case=case.model_copy(update={"load_cases": {**case.load_cases, "weight": heavy}}))
    change = VerdictChange(check=replace(check, verdict=Verdict.FAIL), load=0.5)
    assert "0.500 times all loads (own weight included)" in told(other, change)
    assert "own weight" not in told(result, change)


@pytest.mark.parametrize(
    ("kinds", "words"),
    [
        (
            ["CALIBRATION"],
            "comes from calibration of the hand calculation, narrower by a solid model (--fidelity solid)",
        ),
        (["COUPLES", "EYES"], "between layers and flexibility of eyes, bores and holes together, narrower by fits"),
        (["EYES", "GROWTH"], "growth with the load together, narrower by a solid model (--fidelity solid)."),
        (["GROWTH"], "growth with the load, which no entry of the case and no option narrows"),
        (["IMPERFECTION"], "geometric imperfection, which no entry of the case and no option narrows"),
    ],
)
def test_an_open_check_says_where_its_band_comes_from_and_what_narrows_it(result, check, kinds, words):
    change = VerdictChange(
        check=replace(check, verdict=Verdict.UNDECIDED),
        load=0.9,
        widest=tuple(Source(kind=SourceKind[k]) for k in kinds),
    )
    assert words in told(result, change)


def test_what_narrows_a_band_is_told_only_where_it_does(result, check):
    """A scatter is stated, so that growth is less with less of it; all links are solids, so that no other ones help."""
    growth, eyes, load = (Source(kind=SourceKind[kind]) for kind in ("GROWTH", "EYES", "LOAD"))
    value = replace(check.value, sources=(*check.value.sources, load))
    grown = VerdictChange(check=replace(check, verdict=Verdict.UNDECIDED, value=value), widest=(growth,))
    assert "narrower by a narrower scatter of load and modulus" in told(result, grown)
    one = result.load_cases["weight"]
    solids = replace(result, load_cases={"weight": replace(one, links={})})
    open_by_eyes = VerdictChange(check=grown.check, widest=(eyes,))
    assert "narrower by a solid model" in told(result, open_by_eyes)
    assert "no option narrows" in told(solids, open_by_eyes)


def test_the_command_names_case_entry_range_and_what_was_set(result, check):
    change = VerdictChange(check=check, size=SizeRange(entry="parts.tube.outer_diameter", first="5 mm", last="9 mm"))
    named = replace(result, name="my case.toml")
    plain = "alula size 'my case.toml' --vary parts.tube.outer_diameter=\"5 mm..9 mm\""
    for fidelity, asked in {"auto": "", "solid": "", "beam": " --fidelity beam", "frame": " --fidelity beam"}.items():
        assert size_command(change, replace(named, fidelity=fidelity)) == plain + asked
    case = result.case.read_from(Origin(changes=(("parts.tube.outer_diameter", "5 mm"), ("links.AE.part", "rod"))))
    assert size_command(change, replace(named, case=case)).endswith(" --set links.AE.part=rod")
    spaced = replace(change, size=replace(change.size, entry="parts.arm tube.outer_diameter"))
    assert shlex.split(size_command(spaced, named))[4] == "parts.arm tube.outer_diameter=5 mm..9 mm"
    assert size_command(VerdictChange(check=check), result) == ""


def test_a_check_that_no_load_changes_says_so(result, check):
    gap = replace(check, subject=LINKAGE, quantity=Quantity.CLEARANCE)
    assert told(result, VerdictChange(check=gap)) == "It does not depend on the loads."
    assert "load case" not in change_title(VerdictChange(check=gap), several=True)
    assert change_title(VerdictChange(check=check), several=True).endswith(f", load case {check.load_case}")
    opened = replace(check, verdict=Verdict.UNDECIDED, reason="no model may decide it")
    assert told(result, VerdictChange(check=opened)) == "No model may decide it."


@pytest.mark.parametrize(
    ("state", "words"), [("off", "was not looked at."), ("deformed", "the shape of the deformed linkage counts.")]
)
def test_without_proportion_it_is_said_whether_the_deformed_shape_was_looked_at(result, check, state, words):
    cases = {
        name: replace(one, large_displacement=replace(one.large_displacement, state=state))
        for name, one in result.load_cases.items()
    }
    [said] = change_sentences(VerdictChange(check=check), replace(result, load_cases=cases))
    assert said.endswith(words)


def test_page_console_and_record_tell_the_same(result):
    check = next(c for c in result.load_cases["weight"].checks if c.quantity is Quantity.SAFETY_FACTOR)
    size = SizeRange(entry="parts.tube.outer_diameter", first="5 mm", last="9 mm")
    change = VerdictChange(check=check, load=1.2, material=STRONGER, size=size)
    result = replace(result, changes=(change,))
    [record] = result_record(result)["changes"]
    assert record["load_factor"] == 1.2
    assert record["linear_until"] is None
    assert record["size"] == {"entry": "parts.tube.outer_diameter", "first": "5 mm", "last": "9 mm"}
    console = Console(width=1000, record=True, file=io.StringIO())
    print_result(result, console)
    text, page = console.export_text(), Page(render(result, {}))
    for sentence in (*record["sentences"], record["command"]):
        assert sentence in text
        assert sentence in page.words
    assert page.source.index('id="changes"') < page.source.index("<nav")


def test_a_modulus_of_a_metal_is_told_in_full(result, check):
    """Above 1e5 numbers have a power of ten, which is no stated modulus; what is as stated is not told."""
    failed = replace(check, verdict=Verdict.FAIL)
    stiffer = MaterialChange(what="modulus", material="pvc-paredes-2018", stated=210000.0, needed=231400.0)
    text = told(result, VerdictChange(check=failed, material=stiffer))
    assert "A modulus of 232000 MPa in place of 210000 MPa (Rigid PVC" in text
    same = replace(stiffer, needed=210000.0)
    assert "modulus" not in told(result, VerdictChange(check=failed, load=0.5, material=same))


def test_why_no_factor_is_told_is_true(result, check):
    passed = replace(check, verdict=Verdict.PASS)
    assert told(result, VerdictChange(check=passed, load=1.004)) == "All loads may hardly grow."
    least = replace(passed, value=Band.at_least(2.0))
    assert told(result, VerdictChange(check=least)).endswith("only a least value of the number is known.")
    loose = replace(passed, value=replace(passed.value, sources=(Source(kind=SourceKind.PLAY),)))
    assert "since play of pins" in told(result, VerdictChange(check=loose))
