"""Settings that all tests share."""

import errno
import gc
import os
import shutil
import sys
import tempfile
from pathlib import Path

import chromium
import pytest
from _pytest import runner
from hypothesis import settings

# No deadline per example: a first call may import a library or build a mesh, and machines that test are busy.
# Forty examples find in seconds what is wrong often; what is wrong once in a million is for the fuzzer.
settings.register_profile("unhurried", parent=settings(), deadline=None, max_examples=40)
settings.load_profile("unhurried")


PROGRAMS = ("bash", "make", "mount", "umount", "localedef", "chromedriver", "ccx")
"""What tests may start besides Python and what they wrote themselves: the shell and make, which set-up needs, and what
they do without where it is missing."""


def as_on_a_bare_machine(event, arguments):
    """Let no test start a program that set-up does not install, as if it were missing: an audit hook."""
    if event == "subprocess.Popen":
        name = Path(os.fsdecode(arguments[0]))
        own = name.is_absolute() and (name.is_relative_to(sys.prefix) or name.is_relative_to(tempfile.gettempdir()))
        if not own and name.name not in PROGRAMS:
            raise FileNotFoundError(errno.ENOENT, "a test may start no program that set-up does not install", str(name))


def pytest_configure(config):
    """Make the folder by which the processes of a run share what they solve (``solved``); watch what tests start."""
    sys.addaudithook(as_on_a_bare_machine)
    os.environ["ALULA_CACHE"] = ""  # what an earlier run solved would hide what has changed
    # Child processes that wait for requests serve those of one environment, and each test would start its own.
    runner._update_current_test_var = lambda item, when: None
    if not hasattr(config, "workerinput"):
        os.environ["ALULA_TESTS_SHARE"] = tempfile.mkdtemp(prefix="alula-tests-")


@pytest.hookimpl(hookwrapper=True)
def pytest_collection():
    """Look for no garbage while half a million objects are made that stay, nor ever again among them."""
    gc.disable()
    yield
    gc.enable()
    gc.freeze()


def pytest_collection_finish(session):
    """Let the processes of a run share what the kernel says of bodies that several tests weigh."""
    import solved

    solved.share_masses()


def pytest_unconfigure(config):
    """Remove it."""
    if not hasattr(config, "workerinput"):
        shutil.rmtree(os.environ["ALULA_TESTS_SHARE"], ignore_errors=True)


def pytest_generate_tests(metafunc):
    """Run the tests of ``benchmark_tests`` on each of the importing module's BENCHMARKS."""
    if "benchmark" in metafunc.fixturenames:
        metafunc.parametrize("benchmark", metafunc.module.BENCHMARKS, ids=str)


def pytest_terminal_summary(terminalreporter):
    """Say at the end that no page was tested in a browser, which a letter among thousands does not tell."""
    reasons = {str(report.longrepr) for report in terminalreporter.stats.get("skipped", [])}
    if any(chromium.MISSING in reason for reason in reasons):
        terminalreporter.write_line(chromium.MISSING[0].upper() + chromium.MISSING[1:])
