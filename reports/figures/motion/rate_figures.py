"""All figures of a motion; those of speeds, accelerations, energy and shaking are drawn here."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from alula.fea.findings.of_motion import MotionFindings
from alula.loads.states.case_motion import CaseMotion
from alula.reports.figures.motion.air_figures import air_figures
from alula.reports.figures.motion.motion_figures import (
    COLOURS,
    DASHES,
    DPI,
    angles_figure,
    forces_figure,
    legend,
    over_angle,
    paths_figure,
    torque_figure,
)  # fmt: skip
from alula.reports.figures.sheet.chart import Chart
from alula.reports.motion.rate_rows import told_speed
from alula.reports.motion.rates import QUANTITIES, Series, Values, series

_SIZE = (8.0, 5.4)
_NEAR = 1e-9


def motion_pictures(found: MotionFindings) -> dict[str, Chart]:
    """Draw all figures of a motion.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    dict of str to Chart
        By the name of the file, without its ending.
    """
    result = found.moved
    figures = {
        "link-angles": angles_figure(result),
        "paths": paths_figure(result.motion, found.play),
        "torque": torque_figure(result, found.play),
    }
    for i, load_case in enumerate(result.forces):
        name = "joint-forces" if len(result.forces) == 1 else f"joint-forces-{i + 1}"
        figures[name] = forces_figure(result, load_case)
    figures |= air_figures(found.air) | rate_figures(result)
    return {name: Chart(figure, dpi=DPI) for name, figure in figures.items()}


def rate_figures(result: CaseMotion) -> dict[str, Figure]:
    """Draw what moves at a speed: links and points of the first load case that has one, and the energy of every one.

    Parameters
    ----------
    result : CaseMotion

    Returns
    -------
    dict of str to Figure
        Name of the file, without its ending -> figure; none where nothing has a speed.
    """
    found = {name: rates for name in result.torque if (rates := series(result, name)) is not None}
    if not found:
        return {}
    name, rates = next(iter(found.items()))
    title = f"load case {name}, at {told_speed(result, name)}"
    figures = {
        "link-speeds": _speeds(rates, rates.links, ("angular_speed", "angular_acceleration"), "link", title),
        "point-speeds": _speeds(rates, rates.points, ("speed", "acceleration"), "point", title),
    }
    for i, (name, rates) in enumerate(found.items()):
        figures["energy" if len(found) == 1 else f"energy-{i + 1}"] = energy_figure(result, name, rates)
    return figures


def _speeds(
    rates: Series, rows: Mapping[str, Mapping[str, Values]], keys: tuple[str, str], what: str, title: str
) -> Figure:
    """Draw two rates of links or points below each other, of vectors their sizes; rows that are equal share a line."""
    figure, panels = over_angle(rates.motion, [f"{key.replace('_', ' ')} [{QUANTITIES[key]}]" for key in keys], _SIZE)
    groups: list[list[str]] = []
    for name in rows:
        same = next((group for group in groups if all(_equal(rows[name][k], rows[group[0]][k]) for k in keys)), None)
        groups.append([name]) if same is None else same.append(name)
    for i, group in enumerate(groups):
        for axes, key in zip(panels, keys, strict=True):
            _line(axes, rates, _size(rows[group[0]][key]), ", ".join(group), i)
    legend(panels[0], what)
    panels[0].set_title(title, parse_math=False, loc="left", fontsize=10)
    return figure


def energy_figure(result: CaseMotion, load_case: str, rates: Series) -> Figure:
    """Draw energies, the power of the drive, and what shakes the ground, below each other.

    Parameters
    ----------
    result : CaseMotion
    load_case : str
    rates : Series
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


def _line(axes: Any, rates: Series, values: Values, label: str, index: int) -> None:
    style = {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index // len(COLOURS) % len(DASHES)]}
    axes.plot(rates.motion.told(rates.motion.angles), values, label=label, linewidth=1.8, **style)
    axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
