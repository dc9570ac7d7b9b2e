"""The lightest combination that passes: against rules whose optimum is known in closed form or by trying all."""

import math
from concurrent.futures import Future
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest

from alula.fea.common.verdict import Verdict
from alula.fea.sizing.candidates import Objective
from alula.fea.sizing.lightest import ENUMERATED, lightest, none_passes
from alula.fea.sizing.search import Search
from alula.fea.study.engine import Engine
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.fea.study.store import Store
from alula.geometry.base.errors import CaseError
from alula.loads.plans.axis import axis
from alula.loads.plans.plan import plan_of
from alula.reports.commands.size import exit_status
from alula.reports.commands.telling import text_of
from alula.reports.study.size import size_section

B, H = "parts.tube.inner_diameter", "parts.tube.outer_diameter"


class Desk:
    """Answers by a rule of (b, h, fidelity): safety factors against 1 with a band, and the cost."""

    def __init__(self, rule, cost=lambda b, h: b * h):
        self.rule, self.cost, self.solids, self.by_hand = rule, cost, [], 0

    def submit(self, task):
        tube = task.tables["parts"]["tube"]
        b, h = (float(str(tube[entry.split(".")[-1]]).split()[0]) for entry in (B, H))
        hand = task.fidelity == "beam"
        self.by_hand += hand
        if not hand:
            self.solids.append((b, h))
        future = Future()
        future.set_result(self.answer(self.rule(b, h, task.fidelity), self.cost(b, h) * (0.9 if hand else 1.0)))
        return future

    def answer(self, factors, cost):
        if factors is None:
            return VariantResult(state="refused", sentence="no bore that wide")
        numbers = []
        for name, (value, width) in factors.items():
            low, high = value * (1.0 - width), value * (1.0 + width)
            verdict = Verdict.PASS if low >= 1.0 else Verdict.FAIL if high < 1.0 else Verdict.UNDECIDED
            numbers.append(
                VariantNumber(
                    check=name, subject="AE", quantity="safety factor", unit="1",
                    value=value, low=low, high=high, limit=1.0, verdict=verdict,
                )
            )  # fmt: skip
        mass = VariantNumber.exact("mass", "g", cost, "the linkage")
        verdicts = [number.verdict for number in numbers]
        worst = next((v for v in (Verdict.FAIL, Verdict.UNDECIDED) if v in verdicts), Verdict.PASS)
        return VariantResult(state="done", verdict=worst, numbers=(*numbers, mass))


def search(desk, folder, b="0.1 mm..2 mm by 0.1 mm", h="3 mm..9 mm by 0.1 mm", **more):
    """Search by a rule; returns what was found and its values in mm."""
    plan = plan_of({"case": "owl-wing-static", "vary": {B: b, H: h}, "fidelity": "solid", "mass": True})
    with Store.writing(folder) as store:
        asked = Search(plan, Path(), store, Engine(submit=desk.submit, capacity=lambda: 6))
        found = lightest(asked, (axis(B, b), axis(H, h)), Objective(), **more)
    point = {} if found.best is None else found.point(found.best)
    return found, tuple(float(str(value).split()[0]) for value in point.values())


def bending(c, slender=math.inf, hand=1.0, width=0.0):
    """Strength of a section of width b and height h, b h² ≥ c, that may be so slender, h ≤ slender b."""

    def rule(b, h, fidelity):
        share = hand if fidelity == "beam" else 1.0
        found = {"strength": (b * h**2 / c * share, width)}
        return found | ({"slenderness": (slender * b / h, 0.0)} if math.isfinite(slender) else {})

    return rule


@pytest.mark.parametrize("hand", [0.6, 1.7])
def test_a_bound_that_is_active_is_kept(tmp_path, hand):
    """Least b h with b h² ≥ c wants the greatest h, whatever hand calculation is off by: b = c/h²."""
    desk = Desk(bending(c=56.5, hand=hand))
    found, (b, h) = search(desk, tmp_path, h="5 mm..9 mm by 0.1 mm")
    assert (b, h) == (0.7, 9.0)  # 56.5/81 = 0.698; 0.8 wants 8.5
    assert found.complete
    assert len(desk.solids) <= 12


@pytest.mark.parametrize("seed", [0, 1])
def test_an_optimum_inside_the_bounds_is_found(tmp_path, seed):
    """With h ≤ 6 b as well: b = ∛(c/36), h = 6 b; on whole steps, the best of all 1220."""
    desk = Desk(bending(c=30.0, slender=6.0, hand=1.3, width=0.03))
    found, (b, h) = search(desk, tmp_path, seed=seed)
    needed = 30.0 / 0.97
    tried = [(i / 10, j / 10) for i, j in product(range(1, 21), range(30, 91))]
    inside = [(b * h, b, h) for b, h in tried if b * h**2 >= needed and h <= 6.0 * b * (1.0 + 1e-9)]
    assert b * h == pytest.approx(min(inside)[0], rel=1e-9)
    assert b * h == pytest.approx(6.0 * (needed / 36.0) ** (2.0 / 3.0), rel=0.05)  # within the steps of the closed form
    assert found.complete
    assert len(desk.solids) <= 12
    assert desk.by_hand < 700


