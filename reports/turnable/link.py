"""The model of a link: stress and displacements of every variant, or what flowed at its collapse, on its surface."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import CheckResult, SolidResult, VariantPeak
from alula.fea.plastic.link_collapse import LinkCollapse
from alula.fea.solid.stress import stress_field
from alula.loads.case.case import Case
from alula.reports.figures.figures import COLOURS, colour_range
from alula.reports.figures.scene import Scene, View, scene_of, shown_scale, strip_view
from alula.reports.turnable.pack import data_block, indices, quantised
from alula.reports.turnable.surface import CutSurface, cut_surface
from alula.reports.words.numbers import fixed, number

Real = NDArray[np.float64]


SHOWN = 0.9
"""Share of the nodes that flow whose strain is below the last colour: beside rims it is many times that of the rest."""


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


def collapse_name(link: str) -> str:
    """Return the name of the model of a link's plastic collapse.

    Parameters
    ----------
    link : str

    Returns
    -------
    str
    """
    return f"plastic-{link}"


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


def collapse_models(found: Mapping[str, LinkCollapse], case: Case) -> dict[str, str]:
    """Return the models of links at their plastic collapse.

    Parameters
    ----------
    found : mapping of str to LinkCollapse
        By link.
    case : Case

    Returns
    -------
    dict
        ``collapse_name`` -> data block.
    """
    return {
        collapse_name(link): data_block(collapse_model(link, one, case.links[link].points))
        for link, one in found.items()
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
    return {
        "name": name,
        "measure": scene.measure,
        "seek": "Largest stress",
        "unit": "MPa",
        "top": colour_range(scene)[1],
        "scale": scene.scale,
        "close": scene.close.half_height,
        **_body(space.nodes, cut, points, scene.strip),
        "governing": governing,
        "variants": [
            _variant(link, scene, cut, case.displacement, peak, governs=place == governing)
            for place, (case, peak) in enumerate(zip(cases, link.variants, strict=True))
        ],
    }


def collapse_model(name: str, found: LinkCollapse, points: Mapping[str, tuple[float, float]]) -> dict[str, Any]:
    """Return the record of a link at its plastic collapse, which ``source/link.js`` draws too.

    Parameters
    ----------
    name : str
    found : LinkCollapse
    points : mapping
        As of ``link_model``.

    Returns
    -------
    dict
    """
    cut, scale = cut_surface(found.nodes, found.boundary), shown_scale(found.nodes, found.shape)
    surface = 100.0 * found.zone[cut.nodes]
    endless = found.ended == "limit" and bool(surface.any())
    if endless:  # strain grows as far as the path is followed
        surface *= 100.0 / surface.max()
    hottest = int(np.argmax(surface))
    top = float(np.quantile(surface[surface > 0.0], SHOWN)) if surface.any() else 1.0
    told = "at the ring, and grows without end" if endless else f"{number(surface[hottest], 2)} % where the path ends"
    return {
        "name": name,
        "measure": "plastic strain over its largest" if endless else "plastic strain",
        "seek": "Largest strain",
        "unit": "%",
        "top": top,
        "scale": scale,
        "close": 0.1 * float(np.ptp(found.nodes[:, 0])),
        **_body(found.nodes, cut, points, strip_view(np.vstack([found.nodes, found.nodes + scale * found.shape]))),
        "governing": 0,
        "variants": [
            {
                "title": f"at {number(found.factor, 3)} times its loads",
                "peak": [f"largest: {told}"],
                "beyond": bool(surface[hottest] > top),
                "hottest": hottest,
                "largest": float(np.linalg.norm(found.shape, axis=1).max()),
                "displacement": quantised(found.shape[cut.nodes]),
                "values": quantised(surface),
            }
        ],
    }


def _body(nodes: Real, cut: CutSurface, points: Mapping[str, tuple[float, float]], view: View) -> dict[str, Any]:
    """Return the surface, the names on it and how it is looked at first."""
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    return {
        "colours": [colour.removeprefix("#") for colour in COLOURS],
        "points": {point: list(at) for point, at in points.items()},
        "high": float(high[2]),
        "corners": [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])],
        "toward": view.toward.tolist(),
        "up": view.up.tolist(),
        "nodes": quantised(nodes[cut.nodes]),
        "faces": indices(cut.faces),
        "edges": indices(cut.edges),
    }


def _variant(
    link: SolidResult,
    scene: Scene,
    cut: CutSurface,
    displacement: Real,
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
