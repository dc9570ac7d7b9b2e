"""Volumes, areas and validity of simplices from their nodes."""

import numpy as np
import pytest
from mesh_measures import shape_quality, volumes_and_moments

from alula.geometry.meshing.element_geometry import (
    TETRA_EDGES,
    TRIANGLE_EDGES,
    flatten,
    scaled_jacobians,
    triangle_areas,
)

CORNERS = np.array([[0.0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 4]])


def quadratic(corners: np.ndarray) -> np.ndarray:
    return np.vstack([corners, corners[TETRA_EDGES].mean(axis=1)])


@pytest.mark.parametrize("points", [CORNERS, quadratic(CORNERS)])
def test_straight_tetrahedron(points: np.ndarray) -> None:
    cells = np.arange(len(points))[None]
    volumes, moments = volumes_and_moments(points, cells)
    assert volumes == pytest.approx([4.0])
    assert moments[0] == pytest.approx(4.0 * CORNERS.mean(axis=0))
    assert scaled_jacobians(points, cells) == pytest.approx([1.0])


def test_curved_tetrahedron_under_a_quadratic_map() -> None:
    # x -> x + a y² has Jacobian 1: the volume stays, the centroid moves by a times the mean of y².
    def bend(p: np.ndarray) -> np.ndarray:
        return p + 0.2 * np.stack([p[:, 1] ** 2, 0 * p[:, 0], 0 * p[:, 0]], axis=1)

    points = bend(quadratic(CORNERS))
    volumes, moments = volumes_and_moments(points, np.arange(10)[None])
    mean_square = 3.0**2 / 10.0  # of y over a tetrahedron with one corner at y = 3 and the others at 0
    assert volumes == pytest.approx([4.0])
    assert moments[0] / 4.0 == pytest.approx(CORNERS.mean(axis=0) + np.array([0.2 * mean_square, 0, 0]))
    assert scaled_jacobians(points, np.arange(10)[None]) == pytest.approx([1.0])


def test_inverted_tetrahedra_are_seen() -> None:
    swapped = CORNERS[[1, 0, 2, 3]]
    assert volumes_and_moments(swapped, np.arange(4)[None])[0][0] == pytest.approx(-4.0)
    assert scaled_jacobians(swapped, np.arange(4)[None])[0] < 0.0
    folded = quadratic(CORNERS)
    folded[4] = [-0.5, 0, 0]  # the middle of edge 01 pushed out past corner 0
    assert volumes_and_moments(folded, np.arange(10)[None])[0][0] > 0.0
    assert scaled_jacobians(folded, np.arange(10)[None])[0] < 0.0


def test_flattening_mends_a_folded_element_and_its_neighbour() -> None:
    # Two tetrahedra share edge 01 and face 012.
    points = np.vstack([quadratic(CORNERS), np.zeros((4, 3))])
    apex = np.array([0.0, 0.0, -4.0])
    points[10] = apex
    points[11:14] = (points[[0, 1, 2]] + apex) / 2.0
    cells = np.array([[0, 1, 2, 3, 4, 5, 6, 7, 8, 9], [1, 0, 2, 10, 4, 6, 5, 12, 11, 13]])
    assert (volumes_and_moments(points, cells)[0] > 0.0).all()
    points[4] = [-0.5, 0, 0]
    before = points.copy()
    mended, count = flatten(points, cells, 0.1)
    assert count == 2
    assert (scaled_jacobians(mended, cells) >= 0.1).all()
    assert (points == before).all()
    assert np.flatnonzero((mended != points).any(axis=1)).tolist() == [4]


def test_areas_of_triangles() -> None:
    corners = np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0]])
    assert triangle_areas(corners, np.arange(3)[None]) == pytest.approx([6.0])
    flat = np.vstack([corners, corners[TRIANGLE_EDGES].mean(axis=1)])
    assert triangle_areas(flat, np.arange(6)[None]) == pytest.approx([6.0])
    # A mid-node moved out by d makes its edge of length 3 a parabola: Archimedes' segment adds 2/3 of 3 d.
    flat[3] += [0.0, -0.3, 0.0]
    assert triangle_areas(flat, np.arange(6)[None]) == pytest.approx([6.0 + 2.0 * 0.3])
    # A rolled-up triangle keeps its area as the roll's angle goes to zero with the fourth power.
    for angle, error in ((0.4, 2e-4), (0.2, 1.3e-5)):
        plane = np.vstack([np.array([[0, 0], [1, 0], [0, 1.0]]), [[0.5, 0], [0.5, 0.5], [0, 0.5]]])
        rolled = (
            np.stack([np.sin(angle * plane[:, 0]), np.cos(angle * plane[:, 0]), angle * plane[:, 1]], axis=1) / angle
        )
        assert triangle_areas(rolled, np.arange(6)[None])[0] == pytest.approx(0.5, rel=error)


def test_shape_quality() -> None:
    regular = np.array([[1.0, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]])
    quality = shape_quality(regular, np.array([[0, 1, 2, 3], [1, 0, 2, 3]]))
    assert sorted(np.abs(quality)) == pytest.approx([1.0, 1.0])
    assert sorted(np.sign(quality)) == [-1.0, 1.0]
