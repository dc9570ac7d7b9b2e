"""Linkages whose links share the load by their stiffness, with the links' solids: closed forms and known answers.

* Three parallel cranks under a rigid coupler share what pulls along them as springs in parallel.
* A flat bar, 14 mm wide with round ends, 4 mm thick, with holes of 5 and 6.5 mm 70 mm apart, E 68,900 MPa, ν 0.33,
  pulled by 850 N (cosine pressure): the mean motions of its bores part by 0.019134 mm in plane stress, where centre
  lines have F L/(E A) = 0.01543 mm.
* A bar of two halves, bonded at a pin, against the bar in one piece.
* A bar with a raised eye, bonded at its ground and bent out of the plane, between two cantilevers: one as long as it is
  free beyond its eye, and one as long as the whole bar.
"""

from typing import Any

import numpy as np
import pytest

from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.outcomes.result import LoadCaseResult
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

STATED = ("youngs_modulus", "poissons_ratio", "density", "yield_strength")


def mm(*lengths: float) -> list[str]:
    return [f"{length} mm" for length in lengths]


def material(young: float, poisson: float) -> dict[str, Any]:
    return {
        "title": "Test",
        "youngs_modulus": f"{young} MPa",
        "poissons_ratio": poisson,
        "density": "1200 kg/m^3",
        "yield_strength": "1000 MPa",
        "strength": "yield",
        "minimum_safety_factor": 1.0,
        "sources": dict.fromkeys(STATED, "test"),
        "status": dict.fromkeys(STATED, "assumed"),
    }


def flat(width: float, thickness: float) -> dict[str, Any]:
    """A flat bar with round ends: the hull of two eyes."""
    return {"shape": "plate", "material": "m", "thickness": f"{thickness} mm", "eye_diameter": f"{width} mm"}


def three_cranks(
    parts: list[dict[str, Any]],
    card: dict[str, Any],
    height: float,
    xs: list[float],
    pins: list[list[float]],
    *,
    at: float,
    force: float,
) -> Case:
    """Parallel cranks from a, b, c up to A, B, C of a rigid coupler, which is pulled along them at M."""
    feet, tops = "abc", "ABC"
    links: dict[str, Any] = {
        "ground": {"ground": True, "points": {foot: mm(x, 0.0) for foot, x in zip(feet, xs, strict=True)}},
        "top": {"points": {name: mm(x, 0.0) for name, x in zip((*tops, "M"), (*xs, at), strict=True)}},
    }
    joints = {}
    for k, (foot, top) in enumerate(zip(feet, tops, strict=True)):
        links[f"bar{k}"] = {"part": f"p{k}", "points": {foot: mm(0.0, 0.0), top: mm(height, 0.0)}}
        for name, pair, pin in ((foot, ["ground", f"bar{k}"], pins[k][0]), (top, [f"bar{k}", "top"], pins[k][1])):
            joints[name] = {"links": pair, "pin_diameter": f"{pin} mm"}
    near = {"bar1": "90 deg", "bar2": "90 deg", "top": "0 deg"}
    return validate(
        {
            "schema_version": 1,
            "title": "three cranks",
            "links": links,
            "joints": joints,
            "materials": {"m": card},
            "parts": {f"p{k}": part for k, part in enumerate(parts)},
            "pose": {"coordinate": "bar0", "angle": "90 deg", "near": near},
            "drive": {"link": "bar0", "joint": "a"},
            "solid": {"mesh_size": 2.0},
            "large_displacement": "off",
            "load_cases": {"one": {"forces": [{"link": "top", "at": "M", "force": ["0 N", f"{force} N"]}]}},
            "checks": {"stiff": {"type": "displacement", "link": "top", "at": "M", "maximum": "1 mm"}},
        }
    )


def solved(case: Case, fidelity: str) -> tuple[LoadCaseResult, CheckOutcome]:
    (found,) = check_case(case, fidelity=fidelity, threads=1).load_cases.values()
    return found, next(check for check in found.checks if check.quantity is Quantity.DISPLACEMENT)


def tensions(found: LoadCaseResult) -> list[float]:
    return [-float(found.reactions.joints[name].wrench[1]) for name in "ABC"]


