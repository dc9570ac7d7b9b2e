"""What ``alula.envelope`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.verdict import Verdict
from alula.fea.motion.envelope_result import EnvelopeResult
from alula.geometry.base.errors import CannotRunError
from alula.reports.commands.envelope import drive_angle
from alula.reports.notebook.check_report import check_rows
from alula.reports.notebook.shown import Picture, Row, Table, Tabled, pick, summary
from alula.reports.sentences import told

Real = NDArray[np.float64]


@dataclass(frozen=True)
class EnvelopeReport(Tabled):
    """A case over its whole motion, as ``alula envelope`` makes it.

    Attributes
    ----------
    result : EnvelopeResult
        The record that the numbers come from: curves over the motion, fatigue, meshes.
    """

    result: EnvelopeResult

    @property
    def verdict(self) -> Verdict:
        """Pass, fail or undecided; equal to the text ``"pass"``, ``"fail"`` or ``"undecided"``."""
        return self.result.verdict

    @property
    def headline(self) -> str:
        """The verdict, what decides it, and what it stands on besides."""
        from alula.reports.page.motion_pages import envelope_headline

        return envelope_headline(self.result)

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return tuple(map(told, self.result.warnings))

    @property
    def coordinates(self) -> Real:
        """Direction (n,) of the link that the motion prescribes [degrees]."""
        return np.degrees(self.result.angles)

    @property
    def safety_factors(self) -> Mapping[str, Band]:
        """Least safety factor of every loaded link over motion and load cases [1], with its band."""
        return {name: link.worst.safety_factor.told for name, link in self.result.links.items()}

    def stress(self, link: str, load_case: str) -> Real:
        """Return the stress (n,) that decides on a link at every pose [MPa]; NaN where the pose was left out.

        Parameters
        ----------
        link : str
            Their names.
        load_case : str
            Their names.

        Returns
        -------
        array
            [MPa].

        Raises
        ------
        CaseError
            For a link or load case that there is not, or that does not load the link.
        """
        return pick(pick(self.result.links, link, "loaded link").load_cases, load_case, "load case").value

    def table(self, of: Literal["links", "checks"] = "links") -> Table:
        """Return a table of the result.

        Parameters
        ----------
        of : {"links", "checks"}
            The worst pose of every link and load case, or the checks with value, band and limit.

        Returns
        -------
        Table
            A sequence of mappings, shown as a table.

        Raises
        ------
        CaseError
            For another table.
        """
        tables = {"links": self._link_rows, "checks": self._check_rows}
        return Table(tuple(pick(tables, of, "table")()))

    def plot_safety_factors(self) -> Picture:
        """Draw the safety factor of every link over the motion."""
        from alula.reports.figures.motion.envelope_figures import envelope_figure

        return Picture(envelope_figure(self.result).png())

    def plot_stress(self, link: str) -> Picture:
        """Draw the stress of a link at its worst pose under its worst load case.

        Parameters
        ----------
        link : str
            A link on which something acts.

        Returns
        -------
        Picture

        Raises
        ------
        CaseError
            For a link that there is not.
        CannotRunError
            Where rendering fails.
        """
        from alula.reports.figures.motion.envelope_figures import stress_pictures

        pick(self.result.links, link, "loaded link")
        plots, warnings = stress_pictures(self.result, [link])
        if link not in plots:
            raise CannotRunError("; ".join(warnings))
        return Picture(plots[link].png())

    def __str__(self) -> str:
        return f"{self.headline}\n\n{self.table()}"

    def __repr__(self) -> str:
        return f"<envelope of {self.result.case.title!r}: {self.verdict}>"

    def _repr_html_(self) -> str:
        return summary(self.verdict, self.result.case.title, self.headline, self.table(), self.warnings)

    def _check_rows(self) -> list[Row]:
        return check_rows(self.result.checks)

    def _link_rows(self) -> list[Row]:
        return [
            {
                "link": name,
                "load case": load_case,
                "safety factor": found.safety_factor.value,
                "low": found.safety_factor.told.low,
                "high": found.safety_factor.told.high,
                "stress": link.measure,
                "stress [MPa]": found.stress.value,
                f"at {self.result.drive.link} [deg]": drive_angle(self.result, found.pose),
                "repetitions to failure": None
                if found.fatigue is None or found.fatigue.repetitions is None
                else found.fatigue.repetitions.value,
            }
            for name, link in self.result.links.items()
            for load_case, found in link.load_cases.items()
        ]
