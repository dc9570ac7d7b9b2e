"""Which mesh comes next, and when one mesh is enough."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fea.refine.convergence import grid_convergence
from fea.refine.refinement import _Link, _ratio
from fea.refine.target_sizes import MOST_RATIO, SERIES_RATIO
from geometry.meshing.mesh import ReentrantEdge

EDGE = ReentrantEdge(points=np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]), angle=1.5 * math.pi)


def test_sizes_fall_so_that_two_further_meshes_reach_the_accuracy():
    found = grid_convergence((1.0, 0.6, 0.4), [10.0 + 6.0 * size**2 for size in (1.0, 0.6, 0.4)], estimate=0.9)
    wanted = found.index / 3.0**2
    assert _ratio(found, wanted) == pytest.approx(math.sqrt(3.0), rel=1e-6)
    assert _ratio(found, 1e-6) == MOST_RATIO
    assert _ratio(found, 1.0) == SERIES_RATIO
    assert _ratio(grid_convergence([1.0], [10.0], estimate=5.0), 0.01) == SERIES_RATIO


@pytest.mark.parametrize(("share", "enough"), [(0.2, True), (0.3, False)])
def test_one_mesh_is_not_enough_near_a_sharp_edge_that_may_bear_much(share, enough):
    nodes = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    level = SimpleNamespace(nodes=nodes, figures=[SimpleNamespace(von_mises=np.array([share, 1.0]))])
    link = SimpleNamespace(
        precision=[], edges=[EDGE], levels=[level], task=SimpleNamespace(section=3.0), _limits=lambda: ()
    )
    assert _Link._far(link) is enough
