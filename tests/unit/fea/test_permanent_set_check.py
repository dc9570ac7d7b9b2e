"""A check of permanent set: which load cases have one, what adds to it, how its band is judged, what leaves it open."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from levels import pylon
from lever_on_tie import lever_on_tie
from plastic_problems import FOUND

from alula.fea.asked.asked import asked
from alula.fea.asked.at_temperature import as_known
from alula.fea.check import deciding
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import LINKAGE, Quantity, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging import plastic_collapse
from alula.fea.judging.link_result import by_hand_shares
from alula.fea.judging.linkage import unless_it_gives_way
from alula.fea.judging.plastic_collapse import _of_plates
from alula.fea.links.fidelity import by_hand
from alula.fea.motion.envelope_outcomes import _sets
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.whole.permanent_set import judge_permanent_set, of_one_force
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import PermanentSetCheck
from alula.reports.check.modes import mode_parts, mode_records
from alula.reports.sentences import told

ELASTIC, YIELDS = Band(value=1.5, low=1.0, high=2.0), Band(value=1.5, low=0.99, high=2.0)
SIZES = {"proof": 200.0, "aside": 100.0}
"""Of the forces [N]."""


def moved(*works):
    """Return what was found of a link on whose set its loads do that work [N mm]."""
    return replace(FOUND, stays=works)


@pytest.fixture(scope="module")
def plain():
    return check_case(lever_on_tie(), fidelity="beam")


def judged(plain, case, load_case, factors, found, **more):
    """Return the outcome for links with these safety factors and paths."""
    links = {
        link: replace(plain.load_cases["proof"].links[link], safety_factor=band, decided_by="beam")
        for link, band in factors.items()
    }
    here = SimpleNamespace(
        case=case,
        load_case=load_case,
        links=links,
        collapses=found,
        acts_on=lambda link: True,
        doubts=lambda link: (Growths(), by_hand_shares(Growths(), link)),
        beside_one_force=None,
    )
    for name, value in more.items():
        setattr(here, name, value)
    [one] = asked(case, PermanentSetCheck)
    return judge_permanent_set(here, one)


@pytest.mark.parametrize(("load_case", "value"), [("proof", 3.0), ("aside", 6.0)])
def test_works_of_all_links_that_yield_are_added_over_the_force(plain, load_case, value):
    both = {"lever": moved(500.0, 400.0, 600.0), "tie": moved(100.0, 80.0, 300.0)}
    found = judged(plain, lever_on_tie(), load_case, {"lever": YIELDS, "tie": YIELDS}, both)
    force = SIZES[load_case]
    band = found.outcome.value
    assert (band.value, band.low, band.high) == pytest.approx((600.0 / force, 480.0 / force, 900.0 / force))
    assert band.value == pytest.approx(value)
    assert found.outcome.verdict is {"proof": Verdict.PASS, "aside": Verdict.UNDECIDED}[load_case]
    assert found.outcome.subject == LINKAGE
    assert [(one.link, one.set.value) for one in found.numbers] == [("lever", 500.0 / force), ("tie", 100.0 / force)]
    assert "most of it stays in lever" in told(found.outcome.reason)


@pytest.mark.parametrize("elastic", ["lever", "tie"])
def test_a_link_whose_whole_band_is_above_first_yield_adds_nothing(plain, elastic):
    factors = {"lever": YIELDS, "tie": YIELDS} | {elastic: ELASTIC}
    paths = {"lever": moved(500.0, 400.0, 600.0), "tie": moved(100.0, 80.0, 300.0)}
    found = judged(plain, lever_on_tie(), "proof", factors, paths)
    assert found.outcome.value.value == pytest.approx({"lever": 0.5, "tie": 2.5}[elastic])
    none = judged(plain, lever_on_tie(), "proof", dict.fromkeys(factors, ELASTIC), {})
    assert (none.outcome.value.high, none.outcome.verdict) == (0.0, Verdict.PASS)
    assert none.outcome.margin == math.inf


@pytest.mark.parametrize(("low", "verdict"), [(1200.0, Verdict.FAIL), (900.0, Verdict.UNDECIDED)])
def test_a_load_that_is_not_borne_leaves_no_set_below_any_limit(plain, low, verdict):
    found = judged(
        plain,
        lever_on_tie(),
        "proof",
        {"lever": ELASTIC, "tie": YIELDS},
        {"tie": moved(math.inf, low, math.inf)},
    )
    assert found.outcome.verdict is verdict
    assert found.outcome.value.value == math.inf
    assert not found.outcome.gives_way  # the linkage as a whole, which is judged by itself
    assert "∞" in told(found.outcome.reason) or "inf" in told(found.outcome.reason)


@pytest.mark.parametrize("weakest", ["lever", "tie"])
def test_of_links_that_do_not_bear_their_load_the_weakest_is_named(plain, weakest):
    paths = {link: moved(math.inf, math.inf, math.inf) for link in ("lever", "tie")}
    factors = {"lever": 0.9, "tie": 0.9} | {weakest: 0.8}
    paths = {link: replace(path, factor=factors[link]) for link, path in paths.items()}
    found = judged(plain, lever_on_tie(), "proof", dict.fromkeys(paths, YIELDS), paths)
    assert f"most of it stays in {weakest}" in told(found.outcome.reason)


@pytest.mark.parametrize("brittle", ["lever", "tie"])
def test_brittle_and_printed_links_must_stay_elastic(plain, brittle):
    def edit(tables):
        tables["parts"][brittle]["material"] = "resin-405nm"

    case, paths = lever_on_tie(edit), {"lever": moved(5.0, 4.0, 6.0), "tie": moved(1.0, 0.8, 3.0)}
    open_ = judged(plain, case, "proof", dict.fromkeys(paths, YIELDS), paths).outcome
    assert open_.verdict is Verdict.UNDECIDED
    assert "is brittle" in told(open_.reason)
    kept = judged(plain, case, "proof", dict.fromkeys(paths, YIELDS) | {brittle: ELASTIC}, paths).outcome
    assert kept.verdict is Verdict.PASS


def test_what_leaves_it_open_is_told(plain):
    case, factors = lever_on_tie(), {"lever": ELASTIC, "tie": YIELDS}
    paths = {"tie": moved(1.0, 0.8, 3.0)}
    for more, says in (
        ({"collapses": {}}, "--fidelity solid"),
        ({"collapses": {"tie": "no equilibrium was found"}}, "no equilibrium was found"),
        ({"collapses": {"tie": FOUND}}, "no state under its loads"),
        ({"beside_one_force": reason("set_of_others")}, "other loads act"),
    ):
        found = judged(plain, case, "proof", factors, paths, **more).outcome
        assert (found.verdict, math.isnan(found.value.value)) == (Verdict.UNDECIDED, True)
        assert says in told(found.reason)
    elastic = dict.fromkeys(factors, ELASTIC)
    assert judged(plain, case, "proof", elastic, {}, beside_one_force=reason("set_of_others")).outcome.value.high == 0


def test_it_rests_on_equilibrium_and_on_strengths_that_are_known(plain):
    def warm(tables):
        tables["conditions"] = {"temperature": "90 degC"}

    outcome = judged(plain, lever_on_tie(), "proof", {"lever": ELASTIC, "tie": ELASTIC}, {}).outcome
    [held], [lost] = (unless_it_gives_way([outcome], lost) for lost in ({}, {"proof": reason("no_equilibrium")}))
    assert (held.applies, lost.applies) == (True, False)
    [known], [unknown] = (as_known(case, [outcome]) for case in (lever_on_tie(), lever_on_tie(warm)))
    assert (known.verdict, unknown.verdict) == (Verdict.PASS, Verdict.UNDECIDED)


def test_other_loads_and_stiffness_take_the_proportion_away():
    def weigh(tables):
        tables["load_cases"]["aside"]["own_weight"] = True

    def spring(tables):
        tables["springs"] = {
            "s": {"link_1": "wall", "point_1": "O", "link_2": "lever", "point_2": "P", "stiffness": "1 N/mm",
                  "free_length": "100 mm"}
        }  # fmt: skip

    def said(edit, load_case):
        statics = solve_case_statics(lever_on_tie(edit))
        return of_one_force(statics.case, load_case, statics.forces[load_case], statics.loads[load_case])

    assert said(weigh, "proof") is None
    assert "weight" in told(said(weigh, "aside"))
    stiff = SimpleNamespace(by_equilibrium=False, reason="a redundant joint")
    assert "a redundant joint" in told(of_one_force(lever_on_tie(), "proof", stiff, [None]))


@pytest.mark.parametrize("held", ["once", "twice", "by a pair"])
def test_an_oblique_load_line_on_links_that_hang_by_one_clamp_each_needs_no_stiffness(held):
    """Of the forces in a tree of clamps nothing changes as a link yields; of a loop, and of two plates, it does."""
    tables = pylon(level={"test": "proof"})
    if held == "twice":
        tables["links"]["foot"]["points"]["T"] = ["0 mm", "380 mm"]
        tables["joints"]["T"] = {
            "links": ["foot", "pylon"],
            "clamped": True,
            "clamp_length": "10 mm",
            "angle": "90 deg",
        }
    if held == "by a pair":
        tables["parts"]["tube"] = {"shape": "bar", "material": "aluminium-6061-t6", "width": "20 mm"}
        tables["parts"]["tube"] |= {"thickness": "5 mm", "fillet_radius": "1 mm"}
        tables["links"]["pylon"] |= {"count": 2, "apart": "20 mm"}
    statics = solve_case_statics(validate(tables))
    forces = statics.forces["proof"]
    assert not forces.by_equilibrium
    open_by = of_one_force(statics.case, "proof", forces, statics.loads["proof"])
    assert (open_by is None) == (held == "once")


@pytest.mark.parametrize("load_case", ["proof", "aside"])
def test_a_load_case_of_other_loads_is_refused(load_case):
    def more(entry, value):
        def edit(tables):
            tables["load_cases"][load_case][entry] = value

        return edit

    force = {"link": "lever", "at": "P", "force": ["0 N", "-1 N"]}
    for edit in (
        more("forces", []),
        more("forces", [force, force]),
        more("forces", [force | {"force": ["0 N", "0 N"]}]),
        more("moments", [{"link": "lever", "at": "P", "moment": "1 N*m"}]),
    ):
        with pytest.raises(CaseError, match=f"along the line of one force, but load case '{load_case}'"):
            lever_on_tie(edit)


def test_a_load_line_has_the_size_of_its_force(plain):
    def edit(tables):
        tables["links"]["tie"]["points"]["Q"] = ["60 mm", "0 mm"]
        tables["load_cases"]["proof"] = {
            "load_lines": [
                {"from": ["160 mm", "50 mm"], "to": ["100 mm", "-20 mm"], "force": "-50 N", "link": "lever", "at": "P",
                 "leaves": {"link": "tie", "at": "Q"}}
            ]
        }  # fmt: skip

    case = lever_on_tie(edit)
    paths = {"lever": moved(50.0, 50.0, 50.0), "tie": moved(100.0, 100.0, 100.0)}
    found = judged(plain, case, "proof", dict.fromkeys(paths, YIELDS), paths)
    assert found.outcome.value.value == pytest.approx(3.0)
    statics = solve_case_statics(case)
    assert len(statics.loads["proof"]) == 2
    assert of_one_force(statics.case, "proof", statics.forces["proof"], statics.loads["proof"]) is None


def test_both_plates_of_a_pair_count():
    """One of equal plates was solved, or both of unequal ones; a plate that is not known leaves the link open."""
    one, other = replace(moved(3.0, 2.0, 4.0), low=1.8), moved(5.0, 4.0, 6.0)
    assert _of_plates([one], 1).stays == (3.0, 2.0, 4.0)
    assert _of_plates([one], 2).stays == (6.0, 4.0, 8.0)
    assert _of_plates([other, one], 2).stays == (8.0, 6.0, 10.0)
    assert _of_plates([other, one], 2).low == 1.8
    assert _of_plates([one, "lost"], 2) == _of_plates(["lost", one], 2) == "lost"


@pytest.mark.parametrize("order", [("lever", "tie"), ("tie", "lever")])
def test_over_a_motion_it_is_known_where_nothing_yields(order):
    case = lever_on_tie()

    def over(proof, aside, complete=True):
        bands = {"proof": (ELASTIC, proof), "aside": (aside, ELASTIC)}
        links = {
            link: SimpleNamespace(
                load_cases={
                    name: SimpleNamespace(safety_factor=two[i], discretisation=None) for name, two in bands.items()
                }
            )
            for i, link in enumerate(order)
        }
        return {one.load_case: one for one in _sets(case, links, np.array([True, complete]))}

    known = over(ELASTIC, ELASTIC)
    assert [(one.verdict, one.value.high) for one in known.values()] == [(Verdict.PASS, 0.0)] * 2
    assert {one.verdict for one in over(ELASTIC, ELASTIC, complete=False).values()} == {Verdict.UNDECIDED}
    for bands, lost in (((YIELDS, ELASTIC), "proof"), ((ELASTIC, YIELDS), "aside")):
        found = over(*bands)
        assert [name for name, one in found.items() if one.verdict is not Verdict.PASS] == [lost]
        assert "in single poses" in told(found[lost].reason)


def test_from_the_case_to_the_table(monkeypatch):
    """Paths are read from the least to the largest load over strength; by hand no link has a band here."""
    asked_for = {}

    def find(link, law, loads, mesh, *, factors, **more):
        asked_for[loads.link, loads.name] = factors
        return replace(
            FOUND, stays=tuple(factor * (100.0 if loads.link == "tie" else 200.0) for factor in (1, *factors))
        )

    def edit(tables):
        tables["load_cases"]["proof"]["scatter"] = {"low": "80 %", "high": "125 %"}
        tables["materials"]["own"]["strength_range"] = ["90 MPa", "120 MPa"]

    monkeypatch.setattr(plastic_collapse, "collapse_of", find)
    monkeypatch.setattr(
        deciding, "decide", lambda tasks, beams, *more, **others: {x: by_hand(tasks[x], beams[x]) for x in tasks}
    )
    result = check_case(lever_on_tie(edit), fidelity="auto")
    for link in ("lever", "tie"):
        assert asked_for[link, "proof"] == pytest.approx((0.8 / 1.2, 1.25 / 0.9), rel=0.02)
        assert asked_for[link, "aside"] == pytest.approx((1.0 / 1.2, 1.0 / 0.9), rel=0.02)
    assert len(asked_for) == 4
    found = {
        name: one.value
        for name, case in result.load_cases.items()
        for one in case.checks
        if one.quantity is Quantity.PERMANENT_SET
    }
    assert (found["proof"].value, found["aside"].value) == pytest.approx((300.0 / 200.0, 300.0 / 100.0))
    assert (found["proof"].low, found["aside"].high) == pytest.approx((1.0, 3.33), rel=0.02)
    assert {SourceKind.LOAD, SourceKind.STRENGTH} <= {source.kind for source in found["proof"].sources}
    records = mode_records(result.load_cases["proof"])["permanent_sets"]
    assert [(one["check"], one["link"]) for one in records] == [("stays", "lever"), ("stays", "tie")]
    [table] = [part for part in mode_parts(result.load_cases["proof"]) if part.key == "permanent_sets"]
    assert [column.title for column in table.columns[:2]] == ["check", "link"]
