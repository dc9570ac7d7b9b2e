"""What acts on a link reduced to its axis, once for all that ask: growth of bending and hand calculation."""

from functools import lru_cache

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.loads import RECENT, BeamLoads
from alula.fea.common.link_loads import LinkLoads
from alula.geometry.parts.part import Body


@lru_cache(maxsize=RECENT)
def on_axis(loads: LinkLoads, body: Body, density: float) -> BeamLoads:
    """Return the loads of a link on its axis, as ``beam_loads`` does.

    Parameters
    ----------
    loads : LinkLoads
        As of ``beam_loads``.
    body : Body
        The link's.
    density : float
        Of its material [tonne/mm³].

    Returns
    -------
    BeamLoads
    """
    return beam_loads(loads, body, density)
