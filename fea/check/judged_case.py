"""One load case with its links decided: every check of it, and its result."""

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce

from alula.fea.asked.asked import asked_of
from alula.fea.asked.at_temperature import as_known
from alula.fea.buckling.buckling import buckling_outcomes
from alula.fea.check.kinds import judged_by_hand, judged_on_solids
from alula.fea.check.known_stiffness import with_known_stiffness
from alula.fea.check.load_case import LoadCaseByHand, SolvedAnswers
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import CheckOutcome
from alula.fea.judging.judge import outcomes
from alula.fea.judging.linkage import no_equilibrium, unless_it_gives_way
from alula.fea.judging.linkage_numbers import limit_load_outcomes, linkage_numbers
from alula.fea.judging.loading import Collapse, SolvedLinks
from alula.fea.judging.solid_buckling import solid_buckling_outcomes
from alula.fea.links.fidelity import DecidedLink
from alula.fea.links.link_by_hand import slenderest
from alula.fea.outcomes.found import Found
from alula.fea.outcomes.pins import PinStress, pin_growth, shared_stress, twist_of, twisted, with_torque
from alula.fea.outcomes.result import LinkResult, LoadCaseResult
from alula.fea.outcomes.unloaded import undecided
from alula.fea.standing.case_statics import with_ends
from alula.fea.standing.joint_forces import JointForces, ways_to_hold
from alula.fea.whole.permanent_set import of_one_force
from alula.loads.case.case import Case
from alula.loads.records.check_spec import PinCheck
from alula.loads.statics.statics import Reactions


def judged(
    hand: LoadCaseByHand,
    decided: Mapping[str, DecidedLink],
    solved: Mapping[str, SolvedAnswers],
    links: Mapping[str, LinkResult],
    collapses: Mapping[str, Collapse],
    whole: Sequence[CheckOutcome],
) -> LoadCaseResult:
    """Return the result of a load case.

    Parameters
    ----------
    hand : LoadCaseByHand
    decided : mapping of str to DecidedLink
        Of every link on which something acts.
    solved : mapping of str to SolvedAnswers
        What causes make of links that are solids.
    links : mapping of str to LinkResult
        What ``hand`` makes of both.
    collapses : mapping of str to Collapse
        Of the links whose plastic collapse a check asks for.
    whole : sequence of CheckOutcome
        Of the linkage as a whole, which stand after those of links and joints.

    Returns
    -------
    LoadCaseResult
    """
    case, load_case, forces, statics = hand.case, hand.load_case, hand.forces, hand.statics
    moved = with_known_stiffness(case, hand.moved, forces, links, hand.cut)
    reactions = moved.reactions or statics.reactions[load_case]
    pins = _pins(case, reactions, hand.shared_forces)
    # ``pins`` and bearing hold the sharing of couples.
    pinned = {
        x: with_torque(x, one, pin_growth(case, x, reactions.joints, hand.uneven.of_pin), hand.growth_through)
        for x, one in pins.items()
    }
    linkage = linkage_numbers(case, load_case, moved, forces, links, hand.free)
    columns = {x: slenderest(case, x, hand.columns(x)) for x in hand.plates}
    buckling = (
        *buckling_outcomes(case, load_case, columns, moved),
        *solid_buckling_outcomes(case, load_case, {x: one for x, one in links.items() if hand.acts_on(x)}),
    )
    stressed = hand.uneven.times(hand.shared).stress
    here = SolvedLinks(
        case=case,
        load_case=load_case,
        ways=lambda: (reactions, *forces.sharings),
        loads=lambda link: [loads for loads, _ in hand.plates[link]],
        hands=lambda link: [own for _, own in hand.plates[link]],
        others=hand.others,
        joint_growth=lambda joint: hand.uneven.joints.get(joint, Scatter()),
        link_growth=lambda link: stressed.get(link, Scatter()),
        growth_through=hand.growth_through,
        links=links,
        decided=decided,
        collapses=collapses,
        acts_on=hand.acts_on,
        doubts=lambda link: hand.doubts_on(link, solved.get(link)),
        beside_one_force=of_one_force(case, load_case, forces, statics.loads[load_case]),
    )
    by_hand, on_solids = [*judged_by_hand(here)], [*judged_on_solids(here)]
    every = (
        *outcomes(case, load_case, links, pins, moved, hand.free, pinned, forces),
        *(one.outcome for one in by_hand),
        *(hand.with_growth(one) for one in buckling),
        *limit_load_outcomes(case, load_case, linkage),
        *(one.outcome for one in on_solids),
        *whole,
    )
    doubted = [reduce(lambda one, doubt: doubt.on_buckling(one), hand.doubts, outcome) for outcome in every]
    checks: Iterable[CheckOutcome] = unless_it_gives_way(
        doubted, {load_case: no_equilibrium(moved)} if moved.gives_way else {}
    )
    checks = as_known(case, checks, stiff=moved.state == "small" and forces.by_equilibrium)
    if hand.idle:
        borne = {name: joint.magnitude for name, joint in reactions.joints.items()}
        checks = undecided(checks, load_case, hand.size, borne)
    return LoadCaseResult(
        name=load_case,
        forces=forces,
        large_displacement=moved,
        links=links,
        pins=pins,
        ways_to_hold=ways_to_hold(case, statics.pose, statics.loads[load_case]),
        linkage=linkage,
        standing=statics.standing[load_case],
        checks=tuple(checks),
        work=with_ends(statics, load_case),
        loads=tuple(statics.loads[load_case]),
        found=tuple(
            Found(check=one.outcome.name, subject=one.outcome.subject, numbers=numbers)
            for one in (*by_hand, *on_solids)
            for numbers in one.numbers
        ),
    )


def _pins(case: Case, reactions: Reactions, forces: JointForces) -> dict[str, PinStress]:
    """Stresses of the pins that a check asks for."""
    found = {}
    for joint in asked_of(case, PinCheck):
        reaction = reactions.joints[joint]
        twist = twist_of(case, joint, float(reaction.wrench[5]), float(reactions.drive_torque))
        found[joint] = twisted(case, joint, shared_stress(case, joint, reactions.joints, forces), twist)
    return found
