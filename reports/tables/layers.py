"""Layers of printed links over all load cases: what they hold, and which direction of building would hold best."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.outcomes.result import CheckResult
from alula.fea.solid.layers import Layers, build_directions
from alula.reports.sections.data import data
from alula.reports.words.numbers import band, fixed, number

ALIKE = 0.05
"""Gain in safety factor up to which another direction is not called better."""


@dataclass(frozen=True, kw_only=True, eq=False)
class BuildDirections:
    """Layers of a link over all load cases.

    Attributes
    ----------
    link : str
    layers : Layers
        As the part was built.
    safety_factor : Band
        The least of all load cases.
    load_case : str
        Which one that is.
    scan : ndarray or None
        Least safety factor (POLAR, AZIMUTH) of all load cases for the directions of
        ``alula.fea.solid.layers.build_directions``; None where it is not known.
    """

    link: str
    layers: Layers
    safety_factor: Band
    load_case: str
    scan: NDArray[np.float64] | None

    @property
    def best(self) -> tuple[tuple[float, float, float], float] | None:
        """The direction that would hold best, of unit length, and its safety factor; None without a scan."""
        if self.scan is None:
            return None
        i, j = np.unravel_index(int(np.argmax(self.scan)), self.scan.shape)
        x, y, z = map(float, build_directions()[i, j])
        return (x, y, z), float(self.scan[i, j])

    @property
    def sentence(self) -> str:
        """What the layers hold as built, and which direction would hold best."""
        built = f"{self.link}: built along {direction(self.layers.normal)}, its layers have a safety factor of "
        built += f"{band(self.safety_factor)}"
        if self.best is None:
            if self.safety_factor.unknowable:
                return f"{built}; no direction of building is proposed"
            return (
                f"{built} by tension alone; no direction of building is proposed, since the card has no shear strength"
            )
        way, factor = self.best
        if factor <= (1.0 + ALIKE) * self.safety_factor.value:
            return f"{built}; no direction of building holds noticeably more"
        return (
            f"{built}; built along {direction(way)} it would be {number(factor, 3)}, the largest of all directions "
            "(steps of 5°, by the same solution, without a band)"
        )


def direction(vector: tuple[float, float, float]) -> str:
    """Return a direction as a unit vector in words.

    Parameters
    ----------
    vector : tuple of 3 float
        Of any length.

    Returns
    -------
    str
        Such as ``(0.50, 0, 0.87)``.
    """
    unit = np.asarray(vector) / np.linalg.norm(vector)
    return f"({', '.join(fixed(float(x), 0 if abs(x - round(x)) < 5e-3 else 2) for x in unit)})"


def build_directions_of(result: CheckResult) -> dict[str, BuildDirections]:
    """Return what is known of the layers of every printed link that a solid decided.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    dict of str to BuildDirections
        By link.
    """
    found: dict[str, dict[str, LayerStress]] = {}
    for name, load_case in result.load_cases.items():
        for link, one in load_case.links.items():
            if one.layers is not None:
                found.setdefault(link, {})[name] = one.layers
    return {link: _over_all(link, layers) for link, layers in found.items()}


def _over_all(link: str, cases: dict[str, LayerStress]) -> BuildDirections:
    worst = min(
        cases, key=lambda name: -np.inf if cases[name].safety_factor.unknowable else cases[name].safety_factor.low
    )
    scans = [one.scan for one in cases.values() if one.scan is not None]
    return BuildDirections(
        link=link,
        layers=cases[worst].layers,
        safety_factor=cases[worst].safety_factor,
        load_case=worst,
        scan=np.min(scans, axis=0) if len(scans) == len(cases) else None,
    )


def layer_record(found: LayerStress | None) -> dict[str, Any] | None:
    """Return the layers of a link under a load case as plain data.

    Parameters
    ----------
    found : LayerStress or None

    Returns
    -------
    dict or None
        As ``docs/result.md`` describes it.
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
