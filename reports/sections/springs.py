"""Springs, tendons and stops of a load case, and what holds its pose: for console, page and ``result.json``."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.coordinate import Measure
from alula.loads.acting.sprung import SpringState
from alula.loads.states.actions import lasting
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.standing import Standing
from alula.reports.words.numbers import number, turning


def holding_sentence(standing: Standing) -> str:
    """Say what holds the pose of a load case where the drive does not.

    Parameters
    ----------
    standing : Standing

    Returns
    -------
    str
        A sentence without its full stop; "" where the drive holds it, or nothing needs to.
    """
    pose, case = standing.pose, standing.case
    if standing.stop:
        joint = case.stops[standing.stop].joint
        first, second = case.joints[joint].links
        size, how = number(standing.contact), f"N on {second} along joint {joint}"
        if case.stops[standing.stop].limit.measure is Measure.ANGLE:
            size, how = number(abs(standing.contact)), f"N·mm {turning(standing.contact)} on {second}"
        return f"Stop '{standing.stop}' is reached and bears {size} {how}, the opposite on {first}; no drive is needed"
    if standing.stiffness is not None and pose.coordinate is not None:
        measure = pose.coordinate.measure
        return (
            f"The pose balances by itself at {pose.coordinate} = {number(float(measure.told(pose.held)))} "
            f"{measure.unit}, and is stable: its stiffness is {number(standing.stiffness)} {measure.stiffness_unit}"
        )
    return ""


def spring_sentences(standing: Standing) -> Iterator[str]:
    """Yield length and force of every spring and tendon, and how far every joint is from its stop.

    Parameters
    ----------
    standing : Standing

    Yields
    ------
    str
        Each without its full stop.
    """
    for state in standing.springs:
        yield f"{state.kind.capitalize()} {state.name}: {_size(state)}, {_effort(standing, state)}"
    for name, value in standing.stops.items():
        stop = standing.case.stops[name]
        at, limit = _told(standing, name, value), _told(standing, name, stop.limit.value)
        unit, most = stop.limit.measure.unit, "least" if stop.sense > 0.0 else "most"
        yield f"Stop {name}: joint {stop.joint} at {number(at)} {unit}, at {most} {number(limit)} {unit}"


def _told(standing: Standing, stop: str, value: float) -> float:
    """Return a coordinate at a stop in the unit that is told [mm or deg]."""
    return float(standing.case.stops[stop].limit.measure.told(value))


def _size(state: SpringState) -> str:
    if not state.turns:
        return f"{number(float(state.size))} mm long"
    return f"joint {state.joint} at {number(math.degrees(float(state.size)))} deg"


def _effort(standing: Standing, state: SpringState) -> str:
    effort = float(state.effort)
    if state.turns:
        second = standing.case.joints[state.joint].links[1]
        return f"{number(abs(effort))} N·mm {turning(effort)} on {second}" if effort else "not wound"
    if effort == 0.0:
        return "slack" if state.kind == "tendon" else "neither pulls nor pushes"
    return f"{'pulls' if effort > 0.0 else 'pushes'} with {number(abs(effort))} N"


def motion_springs(result: CaseMotion) -> list[tuple[str, NDArray[np.float64]]]:
    """Return length and pull, or angle and moment, of every spring and tendon over a motion.

    Parameters
    ----------
    result : CaseMotion
        At n poses.

    Returns
    -------
    list of tuple of str and ndarray, shape (n,)
        Name with unit, and values.
    """
    found = []
    for state in (one.state(result.motion.placement) for one in lasting(result.case)):
        if state.turns:
            found.append((f"{state.name} angle [deg]", np.degrees(state.size)))
            found.append((f"{state.name} moment [N mm]", state.effort))
        else:
            found.append((f"{state.name} length [mm]", state.size))
            found.append((f"{state.name} pull [N]", state.effort))
    return found


def standing_record(standing: Standing) -> dict[str, Any]:
    """Return springs, tendons and stops, and what holds the pose, as plain data.

    Parameters
    ----------
    standing : Standing

    Returns
    -------
    dict
        Empty where the case states none of them and its drive holds the pose.
    """
    if not (standing.springs or standing.stops or standing.stiffness is not None):
        return {}
    return {
        "standing": {
            "held_by": "stop" if standing.stop else "balance" if standing.stiffness is not None else "drive",
            "stop": standing.stop or None,
            "contact": standing.contact if standing.stop else None,
            "stiffness": standing.stiffness,
            "springs": [
                {
                    "name": state.name,
                    "kind": state.kind,
                    "length": None if state.turns else float(state.size),
                    "angle": math.degrees(float(state.size)) if state.turns else None,
                    "force": None if state.turns else float(state.effort),
                    "moment": float(state.effort) if state.turns else None,
                }
                for state in standing.springs
            ],
            "stops": [
                {
                    "name": name,
                    "joint": standing.case.stops[name].joint,
                    "value": _told(standing, name, value),
                    "reached": name == standing.stop,
                }
                for name, value in standing.stops.items()
            ],
        }
    }
