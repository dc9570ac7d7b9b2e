"""What is answered to the text of a case while it is edited, as plain data: pose and joint forces, verdicts, motion."""

import math
import time
import tomllib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from alula.fea.check.run import check_case
from alula.fea.common.verdict import CheckOutcome, Subject, Tier, Verdict, by_nearness, overall
from alula.fea.findings.of_check import with_findings
from alula.fea.outcomes.result import CheckResult
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.linkage.motion import solve_motion
from alula.loads.case.case import Case
from alula.loads.case.case_file import changed_case, folder_of, keys_of
from alula.loads.states.case_motion import drive_angles
from alula.loads.states.kinetostatics import dead_points
from alula.reports.check.changes import change_sentences, change_title, size_command
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import checks_of, first_lines, opening
from alula.reports.words.numbers import sentence
from alula.reports.workbench.drawn import drawn, joint_forces

Plain = dict[str, Any]
Tell = Callable[[Plain], None]

_SLOW = 50.0
"""Time of a pose with its joint forces above which the next pose is told before they are known [ms]."""
_SO_FAR = (
    "So far by linear theory of the loads as stated: large displacement, buckling of the linkage, its limit load and "
    "other numbers of it as a whole are still to come, and so are play, air, friction and pins that tilt in the bands."
)


def case_of(text: str, name: str) -> Case:
    """Read a case from its text.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name, whose folder has the files of parts.

    Returns
    -------
    Case

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong.
    """
    try:
        tables = tomllib.loads(text.removeprefix("\ufeff"))
    except (ValueError, RecursionError) as error:
        raise CaseError(f"this is not valid TOML: {error}; correct that line") from None
    return changed_case(tables, (), name, folder_of(name))


def pose_answer(text: str, name: str, early: Tell | None = None) -> Plain:
    """Answer what is drawn of a case, and its joint forces under each load case.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name.
    early : callable, optional
        Is told what is drawn as soon as it is known, before joint forces are.

    Returns
    -------
    dict
        ``drawn`` as ``alula.reports.workbench.drawn.drawn``, None where nothing can be; ``forces`` as ``joint_forces``;
        ``problem``, the sentence that says why either is missing, else None; ``ms``.
    """
    start, seen, forces, problem = time.perf_counter(), None, None, None
    try:
        case = case_of(text, name)
        seen = drawn(case, case.solve_pose())
        if early is not None:
            early(_posed(seen, None, None, start))
        statics = solve_case_statics(case, name)
        seen, forces = drawn(case, statics.pose, statics), joint_forces(statics)
    except AlulaError as error:
        problem = str(error)
    return _posed(seen, forces, problem, start)


def _posed(seen: Plain | None, forces: Plain | None, problem: str | None, start: float) -> Plain:
    return {"drawn": seen, "forces": forces or {}, "problem": problem, "ms": 1e3 * (time.perf_counter() - start)}


def linear_answer(text: str, name: str) -> Plain:
    """Answer the verdict by hand so far: what linear theory says of the loads as stated.

    It leaves out what takes long (``linear`` of ``alula.fea.check.run.check_case``): numbers of the linkage as a whole,
    its buckling, limit load and deformed shape, and in bands play, air, friction and how pins may stand in their holes.
    Its bands are narrower for that, so that a pass may become open or a fail, and a fail open.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name.

    Returns
    -------
    dict
        As ``whole_answer``, of stage ``linear``; without changes and warnings.
    """
    start = time.perf_counter()
    try:
        return _judged(check_case(case_of(text, name), name=name, threads=1, linear=True), "linear", start)
    except AlulaError as error:
        return _open("linear", str(error), start)


def whole_answer(text: str, name: str, early: Tell | None = None) -> Plain:
    """Answer the whole verdict by hand, as ``alula check --fidelity beam`` gives it.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name.
    early : callable, optional
        Is told the same before what would change it is tried, which takes several checks.

    Returns
    -------
    dict
        ``stage`` whole; ``verdict``; ``sentences``, the verdict in words; ``checks``, with value, band and limit in
        their unit, None for what is not known or has no end; ``links``: link -> ``use``, the largest share of strength
        that it takes at the unfavourable end of its band, None where no check asks, and ``verdict``; ``changes``, each
        with ``text``, ``command`` and ``operations``, edits that make it, None where it is no single entry;
        ``warnings``; ``ms``.
    """
    start = time.perf_counter()
    try:
        result = check_case(case_of(text, name), name=name, fidelity="beam", threads=1)
        if early is not None:
            early(_judged(result, "whole", start))
        return _judged(with_findings(result), "whole", start)
    except AlulaError as error:
        return _open("whole", str(error), start)


def _judged(result: CheckResult, stage: str, start: float) -> Plain:
    checks, several = checks_of(result), len(result.load_cases) > 1
    sentences = first_lines(result)
    if stage == "linear":
        sentences = (*opening(result.case, result.verdict, checks, several=several), _SO_FAR)
    of_links = {
        link: [one for one in checks if one.subject == Subject.link(link)] for link in result.case.checked_links
    }
    return {
        "stage": stage,
        "verdict": result.verdict.value,
        "sentences": list(sentences),
        "checks": [_check(result.case, check) for check in by_nearness(checks)],
        "links": {
            link: {"use": _use(own), "verdict": overall(one.verdict for one in own).value}
            for link, own in of_links.items()
        },
        "changes": _changes(result),
        "warnings": [sentence(told(warning)) for warning in result.warnings],
        "ms": 1e3 * (time.perf_counter() - start),
    }


