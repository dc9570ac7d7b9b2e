"""From the load case that a user states to all that acts on the links, at one pose or at n."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.features import FlatFace
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose
from alula.loads.acting.acting import Acting, loads_of
from alula.loads.acting.dead_load import DeadLoad
from alula.loads.acting.load_line import ForceOnLine
from alula.loads.acting.sprung import Sprung
from alula.loads.acting.stop import Bound
from alula.loads.acting.weight import Weight
from alula.loads.case.case import Case
from alula.loads.case.core import CoreCase
from alula.loads.records.aero import air_loads
from alula.loads.records.applied import LineLoad, Load, PartMass, PointLoad, at_poses, shifted
from alula.loads.records.carried import mass_of
from alula.loads.records.load_case import LoadCase, gravity, vector3
from alula.loads.states.flapping import FlappingAir
from alula.loads.states.masses import all_carried

Real = NDArray[np.float64]

_SAME_SPEED = 1e-6
"""Difference of two links' angular speeds times the longest link, over the largest speed, below which they are one."""


def needs_masses(case: Case) -> bool:
    """Return True where a load case needs the masses of the parts, for weight or for inertia.

    Parameters
    ----------
    case : Case

    Returns
    -------
    bool
    """
    return any(load_case.own_weight or load_case.speed != 0.0 for load_case in case.load_cases.values())


def placed(pose: Pose, speed: float) -> Placement:
    """Return where the links stand at a pose, and how they move at a constant speed of its coordinate.

    Parameters
    ----------
    pose : Pose
    speed : float
        Of its coordinate [rad/s].

    Returns
    -------
    Placement
        Without rates at speed 0.

    Raises
    ------
    CaseError
        For a speed of a pose without coordinate or at a dead point of its coordinate.
    """
    if speed == 0.0:
        return pose.placement
    place = replace(solve_motion(pose, [pose.held], speed=speed).placement.chosen(0), q=pose.q)
    refuse_turning_bonds(place)
    return place


def refuse_turning_bonds(place: Placement) -> None:
    """Refuse a motion in which the links of a bonded joint turn against each other.

    Parameters
    ----------
    place : Placement
        One pose or n, with rates.

    Raises
    ------
    CaseError
        With the first such joint.
    """
    linkage = place.linkage
    rates = [np.hypot(np.abs(place.velocity(n)), linkage.longest * place.spin(n)) for n in linkage.moving]
    most = float(np.max(rates)) / linkage.longest
    for name, joint in linkage.joints.items():
        first, second = (place.spin(link) for link in joint.links)
        if joint.fixed and np.any(np.abs(second - first) > _SAME_SPEED * most):
            raise CaseError(
                f"joints.{name}.bonded: links '{joint.links[0]}' and '{joint.links[1]}' are bonded there, but they "
                "would turn against each other as the linkage moves; leave out the motion or speed, leave bonded out, "
                f"or state joints.{name}.angle in a linkage that moves nevertheless"
            )


def lasting(case: CoreCase) -> tuple[Sprung, ...]:
    """Return springs and tendons, which act in every load case.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of Sprung
        Springs first, as the case states them; a case without any needs no pose.
    """
    return tuple(
        one.acting(name, case.stated_pose.placement)
        for table in (case.springs, case.tendons)
        for name, one in table.items()
    )


def bounds(case: CoreCase) -> dict[str, Bound]:
    """Return the stops of a case.

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict of str to Bound
    """
    return {
        name: stop.acting(
            name, case.stated_pose.placement, [other for other in case.stops.values() if other.joint == stop.joint]
        )
        for name, stop in case.stops.items()
    }


