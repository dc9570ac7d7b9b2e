"""Points and directions of the links in a pose."""

import math

from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.reports.sections.table import Column, Number, Table, words


def pose_tables(pose: Pose, case: Case) -> tuple[Table, Table]:
    """Return points and directions of the links in a pose.

    Parameters
    ----------
    pose : Pose
    case : Case

    Returns
    -------
    tuple of 2 Table
    """
    return (
        Table(
            key="points",
            columns=(words("point"), Column("x", "mm"), Column("y", "mm")),
            rows=tuple((name, *(Number(float(x), decimals=3) for x in at)) for name, at in pose.points.items()),
            caption="Points in global axes",
        ),
        Table(
            key="directions",
            columns=(words("link"), words("from → to"), Column("direction", "deg")),
            rows=tuple(
                (link, f"{names[0]} → {names[-1]}", Number(math.degrees(pose.angles[link]) % 360.0, "", 6))
                for link in pose.linkage.moving
                for names in [list(case.links[link].points)]
            ),
            caption="Directions of the links",
        ),
    )
