"""What acts on one link over a whole motion, in the link's own frame."""

from alula.fea.beam.cut_free import link_loads
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.plates import plates
from alula.fea.frame.linkage_frame import out_of_plane
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.forks import apart
from alula.loads.states.case_motion import CaseMotion


def link_histories(moved: CaseMotion, link: str) -> tuple[LinkLoads, ...]:
    """Return the loads on a link over the motion, at all poses, one record per load case.

    Of a pair whose plates bear differently, there are two of a load case.

    Parameters
    ----------
    moved : CaseMotion
        The case over its motion.
    link : str
        A link with a part.

    Returns
    -------
    tuple of LinkLoads

    Raises
    ------
    CannotRunError
        Where the joint forces do not follow from equilibrium.
    CaseError
        For loads out of the plane of a linkage that moves.
    """
    case = moved.case
    if not moved.forces:
        raise CannotRunError(
            "envelope: the linkage is redundant, so its joint forces over a motion do not follow from equilibrium; "
            "remove redundant joints or links, or check single poses with alula check"
        )
    for name, loads in moved.loads.items():
        if moved.held is not None and out_of_plane([load for load in loads if load.link == link]):
            raise CaseError(
                f"load_cases.{name}: a load on link '{link}' acts out of the linkage's plane, which an envelope over "
                "a motion does not follow; leave it out, or check single poses with alula check"
            )
    body = case.body(link)
    whole = [link_loads(name, link, body, moved.forces[name], loads) for name, loads in moved.loads.items()]
    return tuple(plate for loads in whole for plate in plates(loads, apart(case, link)))
