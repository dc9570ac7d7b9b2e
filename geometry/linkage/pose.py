"""Assembling a linkage: Newton on the loop closure, on a stated assembly branch."""

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.coordinate import Coordinate, Measure
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.open_loop import open_loop
from alula.geometry.linkage.pose_record import CLOSED, Pose, constraint_jacobian, held_motion, turning

__all__ = ["CLOSED", "NEAR_DEAD_POINT", "Pose", "constraint_jacobian", "freedom", "held_motion", "turning"]
__all__ += ["nearest_pose", "solve_pose"]

Real = NDArray[np.float64]

_TARGET = 1e-14
_ITERATIONS = 60
_LARGEST_STEP = 0.5
_STARTS = 256
_RANK_TOLERANCE = 1e-9
"""Singular values of the scaled Jacobian (entries of order 1) below it count as zero."""
_SAME = 1e-5
"""Assemblies whose links all point within it [rad] are one."""
NEAR_DEAD_POINT = 0.02
"""Smallest singular value of the scaled Jacobian below which a pose is next to a dead point: 2° off on the owl wing."""
_LOOKED_INTO = 12
"""Attempts from which the least gap of an open loop is sought."""


def solve_pose(
    linkage: Linkage,
    *,
    coordinate: str | None,
    angle: float = 0.0,
    near: Mapping[str, float] | None = None,
    travel: float | None = None,
) -> Pose:
    """Assemble the linkage with ``coordinate`` at ``angle`` [rad], on the branch that ``near`` states.

    With a ``travel`` [mm] the coordinate is the slider or slot of that name, at that travel.

    ``near`` gives rough directions of links [rad]; the branch is the one assembly in which each of
    these links lies within 90° of its stated direction. Where ``near`` names all links, it is the
    assembly that Newton's iteration finds from there.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    coordinate : str, optional
        Name of the link whose angle is prescribed, or of the slider or slot.
    angle : float
        Angle of the coordinate [rad].
    near : mapping of str to float, optional
        Rough directions of links [rad].
    travel : float, optional
        Travel [mm], where the coordinate is a slider or slot.

    Returns
    -------
    Pose
        The assembled pose.

    Raises
    ------
    CaseError
        if the mobility is not the number of pose coordinates, if the linkage cannot be assembled
        (naming the loop that stays open and by how much), or if ``near`` leaves several assemblies to choose from.
        Where the counted mobility is too small, such as for a parallelogram with a further link, the rank of the
        Jacobian in the assembled pose decides.
    """
    near = dict(near or {})
    drives = 0 if coordinate is None else 1
    for name in [*near, *([coordinate] if coordinate and travel is None else [])]:
        if name not in linkage.moving:
            raise CaseError(f"pose: '{name}' is not a moving link; the moving links are {', '.join(linkage.moving)}")
    held = None if coordinate is None else _Held.of(linkage, coordinate, angle, travel)
    if linkage.mobility > drives:
        raise CaseError(
            f"pose: the linkage has mobility {linkage.mobility} (Gruebler) but {drives} pose coordinate(s); "
            f"they must be equal, so add or remove joints or links, or state pose.coordinate{_by_angles(linkage)}"
        )
    try:
        pose = _assemble(linkage, held, near)
        fits = linkage.mobility == drives or freedom(pose) == drives
    except CaseError:
        if linkage.mobility == drives:
            raise
        fits = False
    if not fits:
        raise CaseError(
            f"pose: the linkage has mobility {linkage.mobility} (Gruebler) but {drives} pose coordinate(s); they must "
            "be equal, or the rank of the Jacobian must leave as many degrees of freedom at the stated angle; "
            "add or remove joints or links"
        )
    return pose


def nearest_pose(
    linkage: Linkage,
    *,
    coordinate: str | None,
    near: Mapping[str, float],
    angle: float = 0.0,
    travel: float | None = None,
) -> Pose | None:
    """Assemble a linkage from rough directions of all its links, whatever its mobility.

    Nothing is searched, so that it takes a few steps alone: for a drawing that is not whole, or is being dragged.

    Parameters
    ----------
    linkage : Linkage
        The linkage.
    coordinate : str, optional
        As for ``solve_pose``.
    near : mapping of str to float
        Rough directions [rad]; 0 for a link that is left out.
    angle, travel : float, optional
        As for ``solve_pose``.

    Returns
    -------
    Pose or None
        The assembly that Newton's iteration finds from there; None where it finds none.
    """
    closure = LoopClosure(linkage)
    held = None if coordinate is None else _Held.of(linkage, coordinate, angle, travel)
    q, gaps = _newton(closure, held, near)
    return _pose(closure, q, held, gaps) if _is_assembled(closure, gaps) else None


