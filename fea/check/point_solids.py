"""Solids that are taken or refined since the displacement of a point of the linkage is open without them."""

from collections.abc import Mapping
from dataclasses import replace

from alula.fea.common.reason import reason
from alula.fea.links.fidelity import DecidedLink, Decision
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import Effort, Progress, Watch, refine_links
from alula.geometry.meshing.mesh import MeshSettings


def decide_point(
    decided: Mapping[str, DecidedLink],
    tasks: Mapping[str, LinkTask],
    wanted: Mapping[str, float],
    start: MeshSettings,
    effort: Effort,
    *,
    threads: int | None = None,
    watch: Watch = lambda link, found: None,
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
    watch : callable, optional
        As of ``refine_links``.
    progress : callable

    Returns
    -------
    dict of str to DecidedLink
        Those that changed; a link whose refinement was stopped before is left as it is. A link that was solved under
        some of its loads alone is solved anew under all.
    """
    part = {link for link in wanted if any(loads.name in decided[link].left for loads in tasks[link].loads)}
    closer = {
        link: replace(tasks[link], displacement_error=error)
        for link, error in wanted.items()
        if link in part or (solid := decided[link].solid) is None or solid.may_go_on
    }
    earlier = {link: solid for link in closer if (solid := decided[link].solid) is not None and link not in part}
    why = reason("solid_for_point")
    found = {}
    solids = refine_links(closer, start, effort, earlier=earlier, threads=threads, watch=watch, progress=progress)
    for link, solid in solids.items():
        solved = decided[link].solid is not None
        decision = decided[link].decision if solved else Decision(model="solid", why=why, next_cost=None)
        under = {loads.name for loads in tasks[link].loads}
        left = {name: one for name, one in decided[link].left.items() if name not in under}
        found[link] = replace(decided[link], decision=decision, solid=solid, left=left)
    return found
