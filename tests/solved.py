"""Results of built-in cases that tests of several files read: solved once per run of the tests, and frozen."""

import hashlib
import os
import pickle
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar
from unittest.mock import patch

from edited_cases import PLANAR

from alula.fea.check.run import check_case
from alula.fea.claims.audit import ClaimResult
from alula.fea.claims.sources import check_all
from alula.fea.findings.of_check import with_findings
from alula.fea.outcomes.result import CheckResult
from alula.geometry.base.locks import locked
from alula.geometry.meshing.mesh import MassProperties, mass_properties
from alula.geometry.parts.part import Body
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.states import masses

T = TypeVar("T")


def shared(name: str, solve: Callable[[], T]) -> T:
    """Return what one process of a run solves, while the others wait for it; ``conftest`` makes the folder."""
    if "ALULA_TESTS_SHARE" not in os.environ:  # no run of tests
        return solve()
    folder = Path(os.environ["ALULA_TESTS_SHARE"], hashlib.sha256(name.encode()).hexdigest())
    folder.mkdir(exist_ok=True)
    held, file = locked(folder, wait=True), folder / "result.pickle"
    try:
        if file.exists():
            found: T = pickle.loads(file.read_bytes())
        else:
            found = solve()
            file.write_bytes(pickle.dumps(found))
    finally:
        if held is not None:
            os.close(held)
    return found


def share_masses() -> None:
    """Measure equal bodies once per run: ``alula.loads.states.masses`` measures them once per process."""

    @cache
    def measured(body: Body) -> MassProperties:
        fixed = body.part.is_fixed  # a part from a file, whose content its name does not tell
        return mass_properties(body) if fixed else shared(f"mass {body!r}", lambda: mass_properties(body))

    masses._measured = measured


WINGS = dict.fromkeys(("flapping-wing-chosen", "ornithopter"), (PLANAR, "motion.poses=13"))
"""Entries with which tests take cases that flap: by hand, layers and every degree of motions take most of a minute, and
stand in other cases (``owl-wing-flight``, ``slider-crank``)."""


FEWER = {
    "flapping-wing-chosen": ("held", "flapping"),
    "ornithopter": ("slow", "wings-10-air", "wings-12-air"),
    "owl-wing-anchor": ("weight",),
    "owl-wing-flight": ("complete",),
}
"""Load cases under which tests take long cases by hand; the others are these with other numbers. ``make verify`` has
all of what flaps by its solids, and all of the flight in other air (``owl-wing-braking``); the ground's part bears that
of the anchor in the same way."""


def few(name: str, case: Case) -> Case:
    """Return a built-in case under the load cases that tests take."""
    if name not in FEWER:
        return case
    return case.model_copy(update={"load_cases": {one: case.load_cases[one] for one in FEWER[name]}})


ALIKE = ("owl-wing-braking", "flapping-wing-reference")
"""Built-in cases that are others with other numbers: the flight in other air, the chosen flapping wing with other
lengths."""


@cache
def by_hand(name: str, *overrides: str) -> CheckResult:
    """Check a built-in case by hand calculation, with entries set anew; without any, by ``WINGS`` and ``FEWER``."""

    def solve() -> CheckResult:
        case = read_case(name, overrides) if overrides else few(name, read_case(name, WINGS.get(name, ())))
        found = check_case(case, name=name, fidelity="beam")
        for one in found.load_cases.values():  # what reports ask for, so that no other process finds it again
            _ = one.linkage.displacement_and_place, one.linkage.limit_load
        return found

    return shared(f"by hand {name} {overrides}", solve)


@cache
def told(name: str, *overrides: str) -> CheckResult:
    """Return ``by_hand`` with what a report tells besides."""
    return shared(f"told {name} {overrides}", lambda: with_findings(by_hand(name, *overrides)))


@cache
def claims() -> dict[str, tuple[ClaimResult, ...]]:
    """Return the claims of every source document; their hand calculations are those of ``by_hand`` in one plane."""
    return shared("claims", _claims)


def _claims() -> dict[str, tuple[ClaimResult, ...]]:
    def of_this_process(case: Case, *, name: str, fidelity: str, **options: Any) -> CheckResult:
        assert case == read_case(name).in_one_plane()
        return (
            by_hand(name, PLANAR) if fidelity == "beam" else check_case(case, name=name, fidelity=fidelity, **options)
        )

    with patch("alula.fea.claims.data.check_case", of_this_process):
        return check_all()
