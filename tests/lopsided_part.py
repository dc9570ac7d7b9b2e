"""A kind of part that is not symmetric about its mid-plane: a strip with a bore beside it."""

from typing import Annotated

from strip_part import Strip

from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Length
from alula.geometry.bodies.body import Body, extent
from alula.geometry.bodies.kernel import Entity, Kernel


class Lopsided(Strip):
    """A strip that is bored through across, at a height of its own above the mid-plane."""

    bore: Annotated[Length, POSITIVE]
    height: Annotated[Length, NOT_NEGATIVE]

    def cavities(self, kernel: Kernel, body: Body) -> list[Entity]:
        middle = sum(extent(body)) / 2.0
        return [kernel.cylinder((middle, -self.width, self.height), (0.0, 2.0 * self.width, 0.0), self.bore / 2.0)]
