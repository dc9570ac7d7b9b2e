"""Air forces, air on wings that flap, and loads on the ground: as data for ``result.json`` and for the page."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.check.anchor import anchor_loads
from alula.fea.outcomes.result import CheckResult, LoadCaseResult
from alula.fea.whole.motor import demand
from alula.geometry.base.units import as_text
from alula.geometry.linkage.placement import Placement
from alula.loads.case.case import Case
from alula.loads.case.layers import pin_masses
from alula.loads.records.aero import shares
from alula.loads.records.applied import LineLoad
from alula.loads.records.carried import CarriedSpread
from alula.loads.records.load_case import LoadCase
from alula.loads.states.case_motion import AirRange, CaseMotion
from alula.loads.states.flapping import flapping_loads, wing_reynolds, wing_span
from alula.reports.sections.data import entries
from alula.reports.words.numbers import joined, number, plain

Real = NDArray[np.float64]
_AT = ("without", "least", "stated", "largest")
"""Air of a drive: none, and the least, the stated and the largest C_N."""


def weight_sentence(case: Case, name: str) -> str:
    """Return weight, inertia and massless links of a load case in one sentence, without its full stop.

    Parameters
    ----------
    case : Case
    name : str
        Of the load case.

    Returns
    -------
    str
    """
    load_case = case.load_cases[name]
    if not load_case.own_weight and load_case.speed == 0.0:
        return "The links are massless in this load case; weights are among the stated forces"
    kind = "weight" if load_case.speed == 0.0 else "weight and inertia" if load_case.own_weight else "inertia"
    told = [f"The links have {kind} from volume and density of their parts"]
    if pins := pin_masses(case):
        own = [f"{plain(float(f'{pin.mass * 1e6:.3g}'))} g at {joint} on {pin.link}" for joint, pin in pins.items()]
        told.append(f"pins weigh {joined(own)}")
    if case.carried and load_case.carried:
        carried = [
            f"{mass.link} carries {plain(float(f'{mass.mass * 1e6:.4g}'))} g "
            + (f"spread from {mass.start} to {mass.end}" if isinstance(mass, CarriedSpread) else f"at {mass.at}")
            for mass in case.carried
        ]
        told.append(joined(carried))
    elif case.carried:
        told.append("carried masses are left out")
    if load_case.speed != 0.0:
        told.append(f"{case.pose.coordinate} turns at {plain(load_case.speed * 30.0 / math.pi)} rpm")
    if case.massless:
        told.append(f"{joined(list(case.massless))} {'is' if len(case.massless) == 1 else 'are'} massless")
    return "; ".join(told)


def anchor_record(case: LoadCaseResult) -> dict[str, Any]:
    """Return force and moment on the ground, at each of its joints and in total.

    Parameters
    ----------
    case : LoadCaseResult

    Returns
    -------
    dict
        As plain data.
    """
    anchor = anchor_loads(case)

    def wrench(values: NDArray[np.float64]) -> dict[str, list[float]]:
        return {"force": values[:3].tolist(), "moment": values[3:].tolist()}

    return {
        "joints": [{"joint": name} | wrench(values) for name, values in anchor.joints.items()],
        "total": {"about": anchor.about} | wrench(anchor.total),
        "deformed": anchor.deformed,
        "unstable": anchor.unstable,
    }


def air_record(result: CheckResult, name: str) -> list[dict[str, Any]]:
    """Return lift and drag of every air load of a load case, with coefficients and places.

    Parameters
    ----------
    result : CheckResult
    name : str
        Of the load case.

    Returns
    -------
    list of dict
        As plain data.
    """
    points = result.case.link_points
    found = []
    for air, forces in zip(result.case.load_cases[name].air, result.case.air_forces(name), strict=True):
        lift, drag = forces.coefficients or (None, None)
        found.append(
            entries(air, "title speed density area")
            | entries(forces, "given lift drag lift_direction drag_direction warnings")
            | {
                "dynamic_pressure": forces.pressure,
                "lift_coefficient": lift,
                "drag_coefficient": drag,
                "force": forces.total.tolist(),
                "spread": [
                    {
                        "link": patch.link,
                        "where": patch.at or f"{patch.start} to {patch.end}",
                        "shape": "point" if patch.at else patch.shape,
                        "span": list(patch.span) if patch.at is None and patch.shape == "elliptic" else None,
                        "share": share,
                    }
                    for patch, share in zip(air.spread, shares(air, points), strict=True)
                ],
            }
        )
    return found


def motion_air_record(airs: AirRange | None, load_case: str) -> dict[str, Any] | None:
    """Return what the air does to the wings of a load case over a motion, and to its drive.

    Parameters
    ----------
    airs : AirRange or None
    load_case : str
        Its name.

    Returns
    -------
    dict or None
        ``docs/result.md`` describes it; None without air.
    """
    if airs is None:
        return None
    result = airs.stated
    case, stated, moved = result.case, result.case.load_cases[load_case], result.moved[load_case]
    air = stated.flapping
    if air is None or not np.any(moved.speed):
        return None
    wings = []
    for i, wing in enumerate(case.wings):
        force = wing_force(case, stated, moved.placement, i)
        first, last, chord = wing_span(wing, case)
        largest = int(np.argmax(np.abs(force)))
        wings.append(
            {
                "link": wing.link,
                "span": [first, last],
                "chord": list(chord),
                "largest_force": float(np.abs(force[largest])),
                "largest_at": float(moved.told(moved.angles[largest])),
                "reynolds": wing_reynolds(case, air, wing, moved.placement),
            }
        )
    every = dict(zip(_AT, (airs.without, airs.least, result, airs.largest), strict=True))
    return {
        "density": as_text(air.density, "density"),
        "normal_coefficient": air.normal_coefficient,
        "normal_coefficient_range": list(air.ends),
        "added_mass": air.added_mass,
        "wings": wings,
        "drive": {name: _asked(one, load_case) for name, one in every.items()},
    }


def wing_force(case: Case, load_case: LoadCase, place: Placement, i: int) -> Real:
    """Return the force of the air on a wing, along its link's y axis.

    Parameters
    ----------
    case : Case
    load_case : LoadCase
    place : Placement
        With rates.
    i : int
        Number of the wing.

    Returns
    -------
    array (...)
        [N]
    """
    alone = case.model_copy(update={"wings": (case.wings[i],)})
    parts = [
        load.force if isinstance(load, LineLoad) else load.wrench for load in flapping_loads(alone, load_case, place)
    ]
    return np.asarray(sum(part[..., 1] for part in parts))


def _asked(moved: CaseMotion, load_case: str) -> dict[str, float]:
    times = moved.moved[load_case].times
    assert times is not None
    balanced = np.isfinite(moved.torque[load_case])
    power, effort = (values[balanced] for values in (moved.drive_power(load_case), moved.torque[load_case]))
    found = demand(power, effort, times[balanced])
    return {"peak_power": found.peak_power, "mean_power": found.mean_power, "peak_effort": found.peak_torque}


def case_air_record(airs: AirRange | None) -> dict[str, dict[str, Any]]:
    """Return what the air does over the motion of a case, for every load case that has air.

    Parameters
    ----------
    airs : AirRange or None

    Returns
    -------
    dict of str to dict
        Load case -> its record; empty without air, and without a motion.
    """
    found = {} if airs is None else {name: motion_air_record(airs, name) for name in airs.stated.torque}
    return {name: record for name, record in found.items() if record is not None}


def air_lines(record: dict[str, Any] | None) -> list[str]:
    """Return what the air does over a motion, in sentences.

    Parameters
    ----------
    record : dict or None
        From ``motion_air_record``.

    Returns
    -------
    list of str
    """
    if record is None:
        return []
    low, high = record["normal_coefficient_range"]
    without, least, stated, largest = (record["drive"][name] for name in _AT)
    force = max(wing["largest_force"] for wing in record["wings"])
    reynolds = max(wing["reynolds"] for wing in record["wings"])

    def told(key: str) -> str:
        spread = f" ({number(least[key], 3)} to {number(largest[key], 3)})" if low != high else ""
        return f"{number(without[key], 3)} W without air, {number(stated[key], 3)} W{spread} with it"

    ends = f" ({low:g} to {high:g})" if low != high else ""
    return [
        f"air on wings: C_N {record['normal_coefficient']:g}{ends}, at most {number(force, 3)} N on a wing, Reynolds "
        f"number up to {number(reynolds, 2)}",
        f"drive power in air: on average {told('mean_power')}; at most {told('peak_power')}",
    ]
