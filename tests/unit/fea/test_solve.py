from dataclasses import replace

import numpy as np
import pytest
import solid_meshes

from alula.fea.common import mkl
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import isostatic_supports
from alula.fea.solvers.direct import PardisoFactor
from alula.fea.solvers.solve import available_methods, factorise
from alula.fea.solvers.solved import ENERGY_TARGET, refined, sampled_error
from alula.geometry.base.errors import CannotRunError

METHODS = available_methods()


@pytest.fixture(scope="module")
def system():
    space = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=12))
    K = assemble_stiffness(space, E=2900.0, nu=0.38)
    fixed = isostatic_supports(space.nodes, space.corners)
    rhs = np.random.default_rng(5).normal(size=(K.size, 3))
    rhs[fixed] = 0.0
    return K, K.with_fixed(fixed), rhs, fixed


@pytest.mark.parametrize("method", METHODS)
def test_solution_satisfies_the_system(system, method):
    _, K, rhs, fixed = system
    factor = factorise(K, method=method, threads=1)
    x = factor.solve(rhs)
    assert np.abs(K.full() @ x - rhs).max() < 1e-8 * np.abs(rhs).max()
    np.testing.assert_array_equal(x[fixed], 0.0)
    np.testing.assert_allclose(factor.solve(rhs[:, 1]), x[:, 1], atol=1e-9 * np.abs(x).max())


@pytest.mark.skipif(len(METHODS) < 2, reason="MKL is not installed")
def test_solvers_agree(system):
    _, K, rhs, _ = system
    one, other = (factorise(K, method=m, threads=1).solve(rhs) for m in METHODS)
    np.testing.assert_allclose(one, other, atol=1e-8 * np.abs(one).max())


@pytest.mark.parametrize("method", METHODS)
def test_unsupported_body_is_refused(system, method):
    free, _, _, _ = system
    load = np.zeros(free.size)
    load[0] = 1.0  # does not balance, so no displacement fits it
    with pytest.raises(CannotRunError, match=r"not positive definite|energy norm|could not solve"):
        factorise(free, method=method, threads=1).solve(load)


@pytest.mark.parametrize("method", METHODS)
def test_wrong_solution_is_refined_and_a_hopeless_one_refused(system, method):
    _, K, rhs, _ = system
    factor = factorise(K, method=method, threads=1)
    exact = factor.solver.apply
    factor.solver.apply = lambda b: 1.0001 * exact(b)
    solved = factor.solved(rhs)
    assert solved.error < ENERGY_TARGET
    np.testing.assert_allclose(solved.x, exact(rhs), atol=1e-9 * np.abs(solved.x).max())
    factor.solver.apply = lambda b: 2.5 * exact(b)
    with pytest.raises(CannotRunError, match=r"leaves an error of .* of the solution in the energy norm"):
        factor.solve(rhs)


@pytest.mark.parametrize("wrong", range(6))
def test_one_wrong_column_of_many_is_found_without_solving_each_twice(system, wrong):
    """Two probes and one column stand for all: the error of a single bad column must not hide among good ones."""
    _, K, _, fixed = system
    columns = np.random.default_rng(3).normal(size=(K.size, 6)) * np.logspace(-6, 6, 6)
    columns[fixed] = 0.0
    factor = factorise(K, method=METHODS[0], threads=1).solver
    solved = []

    def apply(b):
        x = factor.apply(b)
        solved.append(1 if b.ndim == 1 else b.shape[1])
        if len(solved) == 1:
            x[:, wrong] *= 1.001
        return x

    x, error = refined(K, apply, columns)
    assert solved[:3] == [6, 3, 6], "all columns, the probes, and a refinement since the error is 0.1 %"
    assert error < ENERGY_TARGET
    exact = factor.apply(columns)
    assert (np.abs(x - exact).max(axis=0) < 1e-9 * np.abs(exact).max(axis=0)).all()
    unrefined = exact.copy()
    unrefined[:, wrong] *= 1.001
    residual = columns - K @ unrefined
    assert sampled_error(residual, factor.apply, columns, unrefined) == pytest.approx(1e-3, rel=1e-3)


def test_fallback_where_mkl_is_not_installed(system, monkeypatch):
    _, K, rhs, _ = system
    monkeypatch.setattr(mkl, "_candidates", lambda: iter(()))
    monkeypatch.setattr(mkl, "library", mkl.library.__wrapped__)
    assert available_methods() == ("superlu",)
    bare = replace(K)  # its product is not made yet
    factor = factorise(bare)
    assert factor.name == "SuperLU"
    monkeypatch.setattr("sys.platform", "linux")
    for machine in ("x86_64", "aarch64"):
        monkeypatch.setattr("platform.machine", lambda machine=machine: machine)
        assert (factorise(bare).reason.kind == "without_mkl") == (machine == "x86_64")
    x = factor.solve(rhs)
    assert not isinstance(bare.product, mkl.SymmetricProduct)
    assert np.abs(K.full() @ x - rhs).max() < 1e-8 * np.abs(rhs).max()
    with pytest.raises(ImportError, match=r"not installed"):
        factorise(K, method="pardiso")


@pytest.mark.skipif("pardiso" not in METHODS, reason="MKL is not installed")
def test_fallback_where_mkl_cannot_be_loaded(system, monkeypatch, tmp_path):
    _, K, _, _ = system
    broken = tmp_path / "libmkl_rt.so"
    broken.write_text("no library")
    monkeypatch.setattr(mkl, "_candidates", lambda: iter([broken]))
    monkeypatch.setattr(mkl, "library", mkl.library.__wrapped__)
    assert factorise(K).name == "SuperLU"
    with pytest.raises(ImportError, match=r"cannot be loaded"):
        factorise(K, method="pardiso")


@pytest.mark.skipif("pardiso" not in METHODS, reason="MKL is not installed")
def test_pardiso_gives_its_memory_back(system):
    _, K, _, _ = system
    factor = PardisoFactor(K)
    handle = factor._handle
    assert handle.any()
    finalizer = factor._finalizer
    del factor
    assert not finalizer.alive
    assert not handle.any()


def test_fixing_keeps_the_matrix_symmetric_and_the_original_unchanged(system):
    free, fixed_matrix, _, fixed = system
    full = fixed_matrix.full()
    assert abs(full - full.T).max() == 0.0
    diagonal = full.diagonal()
    for unknown in fixed:
        row = full[[unknown], :].toarray().ravel()
        assert np.count_nonzero(row) == 1
        assert diagonal[unknown] == free.full().diagonal()[unknown] > 0.0
    free_rows = np.setdiff1d(np.arange(free.size), fixed)
    assert abs((full - free.full())[free_rows][:, free_rows]).max() == 0.0


def test_fixing_in_place_returns_what_it_takes_away(system):
    free, fixed_matrix, rhs, fixed = system
    K = free.copy()
    before = K @ rhs
    removed = K.fix(fixed)
    np.testing.assert_array_equal(K.blocks, fixed_matrix.blocks)
    assert abs(K.full() + removed - free.full()).max() < 1e-15 * abs(free.full()).max()  # full() mirrors one triangle
    np.testing.assert_allclose(K @ rhs + removed @ rhs, before, rtol=0.0, atol=1e-12 * np.abs(before).max())
