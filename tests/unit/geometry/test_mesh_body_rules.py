"""What a body must obey before the geometry kernel sees it."""

import math

import pytest

from geometry.base.errors import CaseError
from geometry.parts.body_rules import check_body, extent, eye_reach, patch_span
from geometry.parts.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube

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
    sizes = {name: size * unit for name, size in TUBE.model_dump().items() if name not in ("shape", "material")}
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
        (body(pins=(), ends=(H,)), "0 pins, but a part needs at least 1"),
        (body(pins=(pin("A", 3.0),)), "all lie at x = 3 mm"),
        (body(pins=(pin("A", 0.0), pin("B", 1e14))), r"reaches 1e\+14 mm from .* 1e\+06 times .* 5e\+06 mm; shorten"),
        (body(pins=(pin("A", 1e9), pin("B", 1e9 + 40.0))), r"reaches 1e\+09 mm from the origin of its frame"),
        (body(part=huge(1e150)), r"section is 5e\+150 mm across, but the geometry kernel needs 1e-12 to 1e\+15 mm"),
        (body(part=huge(1e-14)), r"section is 5e-14 mm across"),
        (
            body(pins=(pin("A", 0.0, diameter=1e-7), pin("B", 40.0))),
            "hole at A has a diameter of 1e-07 mm, but the geometry kernel sees none below 4e-06 mm .* larger",
        ),
        (
            body(pins=(pin("A", 0.0, diameter=8.0), pin("B", 40.0))),
            "hole at A has a diameter of 8 mm.*eye_diameter 8 mm",
        ),
        (body(pins=(pin("A", 0.0, y=1.5), pin("B", 40.0))), "pin A lies 1.5 mm off.*less than 1.5 mm"),
        (body(pins=(pin("A", 0.0), pin("B", 20.0, y=-4.0), pin("C", 40.0))), "pin B lies -4 mm off.*less than 4 mm"),
        (body(pins=(pin("A", 0.0), pin("C", 40.0), pin("B", 1.5))), "pin holes at A and B run into each other"),
        (
            body(pins=(pin("A", 0.0), pin("B", 9.6), pin("C", 40.0))),
            "eyes at A and B overlap.*9.6 mm apart.*than 9.6 mm",
        ),
        (
            body(pins=(pin("A", 0.0), pin("B", 8.9), pin("C", 40.0)), part=BAR),
            "eyes at A and B overlap.*than 9 mm; move",
        ),
        (
            body(
                pins=(pin("A", 0.0), pin("B", 10.9), pin("C", 40.0)), part=BAR.model_copy(update={"eye_thickness": 6.0})
            ),
            "eyes at A and B overlap.*than 11 mm; move",
        ),
        (
            body(pins=(pin("A", 0.0), Pin(name="S", x=15.0, y=0.0, diameter=1.5, slot=13.0), pin("C", 40.0)), part=BAR),
            "eyes at A and S overlap.*15 mm apart.*than 15.5 mm",
        ),
        (body(ends=(PlainEnd(name="H", x=60.0, patch=20.0),)), "patch of H, x = 40 to 60 mm, runs into the eye at B"),
        (body(ends=(PlainEnd(name="H", x=60.0, patch=80.0),)), "patch of H is 80 mm long.*x = -20 to 60"),
        (body(ends=(H, PlainEnd(name="I", x=54.0, patch=4.0))), "patches of H and I overlap"),
        (body(holes=(row(4.0, 20.0),)), r"holes\[1\].*at x = 4 mm that runs into the eye or fillet at A"),
        (body(holes=(row(10.0, 38.0),)), "at x = 38 mm that runs into the eye or fillet at B"),
        (body(holes=(row(10.0, 20.0, count=11),)), "are 1 mm apart and overlap"),
        (body(holes=(row(10.0, 20.0, diameter=5.0, along="z"),)), "cut the link through, because its section is 5 mm"),
        (body(holes=(row(10.0, 20.0, diameter=3.0),), part=BAR), "section is 3 mm across"),
        (body(ends=(H,), holes=(row(50.0, 59.8),)), "at x = 59.8 mm, but holes must lie within the link"),
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


def test_places_along_the_link() -> None:
    link = body(ends=(H, PlainEnd(name="I", x=52.0, patch=4.0), PlainEnd(name="K", x=-20.0, patch=3.0)))
    assert extent(link) == (-20.0, 60.0)
    assert [patch_span(link, end) for end in link.ends] == [(55.0, 60.0), (50.0, 54.0), (-20.0, -17.0)]
    # The fillet's centre is 4.8 mm from an axis on the tube; off it by 4.5 mm, 2 mm of that lie across.
    assert eye_reach(link, link.pins[0]) == pytest.approx(4.8)
    assert eye_reach(link, pin("X", 10.0, y=-4.5)) == pytest.approx(math.sqrt(4.8**2 - 2.0**2))
