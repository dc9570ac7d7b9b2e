"""Makes the STEP file of the owl wing's anchor, loads/cases/owl-wing-anchor.step, with CadQuery.

    python benchmarks/owl_wing_anchor.py

alula does not need CadQuery; run this in an environment that has it. All dimensions are assumed [mm]: the source states
the material and the mass of the coupling alone. It prints volume and mass.
"""

import math
from pathlib import Path

import cadquery as cq

SPAN, THICKNESS, WIDTH = 125.0, 4.0, 2.5
EYE, BORE = 6.5, 1.5
BALL, PLACE, NECK = 7.0, (12.0, 62.5), 4.0
FILLET, AT_BALL = 2.0, 0.8
DENSITY = 1.24e-3
"""Of PLA [g/mm³]."""
FILE = Path(__file__).resolve().parent.parent / "loads" / "cases" / "owl-wing-anchor.step"


def anchor() -> cq.Workplane:
    """Return a bar with an eye at A (0, 0) and at G (0, 125), and a ball stud on a neck half-way between them."""
    level = cq.Workplane("XY", origin=(0.0, 0.0, -THICKNESS / 2.0))
    body = level.center(0.0, SPAN / 2.0).rect(WIDTH, SPAN).extrude(THICKNESS)
    body = body.union(level.center(PLACE[0] / 2.0, PLACE[1]).rect(PLACE[0], NECK).extrude(THICKNESS))
    for y in (0.0, SPAN):
        body = body.union(level.center(0.0, y).circle(EYE / 2.0).extrude(THICKNESS))
    foot = math.sqrt((EYE / 2.0) ** 2 - (WIDTH / 2.0) ** 2)
    inner = [
        cq.selectors.BoxSelector((x - 0.2, y - 0.2, -9.0), (x + 0.2, y + 0.2, 9.0), boundingbox=False)
        for x, y in (
            *((WIDTH / 2.0, PLACE[1] + side * NECK / 2.0) for side in (-1.0, 1.0)),
            *((side * WIDTH / 2.0, y) for side in (-1.0, 1.0) for y in (foot, SPAN - foot)),
        )
    ]
    for where in inner:
        body = body.edges("|Z").edges(where).fillet(FILLET)
    body = body.union(cq.Workplane("XY", origin=(*PLACE, 0.0)).sphere(BALL / 2.0))
    body = body.edges(cq.selectors.BoxSelector((8.0, 59.0, -4.0), (11.5, 66.0, 4.0))).fillet(AT_BALL)
    for y in (0.0, SPAN):
        body = body.cut(level.center(0.0, y).circle(BORE / 2.0).extrude(THICKNESS))
    return body


if __name__ == "__main__":
    made = anchor()
    cq.exporters.export(made, str(FILE))
    volume = made.val().Volume()
    print(f"{volume:.2f} mm3, {DENSITY * volume:.3f} g, valid: {made.val().isValid()}, {made.solids().size()} solid")