def _by_angles(linkage: Linkage) -> str:
    """Return the further remedy of bonded joints whose angles are not stated."""
    open_ones = [name for name, joint in linkage.joints.items() if joint.as_posed]
    return f", or the angle of a bonded joint, joints.{open_ones[0]}.angle" if open_ones else ""


def freedom(pose: Pose) -> int:
    """Degrees of freedom of the pose: unknowns less the rank of the closure's Jacobian.

    Parameters
    ----------
    pose : Pose
        The pose.

    Returns
    -------
    int
        Degrees of freedom.
    """
    scale = pose.linkage.longest
    sizes = np.array([1.0] * len(pose.linkage.moving) + [scale] * len(pose.closure.slots))
    matrix = pose.closure.jacobian(pose.q) * sizes / scale
    return pose.closure.unknowns - int(np.linalg.matrix_rank(matrix, tol=_RANK_TOLERANCE))


@dataclass(frozen=True, kw_only=True)
class _Held:
    """The unknown that fixes the pose: its coordinate, its column and its value [rad, mm]."""

    coordinate: Coordinate
    column: int
    value: float

    @classmethod
    def of(cls, linkage: Linkage, name: str, angle: float, travel: float | None) -> "_Held":
        if travel is None:
            return cls(coordinate=Coordinate(name), column=linkage.moving.index(name), value=angle)
        closure = LoopClosure(linkage)
        slots = closure.slots
        if name not in slots:
            raise CaseError(
                f"pose.coordinate: '{name}' is no slider or slot, but a travel is stated for it; choose among "
                f"{', '.join(slots) or 'none'}, or state the angle of a link"
            )
        coordinate = Coordinate(name, Measure.TRAVEL)
        return cls(coordinate=coordinate, column=coordinate.column(closure), value=travel)

    def __str__(self) -> str:
        kind = "a travel of " if self.coordinate.slides else ""
        return f"{self.coordinate} at {kind}{self.coordinate.measure.in_words(self.value)}"


def _assemble(linkage: Linkage, held: _Held | None, near: dict[str, float]) -> Pose:
    closure = LoopClosure(linkage)
    free = [link for link in linkage.moving if held is None or held.coordinate != Coordinate(link)]

    unstated = [link for link in free if link not in near]
    if not unstated:
        q, gaps = _newton(closure, held, near)
        if _is_assembled(closure, gaps) and not _astray(closure, q, near):
            pose = _pose(closure, q, held, gaps)
            _refuse_rough(pose, held, near, free)
            return pose
    found, attempts = _assemblies(closure, held, near, free)
    if not found:
        raise CaseError(_explain_open(closure, attempts, held))
    kept = [(q, gaps) for q, gaps in found if not _astray(closure, q, near)]
    if len(kept) == 1:
        return _pose(closure, kept[0][0], held, kept[0][1])
    listed = "; ".join(_describe(closure, q, free) for q, _ in (kept or found))
    if kept:
        raise CaseError(f"pose.near: {len(kept)} assemblies fit it; state more directions to choose one of: {listed}")
    raise CaseError(f"pose.near: no assembly lies within 90 deg of all its directions; there are: {listed}")


def _refuse_rough(pose: Pose, held: _Held | None, near: Mapping[str, float], free: list[str]) -> None:
    """Refuse directions that are further from the pose than another assembly is: they do not tell the two apart.

    Looked for only next to a dead point of the coordinate, where assemblies come close to each other.
    """
    if held is None or pose.dead_point_distance(held.coordinate, bonds=False) > NEAR_DEAD_POINT:
        return
    columns = [pose.linkage.moving.index(link) for link in free]
    off = float(np.max(_turned(pose.q[columns] - np.array([near[link] for link in free])), initial=0.0))
    if off <= _SAME:
        return
    others, _ = _assemblies(pose.closure, held, near, free)
    apart = [q for q, _ in others if _SAME < float(np.max(_turned(q[columns] - pose.q[columns]))) <= off]
    if apart:
        listed = "; ".join(_describe(pose.closure, q, free) for q in (pose.q, *apart))
        raise CaseError(
            "pose.near: its directions do not tell apart assemblies that lie close together next to a dead point of "
            f"'{pose.coordinate}': {listed}; state them to better than {math.degrees(off):.2g} deg or change the "
            f"{held.coordinate.measure.word}"
        )


def _pose(closure: LoopClosure, q: Real, held: _Held | None, gaps: Real) -> Pose:
    return Pose(
        linkage=closure.linkage,
        q=q,
        coordinate=None if held is None else held.coordinate,
        residual=float(np.max(np.abs(gaps), initial=0.0)) / closure.linkage.longest,
    )


