"""A clamped bar with alula: mesh file to displacements and stresses. Usage: peer_alula.py MESH.npz SOLVER THREADS."""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from alula.fea.common.threads import bounded
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.quadrature import surface_quadrature
from alula.fea.elements.space import DisplacementSpace, displacement_space
from alula.fea.solid.stress import stress_field, von_mises
from alula.fea.solvers.solve import factorise
from alula.fea.solvers.two_level import linear_level
from alula.geometry.meshing.tagged_mesh import TaggedMesh

E, NU = 2900.0, 0.38


def problem(path: str) -> tuple[DisplacementSpace, np.ndarray, np.ndarray]:
    """Space, fixed unknowns (at the start) and load vector (1 N down, spread over the far end)."""
    with np.load(path) as file:
        mesh = TaggedMesh(
            points=file["points"],
            cells=file["cells"],
            surfaces={"start": file["start"], "end": file["end"]},
            areas={"start": float(file["area"]), "end": float(file["area"])},
            volume=0.0,
            centroid=np.zeros(3),
        )
    space = displacement_space(mesh)
    nodes = np.unique(space.faces("start"))
    fixed = (3 * nodes[:, None] + np.arange(3)).ravel()
    end = surface_quadrature(space, "end")
    traction = np.zeros((*end.w.shape, 3))
    traction[..., 2] = -1.0 / end.measure
    return space, fixed, end.load_vector(traction, len(space.nodes))


def main() -> None:
    path, solver, threads = sys.argv[1], sys.argv[2], int(sys.argv[3])
    with bounded(threads):
        space, fixed, load = problem(path)
        K = assemble_stiffness(space, E=E, nu=NU)
        K.fix(fixed)
        load[fixed] = 0.0
        level = linear_level(space, E=E, nu=NU, fixed=fixed)
        factor = factorise(K, level=level, method=None if solver == "auto" else solver, threads=threads)
        u = factor.solve(load).reshape(-1, 3)
        stress = stress_field(space, u, E=E, nu=NU)
    json.dump(
        {
            "unknowns": space.unknowns,
            "solver": factor.name,
            "tip_mm": float(u[np.unique(space.faces("end")), 2].min()),
            "von_mises_mpa": float(von_mises(stress.at_points).max()),
        },
        sys.stdout,
    )


if __name__ == "__main__":
    main()
