"""Clearances and fits of a case's pins: what is read, written again and refused."""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pint
import pytest
from edited_cases import PLANAR, edited

import alula
from alula.fea.check.run import check_case
from alula.fea.outcomes.free_motion import loose_holes
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.case.joint_rules import clearances, joint_caveats
from alula.loads.text.caveat import Topic
from alula.reports.sentences.caveats import caveat

FOUR_BAR = "four-bar"
SLOTTED = "ornithopter"
TRIANGLE = """
schema_version = 1
title = "links without parts"
links.base = { ground = true, points = { A = ["0 mm", "0 mm"], C = ["50 mm", "0 mm"] } }
links.crank = { points = { A = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"] } }
links.rod = { points = { B = ["0 mm", "0 mm"], C = ["30 mm", "0 mm"] } }
joints.A = { links = ["base", "crank"] }
joints.B = { links = ["crank", "rod"] }
joints.C = { links = ["base", "rod"] }
load_cases.l = { forces = [{ link = "rod", at = "B", force = ["1 N", "0 N"] }] }
"""
LARGE = 'pin_diameter="501 mm"'


def stated(*entries: str, name: str = FOUR_BAR, joint: str = "A"):
    return edited(name, [f"joints.{joint}.{entry}" for entry in entries])


REFUSED = {
    "c not below d": (['clearance={crank="3 mm"}'], "A.clearance: it is 3 mm, but must stay below the pin's"),
    "range not below d": (['clearance=["0.1 mm", "4 mm"]'], "A.clearance: it is 4 mm, but must stay below the pin's"),
    "negative": (['clearance=["-0.1 mm", "0.1 mm"]'], r"A.clearance .*: the clearance must not be negative"),
    "negative in a link": (['clearance={crank="-0.1 mm"}'], "A.clearance: in link 'crank' .* must not be negative"),
    "reversed": (['clearance=["0.2 mm", "0.1 mm"]'], r"A.clearance .*: its range goes from 0.2 mm to 0.1 mm; write"),
    "three ends": (['clearance=["1 mm", "1 mm", "1 mm"]'], "A.clearance .*: a range has two lengths; write for"),
    "a bare number": (["clearance={crank=0.1}"], "A.clearance: in link 'crank' the length needs its unit as text"),
    "bare numbers": (["clearance=[0.1, 0.2]"], "A.clearance .*: the length needs its unit as text"),
    "a list of fits": (['fit=["press", "press"]'], "A.fit .*: a fit is text; write for example"),
    "no fit": (['fit="H7/p6"'], r"A.fit .*: the fit must be that of a hole H .* state clearance = \["),
    "no fit in a link": (['fit={crank="loose"}'], r"A.fit: in link 'crank' the fit must be .* state clearance = \["),
    "empty": (["fit={}"], "A.fit: the table names no link; leave it out"),
    "another link": (['fit={rocker="press"}'], "A.fit: 'rocker' is no link of this joint; choose one of crank, "),
    "another link's": (['clearance={base="1 mm"}'], "A.clearance: 'base' is no link of this joint; choose one of"),
    "press alone": (['fit="press"'], 'A.fit: it does not say in which link .* write fit = { crank = "press" } or'),
    "press in both": (['fit={crank="press", coupler="press"}'], "A.fit: .* pressed in both links .* bonded = true"),
    "fit and clearance": (['fit="H8/f7"', 'clearance="0.1 mm"'], "A.fit: fit and clearance both state the hole of"),
    "both of one link": (
        ['fit={coupler="H8/f7"}', 'clearance={coupler="0.1 mm"}'],
        "A.fit: fit and clearance both state the hole of 'coupler'; leave out",
    ),
    "a fit of one, a clearance of either": (
        ['fit={crank="H8/f7"}', 'clearance="0.1 mm"'],
        "A.fit: fit and clearance both state the hole of 'crank'; leave out one of the two, or state each for a link",
    ),
    "a press and a clearance of one": (
        ['fit={crank="press"}', 'clearance={crank="0.1 mm"}'],
        "A.fit: fit and clearance both state the hole of 'crank'",
    ),
    "no such diameter": (['fit="H8/f7"', LARGE], "A.fit: it is 'H8/f7', but its fits are known up to 500 mm"),
    "no such diameter of a link": (['fit={crank="running"}', LARGE], "A.fit.crank: it is 'running', but its fits are"),
    "bonded": (['fit="H8/f7"', "bonded=true"], "A.fit: a bonded joint does not turn"),
    "heads in one plane": (
        ['heads={diameter="5 mm", gap="0.1 mm"}'],
        "A.heads: it has a meaning only where links lie in layers; leave",
    ),
    "a negative gap": (['heads={diameter="5 mm", gap="-1 mm"}'], "A.heads.gap .*: the gap must not be negative; write"),
    "a reversed gap": (
        ['heads={diameter="5 mm", gap=["1 mm", "0 mm"]}'],
        "A.heads.gap .*: its range goes from 1 mm to 0 mm; write the least gap",
    ),
    "heads without a gap": (['heads={diameter="5 mm"}'], "A.heads.gap: this entry is missing; add"),
    "bonded with play": (['clearance={crank="1 mm"}', "bonded=true"], "A.clearance: a bonded joint has no play"),
}  # fmt: skip


