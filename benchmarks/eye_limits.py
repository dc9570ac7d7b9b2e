"""What a perfectly plastic eye bears, by limit analysis, beside the formulas of ``fea/outcomes/eye_modes.py``.

    python -m benchmarks.eye_limits [seed]

30 eyes are drawn: outer over inner radius, and the angle of the force to the pull straight off the shank. The pin fits
and does not rub; the shank is as wide as the eye and held one outer radius behind the pin, so that it does not bend.
Each stress field that is in equilibrium and nowhere beyond von Mises' condition in plane stress bears no more than the
eye does (lower bound theorem of limit analysis). The best of those that are linear in each triangle, with jumps along
edges where equilibrium allows them (after Sloan, 1988), is found by a cone programme, which needs ``pip install
clarabel``. Finer meshes give more; the results are in ``benchmarks/results/eyes.json``.
"""

import json
import math
import sys
from pathlib import Path

import clarabel
import gmsh
import numpy as np
import scipy.sparse as sp

from alula.fea.outcomes.eye_modes import ACROSS, EyeMode, RoundEye, asme_bth_1

KEPT = Path(__file__).with_name("results") / "eyes.json"
COUNT = 30
RATIOS = (1.3, 4.0)
"""Outer over inner radius."""
ELEMENT = 0.11
"""Largest edge over the outer radius."""


