"""What parts of all kinds, built or imported, state of how they were printed."""

from geometry.base.model import CaseModel, Direction


class Printable(CaseModel):
    """A part that may have been printed in layers."""

    build_direction: Direction | None = None
    """Of a printed part: normal of its layers, in its link's frame (x along the link, z along the pins). Where the
    material's card has the strength across layers, tension normal to them and shear along them are checked."""
