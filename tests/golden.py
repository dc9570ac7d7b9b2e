"""Golden results: the numbers that alula's commands gave for the built-in cases, kept to notice any change.

They are regressions: they say that a number is what it was, not that it is right. A commit that changes one renews its
file with ``make golden`` and says why.
"""

import contextlib
import fnmatch
import io
import json
import math
import re
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import solved
from told import as_json

from alula.fea.standing import case_statics
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, read_text

FOLDER = Path(__file__).parent / "regression" / "golden"
EXACT, ITERATED, MESHED = 1e-9, 2e-6, 2e-6
"""Relative tolerances: of what no iteration and no mesh has a part in; of hand calculation, whose frames have iterated
eigenvalues that repeat to 1.4e-9 on a busy machine; and of what goes through a mesh."""
FOLLOWED, PATH = (".limit_load.", ".held."), 1e-4
"""Entries that end where the steps of a path to a limit load do, and their tolerance. The steps come within 1.6 % of
the limit point and bend with the path, so that another processor's rounding moved them by 6e-6."""
FLOORS = {"residual": 1e-12, "imbalance": 1e-12, "moment": 1e-12, "solver_error": 1e-8, "support_reaction": 1e-8}
FLOORS |= {f"displacement_max.{end}": 1e-12 for end in ("value", "low", "high")} | {"first": 1e-9, "smallest": 1e-9}
"""Differences that are allowed however small the number is, by the end of an entry's path. Residuals and imbalances,
relative, and moments, in N mm, are rounding below 1e-12, and any order of sums may change them. The error of a solver,
relative to the solution, and the reaction of supports, relative to the load, measure error themselves: they are below
1e-9 in all kept results, and differences below 1e-8 have no meaning. Links that nothing bends deflect by rounding [mm],
and a link that starts along x is turned by rounding [deg]."""
STARTERS = ("finger", "four-bar", "knee", "pylon", "six-bar", "slider-crank", "step")
"""Built-in cases of our own, to start from. Their joint forces and torques are compared with closed forms
(``tests/verification/test_starters.py``), so that their hand calculation alone is kept here."""
VOLATILE = ("schema_version", "timings", "timings_s", "kept", "seconds", "version", "next_cost", "work", "memory")
"""Entries that differ from run to run or from machine to machine."""
DERIVED = ("margin", "changes", "tiers")
"""Entries that follow from kept ones, by rules that have tests of their own (``tests/unit/fea/test_changes.py``,
``test_tiers.py``)."""
WHOLE = ("mass", "size", "frequencies")
"""Entries of a whole result that closed forms are compared with (``tests/unit/fea/test_mass_and_size.py`` and
``test_frequency_check.py``)."""
FEWER_POSES = {"flapping-wing-chosen": ("--set", "motion.poses=37")}
"""Play at every degree of this motion takes as long as all other motions together; at every tenth it tells the same."""
UNHURRIED = ("--json", "--threads", "1", "--time-limit", "1e6")
"""Arguments of results that go through a mesh. No limit of time ends their refinement, which would make them depend on
how fast and how busy the machine is."""
FRAMED = "linkage"
"""Entry whose numbers come from the frame; they are kept with hand calculations and motions alone."""


def commands() -> dict[str, list[str]]:
    """Every golden result by its name: the arguments of the command that gives it as JSON.

    Hand calculation and statics of long cases are kept under fewer load cases (``solved.FEWER``).
    """
    found = {"synth": ["synth", "--json"], "claims": ["claims", "--fidelity", "beam", "--json"]}
    for case in built_in_cases():
        sets = [word for entry in solved.WINGS.get(case, ()) for word in ("--set", entry)]
        found[f"hand-{case}"] = ["check", case, "--fidelity", "beam", "--json", *sets]
        if case in STARTERS:
            continue
        found |= {
            f"statics-{case}": ["statics", case, "--json", *sets],
            f"auto-{case}": ["check", case, *UNHURRIED],
            f"solid-{case}": ["check", case, "--fidelity", "solid", *UNHURRIED],
        }
        if "[motion]" in read_text(case)[0]:
            found |= {
                f"motion-{case}": ["motion", case, "--json", *FEWER_POSES.get(case, ())],
                f"envelope-{case}": ["envelope", case, *UNHURRIED],
            }
    return found


def meshed(name: str) -> bool:
    """True for a result that goes through a mesh."""
    return name.startswith(("auto", "solid", "envelope"))


def tolerance(name: str) -> float:
    """Relative tolerance of a golden result."""
    return MESHED if meshed(name) else ITERATED if name.startswith(("hand", "claims")) else EXACT


