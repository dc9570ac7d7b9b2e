"""The reaction at one joint, and where the pin stands."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.placement import Placement, vector

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class JointReaction:
    """Wrench that one link exerts on the other at a joint, at one pose or at n.

    Attributes
    ----------
    joint, on, by : str
        The joint, its second link and its first.
    wrench : array (..., 6)
        Of ``by`` on ``on`` about the pin, global axes [N, N mm].
    arm : array (..., 3)
        From the point of link ``by`` to the pin at the mid-plane of ``on`` [mm]: zero but in slots, along guides,
        between layers and by play.
    """

    VECTORS: ClassVar[tuple[str, ...]] = ("wrench", "arm")
    SCALARS: ClassVar[tuple[str, ...]] = ()
    joint: str
    on: str
    by: str
    wrench: Real
    arm: Real = field(default_factory=lambda: np.zeros(3))

    @property
    def force(self) -> Real:
        """Force (..., 3) [N]."""
        return self.wrench[..., :3]

    @property
    def magnitude(self) -> float:
        """Size of the force at one pose [N]."""
        return float(np.linalg.norm(self.wrench[:3]))


def travelled(place: Placement, name: str) -> Real:
    """Return the vector from the point of a joint's first link to its pin.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    name : str
        Of the joint.

    Returns
    -------
    array (..., 3)
        At revolute joints what play sets apart and the rise between layers [mm].
    """
    joint = place.linkage.joints[name]
    rise = np.array([0.0, 0.0, place.linkage.rise(name)])
    if not joint.slides:
        return np.asarray(vector(np.full(place.shape, place.closure.offsets.get(name, 0.0), dtype=complex)) + rise)
    first, second = (place.position(*at) for at in zip(joint.links, place.linkage.joint_points(name), strict=True))
    return np.asarray(vector(second - first) + rise)
