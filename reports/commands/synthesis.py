"""Output of ``alula synth``: a synthesised four-bar, its precision points and its defects."""

import json as jsonlib
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import POSITIVE, Angle, Length
from alula.geometry.base.version import result_stamp
from alula.geometry.mechanisms.synthesis import DRIVES, PrecisionPoint, Synthesis, synthesise
from alula.loads.text.explain import printable, sentence
from alula.reports.sections.data import entries

PUBLISHED_POINTS = ("0 deg, 30 deg", "20 deg, 110 deg", "5 deg, 130 deg")
"""Precision points (theta, psi) of Arango and Hurtado."""
PUBLISHED_GROUND = "10 m"
_ANGLE = {"a": "φ", "b": "θ", "c": "ψ"}
_LABELS = {"O2": (-23, -13), "A": (5, 8), "B": (8, 6), "O4": (8, -13)}
"""Places of the joints' names beside them, in points."""
_COLOURS = ("#0072b2", "#d55e00", "#009e73")


class _Pair(CaseModel):
    theta: Angle
    psi: Angle


class _Ground(CaseModel):
    d: Annotated[Length, POSITIVE]


def read_synthesis(points: Sequence[str], ground: str) -> Synthesis:
    """Synthesise a four-bar from text.

    Parameters
    ----------
    points : sequence of str
        Three pairs (theta, psi) such as ``"20 deg, 110 deg"``.
    ground : str
        A length such as ``"10 m"``.

    Returns
    -------
    Synthesis

    Raises
    ------
    CaseError
        For other than three points, for invalid text, and where no linkage follows from the points.
    """
    if len(points) != 3:
        raise CaseError(f"--point: there are {len(points)} precision points, but the synthesis takes three; give three")
    pairs = []
    for number, text in enumerate(points, start=1):
        theta, comma, psi = text.partition(",")
        if not comma:
            raise CaseError(
                f"--point {number}: '{printable(text)}' is no pair of angles; write theta and psi with a comma "
                'between, for example "20 deg, 110 deg"'
            )
        try:
            pairs.append(_Pair.model_validate({"theta": theta.strip(), "psi": psi.strip()}))
        except ValidationError as error:
            raise CaseError(f"--point {number}: {sentence(error, _Pair)}") from None
    try:
        d = _Ground.model_validate({"d": ground}).d
    except ValidationError as error:
        raise CaseError(f"--ground: {sentence(error, _Ground)}") from None
    return synthesise([pair.theta for pair in pairs], [pair.psi for pair in pairs], d)


def record(synthesis: Synthesis) -> dict[str, Any]:
    """Return the synthesis as plain data.

    Parameters
    ----------
    synthesis : Synthesis

    Returns
    -------
    dict
        Lengths in mm, angles in degrees from -180 to 180.
    """
    bar, grashof = synthesis.four_bar, synthesis.four_bar.grashof
    return {
        **result_stamp(),
        "units": {"length": "mm", "angle": "deg"},
        "coefficients": {"K1": synthesis.K[0], "K2": synthesis.K[1], "K3": synthesis.K[2]},
        "condition": synthesis.condition,
        "lengths": entries(bar, "a b c d"),
        "turned": {"b": synthesis.b_turned, "c": synthesis.c_turned},
        "grashof": entries(grashof, "satisfied relation inversion shortest_plus_longest other_two"),
        "points": [
            {
                "theta": math.degrees(point.theta),
                "psi": math.degrees(point.psi),
                "phi": math.degrees(point.phi),
                "residual": point.residual,
                "branches": dict(point.branches),
            }
            for point in synthesis.points
        ],
        "lock_ups": [
            {
                "drive": lock.drive,
                "phi": math.degrees(lock.phi),
                "theta": math.degrees(lock.theta),
                "psi": math.degrees(lock.psi),
                "kind": lock.kind,
            }
            for lock in synthesis.lock_ups
        ],
        "findings": [entries(finding, "kind drive sentence") for finding in synthesis.findings],
    }


def print_synthesis(synthesis: Synthesis, *, json: bool) -> None:
    """Print the synthesis.

    Parameters
    ----------
    synthesis : Synthesis
    json : bool
        True to print JSON.
    """
    if json:
        print(jsonlib.dumps(record(synthesis), indent=2, ensure_ascii=False))
        return
    unit, factor = _unit(synthesis)
    bar = synthesis.four_bar
    print("Four-bar through three precision points (Freudenstein)")
    print("  loop a·e^(jφ) + b·e^(jθ) − c·e^(jψ) − d = 0: φ turns with link a, θ with b, ψ with c")
    print(f"  ratios K1 = {synthesis.K[0]:.6f}, K2 = {synthesis.K[1]:.6f}, K3 = {synthesis.K[2]:.6f}")
    print(f"  condition number of the 3×3 system: {synthesis.condition:.4g}")
    print("\nLink lengths")
    for name in "abcd":
        print(f"  {name} = {getattr(bar, name) / factor:.10g} {unit}")
    print("\nPrecision points [deg]; branch as seen from each link that may be driven")
    print(f"  {'':>3}{'θ':>10}{'ψ':>10}{'φ':>11}   {'a (φ)':<12}{'b (θ)':<12}{'c (ψ)':<12}")
    for number, point in enumerate(synthesis.points, start=1):
        angles = f"{math.degrees(point.theta):10.4f}{math.degrees(point.psi):10.4f}{math.degrees(point.phi):11.4f}"
        print(
            f"  {number:>3}{angles}   " + "".join(f"{point.branches[d] or 'dead point':<12}" for d in DRIVES).rstrip()
        )
    if synthesis.lock_ups:
        print("\nLock-up poses [deg]: beyond them the driven link cannot turn")
        print(f"  {'driven':<10}{'φ':>11}{'θ':>11}{'ψ':>11}   other two links")
        for lock in synthesis.lock_ups:
            angles = "".join(f"{math.degrees(value):11.4f}" for value in (lock.phi, lock.theta, lock.psi))
            print(f"  {f'{lock.drive} ({_ANGLE[lock.drive]})':<10}{angles}   {lock.kind}")
    print("\nFindings")
    for finding in synthesis.findings:
        if finding.kind != "lock-up":  # the table above says as much
            print(f"  {finding.kind}: {_in_unit(finding.sentence, synthesis)}")


