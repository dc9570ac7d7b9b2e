"""What ``alula.motion`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.of_motion import MotionFindings, PlayOverMotion, motion_findings, play_over_motion
from alula.fea.findings.rates import series
from alula.geometry.base.errors import CaseError
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.instant_centre import InstantCentre
from alula.reports.motion.whole_motion import motion_sections
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, pick, table_of
from alula.reports.sections.section import Section

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

    @property
    def instant_centre(self) -> InstantCentre | None:
        """Path of the instant centre, and where load lines run past it; None where the case asks for none."""
        return self._found.centre

    def table(self, of: str = "drive") -> ShownTable:
        """Return a table of the motion, with rows per load case.

        Parameters
        ----------
        of : str, optional
            ``drive``: drive and joint forces, with first, last and extreme values. ``links``: angular speeds,
            accelerations, momentum and kinetic energy of the links; ``points``: speeds and accelerations of the points;
            ``energy``: momentum, energies and shaking of the linkage; all three of the load cases that have a speed.
            Or any other table of the page, such as ``directions``, ``springs``, ``play``, ``gaps``, ``wings``.

        Returns
        -------
        ShownTable
            ``at`` is the value of the coordinate there. Extremes are None where a dead point makes them unbounded, and
            where a quantity is not known. Of a vector, the largest is that of its size.

        Raises
        ------
        CaseError
            For a table that there is not; the error lists the others.
        """
        return table_of(self._sections, of)

    @cached_property
    def _sections(self) -> tuple[Section, ...]:
        return motion_sections(self._found)

    @cached_property
    def _found(self) -> MotionFindings:
        """The motion with all that is told of it."""
        return motion_findings(self.result)

    @cached_property
    def _play(self) -> PlayOverMotion | None:
        return play_over_motion(self.result)

    def plot_drive(self) -> ShownPicture:
        """Draw drive torque or force over the coordinate, a line per load case."""
        from alula.reports.figures.motion.motion_figures import torque_figure

        return _picture(torque_figure(self.result, self._play))

    def plot_energy(self, load_case: str) -> ShownPicture:
        """Draw energies, power of the drive and force on the ground of a load case that has a speed.

        Parameters
        ----------
        load_case : str

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a load case that does not exist or has no speed.
        """
        from alula.reports.figures.motion.rate_figures import energy_figure

        moving = {name: found for name in self.result.torque if (found := series(self.result, name)) is not None}
        return _picture(energy_figure(self.result, load_case, pick(moving, load_case, "load case with a speed")))

    def plot_linkage(self) -> ShownPicture:
        """Draw the linkage at a few poses, with the paths of its points."""
        from alula.reports.figures.motion.motion_figures import paths_figure

        return _picture(paths_figure(self.result.motion, self._play))

    def plot_instant_centre(self) -> ShownPicture:
        """Draw the path of the instant centre for which the case asks, with the load lines at the first and last pose.

        Over a cycle they are those at the least and the largest value of its coordinate.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            Where the case asks for none.
        """
        from alula.reports.figures.motion.motion_figures import centre_figure

        if self.instant_centre is None:
            raise CaseError(
                'motion.instant_centre: the case asks for none; state a link, as in instant_centre = "thigh"'
            )
        return _picture(centre_figure(self.instant_centre, self.result.motion))

    def __repr__(self) -> str:
        return f"<motion of {self.result.case.title!r}: {len(self.coordinates)} poses>"

    def _repr_html_(self) -> str:
        from html import escape

        return f"<p><b>{escape(self.result.case.title)}</b></p>\n{self.table()._repr_html_()}"


def _picture(figure: object) -> ShownPicture:
    from alula.reports.figures.motion.motion_figures import DPI
    from alula.reports.figures.sheet.chart import Chart

    return ShownPicture(Chart(figure, dpi=DPI).png())
