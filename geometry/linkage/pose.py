"""The pose of a linkage: Newton on the loop closure, on a stated assembly branch."""

import itertools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from geometry.base.errors import CaseError
from geometry.linkage.closure import LoopClosure
from geometry.linkage.linkage import Linkage
from geometry.linkage.open_loop import open_loop

Real = NDArray[np.float64]

CLOSED = 1e-10
"""Largest closure residual of an assembled pose, as a share of the longest link."""
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


@dataclass(frozen=True, kw_only=True)
class Pose:
    """A linkage in one position.

    linkage       the linkage
    q             (unknowns,) angles of the moving links [rad] and travels in the slots [mm]
    coordinate    the link whose angle fixes the pose; None where nothing moves
    residual      largest closure residual as a share of the longest link
    slides        True where the coordinate is a slider or slot, whose travel fixes the pose
    """

    linkage: Linkage
    q: Real
    coordinate: str | None
    residual: float
    slides: bool = False

    @cached_property
    def closure(self) -> LoopClosure:
        """The loop equations that the pose fulfils."""
        return LoopClosure(self.linkage)

    @cached_property
    def angles(self) -> Mapping[str, float]:
        """Direction of every link's x axis [rad]."""
        moving = self.linkage.moving
        return dict(zip(moving, map(float, self.q[: len(moving)]), strict=True)) | {self.linkage.ground: 0.0}

    @cached_property
    def origins(self) -> Mapping[str, Real]:
        """Origin of every link's frame in global axes [mm]."""
        origins = self.closure.origins(self.q)
        found = {name: np.array([z.real, z.imag]) for name, z in zip(self.linkage.moving, origins, strict=True)}
        return found | {self.linkage.ground: np.zeros(2)}

    @cached_property
    def _positions(self) -> Mapping[tuple[str, str], Real]:
        values = self.closure.positions(self.q)
        return {key: np.array([z.real, z.imag]) for key, z in zip(self.closure.point_names, values, strict=True)}

    @cached_property
    def travels(self) -> Mapping[str, float]:
        """Travel of the pin in every slot and slider [mm]."""
        return dict(zip(self.closure.slots, map(float, self.q[len(self.linkage.moving) :]), strict=True))

    @property
    def held(self) -> float:
        """Angle [rad] or travel [mm] of the coordinate; 0 where nothing moves."""
        if self.coordinate is None:
            return 0.0
        return self.travels[self.coordinate] if self.slides else self.angles[self.coordinate]

    def position(self, link: str, point: str) -> Real:
        """Position of a link's point in global axes (2,) [mm]."""
        return self._positions[link, point]

    @cached_property
    def points(self) -> Mapping[str, Real]:
        """Every point by name; ``link.point`` where links have different points of one name."""
        named: dict[str, Real] = {}
        for (link, point), here in self._positions.items():
            twins = [p for (_, other), p in self._positions.items() if other == point]
            same = all(np.linalg.norm(p - here) <= 1e-9 * self.linkage.longest for p in twins)
            named[point if same else f"{link}.{point}"] = here
        return named

    def rotation(self, link: str) -> Real:
        """Matrix (2, 2) that turns vectors of the link's frame into global axes."""
        c, s = math.cos(self.angles[link]), math.sin(self.angles[link])
        return np.array([[c, -s], [s, c]])

    def dead_point_distance(self, driven: str, *, slides: bool = False) -> float:
        """How far the pose is from a dead point of the given driven link (0 at the dead point).

        Smallest singular value of the scaled constraint Jacobian with that link held: coordinates
        are (x, y, L phi) of every moving link with L the longest link, so all entries are pure
        numbers. Where it vanishes the linkage moves although the link is held. With ``slides`` it
        is a slider or slot of that name that is held.
        """
        matrix = np.vstack([constraint_jacobian(self), held_motion(self, driven, slides=slides)])
        return float(np.linalg.svd(matrix, compute_uv=False)[-1])


def held_motion(pose: Pose, driven: str, *, slides: bool) -> Real:
    """Row (coordinates,) that holds a link's angle or, with ``slides``, the slider or slot of that name."""
    return _joint_motion(pose, driven)[0] if slides else _held(pose.linkage, driven)


