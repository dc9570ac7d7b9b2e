"""The resin-printed ornithopter: its parametric rules, and the motion of its wings in closed form.

A crank drives a connecting rod whose far pin slides along the centre line; that pin runs in the slots of
two wing levers, which turn about fixed pivots at ±X beside the line. Source of the rules: Hernández (2022).
"""

import math
import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Annotated, Literal

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Angle, Length
from alula.geometry.mechanisms.wing_drive import WingDrive
from alula.geometry.parts.part import Bar, Body, Disc, Pin, PlainEnd

MARGIN = 0.2
"""By which the slot goes on at either end of the pin's travel [mm]: the printer's tolerance."""
NECK = 0.4
"""By which rod and lever are narrower than their eyes [mm]."""
STUB, SOCKET = 6.0, 2.0
"""How far the lever reaches beyond its pivot to hold the wing, and over which length it does [mm]."""
FILLET = 0.3
"""Where bars meet their eyes [mm]."""
RING = 0.6
"""Width of the rings about the crank's holes on which a torque enters, as a share of the wall about the pin's hole."""


class Motor(CaseModel):
    """A motor of the source's table."""

    kind: Literal["round", "flat-sided"]
    shaft_diameter: Annotated[Length, POSITIVE]
    shaft_height: Annotated[Length, POSITIVE]
    diameter: Annotated[Length, POSITIVE]
    round_height: Annotated[Length, POSITIVE]
    square_width: Annotated[Length, POSITIVE]
    square_height: Annotated[Length, POSITIVE]


@cache
def motors() -> dict[str, Motor]:
    """Return the motor table by name."""
    text = resources.files("alula.geometry").joinpath("motors.toml").read_text(encoding="utf-8")
    return {name: Motor.model_validate(entry) for name, entry in tomllib.loads(text).items()}


def _wing_angle(value: float) -> float:
    if not 0 < value < math.pi / 2:
        raise PydanticCustomError("wing_angle", "a wing angle lies between 0 and 90 degrees")
    return value


def _motor_name(value: str) -> str:
    if value not in motors():
        raise PydanticCustomError(
            "unknown_motor",
            'there is no motor "{name}"; choose one of {known}',
            {"name": value, "known": ", ".join(motors())},
        )
    return value


@dataclass(frozen=True, kw_only=True)
class OrnithopterDimensions:
    """What the rules yield, in mm; the source's own names in brackets.

    Attributes
    ----------
    pivot_offset : float
        X = throw / tan(wing angle).
    slot_reach : float
        [ranura] = throw / sin(wing angle): from the pivot to the pin in the wing's end positions.
    pin_diameter : float
        Diameter of the pins.
    hole_diameter : float
        Diameter of the holes.
    thick_wall : float
        Around holes of base and crank: 0.5 + clearance/2.
    thin_wall : float
        Around holes of cover and wing lever: 0.5 - clearance/2.
    crank_disc_radius : float
        Radius of the crank disc [mxmv].
    motor_half_width : float
        Half the width of the motor [mxmt].
    body_half_width : float
        Half the width of the body [cbct].
    link_length : float
        Of the movement link (connecting rod); also the height of the pivots over the crank.
    pivot_height : float
        Height of the wing pivots over the crank.
    base_width : float
        Width of the base.
    base_height : float
        Height of the base.
    gear_thickness : float
        Thickness of the crank disc.
    crank_pin_height : float
        Height of the crank pin.
    link_thickness : float
        Thickness of the connecting rod.
    lever_thickness : float
        Thickness of the wing lever: the height of the motor's shaft.
    """

    pivot_offset: float
    slot_reach: float
    pin_diameter: float
    hole_diameter: float
    thick_wall: float
    thin_wall: float
    crank_disc_radius: float
    motor_half_width: float
    body_half_width: float
    link_length: float
    pivot_height: float
    base_width: float
    base_height: float
    gear_thickness: float
    crank_pin_height: float
    link_thickness: float
    lever_thickness: float


