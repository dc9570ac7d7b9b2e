"""Plastic bodies with a known limit load, on structured meshes, for the tests of plastic collapse."""

import numpy as np
import solid_meshes
import solid_problems

from alula.fea.plastic.link_collapse import LinkCollapse
from alula.fea.plastic.load_path import LoadPath, ProportionalLoad, follow
from alula.fea.plastic.plastic_body import PlasticBody
from alula.fea.plastic.yield_law import YieldLaw

E, NU, YIELD = 2900.0, 0.38, 40.0
FOUND = LinkCollapse(
    factor=2.0,
    low=1.9,
    high=2.2,
    mesh_error=0.05,
    pressure=1.0,
    transfer=None,
    ended="limit",
    unloaded=0.0,
    strain=0.001,
    residual=0.01,
    nodes=np.zeros((6, 3)),
    boundary=np.arange(6)[None],
    zone=np.ones(6),
    shape=np.zeros((6, 3)),
    plastic_share=0.3,
    unknowns=18,
    solves=20,
)
"""One that was not computed."""


def law(**others) -> YieldLaw:
    return YieldLaw(E=E, nu=NU, strength=YIELD, **others)


def loaded(p: solid_problems.Problem, yields: YieldLaw | None = None) -> ProportionalLoad:
    """The load of a problem on its body; supports are those of the problem."""
    body = PlasticBody.of(p.space, yields or law())
    return ProportionalLoad(body, p.load, np.array(sorted(p.fixed)), threads=1)


def limit(p: solid_problems.Problem, yields: YieldLaw | None = None) -> LoadPath:
    return follow(loaded(p, yields))


def eighth_in_tension(counts=(2, 2, 2), *, amount=0.0) -> solid_problems.Problem:
    """A box between three planes of symmetry, under a pull of 1 MPa along x."""
    p = solid_problems.Problem(mesh=solid_meshes.box(upper=(2.0, 1.0, 1.0), counts=counts, amount=amount), E=E, nu=NU)
    for axis, name in enumerate("xyz"):
        p.fix(np.flatnonzero(p.space.nodes[:, axis] < 1e-9), name)
    p.traction("end:1", (1.0, 0.0, 0.0))
    return p


def bent(inner: float, outer: float, *, radial=2, around=3, along=3, length=6.0) -> solid_problems.Problem:
    """A quarter of a round tube, half as long, bent in the plane yz by ±1 MPa at its end, as at its plastic moment."""

    def warp(u, v, w):
        radius, angle = inner + (outer - inner) * u, v * np.pi / 2.0
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), length * w], axis=-1)

    even = solid_problems.even
    p = solid_problems.Problem(mesh=solid_problems.single(even(radial), even(around), even(along), warp), E=E, nu=NU)
    p.fix(p.nodes_on("v0"), "xz")  # y = 0: stress is odd in y
    p.fix(p.nodes_on("v1"), "x")
    p.fix(p.nodes_on("w0"), "z")
    p.fix(p.node_at(outer, 0.0, 0.0), "y")
    p.traction("w1", (0.0, 0.0, 1.0))
    return p
