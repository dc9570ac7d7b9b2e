"""A kind of check from loads, from its entry to its table, as a contributor would add it: the force of each joint.

What stands here would be in four files: the entry in ``loads/records/check_spec.py``, the quantity in
``fea/common/verdict.py``, what it makes of a load case in a file of its own in ``fea/judging/``, and the line in
``BY_HAND`` (``fea/check/kinds.py``). A table of what it found besides would be an entry of ``reports/check/modes.py``.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from alula.fea.asked.asked import Asked
from alula.fea.common.band import Band
from alula.fea.common.scatter import load_scatter
from alula.fea.common.verdict import Quantity, Sense
from alula.fea.judging.loading import ByHand, Judged, Loading
from alula.geometry.base.model import CaseModel, Name
from alula.geometry.base.units import POSITIVE, Force
from alula.loads.case.case import Case
from alula.loads.records.check_spec import Check
from alula.reports.check.modes import Telling
from alula.reports.sections.data import entries
from alula.reports.sections.table import Column, Number


class ForceCheck(CaseModel):
    """The force of each joint may be at most the maximum."""

    type: Literal["force"]
    maximum: Annotated[Force, POSITIVE]
    joints: tuple[Name, ...] = ()


class ForceCase(Case):
    """A case whose checks may be of that kind as well."""

    checks: dict[str, Annotated[Check | ForceCheck, Field(discriminator="type")]] = {}


FORCE = Quantity._new_member_(Quantity, "joint force", "N", Sense.AT_MOST, "loads", "force")
"""As a line ``FORCE = "joint force", "N", Sense.AT_MOST, "loads", "force"`` would make it."""
FORCE._name_ = "FORCE"


@dataclass(frozen=True)
class JointForce:
    """What is told of a joint besides."""

    across: float


def judge_force(here: Loading, one: Asked) -> Judged:
    """Return what becomes of a joint."""
    joint = one.subject.name
    sizes = [float(np.linalg.norm(wrench[:2])) for wrench in here.wrenches(joint)]
    spread = load_scatter(here.case, here.load_case).times(here.joint_growth(joint))
    outcome = one.outcome(here.load_case, spread.on(Band.around(sizes[0], tuple(sizes))))
    return Judged(outcome=outcome, numbers=(JointForce(sizes[0]),))


BY_FORCE = ByHand(
    judge=judge_force,
    least=lambda over, one: -np.linalg.norm(over.wrenches(one.subject.name)[0][:, :2], axis=1),
)
TOLD = Telling(
    of=JointForce,
    columns=(Column("force", "N"),),
    rows=lambda found: [(Number(found.across),)],
    entries=lambda found: entries(found, "across"),
    caption="Joint forces",
)
