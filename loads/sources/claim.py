"""Published figures as claims: what a source says of a quantity, with its unit and printed digits."""

import math
import re
import tomllib
from dataclasses import dataclass
from importlib.resources import files
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, Text, refusal
from alula.geometry.base.units import POSITIVE, Angle, AngularSpeed, Length
from alula.geometry.mechanisms.ornithopter import OrnithopterRules
from alula.loads.sources.expression import evaluate_number
from alula.loads.sources.quantity import Value
from alula.loads.text.explain import printable, sentence

_FIGURE = re.compile(r"\s*([+-]?)((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-zµμ°Ω%]\S*)?\s*", re.ASCII)
_EXACT = 1e-9
"""Relative slack for the rounding of binary numbers at the edge of a printed digit."""


@dataclass(frozen=True, kw_only=True)
class Printed:
    """A published number as printed.

    Attributes
    ----------
    number : float
        Such as 0.952.
    unit : str
        Such as "N".
    half : float
        Half a unit of the last printed digit, in that unit.
    """

    number: float
    unit: str
    half: float

    @property
    def value(self) -> Value:
        """The number with its dimension."""
        return Value.of(self.number, self.unit)


def read_printed(text: str) -> Printed | None:
    """Read a published figure.

    Parameters
    ----------
    text : str
        Such as ``"0.9520 N"`` or ``"5.027e-5 N"``.

    Returns
    -------
    Printed or None
        The number; None for words, such as ``"open"``.

    Raises
    ------
    CaseError
        Where a number is followed by what is no unit.
    """
    match = _FIGURE.fullmatch(text.replace("−", "-"))
    if match is None:
        return None
    sign, digits, unit = match[1], match[2], match[3] or ""
    mantissa, _, exponent = digits.lower().partition("e")
    number = float(sign + digits)
    # The exponent by itself: that of a zero is not in the number.
    if len(digits) > 32 or not math.isfinite(number) or abs(int(exponent or 0)) > 300:
        raise CaseError(f"published '{printable(text)}': the number is too long or too large; write it as printed")
    decimals = len(mantissa.partition(".")[2])
    half = 0.5 * 10.0 ** (int(exponent or 0) - decimals)
    printed = Printed(number=number, unit=unit, half=half)
    _ = printed.value
    return printed


def _claim_name(text: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._+-]{0,79}", text):
        raise refusal("a claim's name is made of letters, digits, '.', '-', '_' and '+', at most 80; rename it")
    return text


def _published(text: str) -> str:
    try:
        read_printed(text)
    except CaseError as error:
        raise refusal(str(error)) from None
    return text


Expression = Annotated[str, Field(max_length=500)]


class Claim(CaseModel):
    """A published figure: what it says, where it stands, and how it can be re-derived."""

    name: Annotated[str, AfterValidator(_claim_name)]
    """Name of the claim, for the table of findings: letters, digits, '.', '-', '_' and '+', at most 80."""
    quantity: Expression = ""
    """Our value: a path into the results of the case, or an expression of such paths."""
    published: Annotated[Text, Field(min_length=1, max_length=200), AfterValidator(_published)]
    """The figure as printed, with its unit: ``"0.9520 N"``; words where it is no number."""
    source: Text
    """Where it is published."""
    case: Name | None = None
    """The built-in case that the quantity belongs to, in a source's own file of claims."""
    stated: Expression = ""
    """The arithmetic or relation that the source shows: ``"41.4 MPa / 11.37 MPa"``."""
    means: Expression = ""
    """What the figure's name says, where the source's own definition says something else."""
    tolerance: str = ""
    """What the figure may be off, instead of half a unit of its last digit: ``"0.1 mm"``, or ``"1 %"`` of it."""
    not_stated: dict[str, Text] = {}
    """What the source leaves out, by name; expressions refer to it as ``not_stated.NAME``."""
    note: Text = ""
    """A sentence for the reader, beyond what the finding says."""

    def model_post_init(self, context: object) -> None:
        """Check that something can be derived and that the tolerance means something.

        Parameters
        ----------
        context : object
            Of pydantic; not used.

        Raises
        ------
        CaseError
            Where it cannot or does not.
        """
        if not (self.quantity or self.stated):
            raise CaseError(f"claims.{self.name}: it has neither quantity nor stated; add one of the two")
        if self.tolerance:
            self.allowed(read_printed(self.published))

    def allowed(self, printed: Printed | None) -> float:
        """Return by how much our value may differ.

        Parameters
        ----------
        printed : Printed or None
            The published figure.

        Returns
        -------
        float
            Difference in the unit of the published figure; 0 for words.

        Raises
        ------
        CaseError
            For a tolerance that is none.
        """
        if printed is None:
            if self.tolerance:
                raise CaseError(f"claims.{self.name}.tolerance: '{self.published}' is no number; remove the tolerance")
            return 0.0
        if not self.tolerance:
            return printed.half + _EXACT * abs(printed.number)
        try:
            value = evaluate_number(self.tolerance)
            relative = self.tolerance.rstrip().endswith("%")
            size = value.to("") * abs(printed.number) if relative else value.to(printed.unit)
        except CaseError as error:
            raise CaseError(f"claims.{self.name}.tolerance: {error}") from None
        if not size >= 0.0:
            raise CaseError(f"claims.{self.name}.tolerance: it is negative; write how far the figure may be off")
        return size


