"""Play of pins in a check: displacement, forces, stress, held load, and what is said of it."""

import math
import tomllib
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import PLANAR, edited
from rocker_case import TOML

from alula.fea.beam.cut_free import seat
from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Verdict
from alula.fea.doubts import play_doubt as doubt_of_play
from alula.fea.doubts.narrow_holes import narrower
from alula.fea.outcomes.result import LoadCaseResult
from alula.geometry.linkage.play import LooseJoints
from alula.loads.case.case_file import read_case, validate
from alula.loads.states.play import Span
from alula.reports.sections.play import play_record
from alula.reports.sentences import told as in_words

OWL = "owl-wing-closed"

LEVER = """
schema_version = 1
title = "lever"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], R = ["9 mm", "0 mm"] } }
links.arm = { part = "bar", points = { O = ["0 mm", "0 mm"], P = ["60 mm", "0 mm"] } }
joints.O = { links = ["base", "arm"], pin_diameter = "3 mm", clearance = "CLEARANCE" }
pose = { coordinate = "arm", angle = "0 deg" }
drive = { link = "arm", joint = "O" }
load_cases.tip = { forces = [{ link = "arm", at = "P", force = ["0 N", "-2 N"] }] }
checks.tip = { type = "displacement", at = "P", maximum = "0.6 mm" }
parts.bar = { shape = "bar", material = "pvc-paredes-2018", width = "8 mm", thickness = "4 mm", fillet_radius = "2 mm" }
"""


@cache
def lever(clearance: str) -> LoadCaseResult:
    case = validate(tomllib.loads(LEVER.replace("CLEARANCE", clearance)))
    return check_case(case, fidelity="beam").load_cases["tip"]


@cache
def rocker(clearance: str, coupler: str = "60 mm") -> LoadCaseResult:
    """The four-bar of 20, 60, 40 and 60 mm with a force at its rocker's end, and play at B."""
    data = tomllib.loads(TOML)
    data["joints"]["B"]["clearance"] = clearance
    data["links"]["coupler"] |= {"part": data["links"]["rocker"]["part"]}
    data["links"]["coupler"]["points"]["B"] = [coupler, "0 mm"]
    data["load_cases"]["turn"] = {"forces": [{"link": "rocker", "at": "P", "force": ["1 N", "-3 N"]}]}
    return check_case(validate(data), fidelity="beam").load_cases["turn"]


def test_a_lever_sags_by_half_of_its_play_more() -> None:
    """Down with its load at rest; its pin may stand anywhere, so that both ends are half of the play off."""
    plain, loose = lever("0 mm").checks[0], lever("0.4 mm").checks[0]
    assert loose.value.value == pytest.approx(plain.value.value + 0.2, abs=1e-9)
    assert loose.value.high == pytest.approx(plain.value.high + 0.2, rel=2e-3)  # the hole is wider
    assert loose.value.low == pytest.approx(max(plain.value.low - 0.2, 0.0), abs=1e-5)
    assert SourceKind.PLAY in {source.kind for source in loose.value.sources}
    assert SourceKind.PLAY not in {source.kind for source in plain.value.sources}


def test_the_reason_says_where_play_decides() -> None:
    plain, loose = lever("0 mm").checks[0], lever("0.4 mm").checks[0]
    assert plain.verdict is Verdict.PASS
    assert loose.verdict is not Verdict.PASS
    assert (
        "play of pins lets it move by up to 0.2 mm to either side; without play the verdict would be pass"
        in in_words(loose.reason)
    )
    small = lever("0.01 mm").checks[0]
    assert small.verdict is Verdict.PASS
    assert "without play" not in in_words(small.reason)


def test_play_of_a_lever_changes_no_force() -> None:
    plain, loose = lever("0 mm").links["arm"], lever("0.4 mm").links["arm"]
    one, other = plain.safety_factor, loose.safety_factor
    assert other.value == one.value
    assert other.low == pytest.approx(one.low * 3.0 / 3.4)  # by a hole of 3 mm in place of 3.4 mm
    assert one.high < other.high


