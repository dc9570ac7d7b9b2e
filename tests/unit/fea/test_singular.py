import math

import numpy as np
import pytest

from alula.fea.refine.convergence import williams_exponent
from alula.fea.refine.singular import NEARLY, edge_distance, element_exponents, loaded_edge, sharp_peak
from alula.geometry.meshing.mesh import ReentrantEdge
from alula.reports.sentences import told

EDGE = ReentrantEdge(points=np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), angle=1.5 * math.pi)
OTHER = ReentrantEdge(points=np.array([[5.0, 0.0, -1.0], [5.0, 0.0, 1.0]]), angle=1.2 * math.pi)


def test_distance_from_a_polyline():
    points = np.array([[3.0, 4.0, 0.5], [0.0, 0.0, 3.0], [5.0, 0.0, 0.0]])
    assert edge_distance([EDGE, OTHER], points) == pytest.approx(
        np.array([[5.0, math.sqrt(20.0)], [2.0, math.sqrt(29.0)], [5.0, 0.0]])
    )


def test_exponent_of_an_element_next_to_an_edge():
    found = element_exponents(
        [EDGE, OTHER], np.array([[0.3, 0.0, 0.0], [2.5, 0.0, 0.0], [4.8, 0.0, 0.0]]), np.full(3, 0.5)
    )
    assert found == pytest.approx([williams_exponent(EDGE.angle), 2.0, williams_exponent(OTHER.angle)])


def test_edge_that_bears_most():
    nodes = np.array([[0.0, 0.0, 0.5], [5.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    assert loaded_edge([EDGE, OTHER], nodes, np.array([6.0, 8.0, 10.0]), 3.0) == (OTHER, 1)
    assert loaded_edge([EDGE, OTHER], nodes, np.array([4.0, 3.0, 10.0]), 3.0) is None
    assert loaded_edge([EDGE, OTHER], nodes, np.array([4.0, 3.0, 10.0]), 3.0, NEARLY) == (EDGE, 0)
    assert loaded_edge([], nodes, np.array([4.0, 3.0, 10.0]), 3.0) is None


def peak(values, sizes=(0.8, 0.4, 0.2)):
    nodes = np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.7, 0.0, 0.0], [4.8, 0.0, 0.0]])
    return sharp_peak(
        EDGE, [EDGE, OTHER], place=nodes[0], sizes=sizes, values=values, nodes=nodes,
        von_mises=np.array([30.0, 20.0, 12.0, 25.0]), section=3.0,
    )  # fmt: skip


def test_growth_of_williams_is_singular_and_screened_away_from_every_edge():
    theory = 1.0 - williams_exponent(EDGE.angle)
    found = peak([size**-theory for size in (0.8, 0.4, 0.2)])
    assert found is not None
    assert (found.growth, found.theory) == pytest.approx((theory, theory))
    assert found.distance == pytest.approx(0.6)
    assert found.screening == 12.0  # not 20, too near; not 25, by the other edge
    assert found.resolved
    assert "270°" in told(found.reason)


def test_coarse_elements_move_the_screening_distance_out():
    found = peak([1.0, 1.4, 2.0], sizes=(1.6, 0.8, 0.4))
    assert found is not None
    assert found.distance == pytest.approx(0.8)
    assert not found.resolved


@pytest.mark.parametrize("values", [[1.0, 1.2, 1.21], [1.0, 1.3, 1.2], [1.0, 1.4], [1.0, 1.02, 1.04]])
def test_a_peak_that_settles_is_not_singular(values):
    assert peak(values) is None
