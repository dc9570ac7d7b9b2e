"""Life under a stress that varies: cycles by rainflow, mean stress by Goodman or the material's own rule, Miner's sum.

The measure of stress for brittle materials is the principal stress of largest size. For ductile ones it is the von
Mises stress with the sign of that principal stress. Both assume that the principal directions do not turn within a
cycle. Goodman's line needs no more than the ultimate strength, and lies below tests of most metals (the abstract of
Dowling, Calhoun and Arcari 2009), so that it errs on the safe side.

References
----------
ASTM E1049-85, sections 5.4.4 and 5.4.5.
Shigley's Mechanical Engineering Design, 10th ed., chapter 6.
Dowling, Calhoun & Arcari, Mean stress effects in stress-life fatigue and the Walker equation, Fatigue Fract. Engng.
Mater. Struct. 32 (2009) 163-179.
Peterson's notch sensitivity q = 1/(1 + a/r): as lecture notes on fatigue print it, with a of 0.51 mm for aluminium
alloys, 0.25 mm for low-carbon steels, 0.064 mm for quenched and tempered ones.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, fatigue_scatter, strength_scatter
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.solid.stress import extreme_principal, von_mises
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Fatigue, Material
from alula.geometry.parts.part import Body
from alula.loads.records.check_spec import FatigueCheck
from alula.loads.records.load_case import Block

Real = NDArray[np.float64]

NEGLIGIBLE = 0.05
"""Cycles with a smaller range than this share of the largest range are left out, or ripples would count as peaks."""
STRESS_FACTOR = float(FatigueCheck.model_fields["minimum"].default)
LIFE_FACTOR = 4.0
"""Default limits: on stress at the wanted number of cycles, and on life."""
LEAST_CONCENTRATION = 5.0 / 3.0
"""Of a round hole: (5 + 3 ν)/(3 + ν) of a wide thin plate that is bent out of its plane, at ν = 0. It is 2 or more in a
strip that is pulled or bent in its plane, and beside a pin (Peterson's Stress Concentration Factors, chapter 4)."""
AT_WALL = 0.05
"""Share of a hole's radius within which a place counts as its wall."""
NOTCH = Source(kind=SourceKind.NOTCH, detail=reason("notch_sensitivity_of_hole"))


def signed_stress(stress: Real, *, brittle: bool) -> Real:
    """Return the signed measure of stress, as the module says.

    Parameters
    ----------
    stress : ndarray, shape (..., 6)
        Components [MPa].
    brittle : bool

    Returns
    -------
    ndarray, shape (...)
        [MPa]
    """
    first, last = extreme_principal(stress)
    largest = np.where(np.abs(first) >= np.abs(last), first, last)
    return np.asarray(largest if brittle else np.copysign(von_mises(stress), largest))


def closed_history(history: Real, *, returns: bool) -> Real:
    """Return one repetition of a motion's history: a full turn or a cycle, or there and back.

    Parameters
    ----------
    history : ndarray, shape (n,)
        At the poses of the motion.
    returns : bool
        True where the last pose is the first again, or goes on to it.

    Returns
    -------
    ndarray, shape (k,)
    """
    return history if returns else np.concatenate([history, history[-2:0:-1]])


def not_closed(evaluated: NDArray[np.bool_]) -> Reason | None:
    """Return why the stress over a motion is no closed history; None where it is.

    Parameters
    ----------
    evaluated : ndarray of bool, shape (n,)
        The poses that count.

    Returns
    -------
    Reason or None
    """
    return None if evaluated.all() else reason("history_not_closed")


def turning_points(history: Real) -> Real:
    """Return peaks and valleys of a history, its ends included.

    Parameters
    ----------
    history : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (k,)
    """
    values = history[np.concatenate([[True], np.diff(history) != 0.0])]
    if len(values) < 3:
        return np.asarray(values)
    slopes = np.sign(np.diff(values))
    return np.asarray(values[np.concatenate([[True], slopes[1:] != slopes[:-1], [True]])])


def rainflow(history: Real) -> Real:
    """Count the cycles of a history.

    ASTM E1049-85, section 5.4.4: of the last three points the ranges Y (earlier) and X (later) are compared. If X ≥ Y,
    Y counts as a half cycle where it contains the first point, else as a full one.

    Parameters
    ----------
    history : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (k, 3)
        Range, mean and count (1 or ½) of each, in the order in which they close.
    """
    found: list[tuple[float, float, float]] = []
    points: list[float] = []

    def note(a: float, b: float, count: float) -> None:
        found.append((abs(a - b), (a + b) / 2.0, count))

    for value in turning_points(history):
        points.append(float(value))
        while len(points) >= 3:
            if abs(points[-1] - points[-2]) < abs(points[-2] - points[-3]):
                break
            if len(points) == 3:
                note(points[0], points[1], 0.5)
                del points[0]
            else:
                note(points[-3], points[-2], 1.0)
                del points[-3:-1]
    for a, b in itertools.pairwise(points):
        note(a, b, 0.5)
    return np.array(found).reshape(-1, 3)


def repeated_cycles(history: Real) -> Real:
    """Count the cycles of one repetition of a history that repeats for ever.

    ASTM E1049-85, section 5.4.5: the history is begun at its largest value, so that every cycle closes.

    Parameters
    ----------
    history : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (k, 3)
        Range, mean and count of each.
    """
    start = first_largest(history)
    whole = np.concatenate([history[start:], history[: start + 1]])
    halves = rainflow(whole)
    found: dict[tuple[float, float], float] = {}
    for size, mean, count in halves.tolist():
        if size > 0.0:
            found[size, mean] = found.get((size, mean), 0.0) + count
    return np.array([(size, mean, count) for (size, mean), count in found.items()]).reshape(-1, 3)


def reversed_amplitude(cycles: Real, ultimate: float) -> Real:
    """Return the amplitudes of reversed cycles that harm as much, by Goodman: σa / (1 − σm/Su).

    A compressive mean counts as none (Shigley's Mechanical Engineering Design, 10th ed., chapter 6).

    Parameters
    ----------
    cycles : ndarray, shape (k, 3)
        Range, mean [MPa] and count of each.
    ultimate : float
        Strength Su [MPa].

    Returns
    -------
    ndarray, shape (k,)
        [MPa]; infinite where the mean reaches the ultimate strength.
    """
    amplitude, mean = cycles[:, 0] / 2.0, np.maximum(cycles[:, 1], 0.0)
    with np.errstate(divide="ignore"):
        return np.where(mean < ultimate, amplitude / np.maximum(1.0 - mean / ultimate, 0.0), np.inf)


def equivalent_peak(cycles: Real, fatigue: Fatigue, ultimate: float | None) -> Real:
    """Return the peak stresses of cycles of the test's stress ratio R that harm as much as the given ones.

    By the peak-stress rule it is the cycle's own peak, and zero where that is compressive. By Goodman's rule it is the
    σ at which σ (1 − R)/2 / (1 − σ (1 + R)/(2 Su)) = σr, with the reversed amplitude σr.

    Parameters
    ----------
    cycles : ndarray, shape (k, 3)
        Range, mean [MPa] and count of each.
    fatigue : Fatigue
        Of the material's card.
    ultimate : float or None
        Strength Su [MPa], which Goodman's rule needs.

    Returns
    -------
    ndarray, shape (k,)
        [MPa]
    """
    if fatigue.rule == "peak-stress":
        return np.maximum(cycles[:, 1] + cycles[:, 0] / 2.0, 0.0)
    assert ultimate is not None
    return _peak(reversed_amplitude(cycles, ultimate), fatigue.stress_ratio, ultimate)


def _peak(amplitude: Real, stress_ratio: float, ultimate: float) -> Real:
    """Return the peaks of cycles of one stress ratio that by Goodman's line harm as much as reversed amplitudes."""
    share, ratio = (1.0 - stress_ratio) / 2.0, (1.0 + stress_ratio) / (2.0 * ultimate)
    finite = np.isfinite(amplitude)
    safe = np.where(finite, amplitude, 0.0)
    limit = 1.0 / ratio if ratio > 0.0 else np.inf
    return np.where(finite, safe / (share + safe * ratio), limit)


def cycles_to_failure(stress: Real, fatigue: Fatigue) -> Real:
    """Return N = N1 (σ/(s σ1))^(−exponent) with the surface factor s.

    By Miner's elementary rule the line has no end once one stress is above the endurance limit.

    Parameters
    ----------
    stress : ndarray, shape (k,)
        Peaks of cycles of the test's stress ratio [MPa].
    fatigue : Fatigue
        Of the material's card, with an exponent.

    Returns
    -------
    ndarray, shape (k,)
        Infinite without stress, and where none is above the endurance limit.
    """
    assert fatigue.exponent is not None
    endless = fatigue.endurance_cycles
    if endless is not None and np.max(stress, initial=0.0) <= (strength_at(fatigue, endless) or 0.0):
        return np.full(np.shape(stress), np.inf)
    with np.errstate(divide="ignore", over="ignore"):
        own = fatigue.surface_factor * fatigue.stress
        return np.asarray(fatigue.cycles * (stress / own) ** -fatigue.exponent)


def missing_data(material: Material) -> Reason | None:
    """Return what the card lacks for a fatigue calculation.

    Parameters
    ----------
    material : Material

    Returns
    -------
    Reason or None
        None if nothing.
    """
    if material.fatigue is None:
        return reason("no_fatigue_data")
    if material.fatigue.rule == "goodman" and material.ultimate_strength is None:
        return reason("no_ultimate_strength")
    return None


@dataclass(frozen=True, kw_only=True)
class FatigueLife:
    """Fatigue at one place under a motion that repeats.

    Attributes
    ----------
    smallest, largest : float
        Of the signed stress [MPa].
    cycles : tuple of (float, float, float)
        Range, mean and count of one repetition's, the largest first, without the negligible ones.
    stress : float
        Peak stress of a cycle of the test's stress ratio that harms as much as the worst cycle [MPa].
    count : float
        Cycles as bad as the worst that one repetition's make together, by Miner's sum; all of them, without exponent.
    repetitions : float or None
        Of the motion until Miner's sum is 1; None where the card has no exponent.
    harm : tuple of float
        Of each block its share of Miner's sum; empty where that is 0 or not known.
    """

    smallest: float
    largest: float
    cycles: tuple[tuple[float, float, float], ...]
    stress: float
    count: float
    repetitions: float | None
    harm: tuple[float, ...] = ()

    @property
    def stress_range(self) -> float:
        """Largest less smallest stress [MPa]."""
        return self.largest - self.smallest

    def with_strength(self, material: Material, by: float) -> float:
        """Return the repetitions with another fatigue strength, with which the endurance limit goes as well.

        Parameters
        ----------
        material : Material
        by : float
            Share of the card's strength.

        Returns
        -------
        float
            NaN where the card has no exponent.
        """
        fatigue, cycles = material.fatigue, np.reshape(self.cycles, (-1, 3))
        assert fatigue is not None
        if fatigue.exponent is None:
            return math.nan
        stress = equivalent_peak(cycles, fatigue, material.ultimate_strength)
        return _lasting(float(_harms(cycles, stress / by, fatigue).sum()))


def fatigue_life(history: Real, material: Material, blocks: Sequence[Block] = ()) -> FatigueLife:
    """Return the fatigue under repetitions of a closed history, or of blocks of it, whose harm adds up.

    Parameters
    ----------
    history : ndarray, shape (n,)
        Of the signed stress [MPa].
    material : Material
        Whose card is complete: see ``missing_data``.
    blocks : sequence of Block, optional
        Which of its states follow each other, and how often in each repetition; all of them once where left out.

    Returns
    -------
    FatigueLife
    """
    fatigue = material.fatigue
    assert fatigue is not None
    every = []
    for states, share in blocks or (Block(tuple(range(len(history))), 1.0),):
        found = repeated_cycles(history[list(states)])
        found = found[found[:, 0] >= NEGLIGIBLE * found[:, 0].max(initial=0.0)]
        every.append(found * (1.0, 1.0, share))
    cycles, of_block = np.concatenate(every), np.repeat(np.arange(len(every)), [len(found) for found in every])
    order = np.argsort(-cycles[:, 0], kind="stable")
    cycles, of_block = cycles[order], of_block[order]
    stress = equivalent_peak(cycles, fatigue, material.ultimate_strength)
    repetitions, harm, worst = None, list[float](), float(stress.max(initial=0.0))
    of_worst = stress / worst if 0.0 < worst < math.inf else np.zeros_like(stress)
    count = float((cycles[:, 2] * of_worst ** (fatigue.exponent or 0.0)).sum()) or 1.0
    if fatigue.exponent is not None:
        each = _harms(cycles, stress, fatigue)
        damage = float(each.sum())
        repetitions = _lasting(damage)
        harm = np.bincount(of_block, each / damage, len(every)).tolist() if 0.0 < damage < math.inf else harm
    return FatigueLife(
        smallest=float(history.min()),
        largest=float(history.max()),
        cycles=tuple((float(size), float(mean), float(count)) for size, mean, count in cycles),
        stress=worst,
        count=count,
        repetitions=repetitions,
        harm=tuple(harm),
    )


def _harms(cycles: Real, stress: Real, fatigue: Fatigue) -> Real:
    """Terms of Miner's sum (k,) over one repetition, of cycles (k, 3) and their equivalent peaks."""
    with np.errstate(divide="ignore"):  # stress without end fails at once
        return np.asarray(cycles[:, 2] / cycles_to_failure(stress, fatigue))


def _lasting(damage: float) -> float:
    return 1.0 / damage if damage > 0.0 else math.inf


def strength_at(fatigue: Fatigue, cycles: float) -> float | None:
    """Return the peak stress of the test's stress ratio that is borne for so many cycles.

    Without an exponent it is the stated stress up to the stated cycles, unknown beyond; from the endurance limit on it
    stays. The surface factor is in it.

    Parameters
    ----------
    fatigue : Fatigue
    cycles : float

    Returns
    -------
    float or None
        [MPa]; None where the card does not tell.
    """
    own, endless = fatigue.surface_factor * fatigue.stress, fatigue.endurance_cycles or math.inf
    if fatigue.exponent is not None:
        return float(own * (min(cycles, endless) / fatigue.cycles) ** (-1.0 / fatigue.exponent))
    return own if cycles <= fatigue.cycles or fatigue.cycles >= endless else None


def borne(material: Material, cycles: float) -> float | None:
    """Return the peak stress that a material bears so often, as ``strength_at``, and at most its static strength.

    Parameters
    ----------
    material : Material
        With fatigue data.
    cycles : float

    Returns
    -------
    float or None
        [MPa]
    """
    assert material.fatigue is not None
    found = strength_at(material.fatigue, cycles)
    return None if found is None else min(found, material.ultimate_strength or material.allowable)


def borne_scatter(material: Material, strength: float) -> Scatter:
    """Return what a strength under repeated load may be, over what it is.

    Parameters
    ----------
    material : Material
        With fatigue data.
    strength : float
        As ``borne`` gives it [MPa].

    Returns
    -------
    Scatter
        That of the fatigue strength. The tensile strength of a brittle material, at which it ends, scatters by itself.
    """
    assert material.fatigue is not None
    own, static = fatigue_scatter(material.fatigue), strength_scatter(material)
    if not material.brittle or static == Scatter():
        return own
    least, capped = static.low * material.allowable / strength, strength >= material.allowable
    if least >= own.low and not capped:
        return own
    return own.either(replace(static, low=min(least, 1.0), high=static.high if capped else 1.0))


def borne_repeated(
    material: Material, cycles: float, factor: float, shares: Sequence[float], blocks: Sequence[Block]
) -> float | None:
    """Return the largest stress of a load that comes and goes at which a material keeps a factor on fatigue strength.

    Parameters
    ----------
    material : Material
    cycles : float
        How often.
    factor : float
        Strength over the equivalent peak stress.
    shares : sequence of float
        What is left of the load at the states of its cycles.
    blocks : sequence of Block
        How these follow each other.

    Returns
    -------
    float or None
        [MPa], by halving; None where the card does not tell.
    """
    if missing_data(material) or borne(material, cycles) is None:
        return None

    def keeps(stress: float) -> bool:
        life = fatigue_life(stress * np.array(shares), material, blocks)
        return factor * life.stress <= (borne(material, cycles * life.count) or 0.0)

    low, high = 0.0, 2.0 * (material.ultimate_strength or material.allowable)
    while high - low > 1e-9 * high:
        middle = (low + high) / 2.0
        low, high = (middle, high) if keeps(middle) else (low, middle)
    return low


def notch_factors(body: Body, places: Real, fatigue: Fatigue) -> tuple[Real, Real]:
    """Return by what stress at the walls of round holes counts in fatigue, by Peterson's notch sensitivity.

    Of a peak K σ with the concentration K the part (1 + q (K - 1))/K counts, which falls as K grows: q for the sharpest
    hole, q + (1 - q)/K for the ``LEAST_CONCENTRATION``. Elsewhere, and where the card states no notch length, all of it
    counts, at fillets as well.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    places : ndarray, shape (k, 3)
        In the link's frame [mm].
    fatigue : Fatigue

    Returns
    -------
    tuple of 2 ndarray, shape (k,)
        The least and the largest that may count.
    """
    low, high = np.ones(len(places)), np.ones(len(places))
    if fatigue.notch_length is not None:
        for pin in body.pins:
            radius = pin.diameter / 2.0
            wall = np.abs(pin.distance(places[:, 0], places[:, 1]) - radius) <= AT_WALL * radius
            if pin.slot == 0.0:
                sensitivity = 1.0 / (1.0 + fatigue.notch_length / radius)
                low[wall] = sensitivity
                high[wall] = sensitivity + (1.0 - sensitivity) / LEAST_CONCENTRATION
    return low, high


@dataclass(frozen=True, kw_only=True, eq=False)
class Lasting:
    """How long something lasts under one load case, the motion or the load of a pose repeated for ever.

    Attributes
    ----------
    location : ndarray, shape (3,)
        Of the critical place in the link's frame [mm].
    stress : Band
        The equivalent peak stress [MPa].
    wanted : float
        Repetitions that are asked for.
    strength : float or None
        Peak stress borne for as many cycles [MPa]; None where the card does not tell.
    repetitions : Band or None
        The life; None where the card has no exponent.
    """

    location: Real
    stress: Band
    wanted: float
    strength: float | None
    repetitions: Band | None


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkFatigue(Lasting):
    """Fatigue of a link.

    Attributes
    ----------
    history : ndarray, shape (n,)
        Its signed stress over one repetition, as far as a notch counts [MPa].
    life : FatigueLife
        Of the variant that governs.
    notch : float
        By which the stress was multiplied for the notch at its place.
    """

    history: Real
    life: FatigueLife
    notch: float = 1.0

    @property
    def largest(self) -> float:
        """Upper end of the largest size of the stress there, with all of the concentration of a notch [MPa]."""
        share = self.stress.high / self.life.stress if self.life.stress > 0.0 else 1.0
        return share * max(self.life.largest, -self.life.smallest) / self.notch

    @classmethod
    def of(
        cls, lives: list[FatigueLife], life: FatigueLife, history: Real, location: Real, sources: tuple[Source, ...],
        *, material: Material, repetitions: float | None, without: Reason | str = "", notch: float = 1.0,
    ) -> "LinkFatigue":  # fmt: skip
        """Return the fatigue at a place.

        Parameters
        ----------
        lives : list of FatigueLife
            All that may be.
        life : FatigueLife
            That which governs.
        history, location
            As the attributes.
        sources : tuple of Source
            What makes the lives differ.
        material : Material
        repetitions : float or None
            Asked for; the card's cycles, each repetition one of them, where it is None.
        without : Reason or str, optional
            Why the band covers no error of the model.
        notch : float, optional
            As the attribute.

        Returns
        -------
        LinkFatigue
        """
        assert material.fatigue is not None
        wanted = material.fatigue.cycles if repetitions is None else repetitions
        scatter = fatigue_scatter(material.fatigue)
        counts = tuple(one.with_strength(material, by) for one in lives for by in (scatter.low, scatter.high))
        return cls(
            location=location,
            history=history,
            life=life,
            notch=notch,
            stress=replace(Band.around(life.stress, tuple(one.stress for one in lives), *sources), without=without),
            wanted=wanted,
            strength=borne(material, wanted if repetitions is None else wanted * life.count),
            repetitions=None
            if life.repetitions is None
            else Band.around(life.repetitions, counts, *distinct(sources, life_scatter(material.fatigue).told)),
        )


def life_scatter(data: Fatigue) -> Scatter:
    """Return what the scatter of the fatigue strength makes of a life that ends: its power with the exponent.

    Parameters
    ----------
    data : Fatigue
        With an exponent.

    Returns
    -------
    Scatter
    """
    assert data.exponent is not None
    strength = fatigue_scatter(data)
    return replace(strength, low=strength.low**data.exponent, high=strength.high**data.exponent)