class FlappingSystem(CaseModel):
    """A flapping wing of one crank and two rockers."""

    type: Literal["flapping-wing"]
    crank: Annotated[Length, POSITIVE]
    coupler: Annotated[Length, POSITIVE]
    rocker: Annotated[Length, POSITIVE]
    width: Annotated[Length, POSITIVE]
    height: Length


class TableSystem(CaseModel):
    """Published rows of flapping-wing designs; every cell of a result is a claim, named ``table.model.column``."""

    type: Literal["flapping-wing-table"]
    file: str
    """CSV file that ships with the cases."""
    source: Text


class OrnithopterSystem(CaseModel):
    """An ornithopter by its parametric rules, its crank at a constant speed."""

    type: Literal["ornithopter"]
    rules: OrnithopterRules = OrnithopterRules()
    speed: AngularSpeed


class SynthesisSystem(CaseModel):
    """A four-bar from three pairs of angles."""

    type: Literal["synthesis"]
    theta: tuple[Angle, Angle, Angle]
    psi: tuple[Angle, Angle, Angle]
    d: Annotated[Length, POSITIVE]


class CaseSystem(CaseModel):
    """A built-in case."""

    type: Literal["case"]
    case: Name


System = Annotated[
    FlappingSystem | TableSystem | OrnithopterSystem | SynthesisSystem | CaseSystem, Field(discriminator="type")
]


class PublishedSource(CaseModel):
    """All claims of one source document, and what is needed to re-derive them."""

    title: Text
    systems: dict[Name, System] = {}
    """What the paths of the claims begin with."""
    given: dict[str, str] = {}
    """Figures of the source that its arithmetic uses, as ``given.NAME``: quantities with units."""
    not_stated: dict[str, Text] = {}
    """What the source leaves out, as ``not_stated.NAME``."""
    claims: tuple[Claim, ...] = ()


def sources() -> tuple[str, ...]:
    """Names of the source documents whose claims alula ships."""
    return tuple(sorted(f.name[:-5] for f in files("alula.loads.sources").iterdir() if f.name.endswith(".toml")))


def read_source(name: str) -> PublishedSource:
    """Read the claims of a source document that alula ships.

    Parameters
    ----------
    name : str
        One of ``sources()``.

    Returns
    -------
    PublishedSource
        Its claims and what is needed to re-derive them.

    Raises
    ------
    CaseError
        For an unknown name, and for what is wrong in the file.
    """
    if name not in sources():
        raise CaseError(f"source '{printable(name)}' is unknown; choose one of {', '.join(sources())}")
    text = files("alula.loads.sources").joinpath(f"{name}.toml").read_text(encoding="utf-8")
    try:
        return PublishedSource.model_validate(tomllib.loads(text))
    except ValidationError as error:
        raise CaseError(f"source '{name}': {sentence(error, PublishedSource)}") from None
