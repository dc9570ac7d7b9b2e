"""What ``alula.synthesise`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass

from alula.geometry.mechanisms.synthesis import Synthesis
from alula.reports.figures.four_bar import precision_points_png
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, table_of
from alula.reports.tools.synthesis import POINTS, synthesis_section


@dataclass(frozen=True)
class SynthesisReport(Tabled):
    """A four-bar through three precision points, as ``alula synth`` finds it.

    Attributes
    ----------
    result : Synthesis
        The record that the numbers come from.
    """

    result: Synthesis

    @property
    def lengths(self) -> Mapping[str, float]:
        """Length of each link [mm]: ``"a"`` and ``"c"`` at the ground, ``"b"`` between them, ``"d"`` the ground."""
        return {name: float(getattr(self.result.four_bar, name)) for name in "abcd"}

    @property
    def findings(self) -> tuple[str, ...]:
        """What its user must know, one sentence each: branch and order defects, lock-ups, Grashof's condition."""
        return tuple(finding.sentence for finding in self.result.findings)

    def table(self) -> ShownTable:
        """Return the precision points: directions of the links [degrees], and the branch as seen from each drive."""
        return table_of([synthesis_section(self.result)], POINTS)

    def plot_linkage(self) -> ShownPicture:
        """Draw the linkage at the three precision points."""
        return ShownPicture(precision_points_png(self.result))

    def __repr__(self) -> str:
        told = ", ".join(f"{name} {length:.4g} mm" for name, length in self.lengths.items())
        return f"<four-bar: {told}>"
