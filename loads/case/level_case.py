"""What a level makes of a case: each test is a variant of it, with a load case, checks and conditions of its own."""

from collections.abc import Iterator
from enum import StrEnum
from functools import cache
from typing import Any

from pydantic import TypeAdapter

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_rules import check_check
from alula.loads.case.core import CoreCase
from alula.loads.records.check_spec import Check
from alula.loads.records.load_case import LoadCase
from alula.loads.stated.level_spec import LevelSpec
from alula.loads.text.caveat import Caveat, Heading, Topic
from alula.loads.text.reason import reason


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
        Of the chosen test its load case and conditions, and no checks: ``demanded`` has them once all names fit. Where
        none is chosen, the load cases of all tests, if the case states none.
    """
    level = case.level
    assert level is not None
    if level.test is None:
        own = {} if case.tests_alone else case.load_cases
        return {"load_cases": own or {name: _load_case(level, name) for name in level.tests}}
    step = level.tests[level.test].decisive
    kept = {"cycles": step.cycles, "duration": None, "reverses": False}
    return {
        "load_cases": {level.test: _load_case(level, level.test)},
        "conditions": case.conditions.model_copy(update=kept),
        "checks": {},
        "ways_to_hold": None,
    }


def _load_case(level: LevelSpec, name: str) -> LoadCase:
    """Return the load case of a test: its decisive force along its load line, on a linkage that stands still."""
    test = level.tests[name]
    step = test.decisive
    line = {
        "from": [f"{x!r} mm" for x in level.place(test.top).tolist()],
        "to": [f"{x!r} mm" for x in level.place(test.bottom).tolist()],
        "force": f"{step.force!r} N",
        **level.enters.model_dump(),
        **({} if level.leaves is None else {"leaves": level.leaves.model_dump()}),
    }
    cyclic = {"least": (step.least or 0.0) / step.force} if level.test is not None and step.cycles is not None else {}
    title = test.title or f"Test {name} of {level.title}"
    return LoadCase.model_validate(
        {"title": title, "own_weight": False, "speed": "0 rpm", "load_lines": [line], **cyclic}
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
    test = level.tests[level.test]
    smaller = tuple(step.force for step in test.steps if step is not test.decisive and step.force < test.decisive.force)
    if smaller:
        why = reason("larger_step_decides", force=test.decisive.force)
        yield Caveat(heading=Heading.ASSUMED, topic=Topic.LOADS, what=reason("steps_of", forces=smaller), why=why)
    if test.hold is not None:
        what = reason("held_for", duration=test.hold)
        yield Caveat(topic=Topic.CREEP, what=what, why=reason("cards_tell_long_loads"))
    cards = dict.fromkeys(case.part_of(link).material for link in case.checked_links) if test.lasts else {}
    lines = {name: case.all_materials[name].fatigue for name in cards}
    if without := tuple(name for name, line in lines.items() if line is not None and line.strength_range is None):
        what = reason("scatter_of_fatigue_strength", materials=without)
        yield Caveat(topic=Topic.FATIGUE, what=what, why=reason("no_range_and_no_factor"))
