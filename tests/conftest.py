"""Settings that all tests share."""

import pickle

import pytest
from hypothesis import settings

# No deadline per example: a first call may import a library or build a mesh, and machines that test are busy.
# Forty examples find in seconds what is wrong often; what is wrong once in a million is for the fuzzer.
settings.register_profile("unhurried", parent=settings(), deadline=None, max_examples=40)
settings.load_profile("unhurried")


def pytest_generate_tests(metafunc):
    """Run the tests of ``benchmark_tests`` on each of the importing module's BENCHMARKS."""
    if "benchmark" in metafunc.fixturenames:
        metafunc.parametrize("benchmark", metafunc.module.BENCHMARKS, ids=str)


@pytest.fixture(autouse=True, scope="session")
def bodies_weighed_in_this_process():
    """Have the geometry kernel weigh bodies without a child process, which takes ten times as long to start.

    Whatever fails is asked of the child again. Meshes, and sharp edges, which another thread looks for, stay there.
    """
    from geometry.meshing import mesh, mesh_worker

    child = mesh._run

    def run(task, *arguments, **limits):
        if task == "mass":
            kind, result = mesh_worker._answer(task, *pickle.loads(pickle.dumps(arguments)))
            if kind == "done":
                return result
        return child(task, *arguments, **limits)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mesh, "_run", run)
        yield