@pytest.mark.converged
def test_slender_cranks_share_the_load_as_springs_in_parallel():
    """Springs E A/L under a rigid beam; eyes and bores, a few widths of 300 mm, change the shares by less than 1 %."""
    widths, xs, at, pull = np.array([5.0, 8.0, 6.0]), np.array([0.0, 40.0, 100.0]), 30.0, 30.0
    case = three_cranks(
        [flat(w, 3.0) for w in widths], material(2900.0, 0.38), 300.0, list(xs), [[2.0, 2.0]] * 3, at=at, force=pull
    )
    k = 2900.0 * 3.0 * widths / 300.0
    stiffness = np.array([[k.sum(), k @ xs], [k @ xs, k @ xs**2]])
    rise, turn = np.linalg.solve(stiffness, [pull, pull * at])
    found, moved = solved(case, "solid")
    assert found.forces.model == "spatial frame of the links' solids with pins free about their own axis"
    assert tensions(found) == pytest.approx(k * (rise + turn * xs), rel=0.01)
    assert moved.value.value == pytest.approx(rise + turn * at, rel=0.03)


@pytest.mark.converged
def test_short_plates_share_the_load_as_their_plane_solution_has_it():
    """Two known flat bars beside a slender one, which centre lines give 18 % too little, and solids 4 %."""
    parts, pins = [flat(14.0, 4.0), flat(3.0, 4.0), flat(14.0, 4.0)], [[5.0, 6.5], [1.0, 1.0], [5.0, 6.5]]
    case = three_cranks(parts, material(68900.0, 0.33), 70.0, [0.0, 50.0, 100.0], pins, at=50.0, force=850.0)
    known, slender = 850.0 / 0.019134, 68900.0 * 12.0 / 70.0
    rise = 850.0 / (2.0 * known + slender)
    found, moved = solved(case, "auto")
    assert found.forces.solids == ("bar0", "bar1", "bar2")
    assert tensions(found) == pytest.approx([known * rise, slender * rise, known * rise], rel=0.045)
    assert tensions(found)[0] == pytest.approx(known * rise, rel=0.01)
    lines = 68900.0 * 56.0 / 70.0
    assert tensions(found)[1] > 1.15 * 850.0 * slender / (2.0 * lines + slender)
    assert moved.value.value == pytest.approx(rise, rel=0.01)
    assert moved.value.low <= rise <= moved.value.high
    assert "sinking into the sides that they press could add up to" in told(moved.reason)
    shared = {source.text for source in moved.value.sources if source.kind is SourceKind.DISCRETISATION}
    assert shared <= {source.text for source in found.links["bar0"].von_mises_max.sources}


def bonded(*, halves: bool) -> Case:
    """A bar of 200 mm, built in at both ends, under 10 N across at 40 mm."""
    ground = {"ground": True, "points": {"A": mm(0.0, 0.0), "S": mm(200.0, 0.0)}}
    one = {"part": "p", "points": {"A": mm(0.0, 0.0), "M": mm(40.0, 0.0), "S": mm(200.0, 0.0)}}
    links, joints = {"ground": ground, "one": one}, {"A": ["ground", "one"], "S": ["one", "ground"]}
    if halves:
        one["points"] = {"A": mm(0.0, 0.0), "M": mm(40.0, 0.0), "B": mm(100.0, 0.0)}
        links["two"] = {"part": "p", "points": {"B": mm(0.0, 0.0), "S": mm(100.0, 0.0)}}
        joints = {"A": ["ground", "one"], "B": ["one", "two"], "S": ["two", "ground"]}
    return validate(
        {
            "schema_version": 1,
            "title": "a bar",
            "links": links,
            "joints": {name: {"links": pair, "pin_diameter": "5 mm"} for name, pair in joints.items()},
            "joint_model": "bonded",
            "materials": {"m": material(2900.0, 0.38)},
            "parts": {"p": flat(10.0, 5.0)},
            "pose": {"near": {link: "0 deg" for link in links if link != "ground"}},
            "solid": {"mesh_size": 2.0},
            "large_displacement": "off",
            "load_cases": {"one": {"forces": [{"link": "one", "at": "M", "force": ["0 N", "-10 N"]}]}},
            "checks": {"stiff": {"type": "displacement", "link": "one", "at": "M", "maximum": "1 mm"}},
        }
    )