def test_bands_hold_the_linkage_with_another_coupler() -> None:
    """Play along the coupler is another length of it: safety factor, forces and torque of both lie in the bands."""
    loose = rocker("0.8 mm")
    play = loose.forces.play
    assert play is not None
    found = loose.links["rocker"].safety_factor
    plain = rocker("0 mm").links["rocker"].safety_factor
    assert found.value == plain.value
    assert found.low < plain.low <= plain.high < found.high
    for length in ("59.6 mm", "60.4 mm"):
        other = rocker("0 mm", length)
        factor = other.links["rocker"].safety_factor
        assert found.low <= factor.low * (1.0 + 1e-3)
        assert factor.high <= found.high * (1.0 + 1e-3)
        numbers = [(play.effort, other.reactions.drive_torque)]
        numbers += [(play.forces[name], joint.magnitude) for name, joint in other.reactions.joints.items()]
        for span, value in numbers:
            slack = 1e-3 * (span.high - span.low)  # what is left of third order
            assert span.low - slack < value < span.high + slack
    record = play_record(play)
    assert record is not None
    assert record["clearances"] == {"B": 0.8}
    [tip] = [entry for entry in record["points"] if entry["point"] == "P"]
    assert tip["free_motion"] == pytest.approx(play.free_motion("rocker", "P"))


def test_the_displacement_of_a_link_between_two_pins_has_a_band_though_nothing_bends_it() -> None:
    """Its shares are of what stretches, turns and gives way at its eyes; those of its bending are of rounding."""
    plain, loose = (rocker(play).links["coupler"].displacement_max for play in ("0 mm", "0.8 mm"))
    assert 0.0 < plain.high / plain.low < 10.0
    assert loose.low < plain.low < plain.high < loose.high < 10.0 * plain.high
    for length in ("59.6 mm", "60.4 mm"):
        other = rocker("0 mm", length).links["coupler"].displacement_max
        assert loose.low <= other.low * (1.0 + 1e-3)
        assert other.high <= loose.high * (1.0 + 1e-3)


def test_play_that_reaches_a_dead_point_leaves_forces_without_end() -> None:
    """The coupler of 60 mm in line with the rocker: at crank 180° they reach 80 mm of 100; play of 20 mm and more."""
    data = tomllib.loads(TOML)
    data["links"]["coupler"]["points"]["B"] = ["40.3 mm", "0 mm"]
    data["pose"] = {"coordinate": "crank", "angle": "180 deg", "near": {"coupler": "5 deg", "rocker": "175 deg"}}
    for joint in data["joints"].values():
        joint["clearance"] = "0.4 mm"
    result = check_case(validate(data), fidelity="beam")
    assert any(
        "play of pins may take the linkage through a dead point of the driven link crank" in in_words(w)
        for w in result.warnings
    )
    found = result.load_cases["turn"].links["rocker"].safety_factor
    assert found.low == 0.0


def test_loads_out_of_the_plane() -> None:
    """The frame's couples stay in balance where play turns the links."""
    across = 'load_cases.weight.forces.0.force=["0 N", "-0.25 N", "0.05 N"]'
    case = edited("owl-wing-static", ['joints.C.clearance="0.5 mm"', 'large_displacement="off"', across])
    case = case.model_copy(update={"checks": {}, "claims": ()})
    found = check_case(case, name="owl-wing-static", fidelity="beam").load_cases["weight"]
    plain = found.links["AE"].safety_factor
    assert plain.low < plain.value < plain.high
    assert SourceKind.PLAY in {source.kind for source in plain.sources}


def test_the_limit_load_holds_that_of_the_linkage_with_other_lengths() -> None:
    """Play at both ends of link ED is as if it were longer or shorter by half of both."""

    def limit(*entries: str) -> LoadCaseResult:
        return check_case(edited(OWL, [PLANAR, *entries], fits=False), fidelity="beam").load_cases["weight"]

    loose = limit('joints.D.clearance="0.1 mm"', 'joints.E.clearance="0.1 mm"').linkage.limit_load
    assert SourceKind.PLAY in {source.kind for source in loose.sources}
    other = limit('links.ED.points.D=["88.1 mm", "0 mm"]').linkage.limit_load
    assert loose.low <= other.low * (1.0 + 5e-3)


