"""Figures of the drive with and without air on wings that flap."""

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from alula.loads.states.case_motion import AirRange, CaseMotion
from alula.reports.figures.motion.motion_figures import DPI, legend, over_angle
from alula.reports.figures.sheet.chart import Chart

Real = NDArray[np.float64]
_SIZE = (8.0, 6.6)


def air_chart(airs: AirRange, load_case: str) -> Chart:
    """Draw ``air_figure`` as a picture.

    Parameters
    ----------
    airs : AirRange
    load_case : str
        One with air.

    Returns
    -------
    Chart
    """
    return Chart(air_figure(airs, load_case), dpi=DPI)


def air_figure(airs: AirRange, load_case: str) -> Figure:
    """Draw drive torque and power of a load case with air and without it, with the band of C_N.

    Parameters
    ----------
    airs : AirRange
    load_case : str
        One with air.

    Returns
    -------
    Figure
    """
    result = airs.stated
    air, kind = result.case.load_cases[load_case].flapping, result.effort
    assert air is not None
    figure, panels = over_angle(result.motion, [f"drive {kind.word} [{kind.unit}]", "drive power [W]"], _SIZE)
    at, (low, high) = result.motion.progress, air.ends

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
