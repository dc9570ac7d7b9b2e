"""The instant centre of a link over a motion: its path, and where load lines run past it."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from alula.fea.findings.of_motion import MotionFindings
from alula.geometry.linkage.motion import Motion
from alula.loads.states.instant_centre import InstantCentre
from alula.reports.motion.charts import chart, figures
from alula.reports.motion.extremes import extremes, extremes_table, stretches
from alula.reports.motion.series import pose_columns
from alula.reports.sections.section import Group, Number, Part, Section, Series, Text, say


def centre_section(found: MotionFindings) -> Section:
    """Return the path of the instant centre, and how far ahead of it the load lines run.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    Section
        Without parts where the case asks for no centre.
    """
    centre, motion = found.centre, found.moved.motion
    key, title = "instant-centre", "Instant centre and load lines"
    if centre is None:
        return Section(key=key, title=title, data={"instant_centre": None})
    record = _record(centre, motion)
    columns = {"instant centre x [mm]": centre.path.real, "instant centre y [mm]": centre.path.imag}
    columns |= {f"{name} load line ahead [mm]": line.ahead for name, line in centre.lines.items()}
    return Section(
        key=key,
        title=title,
        short="Instant centre",
        parts=tuple(_parts(centre, motion, record)),
        data={"instant_centre": record},
        series=(Series(file="instant-centre.csv", columns={**pose_columns(motion), **columns}, digits=12),),
    )


def _record(centre: InstantCentre, motion: Motion) -> dict[str, Any]:
    return {
        "link": centre.link,
        "against": centre.against,
        "x": extremes(motion, centre.path.real),
        "y": extremes(motion, centre.path.imag),
        "at_infinity": stretches(motion, np.isnan(centre.path.real)),
        "load_cases": {
            name: {"ahead": extremes(motion, line.ahead), "behind": stretches(motion, line.ahead < 0.0)}
            for name, line in centre.lines.items()
        },
    }


def _parts(centre: InstantCentre, motion: Motion, record: Mapping[str, Any]) -> Iterator[Part]:
    what = f"the instant centre of {centre.link} against {centre.against}"
    yield Text(
        f"A load line runs ahead of the centre where the load turns {centre.link} against this motion, and behind it "
        "where it turns it on",
        kind="note",
    )
    for first, last in record["at_infinity"]:
        ends = {"first": Number(first, motion.unit, 5), "last": Number(last, motion.unit, 5)}
        yield say(
            f"{what[0].upper()}{what[1:]} lies at infinity from {motion.coordinate} = {{first}} to {{last}}", **ends
        )
    for name, of in record["load_cases"].items():
        rows = [("load line ahead of the centre", "mm", of["ahead"])]
        told = _stability(what, motion, centre.lines[name].ahead)
        table = extremes_table("load-line", name, rows, motion.unit, ends=True)
        yield Group(f"Load case {name}", (told, table) if np.isfinite(centre.lines[name].ahead).any() else (told,))
    yield chart("instant-centre", f"Path of {what}", lambda: figures().centre_figure(centre, motion))
    yield chart("load-line", f"Load lines ahead of {what}", lambda: figures().ahead_figure(centre, motion))


def _stability(what: str, motion: Motion, ahead: Any) -> Text:
    """Return on which side the load line runs at the first pose, and where that changes."""
    start = Number(float(motion.told(motion.angles[0])), motion.unit, 5)
    if not np.isfinite(ahead[0]):
        return say(f"At {motion.coordinate} = {{start}} no load line runs past {what}", start=start)
    side, state = ("behind", "Not stable") if ahead[0] < 0.0 else ("ahead of", "Stable")
    told = f"{state}: at {motion.coordinate} = {{start}} the load line runs {{ahead}} {side} {what}"
    facts = {"start": start, "ahead": Number(abs(float(ahead[0])), "mm")}
    turn = np.flatnonzero((ahead < 0.0) != (ahead[0] < 0.0))
    turn = turn[np.isfinite(ahead[turn])]
    if len(turn):
        told += f", and {'ahead of' if ahead[0] < 0.0 else 'behind'} it from {{turn}} on"
        facts["turn"] = Number(float(motion.told(motion.angles[turn[0]])), motion.unit, 5)
    return say(told, **facts)
