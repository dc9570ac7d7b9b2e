"""The plastic zone of links: what has flowed where they collapse, on the body as the stress plot shows it."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from alula.fea.plastic.link_collapse import LinkCollapse
from alula.reports.figures.figures import TIME_LIMIT, rendered
from alula.reports.figures.scene import MARGIN, Rendering, strip_view, surface_triangles
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.plot import Axes
from alula.reports.figures.sheet.style import WIDTH

ELASTIC, FLOWED = (232, 236, 240), (200, 40, 40)
"""Red, green and blue; pale against dark, so that grey print tells them apart too."""


def plastic_plots(
    links: Mapping[str, LinkCollapse], *, time_limit: float = TIME_LIMIT
) -> tuple[dict[str, Canvas], tuple[str, ...]]:
    """Draw the plastic zone of links.

    Where rendering fails there are fewer pictures and one warning.

    Parameters
    ----------
    links : mapping of str to LinkCollapse
        By name.
    time_limit : float, optional
        Of rendering [s].

    Returns
    -------
    tuple
        Link -> Canvas, and warnings.
    """
    if not links:
        return {}, ()
    images, trouble = rendered({link: _rendering(found) for link, found in links.items()}, time_limit=time_limit)
    missing = [link for link in links if link not in images]
    plots = {link: _sheet(links[link], image) for link, image in images.items()}
    return plots, (f"no picture of the plastic zone of {', '.join(missing)}: {trouble}",) if missing else ()


def _rendering(found: LinkCollapse) -> Rendering:
    return Rendering(
        view=strip_view(found.nodes),
        points=found.nodes,
        triangles=surface_triangles(found.boundary),
        values=np.where(found.zone > 0.0, 1.0, 0.0),
        limits=(0.0, 1.0),
        colours=np.array([ELASTIC, FLOWED], dtype=np.uint8),
    )


def _sheet(found: LinkCollapse, image: NDArray[np.float64]) -> Canvas:
    view, wide = strip_view(found.nodes), 72.0 * WIDTH - 2.0 * MARGIN
    high = wide * view.half_height / view.half_width
    sheet = Canvas(72.0 * WIDTH, high + 2.0 * MARGIN)
    sheet.picture(image, Axes(box=(MARGIN, MARGIN, MARGIN + wide, MARGIN + high), x=(0.0, 1.0), y=(0.0, 1.0)).box)
    return sheet
