"""The least size that passes: against rules whose answer is known beforehand."""

import math
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

import pytest

from alula.fea.common.verdict import Verdict
from alula.fea.sizing.least import least_size
from alula.fea.sizing.search import Search
from alula.fea.study.engine import Engine
from alula.fea.study.margin import nearest
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.fea.study.store import Store
from alula.geometry.base.errors import CaseError
from alula.loads.plans.axis import axis
from alula.loads.plans.plan import plan_of
from alula.reports.commands.telling import text_of
from alula.reports.study.size import size_section

PATH = "parts.tube.outer_diameter"


class Desk:
    """Answers by a rule of diameter and fidelity: safety factor and half width of its band, against a limit of 1."""

    def __init__(self, rule):
        self.rule, self.solids = rule, []

    def submit(self, task):
        diameter = float(task.tables["parts"]["tube"]["outer_diameter"].split()[0])
        if task.fidelity != "beam":
            self.solids.append(diameter)
        future = Future()
        future.set_result(self.answer(diameter, task.fidelity))
        return future

    def answer(self, diameter, fidelity):
        found = self.rule(diameter, fidelity)
        if found is None:
            return VariantResult(state="refused", sentence="too thin")
        value, width = found
        low, high = value - width, value + width
        verdict = Verdict.PASS if low >= 1.0 else Verdict.FAIL if high < 1.0 else Verdict.UNDECIDED
        number = VariantNumber(
            check="strength", subject="AE", quantity="safety factor", unit="1",
            value=value, low=low, high=high, limit=1.0, verdict=verdict,
        )  # fmt: skip
        return VariantResult(state="done", verdict=verdict, numbers=(number,))


def search(rule, folder, text="3 mm..9 mm by 0.25 mm"):
    """Size by a rule; returns what was found, its values in mm, and the diameters that were solved."""
    desk = Desk(rule)
    plan = plan_of({"case": "owl-wing-static", "vary": {PATH: text}, "fidelity": "solid"})
    values = axis(PATH, text).values
    with Store.writing(folder) as store:
        found = least_size(Search(plan, Path(), store, Engine(submit=desk.submit, capacity=lambda: 6)), PATH, values)
    return found, [float(value.split()[0]) for value in values], desk.solids


RULES = {
    # rule of (diameter, fidelity), least that passes, greatest that fails, what is open between
    "solids": (lambda d, f: ((d / 6.1) ** 3, 0.0), 6.25, 6.0, []),
    "band of 6 %": (lambda d, f: ((d / 6.1) ** 3, 0.06 * (d / 6.1) ** 3), 6.25, 5.75, [6.0]),
    "band of 30 %": (lambda d, f: ((d / 6.1) ** 3, 0.3 * (d / 6.1) ** 3), 7.0, 5.5, [5.75, 6.0, 6.25, 6.5, 6.75]),
    "hand calculation far off": (lambda d, f: ((d / (4.0 if f == "beam" else 8.1)) ** 3, 0.0), 8.25, 8.0, []),
    "falling": (lambda d, f: ((6.1 / d) ** 3, 0.0), 6.0, 6.25, []),
    "refused below 5 mm": (lambda d, f: None if d < 5.0 else (d / 4.0, 0.0), 5.0, None, []),
    "refused from 5.25 mm on": (
        lambda d, f: None if d > 5.0 else (d / (3.8 if f == "beam" else 4.6), 0.0),
        4.75,
        4.5,
        [],
    ),
    "no solid from 5.25 mm on": (
        lambda d, f: (d / 3.8, 0.0) if f == "beam" else None if d > 5.0 else (d / 4.9, 0.0),
        5.0,
        4.75,
        [],
    ),
    "passes": (lambda d, f: (d, 0.0), 3.0, None, []),
    "fails": (lambda d, f: (d / 10.0, 0.0), None, 9.0, []),
}


