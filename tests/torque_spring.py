"""A kind of acting thing in one class: a spring of constant torque about a joint, as a contributor would add it.

Beside the class stands its place in the union ``Spring``, here that of a case that knows it too.
"""

from alula.geometry.base.model import Name
from alula.geometry.base.units import Moment
from alula.geometry.linkage.placement import Placement
from alula.loads.acting.sizes import Angle
from alula.loads.acting.springs import Spring
from alula.loads.acting.sprung import Law, Sprung, SprungRecord
from alula.loads.case.case import Case


class TorqueSpring(SprungRecord):
    """A coiled strip that turns a joint's second link with the same moment at any angle."""

    about: Name
    torque: Moment

    @property
    def hinge(self) -> str:
        return self.about

    def acting(self, name: str, stated: Placement) -> Sprung:
        return Sprung(name=name, along=Angle(self.about, stated), law=Law(effort=-self.torque))


class TorqueCase(Case):
    springs: dict[Name, TorqueSpring | Spring] = {}  # type: ignore[assignment]
