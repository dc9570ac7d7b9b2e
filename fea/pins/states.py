"""How pins may stand between layers: the state of the stated clearances, and those in which links bear most and least.

What each hole may be between is open. A joint force is a function of the radii that is neither convex nor monotonic,
so that its ends are sought: thrusts and the stress of each pin and each link are followed upwards
and downwards (``alula.fea.pins.aims``, ``alula.fea.pins.ascent``), on the path of the interior point method first,
where rims do not quite touch. All states that are met on the way tell of all of them.
"""

import math
from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.linear import FrameSolution
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.pins.aims import Aims, Nearest, aims_of
from alula.fea.pins.ascent import ascend
from alula.fea.pins.clearances import Radii, clearances_of, furthest, head_gaps, pin_size, radii_of
from alula.fea.pins.holes import RimFrame, faces_of, rims_of
from alula.fea.pins.programme import InDiscs, least_in_discs, slopes
from alula.fea.pins.tangent import RimTangent, tangent_of
from alula.geometry.base.errors import CannotRunError
from alula.geometry.joints.fits import RUNNING, fit
from alula.loads.case.case import Case
from alula.loads.records.applied import load_size
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]
Index = NDArray[np.int64]

SLIGHT = 1e-8
"""Deformation over clearance below which rounding tells more about pins than loads do."""
LEVELS = (0.0, 0.01, 0.1, 0.5, 1.0)
"""Shares of all that is open at which the search starts, beside the values. These states are kept whether or not some
couple is largest in them."""
DRAWS = 300
"""Further states at which the search starts, drawn at random, most clearances at an end or near the lower one."""
STAGES = ((1e-3, 4, 1e-3), (1e-4, 2, 1e-4))
"""Of the search, one after the other: the residual at which its states end, from how many of the largest ones each
function is followed, and down to which gain, over the range of the starts. Some way before rims touch, they are smooth
functions of the radii with fewer local ends, and their slopes are known to 1e-6 and better; at 1e-8 they are known
less well, where it is open whether a rim touches."""
ROUGH = 1e-8
"""Residual at which couples are known to 1e-10, so that it tells in which of the states found they are largest."""
ALIKE = 1e-6
"""Share of a couple by which states are told apart: of those within it the first one stands for all, whatever rounding
makes of them."""
NOTHING = 1e-9
"""Share of the largest couple below which there is none but by rounding."""
LEAST_RADIUS = 1e-7
"""Of a disc, in place of none, so that what a wider hole would make can be told [mm]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PinStates:
    """States of the pins of a frame.

    Attributes
    ----------
    rims : RimFrame
    radii : Radii
    like : PinStates or None
        Those of nearly these pose and loads, or of wider holes: the search starts at the shares that it found there,
        without draws.
    """

    rims: RimFrame
    radii: Radii
    like: "PinStates | None" = None

    def beside(self, like: "PinStates") -> "PinStates":
        """Return the same, with the search to start where that of nearly the same pose and loads ended.

        Parameters
        ----------
        like : PinStates

        Returns
        -------
        PinStates
            Unless other holes are open there.
        """
        return replace(self, like=like) if like.radii.clearances == self.radii.clearances else self

    def solved(self, shares: Real) -> InDiscs:
        """Return where pins stand.

        Parameters
        ----------
        shares : ndarray, shape (n, k)
            Of what is open.

        Returns
        -------
        InDiscs
        """
        radii, _ = self.radii.of(shares)
        return least_in_discs(self.rims.K, self.rims.g, radii, ties=self.radii.ties)

    def answer(self, v: Real) -> FrameSolution:
        """Return the frame's answer with its pins as they stand.

        Parameters
        ----------
        v : ndarray, shape (4 h,)

        Returns
        -------
        FrameSolution
            Its displacements hold what pins move and tilt without any strain.
        """
        return self.rims.solved.solved(self.rims.opened @ v)

    def reactions(self, v: Real) -> Reactions:
        """Return the joint forces with the pins as they stand.

        Parameters
        ----------
        v : ndarray, shape (4 h,)

        Returns
        -------
        Reactions
        """
        found = self.answer(v)
        return self.rims.frame.reactions(found.joint_wrenches, found.residual)

    @cached_property
    def value(self) -> Real:
        """(4 h,) where pins stand with the values of all clearances."""
        return np.asarray(self.solved(self.radii.value[None]).v[0])

    @cached_property
    def aims(self) -> Aims:
        """What is sought: ends of thrusts, of couples on links without a beam, and of the stress of links and pins."""
        return aims_of(self.rims.couples @ self.rims.by_rims, self.rims.beam_ends, self.rims.noise)

    @cached_property
    def _told(self) -> tuple[Real, Real]:
        """Shares, and where pins stand by them, of ``states``."""
        shares = self.extremes
        found = self.solved(shares).v
        alike = np.arange(1, min(1 + len(LEVELS), len(found)))
        kept = np.union1d(_telling(self.aims.values(found)), alike) if self.aims.count else np.array([0])
        return shares[kept], found[kept]

    @property
    def states(self) -> Real:
        """(n, 4 h) where pins stand where some couple is largest or least, and where all holes are alike."""
        return self._told[1]

    def tangent(self, shares: Real, v: Real) -> RimTangent:
        """Return how pins may move on from where they stand.

        Parameters
        ----------
        shares : ndarray, shape (k,)
            Of what is open.
        v : ndarray, shape (4 h,)
            Where pins stand by them.

        Returns
        -------
        RimTangent
        """
        radii = self.radii.of(shares[None])[0][0]
        return tangent_of(radii, v, self.rims.g - self.rims.K @ v, self.radii.ties)

    def leaning(self, small: float) -> tuple[RimTangent, ...]:
        """Return how pins may move on where the linkage may lean: in ``states`` and in these with one hole otherwise.

        In ``states`` pins bear most, and so hold most. In those the linkage leans most where some hole is at either end
        of what it may be, one at a time.

        Parameters
        ----------
        small : float
            How far no point of the linkage moves by rims in states that are left out [mm].

        Returns
        -------
        tuple of RimTangent
        """
        shares = self._told[0]
        every = _distinct(np.vstack([shares, _at_ends(shares)]))[0] if len(self.radii.value) else shares
        wide = every[self.reaches(self.radii.of(every)[0]) > small]
        return (
            tuple(self.tangent(one, v) for one, v in zip(wide, self.solved(wide).v, strict=True)) if len(wide) else ()
        )

    @property
    def standing(self) -> tuple[Real, Real]:
        """Radii (n + 1, d) of all discs, and where pins stand (n + 1, 4 h): of the values first, then of ``states``."""
        shares, states = self._told
        return self.radii.of(np.vstack([self.radii.value, shares]))[0], np.vstack([self.value, states])

    def reaches(self, radii: Real) -> Real:
        """Return how far rims and heads let a point move at most, wherever pins stand; it grows with every radius.

        Parameters
        ----------
        radii : ndarray, shape (n, d)
            Of all discs [mm].

        Returns
        -------
        ndarray, shape (n,)
            [mm]
        """
        moved = self.rims.solved.displacements(self.rims.opened)[:, :3]
        by_rims, holes = moved.reshape(*moved.shape[:2], -1, 2, 2), len(self.rims.holes)
        radius, between = radii[:, : 2 * holes : 2], self.radii.ties[:, 0] // 2
        apart = np.full(radius.shape, 2.0)
        apart[:, between] = radii[:, 2 * holes :] / np.maximum(radius[:, between], LEAST_RADIUS)
        each = np.einsum("sh,snah->sna", radius, furthest(by_rims, apart[:, None, None]))
        return np.asarray(np.linalg.norm(each, axis=2).max(axis=1))

    @cached_property
    def answers(self) -> tuple[FrameSolution, ...]:
        """The frame's answers with the values of all clearances first, then in ``states``."""
        return tuple(self.answer(v) for v in (self.value, *self.states))

    def least(self, link: str) -> int | None:
        """Return the number of that one of ``states`` in which the plain sections of a link bear least.

        Parameters
        ----------
        link : str

        Returns
        -------
        int or None
            None of a link without a beam, and of one that bears the same in all.
        """
        owners = tuple(dict.fromkeys(self.aims.ends.owners))
        if ("link", link) not in owners:
            return None
        return int(self.aims.stresses(self.states)[:, owners.index(("link", link)) - len(owners)].argmax())

    def tried(self, shares: Real) -> dict[tuple[str, str], float]:
        """Return the plain stress of each link and pin where it is largest in some states, without a search.

        Parameters
        ----------
        shares : ndarray, shape (n, k)
            Of what is open, such as the ``extremes`` of another pose.

        Returns
        -------
        dict of tuple of 2 str to float
            "link" or "pin", and its name -> stress [MPa].
        """
        every = self.aims.ends.owners
        largest = -self.aims.stresses(self._stands(shares, STAGES[0][0])[1].v)[:, len(every) :]
        return dict(zip(dict.fromkeys(every), largest.max(axis=0).tolist(), strict=True))

    @cached_property
    def ends(self) -> tuple[Reactions, ...]:
        """Joint forces in ``states``."""
        return tuple(self.rims.frame.reactions(one.joint_wrenches, one.residual) for one in self.answers[1:])

    @cached_property
    def extremes(self) -> Real:
        """(n, k) the shares at which what is sought is largest, after that of the values and those of ``LEVELS``."""
        value, aims = self.radii.value, self.aims
        if not len(value) or not aims.count:
            return value[None]
        alike = np.outer(LEVELS, np.ones(len(value)))
        if self.like is None:
            starts = self._followed(np.vstack([value, alike, _drawn(DRAWS, len(value))]), aims, *STAGES[0])
            starts = self._beside(starts, aims, STAGES[0][0])
        else:
            starts = np.vstack([value, alike, self.like.extremes])
        starts = self._followed(starts, aims, *STAGES[1])
        reached = aims.values(self._stands(starts, ROUGH)[1].v)
        return np.vstack([value, alike, starts[np.unique(_graded(reached, np.ptp(reached, axis=0)).argmax(axis=0))]])

    def moves(self, node: int) -> Real:
        """Return how a node moves by where pins stand.

        Parameters
        ----------
        node : int

        Returns
        -------
        ndarray, shape (3, 4 h)
        """
        return np.asarray(self.rims.solved.displacements(self.rims.opened)[node, :3])

    def nearest(self, node: int, tight: Real) -> Real:
        """Return states of the pins in which a node moves least, sought from those that tell of all else.

        Parameters
        ----------
        node : int
        tight : ndarray, shape (n, 3)
            What it may move with tight pins [mm].

        Returns
        -------
        ndarray, shape (m, 4 h)
        """
        value = self.radii.value
        if not len(value):
            return self.value[None]
        starts = np.vstack([self.extremes, np.outer(LEVELS, np.ones(len(value)))])
        aims = Nearest(tight=tight, by_rims=self.moves(node))
        for close, _, near in STAGES:  # from all of the starts: they are few, and some lead to ends of their own
            starts = self._followed(starts, aims, close, len(starts), near)
        return np.asarray(self.solved(starts).v)

    def _followed(self, starts: Real, aims: Aims | Nearest, close: float, paths: int, near: float) -> Real:
        """Shares where functions of where pins stand are largest, of all that are met, then where ways end."""
        met, reached = [starts], [aims.values(self._stands(starts, close)[1].v)]
        spread = np.ptp(reached[0], axis=0)
        first = np.argsort(-_graded(reached[0], spread), axis=0, kind="stable")[:paths].ravel()
        aim = np.tile(np.arange(aims.count), paths)

        def evaluate(shares: Real, which: Index) -> tuple[Real, Real]:
            known, state = _distinct(shares)
            radii, at = self._stands(known, close)
            by_radii = slopes(self.rims.K, radii, at, state, aims.slopes(at.v[state], aim[which]), self.radii.ties)
            met.append(known)
            reached.append(aims.values(at.v))
            return reached[-1][state, aim[which]], np.einsum("akr,ar->ak", self.radii.of(known)[1][state], by_radii)

        ends = ascend(starts[first], evaluate, near * spread[aim])
        largest = _graded(np.vstack(reached), spread).argmax(axis=0)
        return _distinct(np.vstack([np.vstack(met)[np.unique(largest)], ends]))[0]

    def _beside(self, shares: Real, aims: Aims, close: float) -> Real:
        """Shares, and those in which some function is largest with each one at either end, one at a time.

        A hole whose rims do not touch has no slope, however much more a narrower one would bear.
        """
        best = shares[np.unique(aims.values(self._stands(shares, close)[1].v).argmax(axis=0))]
        return _distinct(np.vstack([shares, _at_ends(best)]))[0]

    def _stands(self, shares: Real, close: float) -> tuple[Real, InDiscs]:
        radii = np.maximum(self.radii.of(shares)[0], LEAST_RADIUS)
        return radii, least_in_discs(self.rims.K, self.rims.g, radii, close, self.radii.ties)


