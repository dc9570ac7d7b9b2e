"""A link under every kind of load at once, at several poses, with pins of two sizes and a slot."""

from dataclasses import replace

import numpy as np

from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.geometry.parts.part import Bar, Body, Pin, PlainEnd
from alula.loads.records.applied import BodyForce, LineLoad, PartMass, shifted

RHO, POSES = 1.2e-9, 5
BODY = Body(
    part=Bar(
        shape="bar", material="resin", width="6 mm", thickness="4 mm", eye_diameter="8 mm", eye_thickness="4 mm",
        fillet_radius="1 mm",
    ),
    pins=(
        Pin(name="A", x=0.0, y=0.0, diameter=3.0),
        Pin(name="S", x=16.0, y=0.0, diameter=2.6, slot=4.0, clearance=0.1),
        Pin(name="B", x=34.0, y=0.0, diameter=2.0),
    ),
    ends=(PlainEnd(name="T", x=44.0, patch=2.0),),
    holes=(),
)  # fmt: skip
TURN = np.linspace(0.3, 1.7, POSES)
STRAIGHT, NOTHING = np.ones(POSES), np.zeros(POSES)


def every_load() -> LinkLoads:
    """Thrust, couples that a pin takes on one side and on both, friction in bore and slot, a torque; A balances all."""
    slide = np.linspace(14.5, 17.0, POSES)
    across, rub = np.linspace(8.0, -6.0, POSES), np.array([0.8, 0.5, 0.0, -0.4, 0.6])
    slot = PinLoad(
        name="S", centre=np.column_stack([slide, NOTHING, NOTHING]), diameter=2.5, slotted=True, friction=rub,
        wrench=np.column_stack([rub, across, 0.5 * STRAIGHT, [2.0, 9.0, 3.0, 1.0, 0.0], NOTHING, NOTHING]),
    )  # fmt: skip
    slot.wrench[:, 5] = slot.rubbed
    turned = np.column_stack(
        [6.0 * np.cos(TURN), 5.0 * np.sin(TURN), np.array([2.0, -1.0, 0.0, 1.5, -2.0]), -3.0 * TURN, 4.0 * np.cos(TURN)]
    )
    friction = 0.3 * np.cos(TURN)
    loads = LinkLoads(
        name="all",
        link="arm",
        pins=(
            PinLoad(name="A", centre=np.zeros((POSES, 3)), diameter=3.0, wrench=np.zeros((POSES, 6))),
            slot,
            PinLoad(
                name="B", centre=np.tile([34.0, 0.0, 0.0], (POSES, 1)), diameter=2.0, friction=friction,
                wrench=np.column_stack([turned, friction + 1.0]),
            ),
        ),
        couples=(DriveCouple(pin="A", torque=10.0 * np.sin(TURN)),),
        ends=(
            EndLoad(
                name="T", point=np.array([44.0, 0.0, 0.0]),
                wrench=np.outer(np.cos(TURN), [0.5, -0.4, 0.2, 0.3, -0.2, 0.6]),
            ),
        ),
        lines=(
            LineLoad(
                link="arm", start=20.0, end=30.0, at_start=np.outer(TURN, [0.01, -0.05, 0.02]),
                at_end=np.outer(STRAIGHT, [0.0, 0.03, 0.01]), axes="link",
            ),
        ),
        inertia=BodyForce(
            link="arm", mass=PartMass(mass=1e-6, centroid=np.array([20.0, 0.0]), inertia=2e-4), axes="link",
            specific_force=np.outer(TURN, [2e5, -1e5, 5e4]), angular_acceleration=2e3 * TURN,
            angular_speed_squared=900.0 * STRAIGHT,
        ),
    )  # fmt: skip
    held, *others = loads.pins
    rest = -loads.resultant()
    return replace(loads, pins=(replace(held, wrench=shifted(rest, -held.centre)), *others))
