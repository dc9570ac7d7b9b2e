"""What is answered to the text of a case while it is edited, as plain data: pose and joint forces, and its motion."""

import math
import time
import tomllib
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import AlulaError
from alula.geometry.imported.files_read import reading_within
from alula.geometry.linkage.continuation import DeadPointError
from alula.geometry.linkage.motion import Motion, ends_of, solve_motion
from alula.loads.case.case import Case
from alula.loads.case.case_file import changed_case, folder_of, parse_tables
from alula.loads.records.motion_spec import MotionSpec
from alula.loads.states.case_motion import drive_angles
from alula.loads.states.kinetostatics import dead_points
from alula.reports.workbench.live.drawn import drawn, drawn_loosely, joint_forces

Plain = dict[str, Any]
Stage = Callable[[str, str, Callable[[str, Plain], None]], None]
"""Takes the text of a case, its path or built-in name, and what is told of events and their data."""

_SHORT = 1e-3
"""How far poses end before a dead point [rad], or over the longest link: less than can be seen."""
_UNLOADED = "load_cases: this entry is missing; add it"
_SLOW = 50.0
"""Time of a pose with its joint forces above which the next pose is told before they are known [ms]."""


def case_of(text: str, name: str) -> Case:
    """Read a case from its text.

    Parameters
    ----------
    text : str
        Of the case file.
    name : str
        Path or built-in name, whose folder has all files that the case names; no other is read.

    Returns
    -------
    Case

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong.
    """
    return _case(parse_tables(text.removeprefix("\ufeff"), "case"), name)


def _case(tables: Plain, name: str) -> Case:
    folder = folder_of(name)
    with reading_within(Path(folder)):
        return changed_case(tables, (), name, folder)


def pose_answer(text: str, name: str, early: Callable[[Plain], None] | None = None) -> Plain:
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
        ``drawn`` as ``alula.reports.workbench.live.drawn.drawn``, loosely where no pose can be solved, None where
        nothing can be read; ``forces`` as ``joint_forces``; ``problem``, the sentence that says why there is less,
        else None; ``ms``.
    """
    start, seen, forces, problem = time.perf_counter(), None, None, None
    case: Case | None = None
    try:
        case = case_of(text, name)
        seen = drawn(case, case.solve_pose())
        if early is not None:
            early(_posed(seen, None, None, start))
        statics = solve_case_statics(case, name)
        seen, forces = drawn(case, statics.pose, statics), joint_forces(statics)
    except AlulaError as error:
        problem = str(error)
        with suppress(ValueError, RecursionError):  # no TOML
            tables = tomllib.loads(text.removeprefix("\ufeff"))
            seen = seen or drawn_loosely(tables, case)
            if problem == _UNLOADED:
                problem = _beside(tables, name) or problem
    return _posed(seen, forces, problem, start)


def _beside(tables: Plain, name: str) -> str | None:
    """Return what is wrong with a case beside that no load is stated, which is told only where one is."""
    try:
        _case(tables | {"load_cases": {"weight": {"own_weight": True}}}, name).solve_pose()
    except AlulaError as error:
        return None if str(error).startswith("load_cases") else str(error)
    return None


def _posed(seen: Plain | None, forces: Plain | None, problem: str | None, start: float) -> Plain:
    return {"drawn": seen, "forces": forces or {}, "problem": problem, "ms": 1e3 * (time.perf_counter() - start)}


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
        ``values`` of the coordinate in ``unit``; ``pose``: those of the pose's own coordinate [deg or mm], None where
        it is the same; ``points``: ``link.point`` -> places [mm]; ``angles``: link -> angles [deg]; ``dead``, values at
        which the drive is at a dead point, or the coordinate goes no further; ``range``, the ends that it reaches;
        ``turns``, true for a full turn. ``problem``: why it does not move, or not as far as the case says, else None;
        without any motion it stands alone, but for ``offer`` where none is stated: the motion that there could be, a
        full turn or as far as the pose's coordinate gets; None of a travel.
    """
    try:
        case = case_of(text, name)
        if case.motion is None:
            none = "motion: the case states none; add a [motion] with its range, or turn = true"
            return {"problem": none, "offer": _offered(case)}
        motion, stopped = _moved(case)
        ends = [] if case.pinned_drive is None else dead_points(motion, case.pinned_drive)
    except AlulaError as error:
        return {"problem": str(error)}
    held = case.pose_coordinate or motion.coordinate
    pose = None if held == motion.coordinate else held.measure.told(motion.q[:, held.column(motion.closure)]).tolist()
    dead = np.unique([*ends, *(one.angle for one in stopped)])
    return {
        "values": motion.told(motion.angles).tolist(),
        "pose": pose,
        "unit": motion.unit,
        "points": {
            f"{link}.{point}": motion.position(link, point).round(4).tolist()
            for link, one in case.links.items()
            for point in one.points
        },
        "angles": {link: np.degrees(motion.angle(link)).round(4).tolist() for link in case.linkage.moving},
        "dead": motion.told(dead).tolist(),
        "range": motion.told(motion.angles[[0, -1]]).tolist(),
        "turns": case.motion.turn and not stopped,
        "problem": str(stopped[0]) if stopped else None,
    }


def _offered(case: Case) -> Plain | None:
    """Return the motion that a case could state: a full turn, or the range of its coordinate."""
    if case.pose.coordinate not in case.linkage.moving:
        return None
    start = math.degrees(case.solve_pose().angles[case.pose.coordinate])
    spec = MotionSpec.model_validate({"range": [f"{start + half} deg" for half in (-180.0, 180.0)]})
    motion, stopped = _moved(case.model_copy(update={"motion": spec}))
    if not stopped:
        return {"turn": True}
    low, high = np.degrees(motion.angles[[0, -1]])
    return {"range": [f"{math.ceil(low)} deg", f"{math.floor(high)} deg"]}


def _moved(case: Case) -> tuple[Motion, list[DeadPointError]]:
    """Return the motion of a case as far as the linkage gets on either side of its pose, and where it is stopped."""
    pose, coordinate = case.solve_pose(), case.motion_coordinate
    assert case.motion is not None
    values, stopped = np.linspace(*ends_of(drive_angles(case, pose)), case.motion.poses), list[DeadPointError]()
    start = float(pose.q[coordinate.column(pose.closure)])
    if not coordinate.slides:
        start += math.tau * round((0.5 * float(values[0] + values[-1]) - start) / math.tau)
    while True:
        try:
            return solve_motion(pose, values, coordinate=coordinate), stopped
        except DeadPointError as error:
            stopped.append(error)
            way = (values - error.angle) * np.sign(start - error.angle)
            values = values[way > _SHORT * coordinate.measure.scale(case.linkage)]
            if len(stopped) > 2 or len(values) < 2:
                raise


class _Pose:
    """The stage of poses, which tells what is drawn before joint forces where these took long the last time."""

    slow = False

    def __call__(self, text: str, name: str, tell: Callable[[str, Plain], None]) -> None:
        def seen(answer: Plain) -> None:
            if (what := answer.pop("drawn")) is not None:
                tell("drawn", what | answer)

        answer = pose_answer(text, name, seen if self.slow else None)
        self.slow = answer["ms"] > _SLOW
        seen(answer)
        if answer["problem"] is not None:
            tell("problem", {"sentence": answer["problem"]})


STAGES: Mapping[str, Stage] = {
    "pose": _Pose(),
    "motion": lambda text, name, tell: tell("motion", motion_answer(text, name)),
}
"""What a process may be asked, one after the other: each tells events with their data."""
