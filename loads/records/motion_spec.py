"""The table ``[motion]`` of a case file: what drives the linkage, over which range, how fast."""

import math
from typing import Annotated

from pydantic import Field, PrivateAttr, ValidationInfo, model_validator

from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import Acceleration, Angle, AngularAcceleration, AngularSpeed, Length, Speed
from alula.loads.records.cycle_spec import CycleMotion


class MotionSpec(CaseModel):
    """The motion of the linkage on the branch of its stated pose."""

    coordinate: Name | None = None
    """The link whose direction is prescribed, or with a travel the slider or slot; the pose's own coordinate when left
    out."""
    range: tuple[Angle, Angle] | None = None
    """First and last direction of that link; from 350 deg to 10 deg it turns back by 340 deg."""
    travel: tuple[Length, Length] | None = None
    """First and last travel of the slider or slot, in place of a range."""
    turn: bool = False
    """True for a full turn from the stated pose: counter-clockwise, or clockwise at a negative speed."""
    poses: Annotated[int, Field(ge=2, le=100_000)] = 361
    """Number of poses, evenly spaced in the angle or travel, both ends included."""
    speed: AngularSpeed = 0.0
    """Angular speed of the coordinate's link at the first pose; constant unless an acceleration is stated."""
    acceleration: AngularAcceleration = 0.0
    """Constant angular acceleration along the motion; negative where the drive slows down."""
    travel_speed: Speed = 0.0
    """Speed of the slider or slot at the first pose, in place of the angular speed."""
    travel_acceleration: Acceleration = 0.0
    """Constant acceleration of the slider or slot, in place of the angular one."""
    instant_centre: Name | None = None
    """A moving link whose instant centre is told over the motion, and where the line of the load on it runs past it."""
    against: Name | None = None
    """The link against which the instant centre is taken; the ground when left out."""
    inertia: bool | None = None
    """Whether the inertia of the links' parts and of what they carry loads the joints: where a speed or an acceleration
    is stated, unless this is false."""
    _states: CycleMotion | None = PrivateAttr(None)

    @property
    def velocity(self) -> float:
        """The angular speed with the sign of the way that the range goes [rad/s]."""
        return self.speed if self.ends is None else math.copysign(self.speed, self.ends[1] - self.ends[0])

    @property
    def states(self) -> CycleMotion | None:
        """What a cycle's table says of the motion, in place of range and speed; None without one."""
        return self._states

    def through(self, states: CycleMotion | None) -> "MotionSpec":
        """Return the motion that goes from state to state.

        Parameters
        ----------
        states : CycleMotion or None
            None for the way between its ends, once and evenly.

        Returns
        -------
        MotionSpec
        """
        found = self.model_copy()
        found._states = states
        return found

    @property
    def moves(self) -> bool:
        """True where it has a speed or an acceleration."""
        if self._states is not None:
            return self._states.times is not None
        return self.rate != (0.0, 0.0)

    @property
    def ends(self) -> tuple[float, float] | None:
        """First and last angle [rad] or travel [mm]; None for a full turn."""
        return self.range if self.travel is None else self.travel

    @property
    def rate(self) -> tuple[float, float]:
        """Speed and acceleration of the coordinate: rad/s and rad/s², or mm/s and mm/s²."""
        if self.travel is None:
            return self.speed, self.acceleration
        return self.travel_speed, self.travel_acceleration

    @model_validator(mode="after")
    def _fits(self, info: ValidationInfo) -> "MotionSpec":
        alone = (info.context or {}).get("cycle") is None  # else its way is that of the cycle's table
        slides, (speed, acceleration) = self.travel is not None, self.rate
        angular = (self.speed, self.acceleration) != (0.0, 0.0)
        along = (self.travel_speed, self.travel_acceleration) != (0.0, 0.0)
        rules = {
            'it needs either turn = true or a range such as range = ["0 deg", "90 deg"] or travel = ["0 mm", "10 mm"]; '
            "state one of them": alone and self.turn + (self.range is not None) + slides != 1,
            "a full turn needs at least 3 poses, since its last pose is its first; write poses = 3 or more": (
                self.turn and self.poses < 3
            ),
            "a slider has no angular speed or acceleration; state travel_speed and travel_acceleration": (
                angular and slides
            ),
            "travel_speed and travel_acceleration belong to the travel of a slider; state travel as well": (
                along and not slides
            ),
            f"it begins and ends at the same {'travel' if slides else 'angle'}; state two different ones": (
                alone and self.ends is not None and math.isclose(*self.ends, abs_tol=1e-12)
            ),
            "the order of the ends gives the direction, so speed must not be negative; swap the ends": (
                self.ends is not None and speed < 0.0
            ),
            "against is the second link of an instant centre; state instant_centre as well": (
                self.against is not None and self.instant_centre is None
            ),
            f"'{self.against}' does not turn against itself; state two different links": (
                self.against is not None and self.against == self.instant_centre
            ),
            'inertia = true needs a speed; state one, for example speed = "150 rpm"': (
                alone and self.inertia is True and speed == 0.0 and acceleration == 0.0
            ),
            "without a speed the acceleration must be positive; state a speed, or change the sign": (
                speed == 0.0 and acceleration < 0.0
            ),
        }
        for rule, broken in rules.items():
            if broken:
                raise refusal(rule)
        return self
