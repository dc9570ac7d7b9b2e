"""The two tiers of a verdict: whether all stays elastic, and whether anything breaks or gives way.

A link of a brittle material has no elastic tier to lose: it breaks where its stress first reaches its strength.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Tier, Verdict, deciding
from alula.loads.case.case import Case
from alula.loads.records.check_spec import BearingCheck


@dataclass(frozen=True, kw_only=True)
class TierVerdict:
    """The verdict of one tier.

    Attributes
    ----------
    tier : Tier
    links : tuple of str
        Those with a part that have such a tier: of what stays elastic the ductile ones, else all.
    unasked : tuple of str
        Those of them of which no check of the case asks for it.
    decides : CheckOutcome or None
        The worst of its outcomes, whose verdict is that of the tier; None where no check asks for it, unless what is
        looked at unasked, such as buckling, fails.
    asks : str
        Type of a check that asks for it.
    """

    tier: Tier
    links: tuple[str, ...]
    unasked: tuple[str, ...]
    decides: CheckOutcome | None
    asks: str

    @property
    def verdict(self) -> Verdict | None:
        """Fail, undecided or pass; None where it is not asked."""
        return None if self.decides is None else self.decides.verdict


def tier_of(case: Case, outcome: CheckOutcome) -> Tier:
    """Return the tier of an outcome: that of its quantity, of a safety factor that of the strength that it is against.

    Parameters
    ----------
    case : Case
    outcome : CheckOutcome

    Returns
    -------
    Tier
    """
    if outcome.quantity is not Quantity.SAFETY_FACTOR:
        return outcome.quantity.tier
    subject, check = outcome.subject, case.all_checks.get(outcome.name)
    material = (case.material_of if subject.kind == "link" else case.pin_material)(subject.name)
    return Tier.BREAK if isinstance(check, BearingCheck) or material.brittle else outcome.quantity.tier


def tiers_of(case: Case, checks: Sequence[CheckOutcome]) -> tuple[TierVerdict, ...]:
    """Return the verdict of each tier: the worst of its outcomes.

    Parameters
    ----------
    case : Case
    checks : sequence of CheckOutcome
        All of them.

    Returns
    -------
    tuple of TierVerdict
        What stays elastic, then what does not break; empty where no link has a part.
    """
    if not case.checked_links:
        return ()
    stated, found = case.all_checks, []
    ductile = tuple(link for link in case.checked_links if not case.material_of(link).brittle)
    for tier in (Tier.ELASTIC, Tier.BREAK):
        own = [check for check in checks if tier_of(case, check) is tier]
        links = ductile if tier is Tier.ELASTIC else case.checked_links
        asked = {check.subject for check in own if check.name in stated}
        worst = deciding(own)[0] if own else None
        found.append(
            TierVerdict(
                tier=tier,
                links=links,
                unasked=tuple(link for link in links if Subject.link(link) not in asked),
                decides=worst if asked or (worst is not None and worst.verdict is Verdict.FAIL) else None,
                asks="plastic-collapse" if links == ductile and tier is Tier.BREAK else "safety-factor",
            )
        )
    return tuple(found)
