"""What stays after a load, by the work of the loads, beside what curvature, strain and geometry say.

The cantilever: with M = P x from its tip and the elastic curvature κ_y of its first yield, M/M_y = 3/2 (1 - (κ_y/κ)²/3)
beyond it, so that κ_y (1/√(3 - 2 m) - m) stays where m = M/M_y > 1. Its work on the unit load's moment x is the
deflection that stays: with s = √(3 - 2 m) at the root, κ_y (L/m)² (5/3 - 3 s/2 + s³/6 - m³/3).
"""

import numpy as np
import pytest
from lever_on_tie import lever_on_tie
from plastic_problems import YIELD, E, law
from scipy.integrate import quad
from solid_problems import Problem, even, graded, single

from alula.fea.check import deciding
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity
from alula.fea.judging import plastic_collapse
from alula.fea.links.fidelity import by_hand
from alula.fea.plastic import link_collapse
from alula.fea.plastic.link_collapse import collapse_of
from alula.fea.plastic.load_path import LoadPath, ProportionalLoad, follow, what_stays
from alula.fea.plastic.plastic_body import PlasticBody
from alula.fea.plastic.yield_law import YieldLaw

LENGTH, DEPTH, WIDTH = 80.0, 4.0, 1.0
MOMENT = YIELD * WIDTH * DEPTH**2 / 4.0
"""That a section bears [N mm]; 1.5 times that of first yield."""


def cantilever(yields: YieldLaw, along: int, across: int) -> tuple[LoadPath, ProportionalLoad]:
    """Half of a beam that bends evenly about its middle, under the force at its tip that its middle bears by theory."""
    mesh = single(
        graded(along, 8.0),
        even(across),
        even(1),
        lambda u, v, w: np.stack([LENGTH * u, DEPTH * (v - 0.5), WIDTH * w], axis=-1),
    )
    p = Problem(mesh=mesh, E=E, nu=0.0)
    p.fix(p.nodes_on("u0"), "x")
    p.fix(p.node_at(0.0, -DEPTH / 2.0, 0.0), "yz")
    p.fix(p.node_at(0.0, DEPTH / 2.0, 0.0), "z")
    for side, sign in (("u1", 1.0), ("u0", -1.0)):
        p.traction(side, (0.0, sign * MOMENT / LENGTH / (WIDTH * DEPTH), 0.0))
    body = PlasticBody.of(p.space, yields)
    load = ProportionalLoad(body, p.load, np.array(sorted(p.fixed)), threads=1)
    return follow(load), load


def even_law(strength: float = YIELD, hardening: tuple[tuple[float, float], ...] = ()) -> YieldLaw:
    return YieldLaw(E=E, nu=0.0, strength=strength, hardening=hardening)


def deflection(factor: float) -> float:
    """What stays of the cantilever [mm] by its formula, and by its curvature."""
    m, elastic = 1.5 * factor, 2.0 * YIELD / (E * DEPTH)
    s = np.sqrt(3.0 - 2.0 * m)
    formula = elastic * (LENGTH / m) ** 2 * (5.0 / 3.0 - 1.5 * s + s**3 / 6.0 - m**3 / 3.0)
    stays, _ = quad(lambda x: elastic * (1.0 / np.sqrt(3.0 - 2.0 * m * x) - m * x) * x * LENGTH**2, 1.0 / m, 1.0)
    assert formula == pytest.approx(stays, rel=1e-6)
    return formula


def test_a_cantilever_stays_bent_by_what_its_curvature_says():
    path, load = cantilever(even_law(), 24, 6)
    for factor in (0.8, 0.9, 0.95, 0.97):
        work, state = what_stays(load, path, factor)
        assert state.factor == factor
        assert work / (MOMENT / LENGTH) == pytest.approx(deflection(factor), rel=0.04)
    assert what_stays(load, path, path.states[0].factor) == (0.0, None)
    assert what_stays(load, path, 1.001 * path.low) == (np.inf, None)


def test_what_stays_is_found_close_to_the_limit_and_grows_up_to_it():
    path, load = cantilever(even_law(), 8, 2)
    works = [what_stays(load, path, factor * path.low)[0] for factor in (0.9, 0.99, 0.999, 1.0)]
    assert works == sorted(works)
    assert works[-1] == pytest.approx(load.work * (path.last.control - path.low))


@pytest.mark.parametrize("strength", [0.9, 1.1])
@pytest.mark.parametrize("hardening", [(), ((0.02, 1.3),)])
def test_a_strength_is_read_off_at_another_load(strength, hardening):
    """Exactly but for the strength itself where nothing hardens; else between that and without it."""
    path, load = cantilever(even_law(hardening=hardening), 8, 2)
    other_path, other = cantilever(even_law(strength * YIELD, hardening), 8, 2)
    at, _ = what_stays(load, path, 0.95 / strength)
    own, _ = what_stays(other, other_path, 0.95)
    if hardening:
        low, high = sorted([1.0, strength])
        assert low < own / at < high
    else:
        assert own == pytest.approx(strength * at, rel=1e-3)


