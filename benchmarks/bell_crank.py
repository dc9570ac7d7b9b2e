"""Makes the STEP file of the built-in case ``step``, loads/cases/bell-crank.step, with CadQuery.

    python benchmarks/bell_crank.py

alula does not need CadQuery; run this in an environment that has it. All dimensions are our own (assumed) [mm].
"""

import math
from pathlib import Path

import cadquery as cq

UP, ALONG = 30.0, 40.0
"""Arms, from the axle to the bores at their ends."""
THICKNESS, HUB, EYE = 5.0, 16.0, 11.0
"""Of the plate; outer diameters about the axle and at the ends."""
AXLE, PIN = 5.0, 4.0
"""Diameters of the bores."""
CORNER = 6.0
"""Radius of the fillet between both arms."""
FILE = Path(__file__).resolve().parent.parent / "loads" / "cases" / "bell-crank.step"


def arm(length: float) -> cq.Workplane:
    """Return an arm along x: hub, eye and the straight sides that touch both."""
    level = cq.Workplane("XY", origin=(0.0, 0.0, -THICKNESS / 2.0))
    turn = math.acos((HUB - EYE) / 2.0 / length)
    touching = [
        (start + radius * math.cos(turn), side * radius * math.sin(turn))
        for side, ends in ((1.0, (0, 1)), (-1.0, (1, 0)))
        for start, radius in ([(0.0, HUB / 2.0), (length, EYE / 2.0)][end] for end in ends)
    ]
    body = level.polyline(touching).close().extrude(THICKNESS)
    for x, diameter in ((0.0, HUB), (length, EYE)):
        body = body.union(level.center(x, 0.0).circle(diameter / 2.0).extrude(THICKNESS))
    return body


def bell_crank() -> cq.Workplane:
    """Return the solid: two arms at a right angle, with a bore at each end and one for the axle."""
    body = arm(ALONG).union(arm(UP).rotate((0, 0, 0), (0, 0, 1), 90.0))
    corner = cq.selectors.BoxSelector((4.0, 4.0, -9.0), (9.0, 9.0, 9.0), boundingbox=False)
    body = body.edges("|Z").edges(corner).fillet(CORNER)
    level = cq.Workplane("XY", origin=(0.0, 0.0, -THICKNESS))
    for x, y, diameter in ((0.0, 0.0, AXLE), (ALONG, 0.0, PIN), (0.0, UP, PIN)):
        body = body.cut(level.center(x, y).circle(diameter / 2.0).extrude(2.0 * THICKNESS))
    return body


if __name__ == "__main__":
    solid = bell_crank()
    cq.exporters.export(solid, str(FILE))
    volume = solid.val().Volume()
    print(f"{FILE.name}: {len(solid.solids().vals())} solid, {volume:.2f} mm³")
