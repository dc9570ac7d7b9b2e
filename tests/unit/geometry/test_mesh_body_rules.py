"""What a body must obey before the geometry kernel sees it."""

import math
import re

import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import extent, patch_span
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.bodies.eyes import eye_reach
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube

TUBE = Tube(
    shape="tube",
    material="pvc",
    outer_diameter="5 mm",
    inner_diameter="2.5 mm",
    eye_diameter="8 mm",
    eye_thickness="7 mm",
    fillet_radius="0.8 mm",
)
BAR = Bar(
    shape="bar",
    material="resin",
    width="5 mm",
    thickness="3 mm",
    eye_diameter="9 mm",
    eye_thickness="3 mm",
    fillet_radius="1 mm",
)


def huge(unit: float) -> Tube:
    """The tube, its sizes multiplied."""
    sizes = {name: size * unit for name, size in TUBE.model_dump().items() if isinstance(size, float)}
    return TUBE.model_copy(update=sizes)


def pin(name: str, x: float, y: float = 0.0, diameter: float = 1.5) -> Pin:
    return Pin(name=name, x=x, y=y, diameter=diameter)


def row(first: float, last: float, count: int = 2, diameter: float = 1.0, along: str = "y") -> HoleRow:
    return HoleRow.model_validate(
        {
            "count": count,
            "diameter": f"{diameter} mm",
            "first": f"{first} mm",
            "last": f"{last} mm",
            "along": along,
        }
    )


def body(
    pins: tuple[Pin, ...] = (pin("A", 0.0), pin("B", 40.0)),
    ends: tuple[PlainEnd, ...] = (),
    holes: tuple[HoleRow, ...] = (),
    part: Tube | Bar = TUBE,
) -> Body:
    return Body(part=part, pins=pins, ends=ends, holes=holes)