def acting_on(case: Case, load_case: LoadCase, masses: Mapping[str, PartMass], *, inert: bool) -> tuple[Acting, ...]:
    """Return all that acts on the links but stops and joint forces.

    In layers pins weigh too (``alula.loads.case.layers.pin_masses``), in the mid-plane of the link that they stand in.

    Parameters
    ----------
    case : Case
    load_case : LoadCase
        One of the case's.
    masses : mapping of str to PartMass
        Of the parts alone, by link; what links carry comes from the case.
    inert : bool
        True where masses act without weight too, by their inertia.

    Returns
    -------
    tuple of Acting
        Load lines first, then other stated loads, weights, wings that flap, springs and tendons.
    """
    found: list[Acting] = [*map(ForceOnLine, load_case.load_lines), *map(DeadLoad, stated_loads(case, load_case))]
    if load_case.own_weight or inert:
        pull = gravity(load_case) if load_case.own_weight else np.zeros(3)
        found += [Weight(link=link, mass=mass, gravity=pull) for link, mass in masses.items()]
        for one in all_carried(case, stated=load_case.carried):
            mass = mass_of(one, case.links[one.link].points)
            found.append(Weight(link=one.link, mass=mass, gravity=pull, carried=one))
    if load_case.flapping is not None:
        found.append(FlappingAir(case, load_case))
    return (*found, *lasting(case))


def acting_loads(case: Case, load_case: LoadCase, place: Placement, masses: Mapping[str, PartMass]) -> tuple[Load, ...]:
    """Return the loads of all that acts on the links but stops and joint forces.

    Parameters
    ----------
    case : Case
    load_case : LoadCase
        One of the case's.
    place : Placement
        Where the links stand; inertia, and air on wings that flap, act where it has rates.
    masses : mapping of str to PartMass
        Of the parts alone, by link; what links carry comes from the case.

    Returns
    -------
    tuple of Load
        At the poses of ``place``.
    """
    acting = acting_on(case, load_case, masses, inert=place.qddot is not None)
    return tuple(at_poses(load, place.shape) for load in loads_of(acting, place))


def stated_loads(case: Case, load_case: LoadCase) -> tuple[PointLoad | LineLoad, ...]:
    """Return the forces, moments, spread loads and air of a load case, the same at every pose: all but load lines.

    Parameters
    ----------
    case : Case
    load_case : LoadCase
        One of the case's.

    Returns
    -------
    tuple of PointLoad or LineLoad
    """
    loads: list[PointLoad | LineLoad] = []
    for force in load_case.forces:
        push, face = vector3(force.force), case.face(force.link, force.at)
        wrench = np.concatenate([push, np.zeros(3)]) if face is None else on_face(face, push)
        loads.append(PointLoad(link=force.link, point=force.at, wrench=wrench, axes=force.axes))
    for moment in load_case.moments:
        wrench = np.array([0.0, 0.0, 0.0, *moment.moment])
        loads.append(PointLoad(link=moment.link, point=moment.at, wrench=wrench))
    for load in load_case.pressures:
        face = case.face(load.link, load.at)
        assert face is not None  # checked as the case was read
        wrench = on_face(face, -load.pressure * face.area * np.array(face.normal))
        loads.append(PointLoad(link=load.link, point=load.at, wrench=wrench, axes="link"))
    for spread in load_case.spread:
        points = case.links[spread.link].points
        start, end = sorted((points[spread.start][0], points[spread.end][0]))
        density = vector3(spread.total) / (end - start)
        loads.append(
            LineLoad(link=spread.link, start=start, end=end, at_start=density, at_end=density, axes=spread.axes)
        )
    for i, air in enumerate(load_case.air):
        loads += air_loads(air, f"air.{i}", case.link_points)
    return tuple(loads)


def on_face(face: FlatFace, force: Real) -> Real:
    """Return an even traction on a face as a load at its point, which lies in the plane z = 0.

    Parameters
    ----------
    face : FlatFace
        The face.
    force : array (3,)
        Its resultant, through the face's centre [N].

    Returns
    -------
    array (6,)
        [N, N mm]; z is that of both the linkage and the link, so that the axes of the plane do not matter.
    """
    return shifted(np.concatenate([force, np.zeros(3)]), np.array([0.0, 0.0, face.centre[2]]))
