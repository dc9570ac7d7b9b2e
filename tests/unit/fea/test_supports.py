import numpy as np
import pytest
import solid_meshes

from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import checked_supports, isostatic_supports, rigid_motions
from alula.geometry.base.errors import CannotRunError


@pytest.mark.parametrize("angles", [(0, 0), (30, 10), (45, 45), (90, 0), (10, 80)])
def test_six_supports_hold_a_body_however_it_lies(angles):
    space = displacement_space(solid_meshes.box(upper=(30.0, 1.0, 0.8)))
    a, b = np.radians(angles)
    about_z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    about_y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    nodes = space.nodes @ (about_z @ about_y).T
    supports = isostatic_supports(nodes, space.corners)
    assert len(set(supports.tolist())) == 6
    motions = rigid_motions(nodes, nodes.mean(axis=0)).reshape(6, -1)[:, supports]
    motions[3:] /= 15.0
    assert np.linalg.svd(motions, compute_uv=False)[-1] > 0.01


def test_missing_and_parallel_supports_are_refused():
    space = displacement_space(solid_meshes.box())
    good = isostatic_supports(space.nodes, space.corners)
    with pytest.raises(CannotRunError, match=r"rigid-body motion free"):
        checked_supports(space.nodes, good[:5])
    along_a_line = np.array([0, 1, 2, *(3 * np.flatnonzero(np.ptp(space.nodes[:, 1:], axis=1) >= 0)[1] + np.arange(3))])
    with pytest.raises(CannotRunError, match=r"rigid-body motion free"):
        checked_supports(space.nodes, along_a_line)


def test_rigid_motions_do_not_strain():
    nodes = np.random.default_rng(1).normal(size=(20, 3))
    motions = rigid_motions(nodes, np.array([1.0, 2.0, 3.0]))
    for field in motions:
        change = np.einsum("abi,abi->ab", nodes[:, None] - nodes[None], field[:, None] - field[None])
        np.testing.assert_allclose(change, 0.0, atol=1e-12)
