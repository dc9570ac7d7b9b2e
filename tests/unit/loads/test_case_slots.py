"""What a case may say about slots and arms, and what the program answers."""

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.beam.cut_free import link_loads
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.geometry.parts.part import Pin
from alula.loads.records.applied import PointLoad
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.statics.statics import solve_statics


def ornithopter(*settings: str):
    return edited("ornithopter", list(settings))


def flapping(*settings: str):
    return edited("flapping-wing-reference", list(settings))


def test_a_slot_becomes_a_hole_drawn_out_with_its_clearance() -> None:
    body = ornithopter('links.lever-right.slots.slot.clearance="0.1 mm"').body("lever-right")
    slot = body.pins[0]
    assert slot == Pin(
        name="slot", x=pytest.approx(-7.372736), y=0.0, diameter=2.1, slot=pytest.approx(1.010357), clearance=0.1
    )
    assert slot.pin_diameter == 2.0


def test_an_arm_starts_at_its_foot() -> None:
    pins = {pin.name: pin for pin in flapping().body("outer-right").pins}
    assert pins["QR"].foot == (0.0, 0.0)
    assert pins["DR"].foot is None
    assert flapping().links["outer-right"].pieces == (("DR", "ER"), ("DR", "QR"))
    assert flapping().links["inner-right"].pieces == (("BR", "O4R"), ("O4R", "DR"))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (['links.lever-right.slots.R={first="0 mm", last="1 mm"}'], r"lever-right.slots.R: a slot belongs to.*R; name"),
        (['links.rod.slots.C={first="9 mm", last="11 mm"}'], r"rod.slots.C: a slot belongs to.*slot-left"),
        (["links.lever-right.slots={}"], r"lever-right.slots: the pin of joint 'slot-right' slides.*add slots.slot"),
        (['joints.slot-right.direction="5 deg"'], r"slots.slot: a part's slot runs along.*5 deg"),
        (['links.base.slots.guide={first="0 mm", last="1 mm"}'], r"links.base.part: it is missing, but slots"),
        (['links.lever-right.slots.slot.first="-6 mm"'], "must be less than last = -6.86756 mm; swap"),
        (
            ['load_cases.slow.forces=[{link="lever-right", at="slot", force=["1 N", "0 N"]}]'],
            r"slow.forces.0: point 'slot' of link 'lever-right' is a slot, where the pin alone can push",
        ),
        (['carried.0.at="slot"'], "carried.0: point 'slot' of link 'lever-right' is a slot"),
        (['drive={link="rod", joint="slot-right"}'], "slots.slot: its joint 'slot-right' is driven"),
    ],
)  # fmt: skip
def test_slots_that_do_not_fit_are_refused(settings: list[str], message: str) -> None:
    with pytest.raises(CaseError, match=message):
        ornithopter(*settings)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ('links.outer-right.arms={QR="X"}', "an arm from 'X' to 'QR' needs two points of the link"),
        ('links.outer-right.arms={QR="ER"}', "an arm from 'ER' to 'QR' needs a pin at both"),
        ("links.outer-right.arms={}", "pin QR is 15.76 mm off the link's axis.*, or let an arm reach it"),
    ],
)
def test_arms_that_do_not_fit_are_refused(setting: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        flapping(setting)


def test_a_pin_pushes_where_it_stands_in_its_slot_and_across_it() -> None:
    case = ornithopter('pose.angle="130 deg"', "load_cases.slow.own_weight=false")
    case = case.model_copy(update={"load_cases": {"slow": case.load_cases["slow"]}})
    pose = case.solve_pose()
    reactions = solve_statics(pose, case.pinned_drive, push_down())
    body = case.body("lever-right")
    loads = link_loads("slow", "lever-right", body, reactions, ())
    slot = next(pin for pin in loads.pins if pin.name == "slot")
    assert slot.slotted
    place = pose.rotation("lever-right").T @ (pose.position("rod", "C") - pose.position("lever-right", "R"))
    assert slot.centre[:2] == pytest.approx(place, abs=1e-9)
    assert body.pins[0].span[0] < slot.centre[0] < body.pins[0].span[1]
    force = abs(slot.wrench[1])
    assert force > 0.1
    assert slot.wrench[[0, 5]] == pytest.approx([0.0, 0.0], abs=1e-9 * force)


def test_a_pin_that_leaves_its_slot_is_named() -> None:
    case = ornithopter('links.lever-right.slots.slot={first="-7.6 mm", last="-6.8 mm"}')
    pose = case.solve_pose()
    reactions = solve_statics(pose, case.pinned_drive, push_down())
    with pytest.raises(
        CaseError, match=r"lever-right.slots.slot: its pin stands at x = -7.6779\d* mm.*-7.6 to -6.8 mm"
    ):
        link_loads("slow", "lever-right", case.body("lever-right"), reactions, ())


def push_down() -> list[PointLoad]:
    return [PointLoad(link="lever-right", point="W", wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]))]


@pytest.mark.parametrize("solve", [solve_case_statics, solve_case_motion])
@pytest.mark.parametrize(("poses", "side"), [(3, "first"), (37, "last")])
def test_a_motion_that_takes_a_pin_out_of_its_slot_is_refused(solve, poses: int, side: str) -> None:
    """The pin goes from 7.07 to 7.68 mm from the pivot, at poses between those that are asked for too."""
    ends = {"first": ("-7.6 mm", "-6.86 mm"), "last": ("-7.88 mm", "-7.15 mm")}[side]
    long, short = (f'{{ first = "{a}", last = "{b}" }}' for a, b in (("-7.88 mm", "-6.86 mm"), ends))
    settings = [f"motion.poses={poses}"]
    solve(ornithopter(*settings, f"links.lever-left.slots.slot={long}"))
    with pytest.raises(
        CaseError, match=r"^links\.lever-left\.slots\.slot: .* from x = -7\.6779\d* to -7\.067\d* mm, but"
    ):
        solve(ornithopter(*settings, f"links.lever-left.slots.slot={short}"))
