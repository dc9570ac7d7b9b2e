"""Peaks of flat links by an independent code: plane elements of fourth order, with loads and stresses of their own.

A flat link in its plane without lateral contraction (ν = 0) is in plane stress exactly, so solids and plane elements
have the same limit. Shared with alula are the outline from the geometry kernel and the sizes about holes and fillets;
elements, order, pressure of the pins, solver and evaluation of the stress (on the edge, without averages) are others.
"""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import PinLoad
from alula.geometry.meshing.mesh_settings import MeshSettings
from alula.geometry.meshing.mesher import size_formulas
from alula.geometry.solids.solid_model import build, initialised
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw
from benchmarks.coverage_parts import YOUNG, Drawn

PLACED = 1e-9
"""Tolerance of scikit-fem's places on curved sides: its 1e-12 is below the rounding of small elements."""
SIZES = MeshSettings(size=0.5, bore_elements=28, hole_elements=28, turn_elements=16, fillet_size=0.4, growth=0.5)


def plane_truths(link: Drawn) -> list[list[float]]:
    """Return value and error of the deciding stress for the wide and the narrow pressure: of two meshes the finer's."""
    fine, coarse = (_peaks(link, sizes) for sizes in (SIZES, SIZES.scaled(1.5)))
    return [
        [float(f"{value:.6g}"), float(f"{abs(value - other):.3g}")] for value, other in zip(fine, coarse, strict=True)
    ]


def _peaks(link: Drawn, sizes: MeshSettings) -> list[float]:
    """Return the largest deciding stress for the wide and the narrow pressure on one mesh."""
    from skfem import Basis, ElementTriP4, ElementVector, FacetBasis, asm, condense, solve
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    mesh = _mesh(link, sizes)
    basis = Basis(mesh, ElementVector(ElementTriP4()), intorder=8)
    shear = lame_parameters(YOUNG, 0.0)[1]
    K = asm(linear_elasticity(0.0, shear), basis)
    thickness = link.body.part.eye_thickness
    edge = FacetBasis(mesh, basis.elem, mapping=_mapping(mesh), intorder=16)
    corner = basis.nodal_dofs
    far = int(np.argmax(np.hypot(*(mesh.p[:, : corner.shape[1]] - mesh.p[:, :1]))))
    fixed = np.array([corner[0, 0], corner[1, 0], corner[1, far] if far else corner[0, far]])
    found = []
    for law in (WIDE, NARROW):
        load = sum(_push(link, pin, law, basis, mesh) for pin in link.loads.pins) / thickness
        x = solve(*condense(K, load, D=fixed))
        found.append(max(_peak(b, x, link.brittle) for b in (basis, edge)))
    return found


def _mesh(link: Drawn, sizes: MeshSettings) -> Any:
    """The upper face as triangles whose sides follow its edges."""
    from skfem import MeshTri1, MeshTri2

    gmsh = initialised()
    try:
        gmsh.model.add("body")
        solid = build(gmsh, link.body)
        top = solid.body.part.eye_thickness / 2.0
        faces = [tag for _, tag in gmsh.model.getEntities(2) if _flat(gmsh, tag, top)]
        fields = []
        for text in size_formulas(solid.body, sizes):
            fields.append(gmsh.model.mesh.field.add("MathEval"))
            gmsh.model.mesh.field.setString(fields[-1], "F", text)
        least = gmsh.model.mesh.field.add("Min")
        gmsh.model.mesh.field.setNumbers(least, "FieldsList", fields)
        gmsh.model.mesh.field.setAsBackgroundMesh(least)
        for name in ("ExtendFromBoundary", "FromPoints"):
            gmsh.option.setNumber(f"Mesh.MeshSize{name}", 0)
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", sizes.turn_elements)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        tags, flat, _ = gmsh.model.mesh.getNodes()
        place = dict(zip(tags.tolist(), flat.reshape(-1, 3)[:, :2] * solid.unit, strict=True))
        cells = np.concatenate([gmsh.model.mesh.getElementsByType(9, tag)[1].reshape(-1, 6) for tag in faces])
    finally:
        gmsh.finalize()
    corners, numbers = np.unique(cells[:, :3], return_inverse=True)
    points = np.array([place[tag] for tag in corners])
    curved = MeshTri2.from_mesh(MeshTri1(points.T.copy(), np.ascontiguousarray(numbers.reshape(-1, 3).T)))
    nodes = curved.doflocs.copy()
    middle = {
        tuple(sorted((row[a], row[b]))): row[m]
        for row in cells.tolist()
        for a, b, m in ((0, 1, 3), (1, 2, 4), (0, 2, 5))
    }
    for facet, ends in enumerate(curved.facets.T):
        nodes[:, curved.dofs.facet_dofs[0, facet]] = place[middle[tuple(sorted(corners[ends].tolist()))]]
    return MeshTri2(nodes, curved.t)


