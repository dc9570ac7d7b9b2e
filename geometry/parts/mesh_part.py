"""The part from a volume mesh: elements from a file, of which its link is made as they are."""

from typing import ClassVar, Literal

from pydantic import field_validator

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import refusal
from alula.geometry.bodies.body import Body, Feature
from alula.geometry.bodies.kernel import Entity, Kernel
from alula.geometry.parts.step import FilePart, ImportedPart

UNITS = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}
"""Units of length of mesh files [mm]."""


class MeshPart(FilePart):
    """Quadratic tetrahedra from a file (.msh, .inp or .vtu), of which a link is made as they are.

    The bores among them are matched to the points of the link.
    """

    shape: Literal["mesh"]
    unit: Literal["um", "mm", "cm", "m", "in"] = "mm"
    """Unit of length of the file, which states none itself."""

    @field_validator("faces")
    @classmethod
    def _no_faces(cls, faces: dict[str, str]) -> dict[str, str]:
        if faces:
            raise refusal("a mesh has no faces with names; give the part as a STEP file")
        return faces

    @property
    def mesh_unit(self) -> float:
        """As ``FilePart.mesh_unit``."""
        return UNITS[self.unit]


class MeshedPart(ImportedPart):
    """A mesh from a file, placed in the frame of a link: the kind of part that a body of a ``MeshPart`` has."""

    takes: ClassVar[frozenset[Feature]] = frozenset(("slots",))
    is_fixed: ClassVar[bool] = True
    patches_anywhere: ClassVar[bool] = False

    shape: Literal["mesh"] = "mesh"
    file_unit: float
    """Unit of length of the file [mm]."""

    @property
    def mesh_unit(self) -> float | None:
        """As ``FilePart.mesh_unit``."""
        return self.file_unit

    def solid(self, kernel: Kernel, body: Body) -> Entity:
        """As ``PartKind.solid``: there is none.

        Raises
        ------
        CaseError
            Always.
        """
        raise CaseError("a part of shape mesh has no solid for the geometry kernel; give it as a STEP file")