def _drawn(count: int, shares: int) -> Real:
    draw = np.random.default_rng(0)
    between, kind = draw.uniform(size=(count, shares)), draw.integers(4, size=(count, shares))
    return np.asarray(np.choose(kind, (between, np.zeros_like(between), np.ones_like(between), between**6)))


def _at_ends(shares: Real) -> Real:
    """Shares (m, k) of states (n, k) with each one at either end, one at a time."""
    count = shares.shape[1]
    ends = np.where(np.eye(count, dtype=bool), np.array([0.0, 1.0])[:, None, None, None], shares[:, None])
    return ends.reshape(-1, count)


def _distinct(rows: Real) -> tuple[Real, Index]:
    """Rows without those that stood before, in their order, and the number of each one's among them."""
    _, first, number = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    return rows[first[order]], np.argsort(order)[number.ravel()]


def _graded(values: Real, size: Real) -> Real:
    """Values (n, c) in steps of ``ALIKE`` of their sizes (c,), so that rounding does not tell which one is largest."""
    return np.round(values / (ALIKE * np.maximum(size, NOTHING * size.max(initial=0.0) or 1.0)))


def _telling(values: Real) -> Index:
    """Numbers of the fewest states found in which each of some functions (n, c) is largest."""
    steps = _graded(values, np.abs(values).max(axis=0))
    near = steps == steps.max(axis=0)
    found, rest = list[int](), np.ones(near.shape[1], dtype=bool)
    while rest.any():
        best = int(near[:, rest].sum(axis=1).argmax())
        found.append(best)
        rest &= ~near[best]
    return np.array(found, dtype=np.int64)