def bar(force: float, area: float, length: float) -> float:
    """Work of a bar's force on what stays of its length [N mm], by its solid."""
    side = np.sqrt(area)
    mesh = single(even(2), even(1), even(1), lambda u, v, w: np.stack([length * u, side * v, side * w], axis=-1))
    p = Problem(mesh=mesh, E=E, nu=0.3)
    for side_name, axis in (("u0", "x"), ("v0", "y"), ("w0", "z")):
        p.fix(p.nodes_on(side_name), axis)
    p.traction("u1", (force / area, 0.0, 0.0))
    body = PlasticBody.of(p.space, law(hardening=HARDENS))
    load = ProportionalLoad(body, p.load, np.array(sorted(p.fixed)), threads=1)
    return what_stays(load, follow(load, largest_strain=HARDENS[-1][0]), 1.0)[0]


HARDENS = ((0.02, 1.2), (0.1, 1.5))


def stretched(force: float, area: float, length: float) -> float:
    """What stays of the length [mm], by the curve."""
    at, factors = zip((0.0, 1.0), *HARDENS, strict=True)
    return length * float(np.interp(force / area / YIELD, factors, at))


@pytest.mark.parametrize("direction", [-90.0, -75.0])
@pytest.mark.parametrize("stresses", [(1.1, 1.4), (1.4, 1.1), (0.9, 1.3)])
def test_a_force_on_two_ties_stays_displaced_by_what_geometry_says(stresses, direction):
    """Two ties hold a force: the joint goes to where both have the lengths that stay, in small displacements."""
    force, angles, lengths = 62.0, np.radians([60.0, 140.0]), np.array([70.0, 110.0])
    along = np.array([np.cos(np.radians(direction)), np.sin(np.radians(direction))])
    ties = np.array([np.cos(angles), np.sin(angles)]).T  # from the joint to the walls
    pulls = np.linalg.solve(ties.T, -force * along)
    assert pulls.min() > 0.0
    areas = pulls / (YIELD * np.array(stresses))
    longer = [stretched(*one) for one in zip(pulls, areas, lengths, strict=True)]
    assert max(longer) > 0.1
    moves = np.linalg.solve(-ties, longer)
    works = [bar(*one) for one in zip(pulls, areas, lengths, strict=True)]
    assert sum(works) / force == pytest.approx(float(moves @ along), rel=2e-3)


@pytest.mark.converged
def test_a_lever_on_a_tie_stays_where_the_shapes_of_its_links_put_it(monkeypatch):
    """Both links by their solids: where bores stay, as means of their nodes, and how both links then fit together."""
    force, fields = 260.0, []
    found = link_collapse._stays

    def kept(paths, *more):
        [(held, path)] = paths
        _, state = held.stays(path, 1.0)
        fields.append(held.displacement(state) - held.displacement(held.problem.elastic(1.0)))
        return found(paths, *more)

    def followed(link, law, loads, mesh, **more):
        one = collapse_of(link, law, loads, mesh, **more)
        fields[-1] = loads.link, one.nodes, fields[-1]
        return one

    def harden(tables):
        tables["materials"]["own"]["hardening_factors"] = [[0.05, 1.5]]
        tables["parts"]["tie"] |= {"width": "2.2 mm", "eye_diameter": "12 mm"}
        tables["load_cases"]["proof"]["forces"][0]["force"] = ["0 N", f"-{force} N"]
        del tables["load_cases"]["aside"]
        tables["solid"] = {"mesh_size": 3.0}

    monkeypatch.setattr(link_collapse, "_stays", kept)
    monkeypatch.setattr(plastic_collapse, "collapse_of", followed)
    monkeypatch.setattr(
        deciding, "decide", lambda tasks, beams, *more, **others: {x: by_hand(tasks[x], beams[x]) for x in tasks}
    )
    result = check_case(lever_on_tie(harden)).load_cases["proof"]
    [stays] = [one.value for one in result.checks if one.quantity is Quantity.PERMANENT_SET]
    (_, *lever), (_, *tie) = sorted(fields, key=lambda of: of[0])

    def bore(nodes, moved, x):
        return moved[np.abs(np.hypot(nodes[:, 0] - x, nodes[:, 1]) - 2.0) < 0.02].mean(axis=0)[:2]

    long = np.hypot(60.0, 120.0)
    longer = (bore(*tie, long) - bore(*tie, 0.0))[0]
    at_b, at_p = (bore(*lever, x) - bore(*lever, 0.0) for x in (100.0, 160.0))
    along = np.array([-60.0, 120.0]) / long  # the tie, from the lever to the wall
    turn = (-longer - at_b @ along) / (100.0 * along[1])
    assert stays.value == pytest.approx(-(at_p[1] + 160.0 * turn), rel=0.005)
    assert 0.5 < longer < 1.0
    assert stays.low < stays.value < stays.high < 1.02 * stays.value
