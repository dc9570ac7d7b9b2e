"""Buckling of a linkage as a whole: closed form, the deformed shape as second way, and the outcome of the check."""

from dataclasses import replace

import numpy as np
import pytest
from edited_cases import PLANAR
from scipy.optimize import brentq
from told import flat, printed

from alula.fea.check.run import check_case
from alula.fea.common.verdict import LINKAGE, Verdict
from alula.fea.frame.build import build_frame
from alula.fea.nonlinear import stability
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath, NoEquilibriumError, UnfollowedError
from alula.fea.nonlinear.stability import buckling_factor
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.applied import PointLoad
from alula.loads.states.actions import stated_loads
from alula.reports.sentences import told

HEIGHT, WIDTH = 120.0, 90.0


def parallelogram(load: float, **more: object) -> Case:
    """Two cranks stand on the ground under a coupler; the drive holds the left one, the right one leans on it."""
    data = {
        "schema_version": 1,
        "title": "parallelogram",
        "links": {
            "ground": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "D": [f"{WIDTH} mm", "0 mm"]}},
            "left": {"part": "rod", "points": {"A": ["0 mm", "0 mm"], "B": [f"{HEIGHT} mm", "0 mm"]}},
            "top": {"part": "rod", "points": {"B": ["0 mm", "0 mm"], "C": [f"{WIDTH} mm", "0 mm"]}},
            "right": {"part": "rod", "points": {"D": ["0 mm", "0 mm"], "C": [f"{HEIGHT} mm", "0 mm"]}},
        },
        "joints": {
            name: {"links": links, "pin_diameter": "1 mm"}
            for name, links in {
                "A": ["ground", "left"],
                "B": ["left", "top"],
                "C": ["top", "right"],
                "D": ["ground", "right"],
            }.items()
        },
        "pose": {"coordinate": "left", "angle": "90 deg", "near": {"top": "0 deg", "right": "90 deg"}},
        "drive": {"link": "left", "joint": "A"},
        "parts": {
            "rod": {
                "shape": "tube",
                "material": "pvc-paredes-2018",
                "outer_diameter": "2 mm",
                "inner_diameter": "1 mm",
                "eye_diameter": "3 mm",
                "eye_thickness": "3 mm",
                "fillet_radius": "0.2 mm",
            }
        },
        "load_cases": {
            "weight": {
                "forces": [
                    {"link": link, "at": point, "force": ["0 N", f"{-load!r} N"]}
                    for link, point in (("left", "B"), ("right", "C"))
                ]
            }
        },
    }
    return validate(data | more)


def critical() -> float:
    """A built-in column beside a leaning one under the same load: tan(k h) = 2 k h (see test_frame_sway)."""
    case = parallelogram(1.0)
    kh = brentq(lambda x: np.sin(x) - 2.0 * x * np.cos(x), 0.5, 1.5)
    stiffness = case.material_of("left").youngs_modulus * case.part_of("left").section.i_z
    return stiffness * (kh / HEIGHT) ** 2


def outcome(case: Case):
    result = check_case(case, fidelity="beam").load_cases["weight"]
    (found,) = [check for check in result.checks if (check.name, check.subject) == ("buckling", LINKAGE)]
    return result.large_displacement, found


def test_the_factor_of_a_parallelogram_is_that_of_the_closed_form() -> None:
    """Far from it the undeformed pose is good enough; no link alone is anywhere near to its own Euler load."""
    moved, found = outcome(parallelogram(0.09 * critical()))
    assert moved.state == "small"
    # Shear of the column takes a little more than lengthening gives.
    assert found.value.value == pytest.approx(1.0 / 0.09, rel=3e-3)
    assert found.value.low == pytest.approx(found.value.value / 5.196 / moved.eyes.high, rel=1e-4)
    assert 1.0 < moved.eyes.high < 1.05
    assert (found.verdict, found.limit, found.at_least) == (Verdict.PASS, 1.0, True)
    links = check_case(parallelogram(0.09 * critical()), fidelity="beam").load_cases["weight"].checks
    alone = {c.link: c.value.value for c in links if c.name == "buckling" and c.subject != LINKAGE}
    assert min(alone.values()) > found.value.value


@pytest.mark.parametrize(
    ("share", "state", "verdict"),
    [
        (0.11, "deformed", Verdict.PASS),
        (0.32, "deformed", Verdict.PASS),
        (0.35, "deformed", Verdict.UNDECIDED),
        (0.97, "deformed", Verdict.UNDECIDED),
        (1.03, "unstable", Verdict.FAIL),
    ],
)
def test_near_to_it_the_deformed_shape_is_asked_though_nothing_moves(share, state, verdict) -> None:
    """One limit load, one outcome: straight up to its buckling load, but within 3 times of it none passes."""
    result = check_case(parallelogram(share * critical()), fidelity="beam").load_cases["weight"]
    moved, (found,) = result.large_displacement, [c for c in result.checks if c.subject == LINKAGE]
    assert found.name == "large displacement"
    assert moved.share < 1e-3
    assert (moved.state, found.verdict) == (state, verdict)
    assert moved.buckling == pytest.approx(1.0 / share, rel=3e-3)
    assert "by linear theory the linkage buckles at" in told(moved.reason)
    assert f"buckling factor by linear theory is {moved.buckling:.3g}" in told(found.reason)
    assert found.value.value == pytest.approx(min(1.0, 1.0 / share), rel=3e-3)
    assert found.value.low == pytest.approx(min(1.0, 1.0 / share / 3.0 / moved.eyes.high), rel=3e-3)
    assert found.value.value <= found.value.high < 1.02 * found.value.value / moved.eyes.low


