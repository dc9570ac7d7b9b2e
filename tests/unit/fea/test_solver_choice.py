"""Which solver is chosen: the one that was measured to be quicker, and one that fits into memory."""

from types import SimpleNamespace

import numpy as np
import pytest
import solid_meshes

from alula.fea.common import memory, mkl
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import isostatic_supports
from alula.fea.solvers import solve
from alula.fea.solvers.solve import available_methods, direct_memory, factorise, two_level_memory
from alula.fea.solvers.two_level import LinearLevel
from alula.geometry.base.errors import CannotRunError
from alula.reports.sentences import told


@pytest.fixture(scope="module")
def small():
    space = displacement_space(solid_meshes.box())
    fixed = isostatic_supports(space.nodes, space.corners)
    K = assemble_stiffness(space, E=2900.0, nu=0.38).with_fixed(fixed)
    return K, LinearLevel(space=space, E=2900.0, nu=0.38, fixed=fixed)


def _choice(unknowns, *, nu=0.38, right_hand_sides=1, direct="pardiso", room=16e9, slenderness=6.0, monkeypatch):
    """What the chooser says about a system of that size, which is not made."""
    K = SimpleNamespace(size=unknowns, blocks=SimpleNamespace(nbytes=int(72 * 4.8 * unknowns)))
    level = SimpleNamespace(space=SimpleNamespace(corners=unknowns // 23), nu=nu, slenderness=slenderness)
    monkeypatch.setattr(memory, "available", lambda: room)
    return solve._chosen(K, level, right_hand_sides, direct, None)


@pytest.mark.parametrize(
    ("unknowns", "options", "method", "reason"),
    [
        (20_000, {}, "pardiso", "small enough"),
        (160_000, {}, "two-level", "more than 33,000 unknowns, up to which MKL PARDISO takes less work"),
        (160_000, {"right_hand_sides": 60}, "pardiso", "60 right-hand sides: small enough"),
        (160_000, {"nu": 0.495}, "pardiso", "ν = 0.495 is above 0.49"),
        (550_000, {"right_hand_sides": 10}, "two-level", "takes less work"),
        (550_000, {"right_hand_sides": 60}, "pardiso", "60 right-hand sides"),
        (550_000, {"right_hand_sides": 200, "room": 4e9}, "two-level", "a factorisation needs about"),
        (1_500_000, {}, "two-level", "GB left"),
        (785_000, {"slenderness": 625.0}, "pardiso", "625 times as long as wide"),
        (785_000, {"slenderness": 625.0, "room": 4e9}, "pardiso", "625 times as long as wide"),
        (160_000, {"slenderness": 62.0, "direct": "superlu", "room": 4e9}, "two-level", "a factorisation needs about"),
        (20_000, {"direct": "superlu"}, "two-level", "SuperLU takes less work"),
        (5_000, {"direct": "superlu"}, "superlu", "small enough"),
    ],
)
def test_choice_and_reason(unknowns, options, method, reason, monkeypatch):
    chosen, why = _choice(unknowns, **options, monkeypatch=monkeypatch)
    assert chosen == method
    assert reason in told(why)


@pytest.mark.parametrize(
    ("unknowns", "right_hand_sides", "factorised", "iterated"),
    [
        (37_011, 1, 0.67, 0.26),
        (37_011, 4, 0.69, 0.69),
        (37_011, 16, 0.74, 2.78),
        (47_664, 1, 0.89, 0.54),
        (62_031, 2, 1.22, 1.46),
        (98_475, 2, 2.54, 1.86),
        (98_475, 4, 2.62, 3.38),
        (107_349, 4, 2.87, 4.18),
        (123_000, 1, 3.5, 1.1),
        (160_000, 1, 9.9, 1.2),
        (160_000, 4, 10.2, 3.4),
        (160_000, 60, 15.8, 46.0),
    ],
)
def test_what_takes_less_work_is_chosen(unknowns, right_hand_sides, factorised, iterated, monkeypatch):
    """Or takes below 1 s. Seconds of one core, of links from the mesher (37,011: growth.json) and a bar (160,000)."""
    chosen, _ = _choice(unknowns, right_hand_sides=right_hand_sides, monkeypatch=monkeypatch)
    taken = iterated if chosen == "two-level" else factorised
    assert taken <= max(1.0, min(factorised, iterated))


def test_what_fits_nowhere_is_refused_with_the_estimate(monkeypatch):
    with pytest.raises(
        CannotRunError, match=r"1,500,000 unknowns by conjugate gradients.* needs about .* GB .*0\.5 GB"
    ):
        _choice(1_500_000, room=0.5e9, monkeypatch=monkeypatch)
    with pytest.raises(CannotRunError, match=r"500,000 unknowns by MKL PARDISO needs about 7\.\d GB .* 4 GB are left"):
        _choice(500_000, nu=0.499, room=4e9, monkeypatch=monkeypatch)


@pytest.mark.skipif("pardiso" not in available_methods(), reason="MKL is not installed")
def test_factor_tells_its_name_and_reason(small):
    K, level = small
    factor = factorise(K, level=level, right_hand_sides=2)
    assert factor.name == "MKL PARDISO"
    assert told(factor.reason) == f"{K.size} unknowns, 2 right-hand sides: small enough for a factorisation"
    forced = factorise(K, level=level, method="two-level")
    assert forced.name == "conjugate gradients over linear elements by MKL PARDISO"
    assert told(forced.reason) == "chosen by the user"
    assert told(factorise(K).reason).endswith("factorisation alone suits this system")


def test_two_levels_that_do_not_fit_are_refused_before_they_are_made(small):
    K, level = small
    with pytest.raises(CannotRunError, match="unknowns by conjugate gradients over linear elements needs about"):
        factorise(K, level=level, method="two-level", memory_limit=1.0)


def test_two_levels_need_quadratic_elements(small):
    K, _ = small
    with pytest.raises(CannotRunError, match=r"needs quadratic elements"):
        factorise(K, method="two-level")


@pytest.mark.parametrize(
    ("method", "unknowns", "space"),
    [
        ("pardiso", 47_000, 0.26e9),
        ("pardiso", 152_000, 1.35e9),
        ("pardiso", 499_000, 7.2e9),
        ("superlu", 14_700, 0.17e9),
        ("superlu", 47_000, 1.4e9),
    ],
)
def test_estimated_memory_of_factorisations_fits_the_measurements(method, unknowns, space):
    assert direct_memory(method, unknowns, 1) == pytest.approx(space, rel=0.25)


@pytest.mark.skipif("pardiso" not in available_methods(), reason="MKL is not installed")
def test_estimated_memory_of_a_factor_bounds_what_its_analysis_finds(small):
    space = displacement_space(solid_meshes.box(counts=(8, 8, 8), upper=(1.0, 1.0, 1.0)))
    K = assemble_stiffness(space, E=2900.0, nu=0.3)
    K = K.with_fixed(isostatic_supports(space.nodes, space.corners))
    found = factorise(K, method="pardiso").solver.memory
    assert 0.5 * found < direct_memory("pardiso", K.size, 1) < 1.5 * found


def test_two_levels_take_less_memory_than_a_factorisation():
    large = SimpleNamespace(size=550_000, blocks=SimpleNamespace(nbytes=190e6))
    level = SimpleNamespace(space=SimpleNamespace(corners=25_000), nu=0.38)
    assert two_level_memory(large, level, 1, "pardiso") < 0.2 * direct_memory("pardiso", 550_000, 1)


@pytest.mark.parametrize("method", [*available_methods(), "two-level", None])
def test_small_limit_is_refused_before_the_factorisation(small, method):
    K, level = small
    limit = memory.resident() + 1e4
    with pytest.raises(CannotRunError, match=r"needs about .* GB of memory and .* of the limit of .* coarser mesh"):
        factorise(K, level=level, method=method, memory_limit=limit)
    factorise(K, level=level, method=method, memory_limit=limit + 1e9)


@pytest.mark.skipif("pardiso" not in available_methods(), reason="MKL is not installed")
@pytest.mark.parametrize("threads", [1, 2])
def test_repeated_solutions_are_equal(threads):
    space = displacement_space(solid_meshes.ring(3.0, 5.0, 2.0, around=16))
    fixed = isostatic_supports(space.nodes, space.corners)
    rhs = np.random.default_rng(2).normal(size=(space.unknowns, 2))
    rhs[fixed] = 0.0

    def run(method):
        K = assemble_stiffness(space, E=2900.0, nu=0.38).with_fixed(fixed)
        level = LinearLevel(space=space, E=2900.0, nu=0.38, fixed=fixed)
        return factorise(K, level=level, method=method, threads=threads).solve(rhs)

    for method in ("pardiso", "two-level"):
        first, kept, second = run(method), np.empty(12345, dtype=np.int8), run(method)  # other addresses
        assert len(kept)
        if threads == 1:
            np.testing.assert_array_equal(first, second)
        else:
            np.testing.assert_allclose(first, second, rtol=0.0, atol=1e-9 * np.abs(first).max())


@pytest.mark.skipif("pardiso" not in available_methods(), reason="MKL is not installed")
def test_threads_are_bounded_while_solving_and_given_back(small, monkeypatch):
    from threadpoolctl import threadpool_info

    K, level = small
    seen = []
    factor = factorise(K, level=level, threads=1)
    exact = factor.solver.apply
    monkeypatch.setattr(
        factor.solver, "apply", lambda b: (seen.append([p["num_threads"] for p in threadpool_info()]), exact(b))[1]
    )
    before = [p["num_threads"] for p in threadpool_info()]
    rhs = np.zeros(K.size)
    rhs[-1] = 1.0
    factor.solve(rhs)
    assert seen
    assert set(seen[0]) == {1}
    assert [p["num_threads"] for p in threadpool_info()] == before


def test_installed_library_is_found():
    assert mkl.installed() == ("pardiso" in available_methods())
