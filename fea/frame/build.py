"""Builds the frame of a linkage: nodes, beams, ties, guides and loads of all its links."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_beam import changes
from alula.fea.beam.flanks import Flanks, flanks_of
from alula.fea.common.reason import Reason, reason
from alula.fea.frame.condensed import CondensedLink, LinkFlexibility
from alula.fea.frame.linkage_frame import LinkageFrame, LinkBeam, out_of_plane
from alula.fea.frame.model import DOFS, Dof, FrameElement, FrameModel, Guide, NodeLoad, Support, Tie
from alula.fea.frame.spring import FrameSpring
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import patch_span
from alula.geometry.bodies.section import ring
from alula.geometry.joints.joint_kinds import ALL_WAYS, MOVES, TURNS, Way, Ways
from alula.geometry.linkage.placement import vector
from alula.geometry.linkage.pose import Pose
from alula.geometry.parts.part import Section
from alula.loads.case.case import Case
from alula.loads.case.forks import in_holes
from alula.loads.case.layers import Eye, pin_stretches
from alula.loads.records.applied import BodyForce, LineLoad, Load, PointLoad, in_axes, shifted
from alula.loads.records.conditions import at_temperature
from alula.loads.states.actions import lasting
from alula.loads.statics.statics import Drive

Real = NDArray[np.float64]
STIFF_IN_TWIST = 1e6
"""How many times its own twist stiffness the pin of the drive's joint, or of a bonded one, has between layers: the
torque goes from the one link to the other beside the pin."""
DOF_OF: Mapping[Way, Dof] = dict(zip(Way, DOFS, strict=True))
"""What the two links of a joint share in each way that is tied."""
TIED_TURNS = (frozenset(TURNS), frozenset((Way.ABOUT_ALONG, Way.ABOUT_ACROSS)))
"""All turns, or those but about the pin: of a node that is tied in others large displacements know no equations."""
ALONG_X = np.array([1.0, 0.0, 0.0])
ALONG_PINS = np.array([0.0, 0.0, 1.0])
RIGID = 1e3
"""How many times as stiff as the stiffest and shortest part a link without part is, however long, where displacements
are large and in vibration; in small displacements it does not give (``FrameElement.rigid``)."""
YIELDS_NOT = 3e3
"""How many times less a beam bends where a clamp holds it than all of it would, in large displacements, which puts the
tip of a cantilever 0.1 % too far; in small ones it does not give. Measured on a portal frame with clamps of 0.5 % to
45 % of its links: equilibrium is followed with 2e3 to 2e4, and with 1e5 no more."""
_SAME_PLACE = 1e-9


def build_frame(
    case: Case,
    pose: Pose,
    loads: Sequence[Load],
    *,
    held: Drive | None,
    bonded: bool = False,
    solids: Mapping[str, LinkFlexibility] | None = None,
    spatial: bool = False,
) -> LinkageFrame:
    """Build the frame of a case in a pose under loads.

    Parameters
    ----------
    case : Case
        The case.
    pose : Pose
        The linkage's pose.
    loads : sequence of Load
        That act on the links, global axes.
    held : Drive or None
        The drive that holds a link; None where nothing is driven.
    bonded : bool, optional
        True where all revolute joints are bonded; else those that the case says.
    solids : mapping of str to LinkFlexibility, optional
        Links whose solids tell how they give between their points; these are no beams.
    spatial : bool, optional
        True where it moves out of its plane although no load does so, and links do not lie in layers.

    Returns
    -------
    LinkageFrame
        Nodes, beams, ties, guides and loads.

    Raises
    ------
    CaseError
        For linkages without any part.
    """
    if not case.bending_links:
        raise CaseError(
            "links: no moving link has a part, so no stiffness is known, which bonded joints, redundant linkages and "
            "loads out of the plane need; give the links parts"
        )
    loads = tuple(in_axes(load, "global", pose.placement) for load in loads)
    joints = case.linkage.joints
    bonds = frozenset(name for name, joint in joints.items() if joint.fixed or (bonded and not joint.slides))
    spatial = spatial or case.layered or out_of_plane(loads)
    standing = frozenset(name for name in joints if spatial and name not in bonds and in_holes(case, name))
    builder = _Builder(case, pose, loads, solids or {}, standing)
    supports, ties, guides = builder.supports, [], []
    stiff = bonds if held is None else bonds | {held.joint}
    contacts = {name: builder.contact(name, twists=name not in stiff) for name in builder.stretches}
    places = np.array(builder.places)
    for name, joint in case.joints.items():
        ways = ALL_WAYS if name in bonds else joint.bears
        if held is not None and name == held.joint:
            ways |= joint.kind.driven
        tied = _tied(ways)
        dofs = frozenset(DOF_OF[way] for way in tied)
        first, second = contacts[name]
        if first is not None and second is not None:
            places[second] = places[first]
            ties += [Tie(nodes=(first, second), dofs=dofs)] if dofs else []
        else:
            supports += [Support(node=node, dofs=dofs) for node in (first, second) if node is not None and dofs]
        guides += [_guide(pose, name, way, contacts[name]) for way in Way if way in ways - tied]
    return LinkageFrame(
        pose=pose,
        held=held,
        bonded=bonds,
        loads=loads,
        model=FrameModel(
            nodes=places,
            elements=tuple(builder.elements),
            supports=tuple(supports),
            ties=tuple(ties),
            guides=tuple(guides),
            loads=tuple(builder.node_loads),
            names=tuple(builder.names),
            condensed=tuple(builder.condensed),
            springs=tuple(FrameSpring.of(one, pose, builder.points) for one in lasting(case)),
        ),
        points=builder.points,
        pins=builder.pins,
        pin_ends=builder.pin_ends,
        pin_beams=builder.pin_beams,
        pin_eyes=builder.pin_eyes,
        stations=builder.stations,
        arms=builder.arms,
        beams=builder.beams,
        notes=tuple(builder.notes),
    )


def _tied(ways: Ways) -> Ways:
    """Return which of the ways that a joint bears a tie holds, in global axes: what has no direction of its own."""
    moves, turns = ways & frozenset(MOVES), ways & frozenset(TURNS)
    return (moves if Way.ALONG in ways else frozenset()) | (turns if turns in TIED_TURNS else frozenset())


def _guide(pose: Pose, name: str, way: Way, nodes: tuple[int | None, int | None]) -> Guide:
    """Return what holds a joint in a way by itself: a plane for its pin, or one for an axis that turns with it."""
    planar = pose.placement.along(name)
    along, across = vector(planar), vector(1j * planar)
    normal = {Way.PIN: ALONG_PINS, Way.ABOUT_ACROSS: along}.get(way, across)
    axis = {Way.ABOUT_ALONG: ALONG_PINS, Way.ABOUT_ACROSS: ALONG_PINS, Way.ABOUT_PIN: along}.get(way)
    return Guide(carrier=nodes[0], pin=nodes[1], normal=normal, axis=axis)


class _Builder:
    """Nodes, beams and loads of all moving links."""

    def __init__(
        self,
        case: Case,
        pose: Pose,
        loads: Sequence[Load],
        solids: Mapping[str, LinkFlexibility],
        standing: frozenset[str],
    ) -> None:
        self.case, self.pose, self.standing = case, pose, standing
        self.condensed: list[CondensedLink] = []
        self.places: list[Real] = []
        self.names: list[str] = []
        self.elements: list[FrameElement] = []
        self.node_loads: list[NodeLoad] = []
        self.points: dict[tuple[str, str], int] = {}
        self.contacts: dict[tuple[str, str], int] = {}
        self.stations: dict[str, tuple[tuple[float, int], ...]] = {}
        self.arms: dict[int, Real] = {}
        self.beams: dict[int, LinkBeam] = {}
        self.notes: list[Reason] = []
        self.supports: list[Support] = []
        self.pin_ends: dict[str, int] = {}
        self.pin_beams: dict[str, int] = {}
        self.pin_eyes: dict[str, tuple[Eye, Eye]] = {}
        self.stretches = pin_stretches(case)
        self.slack = _SAME_PLACE * case.linkage.longest
        for link in case.linkage.moving:
            own = [load for load in loads if load.link == link]
            if link in solids:
                self._solid(link, own, solids[link])
            elif link in case.bending_links:
                self._beam(link, own)
            else:
                if solids and not self._contacts(link):
                    self._solid(link, own, LinkFlexibility.rigid(tuple(case.links[link].points)))
                else:
                    self._rigid(link, own)
                self.notes.append(reason("rigid_in_frame", link=link))
            for load in own:
                if isinstance(load, PointLoad):
                    lever = np.array([load.arm, load.wrench[:3]])
                    self.node_loads.append(
                        NodeLoad(node=self.points[link, load.point], wrench=load.wrench, lever=lever)
                    )
        self.pins = {name: (self._pin(name, 0), self._pin(name, 1)) for name in case.joints}

    def _pin(self, name: str, which: int) -> int | None:
        link = self.case.joints[name].links[which]
        if link == self.case.linkage.ground:
            return None
        known = self.contacts.get((link, name))
        return self.points[link, self.case.linkage.joint_points(name)[which]] if known is None else known

    def contact(self, name: str, *, twists: bool) -> tuple[int | None, int | None]:
        """Return the nodes that a joint brings together, and put its pin between them where its links lie apart.

        The pin is a beam from the mid-plane of the one link to that of the other, or from where that of a shorter joint
        ends (``alula.loads.case.layers.pin_stretches``). ``twists``: false of the pin of the drive's joint, and of a
        bonded one.
        """
        first, second = self.pins[name]
        linkage, joint = self.case.linkage, self.case.joints[name]
        if linkage.rise(name) == 0.0 and name not in self.standing:
            return first, second
        eye, opposite = self.pin_eyes[name] = self.stretches[name]
        link, root = next((x, node) for x, node in zip(joint.links, (first, second), strict=True) if x != opposite[0])
        up = linkage.heights.get(opposite[0], 0.0) - linkage.heights.get(eye[0], 0.0)
        if eye[0] != link:
            root = next(self.pin_ends[other] for other, (_, end) in self.pin_eyes.items() if end == eye)
        if root is None:
            root = self._node(link, *self.case.links[link].points[linkage.point_of(name, link)], name)
            self.supports.append(Support(node=root))
        self.places.append(self.places[root] + np.array([0.0, 0.0, up]))
        self.names.append(f"the pin at {name}")
        self.pin_ends[name] = end = len(self.places) - 1
        self.pin_beams[name] = len(self.elements)
        if linkage.rise(name) == 0.0 or joint.pin_diameter is None or not joint.kind.has_pin:
            self._stiff(root, end, z_axis=ALONG_X)
        else:
            material = at_temperature(self.case.all_materials[joint.pin_material], self.case.conditions)
            section = ring(joint.pin_diameter, 0.0)
            section = section if twists else replace(section, torsion=STIFF_IN_TWIST * section.torsion)
            young, poisson = material.youngs_modulus, material.poissons_ratio
            self.elements.append(
                FrameElement(nodes=(root, end), section=section, young=young, poisson=poisson, z_axis=ALONG_X)
            )
        return (first, end) if opposite[0] == joint.links[0] else (end, second)

    def _contacts(self, link: str) -> dict[str, tuple[float, float]]:
        """Joint -> place of its pin in the frame of a link that carries the slot."""
        found = {}
        for name, joint in self.case.joints.items():
            if joint.carrier == link:
                pin = self.pose.position(joint.links[1], self.case.linkage.joint_points(name)[1])
                x, y = self.pose.rotation(link).T @ (pin - self.pose.origins[link])
                found[name] = (float(x), float(y))
        return found

    def _place(self, link: str, x: float, y: float) -> Real:
        x, y = self.pose.origins[link] + self.pose.rotation(link) @ np.array([x, y])
        return np.array([x, y, self.case.linkage.heights.get(link, 0.0)])

    def _node(self, link: str, x: float, y: float, name: str) -> int:
        self.places.append(self._place(link, x, y))
        self.names.append(f"{name} of {link}")
        return len(self.places) - 1

    def _solid(self, link: str, loads: Sequence[Load], solid: LinkFlexibility) -> None:
        """Add a link that is condensed to its points; spread loads enter by their resultant at the first."""
        points = self.case.links[link].points
        nodes = [self._node(link, *points[name], name) for name in solid.places]
        self.points |= {(link, name): node for name, node in zip(solid.places, nodes, strict=True)}
        places = np.array([self.places[node] for node in nodes])
        arm = self._place(link, 0.0, 0.0) - places[0]
        resultants = [
            shifted(load.resultant(self.pose.placement), arm) for load in loads if not isinstance(load, PointLoad)
        ]
        turn = np.kron(np.eye(2 * len(nodes)), self.pose.placement.axes(link))
        flexibility, moved = turn @ solid.flexibility @ turn.T, turn @ solid.moved
        if resultants:
            whole = np.sum(resultants, axis=0)
            self.node_loads.append(NodeLoad(node=nodes[0], wrench=whole))
            moved = moved - flexibility[:, :6] @ whole
        link_between = CondensedLink(nodes=tuple(nodes), places=places, flexibility=flexibility, moved=moved)
        self.condensed.append(link_between)

    def _beam(self, link: str, loads: Sequence[Load]) -> None:
        record, contacts = self.case.links[link], self._contacts(link)
        points = {name: place for name, place in record.points.items() if name not in record.arms}
        wanted = [x for x, _ in (*points.values(), *contacts.values())]
        wanted += [x for load in loads if isinstance(load, LineLoad) for x in (load.start, load.end)]
        slots = flanks_of(self.case.body(link)) if record.slots else ()
        wanted += [x for slot in slots for x in (slot.first, slot.last)]
        body = self.case.body(link)
        clamps = [patch_span(body, end) for end in body.ends if end.clamped] if body.part.is_beam else []
        wanted += [x for clamp in clamps for x in clamp]
        changing = changes(body)
        wanted += [x for x in changing if min(wanted) < x < max(wanted)]
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
        material = self.case.material_of(link)
        section = body.part.frame_section(body)
        for (x0, a), (x1, b) in itertools.pairwise(stations):
            if not any(slot.first < (x0 + x1) / 2.0 < slot.last for slot in slots):
                here = body.section_at((x0 + x1) / 2.0) if changing else section
                held = any(low < (x0 + x1) / 2.0 < high for low, high in clamps)
                self._along(link, (x0, a), (x1, b), here, lines, held=held)
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
            young, poisson = record.count * material.youngs_modulus, material.poissons_ratio
            reach = float(np.linalg.norm(self.places[tip] - self.places[ends[0]]))
            self.beams[len(self.elements)] = LinkBeam(link=link, start=0.0, end=reach, arm=name)
            arm = body.part.arm_section
            self.elements.append(FrameElement(nodes=ends, section=arm, young=young, poisson=poisson))

    def _along(
        self,
        link: str,
        start: tuple[float, int],
        end: tuple[float, int],
        section: Section,
        lines: Sequence[LineLoad],
        across: Real | None = None,
        share: float = 1.0,
        *,
        held: bool = False,
    ) -> None:
        """Add a beam between two stations, ``across`` (3,) off the link's axis, under a share of its line loads.

        Where a clamp holds it, it does not give, and has its mass all the same.
        """
        (x0, a), (x1, b) = start, end
        first, last = _line_between(lines, x0, x1)
        aside = np.zeros(3) if across is None else across
        material = self.case.material_of(link)
        young = self.case.links[link].count * material.youngs_modulus  # twice the section of a pair
        stations = self.stations[link]
        # Stiffer by one factor for all, a short clamp would be too stiff for equilibrium to be followed.
        stiffer = max(YIELDS_NOT * (x1 - x0) / (stations[-1][0] - stations[0][0]), 1.0) if held else 1.0
        self.beams[len(self.elements)] = LinkBeam(link=link, start=x0, end=x1, flank=across is not None)
        self.elements.append(
            FrameElement(
                nodes=(a, b),
                section=section,
                young=stiffer * young,
                poisson=material.poissons_ratio,
                rigid=held,
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
        (centroid, height), place = load.mass.centroid, self.pose.placement
        slope = 6.0 * (centroid - middle) / length
        force = load.mass.mass * load.per_mass(vector(place.direction(link) * complex(centroid, height)))
        ends = [force / length * (1.0 + s * slope) for s in (-1.0, 1.0)]
        line = LineLoad(link=link, start=start, end=end, at_start=ends[0], at_end=ends[1])
        solid = [s for s in stations if not any(slot.first < s[0] < slot.last for slot in slots)]
        _, node = min(solid, key=lambda station: abs(station[0] - centroid))
        missing = load.resultant(place) - line.resultant(place)
        arm = self._place(link, 0.0, 0.0) - self.places[node]
        aside = place.axes(link) @ np.array([0.0, height, 0.0])
        self.node_loads.append(NodeLoad(node=node, wrench=shifted(missing, arm), lever=np.array([aside, force])))
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
                arm = self._place(link, 0.0, 0.0) - place
                wrench = shifted(load.resultant(self.pose.placement), arm)
                at = arm + self.pose.placement.axes(link) @ _acts_at(load)
                self.node_loads.append(NodeLoad(node=node, wrench=wrench, lever=np.array([at, wrench[:3]])))

    def _stiff(self, a: int, b: int, z_axis: Real = ALONG_PINS) -> None:
        """Add an element that does not give; between two nodes in one place, as a beam along the pins on arms."""
        links = self.case.bending_links
        young = max(self.case.material_of(link).youngs_modulus for link in links)
        sections = [self.case.part_of(link).section for link in links]
        size, apart = max(s.half_y for s in sections), float(np.linalg.norm(self.places[b] - self.places[a]))
        spans = [span for span in map(self.case.linkage.span, links) if span > 0.0]
        longer = max(apart / min(spans, default=apart or 1.0), 1.0)
        second = RIGID * longer**3 * max(max(s.i_y, s.i_z) for s in sections)
        section = Section(
            area=RIGID * longer * max(s.area for s in sections),
            i_y=second,
            i_z=second,
            torsion=2.0 * second,
            half_y=size,
            half_z=size,
            round=True,
        )
        self.elements.append(
            FrameElement(
                nodes=(a, b),
                section=section,
                young=young,
                poisson=0.3,
                z_axis=z_axis,
                rigid=True,
                offsets=np.outer((-0.5, 0.5), size * ALONG_PINS if apart == 0.0 else np.zeros(3)),
            )
        )


def _acts_at(load: BodyForce | LineLoad) -> Real:
    """Return where a spread load's force acts (3,), in the frame of its link."""
    if isinstance(load, BodyForce):
        return np.array([*load.mass.centroid, 0.0])
    size = float(load.force @ load.force)
    return ALONG_X * (float(load.first_moment @ load.force) / size if size > 0.0 else 0.0)


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
