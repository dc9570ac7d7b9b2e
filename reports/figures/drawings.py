"""The drawing of the linkage in its pose with joint forces, loads and drive torque."""

import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from alula.fea.outcomes.result import CheckResult, SolidResult
from alula.geometry.linkage.placement import Placement, vector
from alula.loads.acting.load_line import ForceOnLine
from alula.loads.records.aero import shares
from alula.loads.records.applied import LineLoad, PointLoad, in_axes
from alula.loads.records.load_case import LoadLine
from alula.loads.states.actions import bounds, lasting, stated_loads
from alula.loads.statics.rounding import without_rounding
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.sheet.labels import along, place_labels
from alula.reports.figures.sheet.letters import extent
from alula.reports.figures.sheet.plot import Axes, ticks, widest
from alula.reports.figures.sheet.silhouette import curves, outlines, silhouette
from alula.reports.figures.sheet.style import GROUND, INK, JOINT_FORCE, LINK, LOAD, SPRING, TORQUE, WIDTH
from alula.reports.figures.sprung import mark_line
from alula.reports.words.numbers import number, turning

Real = NDArray[np.float64]

_ARROW = 0.2
"""Length of the largest force's arrow, as a share of the linkage's size."""
_RIGHT, _BELOW, _ABOVE = 7.0, 62.0, 7.0
"""Room about the drawing [points]."""
_LETTERS = 8.5
"""Size of labels [points]."""


def linkage_drawing(result: CheckResult, load_case: str) -> Canvas:
    """Draw the linkage to scale in its pose under a load case.

    Each joint force is drawn as it acts on the link in its label.

    Parameters
    ----------
    result : CheckResult
    load_case : str
        Name of the load case.

    Returns
    -------
    Canvas
    """
    return _Drawing(result, load_case).draw()


class _Line(NamedTuple):
    """A load line as it is drawn: both ends (2, 2) [mm], and what enters over levers from the first and the second."""

    ends: Real
    loads: tuple[PointLoad, ...]

    @classmethod
    def of(cls, line: LoadLine, place: Placement) -> "_Line":
        acting = ForceOnLine(line)
        return cls(np.array(acting.ends(place))[:, :2], acting.loads(place))


