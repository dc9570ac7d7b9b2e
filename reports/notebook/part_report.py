"""What ``alula.inspect`` returns."""

from dataclasses import dataclass

from alula.geometry.base.errors import CannotRunError
from alula.loads.exchange.part import part_entries
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, table_of
from alula.reports.tools.part import BORES, GRAMS, Inspection, part_section


@dataclass(frozen=True)
class PartReport(Tabled):
    """What a STEP file or a mesh holds, as ``alula inspect`` finds it.

    Attributes
    ----------
    result : Inspection
        The record that the numbers come from.
    """

    result: Inspection

    @property
    def volume(self) -> float:
        """Volume [mm³]."""
        return float(self.result.facts.volume)

    @property
    def mass(self) -> float | None:
        """Mass [g]; None where no material is named."""
        return None if self.result.mass is None else self.result.mass * GRAMS

    @property
    def entries(self) -> str:
        """The entries of a case file for the part, as TOML; empty where it has no bore for a pin."""
        return part_entries(self.result)

    def table(self) -> ShownTable:
        """Return one row a bore: diameter, length and centre [mm] in the frame of the file."""
        return table_of([part_section(self.result)], BORES)

    def plot_part(self) -> ShownPicture:
        """Draw the part from above and from below, with its bores and largest flat faces named.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CannotRunError
            Where rendering fails.
        """
        from alula.reports.figures.part_picture import part_picture

        picture, trouble = part_picture(self.result.facts, self.result.surface)
        if picture is None:
            raise CannotRunError(trouble)
        return ShownPicture(picture.png())

    def __repr__(self) -> str:
        return f"<{self.result.path.name}: {len(self.result.facts.bores)} bores>"
