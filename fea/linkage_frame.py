"""A linkage as a spatial frame: links as Timoshenko beams, pins that carry all moments but the one about themselves.

Every link with a part is a beam of its section along the x axis of its frame, at z = 0; a pin off the axis sits on
a rigid arm. Links without a part are rigid. The link that the drive holds keeps its angle to the other link at the
drive's joint, where the moment about z is the drive torque. In bonded linkages every pin carries all six components.
"""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.frame_model import ALL_DOFS, PIN_DOFS, FrameElement, FrameModel, NodeLoad, Support, Tie
from geometry.errors import CaseError
from geometry.part import Section
from geometry.pose import Pose
from loads.applied import BodyForce, LineLoad, Load, PointLoad, shifted
from loads.case import Case
from loads.statics import Drive, JointReaction, Reactions, assemble

Real = NDArray[np.float64]

RIGID = 1e3
"""How many times stiffer than the stiffest part a link without part is."""
_SAME_PLACE = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageFrame:
    """The frame of a linkage in one pose under one set of loads.

    held      the link that the drive holds, and where; None where nothing is driven
    bonded    True where pins carry moments about their own axis as well
    points    (link, point) -> node
    stations  link with a part -> (x in the link's frame, node) along its axis; the node may stand off the axis
    arms      node -> (3,) from it to its link's axis at that station, global axes [mm]; left out where zero
    notes     what the reader must know about this frame
    """

    pose: Pose
    held: Drive | None
    bonded: bool
    loads: tuple[Load, ...]
    model: FrameModel
    points: Mapping[tuple[str, str], int]
    stations: Mapping[str, tuple[tuple[float, int], ...]]
    arms: Mapping[int, Real]
    notes: tuple[str, ...]

    def reactions(self, joint_wrenches: Real, residual: float) -> Reactions:
        """Return joint reactions and drive torque from what all joints together do to each node (n, 6), global axes.

        The moment about z at the drive's joint is the drive torque, and not in the joint's wrench.
        """
        on_link = _joint_by_joint(self, joint_wrenches)
        torque = 0.0
        joints = {}
        for name, joint in self.pose.linkage.joints.items():
            wrench = on_link[name].copy()
            if self.held is not None and name == self.held.joint:
                torque = float(wrench[5]) * (1.0 if joint.links[1] == self.held.link else -1.0)
                wrench[5] = 0.0
            joints[name] = JointReaction(joint=name, on=joint.links[1], by=joint.links[0], wrench=wrench)
        system = assemble(self.pose, self.held, self.loads)
        value = {f"R{name}{axis}": joints[name].wrench[k] for name in joints for k, axis in enumerate("xy")}
        return Reactions(
            pose=self.pose,
            drive=self.held,
            system=system,
            unknowns=np.array([torque if column == "T" else value[column] for column in system.columns]),
            joints=joints,
            drive_torque=torque,
            residual=residual,
        )

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

    Raises ``CaseError`` for joints other than revolute ones and for linkages without any part.
    """
    for name, joint in case.joints.items():
        if joint.type != "revolute":
            raise CaseError(
                f"joints.{name}.type: it is '{joint.type}', but the frame that bonded joints, redundant linkages and "
                "loads out of the plane need knows revolute joints alone; make it revolute or leave those out"
            )
    if not case.checked_links:
        raise CaseError(
            "links: none has a part, so no stiffness is known, which bonded joints, redundant linkages and loads out "
            "of the plane need; give the links parts"
        )
    builder = _Builder(case, pose, loads)
    supports, ties = [], []
    for name, joint in case.joints.items():
        holds = bonded or (held is not None and name == held.joint)
        dofs = ALL_DOFS if holds else PIN_DOFS
        ends = [
            builder.points[link, point]
            for link, point in zip(joint.links, case.linkage.joint_points(name), strict=True)
            if link != case.linkage.ground
        ]
        if len(ends) == 1:
            supports.append(Support(node=ends[0], dofs=dofs))
        else:
            ties.append(Tie(nodes=(ends[0], ends[1]), dofs=dofs))
    places = np.array(builder.places)
    for tie in ties:
        places[tie.nodes[1]] = places[tie.nodes[0]]
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
            loads=tuple(builder.node_loads),
            names=tuple(builder.names),
        ),
        points=builder.points,
        stations=builder.stations,
        arms=builder.arms,
        notes=tuple(builder.notes),
    )


class _Builder:
    """Nodes, beams and loads of all moving links."""

    def __init__(self, case: Case, pose: Pose, loads: Sequence[Load]) -> None:
        self.case, self.pose = case, pose
        self.places: list[Real] = []
        self.names: list[str] = []
        self.elements: list[FrameElement] = []
        self.node_loads: list[NodeLoad] = []
        self.points: dict[tuple[str, str], int] = {}
        self.stations: dict[str, tuple[tuple[float, int], ...]] = {}
        self.arms: dict[int, Real] = {}
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

    def _place(self, link: str, x: float, y: float) -> Real:
        return np.array([*(self.pose.origins[link] + self.pose.rotation(link) @ np.array([x, y])), 0.0])

    def _node(self, link: str, x: float, y: float, name: str) -> int:
        self.places.append(self._place(link, x, y))
        self.names.append(f"{name} of {link}")
        return len(self.places) - 1

    def _beam(self, link: str, loads: Sequence[Load]) -> None:
        points = self.case.links[link].points
        wanted = [x for x, _ in points.values()]
        wanted += [x for load in loads if isinstance(load, LineLoad) for x in (load.start, load.end)]
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
            here = {name: y for name, (x_p, y) in points.items() if abs(x_p - x) <= self.slack}
            here = dict(sorted(here.items(), key=lambda item: abs(item[1])))
            first, y = next(iter(here.items()), (f"x = {x:g} mm", 0.0))
            node = self._node(link, x, y, first)
            if abs(y) > self.slack:
                self.arms[node] = self._place(link, x, 0.0) - self.places[node]
            stations.append((x, node))
            known = [(y, node)]
            for name, y_p in here.items():
                twin = next((n for y_n, n in known if abs(y_n - y_p) <= self.slack), None)
                if twin is None:
                    twin = self._node(link, x, y_p, name)
                    known.append((y_p, twin))
                    self._stiff(node, twin)
                self.points[link, name] = twin
        self.stations[link] = tuple(stations)
        lines = [load for load in loads if isinstance(load, LineLoad)]
        lines += [self._spread(link, load) for load in loads if isinstance(load, BodyForce)]
        material, section = self.case.material_of(link), self.case.part_of(link).section
        for (x0, a), (x1, b) in itertools.pairwise(stations):
            at_start, at_end = _line_between(lines, x0, x1)
            self.elements.append(
                FrameElement(
                    nodes=(a, b),
                    section=section,
                    young=material.youngs_modulus,
                    poisson=material.poissons_ratio,
                    offsets=np.array([self.arms.get(node, np.zeros(3)) for node in (a, b)]),
                    load_first=at_start,
                    load_last=at_end,
                )
            )

    def _spread(self, link: str, load: BodyForce) -> LineLoad:
        """Spread a body force along the beam; what the spread leaves out enters at the station next to the centroid."""
        stations = self.stations[link]
        start, end = stations[0][0], stations[-1][0]
        middle, length = (start + end) / 2.0, end - start
        slope = 6.0 * (load.centroid[0] - middle) / length
        ends = [load.mass / length * (1.0 + s * slope) * load.acceleration for s in (-1.0, 1.0)]
        line = LineLoad(link=link, start=start, end=end, at_start=ends[0], at_end=ends[1])
        _, node = min(stations, key=lambda station: abs(station[0] - load.centroid[0]))
        missing = load.resultant(self.pose) - line.resultant(self.pose)
        arm = np.array([*self.pose.origins[link], 0.0]) - self.places[node]
        self.node_loads.append(NodeLoad(node=node, wrench=shifted(missing, arm)))
        return line

    def _rigid(self, link: str, loads: Sequence[Load]) -> None:
        known: list[tuple[Real, int]] = []
        for name, (x, y) in self.case.links[link].points.items():
            place = self._place(link, x, y)
            node = next((n for p, n in known if np.linalg.norm(p - place) <= self.slack), None)
            if node is None:
                node = self._node(link, x, y, name)
                known.append((place, node))
                if len(known) > 1:
                    self._stiff(known[0][1], node)
            self.points[link, name] = node
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


def _joint_by_joint(frame: LinkageFrame, joint_wrenches: Real) -> dict[str, Real]:
    """What each joint does to its second link (6,), told apart where several joints share a node.

    A node with one joint gives that joint; taking it off the other link's node may leave one joint there, and so on.
    """
    linkage = frame.pose.linkage
    left = joint_wrenches.copy()
    ends = {
        name: {link: frame.points[link, linkage.point_of(name, link)] for link in joint.links if link != linkage.ground}
        for name, joint in linkage.joints.items()
    }
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
        found[name] = wrench if link == linkage.joints[name].links[1] else -wrench
        for other, other_node in ends[name].items():
            left[other_node] += -wrench if other == link else wrench
    return found
