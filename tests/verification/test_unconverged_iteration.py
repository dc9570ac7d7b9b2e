"""No path through the program reports a number from an iteration that has not converged."""

import tomllib
from functools import partial

import arm_case
import pytest
import rocker_case

from alula.fea.check.run import check_case
from alula.fea.motion.envelope import envelope_case
from alula.fea.refine.refinement import Effort
from alula.fea.solvers import solve, two_level
from alula.geometry.base.errors import CannotRunError
from alula.loads.case.case_file import validate


@pytest.fixture
def iterative(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Have every system iterated; returns the sizes of those that were."""
    sizes: list[int] = []

    def chosen(K, level, *rest):
        sizes.append(K.size)
        return "two-level", "chosen by this test"

    monkeypatch.setattr(solve, "_chosen", chosen)
    return sizes


@pytest.mark.parametrize(
    ("case", "run"),
    [
        pytest.param(arm_case.arm(), partial(check_case, fidelity="solid"), id="check"),
        pytest.param(validate(tomllib.loads(rocker_case.TOML)), envelope_case, id="envelope"),
    ],
)
def test_an_iteration_without_convergence_ends_the_run(case, iterative, monkeypatch, run):
    monkeypatch.setattr(two_level, "MOST_ITERATIONS", 4)
    with pytest.raises(CannotRunError, match=r"^\w+: .*did not converge in 4 iterations.*choose a direct solver"):
        run(case, threads=1, effort=Effort(max_meshes=1))
    assert len(iterative) == 1, "the first system that does not converge ends it"
