"""The operations of gmsh's OpenCASCADE kernel that kinds of parts are built with.

gmsh itself is loaded in a child process alone (``alula.geometry.meshing``), which hands it to ``Kernel``.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.outline import Outline
from alula.geometry.bodies.features import Fork, Pin

Entity = tuple[int, int]
"""Dimension and tag of something in the kernel."""
Vector = tuple[float, float, float]
Border = Sequence[tuple[tuple[float, float], tuple[float, float] | None]]
"""A closed border: (x, y) where each piece of it starts, and the middle of an arc; None of a line."""
ON_SURFACE = 1e-5
"""Distance within which a point counts as lying on a surface, in the unit of ``alula.geometry.solids.solid_model``."""


class FilletError(Exception):
    """The kernel cannot round the edges with the radius that is asked for."""


class Kernel:
    """The geometry kernel with one model.

    Parameters
    ----------
    gmsh : module
        gmsh, initialised.
    """

    def __init__(self, gmsh: Any) -> None:
        self.gmsh = gmsh
        self.model = gmsh.model
        self.occ = gmsh.model.occ

    def cylinder(self, start: Vector, axis: Vector, radius: float) -> Entity:
        """Make a cylinder, the seam of its face in the plane of its axis if that lies in z = 0.

        A cut along that plane then leaves each half one face.

        Parameters
        ----------
        start : tuple of float
            Middle of one end.
        axis : tuple of float
            Vector from there to the middle of the other end.
        radius : float
            Its radius.

        Returns
        -------
        Entity
            The solid.
        """
        solid = 3, self.occ.addCylinder(*start, *axis, radius)
        if axis[2] == 0.0 in axis[:2]:  # along x or y, where the kernel begins at +z
            self.occ.rotate([solid], *start, *axis, math.pi / 2.0)
        return solid

    def imported(self, file: str, scale: float, turn: Sequence[Vector], shift: Vector) -> Entity:
        """Read the solid of a STEP file and move it.

        Parameters
        ----------
        file : str
            Path.
        scale : float
            By which its lengths in mm are multiplied.
        turn : sequence of tuple of float
            Rows of a rotation about the origin.
        shift : tuple of float
            By which it is moved then.

        Returns
        -------
        Entity
            The solid.

        Raises
        ------
        CannotRunError
            Where there are several, or none.
        """
        self.gmsh.option.setNumber("Geometry.OCCScaling", scale)
        try:
            found = self.occ.importShapes(file, highestDimOnly=True, format="step")
        finally:
            self.gmsh.option.setNumber("Geometry.OCCScaling", 1.0)
        solid = self.only([entity for entity in found if entity[0] == 3])
        axis, angle = axis_angle(np.array(turn))
        if angle != 0.0:
            self.occ.rotate([solid], 0, 0, 0, *axis, angle)
        self.occ.translate([solid], *shift)
        return solid

    def box(self, corner: Vector, sides: Vector, turn: float = 0.0, about: tuple[float, float] = (0.0, 0.0)) -> Entity:
        """Make a box, and turn it in the plane.

        Parameters
        ----------
        corner : tuple of float
            The corner of least coordinates.
        sides : tuple of float
            Lengths along x, y and z.
        turn : float
            Angle about z [rad].
        about : tuple of float
            (x, y) of the axis about which it turns.

        Returns
        -------
        Entity
            The solid.
        """
        solid = 3, self.occ.addBox(*corner, *sides)
        self.occ.rotate([solid], *about, 0, 0, 0, 1, turn)
        return solid

    def slab(self, outline: Outline, height: float) -> Entity:
        """Extrude an outline along z.

        Parameters
        ----------
        outline : Outline
            Arcs and the straight lines between them.
        height : float
            Half of it lies on either side of the mid-plane.

        Returns
        -------
        Entity
            The solid.
        """
        if len(outline.arcs) == 1:
            (circle,) = outline.arcs
            return self.cylinder((circle.x, circle.y, -height / 2.0), (0, 0, height), circle.radius)
        border: list[tuple[tuple[float, float], tuple[float, float] | None]] = []
        for arc, line in zip(outline.arcs, outline.straight, strict=True):
            border.append((arc.point(arc.start), arc.point((arc.start + arc.end) / 2.0)))
            border += [(arc.point(arc.end), None)] if line else []
        return self.extruded(border, height)

    def extruded(self, border: Border, height: float) -> Entity:
        """Extrude a border along z.

        Parameters
        ----------
        border : Border
            Lines and arcs, counter-clockwise.
        height : float
            Half of it lies on either side of the mid-plane.

        Returns
        -------
        Entity
            The solid.
        """
        low = -height / 2.0
        starts = [self.occ.addPoint(*place, low) for place, _ in border]
        middles, curves = [], []
        for (_, through), first, then in zip(border, starts, starts[1:] + starts[:1], strict=True):
            if through is None:
                curves.append(self.occ.addLine(first, then))
                continue
            middle = self.occ.addPoint(*through, low)
            curves.append(self.occ.addCircleArc(first, middle, then, center=False))
            middles.append((0, middle))
        self.occ.remove(middles)
        loop = self.occ.addCurveLoop(curves)
        solids = self.occ.extrude([(2, self.occ.addPlaneSurface([loop]))], 0, 0, height)
        return self.only([entity for entity in solids if entity[0] == 3])

    def upright(self, pin: Pin, diameter: float, height: float) -> list[Entity]:
        """Make a cylinder along a pin; about a slot, the pieces of one drawn out along x.

        Parameters
        ----------
        pin : Pin
            Hole or slot.
        diameter, height : float
            Sizes; half of the height lies on either side of the mid-plane.

        Returns
        -------
        list of Entity
            Solids that overlap.
        """
        low = -height / 2.0
        pieces = [self.cylinder((x, pin.y, low), (0, 0, height), diameter / 2.0) for x in sorted(set(pin.span))]
        if pin.slot > 0.0:
            pieces.append((3, self.occ.addBox(pin.span[0], pin.y - diameter / 2.0, low, pin.slot, diameter, height)))
        return pieces

    def fork_gap(self, pin: Pin, fork: Fork) -> Entity:
        """Make what cuts the gap of a fork: a cylinder about its pin, whose rims are rounded as the root shall be.

        Parameters
        ----------
        pin : Pin
            The pin.
        fork : Fork
            The gap.

        Returns
        -------
        Entity
            The solid.
        """
        solid = self.cylinder((pin.x, pin.y, -fork.gap / 2.0), (0, 0, fork.gap), fork.depth)
        if fork.radius == 0.0:
            return solid
        self.occ.synchronize()
        flat = [f for f in self.model.getBoundary([solid], oriented=False) if self.model.getType(*f) == "Plane"]
        return self.fillet(solid, [tag for _, tag in self.model.getBoundary(flat, oriented=False)], fork.radius)

    def fuse(self, pieces: list[Entity], *, unify: bool = False) -> Entity:
        """Unite solids that touch or overlap.

        Parameters
        ----------
        pieces : list of Entity
            Solids.
        unify : bool
            Whether faces that lie in one surface become one.

        Returns
        -------
        Entity
            The solid.
        """
        if len(pieces) == 1:
            return pieces[0]
        self.gmsh.option.setNumber("Geometry.OCCUnionUnify", int(unify))
        solids, _ = self.occ.fuse(pieces[:1], pieces[1:])
        self.gmsh.option.setNumber("Geometry.OCCUnionUnify", 0)
        return self.only(solids)

    def cut(self, solid: Entity, tools: list[Entity]) -> Entity:
        """Cut solids out of another.

        Parameters
        ----------
        solid : Entity
            What is cut.
        tools : list of Entity
            What is taken away; it may be empty.

        Returns
        -------
        Entity
            What is left.
        """
        if not tools:
            return solid
        solids, _ = self.occ.cut([solid], tools)
        return self.only(solids)

    def fillet(self, solid: Entity, curves: list[int], radius: float) -> Entity:
        """Round edges of a solid.

        Parameters
        ----------
        solid : Entity
            The solid.
        curves : list of int
            Tags of its edges.
        radius : float
            Radius of the fillets.

        Returns
        -------
        Entity
            The rounded solid.

        Raises
        ------
        FilletError
            Where the kernel finds no such fillets.
        """
        try:
            solids = self.occ.fillet([solid[1]], curves, [radius])
        except Exception as error:
            raise FilletError(str(error)) from error
        return self.only(solids)

    def only(self, solids: list[Entity]) -> Entity:
        """Return the single solid of a result.

        Parameters
        ----------
        solids : list of Entity
            What an operation left.

        Returns
        -------
        Entity
            Its single member.

        Raises
        ------
        CannotRunError
            Where there are several, or none.
        """
        if len(solids) != 1:
            raise CannotRunError(
                f"the part came out as {len(solids)} solids instead of one; change its dimensions a little"
            )
        return solids[0]

    def curves(self, holds: Callable[[NDArray[np.float64]], bool]) -> list[int]:
        """Return the curves of the model on which a condition holds.

        Parameters
        ----------
        holds : callable
            Takes a point (3,); asked at three points of every curve.

        Returns
        -------
        list of int
            Tags.
        """
        self.occ.synchronize()
        return [
            tag
            for _, tag in self.model.getEntities(1)
            if all(holds(self.point_on_curve(tag, at)) for at in (0.13, 0.5, 0.77))
        ]

    def point_on_curve(self, tag: int, at: float) -> NDArray[np.float64]:
        """Return a point of a curve.

        Parameters
        ----------
        tag : int
            The curve.
        at : float
            Share of its range of parameters, 0 to 1.

        Returns
        -------
        ndarray
            The point (3,).
        """
        low, high = self.model.getParametrizationBounds(1, tag)
        return np.asarray(self.model.getValue(1, tag, [low[0] + at * (high[0] - low[0])]))


def axis_angle(turn: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return axis and angle of a rotation, by the quaternion that is nearest to it.

    That is the eigenvector of the largest eigenvalue of a symmetric matrix of the rotation's entries.

    Parameters
    ----------
    turn : ndarray
        Rotation matrix (3, 3).

    Returns
    -------
    axis : ndarray
        Unit vector (3,); x for no rotation.
    angle : float
        From 0 to 2π [rad].

    References
    ----------
    Bar-Itzhack, J. Guidance, Control, and Dynamics 23 (2000) 1085-1087.
    """
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = turn + turn.T - np.trace(turn) * np.eye(3)
    matrix[3, :3] = matrix[:3, 3] = turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]
    matrix[3, 3] = np.trace(turn)
    quaternion = np.linalg.eigh(matrix)[1][:, -1]
    size = float(np.linalg.norm(quaternion[:3]))
    axis = quaternion[:3] / size if size > 0.0 else np.array([1.0, 0.0, 0.0])
    return axis, 2.0 * math.atan2(size, float(quaternion[3]))
