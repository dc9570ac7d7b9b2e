"""Design figures of a flapping wing, by the source's definitions and by the meaning of their names."""

import math
from typing import Any

from alula.loads.case.case import Case
from alula.reports.sections.section import Items, Section, Text
from alula.reports.sections.table import Column, Number, Table, numbers, words

_FIGURES = (
    (
        "phase lag",
        "phase_lag",
        "|Σβ left − Σβ right| over 361 poses: the sides' difference at crank angle 0",
        "crank angle between the reversals of the two sides",
    ),
    ("side difference", "side_difference", "", "largest difference of the two sides' rocker angles"),
    (
        "oscillation",
        "oscillation",
        "max β + |min β| over 361 poses",
        "max β − min β, where crank and coupler are collinear",
    ),
    (
        "asymmetry",
        "asymmetry",
        "mean of what ψ leaves 90° by, upwards and downwards",
        "largest deviation of the transmission angle from 90°",
    ),
    ("transmission, least", "transmission_min", "", "least angle ψ between coupler and rocker"),
    ("transmission, greatest", "transmission_max", "", "greatest angle ψ"),
    ("outer wing, lowest", "lambda_min", "", "least λ to the horizontal"),
    ("outer wing, highest", "lambda_max", "", "greatest λ to the horizontal"),
)
"""Name, field, the source's definition ("" where it has none), and the definition as the name means."""


def design_section(case: Case) -> Section:
    """Return the design figures of a flapping wing, and the source's criteria for them.

    Parameters
    ----------
    case : Case

    Returns
    -------
    Section
        Without parts for other cases.

    Raises
    ------
    CaseError
        For a wing whose crank does not turn fully.
    """
    if case.flapping_wing is None:
        return Section(key="design", data={"design": None})
    wing = case.flapping_wing.wing(case.linkage)
    theirs, ours, criteria = wing.published_metrics(), wing.metrics(), wing.criteria()
    figures: list[dict[str, Any]] = [
        {
            "name": name,
            "published_definition": math.degrees(getattr(theirs, field)) if source else None,
            "proper": math.degrees(getattr(ours, field)),
            "published_as": source or None,
            "proper_as": own,
        }
        for name, field, source, own in _FIGURES
    ]
    published = (row["published_definition"] for row in figures)
    return Section(
        key="design",
        title="The design of the flapping wing",
        parts=(
            Text(
                "The source’s program defines some figures differently from what their names mean. Both are shown, "
                "from the closed form of one side’s four-bar over a full turn of the crank.",
                "note",
            ),
            Table.by_columns(
                {
                    words("figure"): [row["name"] for row in figures],
                    Column("as the source defines it", "deg"): [
                        "" if value is None else Number(value, decimals=4) for value in published
                    ],
                    words("source's definition", wraps=True): [row["published_as"] or "" for row in figures],
                    Column("as its name means", "deg"): numbers((row["proper"] for row in figures), decimals=4),
                    words("definition", wraps=True): [row["proper_as"] for row in figures],
                },
                key="design",
            ),
            Text("The source’s criteria, judged by the figures as their names mean:"),
            Items(tuple(f"{'Met' if one.fulfilled else 'Not met'}: {one.sentence}" for one in criteria)),
        ),
        data={
            "design": {
                "figures": figures,
                "criteria": [{"fulfilled": one.fulfilled, "sentence": one.sentence} for one in criteria],
            }
        },
    )
