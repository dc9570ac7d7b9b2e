"""Make the STEP files of this folder with CadQuery, and print the volume and centroid that CadQuery says of each.

Not run by the tests. CadQuery is no dependency of alula; in an environment that has it: ``python make_parts.py``.
The sizes are those that ``tests/unit/geometry/test_imported.py`` states.
"""

import math
from pathlib import Path

import cadquery as cq
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

HERE = Path(__file__).resolve().parent
STAND = cq.Location(cq.Vector(30.0, -20.0, 55.0), cq.Vector(1.0, 2.0, 3.0), 50.0)
"""Where a part is put: 50 degrees about (1, 2, 3), then shifted."""


def hole(x: float, y: float, diameter: float, low: float, high: float) -> cq.Workplane:
    """Return an upright cylinder, to be cut out."""
    return cq.Workplane("XY", origin=(x, y, low)).circle(diameter / 2.0).extrude(high - low)


def plate() -> cq.Shape:
    """Plate of 60 by 20 by 5 mm with holes of 5 and 6 mm, 40 mm apart, and a boss of 10 mm; rotated and shifted."""
    body = cq.Workplane("XY").box(60.0, 20.0, 5.0)
    body = body.union(hole(0.0, 0.0, 10.0, 2.5, 6.5))
    body = body.cut(hole(-20.0, 0.0, 5.0, -9.0, 9.0)).cut(hole(20.0, 0.0, 6.0, -9.0, 9.0))
    return body.val()  # put into its place by the assembly that ``main`` writes


def bell_crank() -> cq.Shape:
    """Crank of 5 mm with arms of 40 and 30 mm at a right angle; its hub of 10 mm reaches from z = 0 to 12."""
    body = hole(0.0, 0.0, 10.0, 0.0, 12.0)
    for x, y, turn in ((40.0, 0.0, 0.0), (0.0, 30.0, 90.0)):
        length = math.hypot(x, y)
        arm = cq.Workplane("XY").center(length / 2.0, 0.0).rect(length, 9.0).extrude(5.0)
        body = body.union(arm.rotate((0, 0, 0), (0, 0, 1), turn)).union(hole(x, y, 9.0, 0.0, 5.0))
    body = body.edges("|Z").edges(cq.selectors.BoxSelector((4, 4, -1), (5, 5, 13))).fillet(2.0)
    for x, y, diameter in ((0.0, 0.0, 6.0), (40.0, 0.0, 4.0), (0.0, 30.0, 5.0)):
        body = body.cut(hole(x, y, diameter, -1.0, 20.0))
    return body.val()


def fork() -> cq.Shape:
    """Bar of 50 by 12 by 16 mm: a gap of 8 mm makes a fork at x = 40, bore 5 mm; at x = 0 a bore of 6 mm."""
    body = cq.Workplane("XY").center(20.0, 0.0).rect(56.0, 12.0).extrude(16.0)
    body = body.cut(cq.Workplane("XY", origin=(0, 0, 4)).center(42.0, 0.0).rect(24.0, 14.0).extrude(8.0))
    body = body.cut(hole(40.0, 0.0, 5.0, -1.0, 20.0)).cut(hole(0.0, 0.0, 6.0, -1.0, 20.0))
    return body.val().moved(cq.Location(cq.Vector(5.0, 6.0, 7.0), cq.Vector(1.0, 0.0, 0.0), 90.0))


def slotted() -> cq.Shape:
    """Strip of 100 by 20 by 6 mm with every trap along it, at x = -40 to 40.

    A chamfered hole of 6 mm at -40, a countersunk one of 5 mm at -25, a slot of 4 mm (10 mm between its ends' centres,
    30 degrees from x) at -8, a blind one of 5 mm with a drill's tip at 8, a counterbored one of 5 mm at 20 (10 mm, 2
    deep), a window with rounded corners of 1.5 mm at 31, and two blind holes of 4 mm from both sides at 42.
    """
    body = cq.Workplane("XY").box(100.0, 20.0, 6.0)
    body = body.faces(">Z").workplane().center(-40.0, 0.0).hole(6.0)
    body = body.edges("%CIRCLE").edges("<X").chamfer(0.5)
    body = body.cut(hole(-25.0, 0.0, 5.0, -9.0, 9.0))
    body = body.cut(cq.Workplane("XY").add(cq.Solid.makeCone(0.0, 5.0, 5.0, cq.Vector(-25.0, 0.0, -2.0))))
    slot = cq.Workplane("XY", origin=(-8, 0, -9)).slot2D(14.0, 4.0).extrude(18.0)
    body = body.cut(slot.rotate((-8, 0, 0), (-8, 0, 1), 30.0))
    body = body.cut(hole(8.0, 0.0, 5.0, -1.0, 9.0))
    tip = 2.5 / math.tan(math.radians(59.0))
    body = body.cut(cq.Workplane("XY").add(cq.Solid.makeCone(0.0, 2.5, tip, cq.Vector(8.0, 0.0, -1.0 - tip))))
    body = body.cut(hole(20.0, 0.0, 5.0, -9.0, 9.0)).cut(hole(20.0, 0.0, 10.0, 1.0, 9.0))
    window = cq.Workplane("XY", origin=(31, 0, -9)).rect(6.0, 10.0).extrude(18.0).edges("|Z").fillet(1.5)
    body = body.cut(window)
    body = body.cut(hole(42.0, 0.0, 4.0, 1.0, 9.0)).cut(hole(42.0, 0.0, 4.0, -9.0, -1.0))
    return body.val().moved(STAND)


