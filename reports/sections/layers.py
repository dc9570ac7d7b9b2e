"""Layers of printed links over all load cases: what they hold, and which direction of building would hold best."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.solid.layers import build_directions
from alula.fea.whole.build_directions import BuildDirections
from alula.reports.figures.build_map import build_map
from alula.reports.sections.data import data
from alula.reports.sections.section import Beside, Part, Picture, Text, paragraph
from alula.reports.sections.table import Number
from alula.reports.words.numbers import direction

ALIKE = 0.05
"""Gain in safety factor up to which another direction is not called better."""


def layer_text(found: BuildDirections) -> Text:
    """Return what the layers of a link hold as built, and which direction would hold best.

    Parameters
    ----------
    found : BuildDirections

    Returns
    -------
    Text
    """
    built: list[str | Number] = [
        f"Layers of {found.link}: built along {direction(found.layers.normal)}, its layers have a safety factor of ",
        Number(found.safety_factor),
    ]
    if found.best is None and found.safety_factor.unknowable:
        built.append("; no direction of building is proposed")
    elif found.best is None:
        built.append(" by tension alone; no direction of building is proposed, since the card has no shear strength")
    elif found.best[1] <= (1.0 + ALIKE) * found.safety_factor.value:
        built.append("; no direction of building holds noticeably more")
    else:
        built += [f"; built along {direction(found.best[0])} it would be ", Number(found.best[1], "", 3, derived=True)]
        built.append(", the largest of all directions (steps of 5°, by the same solution, without a band)")
    return paragraph(*built)


def layer_parts(found: BuildDirections) -> Iterator[Part]:
    """Yield what the layers of a link hold, beside a map of the directions of building.

    Parameters
    ----------
    found : BuildDirections

    Yields
    ------
    Part
    """
    picture = Picture(
        name=f"layers-{found.link}",
        alt=f"Safety factor of the layers of link {found.link} over the direction of building",
        caption=f"Safety factor of the layers of link {found.link} over the direction of building, least of all load "
        "cases. Centre: along the pins; circles: 30 and 60° to them; rim: in the plane of the linkage. x runs along "
        "the link. A direction and its opposite are the same.",
        draw=lambda: build_map(found),
        kind="map",
    )
    counted = Text(
        "The number counts tension normal to the layers and shear along them, (σ/R)² + (τ/S)² ≤ 1/n²; compression "
        "normal to them neither helps nor harms.",
        "note",
    )
    yield Beside((*((picture,) if found.scan is not None else ()), layer_text(found), counted))


def layer_record(found: LayerStress | None) -> dict[str, Any] | None:
    """Return the layers of a link under a load case as an entry of ``result.json``.

    Parameters
    ----------
    found : LayerStress or None

    Returns
    -------
    dict or None
    """
    if found is None:
        return None
    best = None
    if found.scan is not None:
        i, j = np.unravel_index(int(np.argmax(found.scan)), found.scan.shape)
        best = {"direction": data(build_directions()[i, j]), "safety_factor": float(found.scan[i, j])}
    return {
        "build_direction": list(found.layers.normal),
        "strength_across": found.layers.across,
        "shear_strength": found.layers.between,
        "safety_factor": data(found.safety_factor),
        "location": data(found.location),
        "tension": found.tension,
        "shear": found.shear,
        "best": best,
    }
