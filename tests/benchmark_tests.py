"""What every published benchmark with a known answer must keep, mesh by mesh; a module lists its own in BENCHMARKS.

    from benchmark_tests import *  # noqa: F403  each of the module's BENCHMARKS is tested

``conftest.py`` runs the imported tests on the benchmarks of the module that imports them.
"""

import pytest

__all__ = ["test_band_and_estimate", "test_coarse", "test_converged"]


def test_coarse(benchmark):
    benchmark.check("coarse")


@pytest.mark.converged
def test_converged(benchmark):
    benchmark.check("converged")


@pytest.mark.converged
def test_band_and_estimate(benchmark):
    for study in benchmark.studies():
        study.check()