def test_ways_to_hold_tell_their_own_play() -> None:
    wing = "owl-wing-static"
    case = edited(wing, [PLANAR, 'joints.C.clearance="0.1 mm"'], fits=False)
    found = check_case(case, name=wing, fidelity="beam")
    held = {way.name: way.play for way in found.load_cases["weight"].ways_to_hold}
    assert held["pinned, held at AE"] > 0.05
    assert held["bonded, A, G built in"] == 0.0


@pytest.mark.parametrize("reached", [True, False])
def test_stress_reaches_as_far_as_slopes_add_up_and_as_far_as_it_does_at_the_worst_offsets(
    monkeypatch, reached
) -> None:
    """Slopes of two joints are (3, 4) and (0, 2): 7 to either side of 10. The worst offsets give 2.5 and 19.

    Of the displacement the slopes reach further than the worst offsets. Of the inverse of the buckling factor they are
    (1, -3) and (0, 2), since nothing presses the link any more with B at its second end, and thrice as much against it.
    Where the linkage cannot be assembled at the worst offsets, slopes alone count.
    """
    told = {"plain": (10.0, 1.0, 1.0), "B0": (13.0, 1.3, 2.0), "B1": (14.0, 1.4, 0.0), "C0": (10.0, 1.0, 1.0),
            "C1": (12.0, 1.2, 3.0), "-B0": (7.0, 0.7, 0.0), "-B1": (6.0, 0.6, 4.0), "-C0": (10.0, 1.0, 1.0),
            "-C1": (8.0, 0.8, 0.0), "most": (19.0, 1.5, 2.0), "least": (2.5, 0.5, 0.5)}  # fmt: skip
    stubs = {
        "_answers": lambda case, plain, here, size: [
            (name,) for name, one in zip(here.names, here.sound, strict=True) if one
        ],
        "on_plates": lambda case, link, loads: (loads,),
        "_numbers": lambda case, link, answers: np.array([[told[one][i] for (one,) in answers] for i in (0, 0, 1, 2)]),
        "acting_on": lambda *_: None,
    }
    for name, stub in stubs.items():
        monkeypatch.setattr(doubt_of_play, name, stub)
    ways = [(name, i) for name in ("B", "C") for i in range(2)]
    ends = ["plain", *(f"{sign}{name}{i}" for name, i in ways for sign in ("", "-"))]
    play = SimpleNamespace(
        clearances={"B": 0.1, "C": 0.2},
        forces={},
        through_dead_point=False,
        ends=SimpleNamespace(names=ends, sound=[name != "-C0" for name in ends]),
        solved=lambda slopes: SimpleNamespace(names=["most", "least"] * 4, sound=[reached] * len(slopes["B"])),
        loose=SimpleNamespace(radii={"B": 0.05, "C": 0.1}, ways=ways, at_rims=lambda slopes: slopes),
    )
    linkage = SimpleNamespace(longest=1.0, joints_of=lambda link: ["B", "C"])
    case = SimpleNamespace(checked_links=["arm"], linkage=linkage, layered=False)
    found = doubt_of_play.play_doubt(case, "tip", SimpleNamespace(play=play, reactions=None), ())
    stress, displacement = found.stress["arm"], found.displacement["arm"]
    assert (stress.low, stress.high) == pytest.approx((0.25, 1.9) if reached else (0.3, 1.7))
    assert (displacement.low, displacement.high) == pytest.approx((0.3, 1.7))
    assert (found.columns["arm"].low, found.columns["arm"].high) == pytest.approx((0.0, 1.0 + math.hypot(1, 3) + 2.0))
    # Between layers couples go with the force of that pin of the link which play changes most, whichever it is.
    case.layered = True
    for one, other in (("B", "C"), ("C", "B")):
        play.forces = {one: Span(value=2.0, low=1.8, high=2.2), other: Span(value=1.0, low=0.1, high=3.0)}
        tied = doubt_of_play.play_doubt(case, "tip", SimpleNamespace(play=play, reactions=None), ())
        assert (tied.stress["arm"].low, tied.stress["arm"].high) == pytest.approx((0.1, 3.0))
        assert tied.columns["arm"] == found.columns["arm"]
    told["plain"] = (10.0, 1.0, 0.0)  # nothing presses it as stated: play's part of its buckling is left out
    assert "arm" not in doubt_of_play.play_doubt(case, "tip", SimpleNamespace(play=play, reactions=None), ()).columns