H = PlainEnd(name="H", x=60.0, patch=5.0)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (body(pins=(), ends=(H,)), "no pin on its axis, but a part needs at least 1; add a joint"),
        (body(pins=(pin("A", 3.0),)), "all pins and load points lie at x = 3 mm"),
        (
            body(pins=(pin("A", 0.0), pin("B", 1e14))),
            r"reaches 1e\+14 mm .*; shorten it to 5e\+06 mm, or .* 1e\+08 mm",
        ),
        (body(pins=(pin("A", 1e9), pin("B", 1e9 + 40.0))), r"reaches 1e\+09 mm from the origin of its frame"),
        (body(part=huge(1e16)), r"section is 5e\+16 mm across, but must be 1e-12 to 1e\+15 mm"),
        (body(part=huge(1e-14)), r"section is 5e-14 mm across"),
        (
            body(pins=(pin("A", 0.0, diameter=1e-7), pin("B", 40.0))),
            "hole at A has a diameter of 1e-07 mm, but must have at least 4e-06 mm",
        ),
        (
            body(pins=(pin("A", 0.0, diameter=8.0), pin("B", 40.0))),
            "hole at A has a diameter of 8 mm.*eye_diameter 8 mm",
        ),
        (
            body(pins=(pin("A", 0.0, y=1.5), pin("B", 40.0))),
            "A is 1.5 mm .* than 1.5 mm .* above 8 mm",
        ),
        (
            body(pins=(pin("A", 0.0), pin("B", 20.0, y=-4.0), pin("C", 40.0))),
            "B is 4 mm .* than 4 mm .* above 8 mm",
        ),
        (
            body(pins=(pin("A", 0.0), pin("C", 40.0), pin("B", 1.5))),
            "holes at A and B overlap: .* than 1.5 mm",
        ),
        (
            body(pins=(pin("A", 0.0), pin("B", 9.6), pin("C", 40.0))),
            "eyes at A and B, or .*overlap: move .* more than 9.6 mm apart",
        ),
        (
            body(pins=(pin("A", 0.0), pin("B", 8.9), pin("C", 40.0)), part=BAR),
            r"eyes at A and B, or .*more than 9 mm apart \(now 8.9 mm\)",
        ),
        (
            body(
                pins=(pin("A", 0.0), pin("B", 10.9), pin("C", 40.0)), part=BAR.model_copy(update={"eye_thickness": 6.0})
            ),
            "eyes at A and B, or .*more than 11 mm apart",
        ),
        (
            body(pins=(pin("A", 0.0), Pin(name="S", x=15.0, y=0.0, diameter=1.5, slot=13.0), pin("C", 40.0)), part=BAR),
            r"eyes at A and S, or .*more than 15.5 mm apart \(now 15 mm\)",
        ),
        (
            body(ends=(PlainEnd(name="H", x=60.0, patch=20.0),)),
            "patch of H .* eye at B .* below 15.2 mm",
        ),
        (body(ends=(H, PlainEnd(name="I", x=54.0, patch=4.0))), "patches of H and I overlap"),
        (body(ends=(PlainEnd(name="M", x=20.0, patch=31.0),)), "patch of M .* below 30.4 mm"),
        (
            body(ends=(PlainEnd(name="M", x=38.0, patch=1.0),)),
            "M is no pin, but lies in the eye at B and its fillet",
        ),
        (body(holes=(row(4.0, 20.0),)), r"holes\[1\].*at x = 4 mm that runs into the eye or fillet at A"),
        (body(holes=(row(10.0, 38.0),)), "at x = 38 mm that runs into the eye or fillet at B"),
        (body(holes=(row(10.0, 20.0, count=11),)), "overlap: set diameter below 1 mm"),
        (body(holes=(row(10.0, 20.0, diameter=5.0, along="z"),)), "cut the link through: set diameter below 5 mm"),
        (body(holes=(row(10.0, 20.0, diameter=3.0),), part=BAR), "set diameter below 3 mm"),
        (body(ends=(H,), holes=(row(50.0, 59.8),)), "at x = 59.8 mm, but holes must lie between x = 0.5 and 59.5 mm"),
        (body(holes=(row(10.0, 20.0), row(15.0, 20.5, along="z"))), r"at x = 20 mm that runs into one of holes\[2\]"),
    ],
)
def test_what_is_wrong_is_named(wrong: Body, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        check_body(wrong)


@pytest.mark.parametrize(
    "right",
    [
        body(),
        body(part=BAR),
        body(pins=(pin("A", 0.0, y=1.4), pin("B", 20.0, y=-3.9), pin("C", 40.0))),
        body(ends=(H,), holes=(row(10.0, 20.0), row(50.0, 52.0, along="z"))),
        body(ends=(H, PlainEnd(name="I", x=52.0, patch=4.0))),
        body(holes=(row(30.0, 10.0, count=3),)),
        body(holes=(row(10.0, 10.0, count=1),)),
        body(holes=(row(10.0, 20.0, diameter=4.5),), part=TUBE),
        # Round a tube the fillet ends 4 + 0.8 mm from the pin; beside a flush eye of 9 mm, one of 3 mm has its centre
        # 7.5 mm from the pin and 5.5 mm from the axis, so it ends 5.099 mm along it.
        body(pins=(pin("A", 0.0), pin("B", 9.61), pin("C", 40.0))),
        body(pins=(pin("A", 0.0), pin("B", 10.2), pin("C", 40.0)), part=BAR.model_copy(update={"fillet_radius": 3.0})),
        # On either side of the bar: 2.2 mm off the axis an eye of 9 mm stands out by 4.2 mm above and not at all below.
        body(pins=(pin("A", 0.0), pin("P", 20.0, y=2.2), pin("R", 20.0, y=-2.2), pin("C", 40.0)), part=BAR),
        body(pins=(pin("A", 0.0), pin("B", 2.0), pin("C", 40.0)), part=BAR.model_copy(update={"eye_diameter": 5.0})),
    ],
)
def test_what_is_right_passes(right: Body) -> None:
    check_body(right)


@pytest.mark.parametrize("x", [60.0, 20.0, -9.0])
def test_the_longest_patch_that_an_error_names_is_the_longest(x: float) -> None:
    with pytest.raises(CaseError) as refused:
        check_body(body(ends=(PlainEnd(name="H", x=x, patch=1000.0),)))
    limit = float(re.search(r"below ([\d.]+) mm", str(refused.value))[1])
    check_body(body(ends=(PlainEnd(name="H", x=x, patch=0.999 * limit),)))
    with pytest.raises(CaseError):
        check_body(body(ends=(PlainEnd(name="H", x=x, patch=1.001 * limit),)))


def test_places_along_the_link() -> None:
    link = body(ends=(H, PlainEnd(name="I", x=52.0, patch=4.0), PlainEnd(name="K", x=-20.0, patch=3.0)))
    assert extent(link) == (-20.0, 60.0)
    assert [patch_span(link, end) for end in link.ends] == [(55.0, 60.0), (50.0, 54.0), (-20.0, -17.0)]
    # The fillet's centre is 4.8 mm from an axis on the tube; off it by 4.5 mm, 2 mm of that lie across.
    assert eye_reach(link, link.pins[0]) == pytest.approx(4.8)
    assert eye_reach(link, pin("X", 10.0, y=-4.5)) == pytest.approx(math.sqrt(4.8**2 - 2.0**2))