def pin_states(case: Case, frame: LinkageFrame) -> PinStates | None:
    """Return how the pins of a frame may stand in their holes.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
        With pins that are tight in both links.

    Returns
    -------
    PinStates or None
        None where no pin between layers may run.
    """
    open_holes = clearances_of(case, frame)
    if not open_holes:
        return None
    rims = {hole: rims_of(case, *hole) for one in open_holes for hole in one.holes}
    condensed = RimFrame.of(frame, rims, faces_of(case, frame))
    names = [[(joint, hole.link) for joint in hole.joints] for hole in condensed.holes]
    return PinStates(rims=condensed, radii=radii_of(open_holes, names, head_gaps(case, condensed.holes)))


def refuse_slight(pins: PinStates) -> None:
    """Refuse loads that are so small beside the links' stiffness that rounding tells where pins stand.

    Parameters
    ----------
    pins : PinStates
        Under loads that are judged; at a pose of a motion at which hardly anything acts, nothing depends on pins.

    Raises
    ------
    CannotRunError
        With how much larger they must be.
    """
    rims, radii = pins.rims, pins.radii
    widest = radii.of(np.ones((1, len(radii.value))))[0].max(initial=0.0)
    size, stiff = (float(np.abs(one).max(initial=0.0)) for one in (rims.g, rims.K))
    felt = SLIGHT * load_size(rims.frame.loads, max((hole.high - hole.low for hole in rims.holes), default=1.0))
    if felt < size < SLIGHT * widest * stiff:
        raise CannotRunError(
            "how pins stand in their holes was not found: loads are too small for it, since they deform the links by "
            f"less than {SLIGHT:g} of the clearances; state loads at least {math.ceil(SLIGHT * widest * stiff / size)} "
            "times as large, since stresses under small loads are in proportion to them"
        )


