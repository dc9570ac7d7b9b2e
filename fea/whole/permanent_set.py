"""Permanent set: how far the point at which a load enters the linkage stays displaced along it, once it is gone.

Joint forces that follow from equilibrium are in proportion to the one load F. On each link they balance with it, and do
no work on rigid motions; between links they do opposite work. So with f all that acts on a link, u its displacements
under the load and u_e those that it would have without yield, virtual work gives

    δ = Σ f·(u - u_e) / F

over the links, each led to the load by itself and unloaded elastically (``alula.fea.plastic.load_path.what_stays``).
Links that yield nowhere add nothing. Set grows faster than any load, so that ranges do not multiply it: its ends are
read where loads over strength have theirs. A strength times s is all stresses times s of a body whose modulus is by as
much larger, and set lies between free of the modulus (strains that flow gives alone) and in proportion to one over it
(perfect plasticity); the end that is free of it holds both.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from alula.fea.asked.asked import Asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, compliance_scatter, strength_scatter
from alula.fea.common.source import Source, SourceKind, distinct
from alula.fea.common.verdict import Quantity, Subject
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging.judge import of_link
from alula.fea.judging.link_result import spread
from alula.fea.judging.loading import Judged, SolvedLinks
from alula.fea.judging.plastic_collapse import NEGLIGIBLE, NOT_SOLVED, above_first_yield, as_elastic
from alula.fea.judging.solid_buckling import bending_growth
from alula.fea.outcomes.result import LinkResult
from alula.fea.plastic.link_collapse import LinkCollapse
from alula.fea.standing.joint_forces import JointForces
from alula.fea.superposition.solid_shares import Shares
from alula.loads.case.break_rules import unlike_ductile
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.records.load_case import force_size

NOTHING = Band.exact(0.0)
WITHOUT_YIELD = reason("set_without_yield")


@dataclass(frozen=True, kw_only=True)
class LinkSet:
    """What a link adds to the permanent set of the linkage.

    Attributes
    ----------
    link : str
    set : Band
        Along the load [mm]; infinite where the link does not bear it.
    factor : float
        On its loads, that it bears.
    strain : float or None
        Largest plastic strain under the load; None where it is not borne.
    regained : float
        Share that flow takes back while the load goes; elastic unloading leaves it out.
    """

    link: str
    set: Band
    factor: float
    strain: float | None
    regained: float


def first_yield(link: str) -> Asked:
    """Return the question whether a link stays elastic, as one of its plastic collapse.

    Parameters
    ----------
    link : str

    Returns
    -------
    Asked
    """
    return Asked(name="", subject=Subject.link(link), quantity=Quantity.PLASTIC_COLLAPSE, limit=1.0)


def stays_elastic(case: Case, load_case: str, link: str, result: LinkResult) -> bool:
    """Return True if nothing of a link yields, by the whole band of its safety factor.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    link : str
    result : LinkResult

    Returns
    -------
    bool
    """
    one = first_yield(link)
    return above_first_yield(case, one, of_link(case, load_case, as_elastic(one), result)) is not None


def adds_to_set(case: Case, load_case: str, link: str, result: LinkResult) -> bool:
    """Return True if a link may yield and its path tells by how much.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    link : str
    result : LinkResult

    Returns
    -------
    bool
    """
    return not stays_elastic(case, load_case, link, result) and not unlike_ductile(case, link)


def of_one_force(case: Case, load_case: str, forces: JointForces, loads: Sequence[Load]) -> Reason | None:
    """Return why joint forces are not in proportion to the one force of a load case; None where they are.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
    loads : sequence of Load
        All that acts on the links.

    Returns
    -------
    Reason or None
    """
    if not (forces.by_equilibrium or clamped_tree(case)):
        return reason("set_by_stiffness", why=forces.reason)
    stated = 1 + sum(line.leaves is not None for line in case.load_cases[load_case].load_lines)
    return reason("set_of_others") if len(loads) > stated else None


def clamped_tree(case: Case) -> bool:
    """Return True if links hang on the ground by one bonded joint each, so that equilibrium in space gives all forces.

    Such as a pylon between foot and adapter. Pairs of plates are not such: they share what acts out of the plane by
    their stiffness.

    Parameters
    ----------
    case : Case

    Returns
    -------
    bool
    """
    joints, links = case.linkage.joints.values(), case.linkage.links.values()
    return (
        all(joint.fixed for joint in joints)
        and len(joints) == len(links) - 1
        and all(link.count == 1 for link in links)
    )


def ends_of_load(case: Case, link: str, load_case: str, result: LinkResult, uneven: Growths, shares: Shares) -> Scatter:
    """Return what the loads on a link over its strength may be, over what they are.

    Parameters
    ----------
    case : Case
    link : str
    load_case : str
        Its name.
    result : LinkResult
    uneven, shares
        As ``spread`` takes them.

    Returns
    -------
    Scatter
    """
    loads = spread(case, link, load_case, "von_mises", uneven, shares, bending_growth(case, load_case, link, result))
    return loads.times(strength_scatter(case.material_of(link)).inverse)


def judge_permanent_set(here: SolvedLinks, one: Asked) -> Judged:
    """Return how far the point of entry of the load stays displaced.

    Parameters
    ----------
    here : SolvedLinks
    one : Asked
        Of the linkage.

    Returns
    -------
    Judged
    """
    case, load_case = here.case, here.load_case
    yields = [
        link
        for link in case.checked_links
        if here.acts_on(link) and not stays_elastic(case, load_case, link, here.links[link])
    ]
    if not yields:
        return Judged(outcome=one.outcome(load_case, NOTHING, WITHOUT_YIELD))
    why: Reason | str | None = here.beside_one_force
    found = []
    for link in yields:
        known = here.collapses.get(link, NOT_SOLVED)
        if brittle := unlike_ductile(case, link):
            why = why or reason("set_of_brittle", link=link, why=brittle)
        elif isinstance(known, LinkCollapse) and known.stays is not None:
            found.append(_link_set(here, link, known, known.stays))
        else:
            lost = reason("set_not_found") if isinstance(known, LinkCollapse) else known
            why = why or reason("set_of_link_open", link=link, why=lost)
    if why:
        return Judged(outcome=one.outcome(load_case, Band.unknown(why), why), numbers=tuple(found))
    whole = Band(
        value=sum(part.set.value for part in found),
        low=sum(part.set.low for part in found),
        high=sum(part.set.high for part in found),
        sources=distinct(*(part.set.sources for part in found)),
    )
    outcome, most = one.outcome(load_case, whole), max(found, key=lambda part: (part.set.value, -part.factor))
    back = max(part.regained for part in found)
    said = reason(
        "set_judged",
        link=most.link,
        set=most.set.value,
        factor=most.factor,
        regained=back if back >= NEGLIGIBLE else None,
        judgement=outcome.reason,
    )
    return Judged(outcome=outcome.because(said), numbers=tuple(found))


def _link_set(here: SolvedLinks, link: str, known: LinkCollapse, works: tuple[float, float, float]) -> LinkSet:
    """Return what a link adds, of a pair both plates."""
    case, load_case = here.case, here.load_case
    value, low, high = (work / force_size(case.load_cases[load_case]) for work in works)
    sources = [
        Source(kind=SourceKind.DISCRETISATION),
        *((Source(kind=SourceKind.PIN_PRESSURE),) if known.pressure > 1.0 + NEGLIGIBLE else ()),
        *ends_of_load(case, link, load_case, here.links[link], *here.doubts(link)).told,
    ]
    band = compliance_scatter(case.material_of(link)).on(Band(value=value, low=low, high=high, sources=tuple(sources)))
    return LinkSet(link=link, set=band, factor=known.factor, strain=known.strain, regained=known.regained)
