"""A kind of load in one class: a clip that presses on both flat faces of an eye, as a contributor would add it.

Beside the class stand its record and its place in ``LinkLoads``; by a line in ``KINDS`` checks and envelopes use it.
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.tractions.surface_load import LinearLoad
from alula.fea.tractions.traction import Transfer
from alula.loads.records.applied import chosen

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Clip:
    """The force of a clip about a pin [N]."""

    VECTORS: ClassVar[tuple[str, ...]] = ()
    SCALARS: ClassVar[tuple[str, ...]] = ("force",)
    pin: str
    force: Any


@dataclass(frozen=True, kw_only=True, eq=False)
class ClippedLoads(LinkLoads):
    """Loads of a link with clips, which balance by themselves."""

    clips: tuple[Clip, ...] = ()

    def chosen(self, poses: Any) -> "ClippedLoads":
        return replace(super().chosen(poses), clips=tuple(chosen(clip, poses) for clip in self.clips))


class ClipPressure(LinearLoad):
    """Pressure on both flat faces of one eye."""

    @classmethod
    def places(cls, loads: LinkLoads) -> dict[str, Clip]:
        return {clip.pin: clip for clip in getattr(loads, "clips", ())}

    def amounts(self, loads: LinkLoads, transfer: Transfer | None) -> Real:
        own = (clip.force for clip in getattr(loads, "clips", ()) if clip.pin == self.place)
        return sum(own, np.zeros((1, loads.poses)))

    def unit(self, number: int) -> Real:
        faces = [self.surfaces.named(name) for name in self.surfaces.space.flat_faces(self.place)]
        return sum(self.surfaces.vector(face, -face.normals / face.measure) for face in faces)
