"""Plastic collapse of a link on two meshes: against what its eyes bear by beams, whole and by halves, after the
load."""

from dataclasses import replace
from functools import cache
from unittest.mock import Mock

import numpy as np
import pytest
import solid_meshes
from eye_case import eyes
from plastic_problems import NU, YIELD, E, eighth_in_tension, law, loaded

from alula.fea.check.run import check_case
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.block_matrix import SymmetricBlockMatrix
from alula.fea.elements.space import displacement_space, upper_half
from alula.fea.elements.supports import isostatic_supports
from alula.fea.plastic.link_collapse import (
    COARSER,
    LEAST_RATIO,
    LinkCollapse,
    _errors,
    _pressing,
    _ratio_in_flow,
    _stays,
    _two_meshes,
    collapse_of,
)
from alula.fea.plastic.load_path import NoPlasticStateError, ProportionalLoad, follow
from alula.fea.plastic.pin_contact import PinContact
from alula.fea.plastic.plastic_body import PlasticBody
from alula.fea.refine.link_task import ElasticLink
from alula.fea.tractions.link_tractions import LinkTractions
from alula.fea.tractions.pin_pressure import PinPressure
from alula.fea.tractions.traction import TRANSFERS
from alula.geometry.base.errors import CannotRunError
from alula.geometry.meshing.mirror import mirrored
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.records.bearing import WIDE

HOLE, WIDTH, HEIGHT, LENGTH = 1.5, 5.0, 3.0, 20.0
NET = (WIDTH - 2.0 * HOLE) * HEIGHT * YIELD
"""[N] that the net section of an eye bears."""
LINK = ElasticLink(body=None, E=E, nu=NU, density=1.4e-9, line=("bore:A", "bore:B"), brittle=False)


def pull(force: float) -> LinkLoads:
    pins = (("A", 0.0, -force), ("B", LENGTH, force))
    return LinkLoads(
        name="pull",
        pins=tuple(
            PinLoad(
                name=name, centre=np.array([x, 0.0, 0.0]), diameter=2.0 * HOLE, wrench=np.array([f, 0, 0, 0, 0, 0.0])
            )
            for name, x, f in pins
        ),
    )


@cache
def mesh(coarser: float) -> TaggedMesh:
    radial = 2 if coarser == 1.0 else 1
    half = solid_meshes.half_bar(
        hole=HOLE, half_width=WIDTH / 2.0, length=LENGTH, around=12, radial=radial, along=radial, layers=1
    )
    return mirrored(half)


ENDS = (0.9, 1.02)
"""Of the load for which is sought what stays after it."""


@cache
def collapse(force: float) -> LinkCollapse:
    return collapse_of(LINK, law(), pull(force), mesh, factors=ENDS, threads=1)


def ring_bears() -> float:
    """Share of the net section that the ring about a bore bears by beams: the best of its redundant force and moment.

    A lower bound by statics. From the crown, with hoop force n and moment m, to the net section, under the pressure q
    cos φ over 180°; walls of the square eye by their thickness w and centroid c, each with (N/Np)² + (V/Vp)² + |M|/Mp
    <= 1.
    """
    angle = np.linspace(0.0, np.pi / 2.0, 181)
    along, across = np.cos(angle), np.sin(angle)
    wall = WIDTH / 2.0 / np.maximum(along, across) - HOLE
    radius = HOLE + wall / 2.0
    push = NET * 2.0 / np.pi * along * np.array([along, across])
    steps = (push[:, 1:] + push[:, :-1]) / 2.0 * angle[1]
    pushed = np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)
    at = radius * np.array([along, across])
    area, best = wall * HEIGHT, 0.0
    for n in np.linspace(0.2, 0.8, 61) * NET:
        for m in np.linspace(-0.5, 0.5, 41) * NET:
            x, y = pushed[0], pushed[1] - n
            hoop, shear = across * x - along * y, along * x + across * y
            # the pressure goes through the middle of the bore, the crown's hoop force through its centroid
            moment = m - (at[0, 0] * n) - (at[0] * y - at[1] * x)
            square = (hoop / (area * YIELD)) ** 2 + (shear / (area * YIELD / np.sqrt(3.0))) ** 2
            linear = np.abs(moment) / (YIELD * HEIGHT * wall**2 / 4.0)
            # λ² square + λ linear = 1
            best = max(best, float((2.0 / (linear + np.sqrt(linear**2 + 4.0 * square))).min()))
    return best


