"""A flat bar under every kind of load at once over a full turn, for the tests of unit loads."""

import math

import numpy as np

from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.fea.elements.quadrature import volume_quadrature
from alula.geometry.parts.part import Bar, Body, Pin, PlainEnd
from alula.loads.records.applied import BodyForce, LineLoad, PartMass

L, RHO, POSES = 20.0, 1.2e-9, 24
TURN = np.linspace(0.0, 2.0 * math.pi, POSES, endpoint=False)
PART = Bar.model_construct(width=5.0, thickness=3.0, eye_diameter=5.0, eye_thickness=3.0, fillet_radius=0.0)
BODY = Body(
    part=PART,
    pins=(Pin(name="A", x=0.0, y=0.0, diameter=1.5), Pin(name="B", x=L, y=0.0, diameter=1.5)),
    ends=(PlainEnd(name="T", x=26.5, patch=1.0),),
    holes=(),
)


def mass_of(space):
    volume = volume_quadrature(space)
    mass = RHO * volume.measure
    arm = volume.x[..., :2] - volume.centroid[:2]
    return PartMass(
        mass=mass, centroid=volume.centroid[:2], inertia=RHO * float((volume.w * (arm**2).sum(axis=2)).sum())
    )


def history(space, **changes):
    """A turning force at B, an end load, a spread load and inertia, balanced by the pin and a torque at A."""
    mass = mass_of(space)
    acceleration = np.column_stack(
        [3e6 * np.cos(TURN), -2e6 * np.sin(TURN), 5e4 * np.sin(2 * TURN), np.full(POSES, 2e4)]
    )
    at_b = np.column_stack([2.0 * np.cos(TURN), 2.0 * np.sin(TURN), np.zeros(POSES)])
    end = np.column_stack([0.1 * np.sin(TURN), np.full(POSES, -0.2), np.full(POSES, 0.7)])
    line = np.zeros((POSES, 2, 2))
    line[:, 0, 1], line[:, 1, 1], line[:, 1, 0] = 0.01 * np.cos(TURN), -0.03, 0.005
    c = complex(*mass.centroid)
    sx, sy, rate, square = acceleration.T
    inert = mass.mass * (sx + 1j * sy + (square - 1j * rate) * c)
    torque = (np.conj(c) * mass.mass * (sx + 1j * sy)).imag
    torque = torque - (mass.inertia + mass.mass * abs(c) ** 2) * rate
    first, last = 4.0, 16.0
    q0, q1 = (line[:, i, 0] + 1j * line[:, i, 1] for i in (0, 1))
    spread, length = (last - first) * (q0 + q1) / 2.0, last - first
    arm = first * spread + length**2 * (q0 + 2.0 * q1) / 6.0
    force = -(at_b[:, 0] + 1j * at_b[:, 1] + end[:, 0] + 1j * end[:, 1] + inert + spread)
    torque = torque + L * at_b[:, 1] + 26.5 * end[:, 1] + end[:, 2] + arm.imag
    parts = {
        "pins": {"A": np.column_stack([force.real, force.imag, np.zeros(POSES)]), "B": at_b},
        "couples": {"A": -torque},
        "ends": {"T": end},
        "lines": (line,),
        "mass": mass,
    } | changes
    mass = parts["mass"]
    return LinkLoads(
        name="turn",
        link="bar",
        pins=tuple(
            PinLoad(name=pin.name, centre=np.tile([pin.x, 0.0, 0.0], (POSES, 1)), diameter=pin.diameter, wrench=six(w))
            for pin, w in zip(BODY.pins, parts["pins"].values(), strict=True)
        ),
        couples=tuple(DriveCouple(pin=pin, torque=torque) for pin, torque in parts["couples"].items()),
        ends=tuple(
            EndLoad(name=name, point=np.array([26.5, 0.0, 0.0]), wrench=six(w)) for name, w in parts["ends"].items()
        ),
        lines=tuple(
            LineLoad(link="bar", start=first, end=last, at_start=three(q[:, 0]), at_end=three(q[:, 1]), axes="link")
            for q in parts["lines"]
        ),
        inertia=None
        if mass is None
        else BodyForce(
            link="bar",
            mass=mass,
            specific_force=three(acceleration[:, :2]),
            angular_acceleration=rate,
            angular_speed_squared=square,
            axes="link",
        ),
    )


def six(planar):
    """Fx, Fy and Mz (n, 3) as (n, 6)."""
    return np.asarray(planar) @ np.eye(6)[[0, 1, 5]]


def three(planar):
    """Vectors of the plane (n, 2) as (n, 3)."""
    return np.asarray(planar) @ np.eye(3)[:2]
