"""What a level makes of a case: each test is a variant of it, with a load case, checks and conditions of its own."""

import math
from collections.abc import Iterator
from enum import StrEnum
from functools import cache
from typing import Any, TypeVar

import numpy as np
from pydantic import TypeAdapter, ValidationError

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_rules import check_check
from alula.loads.case.core import CoreCase
from alula.loads.records.check_spec import Check, FatigueCheck
from alula.loads.records.cycle_spec import CycleMotion
from alula.loads.records.load_case import LoadCase
from alula.loads.records.motion_spec import MotionSpec
from alula.loads.stated.level_spec import LevelSpec, LoadState
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.loads.text.explain import sentence
from alula.loads.text.reason import reason

AnyCase = TypeVar("AnyCase", bound=CoreCase)


class Demand(StrEnum):
    """What a test asks for."""

    ELASTIC = "stays elastic"
    PERMANENT_SET = "permanent set"
    NO_BREAK = "does not break"
    LASTS = "lasts"
    BESIDES = "besides"
    """What no entry of the test asks for and alula looks at all the same, such as gaps between layers."""


def with_tests(case: CoreCase) -> dict[str, Any]:
    """Return the entries of a case that its level states in place of it.

    Parameters
    ----------
    case : CoreCase
        With a level.

    Returns
    -------
    dict of str to object
        Of the chosen test its load case and conditions, and no checks: ``demanded`` has them once all names fit. With a
        profile, a load case for each of its states that loads. Tolerances of the load cases that it stands in place of
        go with them. Where no test is chosen, the load cases of all tests, if the case states none.
    """
    level = case.level
    assert level is not None
    if level.test is None:
        own = {} if case.tests_alone else case.load_cases
        return {"load_cases": own or {name: _load_case(level, name) for name in level.tests}}
    test = level.tests[level.test]
    kept = {"cycles": test.cycles, "duration": None, "reverses": False}
    if test.profiled:
        loading = [state for state in test.states if state.force > 0.0]
        load_cases = {one.name: _at_state(level, level.test, one).over(blocks=test.blocks) for one in loading}
    else:
        load_cases = {level.test: _load_case(level, level.test)}
        if test.blocks:
            shares = tuple(state.force / test.decisive.most for state in test.states)
            load_cases[level.test] = load_cases[level.test].over(blocks=test.blocks, shares=shares)
    gone = {f"load_cases.{name}" for name in {*case.load_cases, *level.tests} - load_cases.keys()}
    varied = {path: one for path, one in case.tolerances.items() if ".".join(path.split(".")[:2]) not in gone}
    return {
        "load_cases": load_cases,
        "tolerances": varied,
        "conditions": case.conditions.model_copy(update=kept),
        "checks": {},
        "ways_to_hold": None,
    }


def _load_case(level: LevelSpec, name: str) -> LoadCase:
    """Return the load case of a test: its largest force along its load line, on a linkage that stands still."""
    return _at_state(level, name, max(level.tests[name].states, key=lambda state: state.force))


def _at_state(level: LevelSpec, name: str, state: LoadState) -> LoadCase:
    """Return the load case of one state of a test."""
    test = level.tests[name]
    start, end = level.line(test, state).tolist()
    line = {
        "from": [f"{x!r} mm" for x in start],
        "to": [f"{x!r} mm" for x in end],
        "force": f"{state.force!r} N",
        **level.enters.model_dump(),
        **({} if level.leaves is None else {"leaves": level.leaves.model_dump()}),
    }
    title = test.title or f"Test {name} of {level.title}"
    if state.time is not None:
        title += f": {state.name}, {state.time:.4g} s, tilted by {math.degrees(state.tilt):.4g}°"
    try:
        return LoadCase.model_validate({"title": title, "own_weight": False, "speed": "0 rpm", "load_lines": [line]})
    except ValidationError as error:
        raise CaseError(f"level.tests.{name}, {state.name}: {sentence(error, LoadCase)}") from None


def over_states(case: AnyCase) -> AnyCase:
    """Return a test with a profile as a case under a cycle of loads, which stands in its pose and is asked for fatigue.

    Parameters
    ----------
    case : Case
        With a chosen test that has a profile and cycles.

    Returns
    -------
    Case
        With one load case, of the name of the test, whose rows are the states of the test.
    """
    level = case.level
    assert level is not None
    assert level.test is not None
    name, test = level.test, level.tests[level.test]
    rows = tuple(_at_state(level, name, state) for state in test.states)
    slides = case.pose.travel is not None
    value = case.pose.travel if case.pose.travel is not None else case.pose.angle
    ends: dict[str, Any] = {} if case.pose.coordinate is None else {"travel" if slides else "range": (value, value)}
    none = np.zeros(len(rows))
    still = CycleMotion(
        percent=np.linspace(0.0, 100.0, len(rows)),
        times=None,
        values=none + value,
        speed=none,
        acceleration=none,
        sense=none + 1.0,
    )
    return case.model_copy(
        update={
            "load_cases": {name: _load_case(level, name).over(rows, blocks=test.blocks)},
            "checks": {x: check for x, check in case.checks.items() if isinstance(check, FatigueCheck)},
            "motion": MotionSpec.model_construct(poses=len(rows), **ends).through(still),
        }
    )


