"""Holes that may be narrower than the widest, which are drawn: what that makes of the stress of their links."""

from alula.fea.common.scatter import Scatter
from alula.fea.common.source import play_source
from alula.fea.doubts.load_growth import Growths
from alula.loads.case.case import Case


def narrow_holes(case: Case) -> Growths:
    """Return what narrower holes than the widest may make of the stress of links.

    Parameters
    ----------
    case : Case

    Returns
    -------
    Growths
        Of links with a hole that may be narrower.
    """
    every = {link: narrower(case, link) for link in case.checked_links}
    return Growths(stress={link: own for link, own in every.items() if own.low < own.high})


def narrower(case: Case, link: str) -> Scatter:
    """Return what narrower holes than the widest may make of a link's stress.

    Under one force the stress about a hole is F/(d t) times what grows as the wall w about it falls: in a hole of the
    diameter d' it is at most d/d' of that in the wider one. It is at least (r'/r)(w/w')² of it, as in a ring of the
    mean radius r that its pin bends; it falls by less in a wall that is pulled (``docs/theory/bands.md``).

    Parameters
    ----------
    case : Case
    link : str
        With a part.

    Returns
    -------
    Scatter
    """
    body, low, high = case.body(link), 1.0, 1.0
    for pin, least in zip(body.pins, case.narrowest_body(link).pins, strict=True):
        if least.diameter < pin.diameter and not pin.slot:
            edge = 2.0 * body.part.wall(body, pin)
            ring = (edge + least.diameter) / (edge + pin.diameter)
            low = min(low, ring * ((edge - pin.diameter) / (edge - least.diameter)) ** 2)
            high = max(high, pin.diameter / least.diameter)
    if not low < high:
        return Scatter()
    return Scatter(low=low, high=high, sources=(play_source(case.linkage.plays),))
