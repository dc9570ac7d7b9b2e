"""What joints state of their pins' holes: clearances, fits, tight pins, and what is left open."""

import math

import pytest

from alula.geometry.joints.fits import fit
from alula.geometry.joints.holes import Known, PinHoles, pin_holes
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage

H8F7 = fit("H8/f7", 3.0).bounds
H9D9 = fit("H9/d9", 3.0).bounds


def holes(**entries: object) -> PinHoles:
    return pin_holes(Joint.model_validate({"links": ("crank", "rod"), "pin_diameter": "3 mm"} | entries))


def ranges(found: PinHoles) -> list[tuple[float, float]]:
    return [(hole.low, hole.high) for hole in found.holes]


NOTHING = (0.0, H8F7[1])


@pytest.mark.parametrize(
    ("entries", "first", "second", "play"),
    [
        ({}, NOTHING, NOTHING, 0.0),
        ({"tight_in": "crank"}, (0.0, 0.0), NOTHING, 0.0),
        ({"tight_in": ["crank", "rod"]}, (0.0, 0.0), (0.0, 0.0), 0.0),
        ({"tight_in": "rod", "clearance": "0.1 mm"}, (0.1, 0.1), (0.0, 0.0), 0.1),
        ({"tight_in": "crank", "clearance": ["20 um", "0.1 mm"]}, (0.0, 0.0), (0.02, 0.1), 0.1),
        ({"tight_in": "crank", "fit": "H9/d9"}, (0.0, 0.0), H9D9, H9D9[1]),
        ({"tight_in": "crank", "fit": "running"}, (0.0, 0.0), H8F7, H8F7[1]),
        ({"clearance": {"rod": "0.1 mm"}}, NOTHING, (0.1, 0.1), 0.1),
        ({"clearance": {"crank": "0.05 mm", "rod": ["0 mm", "0.1 mm"]}}, (0.05, 0.05), (0.0, 0.1), 0.15),
        ({"clearance": {"crank": "0.05 mm"}, "tight_in": "rod"}, (0.05, 0.05), (0.0, 0.0), 0.05),
        ({"fit": {"crank": "press"}}, (0.0, 0.0), NOTHING, 0.0),
        ({"fit": {"crank": "press", "rod": "H9/d9"}}, (0.0, 0.0), H9D9, H9D9[1]),
        ({"fit": {"rod": "press"}, "clearance": "0.1 mm"}, (0.1, 0.1), (0.0, 0.0), 0.1),
        ({"fit": {"crank": "running", "rod": "running"}}, H8F7, H8F7, 2.0 * H8F7[1]),
        ({"fit": {"crank": "H9/d9"}, "clearance": {"rod": "0.3 mm"}}, H9D9, (0.3, 0.3), H9D9[1] + 0.3),
    ],
)
def test_each_hole_stands_by_itself(entries, first, second, play):
    found = holes(**entries)
    assert ranges(found) == [pytest.approx(first), pytest.approx(second)]
    assert found.shared is None
    assert found.play == pytest.approx(play)
    for hole in found.holes:
        assert hole.nominal == pytest.approx(0.5 * (hole.low + hole.high), abs=0.6 * H8F7[0])
        assert hole.low <= hole.nominal <= hole.high
        assert hole.stated is ((hole.low, hole.high) != NOTHING)


@pytest.mark.parametrize(
    ("entries", "shared"),
    [
        ({"clearance": "0.1 mm"}, (0.1, 0.1)),
        ({"clearance": "0 mm"}, (0.0, 0.0)),
        ({"clearance": ["0.02 mm", "0.1 mm"]}, (0.02, 0.1)),
        ({"fit": "H9/d9"}, H9D9),
        ({"fit": "running"}, H8F7),
    ],
)
def test_without_tight_in_either_hole_may_have_all_of_it(entries, shared):
    found = holes(**entries)
    assert found.shared == pytest.approx(shared)
    assert ranges(found) == 2 * [(0.0, pytest.approx(shared[1]))]
    assert [hole.nominal for hole in found.holes] == 2 * [pytest.approx(0.25 * sum(shared))]
    assert found.play == pytest.approx(shared[1])


def test_what_tells_a_hole():
    found = holes(fit={"crank": "press", "rod": "running"})
    assert [hole.known for hole in found.holes] == [Known.PRESSED, Known.RUNNING]
    assert found["rod"].known is Known.RUNNING
    assert [hole.known for hole in holes(fit="H8/f7").holes] == 2 * [Known.FIT]
    assert [hole.known for hole in holes(clearance={"rod": "0.1 mm"}).holes] == [Known.NOTHING, Known.CLEARANCE]


def test_a_pressed_pin_is_tight():
    joint = Joint.model_validate({"links": ("crank", "rod"), "fit": {"rod": "press"}})
    assert joint.tight_in == ("rod",)
    assert joint.is_tight_in("rod")
    assert not joint.is_tight_in("crank")
    assert "tight_in" not in joint.model_fields_set


@pytest.mark.parametrize("size", [{"pin_diameter": None}, {"pin_diameter": "600 mm"}])
def test_without_a_diameter_that_has_fits_nothing_bounds_a_hole_of_which_nothing_is_stated(size):
    found = holes(**size)
    assert ranges(found) == 2 * [(0.0, math.inf)]
    assert [hole.nominal for hole in found.holes] == [0.0, 0.0]
    assert found.play == 0.0


@pytest.mark.parametrize(
    ("entries", "known"),
    [({"bonded": True}, Known.PRESSED), ({"clamped": True}, Known.NO_PIN), ({"type": "slider"}, Known.NO_PIN)],
)
def test_what_does_not_turn_has_no_play(entries, known):
    found = holes(**entries)
    assert ranges(found) == 2 * [(0.0, 0.0)]
    assert {hole.known for hole in found.holes} == {known}


def test_the_clearance_of_a_pin_in_a_slot_is_that_of_its_hole_beside_the_slot():
    where = {"A": ("0 mm", "0 mm"), "P": ("9 mm", "0 mm")}
    slot = {"first": "1 mm", "last": "5 mm", "clearance": "0.2 mm"}
    links = {
        "crank": Link.model_validate({"ground": True, "points": where, "slots": {"A": slot}}),
        "rod": Link.model_validate({"points": where}),
    }
    entries = {"links": ("crank", "rod"), "type": "pin-in-slot", "pin_diameter": "3 mm"}
    for stated, hole, play in ((["0 mm", "0.1 mm"], (0.0, 0.1), 0.3), (None, NOTHING, 0.2)):
        joint = Joint.model_validate(entries | ({"clearance": stated} if stated else {}))
        found = Linkage(links, {"A": joint}).pin_holes("A")
        assert ranges(found) == [pytest.approx((0.2, 0.2)), pytest.approx(hole)]
        assert found["crank"].known is Known.SLOT
        assert found.shared is None
        assert found.play == pytest.approx(play)
