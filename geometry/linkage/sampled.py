"""A linkage whose points are elsewhere in each of n samples: loop closure, assembly and placement of all at once."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose_record import CLOSED, Pose
from alula.geometry.linkage.sampled_dead_points import dead_points, own_dead_point

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Shifts = Mapping[tuple[str, str], Complex]

_ITERATIONS = 12
_STEPS = 8
"""In which samples that Newton's iteration did not close at once are led there from the nominal pose."""
_TARGET = 1e-13
_LARGEST_STEP = 0.5


@dataclass(frozen=True, eq=False)
class SampledClosure(LoopClosure):
    """The closure equations with points shifted in each sample.

    Rows of the closure are linear in the places of the points, so each shift adds its part.

    Attributes
    ----------
    shifts : mapping of (str, str) to complex array (n,)
        Link and point -> shift in the link's frame [mm].
    moved : mapping of (str, str) to LoopClosure
        Link and point -> the nominal closure with that point 1 mm further along x.
    """

    shifts: Shifts
    moved: Mapping[tuple[str, str], LoopClosure]

    @classmethod
    def of(cls, linkage: Linkage, shifts: Shifts) -> "SampledClosure":
        """Return the closure of shifted points.

        Parameters
        ----------
        linkage : Linkage
        shifts : mapping of (str, str) to complex array (n,)
            [mm]

        Returns
        -------
        SampledClosure
        """
        return cls(linkage, dict(shifts), {at: LoopClosure(_moved(linkage, at)) for at in shifts})

    @cached_property
    def _nominal(self) -> LoopClosure:
        return LoopClosure(self.linkage)

    def _shifted(self, name: str) -> Complex:
        """Rows (n, rows, columns) of all samples."""
        base = getattr(self._nominal, name)
        found = np.asarray(base)[None]
        for at, shift in self.shifts.items():
            found = found + shift[:, None, None] * (getattr(self.moved[at], name) - base)
        return np.asarray(found)

    @cached_property
    def _loop_rows(self) -> Complex:
        return self._shifted("_loop_rows")

    @cached_property
    def _point_rows(self) -> Complex:
        return self._shifted("_point_rows")

    @cached_property
    def _origin_rows(self) -> Complex:
        return self._shifted("_origin_rows")

    def _evaluate(self, rows: Complex, q: Real) -> Complex:
        links = len(self.linkage.moving) + 1
        e, along = self._directions(q)
        slides = q[..., len(self.linkage.moving) :] * along
        values = np.concatenate([e, slides], axis=-1)
        assert values.shape[-1] == rows.shape[-1] == links + len(self.slots)
        return np.asarray(np.einsum("nrc,nc->nr", rows, values))

    def _derivative(self, rows: Complex, q: Real) -> Complex:
        moving, links = len(self.linkage.moving), len(self.linkage.moving) + 1
        e, along = self._directions(q)
        out = np.empty((len(q), rows.shape[-2], self.unknowns), dtype=complex)
        out[..., :moving] = 1j * rows[..., :moving] * e[..., None, :moving]
        for k, link in enumerate(self.slot_links):
            column = rows[..., links + k] * along[..., None, k]
            out[..., moving + k] = column
            if link < moving:
                out[..., link] += 1j * q[..., None, moving + k] * column
        return out

    def _quadratic(self, rows: Complex, q: Real, qdot: Real) -> Complex:
        moving = len(self.linkage.moving)
        e, along = self._directions(q)
        spin = np.zeros(e.shape)
        spin[..., :moving] = qdot[..., :moving]
        turn, travel, rate = spin[..., self.slot_links], q[..., moving:], qdot[..., moving:]
        values = np.concatenate([-(spin**2) * e, (2j * rate * turn - travel * turn**2) * along], axis=-1)
        return np.asarray(np.einsum("nrc,nc->nr", rows, values))

    def chosen(self, samples: NDArray[Any]) -> "SampledClosure":
        """Return the closure of some samples.

        Parameters
        ----------
        samples : mask (n,) or numbers

        Returns
        -------
        SampledClosure
        """
        found = replace(self, shifts={at: shift[samples] for at, shift in self.shifts.items()})
        rows = self._loop_rows
        found.__dict__["_loop_rows"] = rows if len(rows) == 1 else rows[samples]  # instead of summing them anew
        return found

    def share(self, part: float) -> "SampledClosure":
        """Return the closure with a part of all shifts.

        Parameters
        ----------
        part : float

        Returns
        -------
        SampledClosure
        """
        return replace(self, shifts={at: part * shift for at, shift in self.shifts.items()})


@dataclass(frozen=True, kw_only=True, eq=False)
class SampledPlacement(Placement):
    """Where the links of each sample stand.

    Attributes
    ----------
    closure : SampledClosure
    """

    closure: SampledClosure

    def chosen(self, poses: Any) -> "SampledPlacement":
        """Return the chosen samples alone.

        Parameters
        ----------
        poses : mask or numbers (n,)
            Which of the n samples.

        Returns
        -------
        SampledPlacement
            At these.
        """
        rates = {name: rate[poses] for name in ("qdot", "qddot") if (rate := getattr(self, name)) is not None}
        return SampledPlacement(closure=self.closure.chosen(poses), q=self.q[poses], **rates)

    def arm(self, link: str, point: str) -> Complex:
        """Arm (n,) from the origin of a link's frame to one of its points as it is in each sample, global axes [mm].

        Parameters
        ----------
        link, point : str

        Returns
        -------
        complex array (n,)
        """
        local = complex(*self.linkage.links[link].points[point]) + self.closure.shifts.get((link, point), 0.0)
        return np.asarray(self.direction(link) * local)