def lever() -> cq.Shape:
    """Lever of 70 by 12 by 4 mm: hub of 14 mm, 8 mm high, bore 5 mm at x = 0; slot of 4 mm from x = 34 to 48 mm."""
    body = cq.Workplane("XY").center(25.0, 0.0).rect(70.0, 12.0).extrude(4.0).union(hole(0.0, 0.0, 14.0, 0.0, 8.0))
    body = body.cut(hole(0.0, 0.0, 5.0, -1.0, 9.0))
    return body.cut(cq.Workplane("XY", origin=(41, 0, -1)).slot2D(18.0, 4.0).extrude(9.0)).val().moved(STAND)


def open_bores() -> cq.Shape:
    """Strip of 120 by 20 by 6 mm with bores of 6 mm that are not round all the way.

    At -50 with a keyway of 2 mm, at -30 with a slit of 1 mm to the edge, at -5 with a hole of 2 mm across, at 35 with a
    keyway 2 mm deep from above, at 58 cut by the end.
    """
    body = cq.Workplane("XY").box(120.0, 20.0, 6.0)
    for x in (-50.0, -30.0, -5.0, 35.0, 58.0):
        body = body.cut(hole(x, 0.0, 6.0, -9.0, 9.0))
    body = body.cut(cq.Workplane("XY", origin=(-50.0, 2.0, -9.0)).rect(2.0, 4.0).extrude(18.0))
    body = body.cut(cq.Workplane("XY", origin=(-30.0, 6.0, -9.0)).rect(1.0, 12.0).extrude(18.0))
    body = body.cut(cq.Workplane("XZ", origin=(-5.0, 12.0, 0.0)).circle(1.0).extrude(24.0))
    return body.cut(cq.Workplane("XY", origin=(35.0, 2.0, 1.0)).rect(2.0, 4.0).extrude(18.0)).val()


def threaded() -> cq.Shape:
    """Strip of 44 by 12 by 4 mm, bore of 5 mm at 30; one of 6 mm at 0 with one turn of a thread, 5 mm inside."""
    body = cq.Workplane("XY").center(15.0, 0.0).rect(44.0, 12.0).extrude(4.0)
    body = body.cut(hole(0.0, 0.0, 6.0, -1.0, 9.0)).cut(hole(30.0, 0.0, 5.0, -1.0, 9.0))
    profile = cq.Workplane("XZ").polyline([(3.1, 1.05), (2.5, 1.44), (2.5, 1.56), (3.1, 1.95)]).close()
    helix = cq.Wire.makeHelix(1.0, 1.1, 3.1).translate(cq.Vector(0.0, 0.0, 1.5))
    return body.union(profile.sweep(cq.Workplane(obj=helix), isFrenet=True)).val()


def halves() -> cq.Shape:
    """Strip of 40 by 12 by 4 mm glued of two along its middle and not unified, so that its bores are half-cylinders."""
    upper = cq.Workplane("XY").center(0.0, 3.0).rect(40.0, 6.0).extrude(4.0)
    lower = cq.Workplane("XY").center(0.0, -3.0).rect(40.0, 6.0).extrude(4.0)
    tools = hole(-14.0, 0.0, 5.0, -1.0, 9.0).union(hole(14.0, 0.0, 5.0, -1.0, 9.0))
    return upper.cut(tools).union(lower.cut(tools), clean=False).val()


def cross_tube() -> cq.Shape:
    """Tube of 8 over 5 mm along x, 90 mm long, with pins of 3 mm straight through its walls, 72 mm apart."""
    body = cq.Workplane("YZ", origin=(-45, 0, 0)).circle(4.0).circle(2.5).extrude(90.0)
    return body.cut(hole(-36.0, 0.0, 3.0, -9.0, 9.0)).cut(hole(36.0, 0.0, 3.0, -9.0, 9.0)).val()


