"""Friction on a pin of three links: it stands in one of them, and the bores of both others rub on it.

By virtual work the drive pays what the load gives back less, and what is rubbed: on the pin the force in the bore of
each of the two, times radius and coefficient and how fast that link turns on the third.
"""

import tomllib
from typing import Any

import numpy as np
import pytest

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.case.joint_rules import joint_caveats
from alula.loads.text.caveat import Topic
from alula.reports.sentences.caveats import caveat

SIX_BARS = """
schema_version = 1
title = "Coupler, rocker and rod on one pin"
links.base = { ground = true, points = { O2 = ["0 mm", "0 mm"], O4 = ["90 mm", "0 mm"], O6 = ["150 mm", "20 mm"] } }
links.crank.points = { O2 = ["0 mm", "0 mm"], A = ["40 mm", "0 mm"] }
links.coupler.points = { A = ["0 mm", "0 mm"], B = ["80 mm", "0 mm"] }
links.rocker.points = { O4 = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"] }
links.rod.points = { B = ["0 mm", "0 mm"], E = ["70 mm", "0 mm"] }
links.out = { points = { O6 = ["0 mm", "0 mm"], E = ["50 mm", "0 mm"], P = ["70 mm", "0 mm"] } }
joints.O2.links = ["base", "crank"]
joints.A.links = ["crank", "coupler"]
joints.O4.links = ["base", "rocker"]
joints.E.links = ["rod", "out"]
joints.O6.links = ["base", "out"]
drive = { link = "crank", joint = "O2" }
load_cases.push = { direction = "forward", forces = [{ link = "out", at = "P", force = ["-20 N", "0 N"] }] }
[pose]
coordinate = "crank"
angle = "100 deg"
near = { coupler = "10 deg", rocker = "90 deg", rod = "0 deg", out = "90 deg" }
"""
LINKS = "coupler", "rocker", "rod"
RADIUS = 1.5


def six_bars(stands: str, friction: tuple[float, float] = (0.2, 0.3), **further: Any) -> Case:
    """Two links turn on the one in which the pin stands, each with a coefficient of its own."""
    data = tomllib.loads(SIX_BARS)
    for (name, link), mu in zip(zip("BC", (x for x in LINKS if x != stands), strict=True), friction, strict=True):
        data["joints"][name] = {"links": [stands, link], "points": ["B", "B"], "pin_diameter": "3 mm", "friction": mu}
    for name, entries in further.items():
        data["joints"][name] |= entries
    return validate(data)


@pytest.mark.parametrize("stands", LINKS)
def test_the_drive_pays_for_what_rubs_on_the_link_in_which_the_pin_stands(stands):
    case, step = six_bars(stands), 1e-5
    before, after = (
        case.model_copy(update={"pose": case.pose.model_copy(update={"angle": case.pose.angle + side * step})})
        for side in (-1.0, 1.0)
    )
    at = [one.solve_pose() for one in (before, after)]
    turns = {link: (at[1].angles[link] - at[0].angles[link]) / (2.0 * step) for link in LINKS}
    moved = (at[1].position("out", "P") - at[0].position("out", "P")) / (2.0 * step)
    found = solve_case_statics(case).forces["push"].reactions
    bores = {"coupler": "A", "rocker": "O4", "rod": "E"}  # each of the three bears two forces alone
    rubbed = sum(
        case.joints[name].friction * RADIUS * abs(turns[link] - turns[stands])
        * float(np.hypot(*found.joints[bores[link]].wrench[:2]))
        for name, (_, link) in ((name, case.joints[name].links) for name in "BC")
    )  # fmt: skip
    assert rubbed > 0.5
    assert found.drive_torque + moved @ [-20.0, 0.0] == pytest.approx(rubbed, rel=1e-6)


def test_a_pin_that_is_tight_in_another_link_is_refused():
    """In coupler or rocker the losses differ eight times here."""
    with pytest.raises(
        CaseError, match=r"is tight in 'rocker', so that all other links rub there.* let all of them have 'rock"
    ):
        six_bars("coupler", B={"fit": {"rocker": "press"}})
    six_bars("rocker", B={"fit": {"rocker": "press"}})
    six_bars("coupler", friction=(0.0, 0.0), B={"fit": {"rocker": "press"}})


def test_joints_of_a_pin_without_a_link_in_common_are_refused():
    """A chain of four links on one pin."""
    data = tomllib.loads(SIX_BARS)
    data["links"] |= {"arm": {"points": {"B": ["0 mm", "0 mm"], "F": ["50 mm", "0 mm"]}},
                      "last": {"points": {"O7": ["0 mm", "0 mm"], "F": ["50 mm", "0 mm"]}}}  # fmt: skip
    data["links"]["base"]["points"]["O7"] = ["150 mm", "100 mm"]
    data["pose"]["near"] |= {"arm": "0 deg", "last": "180 deg"}
    ends = {"F": ["arm", "last"], "O7": ["base", "last"]}
    data["joints"] |= {name: {"links": links} for name, links in ends.items()}
    for name, links in zip("BCD", (["coupler", "rocker"], ["rocker", "rod"], ["rod", "arm"]), strict=True):
        data["joints"][name] = {"links": links, "points": ["B", "B"], "pin_diameter": "3 mm", "friction": 0.2}
    with pytest.raises(CaseError, match="have no link in common"):
        validate(data)


def test_where_a_shared_pin_stands_is_told_as_assumed_until_it_is_stated():
    said = "the pin of B, C stands in rocker, and other links rub on it (none"
    told = [caveat(one) for one in joint_caveats(six_bars("rocker")) if one.topic is Topic.FRICTION]
    assert [one.startswith(said) for one in told] == [True]
    stated = joint_caveats(six_bars("rocker", B={"fit": {"rocker": "press"}}))
    assert [one for one in stated if one.topic is Topic.FRICTION] == []
