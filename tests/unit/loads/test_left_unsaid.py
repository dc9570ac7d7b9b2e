"""What a load case leaves unsaid: it moves at the speed of the motion, and what links carry weighs."""

import re
import tomllib
from importlib.resources import files
from typing import Any

import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.states.case_motion import solve_case_motion

FAST = 600.0 * 3.141592653589793 / 30.0
CARRIED = [{"link": "rocker", "at": "P", "mass": "50 kg"}]


def starter(motion: dict[str, Any] | None = None, pose: dict[str, Any] | None = None, **tables: Any) -> Case:
    """The starter with a second load case that stands still, as the file would state them."""
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    data["load_cases"]["held"] = {"own_weight": True, "speed": "0 rpm"}
    data["motion"] |= {"speed": "600 rpm"} | (motion or {})
    data["pose"] |= pose or {}
    return validate(data | tables)


def speeds(case: Case) -> dict[str, float]:
    return {name: round(load_case.speed, 9) for name, load_case in case.load_cases.items()}


def test_the_speed_of_the_motion_is_that_of_load_cases_without_one() -> None:
    assert speeds(starter()) == {"lift": round(FAST, 9), "held": 0.0}
    assert speeds(starter({"inertia": True})) == {"lift": round(FAST, 9), "held": 0.0}
    assert speeds(starter({"inertia": False})) == {"lift": 0.0, "held": 0.0}
    turned = read_case("four-bar", ['motion.speed="1200 rpm"']).with_values({"motion.speed": "600 rpm"})
    assert speeds(turned) == {"lift": round(FAST, 9)}


def test_a_range_that_goes_back_is_run_backward() -> None:
    """With friction and drive power of that way; a load case went forward over it all the same."""
    there, back = (
        starter({"turn": False, "range": ends, "poses": 3}) for ends in (["20 deg", "40 deg"], ["40 deg", "20 deg"])
    )
    for case, speed in ((there, FAST), (back, -FAST)):
        assert speeds(case) == {"lift": round(speed, 9), "held": 0.0}
        moved = solve_case_motion(case)
        assert moved.forces["lift"].motion.speed == pytest.approx(moved.motion.speed)


@pytest.mark.parametrize(
    "motion",
    [
        {"acceleration": "1 rad/s^2"},  # the pose's speed then depends on the way to it
        {"coordinate": "rocker", "turn": False, "range": ["50 deg", "70 deg"]},  # the crank's speed is not constant
    ],
)
def test_a_motion_that_is_not_steady_in_the_pose_has_inertia_of_its_own(motion: dict[str, Any]) -> None:
    case = starter(motion)
    assert speeds(case) == {"lift": 0.0, "held": 0.0}
    assert case.inert


@pytest.mark.parametrize("speed", ["600 rpm", "0 rpm"])
def test_without_parts_and_masses_nothing_is_inert(speed: str) -> None:
    case = starter({"speed": speed})
    bare = {name: link.model_copy(update={"part": None}) for name, link in case.links.items()}
    assert case.inert == (speed != "0 rpm")
    assert not case.model_copy(update={"links": bare}).inert


def test_a_carried_mass_weighs_unless_the_case_says_no() -> None:
    lifted = {"forces": [{"link": "rocker", "at": "P", "force": ["0 N", "-5 N"]}]}
    cases = {"down": lifted | {"gravity_direction": "-90 deg"}, "off": lifted | {"own_weight": False}}
    cases |= {"without": lifted | {"carried": False}}
    case = starter(carried=CARRIED, load_cases=cases)
    assert {name: one.own_weight for name, one in case.load_cases.items()} == {
        "down": True, "off": False, "without": False,
    }  # fmt: skip
    with pytest.raises(CaseError, match=r"^load_cases\.lift\.own_weight: link 'rocker' carries a mass") as refused:
        starter(carried=CARRIED, load_cases=cases | {"lift": lifted})
    assert refused.value.exit_status == 2
    assert starter(load_cases={"lift": lifted}).load_cases["lift"].own_weight is False


def in_layers(*layers: int, **tables: Any) -> Case:
    data = tomllib.loads((files("alula.loads") / "cases" / "four-bar.toml").read_text(encoding="utf-8"))
    for name, layer in zip(data["links"], layers, strict=True):
        data["links"][name]["layer"] = layer
    return validate(data | {"layer_spacing": "4.5 mm"} | tables)


def test_links_in_one_layer_are_looked_at_for_collisions() -> None:
    """They were taken for links without layers, of which nothing is known of how they pass each other."""
    assert "clearance" in in_layers(0, 0, 0, 0).all_checks
    assert "clearance" in in_layers(0, 1, 2, 1).all_checks
    assert "clearance" not in in_layers(0, 1, 2, 1, layer_spacing="0 mm").all_checks
    assert "clearance" not in starter().all_checks


def test_neighbours_in_one_layer_are_refused() -> None:
    from alula.loads.states.clearance import clearance

    with pytest.raises(CaseError, match=re.escape("they share joint A, so their eyes lie in each other")):
        clearance(in_layers(0, 0, 0, 0))
    assert clearance(in_layers(0, 1, 2, 1)) is not None
    assert clearance(starter()) is None
