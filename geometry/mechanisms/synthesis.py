"""Three-point function synthesis of a four-bar after Freudenstein, with the defects that it may hide.

The loop is a e^{jφ} + b e^{jθ} - c e^{jψ} - d = 0: θ turns with b, ψ with c, and a is the link that the
elimination leaves free. Freudenstein's equation K1 cos ψ - K2 cos θ + K3 = cos(θ - ψ), with K1 = d/b,
K2 = d/c, K3 = (b² + c² + d² - a²)/(2bc), knows nothing of branches: it holds for both configurations.
Source: F. Freudenstein, Approximate Synthesis of Four-Bar Linkages, Trans. ASME 77 (1955), 853-861;
as applied by Arango and Hurtado to three precision points.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.dyad import FloatArray, wrap
from alula.geometry.mechanisms.fourbar import Branch, FourBar

Drive = Literal["a", "b", "c"]
"""The link that is turned: a at φ, b at θ, c at ψ."""

DRIVES: tuple[Drive, ...] = ("a", "b", "c")
_ANGLE = {"a": "φ", "b": "θ", "c": "ψ"}

SINGULAR_CONDITION = 1e12
"""Above this 2-norm condition number the lengths would hold fewer than four digits."""
_ILL_CONDITION = 1e6


@dataclass(frozen=True, kw_only=True)
class SynthesisFinding:
    """A property of the synthesised linkage that its user must know, in one plain sentence.

    Attributes
    ----------
    kind : str
        ``conditioning``, ``sign``, ``grashof``, ``branch-defect``, ``order-defect``, ``circuit-defect``, ``lock-up``.
    drive : Drive, optional
        The driven link that the finding holds for; None where it holds for any.
    sentence : str
        What was found, in words.
    """

    kind: str
    drive: Drive | None
    sentence: str


@dataclass(frozen=True, kw_only=True)
class LockUp:
    """A pose beyond which a driven link cannot turn (rad).

    Attributes
    ----------
    drive : Drive
        The driven link.
    phi : float
        Angle of link a.
    theta : float
        Angle of link b.
    psi : float
        Angle of link c.
    kind : Literal[extended, folded]
        Whether the two links that are not driven lie stretched or folded in it.
    """

    drive: Drive
    phi: float
    theta: float
    psi: float
    kind: Literal["extended", "folded"]


@dataclass(frozen=True, kw_only=True)
class PrecisionPoint:
    """A precision point and the link angles in it (rad); residual of Freudenstein's equation.

    Attributes
    ----------
    theta : float
        Angle of link b.
    psi : float
        Angle of link c.
    phi : float
        Angle of link a.
    residual : float
        Of Freudenstein's equation.
    branches : dict[Drive, Branch, optional]
        Branch seen from each driven link; None at a dead point of that drive.
    """

    theta: float
    psi: float
    phi: float
    residual: float
    branches: dict[Drive, Branch | None]


@dataclass(frozen=True, kw_only=True)
class Synthesis:
    """A synthesised four-bar; lengths in the unit of d, angles in rad.

    Attributes
    ----------
    K : tuple[float, float, float]
        Coefficients of Freudenstein's equation.
    condition : float
        2-norm condition number of the 3×3 system.
    four_bar : FourBar
        The four-bar.
    b_turned : bool
        K1 < 0: the length b came out negative, so its link stands at θ + 180°.
    c_turned : bool
        K2 < 0: the length c came out negative, so its link stands at ψ + 180°.
    points : tuple[PrecisionPoint, PrecisionPoint, PrecisionPoint]
        The precision points.
    lock_ups : tuple[LockUp, ...]
        Where a driven link stops.
    findings : tuple[SynthesisFinding, ...]
        What its user must know.
    """

    K: tuple[float, float, float]
    condition: float
    four_bar: FourBar
    b_turned: bool
    c_turned: bool
    points: tuple[PrecisionPoint, PrecisionPoint, PrecisionPoint]
    lock_ups: tuple[LockUp, ...]
    findings: tuple[SynthesisFinding, ...]


def freudenstein_residual(K: Sequence[float], theta: ArrayLike, psi: ArrayLike) -> FloatArray:
    """Return K1 cos ψ - K2 cos θ + K3 - cos(θ - ψ), zero where a pair lies on the linkage.

    Parameters
    ----------
    K : sequence of float
        The three coefficients.
    theta, psi : array_like
        Angles of links b and c, of shapes that broadcast [rad].

    Returns
    -------
    ndarray
        Residuals.
    """
    theta, psi = np.asarray(theta, dtype=float), np.asarray(psi, dtype=float)
    return np.asarray(K[0] * np.cos(psi) - K[1] * np.cos(theta) + K[2] - np.cos(theta - psi))


def driven(four_bar: FourBar, drive: Drive) -> FourBar:
    """Return the four-bar in Norton's form with the given link as its input.

    For ``b`` the first two vectors of the loop change places, so the input angle is θ. For ``c`` the
    four-bar is mirrored, so that its input angle is π - ψ, its coupler angle -θ and its output angle π - φ.

    Parameters
    ----------
    four_bar : FourBar
        The synthesised four-bar.
    drive : {"a", "b", "c"}
        The link that is turned.

    Returns
    -------
    FourBar
        The same linkage, its links renamed.
    """
    if drive == "a":
        return four_bar
    return four_bar.driven_by_coupler() if drive == "b" else four_bar.driven_by_output()


def synthesise(theta: Sequence[float], psi: Sequence[float], d: float) -> Synthesis:
    """Find the four-bar whose links b and c stand at three pairs of angles.

    Solves the 3×3 system [cos ψ, -cos θ, 1] K = cos(θ - ψ) and takes b = d/K1, c = d/K2, a² = b² + c² + d² - 2bcK3.

    Parameters
    ----------
    theta, psi : sequence of float
        Three angles each, of links b and c [rad].
    d : float
        Length of the ground link.

    Returns
    -------
    Synthesis
        The four-bar, in the unit of d, and its defects.

    Raises
    ------
    CaseError
        For other than three pairs, a d that is not positive, a singular system (with the reason), or a link of
        infinite length.
    """
    angles, outputs = np.asarray(theta, dtype=float), np.asarray(psi, dtype=float)
    if angles.shape != (3,) or outputs.shape != (3,) or not np.isfinite([angles, outputs]).all():
        raise CaseError(
            f"three-point synthesis got {angles.size} values of theta and {outputs.size} of psi; "
            "give three finite pairs (theta, psi)."
        )
    if not (math.isfinite(d) and d > 0):
        raise CaseError(f"synthesis length d = {d:g} must be positive; give the length of the ground link.")
    matrix = np.column_stack([np.cos(outputs), -np.cos(angles), np.ones(3)])
    condition = float(np.linalg.cond(matrix))
    if not condition < SINGULAR_CONDITION:
        raise CaseError(_singular(angles, outputs))
    K1, K2, K3 = (float(value) for value in np.linalg.solve(matrix, np.cos(angles - outputs)))
    for name, link, value in (("K1", "b", K1), ("K2", "c", K2)):
        if abs(value) < 1 / SINGULAR_CONDITION:
            raise CaseError(
                f"synthesis gives {name} = {value:.3g}, so link {link} = d/{name} would be infinitely long; "
                "change one of the precision points."
            )
    b, c = d / K1, d / K2
    # The loop itself gives a² = b² + c² + d² - 2 b c K3 without its cancellation, and never a negative one.
    spans = np.abs(d + c * np.exp(1j * outputs) - b * np.exp(1j * angles))
    four_bar = FourBar(a=float(spans.mean()), b=abs(b), c=abs(c), d=d)
    points = tuple(_point(four_bar, (K1, K2, K3), *pair) for pair in zip(angles, outputs, strict=True))
    lock_ups = tuple(lock for drive in DRIVES for lock in _lock_ups(four_bar, drive, b < 0, c < 0))
    findings = [*_general(condition, K1, K2, four_bar)]
    for drive in DRIVES:
        findings += _defects(four_bar, drive, points, b < 0, c < 0)
        findings += _lock_up_finding(drive, [lock for lock in lock_ups if lock.drive == drive])
    return Synthesis(
        K=(K1, K2, K3),
        condition=condition,
        four_bar=four_bar,
        b_turned=b < 0,
        c_turned=c < 0,
        points=(points[0], points[1], points[2]),
        lock_ups=lock_ups,
        findings=tuple(findings),
    )


def _singular(theta: FloatArray, psi: FloatArray) -> str:
    """Return why the three pairs do not fix a linkage."""
    rows = np.column_stack([np.cos(psi), np.cos(theta)])
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if np.allclose(rows[i], rows[j], rtol=0, atol=1e-9):
            same = f"pairs {i + 1} and {j + 1} have the same cosines of theta and psi"
            return f"the synthesis system is singular: {same}, so they count as one; change one of them."
    return (
        "the synthesis system is singular: the three points (cos psi, cos theta) lie on one straight line, so they do "
        "not fix K1, K2 and K3; change one of the pairs."
    )


def _point(four_bar: FourBar, K: tuple[float, float, float], theta: float, psi: float) -> PrecisionPoint:
    theta, psi = float(theta), float(psi)
    theta_b, psi_c = theta + math.pi * (K[0] < 0), psi + math.pi * (K[1] < 0)
    x = four_bar.d + four_bar.c * math.cos(psi_c) - four_bar.b * math.cos(theta_b)
    y = four_bar.c * math.sin(psi_c) - four_bar.b * math.sin(theta_b)
    phi = math.atan2(y, x)
    return PrecisionPoint(
        theta=theta,
        psi=psi,
        phi=phi,
        residual=float(freudenstein_residual(K, theta, psi)),
        branches={
            "a": four_bar.branch_of(phi, theta_b),
            "b": driven(four_bar, "b").branch_of(theta_b, phi),
            "c": driven(four_bar, "c").branch_of(math.pi - psi_c, -theta_b),
        },
    )


def _lock_ups(four_bar: FourBar, drive: Drive, b_turned: bool, c_turned: bool) -> list[LockUp]:
    found = []
    for dead in driven(four_bar, drive).dead_points():
        if drive == "a":
            phi, theta, psi = dead.theta2, dead.theta3, dead.theta4
        elif drive == "b":
            phi, theta, psi = dead.theta3, dead.theta2, dead.theta4
        else:
            phi, theta, psi = math.pi - dead.theta4, -dead.theta3, math.pi - dead.theta2
        found.append(
            LockUp(
                drive=drive,
                phi=float(wrap(phi)),
                theta=float(wrap(theta - math.pi * b_turned)),
                psi=float(wrap(psi - math.pi * c_turned)),
                kind=dead.kind,
            )
        )
    return found


def _general(condition: float, K1: float, K2: float, four_bar: FourBar) -> list[SynthesisFinding]:
    found = []
    if condition > _ILL_CONDITION:
        digits = max(0, round(15.65 - math.log10(condition)))
        text = f"The system's condition number is {condition:.2g}: the lengths hold some {digits} digits at best."
        found.append(SynthesisFinding(kind="conditioning", drive=None, sentence=text))
    for name, link, angle, value in (("K1", "b", "θ", K1), ("K2", "c", "ψ", K2)):
        if value < 0:
            text = (
                f"{name} is negative, so the length of link {link} came out negative: build it with its positive "
                f"length, turned by 180° against {angle}."
            )
            found.append(SynthesisFinding(kind="sign", drive=None, sentence=text))
    found.append(SynthesisFinding(kind="grashof", drive=None, sentence=four_bar.grashof.sentence))
    return found


def _driven_angle(point: PrecisionPoint, drive: Drive, b_turned: bool, c_turned: bool) -> float:
    """Return the angle of the driven link in the frame of ``driven``."""
    if drive == "a":
        return point.phi
    if drive == "b":
        return point.theta + math.pi * b_turned
    return math.pi - (point.psi + math.pi * c_turned)


def _defects(
    four_bar: FourBar, drive: Drive, points: Sequence[PrecisionPoint], b_turned: bool, c_turned: bool
) -> list[SynthesisFinding]:
    """Return circuit, branch and order defect of one drive (Norton, Design of Machinery, 5th ed., chapter 4)."""
    found = []
    name = f"link {drive} (angle {_ANGLE[drive]})"
    branches = [point.branches[drive] for point in points]
    if len({branch for branch in branches if branch is not None}) > 1:
        opened = ", ".join(str(i + 1) for i, branch in enumerate(branches) if branch == "open")
        crossed = ", ".join(str(i + 1) for i, branch in enumerate(branches) if branch == "crossed")
        text = (
            f"Driven by {name}, the points do not share a branch (open: {opened}; crossed: {crossed}): the drive "
            "alone cannot take the linkage from one branch to the other."
        )
        found.append(SynthesisFinding(kind="branch-defect", drive=drive, sentence=text))
        return found
    reach = driven(four_bar, drive).input_range()
    angles = [_driven_angle(point, drive, b_turned, c_turned) for point in points]
    intervals = [reach.interval_of(angle) for angle in angles]
    if len(set(intervals)) > 1:
        text = (
            f"Driven by {name}, the three points lie in separate ranges of its angle: the linkage must be taken "
            "apart and assembled anew to pass from one to the other."
        )
        found.append(SynthesisFinding(kind="circuit-defect", drive=drive, sentence=text))
    elif not reach.full_turn and intervals[0] is not None:
        low = reach.intervals[intervals[0]][0]
        travel = [(angle - low) % (2 * math.pi) for angle in angles]
        if (travel[1] - travel[0]) * (travel[2] - travel[1]) <= 0:
            order = sorted(range(3), key=lambda i: travel[i])
            text = (
                f"Driven by {name} one way, the points come in the order "
                f"{', '.join(str(i + 1) for i in order)}, not 1, 2, 3: the drive must turn back on its way."
            )
            found.append(SynthesisFinding(kind="order-defect", drive=drive, sentence=text))
    return found


def _lock_up_finding(drive: Drive, lock_ups: Sequence[LockUp]) -> list[SynthesisFinding]:
    if not lock_ups:
        return []
    places = "; ".join(
        f"φ {math.degrees(lock.phi):.3f}°, θ {math.degrees(lock.theta):.3f}°, ψ {math.degrees(lock.psi):.3f}°"
        for lock in lock_ups
    )
    text = f"Driven by link {drive} (angle {_ANGLE[drive]}) the linkage locks in {len(lock_ups)} poses: {places}."
    return [SynthesisFinding(kind="lock-up", drive=drive, sentence=text)]
