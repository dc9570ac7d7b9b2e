"""What tubes and bars have in common: straight pieces (the axis, and arms) with an eye at every pin.

Fillets round the edges between pieces and eyes, and between an arm and the piece that it starts from.
"""

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import FLAT_WALL, Body, PartKind, extent
from alula.geometry.bodies.eyes import check_eyes, flush, plain_eye
from alula.geometry.bodies.features import Pin
from alula.geometry.bodies.footprint import Footprint, eye, strip
from alula.geometry.bodies.kernel import ON_SURFACE, Entity, Kernel
from alula.geometry.parts.arms import check_arms

CLEAR_EYE = 1.1
"""Eye over width of a bar from which on the eye's rim stands clear of the bar's sides."""


@dataclass(frozen=True, kw_only=True)
class Piece:
    """A straight piece of the part's section.

    Attributes
    ----------
    start : tuple of float
        (x, y) where its axis begins [mm].
    angle : float
        Direction of its axis [rad].
    length : float
        Its length [mm].
    """

    start: tuple[float, float]
    angle: float
    length: float


class Straight(PartKind):
    """A part of straight pieces with eyes: a kind of it states its sizes and builds one piece."""

    @abstractmethod
    def check_sizes(self) -> None:
        """Refuse sizes that do not go together.

        Raises
        ------
        PydanticCustomError
            With the rule and a remedy.
        """

    @model_validator(mode="after")
    def _sizes(self) -> Self:
        self.check_sizes()
        return self

    def reach(self, body: Body) -> tuple[float, float]:
        """Return where the piece along the axis begins and ends.

        Parameters
        ----------
        body : Body
            The body.

        Returns
        -------
        first, last : float
            Stations [unit of the body]; those of the outermost pins and load points unless the kind knows better.
        """
        return extent(body)

    def pieces(self, body: Body) -> list[Piece]:
        """Return the straight pieces: the one along the axis, then its arms.

        Parameters
        ----------
        body : Body
            The body.

        Returns
        -------
        list of Piece
            The pieces.
        """
        first, last = self.reach(body)
        pieces = [Piece(start=(first, 0.0), angle=0.0, length=last - first)]
        for pin in body.pins:
            if pin.foot is not None:
                x, y = pin.x - pin.foot[0], pin.y - pin.foot[1]
                pieces.append(Piece(start=pin.foot, angle=math.atan2(y, x), length=math.hypot(x, y)))
        return pieces

    def rough_volume(self, body: Body) -> float | None:
        """As ``PartKind.rough_volume``: pieces and eyes less their holes and what they share, without fillets.

        None of a part with forks.
        """
        if any(pin.fork is not None for pin in body.pins):
            return None
        section, pieces = self.section, self.pieces(body)
        axis, *arms = pieces
        widths = [2.0 * self.half_width(body, axis.start[0] + axis.length * (i + 0.5) / 100.0) for i in range(100)]
        thickness = section.area / section.width
        volume = thickness * sum(widths) / 100.0 * axis.length + section.area * sum(arm.length for arm in arms)
        for pin in body.pins:
            ring, hole = body.ring(pin), pin.diameter
            if ring.diameter == 0.0:  # no eye: a hole through what there is
                volume -= ring.thickness * (math.pi / 4.0 * hole**2 + hole * pin.slot)
                continue
            wide = 2.0 * self.half_width(body, pin.x) if pin.foot is None else section.width
            diameter = wide if plain_eye(body, pin) else ring.diameter
            width = min(wide, diameter)
            # Of a disc of the eye's diameter, the bar's sides cut out what follows from the chords at them.
            shared = diameter**2 / 2.0 * math.asin(width / diameter) + width / 2.0 * math.sqrt(diameter**2 - width**2)
            volume += ring.thickness * (math.pi / 4.0 * (diameter**2 - hole**2) - hole * pin.slot)
            volume -= thickness * shared * _share_within(pieces, pin, diameter / 2.0)
        return volume

    @abstractmethod
    def prism(self, kernel: Kernel, body: Body, piece: Piece) -> list[Entity]:
        """Build one straight piece.

        Parameters
        ----------
        kernel : Kernel
            The geometry kernel.
        body : Body
            The body, in the kernel's unit.
        piece : Piece
            Where it lies.

        Returns
        -------
        list of Entity
            Solids that touch.
        """

    def flat_diameter(self, body: Body, pin: Pin) -> float:
        """As ``PartKind.flat_diameter``: within the wall where a flat bar's sides pass close to the eye's rim."""
        eye, width = body.ring(pin).diameter, (self.section if pin.foot is None else self.arm_section).width
        if 0.0 < eye < CLEAR_EYE * width:
            return pin.diameter + FLAT_WALL * (min(eye, width) - pin.diameter)
        return eye

    def check(self, body: Body) -> None:
        """As ``PartKind.check``: eyes and arms fit."""
        for pin in body.pins:
            if pin.ring is not None and pin.ring.diameter > 0.0:
                sizes = {"eye_diameter": pin.ring.diameter, "eye_thickness": pin.ring.height}
                try:
                    self.model_copy(update=sizes).check_sizes()
                except PydanticCustomError as error:
                    raise CaseError(f"the eye at {pin.name} has sizes of its own: {error.message()}") from None
        check_arms(body)
        check_eyes(body)

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: pieces and eyes, and the fillets between them."""
        part, pieces = body.part, self.pieces(body)
        solids = [entity for piece in pieces for entity in self.prism(kernel, body, piece)]
        raised = [pin for pin in body.pins if not plain_eye(body, pin)]
        for pin in body.pins:
            if pin in raised or pin.foot is not None or {*pin.span} & {*self.reach(body)}:  # else within the bar
                diameter = body.ring(pin).diameter if pin in raised else part.section.width
                solids += kernel.upright(pin, diameter, body.ring(pin).height)
        # Eye and bar of one thickness must share one flat face while the corners between them are filleted.
        solid = kernel.fuse(solids, unify=not part.section.round)

        def to_fillet(p: NDArray[np.float64]) -> bool:
            """Return whether a point lies where a piece meets an eye, or an arm's side the bar's."""
            places = [_on_piece(body, piece, p) for piece in pieces]
            sides, on_top = sum(on_side for on_side, _ in places), any(on_top for _, on_top in places)
            return sides > 1 or any(
                abs(pin.distance(p[0], p[1]) - body.ring(pin).diameter / 2.0) < ON_SURFACE
                and (sides > 0 or (on_top and not flush(body, pin)))
                for pin in raised
            )

        curves = kernel.curves(to_fillet)
        if part.fillet_radius == 0.0 or not (raised or len(pieces) > 1):
            return solid
        return kernel.fillet(solid, curves, part.fillet_radius)

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        """As ``PartKind.footprints``: pieces and eyes."""
        wide, high = self.section.width, self.section.height
        found = [strip(piece.start, piece.angle, piece.length, wide, high) for piece in self.pieces(body)]
        for pin in body.pins:
            ring, ends = body.ring(pin), {*pin.span} & {*self.reach(body)}
            if ring.diameter > 0.0 and not plain_eye(body, pin):
                found += eye(pin, ring, ring.diameter)
            elif ring.diameter > 0.0 and (ends or pin.foot is not None):
                found += eye(pin, ring, wide)
        return tuple(found)

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """As ``PartKind.fine_places``: along fillets, or sharp junctions."""
        part, half = body.part, body.part.section.width / 2.0
        edge = min((part.fillet_radius or size) * share, size)

        def to_eye(pin: Pin) -> str:
            return f"({pin.distance_formula}-{body.ring(pin).diameter / 2.0:.12g})"

        to_bar = f"(Sqrt(y^2+z^2)-{half:.12g})" if part.section.round else f"(Fabs(y)-{half:.12g})"
        places = []
        for pin in body.pins:
            pairs = [] if plain_eye(body, pin) else [(to_eye(pin), to_bar)]
            if pin.foot is not None:
                arm = f"(Fabs({_across(pin)})-{half:.12g})"
                foot = body.foot(pin)
                assert foot is not None
                at_eyes = [(to_eye(pin), arm), (to_eye(foot), arm)]
                pairs = [*(at_eyes if pairs else []), (arm, to_bar)]
            places += [(edge, f"Max(Sqrt({a}^2+{b}^2)-{part.fillet_radius:.12g},0)") for a, b in pairs]
        return places


def _share_within(pieces: list[Piece], pin: Pin, radius: float) -> float:
    """Return how much of an eye's diameter the axes of the pieces fill: a half where one ends, all where one passes."""
    filled = 0.0
    for piece in pieces:
        x, y, cos, sin = pin.x - piece.start[0], pin.y - piece.start[1], math.cos(piece.angle), math.sin(piece.angle)
        along, across = x * cos + y * sin, abs(y * cos - x * sin)
        if across < radius:
            filled += max(min(along + radius, piece.length) - max(along - radius, 0.0), 0.0)
    return filled / (2.0 * radius)


