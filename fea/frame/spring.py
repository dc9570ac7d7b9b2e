"""Springs and tendons of a frame: what they do more, or less, once its points have moved.

As the frame stands, their forces are among its loads. In large displacement they follow the points: with the length L
of a spring's line through k points, in the linkage's plane, and its gradient g by their places (2 k), the pull is

    T = λ T0 + c (L - L0),    force -T g,    tangent c g gᵀ + T d²L

where λ is the share of the loads, T0 and L0 pull and length as the frame stands, and c the stiffness. A tendon pulls
where T > 0 alone. Springs about a joint turn with their two nodes about z.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class FrameSpring:
    """A spring or tendon between nodes.

    Attributes
    ----------
    ends : tuple of tuple of 2 str
        (link, point) of its points, one after the other; of a spring about a joint those of its two links.
    nodes : tuple of int or None
        Numbers of their nodes; None on the ground.
    places : ndarray, shape (k, 2)
        Where they stand in the linkage's plane [mm].
    stiffness : float
        [N/mm], or [N mm/rad] about a joint.
    effort : float
        Pull as the frame stands [N]: of a slack tendon what it would be if it could push. Of no use about a joint.
    pulls : bool
        True for a tendon, which does not push.
    turns : bool
        True for a spring about a joint.
    """

    ends: tuple[tuple[str, str], ...]
    nodes: tuple[int | None, ...]
    places: Floats
    stiffness: float
    effort: float = 0.0
    pulls: bool = False
    turns: bool = False

    def softened(self, factor: float) -> "FrameSpring":
        """Return the spring with its stiffness divided by a factor, as that of beams is.

        Parameters
        ----------
        factor : float

        Returns
        -------
        FrameSpring
            What keeps a tendon slack is divided too.
        """
        effort = self.effort / factor if self.pulls and self.effort < 0.0 else self.effort
        return replace(self, stiffness=self.stiffness / factor, effort=effort)

    def loaded(self, factor: float) -> float:
        """Return its pull as the frame stands under a share of the loads; what keeps a tendon slack is no load.

        Parameters
        ----------
        factor : float

        Returns
        -------
        float
            [N]
        """
        return self.effort if self.pulls and self.effort < 0.0 else factor * self.effort

    def pull(self, displacements: Floats, factor: float) -> tuple[float, Floats, Floats]:
        """Return its pull where its points have moved, with gradients.

        Parameters
        ----------
        displacements : ndarray, shape (k, 2)
            Of its points [mm].
        factor : float
            Share of the loads.

        Returns
        -------
        tuple of float and 2 ndarray
            Pull [N], its work per displacement T g less that of the pull as the frame stands (k, 2) [N], and the
            tangent (2 k, 2 k) [N/mm].

        Raises
        ------
        CannotRunError
            Where two neighbouring points meet.
        """
        length, rest = _line(self.places)[0], self.loaded(factor)
        now, gradient, bend = _line(self.places + displacements)
        pull, holds = rest + self.stiffness * (now - length), True
        if self.pulls and (pull < 0.0 or (pull == 0.0 and self.effort <= 0.0)):
            pull, holds = 0.0, False
        flat = gradient.ravel()
        tangent = pull * bend + (self.stiffness * np.outer(flat, flat) if holds else 0.0)
        before = max(rest, 0.0) if self.pulls else rest
        return pull, pull * gradient - before * _line(self.places)[1], tangent


def _line(places: Floats) -> tuple[float, Floats, Floats]:
    """Return the length of a line through points (k, 2), its gradient (k, 2) and second derivatives (2 k, 2 k)."""
    ways = np.diff(places, axis=0)
    lengths = np.linalg.norm(ways, axis=1)
    if not np.all(lengths > 0.0):
        raise CannotRunError("two points of a spring or tendon meet, so that the direction of its force is not known")
    along = ways / lengths[:, None]
    gradient, bend = np.zeros(places.shape), np.zeros((2 * len(places), 2 * len(places)))
    for i, (unit, length) in enumerate(zip(along, lengths, strict=True)):
        gradient[i] -= unit
        gradient[i + 1] += unit
        across = (np.eye(2) - np.outer(unit, unit)) / length
        bend[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += np.kron(np.array([[1.0, -1.0], [-1.0, 1.0]]), across)
    return float(lengths.sum()), gradient, bend


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
