"""What checks find besides the numbers that they judge: by which mode a subject ends, at what factor, and where."""

from dataclasses import dataclass
from typing import Generic, TypeVar

from alula.fea.common.verdict import Subject

T_co = TypeVar("T_co", covariant=True)


@dataclass(frozen=True, kw_only=True)
class Found(Generic[T_co]):
    """What a check found of its subject; ``alula.reports.check.modes`` tells it, kind by kind.

    Attributes
    ----------
    check : str
        Its name.
    subject : Subject
    numbers : object
        A record of their own kind, such as ``EyeFactors``; of several eyes each by itself.
    """

    check: str
    subject: Subject
    numbers: T_co
