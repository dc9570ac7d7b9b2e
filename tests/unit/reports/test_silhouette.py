"""What is drawn of a solid that is seen along its pins."""

import numpy as np
import pytest

from fea.elements.space import displacement_space
from geometry.meshing.mesh import COARSE, mesh_body
from geometry.parts.part import Body, Disc, Pin
from reports.figures.silhouette import silhouette


def test_a_disc_shows_its_face_and_the_circles_that_bound_it():
    """The face of a disc of 20 mm with holes of 4 mm: its area, and the lengths of three circles."""
    part = Disc.model_construct(shape="disc", material="x", diameter=20.0, thickness=3.0, eye_diameter=5.0)
    pins = Pin(name="A", x=0.0, y=0.0, diameter=4.0), Pin(name="B", x=6.0, y=0.0, diameter=4.0)
    space = displacement_space(mesh_body(Body(part=part, pins=pins, ends=(), holes=()), COARSE))
    triangles, edges = silhouette(space.nodes, space.boundary[:, :3])
    a, b, c = np.moveaxis(space.nodes[triangles][:, :, :2], 1, 0)
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum()
    assert area == pytest.approx(np.pi / 4.0 * (20.0**2 - 2.0 * 4.0**2), rel=0.05)
    length = np.linalg.norm(np.diff(space.nodes[edges], axis=1), axis=2).sum()
    assert length == pytest.approx(np.pi * (20.0 + 2.0 * 4.0), rel=0.05)
