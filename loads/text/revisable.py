"""A case knows what it was read from, so that it can be read once more with other values for some entries."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Self

from pydantic import PrivateAttr

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel


@dataclass(frozen=True, kw_only=True)
class Origin:
    """Where a case was read from; no part of what makes two cases equal.

    Attributes
    ----------
    name : str
        Path or built-in name; "" for a case that was not read.
    revise : callable or None
        Reads it once more, with other values for some entries; None where that cannot be.
    changes : tuple of tuple of (str, str)
        Entries that were changed beside the file, as ``--set`` states them.
    digest : str
        SHA-256 of the case file as it was read; of its tables as JSON with sorted keys, where no file was; "" of a case
        that was changed in Python afterwards.
    files : mapping of str to str
        Other files that were read for it, by their paths from its folder -> SHA-256.
    """

    name: str = field(default="", compare=False)
    revise: Callable[[Mapping[str, object]], Any] | None = field(default=None, compare=False)
    changes: tuple[tuple[str, str], ...] = field(default=(), compare=False)
    digest: str = field(default="", compare=False)
    files: Mapping[str, str] = field(default_factory=dict, compare=False)


class Revisable(CaseModel):
    """A record that can be read once more with other values."""

    _origin: Origin = PrivateAttr(default_factory=Origin)

    @property
    def origin(self) -> str:
        """Path or built-in name that it was read from; "" where it was put together in Python."""
        return self._origin.name

    @property
    def changes(self) -> tuple[tuple[str, str], ...]:
        """Path and value of the entries that were changed beside the file, as ``--set`` states them."""
        return self._origin.changes

    @property
    def digest(self) -> str:
        """SHA-256 of what it was read from, as ``Origin`` says."""
        return self._origin.digest

    @property
    def files(self) -> Mapping[str, str]:
        """Other files that were read for it, by their paths from its folder -> SHA-256."""
        return self._origin.files

    def read_from(self, origin: Origin) -> Self:
        """Return a copy with an origin.

        Parameters
        ----------
        origin : Origin
            Where it was read from.

        Returns
        -------
        Revisable
            The copy.
        """
        copied = self.model_copy()
        copied._origin = origin
        return copied

    def with_values(self, values: Mapping[str, object]) -> Self:
        """Return the case with other values for some entries; this one stays as it is.

        Parameters
        ----------
        values : mapping of str to object
            New value by the path of its entry, as for ``--set`` of the command: ``"parts.tube.outer_diameter"``, or
            ``"links.AE.points.P.0"`` for the first entry of a list. Quantities are text with their unit.

        Returns
        -------
        Case
            Read and validated anew, with all that follows from the entries.

        Raises
        ------
        CaseError
            For an entry that the case does not have, a value that breaks a rule of the case file, and a case that
            ``read_case`` did not return.

        Examples
        --------
        >>> import alula
        >>> case = alula.read_case("owl-wing-static")
        >>> thicker = case.with_values({"parts.tube.outer_diameter": "6 mm"})
        >>> case.parts["tube"].outer_diameter, thicker.parts["tube"].outer_diameter  # mm
        (5.0, 6.0)
        """
        if self._origin.revise is None:
            raise CaseError(
                "with_values: this case was built or changed in Python, so it has no file to be read from anew; "
                "start from a case that read_case returned"
            )
        revised: Self = self._origin.revise(values)
        return revised

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with other fields, and without what was worked out from the fields before.

        Parameters
        ----------
        update : mapping of str to object, optional
            New values of fields; they are not validated.
        deep : bool
            Copy the values of the fields as well.

        Returns
        -------
        Revisable
            The copy.
        """
        copied = super().model_copy(update=update, deep=deep)
        if update:
            for name in copied.__dict__.keys() - type(self).model_fields.keys() - update.keys():
                del copied.__dict__[name]
            copied._origin = Origin(name=self.origin)
        return copied
