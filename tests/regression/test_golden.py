"""The built-in cases give the numbers that they gave before (regressions, not truths)."""

import json

import golden
import pytest


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.converged] if golden.slow(n) else []) for n in golden.commands()]
)
def test_the_numbers_are_what_they_were(name: str) -> None:
    path = golden.path_of(name)
    if golden.slow(name) and not path.exists():
        pytest.skip("this result is not recorded yet; make golden records it")
    kept = json.loads(path.read_text(encoding="utf-8"))
    found = golden.differences(kept, golden.run(name), golden.tolerance(name))
    assert not found, "\n".join([f"{len(found)} entries differ; make golden renews them", *found[:20]])


def test_a_difference_names_entry_values_and_tolerance() -> None:
    kept = {"a.x[0]": 1.0, "a.x[1]": 1e-12, "verdict": "pass", "b": 2.0}
    assert golden.differences(kept, {**kept, "a.x[1]": -3e-12}, 1e-9) == []
    assert golden.differences(kept, {**kept, "a.x[0]": 1.0 + 2e-9}, 1e-9) == [
        "a.x[0]: 1.000000002, it was 1 (tolerance 1e-09)"
    ]
    found = {"a.x[0]": 1.0, "a.x[1]": 1e-12, "verdict": "fail", "c": 3.0}
    assert golden.differences(kept, found, 1e-9) == ["b: gone, it was 2.0", "c: new, 3.0", "verdict: fail, it was pass"]


def test_numbers_that_measure_error_count_from_a_floor_of_their_kind() -> None:
    kept = {"a.residual": 1e-15, "a.solver_error": 2e-10, "links.a.support_reaction": 3e-12, "a.stress": 1e-10}
    assert golden.differences(kept, {**kept, "a.residual": 9e-13}, 1e-6) == []
    assert golden.differences(kept, {**kept, "a.solver_error": 9e-9, "links.a.support_reaction": 9e-9}, 1e-6) == []
    still = {"links.a.displacement_max.low": 4e-19, "motion.links.b.first": 7e-13}
    assert golden.differences(still, dict.fromkeys(still, 0.0), 1e-9) == []
    assert len(golden.differences(still, dict.fromkeys(still, 2e-9), 1e-9)) == 2
    for entry in kept:
        assert len(golden.differences(kept, {**kept, entry: 2e-8}, 1e-6)) == 1
