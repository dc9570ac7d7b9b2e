"""Play and friction on links that are solids: each answer of a cause is solved on the solid, none is a ratio of beams.

A four-bar in a plane, with play in two joints and friction in three. What the program says of its coupler and rocker is
held against direct solutions on the same mesh, under forces of the linkage with its pins displaced, or rubbing more.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from tilting_pins import four_bar

from alula.fea.beam.cut_free import link_loads
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.sought import LEFT, sought
from alula.fea.doubts.friction_doubt import friction_doubt
from alula.fea.doubts.play_doubt import play_answers
from alula.fea.links.solid_result import link_task
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.refine.refinement import START, Effort, RefinedSolid, refine_links
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.standing.case_statics import CaseStatics, at_friction_ends, solve_case_statics
from alula.fea.superposition.link_answers import LinkAnswers, widest
from alula.fea.superposition.solid_shares import _factors, solid_shares
from alula.geometry.meshing.mesh import mesh_body
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.case.case_file import validate

RUBS = {"friction": 0.3, "friction_range": [0.1, 0.6]}
LINKS = ("coupler", "rocker")


@cache
def statics() -> CaseStatics:
    data = four_bar(tight={})
    del data["layer_spacing"]
    for link in data["links"].values():
        link.pop("layer", None)
    data["joints"]["A"]["clearance"], data["joints"]["O4"]["clearance"] = "2 mm", "1.5 mm"
    for name in ("O2", "A", "B"):
        data["joints"][name] |= RUBS
    data["load_cases"]["l"]["direction"] = "forward"
    data["checks"] = {"strength": {"type": "safety-factor", "minimum": 2.0}}
    return solve_case_statics(validate(data))


def acting(link: str, found: CaseStatics) -> LinkLoads:
    return link_loads("l", link, found.case.body(link), found.reactions["l"], found.loads["l"])


@cache
def mesh(link: str) -> TaggedMesh:
    return mesh_body(statics().case.body(link), START)


@cache
def solid(link: str) -> RefinedSolid:
    task = link_task(statics().case, link, [acting(link, statics())])
    return refine_links({link: task}, START, Effort(max_meshes=1), first={link: mesh(link)}, threads=1)[link]


def peaks(link: str, *loads: LinkLoads) -> NDArray[np.float64]:
    """Least and largest von Mises stress (n, 2) of all variants under each load, solved on the same mesh [MPa]."""
    task = link_task(statics().case, link, loads)
    found = solve_solid(mesh(link), E=task.E, nu=task.nu, density=task.density, loads=loads, line=task.line)
    fields = [stress_field(found.space, one.displacement, E=found.E, nu=found.nu) for one in found.cases]
    sizes = np.reshape([field.von_mises.max() for field in fields], (len(loads), -1))
    return np.column_stack([sizes.min(axis=1), sizes.max(axis=1)])


@pytest.mark.parametrize("link", LINKS)
def test_the_answers_of_friction_are_those_of_the_solid(link):
    forces = statics().forces["l"]
    doubt = friction_doubt(statics(), "l", examine(statics().case, "l", forces, statics().loads["l"]))
    assert doubt is not None
    answers = doubt.answers(link)
    [found] = solid_shares(link_task(statics().case, link, answers.stated), solid(link), [answers], threads=1)
    ends = [one for one in at_friction_ends(statics(), "l") if one is not None]
    least, most = peaks(link, *(acting(link, one) for one in (statics(), *ends))).T
    assert found["von_mises"].low == pytest.approx(min(least) / least[0], rel=1e-6)
    assert found["von_mises"].high >= max(most) / most[0] * (1.0 - 1e-6)
    assert found["von_mises"].high == pytest.approx(max(most) / most[0], rel=0.1)  # with the estimate of this mesh


def test_layers_of_which_no_series_was_made_have_the_estimate_of_one_mesh():
    """As over a motion, whose meshes are refined for other numbers; of two answers the second is worse by far."""
    answers, layers = [], Layers(normal=(0.6, 0.8, 0.0), across=20.0, between=10.0)
    for factor in (1.02, 3.0):
        stated = acting("coupler", statics())
        more = replace(stated, pins=tuple(replace(pin, wrench=factor * pin.wrench) for pin in stated.pins))
        answers.append(more)
    ways = LinkAnswers(
        stated=(stated,), others=tuple((one,) for one in answers), stress=widest(()), displacement=widest(())
    )
    task = replace(link_task(statics().case, "coupler", [stated]), layers=layers)
    refined = solid("coupler")
    assert all(one.layers is None for one in refined.precision)
    [found] = solid_shares(task, refined, [ways], threads=1)
    low, high = sought([1.0, 1.02, 3.0])
    assert found["layers"].low == pytest.approx(low)
    assert found["layers"].high == pytest.approx(high, rel=0.01)  # errors are in the same proportion


@pytest.mark.parametrize("link", LINKS)
def test_wherever_pins_with_play_stand_the_solid_bears_no_more(link):
    """Twelve places drawn, and the corners of both joints' directions."""
    case, forces, loads = statics().case, statics().forces["l"], statics().loads["l"]
    play, answers = forces.play, play_answers(case, "l", link, forces, loads)
    assert play is not None
    assert play.nominal is not None
    assert answers is not None
    [found] = solid_shares(link_task(case, link, answers.stated), solid(link), [answers], threads=1)
    rng, drawn = np.random.default_rng(1), []
    for _ in range(12):
        angle = rng.uniform(0.0, 2.0 * np.pi, 2)
        shares = {name: np.array([np.cos(a), np.sin(a)]) for name, a in zip(("A", "O4"), angle, strict=True)}
        here = play.at(play.loose.offsets(shares))
        assert here is not None
        drawn.append(link_loads("l", link, case.body(link), here, here.loads))
    stated, *sizes = peaks(link, answers.stated[0], *drawn)
    least, most = np.min(sizes, axis=0)[0] / stated[0], np.max(sizes, axis=0)[1] / stated[1]
    assert found["von_mises"].low <= least
    assert found["von_mises"].high >= most
    assert most > 1.01  # play tells
    narrower = max(pin.diameter / pin.pin_diameter for pin in case.body(link).pins)
    assert found["von_mises"].high < 1.6 * narrower


def test_of_an_idle_plate_nothing_is_known_of_the_low_end():
    """Stated: 2 and 4, or 0 and 4; another answer has 1 and 6."""
    answers = np.array([3, 3, 5, 5])
    both, idle = (_factors(np.array([first, 4.0, 1.0, 6.0]), answers, widest(())) for first in (2.0, 0.0))
    assert (both.low, both.high) == pytest.approx((0.5 - LEFT * 0.5, 1.5 + LEFT * 0.5))
    assert (idle.low, idle.high) == pytest.approx((0.0, 1.5 + LEFT * 0.5))
