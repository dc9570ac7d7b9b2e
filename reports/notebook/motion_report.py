"""What ``alula.motion`` returns."""

import io
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from loads.states.case_motion import CaseMotion
from reports.commands.motion import record
from reports.notebook.shown import Picture, Row, Table

Real = NDArray[np.float64]


@dataclass(frozen=True)
class MotionReport:
    """A case over its motion, as ``alula motion`` makes it.

    Attributes
    ----------
    result : CaseMotion
        The record that the numbers come from: poses, joint forces and powers of every load case.

    Examples
    --------
    >>> import alula
    >>> moved = alula.motion("owl-wing-static")
    >>> print(moved.coordinates[0].round(2), len(moved.drive_efforts["weight"]))
    228.15 361
    """

    result: CaseMotion

    @property
    def coordinates(self) -> Real:
        """Values (n,) of the coordinate that the motion prescribes [degrees, or mm for a travel]."""
        return np.asarray(self.result.motion.told(self.result.motion.angles))

    @property
    def link_angles(self) -> Mapping[str, Real]:
        """Direction (n,) of every moving link, counter-clockwise from the global x axis [degrees]."""
        motion = self.result.motion
        return {link: np.degrees(motion.angle(link)) for link in motion.linkage.moving}

    @property
    def drive_efforts(self) -> Mapping[str, Real]:
        """Drive torque (n,) of every load case [N·mm], or force [N] on a driven slider; NaN where it is unbounded."""
        return self.result.torque

    @property
    def dead_points(self) -> tuple[float, ...]:
        """Values of the coordinate at which the driven link turns back [degrees or mm]."""
        return tuple(float(self.result.motion.told(at)) for at in self.result.dead_points)

    def table(self) -> Table:
        """Return first, last and extreme values of drive and joint forces per load case.

        Returns
        -------
        Table
            Extremes are None where a dead point makes them unbounded; ``at`` is the value of the coordinate there.
        """
        what, unit = self.result.effort
        at = self.result.motion.unit
        rows: list[Row] = []
        for load_case, found in record(self.result, "")["load_cases"].items():
            told = {f"drive {what} on {self.result.drive.link}": (unit, found[f"drive_{what}"])}
            told |= {f"joint {joint}": ("N", values) for joint, values in (found["joints"] or {}).items()}
            if "drive_power" in found:
                told["drive power"] = ("W", found["drive_power"])
            rows += [
                {
                    "load case": load_case,
                    "quantity": name,
                    "unit": unit,
                    "first": values["first"],
                    "last": values["last"],
                    "smallest": values["smallest"],
                    f"smallest at [{at}]": values.get("smallest_at"),
                    "largest": values["largest"],
                    f"largest at [{at}]": values.get("largest_at"),
                }
                for name, (unit, values) in told.items()
            ]
        return Table(tuple(rows))

    def plot_drive(self) -> Picture:
        """Draw drive torque or force over the coordinate, a line per load case."""
        from reports.figures.motion_figures import torque_figure

        return _picture(torque_figure(self.result))

    def plot_linkage(self) -> Picture:
        """Draw the linkage at a few poses, with the paths of its points."""
        from loads.states.loose_motion import loose_motion
        from reports.figures.motion_figures import paths_figure

        return _picture(paths_figure(self.result.motion, loose_motion(self.result)))

    def __str__(self) -> str:
        return str(self.table())

    def __repr__(self) -> str:
        return f"<motion of {self.result.case.title!r}: {len(self.coordinates)} poses>"

    def _repr_html_(self) -> str:
        from html import escape

        return f"<p><b>{escape(self.result.case.title)}</b></p>\n{self.table()._repr_html_()}"


def _picture(figure: object) -> Picture:
    from matplotlib.figure import Figure

    from reports.figures.motion_figures import DPI, quiet_glyphs

    assert isinstance(figure, Figure)
    stream = io.BytesIO()
    with quiet_glyphs():
        figure.savefig(stream, format="png", dpi=DPI)
    return Picture(stream.getvalue())
