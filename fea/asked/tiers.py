"""The two tiers of a verdict: whether all stays elastic, and whether anything breaks or gives way.

A link without plastic collapse, since it is brittle or printed in layers, has no elastic tier to lose: it breaks where
its stress first reaches its strength. A tier is passed by whole links alone: that an eye, a wall or a connection bears
does not say that its link does not collapse.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Tier, Verdict, deciding
from alula.loads.case.break_rules import unlike_ductile
from alula.loads.case.case import Case
from alula.loads.records.check_spec import BearingCheck

WHOLE = (Quantity.SAFETY_FACTOR, Quantity.PLASTIC_COLLAPSE, Quantity.NOTCHES)
"""What is asked of a link as a whole; other quantities can fail its tier or leave it open."""


@dataclass(frozen=True, kw_only=True)
class TierVerdict:
    """The verdict of one tier.

    Attributes
    ----------
    tier : Tier
    links : tuple of str
        Those with a part that have such a tier: of what stays elastic those that can collapse, else all.
    unasked : tuple of str
        Those of them that no check of the case asks as a whole for it.
    decides : CheckOutcome or None
        The worst of its outcomes, asked or looked at unasked, such as buckling; None where there is none.
    asks : str
        Type of a check that asks whole links for it, first those that are not asked.
    """

    tier: Tier
    links: tuple[str, ...]
    unasked: tuple[str, ...]
    decides: CheckOutcome | None
    asks: str

    @property
    def verdict(self) -> Verdict | None:
        """Fail or undecided as what decides; pass where besides all links are asked; else None."""
        if self.decides is None or (self.unasked and self.decides.verdict is Verdict.PASS):
            return None
        return self.decides.verdict


def tier_of(case: Case, outcome: CheckOutcome) -> Tier:
    """Return the tier of an outcome: that of its quantity, or of the strength that it is against.

    A safety factor against ultimate strength, and line contact of which a side breaks before it flows, are of breaking.

    Parameters
    ----------
    case : Case
    outcome : CheckOutcome

    Returns
    -------
    Tier
    """
    if outcome.quantity.tier is not Tier.ELASTIC:
        return outcome.quantity.tier
    subject, check = outcome.subject, case.all_checks.get(outcome.name)
    if isinstance(check, BearingCheck):
        return Tier.BREAK
    if subject.kind == "link":
        breaks = bool(unlike_ductile(case, subject.name))
    else:
        breaks = case.pin_material(subject.name).brittle
    if outcome.quantity is Quantity.LINE_CONTACT and (slotted := case.joints[subject.name].slotted) is not None:
        breaks = breaks or bool(unlike_ductile(case, slotted))
    return Tier.BREAK if breaks else Tier.ELASTIC


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
    found = []
    ductile = tuple(link for link in case.checked_links if not unlike_ductile(case, link))
    for tier in (Tier.ELASTIC, Tier.BREAK):
        own = [check for check in checks if tier_of(case, check) is tier]
        links = ductile if tier is Tier.ELASTIC else case.checked_links
        asked = {check.subject for check in own if check.quantity in WHOLE}
        unasked = tuple(link for link in links if Subject.link(link) not in asked)
        collapses = tier is Tier.BREAK and not set(ductile).isdisjoint(unasked or links)
        found.append(
            TierVerdict(
                tier=tier,
                links=links,
                unasked=unasked,
                decides=worst_of(own) if own else None,
                asks="plastic-collapse" if collapses else "safety-factor",
            )
        )
    return tuple(found)


def worst_of(own: Sequence[CheckOutcome]) -> CheckOutcome:
    """Return the worst outcome of a tier; of what passes also one that is known to be at least so large alone.

    Parameters
    ----------
    own : sequence of CheckOutcome
        At least one.

    Returns
    -------
    CheckOutcome
    """
    first, *_ = found = deciding(own)
    return min(found, key=lambda one: one.margin) if first.verdict is Verdict.PASS else first