class OrnithopterRules(CaseModel):
    """The designer's five choices; the defaults are the ornithopter as built."""

    throw: Annotated[Length, POSITIVE] = 3.0
    """Radius of the crank pin [biela]."""
    wing_angle: Annotated[Angle, AfterValidator(_wing_angle)] = math.radians(23)
    """Greatest angle of a wing to the horizontal."""
    pin_diameter: Annotated[Length, POSITIVE] = 2.0
    """Nominal diameter of pins and holes [DI]."""
    clearance: Annotated[Length, NOT_NEGATIVE] = 0.0
    """Taken off the pins and added to the holes [ajuste]."""
    motor: Annotated[str, AfterValidator(_motor_name)] = Field(default="M-C 10 mm")
    """Name in the motor table."""

    def dimensions(self) -> OrnithopterDimensions:
        """Return all dimensions; CaseError where the clearance leaves no pin or no wall."""
        thin = 0.5 - self.clearance / 2
        if self.clearance >= self.pin_diameter or thin <= 0:
            raise CaseError(
                f"ornithopter clearance = {self.clearance:g} mm must stay below 1 mm and below the pin diameter of "
                f"{self.pin_diameter:g} mm, or a pin or a wall vanishes; choose a smaller clearance."
            )
        thick = 0.5 + self.clearance / 2
        motor = motors()[self.motor]
        offset = self.throw / math.tan(self.wing_angle)
        disc = thick + self.throw + self.pin_diameter / 2
        body = max(motor.diameter / 2, disc)
        link = 2 * self.throw + 1.0 + self.pin_diameter + thick + thin
        return OrnithopterDimensions(
            pivot_offset=offset,
            slot_reach=self.throw / math.sin(self.wing_angle),
            pin_diameter=self.pin_diameter - self.clearance,
            hole_diameter=self.pin_diameter + self.clearance,
            thick_wall=thick,
            thin_wall=thin,
            crank_disc_radius=disc,
            motor_half_width=motor.diameter / 2,
            body_half_width=body,
            link_length=link,
            pivot_height=link,
            base_width=max(body, offset) + 1.5,
            base_height=self.throw + link + 1.5,
            gear_thickness=2.0,
            crank_pin_height=2.0,
            link_thickness=2.0,
            lever_thickness=motor.shaft_height,
        )

    def bodies(self, material: str) -> dict[str, Body]:
        """Return the moving parts as solids: "crank", "rod" and "lever" (both levers are alike).

        The crank is a disc with the shaft's hole and the pin's; rod and lever are flat bars with eyes, the lever with
        the slot of the rod's pin. Of the source are the thicknesses, holes, walls about them, the disc's radius and
        the pin's travel in the slot; ``MARGIN``, ``NECK``, ``STUB``, ``SOCKET``, ``FILLET`` and ``RING`` are assumed.

        Parameters
        ----------
        material : str
            Name of their material.

        Returns
        -------
        dict of str to Body
            Bodies by name.
        """
        sizes, hole = self.dimensions(), self.dimensions().hole_diameter

        def bar(wall: float, thickness: float) -> Bar:
            eye = hole + 2 * wall
            return Bar.model_construct(
                shape="bar",
                material=material,
                width=eye - NECK,
                thickness=thickness,
                eye_diameter=eye,
                eye_thickness=thickness,
                fillet_radius=FILLET,
            )

        def pin(name: str, x: float, diameter: float = hole, slot: float = 0.0) -> Pin:
            return Pin(name=name, x=x, y=0.0, diameter=diameter, slot=slot)

        disc = Disc.model_construct(
            shape="disc",
            material=material,
            diameter=2 * sizes.crank_disc_radius,
            thickness=sizes.gear_thickness,
            eye_diameter=hole + 2 * RING * sizes.thick_wall,
        )
        first, last = -sizes.slot_reach - MARGIN, -sizes.pivot_offset + MARGIN
        found: dict[str, tuple[Bar | Disc, tuple[Pin, ...], tuple[PlainEnd, ...]]] = {
            "crank": (disc, (pin("O", 0.0, motors()[self.motor].shaft_diameter), pin("A", self.throw)), ()),
            "rod": (bar(sizes.thick_wall, sizes.link_thickness), (pin("A", 0.0), pin("C", sizes.link_length)), ()),
            "lever": (
                bar(sizes.thin_wall, sizes.lever_thickness),
                (pin("slot", (first + last) / 2, slot=last - first), pin("pivot", 0.0)),
                (PlainEnd(name="W", x=STUB, patch=SOCKET),),
            ),
        }
        return {name: Body(part=part, pins=pins, ends=ends, holes=()) for name, (part, pins, ends) in found.items()}

    def drive(self) -> WingDrive:
        """Return the wing drive of these dimensions, with the rule's link length from pin to pin."""
        sizes = self.dimensions()
        return WingDrive(
            throw=self.throw,
            rod=sizes.link_length,
            pivot_offset=sizes.pivot_offset,
            pivot_height=sizes.pivot_height,
        )


@cache
def variants() -> dict[str, OrnithopterRules]:
    """Return the variants that the source shows, named by wing angle, throw and motor; the last is the built one."""
    return {
        "30° 8 mm 25 mm": OrnithopterRules(throw="8 mm", wing_angle="30 deg", motor="M-SC 25 mm"),
        "20° 3 mm 25 mm": OrnithopterRules(throw="3 mm", wing_angle="20 deg", motor="M-SC 25 mm"),
        "23° 3 mm 10 mm": OrnithopterRules(),
    }
