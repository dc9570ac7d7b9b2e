"""What springs and tendons do to the links, and how near joints are to their stops, at one pose or at n.

A spring about a joint and a stop know the angle of the joint's second link to its first. In the stated pose it is the
one less than half a turn from the spring's free angle; for stops, from the stop, or from the middle of all stops of
that joint. Over a motion angles go on from there without jumps.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Measure
from alula.geometry.linkage.placement import Complex, Placement, vector
from alula.loads.case.core import CoreCase
from alula.loads.records.applied import PointLoad
from alula.loads.records.springs import Attachment, LineSpring, Stop, Tendon, TurnSpring

Real = NDArray[np.float64]

TOUCHING = 1e-9
"""Distance from a stop within which it is reached [rad], or over the longest link."""
_COINCIDE = 1e-9
"""Length of a piece over the longest link below which its direction is not known."""
_TIE = 9
"""Decimals of an angle [rad] to which two poses are equally near the stated one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SpringState:
    """A spring or tendon at one pose or at n.

    Attributes
    ----------
    name : str
    kind : {"spring", "tendon"}
    size : array (...)
        Its length [mm], or the angle of its joint [rad].
    effort : array (...)
        Its pull [N], negative where it pushes; or its moment on the joint's second link [N mm].
    turns : bool
        True for a spring about a joint.
    """

    name: str
    kind: str
    size: Real
    effort: Real
    turns: bool = False


def spring_states(case: CoreCase, place: Placement) -> tuple[SpringState, ...]:
    """Return lengths and forces, or angles and moments, of all springs and tendons.

    Parameters
    ----------
    case : Case
    place : Placement
        Where the links stand.

    Returns
    -------
    tuple of SpringState
        Springs first, as the case states them.
    """
    found = []
    for name, spring in case.springs.items():
        if isinstance(spring, TurnSpring):
            angle, moment = turned_spring(case, name, spring, place)
            found.append(SpringState(name=name, kind="spring", size=angle, effort=moment, turns=True))
        else:
            length = route_length(place, spring.between)
            pull = spring.stiffness * (length - free_length(case, spring))
            found.append(SpringState(name=name, kind="spring", size=length, effort=pull))
    for name, tendon in case.tendons.items():
        length = route_length(place, tendon.through)
        found.append(SpringState(name=name, kind="tendon", size=length, effort=tension(tendon, length)))
    return tuple(found)


def spring_loads(case: CoreCase, place: Placement) -> tuple[PointLoad, ...]:
    """Return what springs and tendons do to the links, the ground included.

    Parameters
    ----------
    case : Case
    place : Placement
        Where the links stand.

    Returns
    -------
    tuple of PointLoad
        In global axes, at the poses of ``place``.

    Raises
    ------
    CaseError
        Where two points of a spring or tendon coincide, so that its direction is not known.
    """
    found: list[PointLoad] = []
    for state in spring_states(case, place):
        if state.turns:
            spring = case.springs[state.name]
            assert isinstance(spring, TurnSpring)
            joint, points = case.joints[spring.joint], case.linkage.joint_points(spring.joint)
            for link, point, sense in zip(joint.links, points, (-1.0, 1.0), strict=True):
                wrench = np.zeros((*place.shape, 6))
                wrench[..., 5] = sense * state.effort
                found.append(PointLoad(link=link, point=point, wrench=wrench))
        else:
            entry = f"{state.kind}s.{state.name}"
            line = case.springs[state.name] if state.kind == "spring" else case.tendons[state.name]
            assert isinstance(line, LineSpring | Tendon)
            route = line.between if isinstance(line, LineSpring) else line.through
            found += _pulled(entry, place, route, state.effort)
    return tuple(found)


def _pulled(entry: str, place: Placement, route: Sequence[Attachment], pull: Real) -> Iterator[PointLoad]:
    """Yield what a force along a route does to each of its points; pieces of no force need no direction."""
    at = _places(place, route)
    forces = np.zeros((len(route), *place.shape), dtype=complex)
    for i in range(len(route) - 1):
        piece = at[i + 1] - at[i]
        length = np.abs(piece)
        unknown = (length <= _COINCIDE * place.linkage.longest) & (pull != 0.0)
        if np.any(unknown):
            one, other = (f"'{place.at}' of link '{place.link}'" for place in route[i : i + 2])
            raise CaseError(
                f"{entry}: points {one} and {other} coincide, so the direction of its force is not known; move one of "
                "them, or change the pose"
            )
        force = pull * piece / np.where(length > 0.0, length, 1.0)
        forces[i] += force
        forces[i + 1] -= force
    for point, force in zip(route, forces, strict=True):
        wrench = np.concatenate([vector(force), np.zeros((*place.shape, 3))], axis=-1)
        yield PointLoad(link=point.link, point=point.at, wrench=wrench)


def _places(place: Placement, route: Sequence[Attachment]) -> list[Complex]:
    return [place.position(point.link, point.at) for point in route]


