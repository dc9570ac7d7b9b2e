"""How an imported part lies in its link: bores matched to points."""

import itertools

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.facts import Bore
from alula.geometry.parts.step import StepPart
from alula.geometry.placement.fit import Wanted
from alula.geometry.placement.match import place, points_of_part, with_loaded_bores

POINTS = {"A": (0.0, 0.0), "B": (60.0, 0.0), "C": (22.0, 34.0)}
DIAMETERS = {"A": 5.0, "B": 4.0, "C": 6.0}


def part(**entries):
    return StepPart.model_validate({"shape": "step", "material": "pla-fdm-xy", "file": "x.step", **entries})


def wanted(points=POINTS, diameters=DIAMETERS):
    return tuple(Wanted(name=name, place=at, diameter=diameters[name]) for name, at in points.items())


def bore(name, centre, diameter, axis=(0.0, 0.0, 1.0)):
    return Bore(
        name=name, axis=tuple(axis), centre=tuple(centre), diameter=diameter, length=3.0, through=True,
        spans=((-1.5, 1.5),), slot=0.0, slot_axis=(0.0, 0.0, 0.0),
    )  # fmt: skip


def rotation(seed):
    """A random rotation, by the QR factors of a random matrix."""
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0.0 else -q


def moved(turn, shift, points=POINTS, diameters=DIAMETERS, sense=1.0):
    """The bores of a part that was drawn anywhere in space."""
    return [
        bore(f"bore {i}", turn @ [*at, 0.0] + shift, diameters[name], sense * turn[:, 2])
        for i, (name, at) in enumerate(points.items(), start=1)
    ]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_three_bores_anywhere_in_space_lie_at_their_points(seed, sense):
    turn, shift = rotation(seed), np.array([3.0, -40.0, 12.0])
    found = place(part(), moved(turn, shift, sense=sense), wanted())
    assert np.allclose(found.turn, turn.T, atol=1e-12)
    assert np.linalg.det(found.turn) == pytest.approx(1.0)
    for name, at in POINTS.items():
        assert found.middle(name) == pytest.approx([*at, 0.0], abs=1e-9)


def test_equal_bores_are_refused_with_both_ways_until_they_are_named():
    points, diameters = {"A": (0.0, 0.0), "B": (60.0, 0.0)}, {"A": 5.0, "B": 5.0}
    bores = moved(np.eye(3), np.zeros(3), points, diameters)
    with pytest.raises(CaseError, match=r"2 ways \(A = bore 1, B = bore 2; or A = bore 2, B = bore 1\)"):
        place(part(), bores, wanted(points, diameters))
    found = place(part(bores={"A": "bore 2"}), bores, wanted(points, diameters))
    assert (found.bores["A"].name, found.bores["B"].name) == ("bore 2", "bore 1")
    assert found.middle("A") == pytest.approx([0.0, 0.0, 0.0])
    over = place(part(bores={"A": "bore 2"}, flip=True), bores, wanted(points, diameters))
    assert over.turn[2] == pytest.approx(-found.turn[2])


def test_the_plane_of_forces_is_the_mean_of_the_middles_or_as_stated():
    bores = [bore("bore 1", (0.0, 0.0, 1.0), 5.0), bore("bore 2", (60.0, 0.0, 7.0), 4.0)]
    points = {"A": (0.0, 0.0), "B": (60.0, 0.0)}
    found = place(part(), bores, wanted(points))
    assert [found.middle(name)[2] for name in points] == pytest.approx([-3.0, 3.0])
    found = place(part(plane="2 mm"), bores, wanted(points))
    assert [found.middle(name)[2] for name in points] == pytest.approx([-2.0, 4.0])


def test_a_bore_without_a_joint_leaves_the_plane_of_forces_where_it_is():
    """Middles at 1 and 7.5 mm hold joints: 4.25 mm, where the mean of all three would be 3.67 mm."""
    heights = {"A": 1.0, "P": 2.5, "B": 7.5}
    places = {"A": (0.0, 0.0), "P": (22.0, 34.0), "B": (60.0, 0.0)}
    bores = [bore(f"bore {name}", (*at, heights[name]), DIAMETERS.get(name, 8.0)) for name, at in places.items()]
    loaded = {"P": places.pop("P")}
    for own, plane in ((part(), 4.25), (part(plane="2 mm"), 3.0)):
        found = with_loaded_bores(own, place(own, bores, wanted(places)), bores, loaded)
        assert found.bores["P"].name == "bore P"
        assert {name: found.middle(name)[2] + plane for name in heights} == pytest.approx(heights)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"A": 9.0}, r"no bore is within 0.3 mm .* of the pin at A, 9 mm; its bores are bore 1 \(5 mm\)"),
        ({}, "no parallel bores lie as the link's points do .* A to B 61 mm.* bore 1 to bore 2 60 mm"),
    ],
)
def test_what_fits_no_bore_is_refused(change, said):
    points = POINTS if change else POINTS | {"B": (61.0, 0.0)}
    with pytest.raises(CaseError, match=said):
        place(part(), moved(np.eye(3), np.zeros(3)), wanted(points, DIAMETERS | change))


@pytest.mark.parametrize("off", POINTS)
def test_every_bore_has_to_lie_at_its_point(off):
    """One of three off by twice place_tolerance: it is refused though the others are nearer than that."""
    points = POINTS | {off: (POINTS[off][0], POINTS[off][1] + (0.2 if off == "C" else 0.35))}
    with pytest.raises(CaseError, match="no parallel bores lie as the link's points do"):
        place(part(), moved(np.eye(3), np.zeros(3)), wanted(points))


