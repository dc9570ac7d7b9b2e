"""What slots, arms and discs must obey, and the ornithopter's moving parts."""

import math

import pytest
from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import apart, extent, hand_section, reference_line
from alula.geometry.bodies.body_rules import check_body, check_length
from alula.geometry.bodies.eyes import eye_reach
from alula.geometry.mechanisms.ornithopter import OrnithopterRules, variants
from alula.geometry.parts.part import Bar, Body, Disc, HoleRow, Pin, PlainEnd, Slot, Tube

BAR = Bar(
    shape="bar",
    material="resin",
    width="8 mm",
    thickness="4 mm",
    eye_diameter="12 mm",
    eye_thickness="4 mm",
    fillet_radius="2 mm",
)
TUBE = Tube(
    shape="tube",
    material="pvc",
    outer_diameter="5 mm",
    inner_diameter="2.5 mm",
    eye_diameter="8 mm",
    eye_thickness="7 mm",
    fillet_radius="0.8 mm",
)
LUGGED = TUBE.model_copy(update={"arm_width": 5.0, "arm_thickness": 2.0})
DISC = Disc(shape="disc", material="resin", diameter="9 mm", thickness="2 mm", eye_diameter="2.6 mm")
A, B = Pin(name="A", x=0.0, y=0.0, diameter=3.0), Pin(name="B", x=60.0, y=0.0, diameter=3.0)
SLOT = Pin(name="S", x=20.0, y=0.0, diameter=3.0, slot=10.0)
ARM = Pin(name="Q", x=10.0, y=40.0, diameter=3.0, foot=(0.0, 0.0))
LUG = Pin(name="Q", x=30.0, y=15.0, diameter=2.0, foot=(30.0, 0.0))
SHAFT, CRANK_PIN = Pin(name="O", x=0.0, y=0.0, diameter=1.0), Pin(name="A", x=3.0, y=0.0, diameter=2.0)


def body(*pins: Pin, part: Tube | Bar | Disc = BAR, ends: tuple[PlainEnd, ...] = (), holes: tuple[HoleRow, ...] = ()):
    return Body(part=part, pins=pins, ends=ends, holes=holes)


def end(x: float, patch: float) -> PlainEnd:
    return PlainEnd(name="E", x=x, patch=patch)


def hole(x: float) -> HoleRow:
    return HoleRow(count=1, diameter="1 mm", first=f"{x} mm", last=f"{x} mm", along="z")


def moved(pin: Pin, **changes: object) -> Pin:
    return Pin(**{**vars(pin), **changes})


