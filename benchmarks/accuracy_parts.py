"""Three parts with reference solutions, their gmsh meshes, loads and supports, and what hand and frame say of them."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from solid_problems import Problem, Solved

from alula.fea.elements.quadrature import SurfaceQuadrature
from alula.geometry.meshing.tagged_mesh import TaggedMesh

Answer = tuple[float, float]
"""Peak von Mises stress [MPa] and displacement [mm]."""


@dataclass(frozen=True, kw_only=True)
class Part:
    """One part.

    build         draws it with gmsh's OpenCASCADE kernel
    surfaces      name -> condition on the corners (k, 3, 3) of boundary triangles
    hold_and_load puts supports and loads on a ``Problem``
    displacement  [mm] that is compared
    reference     peak von Mises stress and displacement; ``source`` of both
    by_hand, by_frame  the cheaper models' answers; None where a model has none
    size          of the elements of the coarsest mesh [mm]
    """

    name: str
    E: float
    nu: float
    build: Callable[[Any], None]
    surfaces: dict[str, Callable[[np.ndarray], np.ndarray]]
    hold_and_load: Callable[[Problem], None]
    displacement: Callable[[Solved], float]
    reference: Answer
    source: str
    by_hand: Callable[[], Answer]
    by_frame: Callable[[], Answer] | None
    size: float


def on_plane(axis: int, place: float) -> Callable[[np.ndarray], np.ndarray]:
    """Condition: all corners at ``place`` [mm] along an axis."""
    return lambda corners: (np.abs(corners[..., axis] - place) < 1e-6).all(axis=1)


def on_cylinder(radius: float) -> Callable[[np.ndarray], np.ndarray]:
    """Condition: all corners at a radius [mm] from the z axis."""
    return lambda corners: (np.abs(np.hypot(corners[..., 0], corners[..., 1]) - radius) < 1e-6).all(axis=1)


def mesh(part: Part, size: float | tuple[np.ndarray, np.ndarray], *, curved: bool, turn: int) -> TaggedMesh:
    """Mesh a part with tetrahedra of one size, or of sizes at points (n, 3), (n,) [mm]; ``turn`` elements a turn."""
    import gmsh
    from scipy.spatial import Delaunay
    from skfem import MeshTet1

    gmsh.initialize(interruptible=False)
    try:
        for option, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.MeshSizeExtendFromBoundary": 0,
            "Mesh.MeshSizeFromPoints": 0,
            "Mesh.MeshSizeFromCurvature": turn,
        }.items():
            gmsh.option.setNumber(option, value)
        part.build(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        if isinstance(size, tuple):
            points, sizes = size
            cells = Delaunay(points).simplices
            view = gmsh.view.add("sizes")
            data = np.concatenate([points[cells].transpose(0, 2, 1).reshape(-1, 12), sizes[cells]], axis=1)
            gmsh.view.addListData(view, "SS", len(cells), data.ravel())
            field = gmsh.model.mesh.field.add("PostView")
            gmsh.model.mesh.field.setNumber(field, "ViewTag", view)
            gmsh.model.mesh.field.setAsBackgroundMesh(field)
        else:
            gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.model.mesh.generate(3)
        if curved:
            gmsh.model.mesh.setOrder(2)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        _, nodes = gmsh.model.mesh.getElementsByType(11 if curved else 4)
    finally:
        gmsh.finalize()
    number = np.full(int(tags.max()) + 1, -1)
    number[tags] = np.arange(len(tags))
    cells = number[nodes.reshape(-1, 10 if curved else 4)]
    if curved:
        cells = cells[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]  # gmsh has edge 23 before 13
    points = coordinates.reshape(-1, 3)
    used, corner = np.unique(cells[:, :4], return_inverse=True)
    topology = MeshTet1(np.ascontiguousarray(points[used].T), np.ascontiguousarray(corner.reshape(-1, 4).T))
    triangles = used[topology.facets[:, topology.boundary_facets()].T]
    found = {name: triangles[condition(points[triangles])] for name, condition in part.surfaces.items()}
    return TaggedMesh(
        points=points,
        cells=cells,
        surfaces=found,
        areas=dict.fromkeys(found, 0.0),
        volume=0.0,
        centroid=np.zeros(3),
    )


def tube() -> Part:
    """Cantilever tube of the owl wing's link, 5 over 2.5 mm, 88 mm long, 1 N at its tip; a half by symmetry."""
    from alula.fea.frame.linear import solve_frame
    from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
    from alula.geometry.parts.part import Section

    E, nu, length, outer, inner, force = 2900.0, 0.38, 88.0, 2.5, 1.25, 1.0
    area, second = math.pi * (outer**2 - inner**2), math.pi * (outer**4 - inner**4) / 4.0

    def build(occ: Any) -> None:
        whole = occ.cut(
            [(3, occ.addCylinder(0, 0, 0, length, 0, 0, outer))], [(3, occ.addCylinder(0, 0, 0, length, 0, 0, inner))]
        )[0]
        occ.intersect(whole, [(3, occ.addBox(-1, 0, -2 * outer, length + 2, 2 * outer, 4 * outer))])

    def shear(q: SurfaceQuadrature, total: float) -> np.ndarray:
        """Traction along z that vanishes inside and outside, as the true shear stress does at free surfaces."""
        r2 = q.x[..., 1] ** 2 + q.x[..., 2] ** 2
        shape = (outer**2 - r2) * (r2 - inner**2)
        return np.stack([0.0 * shape, 0.0 * shape, total * shape / (q.w * shape).sum()], axis=-1)

    def hold_and_load(p: Problem) -> None:
        p.fix(p.nodes_on("root"), "x")
        p.fix(p.nodes_on("symmetry"), "y")
        p.fix(p.nodes_on("root")[0], "z")  # reacts with nothing: the root carries its shear as a traction
        for name, total in (("root", -force / 2.0), ("tip", force / 2.0)):
            p.traction(name, lambda q, total=total: shear(q, total))

    def by_hand() -> Answer:
        return force * length * outer / second, force * length**3 / (3.0 * E * second)

    def by_frame() -> Answer:
        section = Section(
            area=area,
            i_y=second,
            i_z=second,
            torsion=2.0 * second,
            half_y=outer,
            half_z=outer,
            round=True,
            radius_ratio=inner / outer,
        )
        solution = solve_frame(
            FrameModel(
                nodes=np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]]),
                elements=(FrameElement(nodes=(0, 1), section=section, young=E, poisson=nu),),
                supports=(Support(node=0),),
                loads=(NodeLoad(node=1, wrench=np.array([0.0, 0.0, force, 0.0, 0.0, 0.0])),),
            )
        )
        return section_peak(section, solution.internal_forces(0).at(0.0)), float(solution.displacements[1, 2])

    return Part(
        name="cantilever tube",
        E=E,
        nu=nu,
        build=build,
        surfaces={"root": on_plane(0, 0.0), "tip": on_plane(0, length), "symmetry": on_plane(1, 0.0)},
        hold_and_load=hold_and_load,
        displacement=lambda s: float(s.mean("tip")[2] - s.mean("root")[2]),
        reference=(7.855, 2.732449),
        source="stress: graded, curved, structured meshes, 7.916, 7.869 and 7.860 MPa at 26,061, 68,175 and 131,769 "
        "unknowns, extrapolated; displacement: Cowper 1966, Timoshenko's cantilever",
        by_hand=by_hand,
        by_frame=by_frame,
        size=2.5,
    )