def _mapping(mesh: Any) -> Any:
    mapping = mesh.mapping()
    mapping.invF = partial(mapping.invF, newton_tol=PLACED)
    return mapping


def _flat(gmsh: Any, tag: int, top: float) -> bool:
    box = gmsh.model.getBoundingBox(2, tag)
    return bool(min(box[2], box[5]) > top - 1e-4)


def _push(link: Drawn, pin: PinLoad, law: PressureLaw, basis: Any, mesh: Any) -> NDArray[np.float64]:
    """Load vector of a pin's pressure p0 cos(kθ) on a hole, or p0 cos(πs/w) on a slot's flank; p0 in closed form."""
    from skfem import FacetBasis, LinearForm

    centre, force, radius = pin.centre[:2], pin.wrench[:2], pin.diameter / 2.0
    size = float(np.hypot(*force))
    if size == 0.0:
        return np.zeros(basis.N)
    hole = next(hole for hole in link.body.pins if hole.name == pin.name)
    edge = mesh.boundary_facets()
    ends = mesh.p[:, mesh.facets[:, edge]]
    facets = edge[(np.abs(hole.distance(*ends) - hole.diameter / 2.0) < 1e-6 * radius).all(axis=0)]
    # ∫ cos(kθ) cos θ dθ: π/2 over ±π/2 for k = 1; sin(3a)/3 + sin(a) over ±a = ±π/4 for k = 2.
    integral = np.pi / 2.0 if law.wave == 1 else np.sin(0.75 * np.pi) / 3.0 + np.sin(0.25 * np.pi)
    towards, width = np.arctan2(force[1], force[0]), law.patch(pin.diameter)

    @LinearForm
    def work(v: Any, w: Any) -> Any:
        x, y = w.x[0] - centre[0], w.x[1] - centre[1]
        if pin.slotted:  # pressure per projected length, on the flank that the force points to
            p = np.where(np.abs(x) < width / 2.0, np.cos(np.pi * x / width), 0.0) * force[1] * np.pi / (2.0 * width)
            return p * np.maximum(-np.sign(force[1]) * w.n[1], 0.0) * v[1]
        angle = np.mod(np.arctan2(y, x) - towards + np.pi, 2.0 * np.pi) - np.pi
        p = np.where(np.abs(angle) < np.pi / (2.0 * law.wave), np.cos(law.wave * angle), 0.0)
        return size / (radius * integral) * p * (x * v[0] + y * v[1]) / np.hypot(x, y)

    return np.asarray(work.assemble(FacetBasis(mesh, basis.elem, mapping=_mapping(mesh), facets=facets, intorder=16)))


def _peak(basis: Any, x: NDArray[np.float64], brittle: bool) -> float:
    """Largest stress at the integration points; σ = E ε where ν = 0."""
    gradient = basis.interpolate(x).grad
    xx, yy, xy = YOUNG * gradient[0][0], YOUNG * gradient[1][1], YOUNG * (gradient[0][1] + gradient[1][0]) / 2.0
    if brittle:
        return float(((xx + yy) / 2.0 + np.sqrt((xx - yy) ** 2 / 4.0 + xy**2)).max())
    return float(np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2).max())
