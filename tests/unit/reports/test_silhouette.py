"""What is drawn of a solid that is seen along its pins."""

import numpy as np
import pytest

from alula.fea.elements.space import displacement_space
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.parts.part import Body, Disc, Pin
from alula.reports.figures.sheet.silhouette import curves, outlines, silhouette


def test_a_disc_shows_its_face_and_the_circles_that_bound_it():
    """The face of a disc of 20 mm with holes of 4 mm: its area, and the lengths of three circles."""
    part = Disc.model_construct(shape="disc", material="x", diameter=20.0, thickness=3.0, eye_diameter=5.0)
    pins = Pin(name="A", x=0.0, y=0.0, diameter=4.0), Pin(name="B", x=6.0, y=0.0, diameter=4.0)
    space = displacement_space(mesh_body(Body(part=part, pins=pins, ends=(), holes=()), COARSE))
    triangles, edges = silhouette(space.nodes, space.boundary)
    x, y = np.moveaxis(outlines(space.nodes[triangles][..., :2]), -1, 0)
    area = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum()
    assert area == pytest.approx(np.pi / 4.0 * (20.0**2 - 2.0 * 4.0**2), rel=2e-3)
    lines = curves(space.nodes[edges])
    length = np.linalg.norm(np.diff(lines, axis=1), axis=2).sum()
    assert length == pytest.approx(np.pi * (20.0 + 2.0 * 4.0), rel=2e-3)
    off = [np.hypot(lines[..., 0] - pin.x, lines[..., 1] - pin.y) - 2.0 for pin in pins]
    off += [np.hypot(lines[..., 0], lines[..., 1]) - 10.0]
    assert np.abs(off).min(axis=0).max() < 0.01  # every point of every line is on one of the three circles


def test_flat_triangles_stay_as_they_are():
    places = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    assert np.array_equal(outlines(places), places)
    assert np.array_equal(curves(places[:, :2]), places[:, :2])
