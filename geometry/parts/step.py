"""The imported part: a solid from a file, and how it lies in its link."""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo

from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.model import Direction, Name, Text, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from alula.geometry.bodies.body import Body, Feature, PartKind
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.bodies.footprint import Footprint
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.bodies.section import Section, rectangle
from alula.geometry.imported.read import part_surface
from alula.geometry.materials.printable import Printable
from alula.geometry.parts.shadow import shadows

Vector = tuple[float, float, float]


def _beside_the_case(text: str, info: ValidationInfo) -> str:
    """Return the path of a file that stands beside the case file, or anywhere else if it is an absolute path."""
    if not text.strip() or "\0" in text:
        raise refusal("a part needs the name of its file; name it, relative to the case file")
    if not text.isprintable():
        raise refusal("the name of a part's file has characters that do not print; rename the file")
    folder = (info.context or {}).get("folder", "")
    return str((Path(folder) / text).absolute())


PartFile = Annotated[Text, Field(max_length=1000), AfterValidator(_beside_the_case)]


class FilePart(Printable):
    """A solid from a file; its bores are matched to the points of the link that is made of it."""

    if TYPE_CHECKING:  # at run time it would stand in the way of a kind's field

        @property
        def shape(self) -> str:
            """Name of the kind in the case file."""

    material: Name
    """Name of a material, of the library or of [materials]."""
    file: PartFile
    """Name of the file, relative to the folder of the case file."""
    bores: Annotated[dict[Name, Text], Field(max_length=100)] = {}
    """Point of the link -> name of its bore, as ``alula inspect`` names them; needed where the points and diameters of
    the link fit the part in several ways, and for ``points = "from-part"``."""
    faces: Annotated[dict[Name, Text], Field(max_length=100)] = {}
    """Load point of the link -> name of a flat face of the solid, as ``alula inspect`` names it. The point is the
    centre of the face, and need not be stated; a load there is spread evenly over the whole face."""
    place_tolerance: Annotated[Length, POSITIVE] = 0.1
    """How far the centre of a bore may lie from the point that the link states for it."""
    diameter_tolerance: Annotated[Length, NOT_NEGATIVE] = 0.3
    """How much the diameter of a bore may differ from that of its pin."""
    along: Direction | None = None
    """Direction of the link's x axis in the frame of the file; needed where the link has a single pin and the part
    names the bore of no other of its points, and allowed only with a single pin. What it has along the pin is left
    out."""
    flip: bool = False
    """Whether the part lies the other way up, where its bores alone do not tell."""
    plane: Length | None = None
    """Height above the middle of the first bore with a joint, along z of the link, of the plane in which the forces
    act; the mean of the middles of all bores with joints unless stated."""

    @property
    def mesh_unit(self) -> float | None:
        """Unit of length of a mesh [mm]; None where the file holds a solid, with a unit of its own."""
        return None


class StepPart(FilePart):
    """A solid from a STEP file; its bores are matched to the points of the link that is made of it."""

    shape: Literal["step"]


class ImportedPart(PartKind):
    """A solid from a file, placed in the frame of a link: the kind of part that a body of a ``FilePart`` has.

    A point p of the file lies at ``turn`` p + ``shift`` in the link's frame.
    """

    takes: ClassVar[frozenset[Feature]] = frozenset(("slots", "load points without a pin"))
    is_beam: ClassVar[bool] = False

    shape: Literal["step", "mesh"] = "step"
    material: Name
    file: str
    """Path of the file."""
    digest: str
    """SHA-256 of its content when it was placed."""
    turn: tuple[Vector, Vector, Vector]
    """Rows of the rotation."""
    shift: Vector
    """Where the origin of the file lies [mm]."""
    thickness: float
    """What sets the first element edges [mm]: three times the volume over the surface, but at most the least size
    of the solid along the axes of its file. Of a plate that is its thickness, of a square bar 0.75 times its side, of a
    thin wall 1.5 times its thickness."""
    low: Vector
    high: Vector
    """Bounds of the solid in the link's frame [mm]."""
    unit: float = 1.0
    """Size of the unit of all lengths here [mm]."""
    stations: tuple[CutSection, ...] = ()
    """Sections across the x axis, each in the middle of one of as many equal stretches between the outermost pins."""
    fillet_radius: ClassVar[float] = 0.0
    has_holes: ClassVar[bool] = True
    patches_anywhere: ClassVar[bool] = True

    def cuts(self, body: Body) -> tuple[CutSection, ...]:
        """As ``PartKind.cuts``: those at its stations."""
        return self.stations

    @property
    def may_be_sharp(self) -> bool:
        """As ``PartKind.may_be_sharp``: nobody knows."""
        return True

    @property
    def eye_diameter(self) -> float:
        """Twice the thickness: what no bore has a ring of its own for [mm]."""
        return 2.0 * self.thickness

    @property
    def eye_thickness(self) -> float:
        """Size of the part along the pins [mm]."""
        return self.high[2] - self.low[2]

    @property
    def size(self) -> float:
        """As ``PartKind.size``: the thickness."""
        return self.thickness

    @property
    def section(self) -> Section:
        """A uniform section as flexible as the part between its outermost pins: the harmonic means of its sections."""
        return self._uniform(harmonic=True)

    def hand_section(self, body: Body) -> Section:
        """As ``PartKind.hand_section``: the least area and second moments of all sections."""
        return self._uniform(harmonic=False)

    def _uniform(self, *, harmonic: bool) -> Section:
        if not self.stations:
            across, along = self.high[1] - self.low[1], self.high[2] - self.low[2]
            return rectangle(across, along)

        def one(values: list[float]) -> float:
            return len(values) / sum(1.0 / value for value in values) if harmonic else min(values)

        return Section(
            area=one([cut.area for cut in self.stations]),
            i_y=one([cut.free[0] for cut in self.stations]),
            i_z=one([cut.free[1] for cut in self.stations]),
            torsion=one([cut.torsion for cut in self.stations]),
            half_y=max(cut.width for cut in self.stations) / 2.0,
            half_z=max(cut.height for cut in self.stations) / 2.0,
            round=False,
        )

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: the solid of the file, with its holes.

        Raises
        ------
        CannotRunError
            Where the file is another than when it was placed.
        """
        part = body.part
        assert isinstance(part, ImportedPart)
        if hashlib.sha256(Path(part.file).read_bytes()).hexdigest() != part.digest:
            raise CannotRunError(f"the file '{Path(part.file).name}' changed while it was used; run once more")
        return kernel.imported(part.file, 1.0 / part.unit, part.turn, part.shift)

    @property
    def mesh_unit(self) -> float | None:
        """As ``FilePart.mesh_unit``."""
        return None

    def footprints(self, body: Body) -> tuple[Footprint, ...]:
        """As ``PartKind.footprints``: its shadow, layer by layer between its flat faces."""
        found = part_surface(Path(self.file), self.mesh_unit)
        return shadows(found.points @ np.array(self.turn).T + np.array(self.shift), found.triangles)

    def fine_places(self, body: Body, size: float, share: float) -> list[tuple[float, str]]:
        """As ``PartKind.fine_places``: none but holes and round surfaces, which the mesher finds."""
        return []

    def scaled(self, s: Callable[[float], float]) -> "ImportedPart":
        """As ``PartKind.scaled``: lengths alone."""
        lengths = {"thickness": s(self.thickness), "unit": self.unit * self.thickness / s(self.thickness)}
        vectors = {name: tuple(map(s, getattr(self, name))) for name in ("shift", "low", "high")}
        return self.model_copy(update=lengths | vectors | {"stations": ()})
