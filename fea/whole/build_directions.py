"""Layers of printed links over all load cases, and which direction of building would hold best."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.outcomes.result import CheckResult
from alula.fea.solid.layers import Layers, build_directions


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
