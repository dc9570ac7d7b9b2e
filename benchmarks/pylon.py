"""Makes the STEP file of the built-in case ``pylon``, loads/cases/pylon.step, with the geometry kernel of gmsh.

    python -m benchmarks.pylon

A tube with a cap, and on it a pyramid that stands on its tip, as four screws of a socket's adapter take hold of it. All
dimensions are assumed [mm]; the form is that of EP 0 694 295 (a pyramid of four faces that stands on its tip). The ball
about its tip, on which the adapter tilts, is left out. It prints volume and mass.
"""

from collections.abc import Callable
from pathlib import Path

import gmsh

OUTER, INNER, LENGTH = 30.0, 25.0, 180.0
"""Of the tube; the length is that from its open end to the cap."""
CAP, CAP_ROUND = 10.0, 3.0
"""Thickness of the cap, and the radius in which it meets the inside of the tube."""
TIP, TOP, HEIGHT = 15.0, 20.0, 11.0
"""Widths of the pyramid at its tip and at its top: faces at 12.8 deg to its axis."""
FILLET, CORNER = 2.0, 2.0
"""Between pyramid and cap, and of the pyramid's four edges."""
CROSS, CROSS_AT = 5.0, 15.0
"""A hole across the tube, as for the screw of a cover; it tells how the part lies."""
DENSITY = 2.7e-3
"""Of aluminium [g/mm³]."""
FILE = Path(__file__).resolve().parent.parent / "loads" / "cases" / "pylon.step"


def _frustum(level: float) -> int:
    """A pyramid about x that grows from its tip at ``level`` upwards."""
    occ = gmsh.model.occ
    (tip, top) = (
        [occ.addPoint(x, y * half, z * half) for y, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for x, half in ((level, TIP / 2.0), (level + HEIGHT, TOP / 2.0))
    )
    around = [(k, (k + 1) % 4) for k in range(4)]
    low, high, up = (
        [occ.addLine(one, other) for one, other in pairs]
        for pairs in (
            [(tip[a], tip[b]) for a, b in around],
            [(top[a], top[b]) for a, b in around],
            zip(tip, top, strict=True),
        )
    )
    loops = [low, high, *([low[a], up[b], high[a], up[a]] for a, b in around)]
    return occ.addVolume([occ.addSurfaceLoop([occ.addPlaneSurface([occ.addCurveLoop(loop)]) for loop in loops])])


def _edges(solid: int, chosen: Callable[[tuple[float, ...]], bool]) -> list[int]:
    """Edges of a solid by the box about each."""
    gmsh.model.occ.synchronize()
    found = gmsh.model.getBoundary([(3, solid)], combined=False, oriented=False, recursive=False)
    edges = {edge for face in found for _, edge in gmsh.model.getBoundary([face], oriented=False)}
    return [edge for edge in sorted(edges) if chosen(gmsh.model.getBoundingBox(1, edge))]


def pylon() -> int:
    """Return the solid: x along the tube, from its open end, and the pyramid above the cap."""
    occ, top = gmsh.model.occ, LENGTH + CAP
    body = occ.addCylinder(0.0, 0.0, 0.0, top, 0.0, 0.0, OUTER / 2.0)
    inside = occ.addCylinder(0.0, 0.0, 0.0, LENGTH, 0.0, 0.0, INNER / 2.0)
    rim = _edges(inside, lambda box: box[0] > LENGTH - 1e-3)
    [(_, inside)] = occ.fillet([inside], rim, [CAP_ROUND])
    pyramid = _frustum(top - 1.0)
    slanted = _edges(pyramid, lambda box: box[3] - box[0] > HEIGHT / 2.0)
    [(_, pyramid)] = occ.fillet([pyramid], slanted, [CORNER])
    [(_, body)], _ = occ.fuse([(3, body)], [(3, pyramid)])
    foot = _edges(body, lambda box: abs(box[0] - top) < 1e-3 and abs(box[3] - top) < 1e-3 and box[4] < TOP / 2.0)
    [(_, body)] = occ.fillet([body], foot, [FILLET])
    hole = occ.addCylinder(CROSS_AT, 0.0, -OUTER, 0.0, 0.0, 2.0 * OUTER, CROSS / 2.0)
    [(_, body)], _ = occ.cut([(3, body)], [(3, inside), (3, hole)])
    occ.synchronize()
    return body


if __name__ == "__main__":
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    made = pylon()
    gmsh.write(str(FILE))
    volume = gmsh.model.occ.getMass(3, made)
    print(f"{volume:.2f} mm3, {DENSITY * volume:.2f} g, {len(gmsh.model.getEntities(3))} solid")
    gmsh.finalize()
