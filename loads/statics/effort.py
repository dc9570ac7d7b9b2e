"""What a drive exerts: a torque on a link, or a force along a guide."""

from enum import Enum
from typing import Any


class DriveEffort(Enum):
    """The kind of what a drive exerts.

    Attributes
    ----------
    word : str
        Its name for people.
    unit : str
        Its unit.
    """

    TORQUE = "torque", "N·mm"
    FORCE = "force", "N"

    def __init__(self, word: str, unit: str) -> None:
        self.word, self.unit = word, unit

    @property
    def entry(self) -> str:
        """Its name in records and results, ``drive_torque`` or ``drive_force``."""
        return f"drive_{self.word}"

    def alone(self, value: Any, other: Any) -> dict[str, Any]:
        """Return the values of both kinds, of which a drive exerts this one.

        Parameters
        ----------
        value : float or array (n,)
            Of this kind [N mm, N].
        other : float or None
            Of the other kind.

        Returns
        -------
        dict
            By ``entry``.
        """
        return {kind.entry: value if kind is self else other for kind in DriveEffort}
