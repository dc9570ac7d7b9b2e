"""The model of a link: stress and displacements of every variant on the surface of its solid."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import CheckResult, SolidResult, VariantPeak
from alula.fea.solid.stress import stress_field
from alula.reports.figures.figures import COLOURS, colour_range
from alula.reports.figures.scene import Scene, scene_of
from alula.reports.turnable.pack import data_block, indices, quantised
from alula.reports.turnable.surface import CutSurface, cut_surface
from alula.reports.words.numbers import fixed, number


def link_name(link: str) -> str:
    """Return the name of a link's model.

    Parameters
    ----------
    link : str

    Returns
    -------
    str
    """
    return f"link-{link}"


def link_models(result: CheckResult) -> dict[str, str]:
    """Return the models of all links that were solved as solids, each under its governing load case.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    dict
        ``link_name`` -> data block.
    """
    worst = {link: result.governing(link).links[link] for link in next(iter(result.load_cases.values())).links}
    return {
        link_name(link): data_block(link_model(link, found, result.case.links[link].points))
        for link, found in worst.items()
        if isinstance(found, SolidResult)
    }


def link_model(name: str, link: SolidResult, points: Mapping[str, tuple[float, float]]) -> dict[str, Any]:
    """Return the record of a link that ``source/link.js`` draws.

    Colours, their range and the scale of the displacements are those of the link's picture; one range serves all
    variants, so that they can be compared.

    Parameters
    ----------
    name : str
    link : SolidResult
        Under the load case that is shown.
    points : mapping
        Name -> (x, y) of its pins and load points [mm].

    Returns
    -------
    dict
    """
    scene, space = scene_of(link), link.solution.space
    cut = cut_surface(space.nodes, space.boundary)
    cases = [case for case in link.solution.cases if case.load == link.governing_case.load]
    named: list[tuple[int, str | None]] = [(case.span, case.transfer) for case in cases]
    governing = named.index((link.governing.span, link.governing.transfer))
    low, high = space.nodes.min(axis=0), space.nodes.max(axis=0)
    return {
        "name": name,
        "measure": scene.measure,
        "unit": "MPa",
        "top": colour_range(scene)[1],
        "scale": scene.scale,
        "colours": [colour.removeprefix("#") for colour in COLOURS],
        "points": {point: list(at) for point, at in points.items()},
        "high": float(high[2]),
        "corners": [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])],
        "close": scene.close.half_height,
        "toward": scene.strip.toward.tolist(),
        "up": scene.strip.up.tolist(),
        "nodes": quantised(space.nodes[cut.nodes]),
        "faces": indices(cut.faces),
        "edges": indices(cut.edges),
        "governing": governing,
        "variants": [
            _variant(link, scene, cut, case.displacement, peak, governs=place == governing)
            for place, (case, peak) in enumerate(zip(cases, link.variants, strict=True))
        ],
    }


def _variant(
    link: SolidResult,
    scene: Scene,
    cut: CutSurface,
    displacement: NDArray[np.float64],
    peak: VariantPeak,
    *,
    governs: bool,
) -> dict[str, Any]:
    """Return title, peak and fields of one variant."""
    solid = link.solution
    field = link.stress if governs else stress_field(solid.space, displacement, E=solid.E, nu=solid.nu)
    values = field.decisive(brittle=link.brittle)
    hottest = int(np.argmax(values))
    largest = peak.principal if link.brittle else peak.von_mises
    place = ", ".join(f"{axis} = {fixed(at, 1)}" for axis, at in zip("xyz", solid.space.nodes[hottest], strict=True))
    unknown = np.isnan(largest) or (governs and scene.doubt)
    told = f"no result, {scene.doubt}" if unknown else f"{number(largest)} MPa"
    return {
        "title": peak.title,
        "peak": [f"largest: {told} at {place} mm"],
        "beyond": bool(values.max() > scene.top),
        "hottest": int(np.argmin(np.linalg.norm(solid.space.nodes[cut.nodes] - solid.space.nodes[hottest], axis=1))),
        "largest": float(np.linalg.norm(displacement, axis=1).max()),
        "displacement": quantised(displacement[cut.nodes]),
        "values": quantised(values[cut.nodes]),
    }
