"""The plastic law: its tangent, uniaxial curves, the patch test, and the order in which Newton's method converges."""

import itertools

import numpy as np
import plastic_problems
import pytest
import solid_meshes
from plastic_problems import YIELD, E, law, loaded

from alula.fea.elements.space import displacement_space
from alula.fea.plastic.load_path import TOLERANCE, follow, unloaded_share
from alula.fea.plastic.plastic_body import PlasticBody
from alula.fea.plastic.yield_law import Past

CURVE = ((0.01, 1.2), (0.05, 1.5))
LAWS = {
    "von Mises": {},
    "von Mises, hardening": {"hardening": CURVE},
    "Raghava": {"compression": 1.3},
    "Raghava, hardening": {"compression": 1.3, "hardening": CURVE},
}


@pytest.fixture(params=LAWS)
def yields(request):
    return law(**LAWS[request.param])


def test_stress_lies_on_the_yield_surface_and_the_tangent_is_its_derivative(yields):
    draw = np.random.default_rng(0)
    past = yields.respond(0.02 * draw.normal(size=(100, 6)), Past.none(100)).past
    strain = 0.04 * draw.normal(size=(100, 6))
    found = yields.respond(strain, past)
    assert found.plastic.mean() > 0.8
    over = yields.share(found.stress) * YIELD / yields.yield_stress(found.past.equivalent)
    np.testing.assert_allclose(over[found.plastic], 1.0, atol=1e-12)
    assert over.max() <= 1.0 + 1e-12
    small = 1e-6 * np.eye(6)
    ends = [[yields.respond(strain + sign * d, past).stress for sign in (1, -1)] for d in small]
    derivative = np.stack([(one - other) / 2e-6 for one, other in ends], axis=2)
    np.testing.assert_allclose(found.tangent, derivative, atol=1e-5 * E)
    np.testing.assert_allclose(found.tangent, found.tangent.transpose(0, 2, 1), atol=1e-9 * E)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_tension_and_a_compression_test_give_the_card_back(sign):
    """Pulled or pushed to a plastic strain of 3 % in small steps, sideways free."""
    yields, past, strain = law(compression=1.3, hardening=CURVE), Past.none(1), np.zeros((1, 6))
    for axial in np.linspace(0.0, sign * 0.045, 10):
        strain[0, 0] = axial
        for _ in range(12):  # sideways stress to nothing, by Newton's method
            found = yields.respond(strain, past)
            strain[0, 1:] -= np.linalg.solve(found.tangent[0, 1:, 1:], found.stress[0, 1:])
        past = yields.respond(strain, past).past
    stress = found.stress[0, 0]
    plastic = abs(axial - stress / E)
    if sign > 0.0:  # the equivalent plastic strain is that of this test
        assert past.equivalent[0] == pytest.approx(plastic, rel=1e-9)
        assert stress == pytest.approx(YIELD * np.interp(plastic, [0.01, 0.05], [1.2, 1.5]), rel=1e-9)
    else:
        assert -stress == pytest.approx(1.3 * float(yields.yield_stress(past.equivalent)[0]), rel=1e-9)


def test_an_even_stress_is_found_exactly_in_distorted_elements():
    """Patch test: a bilinear bar in tension, at 1.25 of its yield load, and back."""
    p = plastic_problems.eighth_in_tension(amount=0.05)
    load = loaded(p, law(hardening=((0.1, 2.0),)))
    assert load.first_yield == pytest.approx(YIELD)
    state = load.loaded(load.elastic(YIELD), 1.25 * YIELD)
    strain = 0.25 * 0.1
    assert state.plastic_strain == pytest.approx(strain, rel=1e-4)
    end = p.nodes_on("end:1")
    np.testing.assert_allclose(state.displacement[3 * end], 2.0 * (1.25 * YIELD / E + strain), rtol=1e-4)
    np.testing.assert_allclose(state.response.stress[:, 0], 1.25 * YIELD, rtol=1e-3)
    rest = load.loaded(state, 0.0)
    np.testing.assert_allclose(rest.displacement[3 * end], 2.0 * strain, rtol=1e-4)
    more = load.loaded(state, 1.3 * YIELD)
    assert unloaded_share(load.body, state.response, more.response) == 0.0
    assert unloaded_share(load.body, state.response, rest.response) == pytest.approx(1.0)


def test_newton_converges_quadratically():
    """Each residual of a bent tube is, at the end, about the square of the one before."""
    load = loaded(plastic_problems.bent(0.5, 1.0, radial=1, along=2))
    states = follow(load).states
    pairs = [pair for state in states[1:] for pair in itertools.pairwise(state.residuals)]
    near = [(one, two) for one, two in pairs if one < 0.02]
    assert len(near) > 2
    order = np.median([np.log(two) / np.log(one) for one, two in near])
    assert order > 1.6
    assert max(state.residuals[-1] for state in states[1:]) <= TOLERANCE


def test_the_tangent_stiffness_is_the_derivative_of_the_forces():
    space = displacement_space(solid_meshes.box(counts=(1, 1, 1), amount=0.05, curved=True))
    body = PlasticBody.of(space, law(compression=1.2))
    u = 0.05 * np.random.default_rng(1).normal(size=space.unknowns)
    found = body.respond(u, Past.none(body.points))
    assert found.plastic.any()
    K, d = body.stiffness(found.tangent), np.random.default_rng(2).normal(size=space.unknowns)

    def forces(at):
        return body.forces(body.respond(at, Past.none(body.points), tangent=False).stress)

    expected = (forces(u + 1e-7 * d) - forces(u - 1e-7 * d)) / 2e-7
    np.testing.assert_allclose(K @ d, expected, atol=1e-5 * np.abs(expected).max())
