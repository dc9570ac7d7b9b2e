"""Life under a stress that varies: cycles by rainflow, mean stress by Goodman or the material's own rule, Miner's sum.

The measure of stress for brittle materials is the principal stress of largest size. For ductile ones it is the von
Mises stress with the sign of that principal stress. Both assume that the principal directions do not turn within a
cycle.

References
----------
ASTM E1049-85, sections 5.4.4 and 5.4.5.
Shigley's Mechanical Engineering Design, 10th ed., chapter 6.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason, reason
from alula.fea.solid.stress import extreme_principal, von_mises
from alula.geometry.base.ties import first_largest
from alula.geometry.materials.material import Fatigue, Material

Real = NDArray[np.float64]

NEGLIGIBLE = 0.05
"""Cycles with a smaller range than this share of the largest range are left out, or ripples would count as peaks."""
STRESS_FACTOR = 2.0
LIFE_FACTOR = 4.0
"""Default limits: on stress at the wanted number of cycles, and on life."""


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
    """Return one repetition of a motion's history: a full turn, or there and back.

    Parameters
    ----------
    history : ndarray, shape (n,)
        At the poses of the motion.
    returns : bool
        True where the last pose is the first again.

    Returns
    -------
    ndarray, shape (k,)
    """
    return history[:-1] if returns else np.concatenate([history, history[-2:0:-1]])


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
    amplitude = reversed_amplitude(cycles, ultimate)
    share, ratio = (1.0 - fatigue.stress_ratio) / 2.0, (1.0 + fatigue.stress_ratio) / (2.0 * ultimate)
    finite = np.isfinite(amplitude)
    safe = np.where(finite, amplitude, 0.0)
    limit = 1.0 / ratio if ratio > 0.0 else np.inf
    return np.where(finite, safe / (share + safe * ratio), limit)


def cycles_to_failure(stress: Real, fatigue: Fatigue) -> Real:
    """Return N = N1 (σ/σ1)^(−exponent).

    Parameters
    ----------
    stress : ndarray, shape (k,)
        Peaks of cycles of the test's stress ratio [MPa].
    fatigue : Fatigue
        Of the material's card, with an exponent.

    Returns
    -------
    ndarray, shape (k,)
        Infinite without stress.
    """
    assert fatigue.exponent is not None
    with np.errstate(divide="ignore"):
        return np.asarray(fatigue.cycles * (stress / fatigue.stress) ** -fatigue.exponent)


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
    repetitions : float or None
        Of the motion until Miner's sum is 1; None where the card has no exponent.
    """

    smallest: float
    largest: float
    cycles: tuple[tuple[float, float, float], ...]
    stress: float
    repetitions: float | None

    @property
    def stress_range(self) -> float:
        """Largest less smallest stress [MPa]."""
        return self.largest - self.smallest


def fatigue_life(history: Real, material: Material) -> FatigueLife:
    """Return the fatigue under repetitions of a closed history.

    Parameters
    ----------
    history : ndarray, shape (n,)
        Of the signed stress [MPa].
    material : Material
        Whose card is complete: see ``missing_data``.

    Returns
    -------
    FatigueLife
    """
    fatigue = material.fatigue
    assert fatigue is not None
    cycles = repeated_cycles(history)
    cycles = cycles[np.argsort(-cycles[:, 0], kind="stable")]
    if len(cycles):
        cycles = cycles[cycles[:, 0] >= NEGLIGIBLE * cycles[0, 0]]
    stress = equivalent_peak(cycles, fatigue, material.ultimate_strength)
    repetitions = None
    if fatigue.exponent is not None:
        damage = float((cycles[:, 2] / cycles_to_failure(stress, fatigue)).sum())
        repetitions = 1.0 / damage if damage > 0.0 else math.inf
    return FatigueLife(
        smallest=float(history.min()),
        largest=float(history.max()),
        cycles=tuple((float(size), float(mean), float(count)) for size, mean, count in cycles),
        stress=float(stress.max(initial=0.0)),
        repetitions=repetitions,
    )


def strength_at(fatigue: Fatigue, cycles: float) -> float | None:
    """Return the peak stress of the test's stress ratio that is borne for so many cycles.

    Without an exponent it is the stated stress up to the stated cycles, unknown beyond.

    Parameters
    ----------
    fatigue : Fatigue
    cycles : float

    Returns
    -------
    float or None
        [MPa]; None where the card does not tell.
    """
    if fatigue.exponent is not None:
        return float(fatigue.stress * (cycles / fatigue.cycles) ** (-1.0 / fatigue.exponent))
    return fatigue.stress if cycles <= fatigue.cycles else None
