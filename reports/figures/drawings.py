"""The drawing of the linkage in its pose with joint forces, loads and drive torque (matplotlib, PNG)."""

import io
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.outcomes.result import CheckResult
from loads.records.aero import shares
from loads.records.applied import LineLoad, PointLoad, in_axes
from loads.states.actions import stated_loads
from reports.figures.labels import along, place_labels
from reports.words.wording import number, turning

Real = NDArray[np.float64]

INK = "#1c2733"
LINK = "#9fb1c1"
GROUND = "#5d6b78"
JOINT_FORCE = "#c8460b"
LOAD = "#0067a8"
TORQUE = "#00795a"
DPI = 200
WIDTH = 7.4
"""Inches; fonts are in points, so this sets how large they read on the page."""
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.edgecolor": GROUND,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.linewidth": 0.6,
}
_ARROW = 0.2
"""Length of the largest force's arrow, as a share of the linkage's size."""


def as_png(figure: Any) -> bytes:
    """Return a matplotlib figure as PNG, without a date, so that equal drawings are equal bytes.

    Parameters
    ----------
    figure : object

    Returns
    -------
    bytes
    """
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None})
    return stream.getvalue()


def linkage_drawing(result: CheckResult, load_case: str) -> bytes:
    """Draw the linkage to scale in its pose under a load case.

    Each joint force is drawn as it acts on the link in its label.

    Parameters
    ----------
    result : CheckResult
    load_case : str
        Name of the load case.

    Returns
    -------
    bytes
        A PNG.
    """
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with rc_context(STYLE):
        sheet = _Sheet(result, load_case)
        low, high = sheet.extent
        right, bottom, top = 0.1, 0.85, 0.1  # inches
        digits = len(f"{np.abs([low[1], high[1]]).max():.0f}")
        left = 0.62 + 0.08 * max(digits - 3, 0)  # room for the numbers of the y axis
        wide = WIDTH - left - right
        tall = min(max(wide * (high - low)[1] / (high - low)[0], 2.6), 8.0)
        per_inch = max((high - low) / (wide, tall))
        middle, half = (low + high) / 2.0, per_inch * np.array([wide, tall]) / 2.0
        height = tall + bottom + top
        figure = Figure(figsize=(WIDTH, height), dpi=DPI)
        FigureCanvasAgg(figure)
        axes = figure.add_axes((left / WIDTH, bottom / height, wide / WIDTH, tall / height))
        axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
        axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
        axes.grid(color="#e8ecef", linewidth=0.5)
        axes.set_axisbelow(True)
        axes.set_xlabel("x [mm]")
        axes.set_ylabel("y [mm]")
        sheet.draw(axes)
        figure.legend(
            handles=sheet.legend(), loc="lower center", ncols=3, frameon=False, fontsize=8.5, handlelength=2.2
        )
        return as_png(figure)