def sleeve() -> cq.Shape:
    """Sleeve of 30 mm, 20 mm long, with a bore of 10 mm, a groove for a ring in it, and a grease hole of 3 mm."""
    body = hole(0.0, 0.0, 30.0, 0.0, 20.0).cut(hole(0.0, 0.0, 10.0, 0.0, 20.0)).cut(hole(0.0, 0.0, 11.2, 14.0, 15.2))
    return body.cut(cq.Workplane("YZ").center(0.0, 6.0).circle(1.5).extrude(30.0)).val()


def splines() -> cq.Shape:
    """Strip of 60 by 20 by 5 mm with holes of 5 mm, 40 mm apart, and a mirror image's placement, all faces splines."""
    body = (
        cq.Workplane("XY")
        .box(60.0, 20.0, 5.0)
        .cut(hole(-20.0, 0.0, 5.0, -9.0, 9.0))
        .cut(hole(20.0, 0.0, 5.0, -9.0, 9.0))
    )
    return cq.Shape.cast(BRepBuilderAPI_NurbsConvert(body.val().wrapped, True).Shape()).mirror("XZ", (3.0, 4.0, 5.0))


def inch() -> cq.Shape:
    """Strip of 3 by 1 by 1/4 inch, in mm, with holes of 1/4 inch, 2 inches apart."""
    body = cq.Workplane("XY").box(76.2, 25.4, 6.35)
    return body.cut(hole(-25.4, 0.0, 6.35, -9.0, 9.0)).cut(hole(25.4, 0.0, 6.35, -9.0, 9.0)).val()


def angle() -> cq.Shape:
    """Angle of 16 by 10 by 2 mm along x, 160 mm long, with bores of 4 mm through its wide leg, 140 mm apart.

    Its legs lie on y = 0 to 16, z = 0 to 2 and y = 0 to 2, z = 0 to 10; the bores at y = 8.
    """
    body = cq.Workplane("YZ", origin=(-80, 0, 0)).polyline([(0, 0), (16, 0), (16, 2), (2, 2), (2, 10), (0, 10)])
    body = body.close().extrude(160.0)
    return body.cut(hole(-70.0, 8.0, 4.0, -1.0, 3.0)).cut(hole(70.0, 8.0, 4.0, -1.0, 3.0)).val()


def taper() -> cq.Shape:
    """Bar of 6 mm whose width grows from 10 to 20 mm over 100 mm between bores of 4 mm; it reaches 8 mm past them."""
    rise = 10.0 / 100.0 / 2.0
    low, high = 5.0 - 8.0 * rise, 10.0 + 8.0 * rise
    body = cq.Workplane("XY").polyline([(-8, -low), (108, -high), (108, high), (-8, low)]).close().extrude(6.0)
    return body.cut(hole(0.0, 0.0, 4.0, -1.0, 9.0)).cut(hole(100.0, 0.0, 4.0, -1.0, 9.0)).val()


def two_solids() -> cq.Shape:
    """A block of 10 mm and one of 20 by 10 by 5 mm, apart."""
    return cq.Compound.makeCompound(
        [cq.Solid.makeBox(10.0, 10.0, 10.0), cq.Solid.makeBox(20.0, 10.0, 5.0, cq.Vector(30.0, 0.0, 0.0))]
    )


def shell() -> cq.Shape:
    """The sides of a box, without volume."""
    return cq.Shell.makeShell(cq.Workplane("XY").box(10.0, 10.0, 10.0).faces("|Z or |X").vals())


def main() -> None:
    """Write the files."""
    makers = (
        plate,
        bell_crank,
        fork,
        slotted,
        lever,
        open_bores,
        halves,
        cross_tube,
        sleeve,
        splines,
        inch,
        angle,
        taper,
        two_solids,
        shell,
        threaded,
    )
    for make in makers:
        shape = make()
        if isinstance(shape, cq.Compound) and len(shape.Solids()) == 1:
            shape = shape.Solids()[0]
        path = HERE / f"{make.__name__}.step"
        if make is plate:
            cq.Assembly(cq.Workplane(obj=shape), loc=STAND, name="plate").export(str(path))
            shape = shape.moved(STAND)
        else:
            shape.exportStep(str(path), outputUnit="INCH" if make is inch else "MM", write_pcurves=False)
        print(make.__name__, shape.ShapeType(), shape.isValid(), repr(shape.Volume()), repr(shape.Area()))
        print("   ", shape.Center().toTuple() if shape.Volume() else "")


if __name__ == "__main__":
    main()
