import dataclasses

import numpy as np
import pytest
import solid_meshes

from alula.fea.elements.space import displacement_space
from alula.fea.refine.refinement import START
from alula.fea.refine.target_sizes import (
    GROWTH,
    MOST_RATIO,
    SERIES_RATIO,
    LocalGoal,
    element_sizes,
    next_sizes,
    reduction,
)
from alula.geometry.meshing.mesh import mesh_body
from alula.geometry.meshing.mirror import mirrored
from alula.geometry.parts.part import Bar, Body, Pin


@pytest.fixture(scope="module")
def space():
    return displacement_space(solid_meshes.box(upper=(4.0, 1.0, 1.0), counts=(12, 3, 3)))


def goal(space, estimate, value=10.0):
    count = len(space.cells)
    return LocalGoal(
        location=np.zeros(3), value=value, stress=np.zeros(count), estimate=np.full(count, estimate), allowed=0.05
    )


def test_element_size_is_the_mean_edge():
    space = displacement_space(solid_meshes.box(upper=(1.0, 1.0, 1.0), counts=(1, 1, 1)))
    # Kuhn's tetrahedra of the unit cube: three edges of 1, two of √2, one of √3.
    assert element_sizes(space) == pytest.approx((3.0 + 2.0 * np.sqrt(2.0) + np.sqrt(3.0)) / 6.0)


def test_equal_errors_within_the_aim_leave_sizes_alone():
    assert reduction(np.full(8, 0.01), 1.0, 0.05, 2.0) == pytest.approx(1.0)


def test_error_is_spread_evenly():
    # Two elements, ‖u‖ = 10, η = 0.1: each may hold 0.1 √((100 + 0.25 + 1.44)/2) = 0.7130.
    found = reduction(np.array([0.5, 1.2]), 10.0, 0.1, 2.0)
    assert found == pytest.approx([1.0, np.sqrt(1.2 / (0.1 * np.sqrt(101.69 / 2.0)))])


def test_singular_exponent_refines_more():
    energy = np.array([0.5, 0.8])
    smooth, sharp = (reduction(energy, 10.0, 0.1, exponent)[1] for exponent in (2.0, np.array([2.0, 0.544])))
    assert smooth == pytest.approx(sharp ** (0.544 / 2.0))
    assert sharp > smooth > 1.0


def test_no_stress_no_refinement():
    assert reduction(np.zeros(3), 0.0, 0.1, 2.0) == pytest.approx(1.0)


def test_the_next_mesh_is_finer_at_the_peak_and_nowhere_coarser(space):
    points, sizes = next_sizes(space, [], [goal(space, 0.0)])
    old = element_sizes(space)
    nearest = int(np.argmin(np.linalg.norm(points, axis=1)))
    assert sizes[nearest] == pytest.approx(old.min() / SERIES_RATIO, rel=0.2)
    assert sizes.max() <= old.max() * (1.0 + 1e-3)
    assert sizes[points[:, 0] > 3.5].min() > 0.95 * old.min()


def test_a_mesh_made_of_the_sizes_of_another_has_as_many_elements():
    sizes = {"width": 8.0, "thickness": 4.0, "eye_diameter": 12.0, "eye_thickness": 4.0, "fillet_radius": 2.0}
    part = Bar.model_validate({"shape": "bar", "material": "m"} | {name: f"{v} mm" for name, v in sizes.items()})
    pins = tuple(Pin(name=name, x=x, y=0.0, diameter=3.0) for name, x in (("A", 0.0), ("B", 30.0)))
    body = Body(part=part, pins=pins, ends=(), holes=())
    first = mesh_body(body, START)
    points, found = next_sizes(displacement_space(first), [], [])
    again = mesh_body(body, dataclasses.replace(START, size_points=points, size_values=found))
    assert 0.85 < len(again.cells) / len(first.cells) < 1.15


def test_an_element_that_may_hold_the_peak_is_refined_wherever_it_is(space):
    with_goal = goal(space, 0.0)
    far = int(np.argmax(space.nodes[space.cells[:, :4]].mean(axis=1)[:, 0]))
    with_goal.stress[far], with_goal.estimate[far] = 9.5, 5.0
    _, sizes = next_sizes(space, [], [with_goal])
    assert sizes[space.cells[far, :4]] == pytest.approx(element_sizes(space)[far] / MOST_RATIO, rel=1e-3)


def test_sizes_grow_slowly(space):
    points, sizes = next_sizes(space, [], [goal(space, 0.0)])
    edges = np.unique(
        np.sort(np.concatenate([space.cells[:, [a, b]] for a in range(4) for b in range(a)]), axis=1), axis=0
    )
    length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    assert (np.abs(sizes[edges[:, 0]] - sizes[edges[:, 1]]) <= GROWTH * length * (1.0 + 1e-6)).all()


def test_a_mesh_of_two_halves_becomes_finer_in_both():
    space = displacement_space(mirrored(solid_meshes.half_bar()))
    peak = dataclasses.replace(goal(space, 0.0), location=np.array([0.75, 0.0, 1.5]))
    points, sizes = next_sizes(space, [], [peak])
    above, below = (int(np.argmin(np.linalg.norm(points - (0.75, 0.0, z), axis=1))) for z in (1.5, -1.5))
    assert sizes[above] == sizes[below] < 0.8 * element_sizes(space)[(space.cells == below).any(axis=1)].mean()


def test_rounding_of_the_estimate_leaves_the_sizes_as_they_are(space):
    factors = np.linspace(1.0, 1.4, len(space.cells))
    noise = 1.0 + 1e-13 * np.sin(np.arange(len(factors)))
    sizes, disturbed = (next_sizes(space, [f], [goal(space, 0.01)])[1] for f in (factors, factors * noise))
    assert np.array_equal(sizes, disturbed)
