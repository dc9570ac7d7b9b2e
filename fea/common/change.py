"""What would change the verdict of a check, as ``alula.fea.sizing.changes`` finds it."""

import math
from dataclasses import dataclass
from typing import Literal

from alula.fea.common.source import Source
from alula.fea.common.verdict import CheckOutcome

EXACT = 1e-9
"""Share of a factor that is rounding."""
Property = Literal[
    "yield strength", "ultimate strength", "strength of the layers", "sustained strength", "modulus", "all moduli"
]


@dataclass(frozen=True, kw_only=True)
class SizeRange:
    """An entry of a case, and the range in which its size may be sought.

    Attributes
    ----------
    entry : str
        Path, such as ``parts.tube.outer_diameter``.
    first, last : str
        Ends, with their unit; the case takes both.
    """

    entry: str
    first: str
    last: str


@dataclass(frozen=True, kw_only=True)
class MaterialChange:
    """A material that would take the unfavourable end of a band to its limit.

    Attributes
    ----------
    what : Property
        For people, too.
    material : str
        Name of the material; "" where it is all of them.
    stated : float
        Its property as it is [MPa]; 1 of all moduli together.
    needed : float
        The least that suffices; of a check that passes, how low it may be, and a modulus by linear theory.
    """

    what: Property
    material: str
    stated: float
    needed: float


@dataclass(frozen=True, kw_only=True)
class VerdictChange:
    """What would change the verdict of a check.

    Attributes
    ----------
    check : CheckOutcome
    load : float or None
        Factor on all loads of its load case that takes the unfavourable end of its band to the limit; None where that
        does not follow.
    faster : bool
        True where the number changes faster than the loads: what passes may grow by less than ``load``, and for what
        does not ``load`` suffices.
    until : float
        Factor on the loads up to which the number goes with them; infinite where it does so by definition.
    material : MaterialChange or None
    widest : tuple of Source
        Of an open check, what most of its band comes from; several where they are not known one by one.
    size : SizeRange or None
        What to size with ``alula size``; None where no value was found that passes.
    sizable : bool
        False where the check is open for its model rather than for its number, which no size decides.
    refuted : bool
        True where a load or material was tried and none was found that does.
    """

    check: CheckOutcome
    load: float | None = None
    faster: bool = False
    until: float = math.inf
    material: MaterialChange | None = None
    widest: tuple[Source, ...] = ()
    size: SizeRange | None = None
    sizable: bool = False
    refuted: bool = False


def rounded(value: float, *, up: bool, digits: int = 3) -> float:
    """Return a number to some digits, upwards or downwards, so that it still does what it should.

    Parameters
    ----------
    value : float
    up : bool
    digits : int, optional

    Returns
    -------
    float
    """
    if value <= 0.0 or not math.isfinite(value):
        return value
    step = 10.0 ** (math.floor(math.log10(value)) - digits + 1)
    steps = math.ceil(value / step - EXACT) if up else math.floor(value / step + EXACT)
    return steps * step
