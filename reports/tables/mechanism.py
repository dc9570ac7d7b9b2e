"""Design figures of a flapping wing, by the source's definitions and by the meaning of their names."""

import math
from dataclasses import dataclass
from typing import Any

from alula.loads.case.case import Case


@dataclass(frozen=True, kw_only=True)
class DesignFigure:
    """One figure of a design [deg].

    Attributes
    ----------
    name : str
        Its name.
    published : float, optional
        By the source's definition; None where it has none.
    published_as : str
        That definition in words.
    proper : float
        As its name means.
    proper_as : str
        That definition in words.
    """

    name: str
    published: float | None
    published_as: str
    proper: float
    proper_as: str


@dataclass(frozen=True, kw_only=True)
class Design:
    """Figures of a design and criteria for them.

    Attributes
    ----------
    figures : tuple of DesignFigure
    criteria : tuple of tuple
        Pairs (fulfilled, sentence).
    """

    figures: tuple[DesignFigure, ...]
    criteria: tuple[tuple[bool, str], ...]


def design_of(case: Case) -> Design | None:
    """Return the design figures of a flapping wing.

    Parameters
    ----------
    case : Case

    Returns
    -------
    Design or None
        None for other cases.

    Raises
    ------
    CaseError
        For a wing whose crank does not turn fully.
    """
    if case.flapping_wing is None:
        return None
    wing = case.flapping_wing.wing(case.linkage)
    theirs, ours = wing.published_metrics(), wing.metrics()
    rows = (
        (
            "phase lag",
            theirs.phase_lag,
            "|Σβ left − Σβ right| over 361 poses: the sides' difference at crank angle 0",
            ours.phase_lag,
            "crank angle between the reversals of the two sides",
        ),
        (
            "side difference",
            None,
            "",
            ours.side_difference,
            "largest difference of the two sides' rocker angles",
        ),
        (
            "oscillation",
            theirs.oscillation,
            "max β + |min β| over 361 poses",
            ours.oscillation,
            "max β − min β, where crank and coupler are collinear",
        ),
        (
            "asymmetry",
            theirs.asymmetry,
            "mean of what ψ leaves 90° by, upwards and downwards",
            ours.asymmetry,
            "largest deviation of the transmission angle from 90°",
        ),
        ("transmission, least", None, "", ours.transmission_min, "least angle ψ between coupler and rocker"),
        ("transmission, greatest", None, "", ours.transmission_max, "greatest angle ψ"),
        ("outer wing, lowest", None, "", ours.lambda_min, "least λ to the horizontal"),
        ("outer wing, highest", None, "", ours.lambda_max, "greatest λ to the horizontal"),
    )
    return Design(
        figures=tuple(
            DesignFigure(
                name=name,
                published=None if published is None else math.degrees(published),
                published_as=published_as,
                proper=math.degrees(proper),
                proper_as=proper_as,
            )
            for name, published, published_as, proper, proper_as in rows
        ),
        criteria=tuple((criterion.fulfilled, criterion.sentence) for criterion in wing.criteria()),
    )


def design_record(case: Case) -> dict[str, Any] | None:
    """Return the design figures as plain data [deg].

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict or None
        None for a case without a flapping wing.
    """
    design = design_of(case)
    if design is None:
        return None
    return {
        "figures": [
            {
                "name": figure.name,
                "published_definition": figure.published,
                "proper": figure.proper,
                "published_as": figure.published_as or None,
                "proper_as": figure.proper_as,
            }
            for figure in design.figures
        ],
        "criteria": [{"fulfilled": fulfilled, "sentence": sentence} for fulfilled, sentence in design.criteria],
    }


def design_lines(case: Case) -> list[str]:
    """Return the design figures as lines for the terminal.

    Parameters
    ----------
    case : Case

    Returns
    -------
    list of str
        Empty for a case without a flapping wing.
    """
    design = design_of(case)
    if design is None:
        return []
    lines = ["Design figures of the flapping wing [deg]", f"  {'':<24}{'as the source':>14}{'as its name':>13}"]
    lines.append(f"  {'':<24}{'defines them':>14}{'means':>13}")
    for figure in design.figures:
        published = "" if figure.published is None else f"{figure.published:.4f}"
        lines.append(f"  {figure.name:<24}{published:>14}{figure.proper:>13.4f}   {figure.proper_as}")
    lines.append("Criteria of the source")
    lines += [f"  {'met    ' if fulfilled else 'not met'}  {sentence}" for fulfilled, sentence in design.criteria]
    return lines