def test_what_limits_the_answer_is_named_with_the_gains_of_each_entry(tmp_path):
    """Strength b h²: a step of h from 9 to 9.1 is not there; one of b gains b'/b - 1, for as much mass."""
    found, (b, _) = search(Desk(bending(c=56.5)), tmp_path, h="5 mm..9 mm by 0.2 mm")
    assert found.limit.check == "strength"
    by_path = {gain.path: gain for gain in found.gains}
    assert by_path[B].share == pytest.approx((b + 0.1) / b - 1.0, rel=1e-9)
    assert by_path[B].cost == pytest.approx(0.1 / b, rel=1e-9)
    assert by_path[H].share < 0.0
    assert found.gains[0].path == B
    section = size_section(found)
    told = text_of([section], width=400)
    assert f"Least mass that passes: 6.300 g with {B} = 0.7 mm, {H} = 9 mm." in told
    assert f"{B} = 0.8 mm changes its margin by +14.3 % and the mass by +14.3 %" in told  # 8/7
    assert section.data["best"] == {B: "0.7 mm", H: "9 mm"}
    assert exit_status(found) == 0


def test_equal_seeds_give_equal_searches_and_what_was_computed_stands(tmp_path):
    """In another folder the same combinations are solved; in the same folder none is solved again."""
    rule = bending(c=30.0, slender=6.0, hand=0.8)
    first, again, other = Desk(rule), Desk(rule), Desk(rule)
    h = "3 mm..9 mm by 0.5 mm"
    results = [search(d, tmp_path / n, h=h)[0] for d, n in ((first, "one"), (again, "one"), (other, "two"))]
    assert results[0].best == results[1].best == results[2].best
    assert first.solids == other.solids
    assert not again.solids
    assert not again.by_hand


def test_few_combinations_are_all_calculated_by_hand(tmp_path):
    """The best of a catalogue: values of a list have no order."""
    desk = Desk(bending(c=30.0, hand=1.2))
    found, point = search(desk, tmp_path, b="0.5 mm, 2 mm, 0.9 mm", h="3 mm, 6 mm, 5 mm")
    assert desk.by_hand == 9 <= ENUMERATED
    assert point == (0.9, 6.0)  # 0.5 x 36 and 0.9 x 25 are too little, 2 x 25 weighs more
    assert found.complete
    assert len(desk.solids) < 9


def test_another_number_may_be_made_large(tmp_path):
    """The greatest safety factor wants all of both sizes; of several such numbers the least counts."""
    plan = plan_of({"case": "owl-wing-static", "vary": {B: "1 mm, 2 mm", H: "4 mm, 6 mm"}, "fidelity": "solid"})
    desk = Desk(lambda b, h, f: {"strength": (b * h / 9.0, 0.0), "slenderness": (b * h / 3.0, 0.0)})
    axes = axis(B, "1 mm, 2 mm"), axis(H, "4 mm, 6 mm")
    with Store.writing(tmp_path) as store:
        asked = Search(plan, Path(), store, Engine(submit=desk.submit, capacity=lambda: 6))
        found = lightest(asked, axes, Objective(quantity="safety factor", largest=True))
    assert list(found.point(found.best).values()) == ["2 mm", "6 mm"]
    assert found.objective.number(found.solved[found.best]).value == pytest.approx(12.0 / 9.0)
    assert all(gain.cost < 0.0 or gain.share < 0.0 for gain in found.gains)


def test_what_cannot_be_found_is_told(tmp_path):
    """None passes; a limit on what is solved; a case that refuses all; a number that is not there."""
    few = {"h": "5 mm..9 mm by 0.5 mm"}
    found, _ = search(Desk(bending(c=1e4)), tmp_path / "fails", **few)
    assert found.best is None
    assert none_passes(found)
    found, _ = search(Desk(bending(c=30.0, hand=3.0)), tmp_path / "few", most=1, **few)
    assert not found.complete
    assert len(found.solved) == 1
    with pytest.raises(CaseError, match="no bore that wide"):
        search(Desk(lambda b, h, fidelity: None), tmp_path / "refused", **few)
    plan = plan_of({"case": "owl-wing-static", "vary": {B: "1 mm, 2 mm"}, "fidelity": "solid"})
    with Store.writing(tmp_path / "cost") as store:
        asked = Search(plan, Path(), store, Engine(submit=Desk(bending(c=1.0)).submit, capacity=lambda: 6))
        with pytest.raises(CaseError, match="choose among mass, safety factor"):
            lightest(asked, (axis(B, "1 mm, 2 mm"),), Objective(quantity="colour"))


@pytest.mark.parametrize(("largest", "best", "cost"), [(False, ["1 mm", "4 mm"], -4.0), (True, ["2 mm", "6 mm"], 6.0)])
def test_torques_of_the_drive_are_compared_by_their_size(tmp_path, largest, best, cost):
    """Of two load cases that turn it either way the larger counts where the least is sought, the smaller otherwise."""

    class Driven(Desk):
        def answer(self, factors, cost):
            found = super().answer(factors, cost)
            sides = {"up": -1.0, "down": 0.5}
            torques = [
                VariantNumber.exact("drive torque", "N·mm", k * cost, "the drive", at) for at, k in sides.items()
            ]
            return replace(found, numbers=(*found.numbers, *torques))

    plan = plan_of({"case": "owl-wing-static", "vary": {B: "1 mm, 2 mm", H: "4 mm, 6 mm"}, "fidelity": "solid"})
    axes = axis(B, "1 mm, 2 mm"), axis(H, "4 mm, 6 mm")
    with Store.writing(tmp_path) as store:
        asked = Search(plan, Path(), store, Engine(submit=Driven(bending(c=1.0)).submit, capacity=lambda: 6))
        found = lightest(asked, axes, Objective(quantity="drive torque", largest=largest))
    assert list(found.point(found.best).values()) == best
    assert found.objective.number(found.solved[found.best]).value == cost