@pytest.mark.parametrize("entry", REFUSED)
def test_what_no_pin_has_is_refused(entry):
    entries, message = REFUSED[entry]
    with pytest.raises(CaseError, match=message) as told:
        stated(*entries)
    assert str(told.value).startswith("joints.A.")
    assert re.search(r"; \S", str(told.value))


LAYERED_REFUSED = {
    "press elsewhere": (['fit={AG="press"}', 'tight_in="AE"'], "A.fit: .* is pressed in 'AG', but tight_in .* 'AE'"),
    "press in one of two": (['fit={AG="press"}', 'tight_in=["AG", "AE"]'], "A.fit: .* in 'AG', but tight_in .* 'AE'"),
    "play in a tight hole": (['clearance={AG="0.1 mm"}', 'tight_in="AG"'], "A.clearance.AG: it gives .* tight there"),
    "a fit in a tight hole": (['fit={AG="H8/f7"}', 'tight_in="AG"'], "A.fit.AG: it gives the pin play, but tight_in"),
    "heads that fall through": (
        ['heads={diameter="1.7 mm", gap="0.1 mm"}', 'clearance="0.2 mm"'],
        "A.heads.diameter: it is 1.7 mm, but must be larger than the hole, 1.7 mm; make it larger, "
        "or joints.A.clearance smaller",
    ),
    "a gap as wide as heads": (
        ['heads={diameter="3 mm", gap=["0 mm", "3 mm"]}'],
        "A.heads.gap: it is 3 mm, but must stay below the diameter of the heads, 3 mm; make it smaller",
    ),
    "play where all is tight": (['clearance="0.1 mm"', 'tight_in=["AG", "AE"]'], "A.clearance: .* tight in every link"),
    "a fit where all is tight": (['fit="running"', 'tight_in=["AG", "AE"]'], "A.fit: .* tight in every link; leave"),
}  # fmt: skip


@pytest.mark.parametrize("entry", LAYERED_REFUSED)
def test_what_tight_in_contradicts_is_refused(entry):
    entries, message = LAYERED_REFUSED[entry]
    with pytest.raises(CaseError, match=message):
        edited("owl-wing-static", [f"joints.A.{entry}" for entry in entries], fits=False)


def test_without_a_diameter_there_is_no_fit_but_a_press():
    data = tomllib.loads(TRIANGLE)
    for fit in ("running", {"crank": "H8/f7"}):
        data["joints"]["B"]["fit"] = fit
        with pytest.raises(CaseError, match=r'^joints.B.fit: a fit such as "H8/f7" needs the diameter of the pin; add'):
            validate(data)
    data["joints"]["B"]["fit"] = {"crank": "press"}
    assert validate(data).joints["B"].tight_in == ("crank",)


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ('fit="H8/f7"', "slot-right.fit: a joint of type pin-in-slot has no fit; leave it out, or state the clearance"),
        ('fit={rod="press"}', "slot-right.fit: a joint of type pin-in-slot has no two holes; state one clearance"),
        ('clearance={rod="0.1 mm"}', "slot-right.clearance: a joint of type pin-in-slot has no two holes; state one"),
    ],
)
def test_a_slot_has_a_clearance_alone(entry, message):
    with pytest.raises(CaseError, match=message):
        stated(entry, name=SLOTTED, joint="slot-right")


@pytest.mark.parametrize(
    ("name", "joint", "further", "message"),
    [
        (
            SLOTTED,
            "slot-right",
            [],
            "joints.slot-right.heads: a joint of type pin-in-slot has no pin that turns in two",
        ),
        ("owl-wing-static", "B", ["bonded=true"], "joints.B.heads: a bonded joint has no pin that turns in two holes"),
        ("owl-wing-static", "B", ["clamped=true"], "joints.B.heads: a clamped joint has no pin; leave it out"),
        (
            "flapping-wing-chosen",
            "AL",
            [],
            "joints.AL.heads: joint 'AR' is on the same pin and states none, but its links share the gap; state heads "
            "of both, whose gaps add up, or of neither",
        ),
    ],
)
def test_heads_are_those_of_a_whole_pin_that_turns(name, joint, further, message):
    entries = [f"joints.{joint}.{entry}" for entry in ('heads={diameter="6 mm", gap="0.1 mm"}', *further)]
    with pytest.raises(CaseError, match=message):
        edited(name, entries, fits=bool(not further))