def section_peak(section: Any, forces: np.ndarray) -> float:
    """Largest von Mises stress that a beam's section forces make."""
    from alula.fea.beam.section_stress import section_stress

    return float(section_stress(section, forces).equivalent)


def cylinder() -> Part:
    """Lamé's thick cylinder, 10 and 20 mm in radius, 60 MPa inside, ends held; a quarter by symmetry."""
    E, nu, a, b, height, pressure = 200_000.0, 0.3, 10.0, 20.0, 5.0, 60.0
    base = pressure * a * a / (b * b - a * a)
    radial, hoop = -pressure, base * (1.0 + b * b / a**2)
    axial = nu * (radial + hoop)
    peak = math.sqrt(((radial - hoop) ** 2 + (hoop - axial) ** 2 + (axial - radial) ** 2) / 2.0)
    moved = (1.0 + nu) * base * a / E * (1.0 - 2.0 * nu + b * b / a**2)

    def build(occ: Any) -> None:
        outer = occ.addCylinder(0, 0, 0, 0, 0, height, b, angle=math.pi / 2.0)
        occ.cut([(3, outer)], [(3, occ.addCylinder(0, 0, 0, 0, 0, height, a))])

    def hold_and_load(p: Problem) -> None:
        p.fix(p.nodes_on("x=0"), "x")
        p.fix(p.nodes_on("y=0"), "y")
        p.fix(p.nodes_on("bottom", "top"), "z")
        p.traction("bore", lambda q: -pressure * q.normals)

    def displacement(s: Solved) -> float:
        bore = s.problem.nodes_on("bore")
        out = s.problem.space.nodes[bore, :2]
        return float(((s.u[bore, :2] * out).sum(axis=1) / np.hypot(*out.T)).mean())

    def by_hand() -> Answer:
        middle, wall = (a + b) / 2.0, b - a
        stress = pressure * middle / wall
        return stress, stress * middle / E

    return Part(
        name="thick cylinder",
        E=E,
        nu=nu,
        build=build,
        surfaces={
            "bore": on_cylinder(a),
            "x=0": on_plane(0, 0.0),
            "y=0": on_plane(1, 0.0),
            "bottom": on_plane(2, 0.0),
            "top": on_plane(2, height),
        },
        hold_and_load=hold_and_load,
        displacement=displacement,
        reference=(peak, moved),
        source="Lamé: Timoshenko-Goodier, 3rd ed., art. 28, plane strain",
        by_hand=by_hand,
        by_frame=None,
        size=5.0,
    )