def test_an_eye_bears_what_its_ring_bears_and_at_most_its_net_section():
    found = collapse(NET)
    assert found.ended == "limit"
    assert found.low <= found.factor <= found.high
    assert found.factor <= 1.0
    assert ring_bears() * 0.98 < found.factor
    assert found.solves < 120
    flowed = found.nodes[found.zone > 0.0]
    assert np.minimum(np.abs(flowed[:, 0]), np.abs(flowed[:, 0] - LENGTH)).max() < WIDTH
    assert 0.01 < found.plastic_share < 0.6
    about = [np.hypot(found.nodes[:, 0] - x, found.nodes[:, 1]) < 1.01 * HOLE for x in (0.0, LENGTH)]
    near, far = (found.shape[bore, 0].mean() for bore in about)
    assert abs(near) < 0.05 * far
    assert far > NET / E  # it is drawn out


COARSE = displacement_space(mesh(1.6))


def touching() -> PinContact:
    """The walls of both pins, on the coarser mesh."""
    pose = pull(NET).chosen(None)
    found = LinkTractions.of(COARSE, [pose], density=LINK.density).loads
    bores = [(one.wall.bore, replace(one.wall.pin, wrench=one.wrench(pose))) for one in found]
    return PinContact.of(bores, len(COARSE.nodes), E)


