"""Solids that are taken or refined since the displacement of a point of the linkage is open without them."""

from collections.abc import Mapping
from dataclasses import replace

from alula.fea.common.reason import reason
from alula.fea.links.fidelity import DecidedLink, Decision
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import Effort, Progress, refine_links
from alula.geometry.meshing.mesh import MeshSettings


def decide_point(
    decided: Mapping[str, DecidedLink],
    tasks: Mapping[str, LinkTask],
    wanted: Mapping[str, float],
    start: MeshSettings,
    effort: Effort,
    *,
    threads: int | None = None,
    progress: Progress = lambda message: None,
) -> dict[str, DecidedLink]:
    """Take solids, or refine them, where the displacement of a point of the linkage asks for it.

    Parameters
    ----------
    decided : mapping of str to DecidedLink
    tasks : mapping of str to LinkTask
    wanted : mapping of str to float
        Link -> relative error of displacements that its meshes must keep to.
    start : MeshSettings
        Of the first mesh of a solid.
    effort : Effort
        What it may cost.
    threads : int, optional
    progress : callable

    Returns
    -------
    dict of str to DecidedLink
        Those that changed; a link whose refinement was stopped before is left as it is.
    """
    closer = {
        link: replace(tasks[link], displacement_error=error)
        for link, error in wanted.items()
        if (solid := decided[link].solid) is None or not solid.stopped
    }
    earlier = {link: solid for link in closer if (solid := decided[link].solid) is not None}
    why = reason("solid_for_point")
    found = {}
    for link, solid in refine_links(closer, start, effort, earlier=earlier, threads=threads, progress=progress).items():
        decision = decided[link].decision if link in earlier else Decision(model="solid", why=why, next_cost=None)
        found[link] = replace(decided[link], decision=decision, solid=solid)
    return found