def _unit(synthesis: Synthesis) -> tuple[str, float]:
    """Return the unit in which lengths are printed, and the mm in it."""
    return ("m", 1000.0) if synthesis.four_bar.d >= 1000.0 else ("mm", 1.0)


def _in_unit(text: str, synthesis: Synthesis) -> str:
    """Name the unit of the sums in Grashof's sentence, which come in the unit of d."""
    grashof = synthesis.four_bar.grashof
    unit, factor = _unit(synthesis)
    for value in (grashof.shortest_plus_longest, grashof.other_two):
        text = text.replace(f"{value:.10g}", f"{value / factor:.10g} {unit}")
    return text


def joints_at(synthesis: Synthesis, point: PrecisionPoint) -> NDArray[np.float64]:
    """Return the joints of the linkage at a precision point.

    Parameters
    ----------
    synthesis : Synthesis
    point : PrecisionPoint

    Returns
    -------
    array
        O2, A, B, O4 (4, 2) in the unit of d.
    """
    bar = synthesis.four_bar
    psi = point.psi + math.pi * synthesis.c_turned
    crank = bar.a * np.array([math.cos(point.phi), math.sin(point.phi)])
    output = np.array([bar.d + bar.c * math.cos(psi), bar.c * math.sin(psi)])
    return np.array([[0.0, 0.0], crank, output, [bar.d, 0.0]])


def write_synthesis(synthesis: Synthesis, folder: Path) -> None:
    """Write ``result.json`` and ``linkage.png``.

    Parameters
    ----------
    synthesis : Synthesis
    folder : Path
        An existing folder.
    """
    text = jsonlib.dumps(record(synthesis), indent=2, ensure_ascii=False)
    (folder / "result.json").write_text(text + "\n", encoding="utf-8")
    draw_linkage(synthesis, folder / "linkage.png")


def draw_linkage(synthesis: Synthesis, path: Path | BinaryIO) -> None:
    """Draw the linkage at the three precision points, one below the other.

    Parameters
    ----------
    synthesis : Synthesis
    path : Path or stream
        PNG file to write.
    """
    from matplotlib.figure import Figure

    unit, factor = _unit(synthesis)
    shapes = [joints_at(synthesis, point) / factor for point in synthesis.points]
    everything = np.concatenate(shapes)
    low, high = everything.min(axis=0), everything.max(axis=0)
    margin = 0.09 * float(np.max(high - low))
    width, tall = (high - low) + 2.0 * margin
    panel = float(np.clip(8.0 * tall / width, 1.6, 6.0))
    figure = Figure(figsize=(9.0, 3 * (panel + 0.55) + 0.9), layout="constrained")
    for number, (axes, shape) in enumerate(zip(figure.subplots(3, 1, sharex=True), shapes, strict=True), start=1):
        point = synthesis.points[number - 1]
        axes.set_aspect("equal")
        axes.set_xlim(low[0] - margin, high[0] + margin)
        axes.set_ylim(low[1] - margin, high[1] + margin)
        axes.grid(color="0.92", linewidth=0.8)
        axes.set_axisbelow(True)
        axes.plot(*shape[[0, 3]].T, color="0.6", linewidth=1.2, linestyle=(0, (5, 3)), label="d (ground)")
        for link, ends, colour in zip("abc", ([0, 1], [1, 2], [3, 2]), _COLOURS, strict=True):
            axes.plot(
                *shape[ends].T, color=colour, linewidth=3.0, solid_capstyle="round", label=f"{link} ({_ANGLE[link]})"
            )
        axes.plot(*shape.T, "o", color="black", markerfacecolor="white", markersize=6, zorder=4)
        for (name, off), here in zip(_LABELS.items(), shape, strict=True):
            axes.annotate(name, here, textcoords="offset points", xytext=off, fontsize=9)
        angles = (
            f"θ {math.degrees(point.theta):.4g}°, ψ {math.degrees(point.psi):.4g}°, φ {math.degrees(point.phi):.4g}°"
        )
        seen = ", ".join(f"{drive} {point.branches[drive] or 'dead point'}" for drive in DRIVES)
        axes.set_title(f"Point {number}: {angles}; branch seen from {seen}", fontsize=10, loc="left")
        axes.set_ylabel(f"y [{unit}]")
        if number == 3:
            axes.set_xlabel(f"x [{unit}]")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=9)
    figure.savefig(path, dpi=130, format="png", bbox_inches="tight")
