"""A check of plastic collapse: which links it is asked of, what is refused, and how its band is judged and told."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import NYLON, edited
from plastic_problems import FOUND

from alula.fea.asked.asked import asked, asked_of
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity, Verdict, deciding
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging import plastic_collapse, solid_buckling
from alula.fea.judging.link_result import by_hand_shares
from alula.fea.judging.plastic_collapse import above_first_yield, as_elastic, judge_collapse
from alula.fea.plastic.load_path import NoPlasticStateError
from alula.fea.refine.link_buckling import SolidBuckling
from alula.geometry.base.errors import CaseError
from alula.loads.records.check_spec import PlasticCollapseCheck
from alula.reports.check.folder import report_names
from alula.reports.check.plastic_collapse import collapse_section
from alula.reports.sections.section import Picture
from alula.reports.sentences import told
from alula.reports.turnable.link import collapse_name

CHECK = 'checks.collapse={ type = "plastic-collapse", minimum = 1.5 }'
FRONT = 'checks.collapse={ type = "plastic-collapse", minimum = 1.5, links = ["front"] }'
BEYOND = FRONT.replace("1.5", "150.0")
"""A limit that no safety factor of the knee is at."""
OWN = (
    'materials.own={{ title = "Aluminium", density = "2800 kg/m^3", youngs_modulus = "70 GPa", poissons_ratio = 0.33, '
    'yield_strength = "400 MPa", ultimate_strength = "480 MPa", strength = "yield", '
    "minimum_safety_factor = 2.0{}, sources = {{}}, status = {{}} }}"
)


def judged(case, found):
    """Return the outcome under the first load case."""
    load_case = next(iter(case.load_cases))
    doubts = Growths(), by_hand_shares(Growths(), "front")
    results = {"front": None, "rear": None}
    here = SimpleNamespace(case=case, load_case=load_case, links=results, collapses=found, doubts=lambda link: doubts)
    [one] = asked(case, PlasticCollapseCheck)
    return judge_collapse(here, one).outcome


@pytest.mark.parametrize(
    ("low", "high", "verdict"), [(1.5, 3.0, Verdict.PASS), (1.4, 3.0, Verdict.UNDECIDED), (1.0, 1.45, Verdict.FAIL)]
)
def test_the_whole_band_is_judged(low, high, verdict):
    outcome = judged(edited("knee", [FRONT]), {"front": replace(FOUND, factor=low, low=low, high=high)})
    assert outcome.verdict is verdict
    assert (outcome.subject.name, outcome.limit) == ("front", 1.5)
    assert "flows without end" in told(outcome.reason)


def test_the_largest_strain_and_unloading_are_told():
    case = edited("knee", [FRONT, OWN.format(", hardening_factors = [[0.04, 1.1]]"), 'parts.front.material="own"'])
    outcome = judged(case, {"front": replace(FOUND, ended="strain", unloaded=0.2)})
    assert "largest plastic strain of its card, 4 %" in told(outcome.reason)
    assert "stress fell again in 20 %" in told(outcome.reason)


def test_the_range_of_the_strength_multiplies_the_band():
    entries = OWN.format(', strength_range = ["300 MPa", "500 MPa"]'), 'parts.front.material="own"'
    outcome = judged(edited("knee", [FRONT, *entries]), {"front": FOUND})
    assert outcome.value.low == pytest.approx(1.9 * 0.75)
    assert outcome.value.high == pytest.approx(2.2 * 1.25)
    assert outcome.verdict is Verdict.UNDECIDED


def test_bending_that_grows_towards_buckling_of_the_solid_multiplies_the_band(monkeypatch):
    """At a fifth of the buckling load bending is at most 1/(1 - 1/5) of that of the solid, which is linear."""
    buckles = SolidBuckling(value=6.0, least=5.0, most=9.0, error=0.0)
    monkeypatch.setattr(solid_buckling, "solid_buckling", lambda result: buckles)
    outcome = judged(edited("knee", [FRONT]), {"front": FOUND})
    assert outcome.value.low == pytest.approx(1.9 * 0.8)
    assert outcome.value.high == pytest.approx(2.2)
    assert SourceKind.GROWTH in {source.kind for source in outcome.value.sources}


def collapses(result):
    """Return the outcomes of plastic collapse under all load cases."""
    every = [one for load_case in result.load_cases.values() for one in load_case.checks]
    return [one for one in every if one.quantity is Quantity.PLASTIC_COLLAPSE]


def test_what_stays_elastic_is_told_by_hand():
    collapse = 'collapse={ type = "plastic-collapse", minimum = 2.3, links = ["crank"] }'
    checks = f'checks={{ strength={{ type = "safety-factor", links = ["crank"] }}, {collapse} }}'
    result = check_case(edited("slider-crank", [checks]), fidelity="beam")
    own = collapses(result)
    assert {one.load_case for one in own} == {"push forward", "push backward"}
    for one in own:
        factor = result.load_cases[one.load_case].links["crank"].safety_factor
        assert one.verdict is Verdict.PASS
        assert (one.value.low, one.value.high) == (factor.low, np.inf)
        assert one.value.sources == factor.sources
        assert "nothing of it yields" in told(one.reason)
        checks = [check for check in result.load_cases[one.load_case].checks if check.link == "crank"]
        assert min(checks, key=lambda check: check.margin) is one
        assert deciding(checks)[0] is not one
    assert collapse_section(result).data == {"plastic_collapse": None}


@pytest.mark.parametrize(
    ("low", "without", "card", "tells"),
    [
        (1.5, "", "", True),
        (1.49, "", "", False),
        (1.5, "beam theory alone", "", False),
        (1.5, "", ", compression_ratio = 1.2", False),
        (1.5, "", ", compression_ratio = 1.0, hardening_factors = [[0.04, 1.1]]", True),
    ],
)
def test_when_a_safety_factor_tells(low, without, card, tells):
    """Not within the band, of no known error, or where a pull from all sides makes it yield before von Mises does."""
    case = edited("knee", [FRONT, OWN.format(card), 'parts.front.material="own"'])
    [one] = asked(case, PlasticCollapseCheck)
    band = Band(value=2.0, low=low, high=3.0, without=without)
    found = above_first_yield(case, one, as_elastic(one).outcome("heel-strike", band))
    assert (found is not None) is tells
    if found is not None:
        assert (found.quantity, found.limit, found.value) == (Quantity.PLASTIC_COLLAPSE, 1.5, Band.at_least(1.5))


def test_without_a_solid_it_is_open_and_names_the_remedy():
    result = check_case(edited("knee", [BEYOND.replace(', links = ["front"]', "")]), fidelity="beam")
    own = collapses(result)
    assert {one.verdict for one in own} == {Verdict.UNDECIDED}
    assert all("--fidelity solid" in told(one.reason) for one in own)
    assert {one.link for one in own} == {"front", "rear"}
    assert collapse_section(result).data == {"plastic_collapse": None}


def test_from_the_case_to_the_section(monkeypatch):
    """Of one link a path is lost: it stays open, and never passes. What stays elastic up to the limit needs none."""
    paths = []

    def find(link, law, loads, mesh, **more):
        paths.append(((link.E, law.strength), loads.name, more["until"] < np.inf))
        if loads.name == "late-stance":
            raise NoPlasticStateError("no equilibrium was found in 40 iterations")
        return replace(FOUND, factor=200.0, low=190.0, high=220.0)

    monkeypatch.setattr(plastic_collapse, "collapse_of", find)
    result = check_case(edited("knee", [CHECK.replace("1.5", "60.0"), "solid.mesh_size=1.5"]))
    own = (71700.0, 460.0)
    assert sorted(paths) == [(own, "heel-strike", True)] * 2 + [(own, "late-stance", True)]
    checks = {(one.link, one.load_case): one for one in collapses(result)}
    assert checks["front", "late-stance"].value.least_alone
    assert checks["front", "heel-strike"].value.low == pytest.approx(190.0, rel=0.05)
    lost = checks.pop(("rear", "late-stance"))
    assert {one.verdict for one in checks.values()} == {Verdict.PASS}
    assert lost.verdict is Verdict.UNDECIDED
    assert "no equilibrium" in told(lost.reason)
    section = collapse_section(result)
    record = section.data["plastic_collapse"]["load_cases"]
    assert record["heel-strike"]["links"]["front"]["factor"] == 200.0
    assert record["late-stance"]["links"] == {}
    pictures = {part.name: part.model for part in section.parts if isinstance(part, Picture)}
    assert pictures == {f"plastic-{link}": collapse_name(link) for link in ("front", "rear")}
    assert {f"pictures/{name}.png" for name in pictures} <= report_names(result.case)


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ('parts.front.material="resin-405nm"', "is brittle"),
        ("parts.front.build_direction=[0.0, 0.0, 1.0]", "printed in layers"),
    ],
)
def test_brittle_and_layered_links_are_refused(entry, says):
    card = [NYLON, 'checks.eyes={type="mass", maximum="9 kg"}']  # whose eyes have no formula
    card += [f'parts.{part}.material="nylon"' for part in ("front", "rear")]
    with pytest.raises(CaseError, match=says) as error:
        edited("knee", [*card, FRONT, entry])
    assert "front" in str(error.value)
    assert str(error.value).endswith("name the other links in links")
    case = edited("knee", [*card, CHECK, entry])
    assert asked_of(case, PlasticCollapseCheck) == ("rear",)
    with pytest.raises(CaseError, match="leave this check out"):
        edited("knee", [*card, CHECK, entry, entry.replace("front", "rear")])


@pytest.mark.parametrize(
    "entry",
    ["[[0.0, 1.0]]", "[[0.02, 1.1], [0.01, 1.2]]", "[[0.01, 1.2], [0.02, 1.1]]"],
)
def test_a_curve_rises(entry):
    with pytest.raises(CaseError, match="hardening_factors"):
        edited("knee", [OWN.format(f", hardening_factors = {entry}")])