def test_two_joints_of_one_pin_do_not_state_one_hole_in_two_ways():
    """They may state it alike, or one of them alone: here AR states that the pin is pressed in the crank."""
    name, own = "flapping-wing-chosen", 'fit={coupler-left="running"}'
    assert stated(own, 'clearance={crank="0 mm"}', name=name, joint="AL").joints["AL"].tight_in == ()
    with pytest.raises(CaseError) as told:
        stated('fit={crank="running"}', name=name, joint="AL")
    assert str(told.value) == (
        "joints.AL: it states a clearance of 0.005 to 0.032 mm in the hole of 'crank', but joint 'AR' on the same pin "
        "states a tight pin there; state the same in both, or leave it out of one"
    )
    with pytest.raises(
        CaseError, match=r"^joints\.AL: it states a clearance of 0.1 mm in the hole of 'crank', but joint"
    ):
        stated(own, 'clearance={crank="0.1 mm"}', name=name, joint="AL")


def test_a_slider_has_no_fit():
    name, joint = "slider-crank", next(n for n, j in read_case("slider-crank").joints.items() if j.type == "slider")
    with pytest.raises(CaseError, match=f"joints.{joint}.fit: a joint of type slider has no fit; leave it out"):
        stated('fit="H8/f7"', name=name, joint=joint)


def test_a_case_in_python_states_fits_and_writes_them():
    case = alula.Case.read(FOUR_BAR)
    rows = {"coupler": ["0 mm", np.array([0.02, 0.1])[1] * pint.UnitRegistry().mm]}
    for name, entries in {
        "A": {"clearance": rows, "fit": {"crank": "press"}},
        "B": {"fit": "H9/d9"},
        "O4": {"clearance": ("0.01 mm", "0.05 mm")},
    }.items():
        joint = {"links": case.joints[name].links, "pin_diameter": "3 mm"}
        case = case.with_joint(name, replace=True, **joint, **entries)
    again = alula.Case.from_dict(tomllib.loads(case.to_toml()))
    assert again == case
    for one in (case, again):
        holes = one.record.linkage.pin_holes("A")
        assert [(hole.low, hole.high) for hole in holes.holes] == [(0.0, 0.0), (0.0, 0.1)]
        assert one.joints["O4"].clearance == (0.01, 0.05)
        assert one.joints["B"].fit == "H9/d9"


def test_entries_of_links_are_set_alone():
    case = read_case(FOUR_BAR, ['joints.A.clearance.crank="0.05 mm"', "joints.B.fit.coupler=press"])
    assert case.joints["A"].clearance == {"crank": 0.05}
    assert case.joints["B"].tight_in == ("coupler",)


def test_play_of_both_holes_is_that_of_their_sum():
    """And where it may lie: either hole has its own, and a clearance of the joint is in one or the other."""
    split = stated('clearance={crank="0.04 mm", coupler=["0 mm", "0.06 mm"]}')
    whole = stated('clearance="0.1 mm"')
    assert clearances(split) == clearances(whole) == {"A": pytest.approx(0.1)}
    assert loose_holes(split, "A") == ((("crank", 0.04),), (("coupler", 0.06),))
    assert loose_holes(whole, "A") == ((("crank", 0.1), ("coupler", 0.1)),)
    numbers = [check_case(case, fidelity="beam") for case in (split, whole)]
    for first, second in zip(*(found.load_cases["lift"].links.values() for found in numbers), strict=True):
        one, other = first.safety_factor, second.safety_factor  # the second holds all widths that the first has
        assert 0.95 * one.low < other.low < one.low * 1.0001
        assert one.high * 0.9999 < other.high < 1.05 * one.high


def test_a_press_tells_what_tight_in_tells():
    """In layers, on which way couples are shared; in one plane, where tight_in has no meaning, it may stand as well."""
    wing, pairs = "owl-wing-static", {"A": "AG", "B": "AE"}
    pressed = edited(wing, [f'joints.{joint}.fit={{{link}="press"}}' for joint, link in pairs.items()], fits=False)
    tight = edited(wing, [f'joints.{joint}.tight_in="{link}"' for joint, link in pairs.items()], fits=False)
    assert {n: j.tight_in for n, j in pressed.joints.items()} == {n: j.tight_in for n, j in tight.joints.items()}
    assert edited(wing, [PLANAR, 'joints.A.fit={AG="press"}'], fits=False).joints["A"].tight_in == ("AG",)


