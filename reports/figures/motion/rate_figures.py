"""Figures of speeds, accelerations, energy and shaking over a motion."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from alula.fea.findings.rates import QUANTITIES, Rates, Values
from alula.loads.states.case_motion import CaseMotion
from alula.reports.figures.motion.motion_figures import (
    COLOURS,
    DASHES,
    legend,
    over_angle,
)  # fmt: skip
from alula.reports.sentences.verdicts import told_speed

_SIZE = (8.0, 5.4)
_NEAR = 1e-9


def speeds_figure(rates: Rates, of: str, title: str) -> Figure:
    """Draw two rates of links or points below each other, of vectors their sizes; rows that are equal share a line.

    Parameters
    ----------
    rates : Rates
    of : str
        ``links`` or ``points``.
    title : str

    Returns
    -------
    Figure
    """
    rows: Mapping[str, Mapping[str, Values]] = getattr(rates, of)
    keys = ("angular_speed", "angular_acceleration") if of == "links" else ("speed", "acceleration")
    figure, panels = over_angle(rates.motion, [f"{key.replace('_', ' ')} [{QUANTITIES[key]}]" for key in keys], _SIZE)
    groups: list[list[str]] = []
    for name in rows:
        same = next((group for group in groups if all(_equal(rows[name][k], rows[group[0]][k]) for k in keys)), None)
        groups.append([name]) if same is None else same.append(name)
    for i, group in enumerate(groups):
        for axes, key in zip(panels, keys, strict=True):
            _line(axes, rates, _size(rows[group[0]][key]), ", ".join(group), i)
    legend(panels[0], of[:-1])
    panels[0].set_title(title, parse_math=False, loc="left", fontsize=10)
    return figure


def energy_figure(result: CaseMotion, load_case: str, rates: Rates) -> Figure:
    """Draw energies, the power of the drive, and what shakes the ground, below each other.

    Parameters
    ----------
    result : CaseMotion
    load_case : str
    rates : Rates
        Of this load case.

    Returns
    -------
    Figure
    """
    energy = {
        key: rates.whole[name]
        for key, name in (("kinetic", "kinetic_energy"), ("potential, above its least", "potential_energy"))
        if name in rates.whole
    }
    if len(energy) == 2:
        energy["potential, above its least"] = _above(energy["potential, above its least"])
    borne = {
        key: np.abs(rates.whole[name])
        for key, name in (("by inertia alone (shaking)", "shaking_force"), ("by all loads", "ground_force"))
        if name in rates.whole
    }
    power = np.where(np.isfinite(result.torque[load_case]), result.drive_power(load_case) / 1000.0, np.nan)
    rows = [("energy [N·mm]", energy), ("drive power [W]", {"": power})]
    if np.any(list(borne.values())):
        rows.append(("force on the ground [N]", borne))
    shown = [(label, lines) for label, lines in rows if lines]
    figure, panels = over_angle(rates.motion, [label for label, _ in shown], (_SIZE[0], 1.9 * len(shown) + 0.5))
    for axes, (_, lines) in zip(panels, shown, strict=True):
        for i, (label, values) in enumerate(lines.items()):
            _line(axes, rates, values, label, i)
        if "" not in lines:
            legend(axes, "")
    title = f"load case {load_case}, at {told_speed(result, load_case)}"
    panels[0].set_title(title, parse_math=False, loc="left", fontsize=10)
    return figure


def _above(values: Values) -> Values:
    return np.asarray(values - values.min())


def _size(values: Values) -> Values:
    return np.abs(values) if np.iscomplexobj(values) else values


def _equal(one: Values, other: Values) -> bool:
    return np.allclose(_size(one), _size(other), rtol=_NEAR, atol=_NEAR * float(np.max(np.abs(one))))


def _line(axes: Any, rates: Rates, values: Values, label: str, index: int) -> None:
    style = {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index // len(COLOURS) % len(DASHES)]}
    axes.plot(rates.motion.progress, values, label=label, linewidth=1.8, **style)
    axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