def mesh(radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Return corners (n, 2) and triangles (m, 3) of an eye about a hole of radius 1 with its shank towards -x."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    shape = gmsh.model.occ
    disc, shank = shape.addDisk(0, 0, 0, radius, radius), shape.addRectangle(-radius, -radius, 0, radius, 2 * radius)
    whole, _ = shape.fuse([(2, disc)], [(2, shank)])
    shape.cut(whole, [(2, shape.addDisk(0, 0, 0, 1, 1))])
    shape.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", ELEMENT * radius)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 36)
    gmsh.model.mesh.generate(2)
    tags, places, _ = gmsh.model.mesh.getNodes()
    number = {tag: row for row, tag in enumerate(tags)}
    nodes = np.array([number[tag] for tag in gmsh.model.mesh.getElements(2)[2][0]])
    gmsh.finalize()
    used, triangles = np.unique(nodes, return_inverse=True)
    return places.reshape(-1, 3)[used, :2], triangles.reshape(-1, 3)


def traction(normal: np.ndarray, along: np.ndarray, element: int, corner: int) -> list[tuple[int, float]]:
    """Return the traction on a face along a direction as (unknown, factor); unknowns are σx, σy, τ of every corner."""
    first = 9 * element + 3 * corner
    shear = normal[0] * along[1] + normal[1] * along[0]
    return [(first, normal[0] * along[0]), (first + 1, normal[1] * along[1]), (first + 2, shear)]


def matrix(rows: list[list[tuple[int, float]]], columns: int) -> sp.csc_matrix:
    """Return the rows as a sparse matrix."""
    entries = [(row, column, value) for row, one in enumerate(rows) for column, value in one]
    row, column, value = zip(*entries, strict=True)
    return sp.csc_matrix((value, (row, column)), shape=(len(rows), columns))


def limit_load(radius: float, angle: float) -> float:
    """Return a force that an eye bears over (hole diameter · thickness · yield strength), pulled at an angle [rad]."""
    places, triangles = mesh(radius)
    count, even, pressed = 9 * len(triangles), list[list[tuple[int, float]]](), list[list[tuple[int, float]]]()
    faces: dict[tuple[int, int], list[int]] = {}
    for element, corners in enumerate(triangles):
        slopes = np.linalg.inv(np.column_stack([np.ones(3), places[corners]]))[1:]
        for first, second in ((0, 2), (2, 1)):  # ∂σx/∂x + ∂τ/∂y = 0, ∂τ/∂x + ∂σy/∂y = 0
            even.append(
                [(9 * element + 3 * k + first, slopes[0, k]) for k in range(3)]
                + [(9 * element + 3 * k + second, slopes[1, k]) for k in range(3)]
            )
        for i, j in ((0, 1), (1, 2), (2, 0)):
            faces.setdefault(tuple(sorted((int(corners[i]), int(corners[j])))), []).append(element)  # type: ignore[arg-type]
    force = np.zeros((2, count))
    for ends, elements in faces.items():
        edge = places[ends[1]] - places[ends[0]]
        length, middle = np.hypot(*edge), places[list(ends)].mean(axis=0)
        normal = np.array([edge[1], -edge[0]]) / length
        at_hole = np.hypot(*middle) < 1.0001
        if at_hole and normal @ middle > 0.0:
            normal = -normal
        tangent = np.array([-normal[1], normal[0]])
        for end in ends:
            corner = [int(np.flatnonzero(triangles[element] == end)[0]) for element in elements]
            if len(elements) == 2:
                for along in np.eye(2):
                    one, other = (traction(normal, along, *of) for of in zip(elements, corner, strict=True))
                    even.append(one + [(unknown, -factor) for unknown, factor in other])
            elif at_hole:
                even.append(traction(normal, tangent, elements[0], corner[0]))
                pressed.append(traction(normal, normal, elements[0], corner[0]))
                for axis, along in enumerate(np.eye(2)):
                    for unknown, factor in traction(normal, along, elements[0], corner[0]):
                        force[axis, unknown] += factor * length / 2.0
            elif middle[0] > -radius + 1e-6:
                even += [traction(normal, along, elements[0], corner[0]) for along in np.eye(2)]
    towards = np.array([math.cos(angle), math.sin(angle)])
    across = np.array([-towards[1], towards[0]]) @ force
    at, half, root = np.arange(count // 3), 0.5, math.sqrt(3.0)
    cone = sp.csc_matrix(  # ((σx + σy)/2, √3 (σx - σy)/2, √3 τ) is no longer than the yield strength, 1
        (
            np.repeat([-half, -half, -half * root, half * root, -root], len(at)),
            (
                np.concatenate([4 * at + 1, 4 * at + 1, 4 * at + 2, 4 * at + 2, 4 * at + 3]),
                np.concatenate([3 * at, 3 * at + 1, 3 * at, 3 * at + 1, 3 * at + 2]),
            ),
        ),
        shape=(4 * len(at), count),
    )
    bound = np.zeros(4 * len(at))
    bound[::4] = 1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    solution = clarabel.DefaultSolver(
        sp.csc_matrix((count, count)),
        -(towards @ force),
        sp.vstack([matrix(even, count), sp.csc_matrix(across), matrix(pressed, count), cone]).tocsc(),
        np.concatenate([np.zeros(len(even) + 1 + len(pressed)), bound]),
        [
            clarabel.ZeroConeT(len(even) + 1),
            clarabel.NonnegativeConeT(len(pressed)),
            *(clarabel.SecondOrderConeT(4) for _ in at),
        ],
        settings,
    ).solve()
    return -float(solution.obj_val) / 2.0


def main(seed: int = 1) -> None:
    """Compare drawn eyes with the formulas, for a material that does not harden (F_u = F_y)."""
    drawn, found = np.random.default_rng(seed), []
    for _ in range(COUNT):
        ratio, degrees = float(drawn.uniform(*RATIOS)), float(drawn.uniform(0.0, 90.0))
        eye = RoundEye(radius=ratio, hole=2.0, pin=2.0, thickness=1.0, wall=1e6)
        modes = {mode: force / 2.0 for mode, force in asme_bth_1(eye, 1.0, 1.0).items()}
        mode = min(modes, key=lambda one: modes[one])
        straight, oblique = limit_load(ratio, 0.0), limit_load(ratio, math.radians(degrees))
        row = {
            "ratio": ratio,
            "angle": degrees,
            "mode": str(mode),
            "formula": modes[mode],
            "straight": straight,
            "oblique": oblique,
            "straight_over_formula": straight / modes[mode],
            "lost_over_sine": (1.0 - oblique / straight) / math.sin(math.radians(degrees)),
        }
        found.append(row)
        print({key: round(x, 3) if isinstance(x, float) else x for key, x in row.items()}, flush=True)
    KEPT.write_text(json.dumps({"seed": seed, "element": ELEMENT, "eyes": found}, indent=1) + "\n", encoding="utf-8")
    for mode in (EyeMode.NET_SECTION, EyeMode.FRACTURE, EyeMode.SHEAR_OUT, EyeMode.BEARING):
        own = [row["straight_over_formula"] for row in found if row["mode"] == mode]
        if own:
            print(f"{mode}: {len(own)} eyes, {min(own):.2f} to {max(own):.2f}, mean {np.mean(own):.2f}")
    most = max(row["lost_over_sine"] for row in found)
    print(f"a force across takes off {most:.2f} times the sine at most; the check takes {ACROSS}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
