"""What a level makes of a case: each test a variant of it, with a load case, checks and conditions of its own."""

from collections.abc import Iterator
from contextlib import suppress
from enum import StrEnum
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.loads.case.break_rules import break_links, check_break_check, check_eye_check, check_wall_check, eye_links
from alula.loads.case.core import CoreCase
from alula.loads.records.check_spec import (
    Check,
    EyeCheck,
    FatigueCheck,
    NotchCheck,
    PermanentSetCheck,
    PinCheck,
    PlasticCollapseCheck,
    SafetyFactorCheck,
    WallCheck,
)
from alula.loads.records.level import Level, LevelTest, selected
from alula.loads.records.load_case import LoadCase


class Demand(StrEnum):
    """What a test asks for."""

    ELASTIC = "stays elastic"
    PERMANENT_SET = "permanent set"
    NO_BREAK = "does not break"
    LASTS = "lasts"
    BESIDES = "besides"
    """What no entry of the test asks for and alula looks at all the same, such as gaps between layers."""
