"""A kind of check from its entry to its outcome, as a contributor would add it: how far a linkage reaches in its pose.

What stands here would be in four files: the entry in ``loads/records/check_spec.py``, the quantity in
``fea/common/verdict.py``, the outcomes in a file of their own in ``fea/whole/``, and the line in ``KINDS`` there.
"""

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from alula.fea.asked.asked import asked
from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Sense
from alula.fea.whole.outcomes import WholeNumbers
from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import POSITIVE, Length
from alula.loads.case.case import Case
from alula.loads.records.check_spec import Check


class ReachCheck(CaseModel):
    """No point of a moving link may lie further from the origin than the maximum."""

    type: Literal["reach"]
    maximum: Annotated[Length, POSITIVE]


class ReachCase(Case):
    """A case whose checks may be of that kind as well."""

    checks: dict[str, Annotated[Check | ReachCheck, Field(discriminator="type")]] = {}


REACH = Quantity._new_member_(Quantity, "reach", "mm", Sense.AT_MOST, "shape", "reach")
"""As a line ``REACH = "reach", "mm", Sense.AT_MOST, "shape", "reach"`` would make it."""
REACH._name_ = "REACH"


def reach_outcomes(found: WholeNumbers) -> Iterator[CheckOutcome]:
    """Yield the outcome of every check of reach."""
    case, pose = found.case, found.case.solve_pose()
    places = [pose.position(link, point) for link in case.linkage.moving for point in case.links[link].points]
    furthest = Band.exact(max(float(np.linalg.norm(place)) for place in places))
    for one in asked(case, ReachCheck, quantity=REACH):
        yield one.for_all(case, furthest)
