"""How the bores of a part lie to each other, and the points of the link that it may be."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.geometry.imported.arrangement import angle_between, coaxial, link_frame, parallel_groups, viewing_frame
from alula.geometry.imported.facts import Bore
from alula.geometry.imported.read import part_facts

FILES = Path(__file__).parents[2] / "data" / "step"


def bore(name: str, x: float, y: float, z: float = 0.0, **more: object) -> Bore:
    plain = Bore(name=name, axis=(0.0, 0.0, 1.0), centre=(x, y, z), diameter=5.0, length=4.0, through=True,
                 spans=((-2.0, 2.0),), slot=0.0, slot_axis=(0.0, 0.0, 0.0))  # fmt: skip
    return replace(plain, **more)


def test_the_points_of_a_bell_crank_are_those_of_its_triangle():
    """Arms of 40 and 30 mm at a right angle: 50 mm between their ends; the hub divides these into 18 and 32 mm, 24 mm
    beside them, by the altitude theorem."""
    frame = link_frame(part_facts(FILES / "bell_crank.step").bores)
    assert {point: found.name for point, found in frame.bores.items()} == {"A": "bore 2", "B": "bore 3", "C": "bore 1"}
    assert frame.points == {"A": (0.0, 0.0), "B": (50.0, 0.0), "C": (18.0, -24.0)}
    assert np.allclose(frame.axes @ frame.axes.T, np.eye(3))
    assert np.linalg.det(frame.axes) == pytest.approx(1.0)
    assert frame.place(np.array([0.0, 0.0, 6.0])) == pytest.approx([18.0, -24.0, 3.5])


def test_of_a_rotated_part_its_own_distances_are_the_points():
    """Holes at -40, -25 and 20 mm along it; none is what is blind or the wider part of a stepped hole.

    The slot at -8 mm, 30 degrees from the others' line, is 10 mm long, and x runs along it.
    """
    frame = link_frame(part_facts(FILES / "slotted.step").bores)
    assert [found.diameter for found in frame.bores.values()] == pytest.approx([6.0, 5.0, 5.0, 4.0])
    away = {name: np.hypot(*at) for name, at in frame.points.items()}
    assert away == pytest.approx({"A": 0.0, "B": 60.0, "C": 15.0, "D": 32.0}, abs=1e-6)
    assert np.abs(np.arctan2(*frame.points["D"][::-1])) == pytest.approx(np.radians(30.0))
    assert frame.slots == {"D": pytest.approx((32.0 * np.sqrt(0.75) - 5.0, 32.0 * np.sqrt(0.75) + 5.0))}


def test_of_bores_on_one_axis_that_with_the_longest_wall_is_the_point():
    fork = bore("fork", 30.0, 0.0, length=20.0, spans=((-10.0, -8.0), (8.0, 10.0)))
    middle = bore("middle", 30.0, 0.0, diameter=4.0, length=5.0, spans=((-2.5, 2.5),))
    assert coaxial(fork, middle)
    assert not coaxial(fork, bore("beside", 30.01, 0.0))
    assert link_frame([bore("one", 0.0, 0.0), fork, middle]).bores["B"] is middle


def test_blind_bores_are_points_where_no_two_go_through():
    blind = [bore("one", 0.0, 0.0, through=False), bore("two", 20.0, 0.0, through=False)]
    far = np.hypot(20.0, 9.0)
    frame = link_frame([*blind, bore("three", 0.0, 9.0)])
    assert {point: found.name for point, found in frame.bores.items()} == {"A": "two", "B": "three", "C": "one"}
    assert frame.points["B"] == pytest.approx((far, 0.0))
    assert frame.points["C"] == pytest.approx((20.0 * 20.0 / far, 20.0 * 9.0 / far))
    assert set(link_frame([*blind, bore("three", 0.0, 9.0), bore("four", 7.0, 9.0)]).points) == {"A", "B"}


def test_the_group_with_the_most_axes_comes_first_and_others_are_told_by_their_angle():
    across = bore("across", 5.0, 5.0, axis=(0.6, 0.0, 0.8))
    bores = [across, bore("one", 0.0, 0.0), bore("two", 20.0, 0.0)]
    assert [[found.name for found in group] for group in parallel_groups(bores)] == [["one", "two"], ["across"]]
    assert angle_between(bores[1], across) == pytest.approx(np.arcsin(0.6))
    assert angle_between(bores[1], bore("turned", 0.0, 0.0, axis=(0.0, 0.0, -1.0))) == 0.0


def test_a_part_that_is_no_link_is_looked_at_along_a_bore():
    facts = part_facts(FILES / "sleeve.step")
    assert link_frame(facts.bores) is None
    frame = viewing_frame(facts)
    assert frame.points == {}
    assert np.allclose(frame.axes @ frame.axes.T, np.eye(3))
    assert frame.axes[2] == pytest.approx(facts.bores[0].axis)