def slow(name: str) -> bool:
    """True for a result that ``make verify`` compares and ``make test`` does not.

    Braking is the flight's case in other air, and the longest of all by hand; the reference design of the flapping wing
    is the chosen one with other lengths.
    """
    return meshed(name) or name.partition("-")[2] in solved.ALIKE or name == "claims"


def numbers(data: Any, path: str = "") -> Iterator[tuple[str, float | str | None]]:
    """Yield path and value of every number, verdict and finding in plain data."""
    if isinstance(data, dict):
        for key, value in data.items():
            if key not in (*VOLATILE, *DERIVED, *(() if path else WHOLE)):
                yield from numbers(value, f"{path}.{key}" if path else key)
    elif isinstance(data, list):
        for i, value in enumerate(data):
            yield from numbers(value, f"{path}[{i}]")
    elif path.endswith(("verdict", "finding")) or (isinstance(data, int | float) and not isinstance(data, bool)):
        yield path, data


def with_pins_by_hand(case: Case, name: str) -> CaseStatics:
    """Solve the statics of a case; where pins may stand in their holes is as in the check by hand."""
    found = solve_case_statics(solved.few(name, case), name)
    forces = {load_case: one.forces for load_case, one in solved.by_hand(name).load_cases.items()}
    for load_case, own in found.reactions.items():
        np.testing.assert_allclose(own.unknowns, forces[load_case].reactions.unknowns, rtol=EXACT, atol=EXACT)
    return replace(found, forces=forces)


def run(name: str) -> dict[str, float | str | None]:
    """Run the command of a golden result and return its numbers by path; hand calculations are shared with tests."""
    command, _, case = name.partition("-")
    if command == "hand":
        return dict(numbers(json.loads(as_json(solved.by_hand(case)))))
    from alula.reports.commands.cli import app

    told = io.StringIO()
    with contextlib.ExitStack() as stack:
        if command == "statics" and not slow(f"hand-{case}"):
            stack.enter_context(patch.object(case_statics, "solve_case_statics", with_pins_by_hand))
        stack.enter_context(contextlib.redirect_stdout(told))
        stack.enter_context(contextlib.redirect_stderr(io.StringIO()))
        stack.enter_context(contextlib.suppress(SystemExit))
        app(commands()[name])
    found = dict(numbers(json.loads(told.getvalue())))
    return {path: value for path, value in found.items() if not (meshed(name) and FRAMED in path.split("."))}


def differences(kept: dict[str, Any], found: dict[str, Any], tolerance: float) -> list[str]:
    """Return a line for every entry that is missing, new, or further off than ``tolerance`` of the largest of its kind.

    Entries whose paths differ in indices alone are of one kind: a force that is zero but for rounding counts as zero
    beside the others.
    """
    largest: dict[str, float] = {}
    for path, value in kept.items():
        if isinstance(value, int | float):
            kind = re.sub(r"\[\d+\]", "[]", path)
            largest[kind] = max(largest.get(kind, 0.0), abs(value))
    lines = [f"{path}: gone, it was {kept[path]}" for path in kept.keys() - found.keys()]
    lines += [f"{path}: new, {found[path]}" for path in found.keys() - kept.keys()]
    for path in kept.keys() & found.keys():
        old, new = kept[path], found[path]
        if isinstance(old, int | float) and isinstance(new, int | float):
            allowed = tolerance * largest[re.sub(r"\[\d+\]", "[]", path)]
            allowed = max([allowed, *(floor for end, floor in FLOORS.items() if path.endswith(end))])
            share = max(tolerance, PATH) if any(part in f"{path}." for part in FOLLOWED) else tolerance
            if not math.isclose(old, new, rel_tol=share, abs_tol=allowed):
                limit = max(allowed, share * abs(old))
                lines.append(f"{path}: {new:.10g}, it was {old:.10g} (tolerance {limit:.1g})")
        elif old != new:
            lines.append(f"{path}: {new}, it was {old}")
    return sorted(lines)


def path_of(name: str) -> Path:
    """The file of a golden result."""
    return FOLDER / f"{name}.json"


def renew(pattern: str) -> None:
    """Write the golden results whose names match a pattern, and say what changed."""
    FOLDER.mkdir(exist_ok=True)
    for name in fnmatch.filter(commands(), pattern):
        path = path_of(name)
        old = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        found = run(name)
        changed = differences(old, found, tolerance(name))
        print(f"{name}: {len(found)} entries, {len(changed)} differ", *changed[:20], sep="\n  ", flush=True)
        if changed:
            rounded = {k: float(f"{v:.12g}") if isinstance(v, float) else v for k, v in found.items()}
            path.write_text(json.dumps(rounded, indent=0) + "\n", encoding="utf-8")


if __name__ == "__main__":
    renew(sys.argv[1] if len(sys.argv) > 1 else "*")
