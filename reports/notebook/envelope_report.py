"""What ``alula.envelope`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.verdict import Verdict
from alula.fea.motion.envelope_result import EnvelopeResult
from alula.geometry.base.errors import CannotRunError
from alula.reports.motion.envelope import envelope_headline, envelope_sections
from alula.reports.notebook.check_report import RENAMED as RENAMED_CHECKS
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, pick, summary, table_of
from alula.reports.sentences import told

Real = NDArray[np.float64]
RENAMED = {
    "checks": RENAMED_CHECKS["checks"],
    "links": {"low": "safety factor low", "high": "safety factor high"},
}
"""Names that columns had before -> their names now, for one version."""


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
        return " ".join(envelope_headline(self.result))

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

    def table(self, of: str = "links") -> ShownTable:
        """Return a table of the result.

        Parameters
        ----------
        of : str, optional
            ``links``: the worst pose of every link and load case; ``checks`` with value, band and limit; ``fatigue``.

        Returns
        -------
        ShownTable
            A sequence of mappings, shown as a table.

        Raises
        ------
        CaseError
            For another table; the error lists those that there are.
        """
        return table_of(envelope_sections(self.result), of, RENAMED.get(of, {}))

    def plot_safety_factors(self) -> ShownPicture:
        """Draw the safety factor of every link over the motion."""
        from alula.reports.figures.motion.envelope_figures import envelope_figure

        return ShownPicture(envelope_figure(self.result).png())

    def plot_stress(self, link: str) -> ShownPicture:
        """Draw the stress of a link at its worst pose under its worst load case.

        Parameters
        ----------
        link : str
            A link on which something acts.

        Returns
        -------
        ShownPicture

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
        return ShownPicture(plots[link].png())

    def __str__(self) -> str:
        return f"{self.headline}\n\n{self.table()}"

    def __repr__(self) -> str:
        return f"<envelope of {self.result.case.title!r}: {self.verdict}>"

    def _repr_html_(self) -> str:
        return summary(self.verdict, self.result.case.title, self.headline, self.table(), self.warnings)
