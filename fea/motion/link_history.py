"""What acts on one link over a whole motion, in the link's own frame: every load an array over the poses."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fea.beam.cut_free import in_slot
from fea.common.link_loads import BodyLoad, DriveCouple, EndLoad, LineLoad, LinkLoads, PinLoad
from geometry.base.errors import CannotRunError, CaseError
from geometry.parts.part import Body, Pin
from loads.records.applied import BodyForce, PointLoad
from loads.records.carried import CarriedSpread
from loads.records.load_case import gravity
from loads.states.actions import PartMass, StatedLoad, stated_loads
from loads.states.case_motion import CaseMotion, with_inertia
from loads.states.kinetostatics import Kinetostatics

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, eq=False)
class LineHistory:
    """A load spread between two stations [mm]; ``intensity`` (n, 2, 2) [N/mm]: pose, station, x and y."""

    first: float
    last: float
    intensity: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkHistory:
    """All loads of one load case on one link at n poses; at every pose together they balance.

    pins          pin -> (n, 3) Fx, Fy [N] and Mz [N mm] about its centre, without the drive torque
    places        pin in a slot -> (n,) x at which it stands [mm], about which its force acts
    couples       pin -> (n,) drive torque on the link [N mm]
    ends          plain end -> (n, 3) Fx, Fy, Mz about its point
    lines         spread loads
    acceleration  (n, 4) what moves mass: gravity less the acceleration of the frame's origin along x and y
                  [mm/s²], angular acceleration [rad/s²], angular speed squared [rad²/s²]
    mass          on which those act; None where they act on nothing
    """

    load_case: str
    body: Body
    pins: Mapping[str, Real]
    couples: Mapping[str, Real]
    ends: Mapping[str, Real]
    lines: tuple[LineHistory, ...]
    acceleration: Real
    mass: PartMass | None
    places: Mapping[str, Real] = field(default_factory=dict)

    @property
    def poses(self) -> int:
        """Number of poses."""
        return len(self.acceleration)

    def chosen(self, poses: NDArray[np.bool_]) -> "LinkHistory":
        """Return the history at the chosen poses (n,) alone."""
        return replace(
            self,
            pins={name: loads[poses] for name, loads in self.pins.items()},
            couples={name: torque[poses] for name, torque in self.couples.items()},
            ends={name: loads[poses] for name, loads in self.ends.items()},
            lines=tuple(replace(line, intensity=line.intensity[poses]) for line in self.lines),
            acceleration=self.acceleration[poses],
            places={name: x[poses] for name, x in self.places.items()},
        )

    def at(self, pose: int) -> LinkLoads:
        """Return the loads at one pose, for ``solve_solid``."""
        sx, sy, alpha, square = self.acceleration[pose]
        inert = BodyLoad(
            specific_force=np.array([sx, sy, 0.0]),
            about=np.zeros(3),
            angular_acceleration=float(alpha),
            angular_speed=float(np.sqrt(square)),
        )
        return LinkLoads(
            name=self.load_case,
            pins=tuple(
                PinLoad(
                    name=pin.name,
                    centre=np.array([self.places[pin.name][pose] if pin.slot else pin.x, pin.y, 0.0]),
                    diameter=pin.pin_diameter,
                    wrench=_wrench(self.pins[pin.name][pose]),
                    slotted=pin.slot > 0.0,
                )
                for pin in self.body.pins
            ),
            couples=tuple(DriveCouple(pin=pin, torque=float(t[pose])) for pin, t in self.couples.items()),
            ends=tuple(
                EndLoad(name=end.name, point=np.array([end.x, 0.0, 0.0]), wrench=_wrench(self.ends[end.name][pose]))
                for end in self.body.ends
                if end.name in self.ends
            ),
            bodies=(inert,) if self.mass is not None else (),
            lines=tuple(
                LineLoad(
                    first=line.first,
                    last=line.last,
                    intensity=np.column_stack([line.intensity[pose], np.zeros(2)]),
                )
                for line in self.lines
            ),
        )


def link_histories(moved: CaseMotion, link: str) -> tuple[LinkHistory, ...]:
    """Return the loads on a link with a part over the motion, one record per load case.

    Raises ``CannotRunError`` where the joint forces do not follow from equilibrium, ``CaseError`` for loads
    out of the linkage's plane.
    """
    case = moved.case
    if not moved.forces:
        raise CannotRunError(
            "envelope: the linkage is redundant, so its joint forces over a motion do not follow from equilibrium; "
            "remove redundant joints or links, or check single poses with alula check"
        )
    if case.joint_model != "pinned":
        raise CaseError(
            "joint_model: an envelope needs joints that turn, but they are bonded; choose pinned, or check single poses"
        )
    return tuple(_history(moved, link, name) for name in case.load_cases)


def _history(moved: CaseMotion, link: str, name: str) -> LinkHistory:
    case, solved, load_case = moved.case, moved.forces[name], moved.case.load_cases[name]
    body, count = case.body(link), len(moved.motion.angles)
    back = np.exp(-1j * solved.motion.angle(link))
    forces: dict[str, Complex] = {}
    moments: dict[str, Real] = {}

    def add(point: str, force: Complex, moment: Real) -> None:
        forces[point] = forces.get(point, np.zeros(count, dtype=complex)) + force
        moments[point] = moments.get(point, np.zeros(count)) + moment

    for point, force, moment in _joint_loads(solved, link):
        add(point, np.asarray(force * back), moment)
    lines = []
    for stated in stated_loads(case, load_case, {}):
        load = stated.load
        if load.link != link or isinstance(load, BodyForce):
            continue
        _in_plane(name, stated)
        turn = back if stated.axes == "global" else np.ones(count)
        if isinstance(load, PointLoad):
            add(load.point, np.asarray(complex(*load.wrench[:2]) * turn), np.full(count, load.wrench[5]))
        else:
            ends = [complex(*at[:2]) * turn for at in (load.at_start, load.at_end)]
            lines.append(LineHistory(first=load.start, last=load.end, intensity=_planar(np.stack(ends, axis=1))))
    acceleration = _acceleration(moved, link, name)
    if load_case.carried and (load_case.own_weight or with_inertia(case, name)):
        for mass in case.carried:
            if mass.link != link:
                continue
            points = case.links[link].points
            if isinstance(mass, CarriedSpread):
                first, last = sorted((points[mass.start][0], points[mass.end][0]))
                per_length = mass.mass / (last - first)
                ends = [per_length * _per_mass(acceleration, complex(x)) for x in (first, last)]
                lines.append(LineHistory(first=first, last=last, intensity=_planar(np.stack(ends, axis=1))))
                continue
            centroid = complex(*mass.place(points))
            force = np.asarray(mass.mass * _per_mass(acceleration, centroid))
            arm = centroid - complex(*points[mass.at])
            spin = mass.mass * mass.radius_of_gyration**2 * acceleration[:, 2]
            add(mass.at, force, (np.conj(arm) * force).imag - spin)
    loaded = {point: np.column_stack([_planar(forces[point]), moments[point]]) for point in forces}
    places = {pin.name: _places(solved, link, pin) for pin in body.pins if pin.slot > 0.0}
    for slot in places:
        # A pin free to slide and turn pushes across its slot alone; about its point there was the moment of its travel.
        loaded[slot][:, [0, 2]] = 0.0
    return LinkHistory(
        load_case=name,
        body=body,
        pins={pin.name: loaded.get(pin.name, np.zeros((count, 3))) for pin in body.pins},
        couples=_couples(solved, link),
        ends={end.name: loaded[end.name] for end in body.ends if end.name in loaded},
        lines=tuple(lines),
        acceleration=acceleration,
        mass=moved.masses.get(link) if np.any(acceleration) else None,
        places=places,
    )


def _places(solved: Kinetostatics, link: str, pin: Pin) -> Real:
    """The x (n,) at which a pin stands in its slot [mm]; ``CaseError`` where the slot ends before."""
    motion, linkage = solved.motion, solved.motion.linkage
    joint = next(name for name in linkage.joints_of(link) if linkage.point_of(name, link) == pin.name)
    other = linkage.joints[joint].links[1]
    point, (x, y) = next(iter(linkage.links[link].points.items()))
    arm = motion.position(other, linkage.point_of(joint, other)) - motion.position(link, point)
    along = np.exp(-1j * motion.angle(link)) * (arm[:, 0] + 1j * arm[:, 1]) + complex(x, y)
    return in_slot(pin, np.asarray(along.real), link)


def _joint_loads(solved: Kinetostatics, link: str) -> list[tuple[str, Complex, Real]]:
    """(point, force in global axes, moment about the point) of every joint on the link, at all poses."""
    motion, linkage = solved.motion, solved.motion.linkage
    found = []
    for name in linkage.joints_of(link):
        joint, point = linkage.joints[name], linkage.point_of(name, link)
        sign = 1.0 if joint.links[1] == link else -1.0
        force: Complex = np.asarray(sign * (solved.forces[name][:, 0] + 1j * solved.forces[name][:, 1]))
        moment = sign * solved.moments[name] if name in solved.moments else np.zeros(len(force))
        if joint.type != "revolute" and joint.links[0] == link:
            # The pin has travelled in its slot: its force acts off the point from which the slot is measured.
            pin = motion.position(joint.links[1], linkage.point_of(name, joint.links[1]))
            arm = pin - motion.position(link, point)
            moment = moment + ((arm[:, 0] - 1j * arm[:, 1]) * force).imag
        found.append((point, force, moment))
    return found


def _couples(solved: Kinetostatics, link: str) -> dict[str, Real]:
    drive, linkage = solved.drive, solved.motion.linkage
    if link not in linkage.joints[drive.joint].links:
        return {}
    sign = 1.0 if link == drive.link else -1.0
    return {linkage.point_of(drive.joint, link): sign * solved.torque}


def _acceleration(moved: CaseMotion, link: str, name: str) -> Real:
    """Gravity less acceleration of the frame's origin, angular acceleration and squared speed (n, 4), link axes."""
    motion, load_case = moved.forces[name].motion, moved.case.load_cases[name]
    found = np.zeros((len(motion.angles), 4))
    force = np.zeros(len(motion.angles), dtype=complex)
    if load_case.own_weight:
        force += complex(*gravity(load_case)[:2])
    if with_inertia(moved.case, name):
        point, place = next(iter(motion.linkage.links[link].points.items()))
        spin, rate = motion.angular_speed(link), motion.angular_acceleration(link)
        there = motion.linear_acceleration(link, point)
        arm = np.exp(1j * motion.angle(link)) * complex(*place)
        force -= there[:, 0] + 1j * there[:, 1] - (1j * rate - spin**2) * arm
        found[:, 2], found[:, 3] = rate, spin**2
    found[:, :2] = _planar(force * np.exp(-1j * motion.angle(link)))
    return found


def _per_mass(acceleration: Real, place: complex) -> Complex:
    """Force per mass (n,) at a place of the link's frame."""
    sx, sy, rate, square = acceleration.T
    return np.asarray(sx + 1j * sy + (square - 1j * rate) * place)


def _planar(values: Complex) -> Real:
    return np.stack([values.real, values.imag], axis=-1)


def _wrench(planar: Real) -> Real:
    return np.array([planar[0], planar[1], 0.0, 0.0, 0.0, planar[2]])


def _in_plane(name: str, stated: StatedLoad) -> None:
    load = stated.load
    assert not isinstance(load, BodyForce)
    across = load.wrench[2:5] if isinstance(load, PointLoad) else np.array([load.at_start[2], load.at_end[2]])
    if np.any(across != 0.0):
        raise CaseError(
            f"load_cases.{name}: a load on link '{load.link}' acts out of the linkage's plane, which an envelope over "
            "a motion does not follow; leave it out, or check single poses with alula check"
        )
