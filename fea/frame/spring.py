"""Springs and tendons of a frame: what they do more, or less, once its points have moved.

As the frame stands, their forces are among its loads. In large displacement they follow the points, in the linkage's
plane: see ``alula.loads.acting.sprung``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError
from alula.geometry.linkage.pose import Pose
from alula.loads.acting.sizes import places
from alula.loads.acting.sprung import Sprung

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class FrameSpring:
    """A spring or tendon between nodes.

    Attributes
    ----------
    acting : Sprung
    nodes : tuple of int or None
        Numbers of the nodes of its ends; None on the ground.
    places : complex ndarray, shape (k,)
        Where its ends stand in the linkage's plane [mm].
    size : float
        Its length [mm] or angle [rad] as the frame stands.
    softness : float
        By which its stiffness is divided, as that of beams is, and what keeps a tendon slack.
    """

    acting: Sprung
    nodes: tuple[int | None, ...]
    places: NDArray[np.complex128]
    size: float
    softness: float = 1.0

    @classmethod
    def of(cls, acting: Sprung, pose: Pose, points: Mapping[tuple[str, str], int]) -> "FrameSpring":
        """Return a spring as it stands in a pose.

        Parameters
        ----------
        acting : Sprung
        pose : Pose
        points : mapping of (str, str) to int
            (link, point) -> number of its node.

        Returns
        -------
        FrameSpring
        """
        place, ends = pose.placement, acting.ends
        nodes = tuple(points.get(end) for end in ends)
        return cls(acting=acting, nodes=nodes, places=places(place, ends), size=float(acting.along.of(place)))

    def softened(self, factor: float) -> "FrameSpring":
        """Return the spring with its stiffness divided by a factor.

        Parameters
        ----------
        factor : float

        Returns
        -------
        FrameSpring
        """
        return replace(self, softness=self.softness * factor)

    def resists(self, displacements: Floats, turns: Floats, factor: float) -> tuple[Floats, Floats]:
        """Return what it resists where its ends have moved, and its tangent.

        Parameters
        ----------
        displacements : ndarray, shape (k, 2)
            Of its ends [mm].
        turns : ndarray, shape (k,)
            By how much they are turned about z [rad].
        factor : float
            Share of the loads.

        Returns
        -------
        tuple of 2 ndarray
            Fx, Fy and Mz at its ends, less those as the frame stands (k, 3) [N, N mm]; the tangent (3 k, 3 k).

        Raises
        ------
        CannotRunError
            Where two neighbouring points meet.
        """
        along, law = self.acting.along, self.acting.law
        moved = self.places + displacements @ [1.0, 1.0j]
        if any((*along.meeting(moved, 0.0), *along.meeting(self.places, 0.0))):
            raise CannotRunError(
                "two points of a spring or tendon meet, so that the direction of its force is not known"
            )
        still = float(law.wanted(self.size))
        slack = law.pulls and still < 0.0
        before = still / self.softness if slack else factor * still
        grown = float(along.between(moved, turns) - along.between(self.places, np.zeros(len(turns))))
        effort = before + (float(law.wanted(self.size + grown)) - still) / self.softness
        if law.pulls and (effort < 0.0 or (effort == 0.0 and still <= 0.0)):
            effort, tangent = 0.0, np.zeros(2 * (3 * len(turns),))
        else:
            tangent = self.acting.bent(moved, effort, law.slope(self.size + grown) / self.softness)
        before = max(before, 0.0) if law.pulls else before
        return effort * along.gradient(moved) - before * along.gradient(self.places), tangent


def turn_about_z(rotation: Floats) -> float:
    """Return by how much a rotation matrix turns the linkage's plane.

    Parameters
    ----------
    rotation : ndarray, shape (3, 3)

    Returns
    -------
    float
        [rad], within half a turn.
    """
    return float(np.arctan2(rotation[1, 0] - rotation[0, 1], rotation[0, 0] + rotation[1, 1]))