@pytest.mark.parametrize("share", [0.11, 1.03])
def test_a_path_that_is_not_followed_to_the_load_decides_nothing(share, monkeypatch) -> None:
    """Of one that passes and one that fails else; nothing that rests on its equilibrium passes either."""
    monkeypatch.setattr(EquilibriumPath, "follow", lambda *_, **__: raised(UnfollowedError(0.4)))
    whole = check_case(parallelogram(share * critical()), fidelity="beam")
    result = whole.load_cases["weight"]
    moved, (found,) = result.large_displacement, [c for c in result.checks if c.subject == LINKAGE]
    assert (moved.state, moved.held, moved.lost) == ("no equilibrium", 0.4, np.inf)
    assert found.verdict is Verdict.UNDECIDED
    assert "it holds 0.4 of the load, and 200 steps of load reach no further" in told(found.reason)
    assert moved.limit_load.high == np.inf
    assert found.value.high == 1.0
    assert not [c for c in result.checks if c.verdict is Verdict.PASS and c.quantity.origin == "loads"]
    assert all("whether the linkage holds its load is not known" in told(c.reason) for c in result.checks if c != found)
    assert "gives way" not in printed(whole)
    assert "The linkage was not followed to its load, so no link passes" in flat(printed(whole))


def raised(error: Exception) -> None:
    raise error


@pytest.mark.parametrize(("share", "verdict"), [(0.18, Verdict.PASS), (0.3, Verdict.UNDECIDED), (1.03, Verdict.FAIL)])
def test_where_the_case_leaves_large_displacement_out_the_factor_decides(share, verdict) -> None:
    moved, found = outcome(parallelogram(share * critical(), large_displacement="off"))
    assert moved.state == "off"
    assert found.verdict is verdict
    assert found.value.value == pytest.approx(1.0 / share, rel=3e-3)


@pytest.mark.parametrize("share", [0.3, -0.2])
def test_one_sought_factor_is_the_least_of_all(share, monkeypatch) -> None:
    """Frames of many unknowns are asked for one eigenvalue, pulled ones, where all lie about zero, too."""
    case = parallelogram(share * critical())
    loads = stated_loads(case, case.load_cases["weight"])
    frame = build_frame(case, case.solve_pose(), loads, held=case.pinned_drive)
    every = buckling_factor(frame.model)
    monkeypatch.setattr(stability, "_MANY", 0)
    assert buckling_factor(frame.model) == pytest.approx(every, rel=1e-9)


def test_pulled_it_never_buckles() -> None:
    case = parallelogram(-0.2 * critical())
    result = check_case(case, fidelity="beam").load_cases["weight"]
    assert result.large_displacement.buckling == np.inf
    assert not [check for check in result.checks if (check.name, check.subject) == ("buckling", LINKAGE)]


COMPRESSION = {"AB": 2.0, "BE": 1.0, "GF": 1.5, "FB": 1.2, "BC": 0.7, "CD": 0.9, "DH": 0.4, "ED": 1.1}


def axial_wing() -> tuple[Case, tuple[PointLoad, ...]]:
    """The owl wing under forces at its pins that press every stretch along its axis and bend none."""
    case = read_case("owl-wing-static", [PLANAR])
    pose = case.solve_pose()
    owner = {"A": "AE", "B": "AE", "E": "AE", "F": "GF", "G": "GF", "C": "CH", "D": "CH", "H": "CH"}
    force = {point: np.zeros(2) for point in owner}
    for (a, b), size in COMPRESSION.items():
        along = pose.points[b] - pose.points[a]
        along = along / np.linalg.norm(along)
        force[a] += size * along  # the stretch pushes on both of its ends; these forces hold them
        force[b] -= size * along
    loads = tuple(
        PointLoad(link=owner[p], point=p, wrench=np.array([*f, 0, 0, 0, 0])) for p, f in force.items() if p not in "AG"
    )
    return case, loads


def test_the_wings_factor_is_where_its_deformed_shape_becomes_unstable() -> None:
    case, loads = axial_wing()
    pose = case.solve_pose()
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    factor = buckling_factor(frame.model)

    def at(share: float):
        more = tuple(replace(p, wrench=share * factor * p.wrench) for p in frame.model.loads)
        return solve_large_displacement(replace(frame.model, loads=more))

    below = at(0.95)
    assert below.stable
    assert np.abs(below.displacements).max() < 5e-3 * frame.model.size
    # Uneven shortening bends the path away where it would fork: it ends there, or goes on unstable.
    assert not holds(at, 1.05)


def holds(at, share: float) -> bool:
    try:
        return at(share).stable
    except NoEquilibriumError:
        return False


@pytest.mark.parametrize(("share", "state"), [(0.05, "small"), (0.5, "deformed"), (1.25, "unstable")])
def test_sway_is_found_beyond_the_load_or_below_it(share, state):
    result = check_case(parallelogram(share * critical()), fidelity="beam")
    found = result.load_cases["weight"].linkage.limit_load
    assert result.load_cases["weight"].large_displacement.state == state
    if share < 0.1:
        assert (found.value, found.high) == (10.0, np.inf)
    else:
        assert found.value == pytest.approx(1.0 / share, rel=0.02)
    assert found.low <= 1.0 / share / 3.0
