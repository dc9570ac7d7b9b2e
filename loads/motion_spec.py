"""The table ``[motion]`` of a case file: what drives the linkage, over which range, how fast."""

import math
from typing import Annotated

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from geometry.model import CaseModel, Name
from geometry.units import Angle, AngularAcceleration, AngularSpeed


class MotionSpec(CaseModel):
    """The motion of the linkage on the branch of its stated pose."""

    coordinate: Name | None = None
    """The link whose direction is prescribed; the pose's own coordinate when left out."""
    range: tuple[Angle, Angle] | None = None
    """First and last direction of that link; from 350 deg to 10 deg it turns back by 340 deg."""
    turn: bool = False
    """True for a full turn from the stated pose: counter-clockwise, or clockwise at a negative speed."""
    poses: Annotated[int, Field(ge=3, le=100_000)] = 361
    """Number of poses, evenly spaced in the angle, both ends included."""
    speed: AngularSpeed = 0.0
    """Angular speed of the coordinate's link at the first pose; constant unless an acceleration is stated."""
    acceleration: AngularAcceleration = 0.0
    """Constant angular acceleration along the motion; negative where the drive slows down."""
    inertia: bool = False
    """True: the inertia of the links' parts and of what they carry loads the joints."""

    @model_validator(mode="after")
    def _fits(self) -> "MotionSpec":
        if self.turn == (self.range is not None):
            raise PydanticCustomError(
                "turn_or_range",
                'it needs either turn = true or a range such as range = ["0 deg", "90 deg"]; state one of the two',
            )
        if self.range is not None and math.isclose(*self.range, abs_tol=1e-12):
            raise PydanticCustomError(
                "empty_range", "range begins and ends at the same angle; state two different ones"
            )
        if self.range is not None and self.speed < 0.0:
            raise PydanticCustomError(
                "speed_sign",
                "the order of the range gives the direction, so speed must not be negative; swap the ends of the range",
            )
        if self.inertia and self.speed == 0.0 and self.acceleration == 0.0:
            raise PydanticCustomError(
                "no_speed", 'inertia = true needs a speed; state one, for example speed = "150 rpm"'
            )
        if self.speed == 0.0 and self.acceleration < 0.0:
            raise PydanticCustomError(
                "no_start", "from rest the acceleration must be positive; state a speed or turn it"
            )
        return self
