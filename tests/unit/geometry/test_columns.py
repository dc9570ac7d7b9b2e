"""Material along lines through triangles, on a block of 4 by 4 by 10 with a slot of 2 by 4 by 2 mm in its middle."""

import math

import numpy as np
import pytest

from alula.geometry.imported.columns import Columns
from alula.geometry.imported.facts import PartSurface
from alula.geometry.imported.walls import Line


def box(low: tuple[float, float, float], high: tuple[float, float, float], *, hollow: bool = False) -> np.ndarray:
    """Return the triangles (12, 3, 3) of a box, counter-clockwise from outside, or from inside."""
    found = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        for side in (low, high):
            corners = np.empty((4, 3))
            corners[:, k] = side[k]
            corners[:, i] = [low[i], high[i], high[i], low[i]]
            corners[:, j] = [low[j], low[j], high[j], high[j]]
            ring = corners if (side is high) != hollow else corners[::-1]
            found += [ring[[0, 1, 2]], ring[[0, 2, 3]]]
    return np.array(found)


@pytest.fixture
def columns() -> Columns:
    """The block stands on z = 5, the axis' own point at z = 0."""
    corners = np.concatenate([box((-2, -2, 5), (2, 2, 15)), box((-1, -2, 9), (1, 2, 11), hollow=True)])
    surface = PartSurface(
        points=corners.reshape(-1, 3), triangles=np.arange(72).reshape(-1, 3), faces=np.zeros(24, int)
    )
    line = Line(point=np.array([0.1, 0.2, 0.0]), axis=np.array([0.0, 0.0, 1.0]))
    return Columns(surface, line, 3.0)


def test_material_is_where_the_block_is(columns: Columns) -> None:
    places = np.array([4.9, 5.1, 8.9, 9.1, 10.9, 11.1, 14.9, 15.1])
    at = columns.offset(np.array([0.03, 0.07, 0.0]))
    assert columns.material(at, places).tolist() == [False, True, True, False, False, True, True, False]
    beside = columns.offset(np.array([1.5, 0.07, 0.0]))
    assert columns.material(beside, places).tolist() == [False] + [True] * 6 + [False]
    outside = columns.offset(np.array([2.5, 0.07, 0.0]))
    assert not columns.material(outside, places).any()


def test_the_first_material_that_one_sees(columns: Columns) -> None:
    at = columns.offset(np.array([0.03, 0.07, 0.0]))
    assert columns.first_material(at, 10.0, 1.0) == pytest.approx(1.0)
    assert columns.first_material(at, 10.0, -1.0) == pytest.approx(1.0)
    assert columns.first_material(at, 0.0, 1.0) == pytest.approx(5.0)
    assert columns.first_material(at, 0.0, -1.0) == math.inf
    assert columns.first_material(at, 7.0, 1.0) == 0.0


def test_a_ring_stands_at_its_radius(columns: Columns) -> None:
    assert [float(np.linalg.norm(at)) for at in columns.ring(1.7)] == pytest.approx([1.7] * 8)
