"""Figures of a motion, drawn without a display: link directions, joint paths, drive torque, joint forces."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from alula.fea.findings.joint_paths import loosest, moving_points
from alula.fea.findings.of_motion import PlayOverMotion
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import Motion
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.instant_centre import InstantCentre

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8c6d00", "#56b4e9", "#444444", "#e69f00")
"""Okabe and Ito's colours, told apart by the colour-blind; two of them darkened for lines on white."""
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.5)), (0, (1.5, 1)))
DPI = 130
_SIZE = (8.0, 4.8)
_POSES = 5
_STRAY = 20
"""Of how many directions one is drawn where play shades a path."""
_FAR = 10.0
"""Points of a path that are so many times the longest link away are left out of a picture; load lines are so long."""
_CLIP, _HEADROOM = 4.0, 1.6
"""Beside a dead point of the drive the axis ends at these multiples of the median and of the ends' values."""


def angles_figure(result: CaseMotion) -> Figure:
    """Draw the direction of every moving link over the coordinate.

    Parameters
    ----------
    result : CaseMotion

    Returns
    -------
    Figure
    """
    motion = result.motion
    figure, [axes] = over_angle(motion, ["direction of the link [deg]"])
    for i, link in enumerate(motion.linkage.moving):
        _line(axes, motion, np.degrees(motion.angle(link)), link, i)
    _dead_points(axes, result)
    legend(axes, "link")
    return figure


def torque_figure(result: CaseMotion, play: PlayOverMotion | None = None) -> Figure:
    """Draw drive torque or force over the coordinate, one line per load case, and dashed what it is without friction.

    A shaded band tells what play of pins makes of it.

    Parameters
    ----------
    result : CaseMotion
    play : PlayOverMotion, optional

    Returns
    -------
    Figure
    """
    motion = result.motion
    figure, [axes] = over_angle(motion, [f"drive {result.effort.word} on {result.drive.link} [{result.effort.unit}]"])
    for i, (load_case, torque) in enumerate(result.torque.items()):
        _line(axes, motion, _broken(result, torque), load_case, i)
    _with_play(axes, result, play)
    _without_friction(axes, result)
    axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    _clip(axes, result, list(result.torque.values()), symmetric=True)
    _dead_points(axes, result)
    _locked(axes, result)
    legend(axes, "load case")
    return figure


def _with_play(axes: Any, result: CaseMotion, play: PlayOverMotion | None) -> None:
    """Shade between the ends of the drive torque with play, and where it has none."""
    if play is None:
        return
    at = result.motion.progress
    for i, load_case in enumerate(result.torque):
        ends = [np.where(np.isfinite(end), _broken(result, end), np.nan) for end in play.effort[load_case]]
        label = f"{load_case} with play of pins" if len(result.torque) > 1 else "with play of pins"
        axes.fill_between(
            at, *ends, color=COLOURS[i % len(COLOURS)], alpha=0.25, linewidth=0.0, label=label, zorder=1.5
        )
    if play.passes.any():
        style: dict[str, Any] = {"hatch": "xxx", "edgecolor": "0.75", "label": "no end: play may reach a dead point"}
        inside = axes.get_xaxis_transform()
        axes.fill_between(
            at, 0, 1, where=play.passes, transform=inside, facecolor="0.95", linewidth=0, zorder=0.5, **style
        )


def _without_friction(axes: Any, result: CaseMotion) -> None:
    """Draw the drive torque without friction, one dashed line for both directions of a load case."""
    drawn: list[Real] = []
    for load_case, torque in result.frictionless.items():
        if not any(np.array_equal(torque, other, equal_nan=True) for other in drawn):
            stated = load_case.removesuffix(f" {result.rubbing[load_case].way}")
            label = f"{stated} without friction"
            values, style = _broken(result, torque), {"color": "0.45", "linestyle": DASHES[1 + len(drawn) % 2]}
            axes.plot(result.motion.progress, values, label=label, linewidth=1.3, **style)
            drawn.append(torque)


def _locked(axes: Any, result: CaseMotion) -> None:
    """Shade where friction locks the linkage."""
    for way in dict.fromkeys(rubbing.way for rubbing in result.rubbing.values()):
        spans = {span for rubbing in result.rubbing.values() if rubbing.way == way for span in rubbing.spans}
        for i, span in enumerate(sorted(spans)):
            label = f"locked, {way}" if i == 0 else None
            style: dict[str, Any] = {"hatch": "///" if way == "forward" else "\\\\\\", "edgecolor": "0.6"}
            axes.axvspan(*span, facecolor="0.92", linewidth=0.0, label=label, zorder=0.5, **style)


