"""What is answered to the text of a case while it is edited, as plain data: pose and joint forces, and its motion."""

import time
import tomllib
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.linkage.motion import solve_motion
from alula.loads.case.case import Case
from alula.loads.case.case_file import changed_case, folder_of
from alula.loads.states.case_motion import drive_angles
from alula.loads.states.kinetostatics import dead_points
from alula.reports.workbench.drawn import drawn, joint_forces
from alula.reports.workbench.sketch import sketched

Plain = dict[str, Any]
Stage = Callable[[str, str, Callable[[str, Plain], None]], None]
"""Takes the text of a case, its path or built-in name, and what is told of events and their data."""

_SLOW = 50.0
"""Time of a pose with its joint forces above which the next pose is told before they are known [ms]."""


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
        ``drawn`` as ``alula.reports.workbench.drawn.drawn``, or ``sketched`` while there is no pose, None where nothing can
        be; ``forces`` as ``joint_forces``;
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
        seen = seen or _sketch(text)
    return _posed(seen, forces, problem, start)


def _sketch(text: str) -> Plain | None:
    with suppress(ValueError, RecursionError):
        return sketched(tomllib.loads(text.removeprefix("\ufeff")))
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


STAGES: Mapping[str, Stage] = {"pose": _Pose(), "motion": _motion}
"""What a process may be asked, one after the other: each tells events with their data."""