class _Drawing:
    """Positions and forces of one load case, and how to draw them."""

    def __init__(self, result: CheckResult, load_case: str) -> None:
        self.name = load_case
        self.result, self.pose, self.linkage = result, result.pose, result.pose.linkage
        self.reactions = without_rounding(result.load_cases[load_case].reactions)
        self.stated = result.case.load_cases[load_case]
        # The very loads that the statics had, turned as they are in this pose; the air's are told together below.
        without_air = self.stated.model_copy(update={"air": ()})
        stated = stated_loads(result.case, without_air)
        self.applied = [in_axes(load, "global", self.pose.placement) for load in stated]
        self.lines = [_Line.of(line, self.pose.placement) for line in self.stated.load_lines]
        self.points = {
            (link, point): self.pose.position(link, point)
            for link, record in self.linkage.links.items()
            for point in record.points
        }
        corners = np.array(list(self.points.values()))
        self.size = float(np.linalg.norm(np.ptp(corners, axis=0)))
        forces = [f for *_, f in (*self._joint_forces(), *self._loads())]
        self.largest = max((float(np.linalg.norm(f)) for f in forces), default=0.0)
        self.per_newton = _ARROW * self.size / self.largest if self.largest > 0.0 else 0.0
        tips = [at + f * self.per_newton for _, at, f in (*self._joint_forces(), *self._loads())]
        everything = np.vstack([corners, *[t[None] for t in tips], *[line.ends for line in self.lines]])
        low, high = everything.min(axis=0) - 0.11 * self.size, everything.max(axis=0) + 0.11 * self.size
        for link in self.linkage.links:
            if (nodes := self._nodes(link)) is not None:  # a part may reach far beyond its points
                low = np.minimum(low, nodes.min(axis=0) - 0.02 * self.size)
                high = np.maximum(high, nodes.max(axis=0) + 0.02 * self.size)
        self._lay_out(low, high)

    def _lay_out(self, low: Real, high: Real) -> None:
        """Choose sheet and scale, the same along x and y, for what lies between two corners."""
        left = 32.0 + widest(ticks(float(low[1]), float(high[1]), most=9))
        wide = 72.0 * WIDTH - left - _RIGHT
        tall = min(max(wide * (high - low)[1] / (high - low)[0], 187.0), 576.0)
        half = max((high - low) / (wide, tall)) * np.array([wide, tall]) / 2.0
        (x0, y0), (x1, y1) = (low + high) / 2.0 - half, (low + high) / 2.0 + half
        self.sheet = Canvas(72.0 * WIDTH, tall + _ABOVE + _BELOW)
        box = (left, _ABOVE, left + wide, _ABOVE + tall)
        self.axes = Axes(box=box, x=(float(x0), float(x1)), y=(float(y0), float(y1)))

    def _joint_forces(self) -> list[tuple[str, Real, Real]]:
        """(label, point, force) of every joint force that is not nil."""
        reactions = self.reactions.joints
        largest = max((r.magnitude for r in reactions.values()), default=0.0)
        return [
            (f"{name}: {number(r.magnitude, 3)} N\non {r.on}", self._joint(name), r.force[:2])
            for name, r in reactions.items()
            if r.magnitude > 1e-9 * largest
        ]

    def _joint(self, name: str) -> Real:
        joint = self.linkage.joints[name]
        return self.pose.position(joint.links[1], self.linkage.joint_points(name)[1])

    def _loads(self) -> list[tuple[str, Real, Real]]:
        """(label, point, force) of every load in the plane, as it acts in this pose."""
        found = []
        for load in self.applied:
            if isinstance(load, PointLoad):
                vector, at, how = load.wrench[:2], self.points[load.link, load.point], "on"
            elif isinstance(load, LineLoad):
                vector = load.force[:2]
                middle = 0.5 * (load.start + load.end)
                at = self.pose.origins[load.link] + middle * self.pose.rotation(load.link)[:, 0]
                how = "spread on"
            else:
                continue
            if np.any(vector):
                found.append((f"{number(float(np.linalg.norm(vector)), 3)} N\n{how} {load.link}", at, vector))
        for line in self.lines:
            for load, at in zip(line.loads, line.ends, strict=False):
                if np.any(vector := load.wrench[:2]):
                    whole = number(float(np.linalg.norm(load.wrench[:3])), 3)
                    found.append((f"{whole} N\non {load.link}", at, vector))
        points = self.result.case.link_points
        for air, forces in zip(self.stated.air, self.result.case.air_forces(self.name), strict=True):
            for patch, share in zip(air.spread, shares(air, points), strict=True):
                vector = share * forces.total[:2]
                if np.linalg.norm(vector) > 1e-9 * np.linalg.norm(forces.total):
                    ends = [self.points[patch.link, p] for p in (patch.at, patch.start, patch.end) if p is not None]
                    label = f"{number(float(np.linalg.norm(vector)), 3)} N\nof air on {patch.link}"
                    found.append((label, np.asarray(sum(ends) / len(ends)), vector))
        return found

    def draw(self) -> Canvas:
        """Draw everything; labels last, where there is room."""
        sheet, axes, at = self.sheet, self.axes, self.axes.at
        axes.scale_x(sheet, "x [mm]", grid=True)
        axes.scale_y(sheet, "y [mm]", label_at=12.0, grid=True)
        axes.frame(sheet)
        obstacles = [*self._links(), *self._joints()]
        labels: list[tuple[Real, str, str]] = []
        for text, line in self._springs():
            sheet.line(at(line), SPRING, 1.1)
            obstacles.append(np.vstack([along(a, b) for a, b in itertools.pairwise(line)]))
            labels.append((at(line), text, SPRING))
        for stated in self.lines:
            starts = zip(stated.ends, stated.loads, strict=False)
            levers = [((place, self.points[one.link, one.point]), 1.3, (1.2, 2.4)) for place, one in starts]
            for (one, other), width, dashes in (((stated.ends[0], stated.ends[1]), 0.9, (6.0, 3.0)), *levers):
                sheet.line(at(np.array([one, other])), LOAD, width, dashes)
                obstacles.append(along(one, other))
        arrows = [(*entry, JOINT_FORCE) for entry in self._joint_forces()]
        arrows += [(*entry, LOAD) for entry in self._loads()]
        for text, place, force, colour in arrows:
            tip = place + force * self.per_newton
            sheet.arrow(at(place), at(tip), colour)
            obstacles.append(along(place, tip))
            labels.append((at(tip[None]), text, colour))
        for place, middle, moment, radius, text, colour in self._moments():
            arc = self._arc(place, middle, moment, radius, colour)
            labels.append((at(arc[::6]), text, colour))
            obstacles.append(arc)
        names = [(at(place[None]), name, INK) for name, place in self.pose.points.items()]
        for link in dict.fromkeys((*self.linkage.moving, *self.result.case.checked_links)):
            pieces = [(self.points[link, a], self.points[link, b]) for a, b in self.linkage.links[link].pieces]
            a, b = max(pieces, key=lambda ab: float(np.linalg.norm(ab[1] - ab[0])))
            middles = np.array([0.5 * a + 0.5 * b, 0.7 * a + 0.3 * b, 0.3 * a + 0.7 * b])
            names.append((at(middles), f"link {link}", GROUND))
        place_labels(sheet, axes.box, [*names, *labels], at(np.vstack(obstacles)), size=_LETTERS)
        self._legend()
        return sheet

    def _links(self) -> list[Real]:
        """Draw the links; returns points of them."""
        thickness, found = 0.011 * self.size, []
        solid = {*self.linkage.moving, *self.result.case.checked_links}  # the ground is a line unless it has a part
        for link, record in self.linkage.links.items():
            if (seen := self._silhouette(link)) is not None:
                found.append(seen)
                continue
            for a, b in ((self.points[link, one], self.points[link, other]) for one, other in record.pieces):
                if np.linalg.norm(b - a) <= 1e-9 * self.size:
                    continue
                if link not in solid:
                    self._line([a, b], 0.8, dashes=(4.8, 3.2))
                else:
                    self._bar(a, b, thickness)
                normal = np.array([a[1] - b[1], b[0] - a[0]]) / np.linalg.norm(b - a)
                sides = (-1.0, 0.0, 1.0) if link in solid else (0.0,)
                found += [along(a + side * thickness * normal, b + side * thickness * normal) for side in sides]
        return found

    def _seen(self, link: str) -> SolidResult | None:
        """Return the solid as which a link is drawn: that of a part that is no uniform beam."""
        found, case = self.result.load_cases[self.name].links.get(link), self.result.case
        if not isinstance(found, SolidResult) or (case.part_of(link).is_beam and not case.body(link).cuts):
            return None
        return found

    def _nodes(self, link: str) -> Real | None:
        """Return the nodes (n, 2) of the solid as which a link is drawn [mm]."""
        if (found := self._seen(link)) is None:
            return None
        nodes, place = found.stress.space.nodes, self.pose.placement
        places = place.origin(link) + place.direction(link) * (nodes[:, 0] + 1j * nodes[:, 1])
        return np.column_stack([places.real, places.imag])

    def _silhouette(self, link: str) -> Real | None:
        """Draw a part that is no uniform beam as it is seen along its pins, where a solid tells; returns its points."""
        found, nodes = self._seen(link), self._nodes(link)
        if found is None or nodes is None:
            return None
        space, flat = found.stress.space, self.axes.at(nodes)
        triangles, edges = silhouette(space.nodes, space.boundary)
        for triangle in outlines(flat[triangles]):
            self.sheet.area(triangle, LINK, LINK, 0.3)
        for edge in curves(flat[edges]):
            self.sheet.line(edge, INK, 0.6)
        return nodes[np.unique(edges)[::5]]

    def _joints(self) -> list[Real]:
        """Draw the joints; returns points of them."""
        found, ground = [], self.linkage.ground
        if (held_at := self.linkage.links[ground].held_at) is not None:
            found.append(self._support((ground,), self.points[ground, held_at]))
        for name, joint in self.linkage.joints.items():
            at = self._joint(name)
            if joint.slides:
                found.append(self._guide(name, at))
            elif joint.clamped:
                found += self._clamps(name)
            elif ground in joint.links and held_at is None:
                found.append(self._support(joint.links, at))
            self.sheet.disc(self.axes.at(at), 2.75, INK if joint.fixed else "#ffffff", INK, 1.0)
            found.append(at[None])
        return found

    def _clamps(self, name: str) -> list[Real]:
        """Draw the jaws of a clamp beside each link that it holds, hatched on the ground; returns points of them."""
        joint, found = self.linkage.joints[name], []
        for link in (link for link in joint.links if len(self.linkage.links[link].points) > 1):
            if link == self.linkage.ground and link not in self.result.case.checked_links:
                continue
            point = self.linkage.point_of(name, link)
            at, others = self.points[link, point], [self.points[link, p] for p in self.linkage.links[link].points]
            way = max((other - at for other in others), key=lambda arm: float(np.linalg.norm(arm)))
            way = way / np.linalg.norm(way)
            length, side = joint.clamp_length or 0.04 * self.size, 0.02 * self.size * np.array([-way[1], way[0]])
            for sign in (-1.0, 1.0):
                start, end = at + sign * side, at + sign * side + length * way
                self._line([start, end], 1.6)
                found.append(along(start, end))
                if self.linkage.ground in joint.links:
                    step = 0.5 * sign * side - 0.008 * self.size * way
                    for share in np.linspace(0.1, 1.0, 6):
                        root = start + share * length * way
                        self._line([root, root + step], 0.7)
        return found

    def _springs(self) -> list[tuple[str, Real]]:
        """(label, line) of every spring and tendon, and of every stop."""
        case, place, found = self.result.load_cases[self.name].standing.case, self.pose.placement, []
        for one in (*lasting(case), *bounds(case).values()):
            for mark in one.marks(place):
                told = "slack"
                if mark.effort:
                    told = f"{number(abs(mark.effort), 3)} {'N·mm' if mark.turns else 'N'}"
                found.append(
                    (
                        mark.name if mark.kind == "wall" else f"{mark.name}: {told}",
                        mark_line(mark, self.pose, self.size),
                    )
                )
        return found

    def _line(self, points: list[Real], width: float, dashes: tuple[float, float] | None = None) -> None:
        self.sheet.line(self.axes.at(points), GROUND, width, dashes)

    def _bar(self, a: Real, b: Real, thickness: float) -> None:
        """Draw a bar with round ends about its points."""
        angle = math.atan2(b[1] - a[1], b[0] - a[0])
        turn = np.linspace(-0.5, 0.5, 37) * np.pi + angle
        end = thickness * np.column_stack([np.cos(turn), np.sin(turn)])
        self.sheet.area(self.axes.at(np.vstack([b + end, a - end])), LINK, INK, 0.6)

    def _support(self, links: tuple[str, ...], at: Real) -> Real:
        """Hatched support of the ground at a point, on the side where none of the links is; returns its points."""
        others = [
            self.points[link, point] - at
            for link in links
            for point in self.linkage.links[link].points
            if np.linalg.norm(self.points[link, point] - at) > 1e-9 * self.size
        ]
        away = [v / np.linalg.norm(v) for v in others]
        side = min(
            (np.array(d) for d in ((0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0))),
            key=lambda d: max((float(d @ v) for v in away), default=0.0),
        )
        across = np.array([-side[1], side[0]])
        depth, half = 0.034 * self.size, 0.024 * self.size
        base = at + side * depth
        triangle = np.array([at, base + across * half, base - across * half])
        self.sheet.area(self.axes.at(triangle), "#ffffff", GROUND, 0.9)
        self._line([base - across * 1.6 * half, base + across * 1.6 * half], 1.1)
        for step in np.linspace(-1.5, 1.5, 7):
            start = base + across * half * step
            self._line([start, start + (side * 0.6 - across * 0.4) * half], 0.7)
        rows = [(side * reach - across * 1.9 * half, side * reach + across * 1.6 * half) for reach in (0.0, 0.6 * half)]
        lines = [(at, end) for end in triangle[1:]] + [(base + start, base + end) for start, end in rows]
        return np.vstack([along(*line) for line in lines])

    def _guide(self, name: str, at: Real) -> Real:
        """Draw the two sides of the slot or guide that a pin or slider runs in; returns their points."""
        way = vector(self.pose.placement.along(name))[:2]
        side = 0.016 * self.size * np.array([-way[1], way[0]])
        reach = 0.09 * self.size * way
        edges = [along(at - reach + s, at + reach + s) for s in (-side, side)]
        for edge in edges:
            self._line([edge[0], edge[-1]], 1.1)
        return np.vstack(edges)

    def _moments(self) -> list[tuple[Real, float, float, float, str, str]]:
        """(place, direction of its middle, moment, radius, label, colour) of drive, clamps and stated moments."""
        found = []
        for name in (name for name, joint in self.linkage.joints.items() if joint.clamped):
            reaction = self.reactions.joints[name]
            if abs(moment := float(reaction.wrench[5])) > 1e-9 * self.size * reaction.magnitude:
                text = f"{name}: {number(abs(moment))} N·mm\n{turning(moment)} on {reaction.on}"
                angle = self.pose.angles.get(reaction.on, 0.0)
                found.append((self._joint(name), angle, moment, 0.065, text, JOINT_FORCE))
        drive, torque = self.reactions.drive, self.reactions.drive_torque
        if drive is not None and torque != 0.0 and not drive.idle:
            what = f"stop {drive.stop}: " if drive.stop else ""
            text = f"{what}{number(abs(torque))} N·mm\n{turning(torque)} on {drive.link}"
            found.append((self._joint(drive.joint), self.pose.angles[drive.link], torque, 0.075, text, TORQUE))
        for load in self.applied:
            if isinstance(load, PointLoad) and load.wrench[5] != 0.0:
                moment, angle = float(load.wrench[5]), self.pose.angles.get(load.link, 0.0)
                text = f"{number(abs(moment))} N·mm\n{turning(moment)} on {load.link}"
                found.append((self.points[load.link, load.point], angle, moment, 0.055, text, LOAD))
        return found

    def _arc(self, at: Real, middle: float, moment: float, radius: float, colour: str) -> Real:
        """Draw a moment as an arc about a point, clear of the link that points to its middle; returns its points."""
        sweep = np.linspace(-1.0, 1.0, 40) * math.radians(60.0) * math.copysign(1.0, moment) + middle
        arc = at + radius * self.size * np.column_stack([np.cos(sweep), np.sin(sweep)])
        self.sheet.line(self.axes.at(arc[:-4]), colour, 1.5)
        self.sheet.arrow(self.axes.at(arc[-5]), self.axes.at(arc[-1]), colour)
        return np.asarray(arc)

    def _legend(self) -> None:
        """Say below the drawing what the colours mean, with the scale of the arrows."""
        key = _round_down(self.largest)
        scale = f"; {number(key, 1)} N is {number(key * self.per_newton, 2)} mm long" if key > 0.0 else ""
        entries = [(JOINT_FORCE, f"joint force{scale}")]
        if self._loads() or any(colour == LOAD for *_, colour in self._moments()):
            entries.append((LOAD, "applied load" + ("; dashed: its line, dotted: rigid lever" if self.lines else "")))
        drive = self.reactions.drive
        if drive is not None and self.reactions.drive_torque != 0.0 and not drive.idle:
            entries.append((TORQUE, "moment of the stop" if drive.stop else "drive torque"))
        if self._springs():
            entries.append((SPRING, "springs and stops"))
        mark, gap, space = 19.0, 6.0, 16.0
        widths = [mark + gap + extent(text, _LETTERS)[0] for _, text in entries]
        x, y = (self.sheet.width - sum(widths) - space * (len(widths) - 1)) / 2.0, self.sheet.height - 12.0
        for (colour, text), wide in zip(entries, widths, strict=True):
            self.sheet.line([(x, y), (x + mark, y)], colour, 1.5)
            self.sheet.write(text, (x + mark + gap, y), anchor="left middle", size=_LETTERS)
            x += wide + space


def _round_down(value: float) -> float:
    """Largest 1, 2 or 5 times a power of ten that is not above a value."""
    if value <= 0.0:
        return 0.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= value * (1.0 + 1e-12))