def test_contact_of_pins_is_the_slope_of_an_energy():
    """Its forces balance and push alone; its stiffness is their slope; half of it on the half of a body."""
    contact, by = touching(), np.random.default_rng(1)
    count, pins = 3 * (int(contact.nodes.max()) + 1), contact.forces.size
    x, step = by.normal(0.0, 0.1, count + pins), by.normal(0.0, 1e-7, count + pins)

    def forces(x):
        return np.concatenate(contact.resist(x[:count], x[count:]))

    body, moved = contact.resist(x[:count], x[count:])
    push = -body.reshape(-1, 3)[contact.nodes]
    assert (push * contact.normals).sum(axis=1).min() >= 0.0
    assert body.reshape(-1, 3)[:, :2].sum(axis=0) == pytest.approx(-moved.reshape(-1, 2).sum(axis=0))
    K = SymmetricBlockMatrix(
        indptr=np.arange(count // 3 + 1, dtype=np.int32),
        indices=np.arange(count // 3, dtype=np.int32),
        blocks=np.zeros((count // 3, 3, 3)),
    )
    coupled, own = contact.stiffen(K, contact.overlap(x[:count], x[count:]) > 0.0, np.ones(count, dtype=bool))
    slope = np.concatenate([K @ step[:count] + coupled @ step[count:], coupled.T @ step[:count] + own @ step[count:]])
    assert forces(x + step) - forces(x) == pytest.approx(slope, rel=1e-6, abs=1e-9 * np.abs(slope).max())
    half = upper_half(COARSE)
    assert contact.upper(half).stiffness.sum() == pytest.approx(contact.stiffness.sum() / 2.0)
    assert 2.0 * contact.upper(half).forces == pytest.approx(contact.forces)


def test_pins_in_contact_bear_their_force_and_the_link_more():
    """By the static theorem no pressure that is given bears more; the upper end of the band is that of contact."""
    body, fixed = PlasticBody.of(COARSE, law()), isostatic_supports(COARSE.nodes, COARSE.corners)
    load = ProportionalLoad(body, np.zeros(COARSE.unknowns), fixed, contact=touching(), threads=1)
    for state in (load.elastic(load.first_yield), load.led(load.elastic(load.first_yield), 2.0 * load.first_yield)):
        _, pins = load.contact.resist(load.of_body(state.displacement), state.displacement[COARSE.unknowns :])
        assert pins == pytest.approx(state.factor * load.contact.forces.ravel(), abs=1e-4 * state.factor * NET)
    found = collapse(NET)
    assert found.pressure > 1.05
    assert found.high > found.factor * found.pressure


def test_a_pin_whose_force_is_rounding_is_no_plug_of_its_hole():
    """A third pin has 1e-14 N; with 0 N it would be none."""
    pose = pull(NET).chosen(None)
    pins = [Mock(spec=PinPressure, wrench=lambda _, f=f: np.array([[f, 0, 0, 0, 0, 0.0]])) for f in (1e-14, NET, -NET)]
    assert _pressing(Mock(loads=pins), pose) == pins[1:]


def test_a_pin_that_touches_nowhere_has_no_state():
    contact = touching()
    body, fixed = PlasticBody.of(COARSE, law()), isostatic_supports(COARSE.nodes, COARSE.corners)
    load = ProportionalLoad(body, np.zeros(COARSE.unknowns), fixed, contact=contact, threads=1)
    with pytest.raises(NoPlasticStateError, match="not held by the walls"):
        load._solved(load._elastic, contact.pins == 0, load.load)


def test_sizes_count_where_it_flows():
    """Edges 1.4 times as long about an eye, 1 times along the shank, 3 times at the other eye, where 1.6 was asked."""
    places, flows = (0.0, 10.0, 20.0), np.array([2.0, 0.0, 0.0])

    def body(*edges):
        corners = np.concatenate([[x, 0.0, 0.0] + edge * np.eye(4, 3) for x, edge in zip(places, edges, strict=True)])
        space = Mock(cells=np.arange(12).reshape(3, 4), nodes=corners)
        return Mock(space=space, weights=np.repeat(np.array(edges) ** 3 / 24.0, 4))

    def ratio(*strain):
        state = Mock()
        state.response.past.equivalent = np.repeat(strain, 4)
        return _ratio_in_flow(body(1.0, 3.0, 1.0), state, body(1.4, 3.0, 3.0))

    assert ratio(*flows) == pytest.approx(1.4)
    assert ratio(*flows[[1, 0, 2]]) == LEAST_RATIO
    assert ratio(*flows[::-1]) == COARSER
    assert ratio(27.0, 0.5, 0.0) == pytest.approx((27.0 * 1.4 + 0.5 * 27.0 * 3.0) / (27.0 + 0.5 * 27.0 * 3.0))


@pytest.mark.parametrize("bound", [1.6, 1.0, 0.6, 0.4, 0.1])
def test_meshes_get_finer_until_they_differ(bound):
    """Six elements on a turn bind a thin tube until edges of ``bound`` are asked for."""

    def space(coarser):
        return Mock(cells=range(round(1e4 * min(coarser, bound) ** -3)))

    if bound == 0.1:
        with pytest.raises(CannotRunError, match="alike"):
            _two_meshes(space)
        return
    fine, coarse = (len(one.cells) ** (-1.0 / 3.0) for one in _two_meshes(space))
    assert LEAST_RATIO <= coarse / fine <= 1.001 * COARSER


@pytest.mark.parametrize("earlier", [0.99, 1.01, 2.5])
def test_paths_on_two_meshes_have_the_same_states(earlier):
    """Beyond first yield, however that differs; else the longer step would tell of itself, not of the mesh."""
    alone = follow(loaded(eighth_in_tension(amount=0.1)))
    like = replace(alone, states=tuple(replace(one, control=earlier * one.control) for one in alone.states))
    found = follow(loaded(eighth_in_tension(amount=0.1)), like=like)
    wanted = [one.control for one in like.states if one.control > found.states[0].control]
    assert [one.control for one in found.states[1:]][-len(wanted) :] == pytest.approx(wanted)


def test_the_first_yield_is_a_lower_bound_of_what_a_path_finds():
    """Where a check takes a safety factor for a collapse factor, no path followed instead finds less."""
    space = displacement_space(mesh(1.0))
    pose = pull(NET).chosen(None)
    [variant] = LinkTractions.of(space, [pose], density=LINK.density).variants(pose, (WIDE,), TRANSFERS)
    fixed = isostatic_supports(space.nodes, space.corners)
    load = ProportionalLoad(PlasticBody.of(space, law()), variant.load, fixed, threads=1)
    before = load.elastic(0.999 * load.first_yield)
    assert before.plastic_strain == 0.0
    assert load.loaded(before, 1.05 * load.first_yield).plastic_strain > 0.0
    assert load.first_yield < collapse(NET).low


def test_without_a_state_in_contact_the_narrower_pressure_stands_in(monkeypatch):
    monkeypatch.setattr(PinContact, "of", Mock(side_effect=NoPlasticStateError("no elastic contact")))
    lost = collapse_of(LINK, law(), pull(NET), mesh, threads=1)
    assert (lost.factor, lost.low) == pytest.approx((collapse(NET).factor, collapse(NET).low))
    assert lost.pressure == pytest.approx(1.36, abs=0.15)


@pytest.mark.converged
@pytest.mark.parametrize(("eye", "width", "ratio"), [(12.0, 8.0, 1.040), (8.0, 5.0, 1.360)])
def test_contact_against_limit_analysis(eye, width, ratio):
    """Eyes about pins of 5 mm: what they bear in contact over that under a cosine, by benchmarks/eye_limits.py."""

    def sized(tables):
        tables["parts"]["bar"] |= {"eye_diameter": f"{eye} mm", "width": f"{width} mm", "fillet_radius": "0.5 mm"}
        tables["checks"] = {"collapse": {"type": "plastic-collapse", "minimum": 1.0, "links": ["level"]}}

    found = check_case(eyes(sized), fidelity="solid").load_cases["pull"].of_links(LinkCollapse)["level"]
    assert found.pressure == pytest.approx(ratio, abs=0.05)


def test_half_a_body_collapses_as_the_whole():
    whole = collapse_of(LINK, law(), pull(NET), lambda coarser: replace(mesh(coarser), mirror=None), threads=1)
    assert whole.factor == pytest.approx(collapse(NET).factor, rel=1e-3)


def test_what_stays_after_the_load():
    """The factor goes with the load; a link that does not bear its load leaves nothing to tell."""
    much, over = collapse(0.7 * NET), collapse(NET)
    assert 0.7 * much.factor == pytest.approx(over.factor, rel=1e-3)
    assert much.strain > 1e-3
    assert 1e-3 * HOLE < much.residual < 0.2 * HOLE
    assert over.strain is None
    assert over.residual is None
    value, low, high = (work / (0.7 * NET) for work in much.stays)
    assert low < value < high
    assert value == pytest.approx(much.residual, rel=0.05)  # the far bore moves along the bar alone
    assert 0.0 <= much.regained < 0.01
    assert (over.stays[0], over.stays[2]) == (np.inf, np.inf)
    assert 0.0 < over.stays[1] < np.inf


def test_each_end_of_what_stays_is_read_at_a_load_of_its_own():
    """Of two ways in which a torque may enter: those of load, mesh and pins; where the path ends below one, no end."""
    ways = [(Mock(stays=lambda path, factor, by=by: (by * factor, None)), Mock(low=2.0, high=2.1)) for by in (3.0, 4.0)]
    for found in (ways, ways[::-1]):
        assert _stays(found, (0.8, 1.2), [(1.0, 0.0), (1.5, 0.1), (2.0, 0.2)], 1.25, 0.05) == (
            pytest.approx((4.0, 3.0 * 0.8 / 1.25 / 1.05, 4.0 * 1.2 / 0.9 * 1.05)),
            0.0,
        )
        (_, low, high), _ = _stays(found, (2.2, 1.9), [(1.0, 0.0), (2.0, 0.1)], 1.0, 0.0)
        assert low == pytest.approx(3.0 * 2.0)  # between what the path bears for sure and what it may bear
        assert high == np.inf
    assert _stays(ways, (2.5, 3.0), [(1.0, 0.0), (2.0, 0.1)], 1.0, 0.0)[0][1] == np.inf


def test_what_flow_takes_back_lowers_the_low_end_alone():
    held = Mock(stays=lambda path, factor: (4.0 * factor, "loaded"), work=8.0)
    held.problem.loaded = lambda state, factor: Mock(control=0.45 if (state, factor) == ("loaded", 0.0) else np.nan)
    works, back = _stays([(held, Mock(low=2.0, high=2.0))], (0.5, 1.5), [(2.0, 0.0)], 1.0, 0.0)
    assert (works, back) == (pytest.approx((4.0, 0.9 * 2.0, 6.0)), pytest.approx(0.1))


def test_errors_of_the_load_are_those_of_two_meshes_in_the_same_states():
    """Where one has not flowed; they never fall along the path."""
    path = Mock(states=[Mock(factor=f, control=c) for f, c in ((1.0, 1.0), (1.5, 2.0), (1.8, 4.0))])
    coarse = Mock(factor_at=lambda other, control: {1.0: 1.0, 2.0: 1.65, 4.0: 1.89}[control])
    assert _errors(path, coarse, path, 0.5) == [(1.0, 0.0), pytest.approx((1.5, 0.25)), pytest.approx((1.8, 0.25))]


def test_a_path_without_time_gives_no_factor():
    with pytest.raises(NoPlasticStateError, match="time limit"):
        collapse_of(LINK, law(), pull(NET), mesh, until=0.0)
    begun = loaded(eighth_in_tension())
    begun.until = 0.0
    with pytest.raises(NoPlasticStateError, match="time limit"):
        follow(begun)
