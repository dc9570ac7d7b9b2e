"""Buckling of links that are no beams: decided on the eigenvalues of their solids, and undecided without them."""

import math
from collections.abc import Iterator, Mapping

from alula.fea.buckling.buckling import asked_of, factor_band, judgement
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import Scatter, load_over_modulus
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome, Subject
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.refine.link_buckling import SolidBuckling
from alula.fea.solid.buckling_factor import MOST
from alula.loads.case.case import Case

NO_BEAM = reason("no_beam_and_no_solid")


def solid_buckling_outcomes(case: Case, load_case: str, loaded: Mapping[str, LinkResult]) -> Iterator[CheckOutcome]:
    """Yield the outcome of every link that is no beam and may buckle under a load case.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    loaded : mapping of str to LinkResult
        Link -> its result; the links on which something acts.

    Yields
    ------
    CheckOutcome
        None for a solid that does not buckle below ``MOST`` times the load.
    """
    for link, result in loaded.items():
        if case.part_of(link).is_beam:
            continue
        found = solid_buckling(result) or SolidBuckling.unknown(NO_BEAM)
        if found.without:
            yield undecided_buckling(load_case, link, found.without)
        elif math.isfinite(found.least):
            yield _outcome(case, load_case, link, found)


def solid_buckling(result: LinkResult) -> SolidBuckling | None:
    """Return the buckling factors of a link by its solid; None where beams stand for it, or no solid was solved.

    Parameters
    ----------
    result : LinkResult

    Returns
    -------
    SolidBuckling or None
    """
    return result.buckling if isinstance(result, SolidResult) else None


def undecided_buckling(load_case: str, link: str, why: Reason | str) -> CheckOutcome:
    """Return the outcome of a link whose factor is not known.

    Parameters
    ----------
    load_case : str
        Its name.
    link : str
    why : Reason or str
        A text is that of an error.

    Returns
    -------
    CheckOutcome
    """
    return asked_of(Subject.link(link)).outcome(load_case, Band.unknown(why)).because(why)


def _outcome(case: Case, load_case: str, link: str, found: SolidBuckling) -> CheckOutcome:
    said = reason(
        "solid_buckles",
        factor=found.value if math.isfinite(found.value) else None,
        most=MOST,
        held=found.holding,
        least=found.least if found.least < found.value else None,
    )
    mesh = Source(kind=SourceKind.DISCRETISATION, detail=reason("up_to_share_of_factor", share=found.error))
    ends = found.least * max(1.0 - found.error, 0.0), found.most * (1.0 + found.error)
    band = factor_band(case, load_case, link, min(found.value, MOST), ends, mesh)
    outcome = asked_of(Subject.link(link)).outcome(load_case, band, said)
    return outcome.because(reason("buckling_judged", found=said, judgement=judgement(outcome, None)))


def bending_growth(case: Case, load_case: str, link: str, result: LinkResult) -> Scatter:
    """Return ``solid_growth`` of a link under the largest load over modulus that may be.

    Parameters
    ----------
    case : Case
    load_case, link : str
        Their names.
    result : LinkResult
        Of the link.

    Returns
    -------
    Scatter
    """
    return solid_growth(solid_buckling(result), load_over_modulus(case, load_case, [link])[1])


def solid_growth(found: SolidBuckling | None, most: float = 1.0) -> Scatter:
    """Return by how much bending that goes with the load may exceed that of the solid, which is linear.

    Parameters
    ----------
    found : SolidBuckling or None
        Its buckling factors n; the growth is 1/(1 - 1/n) at most (``alula.fea.buckling.buckling``).
    most : float, optional
        Largest load over modulus, over what it is, by which n is less.

    Returns
    -------
    Scatter
        None at n <= 1, where no factor bounds it, and the link does not pass.
    """
    least = found.least * (1.0 - found.error) / most if found is not None and not found.without else math.inf
    if not 1.0 < least < math.inf:
        return Scatter()
    detail = reason("bending_towards_buckling", factor=least)
    return Scatter(high=1.0 / (1.0 - 1.0 / least), sources=(Source(kind=SourceKind.GROWTH, detail=detail),))