def demanded(case: CoreCase) -> dict[Demand, dict[str, Check]]:
    """Return the checks by which each thing is judged that the chosen test asks for.

    Parameters
    ----------
    case : CoreCase
        Whose names fit together.

    Returns
    -------
    dict of Demand to dict of str to Check
        By their names, all with the limit 1; empty where no test is chosen.
    """
    if case.level is None or case.level.test is None:
        return {}
    test, found = case.level.tests[case.level.test], dict[Demand, dict[str, Check]]()
    if test.elastic:
        found[Demand.ELASTIC] = {"stays elastic": _least("safety-factor"), **_pins(case)}
    if test.permanent_set is not None:
        found[Demand.PERMANENT_SET] = {
            "permanent set": _check(type="permanent-set", maximum=f"{test.permanent_set!r} mm")
        }
    if test.no_break:
        found[Demand.NO_BREAK] = dict(_breaking(case)) | ({} if test.elastic else _pins(case))
    if test.lasts:
        found[Demand.LASTS] = {"lasts": _least("fatigue")}
    return found


@cache
def _adapter() -> TypeAdapter[Check]:
    return TypeAdapter(Check)


def _check(**entries: object) -> Check:
    return _adapter().validate_python(entries)


def _least(kind: str, **entries: object) -> Check:
    """Return a check of a kind whose least factor is 1."""
    return _check(type=kind, minimum=1.0, **entries)


def _pins(case: CoreCase) -> dict[str, Check]:
    """Return the check of pins, by first yield whatever the test asks for: nothing tells what they bear beyond."""
    return {"pins": _least("pins", joints=case.pinned_joints)} if case.pinned_joints else {}


def _breaking(case: CoreCase) -> Iterator[tuple[str, Check]]:
    """Yield what tells that links do not break: of each what its material and its shape allow to tell."""

    def those(kind: str) -> tuple[str, ...]:
        return tuple(link for link in case.checked_links if _takes(case, _least(kind, links=(link,))))

    ductile, notched = those("plastic-collapse"), those("notch")
    by_peak = tuple(link for link in case.checked_links if link not in {*ductile, *notched})
    for name, kind, links in (
        ("does not collapse", "plastic-collapse", ductile),
        ("does not break at notches", "notch", notched),
        ("does not break at its peak", "safety-factor", by_peak),
        ("eyes do not break", "eye", those("eye")),
        ("walls do not buckle", "wall", those("wall")),
    ):
        if links:
            yield name, _least(kind, links=links)


def _takes(case: CoreCase, check: Check) -> bool:
    """Return whether a check can tell of the links that it names."""
    try:
        check_check(case, "", check)
    except CaseError:
        return False
    return True


def level_caveats(case: CoreCase) -> Iterator[Caveat]:
    """Yield what a chosen test leaves out of what it states, or that no test was chosen.

    Parameters
    ----------
    case : CoreCase

    Yields
    ------
    Caveat
    """
    level = case.level
    if level is None:
        return
    if level.test is None:
        what = reason("tests_of_level", tests=tuple(level.tests), level=level.title)
        yield Caveat(topic=Topic.LOADS, what=what, why=reason("alula_check_runs_tests", first=next(iter(level.tests))))
        return
    if "load_cases" not in case.model_fields_set and "checks" in case.model_fields_set:
        yield Caveat(topic=Topic.LOADS, what=reason("checks_of_case"), why=reason("tests_ask_their_own"))
    test = level.tests[level.test]
    most = test.decisive.most
    smaller = tuple(
        step.force for step in test.steps if step.force is not None and not step.cycles and step.force < most
    )
    if smaller and not test.profiled:
        why = reason("larger_step_decides", force=most)
        yield Caveat(heading=Heading.ASSUMED, topic=Topic.LOADS, what=reason("steps_of", forces=smaller), why=why)
    if test.hold is not None:
        what = reason("held_for", duration=test.hold)
        yield Caveat(topic=Topic.CREEP, what=what, why=reason("cards_tell_long_loads"))
    cards = dict.fromkeys(case.part_of(link).material for link in case.checked_links) if test.lasts else {}
    lines = {name: case.all_materials[name].fatigue for name in cards}
    if without := tuple(name for name, line in lines.items() if line is not None and line.strength_range is None):
        what = reason("scatter_of_fatigue_strength", materials=without)
        yield Caveat(topic=Topic.FATIGUE, what=what, why=reason("no_range_and_no_factor"))
