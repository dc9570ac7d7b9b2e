"""What the command ``alula synth`` is given: three precision points as text, and a ground link."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import POSITIVE, Angle, Length
from alula.geometry.mechanisms.synthesis import Synthesis, synthesise
from alula.loads.text.explain import printable, sentence

PUBLISHED_POINTS = ("0 deg, 30 deg", "20 deg, 110 deg", "5 deg, 130 deg")
"""Precision points (theta, psi) of Arango and Hurtado."""
PUBLISHED_GROUND = "10 m"


class _Pair(CaseModel):
    theta: Angle
    psi: Angle


class _Ground(CaseModel):
    d: Annotated[Length, POSITIVE]


def read_synthesis(points: Sequence[str], ground: str) -> Synthesis:
    """Synthesise a four-bar from text.

    Parameters
    ----------
    points : sequence of str
        Three pairs (theta, psi) such as ``"20 deg, 110 deg"``.
    ground : str
        A length such as ``"10 m"``.

    Returns
    -------
    Synthesis

    Raises
    ------
    CaseError
        For other than three points, for invalid text, and where no linkage follows from the points.
    """
    if len(points) != 3:
        raise CaseError(f"--point: there are {len(points)} precision points, but the synthesis takes three; give three")
    pairs = []
    for number, text in enumerate(points, start=1):
        theta, comma, psi = text.partition(",")
        if not comma:
            raise CaseError(
                f"--point {number}: '{printable(text)}' is no pair of angles; write theta and psi with a comma "
                'between, for example "20 deg, 110 deg"'
            )
        try:
            pairs.append(_Pair.model_validate({"theta": theta.strip(), "psi": psi.strip()}))
        except ValidationError as error:
            raise CaseError(f"--point {number}: {sentence(error, _Pair)}") from None
    try:
        d = _Ground.model_validate({"d": ground}).d
    except ValidationError as error:
        raise CaseError(f"--ground: {sentence(error, _Ground)}") from None
    return synthesise([pair.theta for pair in pairs], [pair.psi for pair in pairs], d)
