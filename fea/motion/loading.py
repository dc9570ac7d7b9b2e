"""What acts on links and joints over a motion under a load case, and at each of its poses."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.scatter import Scatter
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging.loading import Demand, OverMotion, Real
from alula.fea.links.link_by_hand import LinkByHand, link_by_hand
from alula.fea.motion.layered import forces_at, has_couples
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.linkage_history import causes_over
from alula.fea.motion.loosened import joint_growth, most_at_each
from alula.loads.case.case import Case
from alula.loads.states.case_motion import CaseMotion
from alula.loads.statics.statics import Equilibrium


def loading_over(
    moved: CaseMotion,
    load_case: str,
    evaluated: NDArray[np.bool_],
    loaded: Mapping[str, Sequence[LinkLoads]],
    grown: Growths,
    stressed: Callable[[str, str], Scatter] | None = None,
) -> OverMotion:
    """Return what acts over a motion; growth is that of what is worst over all poses.

    Parameters
    ----------
    moved : CaseMotion
    load_case : str
        Its name.
    evaluated : ndarray of bool, shape (n,)
        The poses that count.
    loaded : mapping of str to sequence of LinkLoads
        Link -> what acts on it, one record per load case and plate.
    grown : Growths
        What the deformed shape makes of joint forces.
    stressed : callable, optional
        Of load case and link, to what else than the scatter of loads makes of its stress by hand.

    Returns
    -------
    OverMotion
    """
    case, solved = moved.case, moved.forces[load_case]

    def loads(link: str) -> list[LinkLoads]:
        return [one for one in loaded.get(link, ()) if one.name == load_case]

    @cache
    def otherwise(link: str) -> list[tuple[Case, LinkLoads]]:
        every = [one for cause in causes_over(moved, load_case, evaluated) for one in cause.others]
        return [(one.case, own) for one in every for own in link_histories(one, link) if own.name == load_case]

    @cache
    def force(joint: str) -> Scatter:
        return joint_growth(moved, load_case, joint, evaluated).times(grown.joints.get(joint, Scatter()))

    @cache
    def most(joint: str) -> Real:
        own, shape = joint_growth(moved, load_case, joint, evaluated), grown.joints.get(joint, Scatter())
        return most_at_each(moved, load_case, joint, evaluated, own) * shape.high

    def through(joint: str, demand: Demand) -> Scatter:
        def of(other: CaseMotion) -> Real:
            forces = other.forces[load_case]
            return demand(other.case, forces.joints[joint].wrench, forces.driving[0])

        return joint_growth(moved, load_case, joint, evaluated, of).times(grown.through(joint))

    def ways(pose: int) -> tuple[Equilibrium, ...]:
        return (solved.at(pose), *(forces_at(moved, load_case, pose).sharings if has_couples(moved) else ()))

    def at(pose: int) -> OverMotion:
        def here(link: str) -> list[LinkLoads]:
            return [one.chosen(pose) for one in loads(link)]

        def hands(link: str) -> list[LinkByHand]:
            return [link_by_hand(case, link, one) for one in here(link)]

        def others(link: str) -> list[LinkByHand]:
            return [link_by_hand(own, link, history.chosen(pose)) for own, history in otherwise(link)]

        def grows(joint: str) -> Scatter:
            return replace(force(joint), high=float(most(joint)[pose]))

        return replace(
            over,
            ways=lambda: ways(pose),
            loads=here,
            hands=hands,
            others=others,
            joint_growth=grows,
            pin_growth=lambda joint: grows(joint).times(grown.pins.get(joint, Scatter())),
        )

    over = OverMotion(
        case=case,
        load_case=load_case,
        ways=lambda: (solved,),
        loads=loads,
        hands=lambda link: (),
        others=lambda link: (),
        joint_growth=force,
        most_growth=most,
        link_growth=lambda link: Scatter() if stressed is None else stressed(load_case, link),
        growth_through=through,
        pin_growth=lambda joint: force(joint).times(grown.pins.get(joint, Scatter())),
        evaluated=evaluated,
        at=at,
    )
    return over
