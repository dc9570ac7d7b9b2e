"""The whole from its upper half: nodes, elements, surfaces and measures against those of a whole made at once."""

import dataclasses

import numpy as np
import pytest
import solid_meshes as meshes

from alula.fea.elements.quadrature import surface_quadrature, volume_quadrature
from alula.fea.elements.space import displacement_space
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.element_geometry import jacobian_coefficients, scaled_jacobians
from alula.geometry.meshing.mirror import mirrored

Z = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("curved", [True, False])
def test_a_whole_of_two_halves_measures_what_a_whole_made_at_once_does(curved):
    whole, reference = mirrored(meshes.half_bar(curved=curved)), meshes.bar(height=3.0, layers=4, curved=curved)
    space, plain = displacement_space(whole), displacement_space(reference)
    assert set(whole.surfaces) == set(reference.surfaces)
    for name in reference.surfaces:
        ours, theirs = surface_quadrature(space, name), surface_quadrature(plain, name)
        assert ours.measure == pytest.approx(theirs.measure, rel=1e-12)
        assert ours.centroid == pytest.approx(theirs.centroid, abs=1e-12)
        assert (ours.w[..., None] * ours.normals).sum(axis=(0, 1)) == pytest.approx(
            (theirs.w[..., None] * theirs.normals).sum(axis=(0, 1)), abs=1e-12
        )
    assert volume_quadrature(space).measure == pytest.approx(volume_quadrature(plain).measure, rel=1e-12)
    # No inner boundary is left at the cut.
    assert len(space.boundary) == len(plain.boundary)


@pytest.mark.parametrize("curved", [True, False])
def test_every_point_and_element_has_its_image(curved):
    half = meshes.half_bar(curved=curved)
    whole = mirrored(half)
    assert whole.mirror is not None
    on_plane = half.points[:, 2] == 0.0
    assert len(whole.points) == 2 * len(half.points) - np.count_nonzero(on_plane)
    assert np.array_equal(whole.points[whole.mirror], whole.points * (1.0, 1.0, -1.0))
    assert np.array_equal(whole.mirror[whole.points[:, 2] == 0.0], np.flatnonzero(whole.points[:, 2] == 0.0))
    assert np.array_equal(whole.cells[: len(half.cells)], half.cells)
    for measure in (scaled_jacobians, jacobian_coefficients):  # both signed
        upper, lower = np.split(np.sort(measure(whole.points, whole.cells).reshape(len(whole.cells), -1)), 2)
        assert lower == pytest.approx(upper, rel=1e-12)
    assert (whole.volume, whole.areas["top:A"], whole.areas["bottom:B"], whole.areas["bore:A"]) == (6.0, 2.0, 2.0, 4.0)
    assert np.array_equal(whole.centroid, [10.0, 0.0, 0.0])


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("curved", [True, False])
def test_a_displacement_space_knows_the_images_of_its_nodes(order, curved):
    space = displacement_space(mirrored(meshes.half_bar(curved=curved)), order=order)
    assert space.mirror is not None
    assert np.array_equal(space.nodes[space.mirror], space.nodes * (1.0, 1.0, -1.0))
    assert np.array_equal(np.sort(space.mirror), np.arange(len(space.nodes)))
    assert displacement_space(meshes.bar(height=3.0, curved=curved), order=order).mirror is None


def test_rounding_at_the_plane_is_taken_off_and_no_node_stands_there_twice():
    whole = mirrored(meshes.half_bar(wobble=1e-11))
    assert np.count_nonzero(np.abs(whole.points[:, 2]) < 1e-6) == np.count_nonzero(whole.points[:, 2] == 0.0)
    assert len(np.unique(np.round(whole.points, 8), axis=0)) == len(whole.points)


def test_a_half_that_is_not_cut_at_the_plane_is_refused():
    half = meshes.half_bar()
    with pytest.raises(CannotRunError, match=r"reaches down to z = -0\.1 mm"):
        mirrored(dataclasses.replace(half, points=half.points - 0.1 * Z))
    with pytest.raises(CannotRunError, match="no face on the plane"):
        mirrored(dataclasses.replace(half, points=half.points + 0.1 * Z))
    points = half.points.copy()
    corner = np.zeros(len(points), dtype=bool)
    corner[half.cells[:, :4]] = True
    points[np.flatnonzero(~corner & (points[:, 2] == 0.0))[0], 2] = 0.01
    with pytest.raises(CannotRunError, match="bulges out of it"):
        mirrored(dataclasses.replace(half, points=points))


def test_a_mesh_that_claims_a_symmetry_it_lacks_is_refused():
    whole = mirrored(meshes.half_bar())
    assert whole.mirror is not None
    for wrong in (
        {"points": whole.points + 1e-9 * Z},
        {"mirror": np.arange(len(whole.points))},
        {"mirror": whole.mirror[:-1]},
        {"cells": whole.cells[:-2]},
        {"cells": whole.cells[::-1]},
    ):
        with pytest.raises(CannotRunError, match="not the image of its upper half"):
            dataclasses.replace(whole, **wrong)