def constraint_jacobian(pose: Pose) -> Real:
    """Jacobian of all joint constraints by (x, y, L phi) of every moving link, without dimensions.

    Rows: two per revolute joint (x, y), one per pin in slot (normal), two per slider (normal and
    angle). García de Jalón & Bayo, Kinematic and Dynamic Simulation of Multibody Systems, 1994,
    section 2.3 (reference-point coordinates).
    """
    linkage = pose.linkage
    rows: list[Real] = []
    for name, joint in linkage.joints.items():
        along, across, turn = _joint_motion(pose, name)
        rows += [along, across] if joint.type == "revolute" else [across]
        if joint.type == "slider":
            rows.append(turn)
    return np.array(rows)


def _joint_motion(pose: Pose, name: str) -> tuple[Real, Real, Real]:
    """Motion of a joint's second link against its first: along and across its direction, and turning.

    Rows (coordinates,) by (x, y, L phi) of every moving link; along x and y for a revolute joint.
    """
    linkage, joint = pose.linkage, pose.linkage.joints[name]
    at = pose.position(joint.links[1], linkage.joint_points(name)[1])
    relative, turn = np.zeros((2, 3 * len(linkage.moving))), np.zeros(3 * len(linkage.moving))
    for link, sign in zip(joint.links, (-1.0, 1.0), strict=True):
        if link != linkage.ground:
            k = 3 * linkage.moving.index(link)
            arm = at - pose.origins[link]
            relative[:, k : k + 2] = sign * np.eye(2)
            relative[:, k + 2] = sign * np.array([-arm[1], arm[0]]) / linkage.longest
            turn[k + 2] = sign
    if joint.type == "revolute":
        return relative[0], relative[1], turn
    along = pose.angles[joint.links[0]] + joint.direction
    c, s = math.cos(along), math.sin(along)
    return np.array([c, s]) @ relative, np.array([-s, c]) @ relative, turn


def _held(linkage: Linkage, link: str) -> Real:
    row = np.zeros(3 * len(linkage.moving))
    row[3 * linkage.moving.index(link) + 2] = 1.0
    return row


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

    Raises ``CaseError`` if the mobility is not the number of pose coordinates, if the linkage
    cannot be assembled (naming the loop that stays open and by how much), or if ``near`` leaves
    several assemblies to choose from. Where the counted mobility is too small, such as for a
    parallelogram with a further link, the rank of the Jacobian in the assembled pose decides.
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
            "they must be equal, so add or remove joints or links, or state pose.coordinate"
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


def freedom(pose: Pose) -> int:
    """Degrees of freedom of the pose: unknowns less the rank of the closure's Jacobian."""
    scale = pose.linkage.longest
    sizes = np.array([1.0] * len(pose.linkage.moving) + [scale] * len(pose.closure.slots))
    matrix = pose.closure.jacobian(pose.q) * sizes / scale
    return pose.closure.unknowns - int(np.linalg.matrix_rank(matrix, tol=_RANK_TOLERANCE))


@dataclass(frozen=True, kw_only=True)
class _Held:
    """The unknown that fixes the pose: its name, its column and its value [rad, mm]."""

    name: str
    column: int
    value: float
    slides: bool

    @classmethod
    def of(cls, linkage: Linkage, name: str, angle: float, travel: float | None) -> "_Held":
        if travel is None:
            return cls(name=name, column=linkage.moving.index(name), value=angle, slides=False)
        slots = LoopClosure(linkage).slots
        if name not in slots:
            raise CaseError(
                f"pose.coordinate: '{name}' is no slider or slot, but a travel is stated for it; choose among "
                f"{', '.join(slots) or 'none'}, or state the angle of a link"
            )
        return cls(name=name, column=len(linkage.moving) + slots.index(name), value=travel, slides=True)

    def __str__(self) -> str:
        value = f"a travel of {self.value:.6g} mm" if self.slides else f"{math.degrees(self.value):.6g} deg"
        return f"{self.name} at {value}"


def _assemble(linkage: Linkage, held: _Held | None, near: dict[str, float]) -> Pose:
    closure = LoopClosure(linkage)
    free = [link for link in linkage.moving if held is None or held.slides or link != held.name]

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
    if held is None or pose.dead_point_distance(held.name, slides=held.slides) > NEAR_DEAD_POINT:
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
            f"{'travel' if held.slides else 'angle'}"
        )


def _pose(closure: LoopClosure, q: Real, held: _Held | None, gaps: Real) -> Pose:
    return Pose(
        linkage=closure.linkage,
        q=q,
        coordinate=None if held is None else held.name,
        residual=float(np.max(np.abs(gaps), initial=0.0)) / closure.linkage.longest,
        slides=held is not None and held.slides,
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
    change = "travel" if held is not None and held.slides else "angle"
    return f"pose: the linkage cannot be assembled{at}: {where}; change the {change} or the links' lengths"