def _moved(linkage: Linkage, at: tuple[str, str]) -> Linkage:
    """Return the linkage with one point 1 mm further along x of its link."""
    link, point = at
    record = linkage.links[link]
    x, y = record.points[point]
    points = {**record.points, point: (x + 1.0, y)}
    return Linkage(
        {**linkage.links, link: record.model_copy(update={"points": points})}, linkage.joints, linkage.heights
    )


def assemble_samples(pose: Pose, shifts: Shifts, value: Real) -> tuple[SampledPlacement, NDArray[np.bool_], Real]:
    """Assemble every sample on the branch of a nominal pose.

    Parameters
    ----------
    pose : Pose
        The nominal one.
    shifts : mapping of (str, str) to complex array (n,)
        Of points in their links' frames [mm].
    value : array (n,)
        Shift of the pose's coordinate [rad, mm].

    Returns
    -------
    tuple of (SampledPlacement, ndarray of bool, shape (n,), ndarray, shape (n,))
        Where links stand, which samples assemble, and by how much the branch of a sample that does not ends at a dead
        point before its value of the coordinate [rad, mm]; NaN for all others.
    """
    closure = SampledClosure.of(pose.linkage, shifts)
    q, free = np.tile(pose.q, (len(value), 1)), np.ones(len(pose.q), dtype=np.bool_)
    if pose.coordinate is not None:
        free[pose.held_column] = False
        q[:, pose.held_column] += value
    found, done = _newton(closure, q, free)
    done &= _same_branch(pose, closure, found, free)
    if not done.all():
        lost = np.flatnonzero(~done)
        found[lost], done[lost] = _led(pose, closure.chosen(lost), value[lost], free)
    short = np.full(len(value), np.nan)
    if not done.all():
        lost = np.flatnonzero(~done)
        found[lost], done[lost], short[lost] = _at_dead_points(pose, closure.chosen(lost), value[lost], free)
    return SampledPlacement(closure=closure, q=found), done, short


def _newton(closure: SampledClosure, q: Real, free: NDArray[np.bool_]) -> tuple[Real, NDArray[np.bool_]]:
    """Close the loops of every sample; also tell where that succeeded."""
    scale, q, left = closure.linkage.longest, q.copy(), np.arange(len(q))
    weights = np.array([1.0] * len(closure.linkage.moving) + [scale] * len(closure.slots))[free]
    gap, part = np.zeros(len(q)), closure
    for iteration in range(_ITERATIONS + 1):
        gaps = part.residual(q[left])
        gap[left] = np.abs(gaps).max(axis=-1, initial=0.0)
        open_yet = gap[left] > _TARGET * scale
        if iteration == _ITERATIONS or not open_yet.any():
            break
        left, gaps, part = left[open_yet], gaps[open_yet], part if open_yet.all() else part.chosen(open_yet)
        step = np.clip(_solved(part.jacobian(q[left])[..., free] * weights, -gaps), -_LARGEST_STEP, _LARGEST_STEP)
        q[np.ix_(left, free)] += np.where(np.isfinite(step), step, 0.0) * weights
    return q, gap <= CLOSED * scale


def _solved(J: Real, right: Real) -> Real:
    if J.shape[-1] == J.shape[-2]:
        try:
            return np.asarray(np.linalg.solve(J, right[..., None])[..., 0])
        except np.linalg.LinAlgError:
            pass
    return np.asarray((np.linalg.pinv(J, rcond=1e-13) @ right[..., None])[..., 0])


def _same_branch(pose: Pose, closure: SampledClosure, q: Real, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tell where the Jacobian's determinant has its nominal sign: it changes at a dead point of the coordinate."""
    J = closure.jacobian(q)[..., free]
    if J.shape[-1] != J.shape[-2] or not J.shape[-1]:
        return np.ones(len(q), dtype=np.bool_)
    nominal = np.linalg.slogdet(pose.closure.jacobian(pose.q)[..., free])[0]
    return np.asarray(np.linalg.slogdet(J)[0] == nominal)


def _led(pose: Pose, closure: SampledClosure, value: Real, free: NDArray[np.bool_]) -> tuple[Real, NDArray[np.bool_]]:
    """Lead samples from the nominal pose to their own in small steps; one that is lost on the way is left."""
    q, left = np.tile(pose.q, (len(value), 1)), np.arange(len(value))
    for step in range(1, _STEPS + 1):
        here = closure.chosen(left).share(step / _STEPS)
        if pose.coordinate is not None:
            q[left, pose.held_column] = pose.q[pose.held_column] + value[left] * (step / _STEPS)
        q[left], closed = _newton(here, q[left], free)
        left = left[closed & _same_branch(pose, here, q[left], free)]
        if not len(left):
            break
    done = np.zeros(len(value), dtype=np.bool_)
    done[left] = True
    return q, done


def _at_dead_points(
    pose: Pose, closure: SampledClosure, value: Real, free: NDArray[np.bool_]
) -> tuple[Real, NDArray[np.bool_], Real]:
    """Solve samples from their own dead points, which are near to that of the nominal linkage."""
    q, there = np.tile(pose.q, (len(value), 1)), own_dead_point(pose)
    if there is None:
        return q, np.zeros(len(value), dtype=np.bool_), np.full(len(value), np.nan)
    wanted = pose.q[pose.held_column] + value
    points = dead_points(closure, np.tile(there, (len(value), 1)), pose.held_column)
    short = points.short(wanted)
    q, done = _newton(closure, points.beside(wanted, pose.q - there), free)
    done &= (short <= 0.0) & _same_branch(pose, closure, q, free)
    return q, done, np.where(done | ~(short > 0.0), np.nan, short)