def unstated(case: Case, pins: PinStates) -> tuple[str, ...]:
    """Return the joints that do not state how their pins sit in some hole between layers.

    Parameters
    ----------
    case : Case
    pins : PinStates

    Returns
    -------
    tuple of str
    """
    open_holes = [hole for one in pins.radii.clearances for hole in one.holes]
    known = {name: case.linkage.pin_holes(name) for name, _ in open_holes}
    return tuple(dict.fromkeys(name for name, link in open_holes if not known[name][link].stated))


def running(case: Case, pins: PinStates, joints: Collection[str], *, like: PinStates | None = None) -> PinStates:
    """Return the states of pins that would run in the holes of some joints of which nothing is stated.

    Parameters
    ----------
    case : Case
    pins : PinStates
    joints : collection of str
    like : PinStates, optional
        Where the search starts; it is then quicker, and may miss a part of the ends.

    Returns
    -------
    PinStates
    """
    found = []
    for one in pins.radii.clearances:
        [name, link] = one.holes[0]
        if name in joints and not case.linkage.pin_holes(name)[link].stated:
            low, high = fit(RUNNING, pin_size(case, name)).bounds
            one = replace(one, low=low, value=(low + high) / 2.0, high=high)
        found.append(one)
    return replace(pins, radii=replace(pins.radii, clearances=tuple(found)), like=like)
