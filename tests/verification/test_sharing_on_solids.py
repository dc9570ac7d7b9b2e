"""Ways of sharing couples on links that are solids: each way's own peaks, and frames of condensed solids."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import QhullError
from tilting_pins import PLA, checked, four_bar, loaded

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.solid_frame import with_solids
from alula.fea.common.sought import LEFT
from alula.fea.doubts.force_doubt import outermost, sharing_answers, sharing_doubt
from alula.fea.links.link_by_hand import HandStates
from alula.fea.links.solid_result import link_task
from alula.fea.refine.refinement import START, Effort, RefinedSolid, refine_links
from alula.fea.solid.solution import SolidSolution, solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.fea.standing.joint_forces import JointForces
from alula.fea.standing.thrust import thrusts
from alula.fea.superposition.solid_shares import solid_shares
from alula.geometry.meshing.mesh import mesh_body
from alula.loads.case.case import Case
from alula.loads.statics.statics import Reactions


@cache
def in_plane() -> tuple[Case, CaseStatics, JointForces]:
    case = loaded(PLA, ["0 N", "-1 N"])
    statics = solve_case_statics(case)
    return case, statics, statics.forces["l"]


@cache
def worst() -> Reactions:
    """The way under which the rocker bears most, by hand."""
    case, statics, forces = in_plane()
    body, loads = case.body("rocker"), statics.loads["l"]
    acting = [(link_loads("l", "rocker", body, one, loads),) for one in forces.sharings]
    return forces.sharings[int(HandStates(case, "rocker", acting).stress.argmax())]


@cache
def rocker() -> tuple[RefinedSolid, SolidSolution]:
    """The rocker's solid under running pins, and on the same mesh under its worst way."""
    case, statics, forces = in_plane()
    body = case.body("rocker")
    plain, shared = (link_loads("l", "rocker", body, one, statics.loads["l"]) for one in (forces.reactions, worst()))
    task, mesh = link_task(case, "rocker", [plain]), mesh_body(body, START)
    refined = refine_links({"rocker": task}, START, Effort(max_meshes=1), first={"rocker": mesh})["rocker"]
    alone = solve_solid(mesh, E=task.E, nu=task.nu, density=task.density, loads=[shared], line=task.line)
    return refined, alone


def largest(solution: SolidSolution) -> tuple[float, float]:
    """Largest von Mises stress and displacement of all variants [MPa], [mm]."""
    fields = [stress_field(solution.space, one.displacement, E=solution.E, nu=solution.nu) for one in solution.cases]
    return max(float(field.von_mises.max()) for field in fields), max(one.displacement_max for one in solution.cases)


def test_a_way_of_sharing_is_solved_on_the_solid():
    """Superposition against that way solved alone."""
    case, statics, forces = in_plane()
    refined, alone = rocker()
    ways = sharing_answers(case, "l", "rocker", forces, statics.loads["l"])
    acting = link_loads("l", "rocker", case.body("rocker"), worst(), statics.loads["l"])
    task = link_task(case, "rocker", ways.stated)
    [found] = solid_shares(task, refined, [replace(ways, others=((acting,),))])
    (stress, moved), (plain, still) = largest(alone), largest(refined.solution)
    assert stress > 2.0 * plain
    least, most = sorted((moved / still, 1.0))
    beyond = LEFT * (most - least)  # what the search may have left
    assert (found["displacement"].low, found["displacement"].high) == pytest.approx(
        (least - beyond, most + beyond), rel=1e-3
    )
    top = max(one.high("von_mises") for one in refined.precision)
    assert stress / plain * (1.0 - 1e-3) <= found["von_mises"].high
    assert stress < top * found["von_mises"].high < 2.0 * stress  # with the estimate of this one mesh
    [every] = solid_shares(task, refined, [ways])
    assert every["von_mises"].high >= found["von_mises"].high * (1.0 - 1e-6)
    assert every["von_mises"].low < found["von_mises"].low


