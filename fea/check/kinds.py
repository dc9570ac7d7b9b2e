"""The kinds of checks that are judged from loads, each in a file of its own; a new one is a line here."""

import math
from collections.abc import Iterator
from dataclasses import replace

from alula.fea.asked.asked import asked
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.judging.bearing import BEARING
from alula.fea.judging.connections import CONNECTION
from alula.fea.judging.eyes import EYES
from alula.fea.judging.fatigue import judge_fatigue
from alula.fea.judging.line_contact import LINE_CONTACT
from alula.fea.judging.loading import ByHand, Judged, Loading, OnSolids, SolvedLinks
from alula.fea.judging.notches import judge_notches
from alula.fea.judging.plastic_collapse import judge_collapse
from alula.fea.judging.walls import WALLS
from alula.fea.whole.permanent_set import judge_permanent_set
from alula.geometry.base.model import CaseModel
from alula.loads.records.check_spec import (
    BearingCheck,
    ConnectionCheck,
    EyeCheck,
    FatigueCheck,
    LineContactCheck,
    NotchCheck,
    PermanentSetCheck,
    PlasticCollapseCheck,
    WallCheck,
)

BY_HAND: dict[type[CaseModel], ByHand] = {
    BearingCheck: BEARING,
    EyeCheck: EYES,
    WallCheck: WALLS,
    LineContactCheck: LINE_CONTACT,
    ConnectionCheck: CONNECTION,
}
ON_SOLIDS: dict[type[CaseModel], OnSolids] = {
    PlasticCollapseCheck: judge_collapse,
    PermanentSetCheck: judge_permanent_set,
    NotchCheck: judge_notches,
    FatigueCheck: judge_fatigue,
}


def judged_by_hand(here: Loading) -> Iterator[Judged]:
    """Yield what all checks by hand make of a load case in a pose.

    Parameters
    ----------
    here : Loading

    Yields
    ------
    Judged
    """
    for kind, how in BY_HAND.items():
        for one in asked(here.case, kind):
            yield how.judge(here, one)


def judged_on_solids(here: SolvedLinks) -> Iterator[Judged]:
    """Yield what all checks on solids make of a load case in a pose; a link on which nothing acts has no end.

    Parameters
    ----------
    here : SolvedLinks

    Yields
    ------
    Judged
    """
    for kind, judge in ON_SOLIDS.items():
        for one in asked(here.case, kind):
            found = judge(here, one)
            if one.subject.kind == "link" and not here.acts_on(one.subject.name):
                idle = one.outcome(here.load_case, Band.exact(math.inf), reason("idle_link"))
                found = replace(found, outcome=idle)
            yield found
