"""Speeds, accelerations, momentum and energy over a motion: of links, of points, of the linkage as a whole."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.joint_paths import moving_points, owners
from alula.geometry.linkage.motion import Motion
from alula.loads.states.case_motion import CaseMotion
from alula.loads.statics.momentum import LinkageMomentum, on_ground

Real = NDArray[np.float64]
Values = NDArray[Any]
"""Over the n poses: real numbers, or vectors of the plane as complex ones, x + iy."""

QUANTITIES = {
    "angular_speed": "rad/s",
    "angular_acceleration": "rad/s²",
    "speed": "mm/s",
    "acceleration": "mm/s²",
    "momentum": "mN·s",
    "angular_momentum": "N·mm·s",
    "kinetic_energy": "N·mm",
    "potential_energy": "N·mm",
    "shaking_force": "N",
    "shaking_moment": "N·mm",
    "ground_force": "N",
    "ground_moment": "N·mm",
}
"""Unit of each quantity. N·mm is mJ, and mN·s is g·m/s."""
_ROUNDING = 1e-12
_GRAMS, _MILLI = 1e6, 1e3


@dataclass(frozen=True, kw_only=True, eq=False)
class Rates:
    """Rates at every pose of a motion that has a speed, in the units of ``QUANTITIES``; rounding is zero.

    Attributes
    ----------
    motion : Motion
        At the speed that they belong to.
    about : str or None
        The joint about which moments of the whole are taken; None for the global origin.
    place : complex
        That point [mm].
    masses : mapping of str to float
        Link -> its mass, with what it carries [g].
    links : mapping of str to mapping
        Moving link -> quantity -> values; without momentum and energy where it has no mass.
    points : mapping of str to mapping
        Moving point -> quantity -> values.
    whole : mapping of str to array
        Quantity of the linkage -> values; without those of inertia where nothing was weighed.
    """

    motion: Motion
    about: str | None
    place: complex
    masses: Mapping[str, float]
    links: Mapping[str, Mapping[str, Values]]
    points: Mapping[str, Mapping[str, Values]]
    whole: Mapping[str, Values]


def series(result: CaseMotion, load_case: str | None = None) -> Rates | None:
    """Return the rates of a motion at the speed of a load case.

    Parameters
    ----------
    result : CaseMotion
    load_case : str, optional
        The speed of the motion itself, and nothing of the loads, unless given.

    Returns
    -------
    Rates or None
        None without a speed.
    """
    motion = result.motion if load_case is None else result.moved[load_case]
    if not motion.moves:
        return None
    momentum, longest = result.momentum(load_case), motion.linkage.longest
    mass = 0.0 if momentum is None else sum(one.mass for one in momentum.links.values())
    speed, rate = (float(np.max(np.abs(v))) for v in (motion.point_velocities, motion.point_accelerations))
    sizes = {
        "angular_speed": speed / longest,
        "angular_acceleration": rate / longest,
        "speed": speed,
        "acceleration": rate,
        "momentum": _MILLI * mass * speed,
        "angular_momentum": mass * speed * longest,
        "kinetic_energy": mass * speed**2,
        "shaking_force": mass * rate,
        "shaking_moment": mass * rate * longest,
    }

    def clean(values: Mapping[str, Values]) -> dict[str, Values]:
        return {key: _clean(found, _ROUNDING * sizes.get(key, 0.0)) for key, found in values.items()}

    about, place = result.moment_point
    return Rates(
        motion=motion,
        about=about,
        place=place,
        masses={} if momentum is None else {link: _GRAMS * one.mass for link, one in momentum.links.items()},
        links={link: clean(_of_link(motion, link, momentum)) for link in motion.linkage.moving},
        points={label: clean(_of_point(motion, label)) for label in moving_points(motion)},
        whole=clean(_of_whole(result, load_case, momentum)),
    )


def _clean(values: Values, nil: float) -> Values:
    """Values, or components of vectors, with zero for what is not above ``nil``."""
    if np.iscomplexobj(values):
        return _clean(values.real, nil) + 1j * _clean(values.imag, nil)
    return np.where(np.abs(values) <= nil, 0.0, values)


def _of_link(motion: Motion, link: str, momentum: LinkageMomentum | None) -> dict[str, Values]:
    found: dict[str, Values] = {
        "angular_speed": motion.angular_speed(link),
        "angular_acceleration": motion.angular_acceleration(link),
    }
    if momentum is None or link not in momentum.links:
        return found
    own = momentum.links[link]
    carried = {"momentum": _MILLI * own.linear, "angular_momentum": own.angular, "kinetic_energy": own.kinetic}
    return found | carried


def _of_point(motion: Motion, label: str) -> dict[str, Values]:
    column = motion.column(*owners(motion, label)[0])
    return {"speed": motion.point_velocities[:, column], "acceleration": motion.point_accelerations[:, column]}


def _of_whole(result: CaseMotion, load_case: str | None, momentum: LinkageMomentum | None) -> dict[str, Values]:
    found: dict[str, Values] = {}
    if momentum is not None:
        found |= {
            "momentum": _MILLI * momentum.linear,
            "angular_momentum": momentum.angular,
            "kinetic_energy": momentum.kinetic,
            "shaking_force": momentum.shaking_force,
            "shaking_moment": momentum.shaking_moment,
        }
    if load_case is None:
        return found
    if result.case.load_cases[load_case].own_weight:
        found["potential_energy"] = result.power[load_case].potential
    force, moment = on_ground(result.loads[load_case], result.moved[load_case].placement, result.moment_point[1])
    return found | {"ground_force": force, "ground_moment": moment}
