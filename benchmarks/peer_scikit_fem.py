"""The same bar with scikit-fem's own forms and scipy's spsolve. Usage: peer_scikit_fem.py MESH.npz SOLVER THREADS."""

import json
import sys

import numpy as np
from skfem import Basis, ElementTetP2, ElementVector, FacetBasis, MeshTet, condense, solve
from skfem.assembly import BilinearForm, LinearForm
from skfem.helpers import ddot, eye, sym_grad, trace

E, NU = 2900.0, 0.38
LAME, SHEAR = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))


def stress(strain: np.ndarray) -> np.ndarray:
    return LAME * eye(trace(strain), 3) + 2 * SHEAR * strain


@BilinearForm
def stiffness(u, v, w):
    return ddot(stress(sym_grad(u)), sym_grad(v))


@LinearForm
def pull(v, w):
    return -v.value[2] / w.area


def main() -> None:
    with np.load(sys.argv[1]) as file:
        mesh = MeshTet(file["points"].T.copy(), file["cells"].T.copy())
        area = float(file["area"])
    basis = Basis(mesh, ElementVector(ElementTetP2()), intorder=2)
    far = mesh.p[0].max()
    end = FacetBasis(mesh, basis.elem, facets=mesh.facets_satisfying(lambda x: x[0] == far), intorder=2)
    K = stiffness.assemble(basis)
    f = pull.assemble(end, area=area)
    u = solve(*condense(K, f, D=basis.get_dofs(lambda x: x[0] == 0.0).all()))
    field = basis.interpolate(u)
    s = stress(sym_grad(field))
    mean = trace(s) / 3
    deviator = s - eye(mean, 3)
    tip = basis.doflocs[0] == far
    json.dump(
        {
            "unknowns": int(basis.N),
            "solver": "scipy spsolve",
            "tip_mm": float(u[tip].min()),
            "von_mises_mpa": float(np.sqrt(1.5 * ddot(deviator, deviator)).max()),
        },
        sys.stdout,
    )


if __name__ == "__main__":
    main()