def _on_piece(body: Body, piece: Piece, p: NDArray[np.float64]) -> tuple[bool, bool]:
    """Return whether a point lies on a side of a straight piece, and on its top or bottom."""
    section = body.part.section
    x, y = p[0] - piece.start[0], p[1] - piece.start[1]
    cosine, sine = math.cos(piece.angle), math.sin(piece.angle)
    u, v = x * cosine + y * sine, y * cosine - x * sine
    if not -ON_SURFACE < u < piece.length + ON_SURFACE:
        return False, False
    if section.round:
        return abs(math.hypot(v, p[2]) - section.half_y) < ON_SURFACE, False
    on_side = abs(abs(v) - section.half_y) < ON_SURFACE and abs(p[2]) < section.half_z + ON_SURFACE
    on_top = abs(abs(p[2]) - section.half_z) < ON_SURFACE and abs(v) < section.half_y + ON_SURFACE
    return on_side, on_top


def _across(pin: Pin) -> str:
    """Return the distance from an arm's axis, to its left, as a formula."""
    assert pin.foot is not None
    dx, dy = pin.x - pin.foot[0], pin.y - pin.foot[1]
    length = math.hypot(dx, dy)
    return f"(y-({pin.foot[1]:.12g}))*({dx / length:.12g})-(x-({pin.foot[0]:.12g}))*({dy / length:.12g})"