def forces_figure(result: CaseMotion, load_case: str) -> Figure:
    """Draw the magnitude of every joint force over the coordinate.

    Parameters
    ----------
    result : CaseMotion
    load_case : str
        Name of the load case.

    Returns
    -------
    Figure
    """
    motion, forces = result.motion, result.forces[load_case].forces
    figure, [axes] = over_angle(motion, ["joint force [N]"])
    sizes = {joint: np.linalg.norm(force, axis=1) for joint, force in forces.items()}
    for i, joints in enumerate(_equal(sizes)):
        _line(axes, motion, _broken(result, sizes[joints[0]]), ", ".join(joints), i)
    axes.set_ylim(bottom=0.0)
    _clip(axes, result, list(sizes.values()), symmetric=False)
    axes.set_title(f"load case {load_case}", parse_math=False, loc="left", fontsize=10)
    _dead_points(axes, result)
    legend(axes, "joint")
    return figure


def paths_figure(motion: Motion, play: PlayOverMotion | None = None) -> Figure:
    """Draw the paths of the moving points and the linkage at a few poses, from light to dark.

    With play of pins the paths are shaded as wide as it lets their points stray with the drive held.

    Parameters
    ----------
    motion : Motion
    play : PlayOverMotion, optional

    Returns
    -------
    Figure
    """
    figure, axes = plane(motion, width=8.0)
    indices = np.unique(np.linspace(0, len(motion.angles) - 1, _POSES).round().astype(int))
    if motion.returns:
        indices = np.unique(np.linspace(0, len(motion.angles) - 1, _POSES + 1).round().astype(int))[:-1]
    for i, (label, xy) in enumerate(moving_points(motion).items()):
        style = {"color": COLOURS[i % len(COLOURS)], "linestyle": DASHES[i // len(COLOURS) % len(DASHES)]}
        if play is not None:
            label += _stray(axes, motion, play, label, COLOURS[i % len(COLOURS)])
        axes.plot(*xy.T, linewidth=1.6 if play is None else 0.7, label=label, zorder=2, **style)
    for index, shade in zip(indices, np.linspace(0.78, 0.0, len(indices)), strict=True):
        colour = str(shade)
        for chain in chains(motion.linkage):
            xy = np.array([motion.position(link, point)[index] for link, point in chain])
            axes.plot(*xy.T, color=colour, linewidth=1.4, marker="o", markersize=3.5, markerfacecolor="white", zorder=3)
    ground(axes, motion)
    first, last = (f"{motion.progress[i]:.5g} {motion.progress_unit}" for i in (0, indices[-1]))
    what = motion.coordinate if motion.instants is None else "cycle"
    axes.set_title(
        f"{what} from {first} (light) to {last} (black)",
        parse_math=False,
        loc="left",
        fontsize=10,
    )
    legend(axes, "path of" if play is None else "path of, with play")
    return figure


def _stray(axes: Any, motion: Motion, play: PlayOverMotion, label: str, colour: str) -> str:
    """Shade where play lets the point of a path be, from pose to pose, and tell how far that is at the most."""
    from shapely import MultiPoint, unary_union

    link, point = loosest(motion, play, label)
    outline = play.points[link, point].outline[:, ::_STRAY] + motion.placement.position(link, point)[:, None]
    rings = [np.column_stack([ring.real, ring.imag]) for ring in np.where(play.passes[:, None], np.nan, outline)]
    pairs = (np.vstack(pair) for pair in pairwise(rings))
    area = unary_union([MultiPoint(pair).convex_hull for pair in pairs if np.isfinite(pair).all()])
    for part in getattr(area, "geoms", [area]):
        curves = [np.array(ring.coords) for ring in (part.exterior, *part.interiors)] if part.area > 0.0 else []
        if curves:
            path = Path.make_compound_path(*(Path(curve, closed=True) for curve in curves))
            axes.add_patch(PathPatch(path, facecolor=colour, alpha=0.45, linewidth=0.0, zorder=1.8))
    most, _ = play.points[link, point].farthest
    return f" ± {most:.2g} mm" if np.isfinite(most) else ""


def centre_figure(centre: InstantCentre, motion: Motion) -> Figure:
    """Draw the path of an instant centre, and the linkage with its load lines at the first pose (black) and the last.

    Over a cycle, which may end as it begins, at the least and the largest value of its coordinate.

    Parameters
    ----------
    centre : InstantCentre
    motion : Motion

    Returns
    -------
    Figure
    """
    figure, axes = plane(motion, width=8.0, beside=centre.path)
    path = centre.path[np.argsort(motion.angles, kind="stable")]
    axes.plot(path.real, path.imag, color="black", linewidth=1.6, label="instant centre")
    size = motion.linkage.longest * _FAR
    first, last = (0, -1) if motion.instants is None else (motion.angles.argmin(), motion.angles.argmax())
    for index, colour in ((last, "0.75"), (first, "black")):
        for chain in chains(motion.linkage):
            xy = np.array([motion.position(link, point)[index] for link, point in chain])
            axes.plot(*xy.T, color=colour, linewidth=1.4, marker="o", markersize=3.5, markerfacecolor="white", zorder=3)
        axes.plot(centre.path.real[index], centre.path.imag[index], "o", color=colour, markersize=7, zorder=4)
        for i, (name, line) in enumerate(centre.lines.items()):
            ends = line.foot[index] + size * line.along[index] * np.array([-1.0, 1.0])
            style = {"linestyle": DASHES[1], "alpha": 1.0 if index == first else 0.35, "zorder": 2}
            label = f"load line of {name}" if index == first else None
            axes.plot(ends.real, ends.imag, color=COLOURS[i % len(COLOURS)], linewidth=1.3, label=label, **style)
    ground(axes, motion)
    legend(axes, f"{centre.link} against {centre.against}")
    return figure


def ahead_figure(centre: InstantCentre, motion: Motion) -> Figure:
    """Draw how far ahead of an instant centre the load lines run, over the coordinate.

    Parameters
    ----------
    centre : InstantCentre
    motion : Motion

    Returns
    -------
    Figure
    """
    figure, [axes] = over_angle(motion, ["load line ahead of the centre [mm]"])
    for i, (name, line) in enumerate(centre.lines.items()):
        _line(axes, motion, line.ahead, name, i)
    axes.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    legend(axes, "load case")
    return figure


def plane(motion: Motion, *, width: float, beside: Complex | None = None) -> tuple[Figure, Any]:
    """Return a figure and axes that contain the whole motion to scale [mm].

    Parameters
    ----------
    motion : Motion
    width : float
        Of the figure [inches].
    beside : complex array, optional
        Other points that it contains, where they are not far off.

    Returns
    -------
    tuple
    """
    everything = motion.points
    if beside is not None:
        near = beside[np.abs(beside - everything.mean()) < _FAR * motion.linkage.longest]
        everything = np.concatenate([everything.ravel(), near])
    x, y = everything.real, everything.imag
    margin = 0.06 * max(np.ptp(x), np.ptp(y))
    spans = (np.ptp(x) + 2 * margin, np.ptp(y) + 2 * margin)
    height = float(np.clip(width * 0.82 * spans[1] / spans[0] + 0.9, 3.6, 7.5))
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.set_xlim(x.min() - margin, x.max() + margin)
    axes.set_ylim(y.min() - margin, y.max() + margin)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.grid(color="0.92", linewidth=0.8)
    axes.set_axisbelow(True)
    return figure, axes


def chains(linkage: Linkage) -> list[list[tuple[str, str]]]:
    """Return the lines that draw each moving link.

    Parameters
    ----------
    linkage : Linkage

    Returns
    -------
    list of list[tuple[str, str]]
        Pairs (link, point) in order; closed where the points are not on one line.
    """
    found = []
    for link in linkage.moving:
        points = linkage.links[link].points
        chain = [(link, name) for name in points]
        xy = np.array(list(points.values()))
        if len(xy) > 2 and np.linalg.svd(xy - xy.mean(axis=0), compute_uv=False)[1] > 1e-6 * linkage.longest:
            chain.append(chain[0])
        found.append(chain)
    return found


def ground(axes: Any, motion: Motion) -> None:
    """Draw and name the joints of the ground: pivots as triangles, slots as bars of the length of the travel.

    Parameters
    ----------
    axes : object
        A matplotlib Axes.
    motion : Motion
    """
    base = motion.linkage.ground
    for name in motion.linkage.joints_of(base):
        joint = motion.linkage.joints[name]
        x, y = motion.linkage.links[base].points[motion.linkage.point_of(name, base)]
        if joint.carrier == base:
            travel = motion.travel(name)
            reach = np.array([travel.min(), travel.max()])
            bar = complex(x, y) + np.exp(1j * joint.direction) * reach
            axes.plot(bar.real, bar.imag, color="0.82", linewidth=8.0, solid_capstyle="round", zorder=0.5)
            x, y = bar[0].real, bar[0].imag
        else:
            axes.plot(x, y, marker="^", markersize=10, color="0.35", zorder=1)
        axes.annotate(name, (x, y), xytext=(7, -13), textcoords="offset points", fontsize=10, parse_math=False)


def over_angle(motion: Motion, labels: Sequence[str], size: tuple[float, float] = _SIZE) -> tuple[Figure, list[Any]]:
    """Return a figure with axes below each other over the coordinate of a motion, or over the cycle.

    Parameters
    ----------
    motion : Motion
    labels : sequence of str
        Of the y axes, the top one first.
    size : tuple of float, optional
        Width and height [inches].

    Returns
    -------
    tuple of Figure and list of Axes
    """
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(labels), 1, sharex=True, squeeze=False)[:, 0].tolist()
    for axes, label in zip(panels, labels, strict=True):
        axes.set_ylabel(label, parse_math=False)
        axes.set_xlim(*motion.progress[[0, -1]])
        axes.grid(color="0.9", linewidth=0.8)
    panels[-1].set_xlabel(motion.progress_title, parse_math=False)
    return figure, panels


def _line(axes: Any, motion: Motion, values: Real, label: str, index: int) -> None:
    style = {"color": COLOURS[index % len(COLOURS)], "linestyle": DASHES[index // len(COLOURS) % len(DASHES)]}
    axes.plot(motion.progress, values, label=label, linewidth=1.8, **style)


def _equal(sizes: dict[str, Real]) -> list[list[str]]:
    """Joints by equal force, as at both ends of a link that nothing else loads: one line serves them all."""
    groups: list[list[str]] = []
    for joint, size in sizes.items():
        for group in groups:
            if np.allclose(size, sizes[group[0]], rtol=1e-9, atol=1e-12, equal_nan=True):
                group.append(joint)
                break
        else:
            groups.append([joint])
    return groups


def _broken(result: CaseMotion, values: Real) -> Real:
    """The values with a gap at every dead point, so that no line joins the two sides of a pole."""
    out, motion = values.copy(), result.motion
    for angle in result.dead_points:
        out[int(np.argmin(np.abs(motion.angles - angle)))] = np.nan
        if motion.instants is not None:
            out[motion.passing(angle)] = np.nan
    return out


def _clip(axes: Any, result: CaseMotion, values: list[Real], *, symmetric: bool) -> None:
    if not result.dead_points:
        return
    limit = max(_CLIP * float(np.nanmedian(np.abs(v))) for v in values)
    ends = [abs(float(v[i])) for v in values for i in (0, -1) if np.isfinite(v[i])]
    limit = max([limit, *(_HEADROOM * end for end in ends)])
    if limit > 0.0:
        axes.set_ylim(-limit if symmetric else 0.0, limit)


def _dead_points(axes: Any, result: CaseMotion) -> None:
    motion = result.motion
    for dead in result.dead_points:
        angle = float(motion.told(dead))
        if motion.instants is not None:  # which passes it several times
            for i in motion.passing(dead):
                axes.axvline(motion.progress[i], color="0.25", linewidth=1.0, linestyle=(0, (2, 2)), zorder=1)
            continue
        axes.axvline(angle, color="0.25", linewidth=1.0, linestyle=(0, (2, 2)), zorder=1)
        axes.annotate(
            f"dead point of {result.drive.link}: {angle:.2f} {result.motion.unit}",
            (angle, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(-4, -6),
            textcoords="offset points",
            rotation=90,
            ha="right",
            va="top",
            fontsize=8.5,
            parse_math=False,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.0},
        )


def legend(axes: Any, title: str) -> None:
    """Name the lines beside the axes.

    Parameters
    ----------
    axes : object
        A matplotlib Axes.
    title : str
        Above the names.
    """
    names = axes.legend(title=title, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, borderaxespad=0.0)
    for text in names.get_texts():
        text.set_parse_math(False)