def test_a_running_fit_is_told_as_assumed():
    told = [caveat(one) for one in joint_caveats(stated('fit={crank="press", coupler="running"}'))]
    assert told == ["running pin A (H8/f7 of ISO 286 is taken for it)"]
    assert [caveat(one) for one in joint_caveats(stated('fit="H8/f7"'))] == []


def test_play_that_is_not_followed_is_told():
    """In a linkage that is let go a fit tells how pins sit, and its play in the plane is left out."""
    case = edited("spring-pedal", ['joints.O.fit="H8/f7"'], fits=False)
    assert clearances(case) == {}
    [told] = [caveat(one) for one in joint_caveats(case) if one.topic is Topic.PLAY]
    assert told == "play in the plane of pin O (the linkage is let go)"
    with pytest.raises(CaseError, match=r"joints.O.clearance: play of a linkage that is let go is not modelled"):
        edited("spring-pedal", ['joints.O.clearance="0.1 mm"'], fits=False)


@pytest.mark.parametrize("stated", ['fit="H8/f7"', 'clearance="0.1 mm"', 'clearance={crank=["0.05 mm", "0.1 mm"]}'])
def test_bonds_of_the_whole_case_leave_fits_and_play_without_meaning(stated):
    assert clearances(edited(FOUR_BAR, [f"joints.A.{stated}"])) != {}
    assert clearances(edited(FOUR_BAR, [f"joints.A.{stated}", 'joint_model="bonded"'])) == {}


def _holes(case, of, point="A"):
    return {link: of(case, link).pin(point).diameter for link in ("crank", "coupler")}


WIDTHS = {
    "nothing": ([], (3.0, 3.0), (3.0, 3.0)),
    "shared": (['clearance=["0.1 mm", "0.5 mm"]'], (3.5, 3.5), (3.15, 3.15)),
    "of each": (['clearance={crank="0.4 mm", coupler=["0.1 mm", "0.2 mm"]}'], (3.4, 3.2), (3.4, 3.15)),
    "pressed in one": (['fit={crank="press"}', 'clearance={coupler="0.4 mm"}'], (3.0, 3.4), (3.0, 3.4)),
}


@pytest.mark.parametrize(("entries", "widest", "made"), WIDTHS.values(), ids=WIDTHS)
def test_holes_are_drawn_at_their_widest_and_made_in_the_middle(entries, widest, made):
    case = stated(*entries)
    assert _holes(case, Case.body) == pytest.approx(dict(zip(("crank", "coupler"), widest, strict=True)))
    assert _holes(case, Case.body_to_make) == pytest.approx(dict(zip(("crank", "coupler"), made, strict=True)))
    assert [case.body(link).pin("A").pin_diameter for link in ("crank", "coupler")] == pytest.approx([3.0, 3.0])


def test_a_hole_of_two_joints_is_as_wide_as_the_looser_makes_it():
    """Of three links on one pin; a joint of which nothing is stated makes it no wider."""
    data = tomllib.loads(TRIANGLE)
    data["links"]["arm"] = {"points": {"B": ["0 mm", "0 mm"], "D": ["9 mm", "0 mm"]}}
    data["joints"]["B"]["clearance"] = {"crank": ["0.1 mm", "0.2 mm"], "rod": "0.5 mm"}
    data["joints"]["B2"] = {"links": ["crank", "arm"], "points": ["B", "B"], "clearance": {"crank": "0.3 mm"}}
    linkage = validate(
        data | {"drive": {"link": "arm", "joint": "B2"}, "pose": {"coordinate": "arm", "angle": "0 deg"}}
    ).linkage
    widths = [linkage.wider(link, "B") for link in ("crank", "rod", "arm")]
    assert widths == [(0.3, 0.3, 0.3), (0.5, 0.5, 0.5), (0.0, 0.0, 0.0)]


def test_a_wide_hole_takes_from_its_wall_what_a_wide_pin_does():
    """An eye of 6.4 mm about a hole of 5.9 mm had been calculated about one of 3 mm."""
    wide, loose = (
        edited(FOUR_BAR, ['parts.bar.width="4 mm"', f"joints.A.{entry}"])
        for entry in ('pin_diameter="5.9 mm"', 'clearance="2.9 mm"')
    )
    for link in ("crank", "coupler"):
        body = loose.body(link)
        told = replace(body, pins=tuple(replace(pin, clearance=0.0) for pin in body.pins))
        assert told == wide.body(link)


def test_a_hole_wider_than_its_eye_is_refused():
    with pytest.raises(CaseError, match=r"hole at A .* 6.5 mm.* less .* 6.4 mm; reduce pin_diameter or the clearance"):
        edited(FOUR_BAR, ['parts.bar.width="4 mm"', 'joints.A.pin_diameter="3.6 mm"', 'joints.A.clearance="2.9 mm"'])