def _is_assembled(closure: LoopClosure, gaps: Real) -> bool:
    return bool(np.max(np.abs(gaps), initial=0.0) <= CLOSED * closure.linkage.longest)


def _newton(closure: LoopClosure, held: _Held | None, start: Mapping[str, float]) -> tuple[Real, Real]:
    """Newton with the exact Jacobian and halved steps; returns unknowns and closure residual.

    Every step solves by least squares, so that a singular or redundant system is no special case.
    """
    moving, scale = closure.linkage.moving, closure.linkage.longest
    q = np.array([start.get(link, 0.0) for link in moving] + [0.0] * len(closure.slots))
    if held is not None:
        q[held.column] = held.value
    free = _free(closure, held)
    weights = np.array([1.0] * len(moving) + [scale] * len(closure.slots))[free]
    gaps = closure.residual(q)
    for _ in range(_ITERATIONS):
        if np.max(np.abs(gaps), initial=0.0) <= _TARGET * scale:
            break
        step, *_ = np.linalg.lstsq(closure.jacobian(q)[:, free] * weights, -gaps, rcond=1e-13)
        step *= min(1.0, _LARGEST_STEP / max(float(np.max(np.abs(step))), 1e-300)) if not closure.slots else 1.0
        step = step * weights
        for _halving in range(12):
            trial = q.copy()
            trial[free] += step
            trial_gaps = closure.residual(trial)
            if np.linalg.norm(trial_gaps) < np.linalg.norm(gaps):
                break
            step = step / 2.0
        else:
            break
        q, gaps = trial, trial_gaps
    return q, gaps


def _free(closure: LoopClosure, held: _Held | None) -> NDArray[np.bool_]:
    return np.array([held is None or column != held.column for column in range(closure.unknowns)])


def _assemblies(
    closure: LoopClosure, held: _Held | None, near: Mapping[str, float], free: list[str]
) -> tuple[list[tuple[Real, Real]], list[tuple[Real, Real]]]:
    """Look for every assembly from many starts; also return all attempts."""
    quarter = [0.3, 0.3 + math.pi / 2, 0.3 + math.pi, 0.3 + 1.5 * math.pi]
    choices = [[near[link], near[link] + 0.9, near[link] - 0.9] if link in near else quarter for link in free]
    starts: Iterable[tuple[float, ...]] = itertools.product(*choices)
    if math.prod(len(c) for c in choices) > _STARTS:
        rng = np.random.default_rng(0)
        starts = [tuple(c[rng.integers(len(c))] for c in choices) for _ in range(_STARTS)]
    found: list[tuple[Real, Real]] = []
    attempts: list[tuple[Real, Real]] = []
    for start in starts:
        q, gaps = _newton(closure, held, dict(zip(free, start, strict=True)))
        attempts.append((q, gaps))
        if _is_assembled(closure, gaps) and not any(_same(closure, q, other) for other, _ in found):
            found.append((q, gaps))
    return found, attempts


def _turned(difference: Real | float) -> Real:
    return np.abs(np.arctan2(np.sin(difference), np.cos(difference)))


def _same(closure: LoopClosure, first: Real, second: Real) -> bool:
    moving = len(closure.linkage.moving)
    return bool(np.max(_turned(first[:moving] - second[:moving])) < _SAME)


def _astray(closure: LoopClosure, q: Real, near: Mapping[str, float]) -> bool:
    angles = dict(zip(closure.linkage.moving, q, strict=False))
    return any(float(_turned(angles[link] - stated)) > math.pi / 2 for link, stated in near.items())


def _describe(closure: LoopClosure, q: Real, free: list[str]) -> str:
    angles = dict(zip(closure.linkage.moving, q, strict=False))
    return ", ".join(f"{link} {math.degrees(angles[link]) % 360.0:.1f} deg" for link in free)


def _explain_open(closure: LoopClosure, attempts: list[tuple[Real, Real]], held: _Held | None) -> str:
    nearest = sorted(attempts, key=lambda attempt: float(np.linalg.norm(attempt[1])))[:_LOOKED_INTO]
    worst = open_loop(closure, _free(closure, held), [q for q, _ in nearest])
    where = "its joints cannot be brought together"
    if worst is not None:
        where = f"loop {'-'.join(closure.loop_path(worst[0]))} stays open by {worst[1]:.4g} mm"
    at = "" if held is None else f" with {held}"
    change = (Measure.ANGLE if held is None else held.coordinate.measure).word
    return f"pose: the linkage cannot be assembled{at}: {where}; change the {change} or the links' lengths"
