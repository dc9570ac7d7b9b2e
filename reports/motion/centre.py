"""The instant centre of a link over a motion: its path, and where load lines run past it."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np

from alula.fea.findings.of_motion import MotionFindings
from alula.geometry.linkage.motion import Motion
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.instant_centre import InstantCentre
from alula.loads.text.explain import printable
from alula.reports.motion.charts import chart, figures
from alula.reports.motion.extremes import extremes, extremes_table, stretches
from alula.reports.motion.series import pose_columns
from alula.reports.sections.section import Group, Number, Part, Section, Series, Text, say
from alula.reports.words.numbers import joined


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
        parts=tuple(_parts(centre, found.moved, record)),
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


def _parts(centre: InstantCentre, moved: CaseMotion, record: Mapping[str, Any]) -> Iterator[Part]:
    motion, cycle = moved.motion, moved.case.cycle
    what = f"the instant centre of {centre.link} against {centre.against}"
    onward = "this motion" if cycle is None else f"growing {printable(cycle.signed_angle[1]) or motion.coordinate}"
    yield Text(
        f"A load line runs ahead of the centre where the load turns {centre.link} against {onward}, and behind it "
        "where it turns it on",
        kind="note",
    )
    if record["at_infinity"]:
        yield _where(f"{what[0].upper()}{what[1:]} lies at infinity", motion, record["at_infinity"])
    for name, of in record["load_cases"].items():
        rows = [("load line ahead of the centre", "mm", of["ahead"])]
        ahead = centre.lines[name].ahead
        told = _stability(what, motion, ahead) if cycle is None else _sides(what, motion, ahead, of["behind"])
        table = extremes_table("load-line", name, rows, motion.progress_unit, ends=True)
        yield Group(f"Load case {name}", (told, table) if np.isfinite(ahead).any() else (told,))
    yield chart("instant-centre", f"Path of {what}", lambda: figures().centre_figure(centre, motion))
    yield chart("load-line", f"Load lines ahead of {what}", lambda: figures().ahead_figure(centre, motion))


def _where(told: str, motion: Motion, runs: Sequence[tuple[float, float]], rest: str = "") -> Text:
    """Return what is told of runs of poses, with first and last of each, and of the rest."""
    of = "" if motion.instants is None else " of the cycle"
    spans, facts = _spans(motion, runs)
    return say(f"{told} {spans}{of}{rest}", **facts)


def _spans(motion: Motion, runs: Sequence[Sequence[float]]) -> tuple[str, dict[str, Number]]:
    """Return first and last of runs of poses as a text with places, and the numbers for these."""
    at = f"{motion.coordinate} = " if motion.instants is None else ""
    facts = {f"end{i}": Number(value, motion.progress_unit, 5) for i, value in enumerate(chain(*runs))}
    spans = [
        f"at {at}{{end{2 * i}}}" if first == last else f"from {at}{{end{2 * i}}} to {{end{2 * i + 1}}}"
        for i, (first, last) in enumerate(runs)
    ]
    return joined(spans), facts


def _sides(what: str, motion: Motion, ahead: Any, behind: Sequence[tuple[float, float]]) -> Text:
    """Return on which side the load line of a cycle runs, and when."""
    if not np.isfinite(ahead).any():
        return Text(f"Over the cycle no load line runs past {what}.")
    rest = " while there is one" if np.isnan(ahead).any() else ""
    if not behind:
        return Text(f"The load line runs ahead of {what} over the whole cycle{rest}.")
    if not (ahead >= 0.0).any():
        return Text(f"The load line runs behind {what} over the whole cycle{rest}.")
    return _where(f"The load line runs behind {what}", motion, behind, f", ahead of it else{rest}")


def _stability(what: str, motion: Motion, ahead: Any) -> Text:
    """Return on which side the load line runs at the first pose, and where on the other."""
    start = Number(float(motion.told(motion.angles[0])), motion.unit, 5)
    if not np.isfinite(ahead[0]):
        return say(f"At {motion.coordinate} = {{start}} no load line runs past {what}", start=start)
    side, state = ("behind", "Not stable") if ahead[0] < 0.0 else ("ahead of", "Stable")
    told = f"{state}: at {motion.coordinate} = {{start}} the load line runs {{ahead}} {side} {what}"
    facts = {"start": start, "ahead": Number(abs(float(ahead[0])), "mm")}
    if runs := stretches(motion, ahead >= 0.0 if ahead[0] < 0.0 else ahead < 0.0):
        spans, ends = _spans(motion, runs)
        told, facts = f"{told}, and {'ahead of' if ahead[0] < 0.0 else 'behind'} it {spans}", facts | ends
    return say(told, **facts)
