"""What ``alula.motion`` returns."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.of_motion import MotionFindings, PlayOverMotion, motion_findings, play_over_motion
from alula.fea.findings.rates import QUANTITIES, rates_record, series
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.rate_rows import whole_rows
from alula.reports.motion.record import record
from alula.reports.notebook.shown import Picture, Row, Table, Tabled, pick

Real = NDArray[np.float64]


@dataclass(frozen=True)
class MotionReport(Tabled):
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

    def table(self, of: Literal["drive", "links", "points", "energy"] = "drive") -> Table:
        """Return a table of the motion, with a row per load case.

        Parameters
        ----------
        of : {"drive", "links", "points", "energy"}
            Drive and joint forces, with first, last and extreme values; angular speeds, accelerations, momentum and
            kinetic energy of the links; speeds and accelerations of the points; or momentum, energies and shaking of
            the linkage. All but the first have rows of the load cases that have a speed.

        Returns
        -------
        Table
            ``at`` is the value of the coordinate there. Extremes are None where a dead point makes them unbounded, and
            where a quantity is not known. Of a vector, the largest is that of its size.

        Raises
        ------
        CaseError
            For a table that does not exist.
        """
        builders = {"drive": self._drive_rows, "links": self._rows_of, "points": self._rows_of, "energy": self._whole}
        return Table(tuple(pick(builders, of, "table")(of)))

    def _rows_of(self, of: str) -> Iterator[Row]:
        for load_case, rates in self._rates():
            for name, row in rates[of].items():
                told = {key: value for key, value in row.items() if key != "mass"}
                mass: Row = {"mass [g]": row["mass"]} if "mass" in row else {}
                named: Row = {"load case": load_case, of[:-1]: name, **mass}
                yield named | {
                    f"{key.replace('_', ' ')}, {end} [{unit}]": None if found is None else found.get(way)
                    for key, found in told.items()
                    for end, way, unit in self._ends(key)
                }

    def _ends(self, key: str) -> list[tuple[str, str, str]]:
        """What is told of a quantity: the largest size of a vector, or both ends; with the unit."""
        unit, at = QUANTITIES[key], self.result.motion.unit
        largest = [("largest", "largest", unit), ("largest at", "largest_at", at)]
        sized = key in ("speed", "acceleration", "momentum")
        return largest if sized else [("smallest", "smallest", unit), ("smallest at", "smallest_at", at), *largest]

    def _whole(self, of: str) -> Iterator[Row]:
        at = self.result.motion.unit
        for load_case, rates in self._rates():
            for name, unit, row in whole_rows(rates):
                yield {
                    "load case": load_case,
                    "quantity": name,
                    "unit": unit,
                    "smallest": row.get("smallest"),
                    f"smallest at [{at}]": row.get("smallest_at"),
                    "largest": row["largest"],
                    f"largest at [{at}]": row.get("largest_at"),
                }

    def _rates(self) -> Iterator[tuple[str, dict[str, Any]]]:
        for load_case in self.result.torque:
            if (rates := rates_record(self.result, load_case)) is not None:
                yield load_case, rates

    @cached_property
    def _found(self) -> MotionFindings:
        """The motion with all that is told of it."""
        return motion_findings(self.result)

    @cached_property
    def _play(self) -> PlayOverMotion | None:
        return play_over_motion(self.result)

    def _drive_rows(self, of: str) -> Iterator[Row]:
        what, unit = self.result.effort
        at = self.result.motion.unit
        for load_case, found in record(self._found, "")["load_cases"].items():
            told = {f"drive {what} on {self.result.drive.link}": (unit, found[f"drive_{what}"])}
            told |= {f"joint {joint}": ("N", values) for joint, values in (found["joints"] or {}).items()}
            if "drive_power" in found:
                told["drive power"] = ("W", found["drive_power"])
            for name, (unit, values) in told.items():
                yield {
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

    def plot_drive(self) -> Picture:
        """Draw drive torque or force over the coordinate, a line per load case."""
        from alula.reports.figures.motion.motion_figures import torque_figure

        return _picture(torque_figure(self.result, self._play))

    def plot_energy(self, load_case: str) -> Picture:
        """Draw energies, power of the drive and force on the ground of a load case that has a speed.

        Parameters
        ----------
        load_case : str

        Returns
        -------
        Picture

        Raises
        ------
        CaseError
            For a load case that does not exist or has no speed.
        """
        from alula.reports.figures.motion.rate_figures import energy_figure

        moving = {name: found for name in self.result.torque if (found := series(self.result, name)) is not None}
        return _picture(energy_figure(self.result, load_case, pick(moving, load_case, "load case with a speed")))

    def plot_linkage(self) -> Picture:
        """Draw the linkage at a few poses, with the paths of its points."""
        from alula.reports.figures.motion.motion_figures import paths_figure

        return _picture(paths_figure(self.result.motion, self._play))

    def __str__(self) -> str:
        return str(self.table())

    def __repr__(self) -> str:
        return f"<motion of {self.result.case.title!r}: {len(self.coordinates)} poses>"

    def _repr_html_(self) -> str:
        from html import escape

        return f"<p><b>{escape(self.result.case.title)}</b></p>\n{self.table()._repr_html_()}"


def _picture(figure: object) -> Picture:
    from alula.reports.figures.motion.motion_figures import DPI
    from alula.reports.figures.sheet.chart import Chart

    return Picture(Chart(figure, dpi=DPI).png())