class _Sheet:
    """Positions and forces of one load case, and how to draw them."""

    def __init__(self, result: CheckResult, load_case: str) -> None:
        self.name = load_case
        self.result, self.pose, self.linkage = result, result.pose, result.pose.linkage
        self.reactions = result.load_cases[load_case].reactions
        self.stated = result.case.load_cases[load_case]
        # The very loads that the statics had, turned as they are in this pose; the air's are told together below.
        without_air = self.stated.model_copy(update={"air": ()})
        stated = stated_loads(result.case, without_air)
        self.applied = [in_axes(load, "global", self.pose.placement) for load in stated]
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
        everything = np.vstack([corners, *[t[None] for t in tips]])
        margin = 0.11 * self.size
        self.extent = everything.min(axis=0) - margin, everything.max(axis=0) + margin

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
        points = self.result.case.link_points
        for air, forces in zip(self.stated.air, self.result.case.air_forces(self.name), strict=True):
            for patch, share in zip(air.spread, shares(air, points), strict=True):
                vector = share * forces.total[:2]
                if np.linalg.norm(vector) > 1e-9 * np.linalg.norm(forces.total):
                    ends = [self.points[patch.link, p] for p in (patch.at, patch.start, patch.end) if p is not None]
                    label = f"{number(float(np.linalg.norm(vector)), 3)} N\nof air on {patch.link}"
                    found.append((label, np.asarray(sum(ends) / len(ends)), vector))
        return found

    def draw(self, axes: Any) -> None:
        """Draw everything; labels last, where there is room."""
        thickness = 0.011 * self.size
        obstacles: list[Real] = []
        for link, record in self.linkage.links.items():
            for a, b in ((self.points[link, one], self.points[link, other]) for one, other in record.pieces):
                if np.linalg.norm(b - a) <= 1e-9 * self.size:
                    continue
                if link == self.linkage.ground:
                    axes.plot(*np.array([a, b]).T, color=GROUND, linewidth=0.8, linestyle=(0, (6, 4)), zorder=1)
                else:
                    self._bar(axes, a, b, thickness)
                normal = np.array([a[1] - b[1], b[0] - a[0]]) / np.linalg.norm(b - a)
                sides = (-1.0, 0.0, 1.0) if link != self.linkage.ground else (0.0,)
                obstacles += [along(a + side * thickness * normal, b + side * thickness * normal) for side in sides]
        for name, joint in self.linkage.joints.items():
            at = self._joint(name)
            if joint.type != "revolute":
                obstacles.append(self._guide(axes, name, at))
            elif self.linkage.ground in joint.links:
                obstacles.append(self._support(axes, name, at))
            axes.plot(*at, marker="o", markersize=5.5, markerfacecolor="white", markeredgecolor=INK, zorder=6)
            obstacles.append(at[None])
        labels: list[tuple[Real, str, str]] = []
        arrows = [(*entry, JOINT_FORCE) for entry in self._joint_forces()]
        arrows += [(*entry, LOAD) for entry in self._loads()]
        for text, at, force, colour in arrows:
            tip = at + force * self.per_newton
            self._arrow(axes, at, tip, colour)
            obstacles.append(along(at, tip))
            labels.append((tip[None], text, colour))
        for at, middle, moment, radius, text, colour in self._moments():
            arc = self._arc(axes, at, middle, moment, radius, colour)
            labels.append((arc[::6], text, colour))
            obstacles.append(arc)
        names = [(at[None], name, INK) for name, at in self.pose.points.items()]
        for link in self.linkage.moving:
            pieces = [(self.points[link, a], self.points[link, b]) for a, b in self.linkage.links[link].pieces]
            a, b = max(pieces, key=lambda ab: float(np.linalg.norm(ab[1] - ab[0])))
            names.append((np.array([0.5 * a + 0.5 * b, 0.7 * a + 0.3 * b, 0.3 * a + 0.7 * b]), f"link {link}", GROUND))
        place_labels(axes, [*names, *labels], np.vstack(obstacles), fontsize=8.5)

    @staticmethod
    def _bar(axes: Any, a: Real, b: Real, thickness: float) -> None:
        from matplotlib.patches import FancyBboxPatch
        from matplotlib.transforms import Affine2D

        length, angle = float(np.linalg.norm(b - a)), math.atan2(b[1] - a[1], b[0] - a[0])
        bar = FancyBboxPatch(
            (0.0, -thickness / 2.0),
            length,
            thickness,
            boxstyle=f"round,pad={thickness / 2.0},rounding_size={thickness}",
            facecolor=LINK,
            edgecolor=INK,
            linewidth=0.6,
            zorder=2,
        )
        bar.set_transform(Affine2D().rotate(angle).translate(*a) + axes.transData)
        axes.add_patch(bar)

    def _support(self, axes: Any, joint: str, at: Real) -> Real:
        """Hatched support of a joint to the ground, on the side where no link is; returns its points."""
        others = [
            self.points[link, point] - at
            for link in self.linkage.joints[joint].links
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
        axes.fill(*triangle.T, facecolor="white", edgecolor=GROUND, linewidth=0.9, zorder=3)
        axes.plot(*np.array([base - across * 1.6 * half, base + across * 1.6 * half]).T, color=GROUND, linewidth=1.1)
        for step in np.linspace(-1.5, 1.5, 7):
            start = base + across * half * step
            axes.plot(*np.array([start, start + (side * 0.6 - across * 0.4) * half]).T, color=GROUND, linewidth=0.7)
        return np.vstack([along(at, base + side * half), along(base - across * 1.6 * half, base + across * 1.6 * half)])

    def _guide(self, axes: Any, name: str, at: Real) -> Real:
        """Draw the two sides of the slot or guide that a pin or slider runs in; returns their points."""
        joint = self.linkage.joints[name]
        along_angle = self.pose.angles[joint.links[0]] + joint.direction
        way = np.array([math.cos(along_angle), math.sin(along_angle)])
        side = 0.016 * self.size * np.array([-way[1], way[0]])
        reach = 0.09 * self.size * way
        edges = [along(at - reach + s, at + reach + s) for s in (-side, side)]
        for edge in edges:
            axes.plot(*edge.T, color=GROUND, linewidth=1.1, zorder=5)
        return np.vstack(edges)

    @staticmethod
    def _arrow(axes: Any, start: Real, end: Real, colour: str) -> None:
        axes.annotate(
            "",
            xy=tuple(end),
            xytext=tuple(start),
            arrowprops={"arrowstyle": "-|>,head_length=0.55,head_width=0.22", "color": colour, "linewidth": 1.5,
                        "shrinkA": 0.0, "shrinkB": 0.0},
            zorder=7,
        )  # fmt: skip

    def _moments(self) -> list[tuple[Real, float, float, float, str, str]]:
        """(place, direction of its middle, moment, radius, label, colour) of the drive torque and of stated moments."""
        found = []
        drive, torque = self.reactions.drive, self.reactions.drive_torque
        if drive is not None and torque != 0.0:
            text = f"{number(abs(torque))} N·mm\n{turning(torque)} on {drive.link}"
            found.append((self._joint(drive.joint), self.pose.angles[drive.link], torque, 0.075, text, TORQUE))
        for load in self.applied:
            if isinstance(load, PointLoad) and load.wrench[5] != 0.0:
                moment, angle = float(load.wrench[5]), self.pose.angles.get(load.link, 0.0)
                text = f"{number(abs(moment))} N·mm\n{turning(moment)} on {load.link}"
                found.append((self.points[load.link, load.point], angle, moment, 0.055, text, LOAD))
        return found

    def _arc(self, axes: Any, at: Real, middle: float, moment: float, radius: float, colour: str) -> Real:
        """Draw a moment as an arc about a point, clear of the link that points to its middle; returns its points."""
        sweep = np.linspace(-1.0, 1.0, 40) * math.radians(60.0) * math.copysign(1.0, moment) + middle
        arc = at + radius * self.size * np.column_stack([np.cos(sweep), np.sin(sweep)])
        axes.plot(*arc[:-3].T, color=colour, linewidth=1.5, zorder=7)
        self._arrow(axes, arc[-5], arc[-1], colour)
        return np.asarray(arc)

    def legend(self) -> list[Any]:
        """Proxies for the legend, with the scale of the arrows."""
        from matplotlib.lines import Line2D

        key = _round_down(self.largest)
        scale = f"; {number(key, 1)} N is {number(key * self.per_newton, 2)} mm long" if key > 0.0 else ""
        handles = [Line2D([], [], color=JOINT_FORCE, linewidth=1.5, label=f"joint force{scale}")]
        if self._loads() or any(colour == LOAD for *_, colour in self._moments()):
            handles.append(Line2D([], [], color=LOAD, linewidth=1.5, label="applied load"))
        if self.reactions.drive is not None and self.reactions.drive_torque != 0.0:
            handles.append(Line2D([], [], color=TORQUE, linewidth=1.5, label="drive torque"))
        return handles


def _round_down(value: float) -> float:
    """Largest 1, 2 or 5 times a power of ten that is not above a value."""
    if value <= 0.0:
        return 0.0
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= value * (1.0 + 1e-12))
