"""Two classics on structured meshes: the thick-walled cylinder under pressure, and the strip with a hole in tension."""

import numpy as np
from solid_problems import Problem, block, even, graded, joined, single

CYLINDER = A, B, PRESSURE, E, NU = 100.0, 200.0, 60.0, 200_000.0, 0.3
WIDTH, LENGTH, THICKNESS = 2.0, 6.0, 0.1  # strip of half-width 1, half-length 3 widths


def cylinder_problem(radial, around, layers, *, held, ratio=2.0):
    def warp(u, v, w):
        radius, angle = A + (B - A) * u, v * np.pi / 2.0
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), 20.0 * w], axis=-1)

    p = Problem(mesh=single(graded(radial, ratio), even(around), even(layers), warp), E=E, nu=NU)
    p.fix(p.nodes_on("v0"), "y")
    p.fix(p.nodes_on("v1"), "x")
    p.fix(p.nodes_on("w0", "w1") if held else p.nodes_on("w0"), "z")
    p.traction("u0", lambda q: -PRESSURE * q.normals)
    return p


def strip_problem(ratio, around, radial, along, E=2900.0, nu=0.38):
    """Quarter: a square around the hole (u radial, v around from the x axis) and the rest of the strip."""
    hole = ratio * WIDTH / 2.0

    def square(u, v, w):
        angle = v * np.pi / 2.0
        # The outer edge runs up the side x = 1, then back along y = 1.
        x, y = np.minimum(1.0, 2.0 - 2.0 * v), np.minimum(1.0, 2.0 * v)
        edge = [(1.0 - u) * hole * np.cos(angle) + u * x, (1.0 - u) * hole * np.sin(angle) + u * y]
        return np.stack([*edge, THICKNESS * w], axis=-1)

    def rest(u, v, w):
        return np.stack([u, v, THICKNESS * w], axis=-1)

    v = even(2 * around)
    mesh = joined(
        [
            block(graded(radial, 2.0 / hole), v, even(1), square),
            block(graded(along, 4.0, 1.0, LENGTH), even(around), even(1), rest),
        ],
        [{"u0": "hole", "v0": "y=0", "v1": "x=0", "w0": "faces", "w1": "faces"},
         {"u1": "end", "v0": "y=0", "w0": "faces", "w1": "faces"}],
    )  # fmt: skip
    p = Problem(mesh=mesh, E=E, nu=nu)
    p.fix(p.nodes_on("x=0"), "x")
    p.fix(p.nodes_on("y=0"), "y")
    p.fix(p.nodes_on("faces"), "z")
    p.traction("end", (1.0, 0.0, 0.0))
    return p