@pytest.mark.converged
def test_two_halves_bonded_at_a_pin_are_as_one_bar():
    """The bond gives a little: moments by which the ends are built in agree within 3 %, the displacement within 2 %."""
    (one, moved), (two, also) = (solved(bonded(halves=halves), "solid") for halves in (False, True))
    assert one.forces.model == two.forces.model == "spatial frame of the links' solids with bonded joints"
    for name in "AS":
        expected, found = (case.reactions.joints[name].wrench for case in (one, two))
        assert found[1] == pytest.approx(expected[1], rel=0.01)
        assert found[5] == pytest.approx(expected[5], rel=0.03)
    assert also.value.value == pytest.approx(moved.value.value, rel=0.02)
    # Plain beams, which are stiffer at their built-in ends: P a b²/L² and P a² b/L².
    assert [abs(one.reactions.joints[n].wrench[5]) for n in "AS"] == pytest.approx([256.0, 64.0], rel=0.07)


def raised_eye() -> Case:
    """A bar of 12 x 4 mm on an eye of 20 x 9 mm, bonded to the ground; forces across the plane at its tip and half-way.

    The limits lie within what eyes leave open of the frame of centre lines, beyond what solids do.
    """
    cases = {"tip": ("T", 5.0), "middle": ("M", -14.0)}
    return validate(
        {
            "schema_version": 1,
            "title": "a raised eye",
            "links": {
                "ground": {"ground": True, "points": {"K": mm(0.0, 0.0), "O": mm(0.0, 50.0)}},
                "arm": {
                    "part": "p",
                    "points": {"K": mm(0.0, 0.0), "M": mm(30.0, 0.0), "T": mm(60.0, 0.0)},
                    "end_patch": "4 mm",
                },
            },
            "joints": {"K": {"links": ["ground", "arm"], "pin_diameter": "5 mm", "bonded": True, "angle": "0 deg"}},
            "materials": {"m": material(68900.0, 0.33)},
            "parts": {
                "p": {
                    "shape": "bar",
                    "material": "m",
                    "width": "12 mm",
                    "thickness": "4 mm",
                    "eye_diameter": "20 mm",
                    "eye_thickness": "9 mm",
                    "fillet_radius": "2 mm",
                }
            },
            "load_cases": {
                name: {"forces": [{"link": "arm", "at": at, "force": ["0 N", "0 N", f"{force} N"]}]}
                for name, (at, force) in cases.items()
            },
            "checks": {
                "strength": {"type": "safety-factor"},
                "end": {"type": "displacement", "link": "arm", "at": "T", "maximum": "0.085 mm"},
                "half": {"type": "displacement", "link": "arm", "at": "M", "maximum": "0.0285 mm"},
            },
        }
    )


def moves(case: Case, fidelity: str) -> dict[tuple[str, str], CheckOutcome]:
    result = check_case(case, fidelity=fidelity, threads=1)
    every = (check for load_case in result.load_cases.values() for check in load_case.checks)
    return {(o.load_case, o.name): o for o in every if o.quantity is Quantity.DISPLACEMENT}


def test_solids_tell_how_far_a_point_moves_where_centre_lines_leave_it_open():
    """Their stiffness changes no joint force here, since there is one joint."""
    beams, solids = (moves(raised_eye(), fidelity) for fidelity in ("beam", "auto"))
    for at, load, span in (("end", "tip", 60.0), ("half", "middle", 30.0)):
        hand, found = beams[load, at], solids[load, at]
        assert hand.verdict is Verdict.UNDECIDED
        assert "--fidelity solid" in told(hand.reason)
        assert found.verdict is Verdict.PASS
        assert told(found.reason).startswith("by the frame of the links' solids")
        force = {"tip": 5.0, "middle": 14.0}[load]
        short, long = (force * reach**3 / (3.0 * 68900.0 * 64.0) for reach in (span - 10.0, span))
        assert short < found.value.value < long
        assert found.value.high - found.value.low < 0.2 * (hand.value.high - hand.value.low)