@pytest.mark.parametrize("name", RULES)
def test_the_boundary_of_a_known_rule_is_found(name, tmp_path):
    """Both ends over the whole band and all that is open between; far fewer solids than steps."""
    rule, passing, failing, opened = RULES[name]
    found, values, solids = search(rule, tmp_path)
    assert (None if found.passing is None else values[found.passing]) == passing
    assert (None if found.failing is None else values[found.failing]) == failing
    assert [values[step] for step in found.opened if step in found.results] == [
        value for value in opened if value in solids
    ]
    between = sorted(filter(None, (passing, failing)))
    if len(between) == 2:
        assert all(values[step] in opened for step in range(len(values)) if between[0] < values[step] < between[1])
    assert not found.turns
    assert len(solids) == len(set(solids)) <= 12


def test_a_verdict_that_turns_more_than_once_is_told(tmp_path):
    """Passes from 4 to 5 mm, fails above, passes again from 7 mm."""
    found, values, _ = search(lambda d, f: (2.0 if 4.0 <= d <= 5.0 or d >= 7.0 else 0.5, 0.0), tmp_path)
    assert values[found.passing] == 4.0
    assert values[found.failing] == 3.75
    assert found.turns
    assert all(5.0 < values[step] < 7.0 for step in found.turns)


def test_what_a_step_gains_follows_from_the_solved_ones(tmp_path):
    """A safety factor with the cube of the diameter: from 6 to 6.25 mm it gains (6.25/6)^3 - 1."""
    found, _, _ = search(RULES["solids"][0], tmp_path)
    assert found.gain(found.failing) == pytest.approx((6.25 / 6.0) ** 3 - 1.0, rel=1e-9)
    assert found.limit(found.failing).value == pytest.approx((6.0 / 6.1) ** 3)
    assert math.isclose(found.results[found.passing].numbers[0].value, (6.25 / 6.1) ** 3)
    assert "6.25 mm raises its margin by some 13 %" in text_of([size_section(found)], width=400)


def test_a_number_at_most_that_grows_with_a_size_has_a_margin_that_falls(tmp_path, monkeypatch):
    """A mass of 95 g at 6.25 mm, of at most 100 g, limits it more than a strength of which 6.1 mm is enough."""
    answer = Desk.answer

    def weighed(desk, diameter, fidelity):
        found = answer(desk, diameter, fidelity)
        mass = replace(found.numbers[0], check="mass", quantity="total mass", unit="g", limit=100.0)
        grams = 95.0 * diameter / 6.25
        passes = Verdict.PASS if grams <= 100.0 else Verdict.FAIL
        mass = replace(mass, value=grams, low=grams, high=grams, verdict=passes)
        worst = Verdict.FAIL if Verdict.FAIL in (passes, found.verdict) else found.verdict
        return replace(found, verdict=worst, numbers=(*found.numbers, mass))

    monkeypatch.setattr(Desk, "answer", weighed)
    found, values, _ = search(lambda d, f: ((d / 6.1) ** 3, 0.0), tmp_path, "6 mm..6.5 mm by 0.25 mm")
    assert values[found.passing] == 6.25
    told = text_of([size_section(found)], width=400)
    assert "At 6.25 mm total mass" in told
    assert "6.5 mm lowers its margin by some 3.8 %" in told  # 6.25/6.5


def test_a_range_without_a_case_is_refused(tmp_path):
    """With the sentence of the case's own rules."""
    with pytest.raises(CaseError, match="too thin"):
        search(lambda d, f: None, tmp_path)


def test_what_limits_is_a_check_that_makes_the_verdict():
    """A column whose wide band reaches lower limits nothing where the linkage gives way beside it."""
    gives_way = VariantNumber(
        check="holding", subject="the linkage", quantity="share of the load that is held", unit="1",
        value=0.7, low=0.65, high=0.75, limit=1.0, verdict=Verdict.FAIL,
    )  # fmt: skip
    column = VariantNumber(
        check="buckling", subject="rocker", quantity="buckling factor", unit="1",
        value=1.2, low=0.3, high=6.0, limit=1.0, verdict=Verdict.UNDECIDED,
    )  # fmt: skip
    failed = VariantResult(state="done", verdict=Verdict.FAIL, numbers=(gives_way, column))
    assert nearest(failed) is gives_way
    assert nearest(VariantResult(state="done", verdict=Verdict.UNDECIDED, numbers=(column,))) is column