def test_the_worst_offsets_lie_along_all_slopes_each_joint_at_the_rim_of_its_play() -> None:
    slopes = {
        "B": np.array([[3.0, -4.0], [-3.0, 4.0]]),
        "C": np.zeros((2, 2)),
        "D": np.array([[0.0, 2.0], [0.0, -2.0]]),
    }
    loose = SimpleNamespace(offsets=lambda shares: {name: share.tolist() for name, share in shares.items()})
    assert LooseJoints.at_rims(loose, slopes) == {  # type: ignore[arg-type]
        "B": [pytest.approx([0.6, -0.8]), pytest.approx([-0.6, 0.8])],
        "C": [[0.0, 0.0], [0.0, 0.0]],
        "D": [[0.0, 1.0], [0.0, -1.0]],
    }


def test_no_answer_is_made_of_states_in_which_the_linkage_cannot_be_assembled(monkeypatch) -> None:
    acting = SimpleNamespace(name="tip", link="arm", wrenches=(), with_wrenches=lambda _: SimpleNamespace(chosen=int))
    monkeypatch.setattr(doubt_of_play, "link_loads", lambda *_: acting)
    monkeypatch.setattr(doubt_of_play, "on_plates", lambda case, link, loads: (loads,))
    monkeypatch.setattr(doubt_of_play, "without_rounding", lambda loads, size, length: loads)
    case = SimpleNamespace(body=lambda link: None, linkage=SimpleNamespace(longest=1.0))
    for sound in ([True, False, True, False], [False, False]):
        here = SimpleNamespace(sound=np.array(sound), chosen=lambda of: SimpleNamespace(sound=of[of], loads=()))
        found = doubt_of_play._answers(case, acting, here, 1.0)  # type: ignore[arg-type]
        assert found == [(i,) for i in range(sum(sound))]


@pytest.mark.parametrize(("ends", "shares"), [((-6.0, -1.0), (0.5, 3.0)), ((-1.0, 6.0), (0.0, 3.0))])
def test_at_the_joint_of_the_drive_the_torque_counts_beside_the_force(ends, shares) -> None:
    """By its size, whichever way it turns; where play turns it about, from nothing on."""
    force, torque = Span(value=4.0, low=3.6, high=4.4), Span(value=-2.0, low=ends[0], high=ends[1])
    play = SimpleNamespace(clearances={"O": 0.1}, forces={"O": force}, effort=torque)
    alone, driven = (doubt_of_play.play_at_joint(play, "O", driven=one) for one in (False, True))
    assert (alone.low, alone.high) == pytest.approx((0.9, 1.1))
    assert (driven.low, driven.high) == pytest.approx(shares)


@pytest.mark.parametrize("holes", [("1 mm", "0.2 mm"), ("0.2 mm", "1 mm")])
def test_of_two_loose_holes_the_worse_counts(holes: tuple[str, str]) -> None:
    """Eyes of 12.8 mm about pins of 3 mm, of which one hole may be up to 1 mm wider."""
    entries = [
        f'joints.{name}.clearance={{crank=["0 mm", "{play}"]}}' for name, play in zip(("O2", "A"), holes, strict=True)
    ]
    found = narrower(edited("four-bar", entries), "crank")
    assert found.high == pytest.approx(4.0 / 3.0)
    assert found.low == pytest.approx(15.8 / 16.8 * (8.8 / 9.8) ** 2)


def test_a_seat_has_the_pin_and_not_its_hole() -> None:
    """Whose bending stiffness goes with the fourth power of its diameter."""
    case = read_case("owl-wing-static")
    body = case.body("GF")
    assert body.pin("G").diameter == pytest.approx(1.65)
    found = seat(case.linkage, "GF", body, body.pin("G"))
    assert found is not None
    assert found.diameter == pytest.approx(1.5)