def test_the_band_by_hand_of_a_bent_link_holds_its_solid_in_its_worst_way():
    """Loaded in the plane its section bears most, in its worst way an eye; a band by plain sections ended at 68 MPa."""
    data = four_bar(tight={}, checks={"s": {"type": "safety-factor", "minimum": 2.0}})
    data["parts"]["bar"] |= {"width": "6 mm", "fillet_radius": "1.5 mm"}
    data["links"]["coupler"]["points"]["P"] = ["100 mm", "0 mm"]
    data["load_cases"]["l"]["forces"] = [{"link": "coupler", "at": "P", "force": ["0 N", "-20 N"]}]
    case = checked(data)
    statics = solve_case_statics(case)
    ways = sharing_answers(case, "l", "coupler", statics.forces["l"], statics.loads["l"])
    growth = sharing_doubt(case, "l", statics.forces["l"], statics.loads["l"], links=["coupler"]).stress["coupler"]
    low, high = HandStates(case, "coupler", ways.every).peaks
    [acting] = ways.others[high[1:].argmax()]
    task, mesh = link_task(case, "coupler", [acting]), mesh_body(case.body("coupler"), START)
    alone = solve_solid(mesh, E=task.E, nu=task.nu, density=task.density, loads=[acting], line=task.line)
    found, _ = largest(alone)
    assert low[0] * growth.low < high[0] < found < high[0] * growth.high
    plain, *others = HandStates(case, "coupler", ways.every).stress
    assert found > high[0] * ways.stress(plain, others).high


def test_the_corners_of_the_hull_bear_the_most():
    """By hand of every link the same ends as of all ways."""
    case, statics, forces = in_plane()
    few = sharing_doubt(case, "l", forces, statics.loads["l"])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("alula.fea.doubts.force_doubt.outermost", lambda points: np.arange(len(points)))
        every = sharing_doubt(case, "l", forces, statics.loads["l"])
    assert few.stress.keys() == every.stress.keys() == set(case.checked_links)
    for link, share in every.stress.items():
        assert (few.stress[link].low, few.stress[link].high) == pytest.approx((share.low, share.high), rel=1e-5)


@pytest.mark.parametrize(
    ("points", "corners"),
    [
        ([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [4.0, 4.0], [1.0, 2.0], [3.9, 2.0]], [0, 1, 2, 3]),
        ([[1.0, 1.0, 0.0], [3.0, 3.0, 0.0], [2.0, 2.0, 0.0]], [0, 1]),  # on a line
        ([[1.0, 2.0], [1.0, 2.0]], [0]),  # all at one place
    ],
)
def test_outermost_points(points, corners):
    assert outermost(np.array(points)).tolist() == corners


def test_where_no_hull_is_found_all_points_are_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wing with moduli five times as small ended in an internal error: its ways to share couples lie on one face."""

    def refuse(points: object) -> None:
        raise QhullError("qhull topology error")

    monkeypatch.setattr("scipy.spatial.ConvexHull", refuse)
    assert outermost(np.random.default_rng(1).normal(size=(9, 3))).tolist() == list(range(9))


def test_a_small_force_across_the_plane_leaves_the_ways_of_sharing():
    """0.001 N of it brings the links in as condensed solids; thrust once fell from 0.285 to 0.0065 N by that."""
    case, statics, plain = in_plane()
    out = solve_case_statics(loaded(PLA, ["0 N", "-1 N", "0.001 N"]))
    solved, _ = with_solids(out, {"l": SimpleNamespace(followed=False)}, START, always=True)  # type: ignore[dict-item]
    forces = solved.forces["l"]
    assert set(forces.solids) == set(case.checked_links)
    before, after = thrusts(plain), thrusts(forces)
    for name, band in before.items():
        assert after[name].high == pytest.approx(band.high, rel=0.02)
        assert band.high > 0.1
    one, other = (
        sharing_doubt(case, "l", found, stat.loads["l"]).stress for found, stat in ((plain, statics), (forces, out))
    )
    for link in case.checked_links:
        assert other[link].high == pytest.approx(one[link].high, rel=0.05)
