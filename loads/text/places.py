"""Links and points that an entry of a case names: whether there are such ones."""

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Linkage
from alula.loads.text.explain import require


def check_moving(linkage: Linkage, entry: str, link: str) -> None:
    """Check that a link moves.

    Parameters
    ----------
    linkage : Linkage
        The linkage of the case.
    entry : str
        Entry of the case file that names the link, for the message.
    link : str
        Name of the link.

    Raises
    ------
    CaseError
        Where it is the ground or unknown.
    """
    require(entry, link, linkage.moving, "is not a moving link")


def check_point(linkage: Linkage, entry: str, link: str, point: str) -> None:
    """Check that a link moves and has a point.

    Parameters
    ----------
    linkage : Linkage
        The linkage of the case.
    entry : str
        Table of the case file that names both, for the message.
    link, point : str
        Their names.

    Raises
    ------
    CaseError
        Where it is the ground or unknown, or has no such point.
    """
    check_moving(linkage, f"{entry}.link", link)
    points = linkage.links[link].points
    if point not in points:
        raise CaseError(f"{entry}: link '{link}' has no point '{point}'; its points are {', '.join(points)}")