def route_length(place: Placement, route: Sequence[Attachment]) -> Real:
    """Return the length of the line through points of links.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    route : sequence of Attachment
        Its k points.

    Returns
    -------
    array (...)
        [mm]
    """
    at = _places(place, route)
    return np.asarray(sum(np.abs(b - a) for a, b in itertools.pairwise(at)))


def free_length(case: CoreCase, spring: LineSpring) -> float:
    """Return the length at which a spring neither pulls nor pushes; negative where it would pull at any length.

    Parameters
    ----------
    case : Case
        In whose stated pose a preload acts.
    spring : LineSpring

    Returns
    -------
    float
        [mm]
    """
    if spring.free_length is not None:
        return spring.free_length
    assert spring.preload is not None
    return float(route_length(case.stated_pose.placement, spring.between)) - spring.preload / spring.stiffness


def tension(tendon: Tendon, length: Real) -> Real:
    """Return the force in a tendon.

    Parameters
    ----------
    tendon : Tendon
    length : array (...)
        Of the whole [mm].

    Returns
    -------
    array (...)
        [N], never negative.
    """
    if tendon.tension is not None:
        return np.full(np.shape(length), tendon.tension)
    assert tendon.stiffness is not None
    assert tendon.free_length is not None
    return np.asarray(np.maximum(tendon.stiffness * (length - tendon.free_length), 0.0))


def turned_spring(case: CoreCase, name: str, spring: TurnSpring, place: Placement) -> tuple[Real, Real]:
    """Return the angle of a spring about a joint, and its moment on the joint's second link.

    Parameters
    ----------
    case : Case
    name : str
        Of the spring.
    spring : TurnSpring
    place : Placement
        Where the links stand.

    Returns
    -------
    tuple of 2 array (...)
        [rad] and [N mm].
    """
    stated = float(_relative(case, spring.joint, case.stated_pose.placement))
    turned = turned_since(case, f"springs.{name}", spring.joint, place)
    if spring.preload is not None:
        return stated + turned, spring.preload - spring.stiffness * turned
    assert spring.free_angle is not None
    stated = spring.free_angle + _within(stated - spring.free_angle)
    return stated + turned, -spring.stiffness * (stated - spring.free_angle + turned)


def _relative(case: CoreCase, joint: str, place: Placement) -> Real:
    first, second = case.joints[joint].links
    return np.asarray(place.angle(second) - place.angle(first))


def _within(angle: Real | float) -> float:
    """Return an angle by full turns less than half a turn from zero."""
    return math.remainder(float(angle), 2.0 * math.pi)


def turned_since(case: CoreCase, entry: str, joint: str, place: Placement) -> Real:
    """Return how far a revolute joint has turned since the stated pose, without jumps over the poses.

    Of angles that differ by full turns, the stated pose counts as the one nearest to these poses.

    Parameters
    ----------
    case : Case
    entry : str
        Of the case file, for messages.
    joint : str
    place : Placement
        Where the links stand.

    Returns
    -------
    array (...)
        [rad]
    """
    found = _relative(case, joint, place) - _relative(case, joint, case.stated_pose.placement)
    if not np.size(found):
        return found
    every = np.ravel(found)
    nearest = int(np.argmin(np.round(np.abs(np.remainder(every + np.pi, 2.0 * np.pi) - np.pi), _TIE)))
    return np.asarray(found - 2.0 * np.pi * np.round(every[nearest] / (2.0 * np.pi)))


def stop_gaps(case: CoreCase, place: Placement) -> dict[str, Real]:
    """Return how far joints are from their stops: negative beyond one.

    Parameters
    ----------
    case : Case
    place : Placement
        Where the links stand.

    Returns
    -------
    dict of str to array (...)
        Stop -> [rad] at a revolute joint, [mm] at a slider.
    """
    return {name: stop.sense * (joint_value(case, stop, place) - stop.limit.value) for name, stop in case.stops.items()}


def joint_value(case: CoreCase, stop: Stop, place: Placement) -> Real:
    """Return the angle or the travel that a stop limits.

    Parameters
    ----------
    case : Case
    stop : Stop
    place : Placement
        Where the links stand.

    Returns
    -------
    array (...)
        [rad] or [mm]
    """
    if stop.limit.measure is Measure.TRAVEL:
        return np.asarray(place.q[..., len(case.linkage.moving) + place.closure.slots.index(stop.joint)])
    limits = [other.limit.value for other in case.stops.values() if other.joint == stop.joint]
    middle = (min(limits) + max(limits)) / 2.0
    stated = middle + _within(float(_relative(case, stop.joint, case.stated_pose.placement)) - middle)
    return stated + turned_since(case, "stops", stop.joint, place)


def touching(case: CoreCase, stop: Stop) -> float:
    """Return the distance from a stop within which it is reached.

    Parameters
    ----------
    case : Case
    stop : Stop

    Returns
    -------
    float
        [rad] or [mm]
    """
    return TOUCHING * stop.limit.measure.scale(case.linkage)