def test_a_third_bore_that_is_not_parallel_fits_no_point():
    """It has the diameter and the place of its point, and is the one that decides nothing about direction."""
    bores = moved(np.eye(3), np.zeros(3))
    tilted = [*bores[:2], bore("bore 3", bores[2].centre, 6.0, (0.0, 0.1, np.sqrt(0.99)))]
    with pytest.raises(CaseError, match="no parallel bores lie as the link's points do"):
        place(part(), tilted, wanted())


def test_named_bores_that_are_not_parallel_are_refused_with_the_angle():
    bores = [bore("bore 1", (0, 0, 0), 5.0), bore("bore 2", (60.0, 0, 0), 4.0, (0.0, 0.6, 0.8))]
    with pytest.raises(CaseError, match=r"bores of A and B \(bore 1, bore 2\) stand at 36.9 degrees"):
        place(part(bores={"A": "bore 1", "B": "bore 2"}), bores, wanted({"A": (0, 0), "B": (60, 0)}))


@pytest.mark.parametrize("seed", range(3))
def test_points_from_the_part_place_it_again(seed):
    bores = moved(rotation(seed), np.array([1.0, 2.0, 3.0]))
    own = part(bores={"C": "bore 3", "A": "bore 1", "B": "bore 2"})
    points = points_of_part(own, bores)
    assert points["C"] == (0.0, 0.0)
    assert points["A"] == pytest.approx((np.hypot(22.0, 34.0), 0.0))
    for (one, at), (other, to) in itertools.combinations(points.items(), 2):
        assert np.hypot(*np.subtract(at, to)) == pytest.approx(np.hypot(*np.subtract(POINTS[one], POINTS[other])))
    place(own, bores, wanted(points))


def test_a_place_off_by_less_than_the_tolerance_is_the_nearest():
    off = {"A": (0.0, 0.0), "B": (60.06, 0.0), "C": (22.0, 34.0)}
    found = place(part(), moved(np.eye(3), np.zeros(3)), wanted(off))
    assert max(np.linalg.norm(found.middle(name)[:2] - at) for name, at in off.items()) < 0.05


ONE = {"A": (7.0, -2.0)}


@pytest.mark.parametrize("seed", range(3))
def test_a_single_pin_needs_a_direction_of_which_the_part_across_the_bore_counts(seed):
    turn = rotation(seed)
    z = turn[:, 2] * np.sign(turn[np.argmax(np.abs(turn[:, 2])), 2])
    bores = moved(turn, np.array([3.0, -40.0, 12.0]), ONE)
    found = place(part(along=tuple(turn[:, 0] + 0.7 * z)), bores, wanted(ONE))
    assert found.turn == pytest.approx(np.array([turn[:, 0], np.cross(z, turn[:, 0]), z]))
    assert found.middle("A") == pytest.approx([7.0, -2.0, 0.0])
    over = place(part(along=tuple(turn[:, 0]), flip=True, plane="2 mm"), bores, wanted(ONE))
    assert over.turn == pytest.approx(np.array([turn[:, 0], np.cross(-z, turn[:, 0]), -z]))
    assert over.middle("A") == pytest.approx([7.0, -2.0, -2.0])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("pin", POINTS)
def test_named_bores_without_a_joint_tell_how_a_part_on_a_single_pin_lies(seed, pin):
    """As all pins do together; the third point tells which side is up, and of two alone ``flip`` does."""
    turn, shift, names = rotation(seed), np.array([3.0, -40.0, 12.0]), {"A": "bore 1", "B": "bore 2", "C": "bore 3"}
    bores, loaded = moved(turn, shift), {name: at for name, at in POINTS.items() if name != pin}
    found = place(part(bores=names), bores, wanted({pin: POINTS[pin]}), loaded)
    assert np.allclose(found.turn, turn.T, atol=1e-12)
    assert list(found.bores) == [pin]
    other = max(loaded)
    two = {point: names[point] for point in (pin, other)}
    sides = [
        place(part(bores=two, flip=bool(f)), bores, wanted({pin: POINTS[pin]}), {other: POINTS[other]}) for f in (0, 1)
    ]
    assert sides[0].turn[2] == pytest.approx(-sides[1].turn[2])
    for side in sides:
        assert side.turn @ bores["ABC".index(other)].centre + side.shift == pytest.approx([*POINTS[other], 0.0])


def test_without_pins_the_bore_of_a_point_tells_how_a_part_lies():
    turn, shift = rotation(3), np.array([3.0, -40.0, 12.0])
    bores, names = moved(turn, shift), {"B": "bore 2", "C": "bore 3"}
    pinned = place(part(bores=names), bores, wanted({"B": POINTS["B"]}), {"C": POINTS["C"]})
    found = place(part(bores=names), bores, [], {name: POINTS[name] for name in ("B", "C")})
    assert list(found.bores) == ["B"]
    assert np.allclose(found.turn, pinned.turn, atol=1e-12)
    assert np.allclose(found.shift, pinned.shift, atol=1e-9)


@pytest.mark.parametrize(
    ("entries", "points", "said"),
    [
        ({}, ONE, r"single pin, A, which does not tell how the part lies; name the bore of a second point"),
        ({"along": (0.0, 0.01, 1.0)}, ONE, "is the direction of bore 1, but the link's x axis lies across its pins"),
        ({"along": (1.0, 0.0, 0.0)}, POINTS, "along: the pins of the link tell how the part lies; leave it out"),
        ({"along": (1.0, 0.0, 0.0)}, {}, "the link has no joint with a pin; add one"),
    ],
)
def test_a_direction_is_stated_where_it_is_needed_and_only_there(entries, points, said):
    with pytest.raises(CaseError, match=said):
        place(part(**entries), moved(np.eye(3), np.zeros(3)), wanted(points))
