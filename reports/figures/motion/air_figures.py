"""Figures of the drive with and without air on wings that flap."""

from io import BytesIO

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from alula.fea.whole.air_range import air_range
from alula.loads.states.case_motion import CaseMotion
from alula.reports.figures.motion.motion_figures import DPI, legend, over_angle
from alula.reports.tables.loads import motion_air_record

Real = NDArray[np.float64]
_SIZE = (8.0, 6.6)


def case_air_pictures(moved: CaseMotion | None) -> dict[str, bytes]:
    """Draw the drive with and without air over the motion of a case.

    Parameters
    ----------
    moved : CaseMotion or None
        As ``motion_in_air``.

    Returns
    -------
    dict of str to bytes
        Load case -> PNG; empty without air, and without a motion.
    """
    found = {}
    for name in () if moved is None else moved.torque:
        with BytesIO() as file:
            assert moved is not None
            air_figure(moved, name).savefig(file, dpi=DPI)
            found[name] = file.getvalue()
    return found


def air_figures(result: CaseMotion) -> dict[str, Figure]:
    """Draw drive torque and power of every load case with air, with and without it.

    Parameters
    ----------
    result : CaseMotion

    Returns
    -------
    dict of str to Figure
        Name of the file, without its ending -> figure.
    """
    names = [name for name in result.torque if motion_air_record(result, name) is not None]
    return {"air" if len(names) == 1 else f"air-{i + 1}": air_figure(result, name) for i, name in enumerate(names)}


def air_figure(result: CaseMotion, load_case: str) -> Figure:
    """Draw drive torque and power of a load case with air and without it, with the band of C_N.

    Parameters
    ----------
    result : CaseMotion
    load_case : str
        One with air.

    Returns
    -------
    Figure
    """
    what, unit = result.effort
    airs, air = air_range(result), result.case.load_cases[load_case].flapping
    assert airs is not None
    assert air is not None
    figure, panels = over_angle(result.motion, [f"drive {what} [{unit}]", "drive power [W]"], _SIZE)
    at, (low, high) = result.motion.told(result.motion.angles), air.ends

    def effort(one: CaseMotion) -> Real:
        return one.torque[load_case]

    def power(one: CaseMotion) -> Real:
        return np.asarray(one.drive_power(load_case) / 1000.0)

    for axes, of in zip(panels, (effort, power), strict=True):
        axes.plot(at, of(airs.without), color="0.35", linestyle=(0, (5, 1.5)), linewidth=1.4, label="without air")
        axes.plot(at, of(result), color="#0072b2", linewidth=1.6, label=f"C_N {air.normal_coefficient:g}")
        if low < high:
            ends, label = (of(airs.least), of(airs.largest)), f"C_N {low:g} to {high:g}"
            axes.fill_between(at, *ends, color="#0072b2", alpha=0.25, linewidth=0.0, label=label, zorder=1.5)
        axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    legend(panels[0], "air on wings")
    panels[0].set_title(f"load case {load_case}", parse_math=False, loc="left", fontsize=10)
    return figure