def strip() -> Part:
    """Howland's strip, 20 mm wide, hole of 6 mm, 10 MPa tension, plane strain; a quarter by symmetry."""
    from alula.fea.frame.linear import solve_frame
    from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
    from alula.geometry.parts.part import Section

    E, nu, half, hole, length, thickness, tension = 2900.0, 0.38, 10.0, 3.0, 60.0, 4.0, 10.0
    share = math.sqrt(1.0 - nu + nu * nu)  # von Mises over the stress along the strip, in plane strain
    net = tension / (1.0 - hole / half)
    stiff = E / (1.0 - nu * nu)

    def build(occ: Any) -> None:
        occ.cut(
            [(3, occ.addBox(0, 0, 0, length, half, thickness))], [(3, occ.addCylinder(0, 0, 0, 0, 0, thickness, hole))]
        )

    def hold_and_load(p: Problem) -> None:
        p.fix(p.nodes_on("x=0"), "x")
        p.fix(p.nodes_on("y=0"), "y")
        p.fix(p.nodes_on("bottom", "top"), "z")
        p.traction("end", (tension, 0.0, 0.0))

    def by_hand() -> Answer:
        heywood = 2.0 + (1.0 - hole / half) ** 3
        return heywood * net * share, tension * length / stiff

    def by_frame() -> Answer:
        section = Section(
            area=2.0 * half * thickness,
            i_y=2.0 * half * thickness**3 / 12.0,
            i_z=thickness * (2.0 * half) ** 3 / 12.0,
            torsion=1.0,  # not twisted
            half_y=half,
            half_z=thickness / 2.0,
            round=False,
        )
        solution = solve_frame(
            FrameModel(
                nodes=np.array([[0.0, 0.0, 0.0], [length, 0.0, 0.0]]),
                elements=(FrameElement(nodes=(0, 1), section=section, young=stiff, poisson=nu),),
                supports=(Support(node=0),),
                loads=(NodeLoad(node=1, wrench=np.array([tension * section.area, 0.0, 0.0, 0.0, 0.0, 0.0])),),
            )
        )
        peak = section_peak(section, solution.internal_forces(0).at(0.0))
        return peak * share, float(solution.displacements[1, 0])

    return Part(
        name="strip with a hole",
        E=E,
        nu=nu,
        build=build,
        surfaces={
            "x=0": on_plane(0, 0.0),
            "y=0": on_plane(1, 0.0),
            "bottom": on_plane(2, 0.0),
            "top": on_plane(2, thickness),
            "end": on_plane(0, length),
        },
        hold_and_load=hold_and_load,
        displacement=lambda s: float(s.mean("end")[0]),
        reference=(2.362 * net * share, 0.183993),
        source="stress: Howland 1930, 2.362 times the net stress; displacement: curved, structured meshes, 0.1839924, "
        "0.1839928 and 0.1839928 mm at 13,401, 36,369 and 70,569 unknowns",
        by_hand=by_hand,
        by_frame=by_frame,
        size=5.0,
    )


PARTS = (tube, cylinder, strip)
