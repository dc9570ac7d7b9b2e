"""The same bar with NGSolve. Usage: peer_ngsolve.py MESH.npz direct|bddc THREADS. Needs numpy and ngsolve alone.

Its fastest settings of those tried at 160,000 unknowns. BDDC takes edges out of its coarse (wirebasket) space: with
them it factorises nearly the whole matrix, four times as slow. One triangle of the symmetric matrix is stored: three
quarters of the time. The direct solver is its own sparse Cholesky: MKL PARDISO through NGSolve took longer and twice
the memory.
"""

import json
import sys

import numpy as np
from netgen.meshing import FaceDescriptor
from netgen.meshing import Mesh as NetgenMesh
from ngsolve import (
    TET,
    VOL,
    BilinearForm,
    CGSolver,
    CoefficientFunction,
    Grad,
    GridFunction,
    Id,
    InnerProduct,
    IntegrationRule,
    LinearForm,
    Mesh,
    Preconditioner,
    SetNumThreads,
    Sym,
    TaskManager,
    Trace,
    VectorH1,
    ds,
    dx,
    sqrt,
)

E, NU = 2900.0, 0.38
LAME, SHEAR = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))


def read(path: str) -> tuple[Mesh, float]:
    with np.load(path) as file:
        points, cells = file["points"], file["cells"]
        start, end, area = file["start"], file["end"], float(file["area"])
    mesh = NetgenMesh(dim=3)
    mesh.AddPoints(points)
    mesh.Add(FaceDescriptor(surfnr=1, domin=1, bc=1))
    mesh.Add(FaceDescriptor(surfnr=2, domin=1, bc=2))
    mesh.AddElements(dim=3, index=1, data=cells.astype(np.int32), base=0)
    mesh.AddElements(dim=2, index=1, data=start.astype(np.int32), base=0)
    mesh.AddElements(dim=2, index=2, data=end.astype(np.int32), base=0)
    mesh.SetBCName(0, "start")
    mesh.SetBCName(1, "end")
    return Mesh(mesh), area


def main() -> None:
    solver, threads = sys.argv[2], int(sys.argv[3])
    SetNumThreads(threads)
    with TaskManager():
        mesh, area = read(sys.argv[1])
        space = VectorH1(mesh, order=2, dirichlet="start", wb_withedges=False)
        u, v = space.TnT()

        def stress(strain):
            return LAME * Trace(strain) * Id(3) + 2 * SHEAR * strain

        form = BilinearForm(space, symmetric=True, symmetric_storage=True)
        form += InnerProduct(stress(Sym(Grad(u))), Sym(Grad(v))) * dx
        load = LinearForm(space)
        load += CoefficientFunction((0, 0, -1.0 / area)) * v * ds("end")
        field = GridFunction(space)
        if solver == "bddc":
            pre = Preconditioner(form, "bddc")
            form.Assemble()
            load.Assemble()
            field.vec.data = CGSolver(form.mat, pre.mat, tol=1e-8, maxiter=500) * load.vec
        else:
            form.Assemble()
            load.Assemble()
            field.vec.data = form.mat.Inverse(space.FreeDofs(), inverse="sparsecholesky") * load.vec
        s = stress(Sym(Grad(field)))
        deviator = s - Trace(s) / 3 * Id(3)
        misses = sqrt(1.5 * InnerProduct(deviator, deviator))
        rule = IntegrationRule(TET, 2)
        values = misses(mesh.MapToAllElements({TET: rule}, VOL))
        tip = field.components[2](mesh(*np.max(points_of(mesh), axis=0) * (1, 0.5, 0.5)))
    json.dump(
        {
            "unknowns": int(space.ndof),
            "solver": f"NGSolve {solver}",
            "tip_mm": float(tip),
            "von_mises_mpa": float(np.max(values)),
        },
        sys.stdout,
    )


def points_of(mesh: Mesh) -> np.ndarray:
    return np.array([p.p for p in mesh.ngmesh.Points()])


if __name__ == "__main__":
    main()
