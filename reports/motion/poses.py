"""The poses of a motion: its range, directions of the links, paths of the points, springs, dead points."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from alula.fea.findings.joint_paths import moving_points, path_length
from alula.fea.findings.of_motion import MotionFindings
from alula.fea.findings.rates import Rates
from alula.geometry.linkage.motion import Motion, ends_of
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.charts import chart, figures
from alula.reports.motion.extremes import every_extreme, finite_or_none
from alula.reports.sections.section import Cell, Column, Number, Part, Section, Table, Text, say, words
from alula.reports.sections.springs import motion_springs

_ENDS = ("first", "last", "smallest", "largest")


def motion_section(found: MotionFindings, own: Rates | None) -> Section:
    """Return range, directions of the links, paths, springs and dead points.

    Parameters
    ----------
    found : MotionFindings
    own : Rates or None
        Rates at the motion's own speed; None without one.

    Returns
    -------
    Section
    """
    return Section(
        key="motion",
        title="The motion",
        short="Motion",
        parts=tuple(_parts(found)),
        data={"motion": _motion(found.moved, own), "drive": _drive(found)},
    )


def range_text(moved: CaseMotion) -> Text:
    """Return over which poses the linkage moves.

    Parameters
    ----------
    moved : CaseMotion

    Returns
    -------
    Text
    """
    motion = moved.motion
    first, last = (Number(float(motion.told(end)), stated=True) for end in ends_of(motion.angles))
    took = {} if motion.times is None else {"duration": Number(float(motion.times[-1]), "s")}
    cycle = moved.case.cycle
    whole, of = ("From", {}) if cycle is None else ("Over the cycle of {file}: from", {"file": cycle.file})
    return say(
        f"{whole} {motion.coordinate} = {{first}} to {{last}} {motion.unit}, driven at {moved.drive.link}, in "
        f"{len(motion.angles)} poses{' and {duration}' if took else ''}; largest gap of a loop {{gap}} of the longest "
        "link",
        first=first,
        last=last,
        **took,
        gap=Number(motion.residual, "", 1),
        **of,
    )


def _parts(found: MotionFindings) -> Iterator[Part]:
    moved, motion = found.moved, found.moved.motion
    yield range_text(moved)
    if motion.returns:
        yield Text("The linkage returns to its start.")
    yield from _dead_points(found)
    directions: list[tuple[Cell, ...]] = [
        (link, *(Number(value, decimals=3) for value in _directions(motion, link).values()))
        for link in motion.linkage.moving
    ]
    columns = (words("link"), *(Column(title, "deg") for title in _ENDS))
    yield Table(key="directions", columns=columns, rows=tuple(directions), caption="Directions of the links")
    yield chart("link-angles", "Directions of the links", lambda: figures().angles_figure(moved))
    yield chart("paths", "Paths of the joints", lambda: figures().paths_figure(motion, found.play))
    if springs := motion_springs(moved):
        yield Table(
            key="springs",
            columns=(words("spring or tendon"), *map(Column, _ENDS)),
            rows=tuple((told, *(Number(x, derived=True) for x in _ends(values))) for told, values in springs),
        )


def _dead_points(found: MotionFindings) -> Iterator[Text]:
    moved, motion = found.moved, found.moved.motion
    link = moved.drive.link
    for at in moved.dead_points:
        yield say(
            f"Dead point of the driven link {link} at {motion.coordinate} = {{at}}: {link} reverses its direction "
            f"there; drive {moved.effort.word} and joint forces grow without bound",
            at=Number(float(motion.told(at)), motion.unit, decimals=4),
        )
    if not moved.dead_points:
        way = finite_or_none(float(motion.told(found.way_to_dead_point)))
        facts: dict[str, object] = {"least": Number(found.dead_point_distance, "", 3)}
        beyond = "none was met beyond"
        if way is not None:
            beyond, facts["way"] = "the nearest is {way} beyond", Number(way, motion.unit)
        yield say(f"No dead point of {link} in the range, {beyond}; least distance (a ratio) {{least}}", **facts)


def _ends(values: Any) -> list[float]:
    """First, last, smallest and largest."""
    return [float(value) for value in (values[0], values[-1], values.min(), values.max())]


def _directions(motion: Motion, link: str) -> dict[str, float]:
    """First, last, smallest and largest direction of a link [deg]."""
    return dict(zip(_ENDS, map(math.degrees, _ends(motion.angle(link))), strict=True))


def _motion(moved: CaseMotion, own: Rates | None) -> dict[str, Any]:
    motion = moved.motion

    def rates(of: Mapping[str, Any], *quantities: str) -> dict[str, Any]:
        return dict.fromkeys(quantities) if own is None else every_extreme(own.motion, {q: of[q] for q in quantities})

    links, points = ({}, {}) if own is None else (own.links, own.points)
    return {
        "coordinate": motion.coordinate.name,
        "unit": motion.unit,
        "first": float(motion.told(motion.angles[0])),
        "last": float(motion.told(motion.angles[-1])),
        "poses": len(motion.angles),
        f"speed_{motion.coordinate.measure.symbol}_per_s": [
            float(motion.speed[0]),
            float(motion.speed[-1]),
        ],
        "duration": None if motion.times is None else float(motion.times[-1]),
        "closure_residual": motion.residual,
        "returns_to_start": motion.returns,
        "cycle": None if motion.instants is None else motion.progress.tolist(),
        "inertia": moved.case.inert,
        "links": {
            link: _directions(motion, link) | rates(links.get(link, {}), "angular_speed", "angular_acceleration")
            for link in motion.linkage.moving
        },
        "points": {
            label: {"path_length": path_length(xy), **rates(points.get(label, {}), "speed", "acceleration")}
            for label, xy in moving_points(motion).items()
        },
    }


def _drive(found: MotionFindings) -> dict[str, Any]:
    moved = found.moved
    return {
        "link": moved.drive.link,
        "joint": moved.drive.joint,
        "dead_points": [float(moved.motion.told(at)) for at in moved.dead_points],
        "least_distance": found.dead_point_distance,
        "way_to_dead_point": finite_or_none(float(moved.motion.told(found.way_to_dead_point))),
    }
