"""Air forces and loads on the ground, as data for ``result.json`` and for the page."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.check.anchor import anchor_loads
from fea.outcomes.result import CheckResult, LoadCaseResult
from loads.case.case import Case
from loads.case.layers import pin_masses
from loads.records.aero import shares
from loads.records.carried import CarriedSpread
from reports.tables.data import entries
from reports.words.wording import joined, plain


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