@pytest.mark.parametrize(
    "right",
    [
        body(A, SLOT, B),
        body(SLOT, B),
        body(A, B, ARM),
        body(A, B, LUG, part=LUGGED),
        body(A, ARM, ends=(end(60.0, 5.0),)),
        body(SHAFT, CRANK_PIN, part=DISC),
    ],
)
def test_what_fits_passes(right: Body) -> None:
    check_body(right)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (body(A, moved(SLOT, y=0.5), B), "slot at S lies 0.5 mm off the link's axis"),
        (body(A, moved(SLOT, diameter=12.0), B), "pin hole at S has a diameter of 12 mm"),
        (body(A, moved(SLOT, x=7.0), B), "pin holes at A and S overlap"),
        (body(A, moved(SLOT, diameter=2.0), B, part=TUBE), "S: a part of shape tube takes no slots; choose"),
        (body(SHAFT, moved(SLOT, x=3.0, diameter=1.0, slot=0.4), part=DISC), "S: a part of shape disc takes no slots"),
        (
            body(A, SLOT, B, holes=(hole(33.0),)),
            "runs into the eye or fillet at S",
        ),
        (body(A, moved(SLOT, x=50.0, slot=6.0), ends=(end(62.0, 3.0),)), "would run into the eye at S.* below 1 mm"),
        (body(A, B, moved(ARM, foot=(5.0, 0.0))), "arm to Q must start at a pin hole on the link's axis"),
        (body(A, SLOT, B, moved(ARM, foot=(20.0, 0.0))), "arm to Q must start at a pin hole"),
        (body(A, B, moved(ARM, x=70.0)), "arm to Q stands at 29.7 degrees.*at least 30: .* at most 69.28 mm"),
        (body(A, B, moved(ARM, x=5.0, y=13.0)), "Q is too close to the bar: move it more than 14 mm off"),
        (body(A, B, LUG, part=TUBE), "arm to Q needs sizes.*state arm_width and arm_thickness"),
        (body(A, B, moved(LUG, x=31.0), part=LUGGED), "arm to Q starts at x = 30 mm.* square on it: .* x = 31 mm"),
        (body(A, B, moved(LUG, y=5.5), part=LUGGED), "Q is too close to the tube: move it more than 5.8 mm off"),
        (body(A, moved(B, x=36.0), LUG, part=LUGGED), "26.7 to 33.3 mm .* runs into the eye or pin hole at B"),
        (body(A, B, LUG, moved(LUG, name="R", x=36.0, foot=(36.0, 0.0)), part=LUGGED), "runs into the arm to Q"),
        (body(A, B, LUG, part=LUGGED, holes=(hole(33.0),)), "runs into a hole at x = 33 mm"),
        (body(A, B, LUG, part=LUGGED.model_copy(update={"arm_thickness": 3.5})), "arm_thickness 3.5 mm and two fil"),
        (body(ARM), "no pin on its axis, but a part needs at least 1"),
        (body(SHAFT, moved(CRANK_PIN, x=3.3), part=DISC), "ring about the hole at A .* diameter above 9.2 mm"),
        (body(SHAFT, moved(CRANK_PIN, x=2.5), part=DISC), "holes at O and A overlap: .* below 2.5 mm"),
        (body(SHAFT, CRANK_PIN, part=DISC, ends=(end(4.0, 1.0),)), "E: a part of shape disc takes no load points"),
        (
            body(SHAFT, CRANK_PIN, part=DISC, holes=(hole(1.0),)),
            "holes: a part of shape disc takes no rows of holes",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_with_its_remedy(wrong: Body, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        check_body(wrong)


def test_a_disc_across_the_x_axis_may_be_the_ground_but_no_link_that_moves() -> None:
    across = body(SHAFT, moved(CRANK_PIN, x=0.0, y=CRANK_PIN.x), part=DISC)
    check_body(across)
    with pytest.raises(CaseError, match="all pins and load points lie at x = 0 mm"):
        check_length(across)


def cornered(angle: float, fillet: float, eye: float, thickness: float = 4.0, width: float = 8.0) -> Body:
    """A bar with an arm of 60 mm at an angle [deg] from the pin at its end."""
    sizes = {"fillet_radius": fillet, "eye_diameter": eye, "eye_thickness": thickness, "width": width}
    turn = math.radians(angle)
    arm = moved(ARM, x=60.0 * math.cos(turn), y=60.0 * math.sin(turn))
    return body(A, moved(B, x=90.0), arm, part=BAR.model_copy(update=sizes))


@pytest.mark.parametrize(
    ("angle", "fillet", "eye", "thickness", "most"),
    [
        # At 90° two fillets touch where (4 + f)/(6.4 + f) = sin 45°: f = 1.79411 mm.
        (90.0, 1.80, 12.8, 4.0, 1.79411),
        (90.0, 1.80, 12.8, 10.0, 1.79411),
        # At 60° the corner is 8 mm from the pin: a thick eye of 7 mm hides in it with a fillet below 1 mm.
        (60.0, 1.01, 14.0, 10.0, 1.0),
        (60.0, 2.10, 18.0, 4.0, 1.0),
    ],
)
def test_a_corner_at_an_arm_must_hold_the_fillets(
    angle: float, fillet: float, eye: float, thickness: float, most: float
) -> None:
    with pytest.raises(CaseError, match=rf"fillet_radius .* too large for the corner of {angle:g} degrees") as refused:
        check_body(cornered(angle, fillet, eye, thickness))
    assert f"set it below {most:g} mm" in str(refused.value)
    check_body(cornered(angle, 0.99 * most, eye, thickness))


def test_an_eye_as_thick_as_its_bar_hides_in_a_corner_with_any_fillet() -> None:
    check_body(cornered(60.0, 2.1, 14.0))


@pytest.mark.parametrize(
    ("arms", "message"),
    [
        ((ARM, moved(ARM, name="R", x=30.0)), "arm to R and the arm to Q stand at 22.8 degrees.*at least 30; move"),
        (
            (moved(ARM, x=40.0), moved(ARM, name="R", x=10.0, y=60.0, foot=(60.0, 0.0))),
            "arm to Q and the arm to R are too close: 0 mm apart",
        ),
        (
            (ARM, moved(ARM, name="R", x=24.0, foot=(60.0, 0.0))),
            "Q and the eye at R .*: 2 mm apart.* 2 mm further",
        ),
        (
            # From (40.15, 40) to the line of (60, 0) and (50, 60) are 13 mm, and the eye and half the arm take 10 mm.
            (moved(ARM, x=40.15), moved(ARM, name="R", x=50.0, y=60.0, foot=(60.0, 0.0))),
            r"arm to R and the eye at Q are too close: 3\.00\d* mm apart",
        ),
    ],
)
def test_arms_must_stay_clear_of_each_other(arms: tuple[Pin, ...], message: str) -> None:
    with pytest.raises(CaseError, match=message):
        check_body(body(A, B, *arms))


def test_slot_and_disc_sizes_are_checked_as_they_are_read() -> None:
    with pytest.raises(ValidationError, match="must be less than last = 2 mm; swap"):
        Slot(first="2 mm", last="2 mm")
    with pytest.raises(ValidationError, match="must be less than diameter 9 mm"):
        Disc(shape="disc", material="resin", diameter="9 mm", thickness="2 mm", eye_diameter="9 mm")


def test_a_slot_and_its_eye_are_drawn_out_along_the_axis() -> None:
    long = body(SLOT, B)
    assert extent(long) == (15.0, 60.0)
    assert SLOT.span == (15.0, 25.0)
    round_ = body(moved(SLOT, slot=0.0), B)
    assert eye_reach(long, SLOT) == pytest.approx(eye_reach(round_, moved(SLOT, slot=0.0)) + 5.0)
    assert apart(SLOT, B) == 35.0
    assert apart(SLOT, moved(A, x=20.0, y=7.0)) == 7.0


def test_an_arm_leaves_the_extent_alone_and_widens_its_foot() -> None:
    bent = body(A, ARM, ends=(end(60.0, 5.0),))
    assert extent(bent) == (0.0, 60.0)
    assert eye_reach(bent, A) == 8.0
    low = moved(ARM, x=40.0, y=30.0)
    half = math.atan2(30.0, 40.0) / 2.0
    assert eye_reach(body(A, low), A) == pytest.approx(6.0 / math.tan(half))
    assert reference_line(bent) == (0.0, 6.0)
    assert reference_line(body(A, B, ARM)) == (0.0, 60.0)
    backwards = body(B, moved(ARM, x=60.0, foot=(60.0, 0.0)), ends=(end(0.0, 5.0),))
    assert reference_line(backwards) == (60.0, 54.0)


def test_a_disc_counts_by_its_narrowest_net_chord() -> None:
    """At A the chord is 2 √(4.5² - 3²) = 6.708 mm less 2 mm of hole; at O 9 mm less 1 mm."""
    section = hand_section(body(SHAFT, CRANK_PIN, part=DISC))
    assert 2.0 * section.half_y == pytest.approx(2.0 * math.sqrt(4.5**2 - 9.0) - 2.0, rel=1e-3)
    assert 2.0 * section.half_z == 2.0
    assert (DISC.section.width, DISC.section.height) == (9.0, 2.0)
    assert hand_section(body(A, SLOT, B)) == BAR.section


def test_the_moving_parts_of_the_ornithopter_follow_its_rules() -> None:
    """Hernández (2022): disc radius 4.5 mm, rod 10 mm and 2 mm thick, lever 3.5 mm thick, walls of 0.5 mm."""
    for name, rules in variants().items():
        sizes, parts = rules.dimensions(), rules.bodies("resin-405nm")
        assert set(parts) == {"crank", "rod", "lever"}
        for part in parts.values():
            check_body(part)
        lever = parts["lever"]
        low, high = lever.pins[0].span
        assert (low, high) == pytest.approx((-sizes.slot_reach - 0.2, -sizes.pivot_offset + 0.2)), name
        assert lever.part.eye_diameter == sizes.hole_diameter + 2.0 * sizes.thin_wall
        assert parts["crank"].part.diameter == 2.0 * sizes.crank_disc_radius
    built = OrnithopterRules().bodies("resin-405nm")
    assert built["crank"].part.diameter == 9.0
    assert built["rod"].part.thickness == 2.0
    assert built["lever"].part.thickness == 3.5
    loose = OrnithopterRules(clearance="0.2 mm").bodies("resin-405nm")
    assert loose["rod"].pins[0].diameter == 2.2
    assert loose["rod"].part.eye_diameter == pytest.approx(2.2 + 2.0 * 0.6)
