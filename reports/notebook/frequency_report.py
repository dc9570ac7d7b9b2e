"""What ``alula.frequencies`` returns."""

from collections.abc import Mapping
from dataclasses import dataclass

from alula.fea.common.band import Band
from alula.fea.vibration.frequency_outcomes import deciding_load_case, least_frequency, unit
from alula.fea.vibration.over_motion import CaseFrequencies, FrequencyHistory
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, pick, table_of
from alula.reports.sections.frequencies import frequencies_section, history_sentence

RENAMED = {"low": "frequency [Hz] low", "high": "frequency [Hz] high"}
"""Names that columns had before -> their names now, for one version."""


@dataclass(frozen=True)
class FrequencyReport(Tabled):
    """Natural frequencies of a linkage over its motion and of each link by itself, as ``alula frequencies`` finds them.

    Attributes
    ----------
    result : CaseFrequencies
        The record that the numbers come from: frequencies at all poses, and shapes.
    """

    result: CaseFrequencies

    @property
    def lowest(self) -> Mapping[str, Band]:
        """Lowest natural frequency over the motion under every load case [Hz]: ``value``, ``low``, ``high``."""
        return {name: least_frequency(history) for name, history in self.result.histories.items()}

    @property
    def links(self) -> Mapping[str, tuple[Band, ...]]:
        """Natural frequencies of every link by itself, its joints held [Hz]."""
        return {name: tuple(mode.frequency for mode in found.modes) for name, found in self.result.links.items()}

    @property
    def sentences(self) -> Mapping[str, str]:
        """Of every load case: where the lowest natural frequency is least, and which harmonic meets one."""
        return {name: history_sentence(self.result.case, one) for name, one in self.result.histories.items()}

    def table(self, of: str = "frequencies") -> ShownTable:
        """Return a row for every natural frequency: of the linkage where the lowest is least, and of the links.

        Parameters
        ----------
        of : str, optional
            ``frequencies``, the only one.

        Returns
        -------
        ShownTable

        Raises
        ------
        CaseError
            For another table.
        """
        return table_of([frequencies_section(self.result)], of, RENAMED)

    def plot_campbell(self, load_case: str | None = None) -> ShownPicture:
        """Draw natural frequencies over the motion, and over the speed of the drive, with its harmonics.

        Parameters
        ----------
        load_case : str, optional
            Its name; the one that decides when left out.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a load case that there is not.
        """
        from alula.reports.figures.vibration.campbell import campbell_diagram

        name, history = self._history(load_case)
        case = self.result.case
        coordinate = "pose" if case.motion is None else case.motion_coordinate.name
        return ShownPicture(campbell_diagram(history, coordinate=coordinate, unit=unit(case), load_case=name).png())

    def plot_shapes(self, load_case: str | None = None) -> ShownPicture:
        """Draw the shapes of the lowest natural frequencies, in the pose where the first is least.

        Parameters
        ----------
        load_case : str, optional
            Its name; the one that decides when left out.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a load case that there is not.
        """
        from alula.reports.figures.vibration.shapes import shapes_drawing

        return ShownPicture(shapes_drawing(self._history(load_case)[1].lowest).png())

    def _history(self, load_case: str | None) -> tuple[str, FrequencyHistory]:
        name = deciding_load_case(self.result) if load_case is None else load_case
        return name, pick(self.result.histories, name, "load case")

    def __str__(self) -> str:
        return "\n".join((*self.sentences.values(), "", str(self.table())))

    def __repr__(self) -> str:
        return f"<natural frequencies of {self.result.case.title!r}>"