def _open(stage: str, problem: str, start: float) -> Plain:
    """Return the verdict on a case that cannot be checked."""
    nothing: Plain = {"checks": [], "links": {}, "changes": [], "warnings": []}
    ms = 1e3 * (time.perf_counter() - start)
    return {"stage": stage, "verdict": Verdict.UNDECIDED.value, "sentences": [problem], **nothing, "ms": ms}


def _check(case: Case, check: CheckOutcome) -> Plain:
    return {
        "check": check.name,
        "type": getattr(case.all_checks.get(check.name), "type", ""),
        "quantity": str(check.quantity),
        "subject": str(check.subject),
        "load_case": check.load_case,
        "value": _known(check.value.value),
        "low": _known(check.value.low),
        "high": _known(check.value.high),
        "limit": _known(check.limit),
        "unit": check.unit,
        "verdict": check.answer,
        "text": sentence(told(check.reason)),
    }


def _known(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _use(checks: Sequence[CheckOutcome]) -> float | None:
    """Return the largest share of strength that a link takes: the limit over the low end of its band."""
    margins = [one.margin for one in checks if one.applies and one.quantity.tier is not Tier.NEITHER]
    known = [1.0 / margin for margin in margins if margin > 0.0]
    return max(known, default=None)


def _changes(result: CheckResult) -> list[Plain]:
    """Return what would change the verdict, as reports tell it; a size that was tried and passes can be set at once."""
    several, found = len(result.load_cases) > 1, list[Plain]()
    for change in result.changes:
        title = sentence(change_title(change, several=several))[:-1]
        told_of_it = f"{title}: {' '.join(change_sentences(change, result))}"
        found.append({"text": told_of_it, "command": size_command(change, result) or None, "operations": None})
        if (size := change.size) is not None and change.check.verdict is not Verdict.PASS:
            operations = [{"op": "set", "path": keys_of(size.entry), "value": size.last}]
            wide = f"With {size.entry} = {size.last} it passes; the least that does lies between {size.first} and this."
            found.append({"text": wide, "command": None, "operations": operations})
    return found


def motion_answer(text: str, name: str) -> Plain:
    """Answer the positions of a case over its motion, without forces.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name.

    Returns
    -------
    dict
        ``values`` of the coordinate in ``unit``; ``points``: ``link.point`` -> places [mm]; ``angles``: link -> angles
        [deg]; ``dead``, values at which the drive is at a dead point; ``range``, its ends; ``turns``, true for a full
        turn. ``problem`` in their stead where the case does not move as it says.
    """
    try:
        case = case_of(text, name)
        if case.motion is None:
            return {"problem": "motion: the case states none; add a [motion] with its range, or turn = true"}
        pose, coordinate = case.solve_pose(), case.motion_coordinate
        motion = solve_motion(pose, drive_angles(case, pose), coordinate=coordinate)
        dead = () if case.pinned_drive is None else dead_points(motion, case.pinned_drive)
    except AlulaError as error:
        return {"problem": str(error)}
    return {
        "values": motion.told(motion.angles).tolist(),
        "unit": motion.unit,
        "points": {
            f"{link}.{point}": motion.position(link, point).round(4).tolist()
            for link, one in case.links.items()
            for point in one.points
        },
        "angles": {link: np.degrees(motion.angle(link)).round(4).tolist() for link in case.linkage.moving},
        "dead": motion.told(np.array(dead, dtype=float)).tolist(),
        "range": motion.told(motion.angles[[0, -1]]).tolist(),
        "turns": case.motion.turn,
    }


class _Pose:
    """The stage of poses, which tells what is drawn before joint forces where these took long the last time."""

    slow = False

    def __call__(self, text: str, name: str, tell: Callable[[str, Plain], None]) -> None:
        def tell_drawn(answer: Plain) -> None:
            if answer["drawn"] is not None:
                kept = {one: answer[one] for one in ("forces", "problem", "ms")}
                tell("drawn", {**answer["drawn"], **kept})

        answer = pose_answer(text, name, tell_drawn if self.slow else None)
        tell_drawn(answer)
        self.slow = answer["ms"] > _SLOW
        if answer["problem"] is not None:
            tell("problem", {"sentence": answer["problem"]})


def _motion(text: str, name: str, tell: Callable[[str, Plain], None]) -> None:
    tell("motion", motion_answer(text, name))


def _linear(text: str, name: str, tell: Callable[[str, Plain], None]) -> None:
    tell("verdict", linear_answer(text, name))


def _whole(text: str, name: str, tell: Callable[[str, Plain], None]) -> None:
    tell("verdict", whole_answer(text, name, lambda answer: tell("verdict", answer)))


STAGES: Mapping[str, Callable[[str, str, Callable[[str, Plain], None]], None]] = {
    "pose": _Pose(),
    "motion": _motion,
    "linear": _linear,
    "whole": _whole,
}
"""What a process may be asked, by its name: each tells events with their data."""
