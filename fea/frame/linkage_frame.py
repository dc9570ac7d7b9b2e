"""A linkage as a spatial frame: links as Timoshenko beams, pins that carry all moments but the one about themselves.

Every link with a part is a beam of its section along the x axis of its frame, at z = 0; a pin off the axis sits on
a rigid arm, or where the link states an arm to it, on a beam of the same section. Along a slot the two flanks are
beams of their own (``fea.beam.flanks``), of which the pin pushes one. Links without a part are rigid. The
link that the drive holds keeps its angle to the other link at the drive's joint, where the moment about z is the drive
torque; at a slider it keeps its place, and the force along the guide is the drive force. In bonded linkages every pin
of a revolute joint carries all six components; pins in slots and sliders slide as they do else.

A pin in a slot stands at a station of its own of the slotted link. It presses on the slot's flanks: they take a force
normal to the slot in the linkage's plane, and the moment about the slot of a pin that would tilt between them. It is
free to slide along the slot, which turns with that station, to turn about its own axis and, having no heads, to shift
along it and to tilt along the slot. A slider is free to slide, and carries all else.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.beam.flanks import Flanks, flanks_of
from fea.frame.model import ALL_DOFS, PIN_DOFS, Dof, FrameElement, FrameModel, Guide, NodeLoad, Support, Tie
from geometry.base.errors import CaseError
from geometry.linkage.pose import Pose
from geometry.parts.part import Section
from loads.case.case import Case
from loads.records.applied import BodyForce, LineLoad, Load, PointLoad, shifted
from loads.statics.statics import Drive, JointReaction, Reactions, assemble, travelled

Real = NDArray[np.float64]

TURNS: frozenset[Dof] = frozenset({"rx", "ry", "rz"})
JOINT_DOFS: Mapping[str, frozenset[Dof]] = {"revolute": PIN_DOFS, "pin-in-slot": frozenset(), "slider": TURNS}
"""What the two links of a joint share; guides add what slots hold."""
ALONG_PINS = np.array([0.0, 0.0, 1.0])
RIGID = 1e3
"""How many times stiffer than the stiffest part a link without part is."""
_SAME_PLACE = 1e-9


@dataclass(frozen=True, kw_only=True)
class LinkBeam:
    """Which part of a link an element of the frame is.

    start, end  x along the link's axis, or along its ``arm`` (the name of the point there) from the arm's foot [mm]
    flank       True for one flank of a slot
    """

    link: str
    start: float
    end: float
    arm: str = ""
    flank: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageFrame:
    """The frame of a linkage in one pose under one set of loads.

    held      the link that the drive holds, and where; None where nothing is driven
    bonded    True where pins carry moments about their own axis as well
    points    (link, point) -> node
    pins      joint -> nodes of its first and its second link, where the pin stands; None on the ground
    stations  link with a part -> (x in the link's frame, node) along its axis; the node may stand off the axis
    arms      node -> (3,) from it to its link's axis at that station, global axes [mm]; left out where zero
    beams     element -> which part of a link it is; rigid ones are left out
    notes     what the reader must know about this frame
    """

    pose: Pose
    held: Drive | None
    bonded: bool
    loads: tuple[Load, ...]
    model: FrameModel
    points: Mapping[tuple[str, str], int]
    pins: Mapping[str, tuple[int | None, int | None]]
    stations: Mapping[str, tuple[tuple[float, int], ...]]
    arms: Mapping[int, Real]
    beams: Mapping[int, LinkBeam]
    notes: tuple[str, ...]

    def reactions(self, joint_wrenches: Real, residual: float, displacements: Real | None = None) -> Reactions:
        """Return joint reactions and drive torque from what all joints together do to each node (n, 6), global axes.

        The moment about z at the drive's joint is the drive torque, and not in the joint's wrench.
        ``displacements`` (n, 3) are those of the nodes where equilibrium holds on the deformed shape [mm].
        """
        shape = np.zeros((len(self.model.nodes), 3)) if displacements is None else displacements
        on_link = _joint_by_joint(self, joint_wrenches, shape)
        torque = 0.0
        joints = {}
        for name, joint in self.pose.linkage.joints.items():
            wrench = on_link[name].copy()
            if self.held is not None and name == self.held.joint and not self.held.pushes(self.pose.linkage):
                torque = float(wrench[5]) * (1.0 if joint.links[1] == self.held.link else -1.0)
                wrench[5] = 0.0
            joints[name] = JointReaction(
                joint=name, on=joint.links[1], by=joint.links[0], wrench=wrench, arm=self._arm(name, shape)
            )
        system = assemble(self.pose, self.held, self.loads)
        value = {f"R{name}{axis}": joints[name].wrench[k] for name in joints for k, axis in enumerate("xy")}
        for name in joints:
            value[f"N{name}"] = float(slot_normal(self.pose, name) @ joints[name].wrench[:3])
            value[f"M:{name}"] = float(joints[name].wrench[5])
        push = 0.0
        if self.held is not None and self.held.pushes(self.pose.linkage):
            across = slot_normal(self.pose, self.held.joint)
            force = joints[self.held.joint].wrench
            push = self.held.sign(self.pose.linkage) * float(across[1] * force[0] - across[0] * force[1])
        value |= {"T": torque, "P": push}
        return Reactions(
            pose=self.pose,
            drive=self.held,
            system=system,
            unknowns=np.array([value[column] for column in system.columns]),
            joints=joints,
            drive_torque=torque,
            drive_force=push,
            residual=residual,
        )

    def _arm(self, name: str, shape: Real) -> Real:
        """From the point of a joint's first link to its pin (3,), with the nodes displaced by ``shape`` (n, 3)."""
        linkage, arm = self.pose.linkage, travelled(self.pose, name)
        if linkage.joints[name].type == "revolute":
            return arm
        first, second = linkage.joints[name].links
        if second != linkage.ground:
            arm = arm + shape[self.points[second, linkage.point_of(name, second)]]
        if first != linkage.ground:
            arm = arm - shape[self.points[first, linkage.point_of(name, first)]]
        return arm

    def at_points(self, displacements: Real) -> dict[tuple[str, str], Real]:
        """Displacement (3,) of every link's point [mm] from those of the nodes (n, 3 or more)."""
        return {key: np.asarray(displacements[node, :3]) for key, node in self.points.items()}


def out_of_plane(loads: Sequence[Load]) -> bool:
    """Return True if any load has a force along z or a moment about x or y."""
    for load in loads:
        if isinstance(load, PointLoad):
            found = load.wrench[2:5]
        elif isinstance(load, LineLoad):
            found = np.array([load.at_start[2], load.at_end[2]])
        else:
            found = load.acceleration[2:]
        if np.any(found != 0.0):
            return True
    return False


def build_frame(
    case: Case, pose: Pose, loads: Sequence[Load], *, held: Drive | None, bonded: bool = False
) -> LinkageFrame:
    """Build the frame of a case in a pose under loads in global axes.

    Raises ``CaseError`` for linkages without any part.
    """
    if not case.checked_links:
        raise CaseError(
            "links: none has a part, so no stiffness is known, which bonded joints, redundant linkages and loads out "
            "of the plane need; give the links parts"
        )
    builder = _Builder(case, pose, loads)
    supports, ties, guides = [], [], []
    places = np.array(builder.places)
    for name, joint in case.joints.items():
        held_here = held is not None and name == held.joint
        keeps = ALL_DOFS if joint.type == "slider" else TURNS
        fixed = bonded and joint.type == "revolute"
        dofs = ALL_DOFS if fixed else JOINT_DOFS[joint.type] | (keeps if held_here else frozenset())
        first, second = builder.pins[name]
        if first is not None and second is not None:
            places[second] = places[first]
            ties += [Tie(nodes=(first, second), dofs=dofs)] if dofs else []
        else:
            supports += [Support(node=node, dofs=dofs) for node in (first, second) if node is not None and dofs]
        if not {"ux", "uy"} <= dofs:
            across = slot_normal(pose, name)
            guides.append(Guide(carrier=first, pin=second, normal=across))
            if joint.type == "slider":
                guides.append(Guide(carrier=first, pin=second, normal=ALONG_PINS))
            elif not dofs:
                guides.append(Guide(carrier=first, pin=second, normal=across, axis=ALONG_PINS))
    return LinkageFrame(
        pose=pose,
        held=held,
        bonded=bonded,
        loads=tuple(loads),
        model=FrameModel(
            nodes=places,
            elements=tuple(builder.elements),
            supports=tuple(supports),
            ties=tuple(ties),
            guides=tuple(guides),
            loads=tuple(builder.node_loads),
            names=tuple(builder.names),
        ),
        points=builder.points,
        pins=builder.pins,
        stations=builder.stations,
        arms=builder.arms,
        beams=builder.beams,
        notes=tuple(builder.notes),
    )


def slot_normal(pose: Pose, name: str) -> Real:
    """Return the direction (3,) in the linkage's plane in which a joint's slot holds its pin."""
    joint = pose.linkage.joints[name]
    along = pose.angles[joint.links[0]] + joint.direction
    return np.array([-math.sin(along), math.cos(along), 0.0])


class _Builder:
    """Nodes, beams and loads of all moving links."""

    def __init__(self, case: Case, pose: Pose, loads: Sequence[Load]) -> None:
        self.case, self.pose = case, pose
        self.places: list[Real] = []
        self.names: list[str] = []
        self.elements: list[FrameElement] = []
        self.node_loads: list[NodeLoad] = []
        self.points: dict[tuple[str, str], int] = {}
        self.contacts: dict[tuple[str, str], int] = {}
        self.stations: dict[str, tuple[tuple[float, int], ...]] = {}
        self.arms: dict[int, Real] = {}
        self.beams: dict[int, LinkBeam] = {}
        self.notes: list[str] = []
        self.slack = _SAME_PLACE * case.linkage.longest
        for link in case.linkage.moving:
            own = [load for load in loads if load.link == link]
            if link in case.checked_links:
                self._beam(link, own)
            else:
                self._rigid(link, own)
                self.notes.append(f"link {link} has no part: the frame takes it as rigid")
            for load in own:
                if isinstance(load, PointLoad):
                    self.node_loads.append(NodeLoad(node=self.points[link, load.point], wrench=load.wrench))
        self.pins = {name: (self._pin(name, 0), self._pin(name, 1)) for name in case.joints}

    def _pin(self, name: str, which: int) -> int | None:
        link = self.case.joints[name].links[which]
        if link == self.case.linkage.ground:
            return None
        known = self.contacts.get((link, name))
        return self.points[link, self.case.linkage.joint_points(name)[which]] if known is None else known

    def _contacts(self, link: str) -> dict[str, tuple[float, float]]:
        """Joint -> place of its pin in the frame of a link that carries the slot."""
        found = {}
        for name, joint in self.case.joints.items():
            if joint.type != "revolute" and joint.links[0] == link:
                pin = self.pose.position(joint.links[1], self.case.linkage.joint_points(name)[1])
                x, y = self.pose.rotation(link).T @ (pin - self.pose.origins[link])
                found[name] = (float(x), float(y))
        return found

    def _place(self, link: str, x: float, y: float) -> Real:
        return np.array([*(self.pose.origins[link] + self.pose.rotation(link) @ np.array([x, y])), 0.0])

    def _node(self, link: str, x: float, y: float, name: str) -> int:
        self.places.append(self._place(link, x, y))
        self.names.append(f"{name} of {link}")
        return len(self.places) - 1

    def _beam(self, link: str, loads: Sequence[Load]) -> None:
        record, contacts = self.case.links[link], self._contacts(link)
        points = {name: place for name, place in record.points.items() if name not in record.arms}
        wanted = [x for x, _ in (*points.values(), *contacts.values())]
        wanted += [x for load in loads if isinstance(load, LineLoad) for x in (load.start, load.end)]
        slots = flanks_of(self.case.body(link)) if record.slots else ()
        wanted += [x for slot in slots for x in (slot.first, slot.last)]
        xs: list[float] = []
        for x in sorted(wanted):
            if not xs or x - xs[-1] > self.slack:
                xs.append(x)
        if len(xs) < 2:
            raise CaseError(
                f"links.{link}: all of its points lie at one station of its axis, so it is no beam; place its x axis "
                "along the link"
            )
        stations = []
        for x in xs:
            places = [
                (abs(y), name, y, self.points if group is points else self.contacts)
                for group in (points, contacts)
                for name, (x_p, y) in group.items()
                if abs(x_p - x) <= self.slack
            ]
            places.sort(key=lambda place: place[0])
            _, first, y, _ = places[0] if places else (0.0, f"x = {x:g} mm", 0.0, self.points)
            node = self._node(link, x, y, first)
            if abs(y) > self.slack:
                self.arms[node] = self._place(link, x, 0.0) - self.places[node]
            stations.append((x, node))
            known = [(y, node)]
            for _, name, y_p, found in places:
                twin = next((n for y_n, n in known if abs(y_n - y_p) <= self.slack), None)
                if twin is None:
                    twin = self._node(link, x, y_p, name)
                    known.append((y_p, twin))
                    self._stiff(node, twin)
                found[link, name] = twin
        self.stations[link] = tuple(stations)
        lines = [load for load in loads if isinstance(load, LineLoad)]
        lines += [self._spread(link, load, slots) for load in loads if isinstance(load, BodyForce)]
        material, section = self.case.material_of(link), self.case.part_of(link).section
        for (x0, a), (x1, b) in itertools.pairwise(stations):
            if not any(slot.first < (x0 + x1) / 2.0 < slot.last for slot in slots):
                self._along(link, (x0, a), (x1, b), section, lines)
        for slot in slots:
            own = [s for s in stations if slot.first - self.slack <= s[0] <= slot.last + self.slack]
            inner = [(x, self._node(link, x, 0.0, f"x = {x:g} mm of the slot's other flank")) for x, _ in own[1:-1]]
            for chain, side in ((own, 0.5), ([own[0], *inner, own[-1]], -0.5)):
                across = self._place(link, 0.0, side * slot.apart) - self._place(link, 0.0, 0.0)
                for start, end in itertools.pairwise(chain):
                    self._along(link, start, end, slot.one, lines, across, 0.5)
        for name, foot in record.arms.items():
            tip = self.points[link, name] = self._node(link, *record.points[name], name)
            ends = (self.points[link, foot], tip)
            young, poisson = material.youngs_modulus, material.poissons_ratio
            reach = float(np.linalg.norm(self.places[tip] - self.places[ends[0]]))
            self.beams[len(self.elements)] = LinkBeam(link=link, start=0.0, end=reach, arm=name)
            self.elements.append(FrameElement(nodes=ends, section=section, young=young, poisson=poisson))

    def _along(
        self,
        link: str,
        start: tuple[float, int],
        end: tuple[float, int],
        section: Section,
        lines: Sequence[LineLoad],
        across: Real | None = None,
        share: float = 1.0,
    ) -> None:
        """Add a beam between two stations, ``across`` (3,) off the link's axis, under a share of its line loads."""
        (x0, a), (x1, b) = start, end
        first, last = _line_between(lines, x0, x1)
        aside = np.zeros(3) if across is None else across
        material = self.case.material_of(link)
        self.beams[len(self.elements)] = LinkBeam(link=link, start=x0, end=x1, flank=across is not None)
        self.elements.append(
            FrameElement(
                nodes=(a, b),
                section=section,
                young=material.youngs_modulus,
                poisson=material.poissons_ratio,
                offsets=np.array([self.arms.get(node, np.zeros(3)) + aside for node in (a, b)]),
                load_first=share * first,
                load_last=share * last,
            )
        )

    def _spread(self, link: str, load: BodyForce, slots: Sequence[Flanks]) -> LineLoad:
        """Spread a body force along the beam; what the spread leaves out enters at the station next to the centroid.

        Not at one inside a slot, where it would bend one flank.
        """
        stations = self.stations[link]
        start, end = stations[0][0], stations[-1][0]
        middle, length = (start + end) / 2.0, end - start
        slope = 6.0 * (load.centroid[0] - middle) / length
        ends = [load.mass / length * (1.0 + s * slope) * load.acceleration for s in (-1.0, 1.0)]
        line = LineLoad(link=link, start=start, end=end, at_start=ends[0], at_end=ends[1])
        solid = [s for s in stations if not any(slot.first < s[0] < slot.last for slot in slots)]
        _, node = min(solid, key=lambda station: abs(station[0] - load.centroid[0]))
        missing = load.resultant(self.pose) - line.resultant(self.pose)
        arm = np.array([*self.pose.origins[link], 0.0]) - self.places[node]
        self.node_loads.append(NodeLoad(node=node, wrench=shifted(missing, arm)))
        return line

    def _rigid(self, link: str, loads: Sequence[Load]) -> None:
        known: list[tuple[Real, int]] = []
        named = [(self.points, name, at) for name, at in self.case.links[link].points.items()]
        named += [(self.contacts, name, at) for name, at in self._contacts(link).items()]
        for found, name, (x, y) in named:
            place = self._place(link, x, y)
            node = next((n for p, n in known if np.linalg.norm(p - place) <= self.slack), None)
            if node is None:
                node = self._node(link, x, y, name)
                known.append((place, node))
                if len(known) > 1:
                    self._stiff(known[0][1], node)
            found[link, name] = node
        place, node = known[0]
        for load in loads:
            if not isinstance(load, PointLoad):
                arm = np.array([*self.pose.origins[link], 0.0]) - place
                self.node_loads.append(NodeLoad(node=node, wrench=shifted(load.resultant(self.pose), arm)))

    def _stiff(self, a: int, b: int) -> None:
        links = self.case.checked_links
        young = max(self.case.material_of(link).youngs_modulus for link in links)
        sections = [self.case.part_of(link).section for link in links]
        second = RIGID * max(max(s.i_y, s.i_z) for s in sections)
        size = max(s.half_y for s in sections)
        section = Section(
            area=RIGID * max(s.area for s in sections),
            i_y=second,
            i_z=second,
            torsion=2.0 * second,
            half_y=size,
            half_z=size,
            round=True,
        )
        self.elements.append(FrameElement(nodes=(a, b), section=section, young=young, poisson=0.3))


def _line_between(lines: Sequence[LineLoad], x0: float, x1: float) -> tuple[Real, Real]:
    """Force per length (3,) just after x0 and just before x1 of all line loads, global axes; none ends in between."""
    first, last = np.zeros(3), np.zeros(3)
    middle = (x0 + x1) / 2.0
    for line in lines:
        if line.start < middle < line.end:
            slope = (line.at_end - line.at_start) / (line.end - line.start)
            first = first + line.at_start + slope * (x0 - line.start)
            last = last + line.at_start + slope * (x1 - line.start)
    return first, last


def _joint_by_joint(frame: LinkageFrame, joint_wrenches: Real, shape: Real) -> dict[str, Real]:
    """What each joint does to its second link (6,), told apart where several joints share a node.

    A node with one joint gives that joint; taking it off the other link's node may leave one joint there, and so on.
    Where a pin has slid in its slot by what the nodes are displaced (``shape``), its force is moved along.
    """
    linkage = frame.pose.linkage
    left = joint_wrenches.copy()
    ends = {
        name: {link: node for link, node in zip(linkage.joints[name].links, nodes, strict=True) if node is not None}
        for name, nodes in frame.pins.items()
    }

    def moved(wrench: Real, start: int | None, end: int | None) -> Real:
        away = [np.zeros(3) if node is None else shape[node] for node in (start, end)]
        return shifted(wrench, away[0] - away[1])

    found: dict[str, Real] = {}
    while len(found) < len(ends):
        open_at: dict[int, list[tuple[str, str]]] = {}
        for name, nodes in ends.items():
            for link, node in nodes.items() if name not in found else ():
                open_at.setdefault(node, []).append((name, link))
        single = next((at for at in open_at.items() if len(at[1]) == 1), None)
        if single is None:
            names = sorted({name for at in open_at.values() for name, _ in at})
            raise CaseError(
                f"joints: {', '.join(names)} join the same links at one pin in a ring, so their forces cannot be told "
                "apart; remove one of them"
            )
        node, [(name, link)] = single
        wrench = left[node].copy()
        first, second = frame.pins[name]
        found[name] = wrench if link == linkage.joints[name].links[1] else moved(-wrench, first, second)
        for other, other_node in ends[name].items():
            left[other_node] += -wrench if other == link else moved(wrench, node, other_node)
    return found
