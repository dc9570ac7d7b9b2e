"""A link condensed to its pins: beams by closed form, and pins by virtual work."""

import numpy as np
import pytest
import solid_meshes

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.space import displacement_space
from alula.fea.solid.condensation import condense
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.virtual_work import virtual_work
from alula.geometry.meshing.mirror import mirrored
from alula.geometry.parts.part import Bar, Body, Pin
from alula.loads.records.applied import LineLoad

E, NU = 2900.0, 0.38
LENGTH, WIDE, THICK = 160.0, 5.0, 3.0


def bar_of(length):
    part = Bar.model_construct(width=WIDE, thickness=THICK, eye_diameter=WIDE, eye_thickness=THICK, fillet_radius=0.0)
    pins = tuple(Pin(name=name, x=x, y=0.0, diameter=1.5) for name, x in (("A", 0.0), ("B", length)))
    return Body(part=part, pins=pins, ends=(), holes=())


def pulled(length, force_x=0.0, lines=()):
    places = (("A", 0.0, -force_x), ("B", length, force_x))
    pins = tuple(
        PinLoad(name=n, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=np.array([f, 0, 0, 0, 0, 0]))
        for n, x, f in places
    )
    return LinkLoads(name="one", pins=pins, lines=lines)


@pytest.fixture(scope="module")
def slender():
    """A slender bar under an even load across, in the link's axes."""
    space = displacement_space(mirrored(solid_meshes.half_bar(length=LENGTH, along=32, layers=1)))
    q = np.array([0.0, -0.5, 0.0])
    spread = pulled(LENGTH, lines=(LineLoad(link="bar", start=0.0, end=LENGTH, at_start=q, at_end=q),))
    return condense(space, bar_of(LENGTH), [spread], E=E, nu=NU, density=1e-9)


def test_a_slender_bar_gives_between_its_pins_as_a_beam_does(slender):
    """Cantilever from A under forces and moments at B: L/(EA), L³/(3EI), L²/(2EI), L/(EI), and how bores turn.

    A moment in the plane shears the ring about a bore, which turns by M/(4πG t) (1/r² - 1/R²) as τ = M/(2π r² t). Out
    of the plane moments enter through bores as long as the bar is thick, which give as some 4 mm of the bar: 8 %.
    """
    balanced = np.zeros((12, 6))
    balanced[6:] = np.eye(6)
    balanced[:6] = -np.eye(6)
    balanced[5, 1], balanced[4, 2] = -LENGTH, LENGTH  # the moment of a force at B about A
    found = balanced.T @ slender.flexibility @ balanced
    ring = (1.0 / 0.75**2 - 1.0 / (WIDE / 2.0) ** 2) / (4.0 * np.pi * E / (2.0 + 2.0 * NU) * THICK)
    stiff, across = E * THICK * WIDE**3 / 12.0, E * WIDE * THICK**3 / 12.0
    assert found[0, 0] == pytest.approx(LENGTH / (E * WIDE * THICK), rel=0.02)
    assert found[5, 5] == pytest.approx(LENGTH / stiff + 2.0 * ring, rel=0.01)
    assert found[1, 5] == pytest.approx(LENGTH**2 / (2.0 * stiff) + LENGTH * ring, rel=0.01)
    assert found[1, 1] == pytest.approx(LENGTH**3 / (3.0 * stiff) + LENGTH**2 * ring, rel=0.01)
    assert found[2, 2] == pytest.approx(LENGTH**3 / (3.0 * across), rel=0.08)
    assert found[2, 4] == pytest.approx(-(LENGTH**2) / (2.0 * across), rel=0.08)


def test_spread_loads_turn_the_ends_of_a_supported_bar_as_a_beam(slender):
    """Both bores of a simply supported bar under an even load turn by q L³/(24 E I), against each other."""
    turned = np.zeros(12)
    turned[[5, 11]] = -1.0, 1.0
    inertia = THICK * WIDE**3 / 12.0
    # Forces of the supports are balanced wrenches beside those that balance the load at the places: by symmetry none.
    assert turned @ slender.moved["one"] == pytest.approx(0.5 * LENGTH**3 / (12.0 * E * inertia), rel=0.02)


@pytest.mark.parametrize("size", [3.0, -3.0])
def test_pins_give_along_their_forces_as_virtual_work_has_it(size):
    """The same mesh under cosine pressure: the mean motions of the bores, and what sinks at the most."""
    mesh, body = mirrored(solid_meshes.half_bar(layers=1)), bar_of(20.0)
    loads = pulled(20.0, size)
    solved = solve_solid(mesh, E=E, nu=NU, density=1e-9, loads=[loads], line=("bore:A", "bore:B"), threads=1)
    (expected,) = virtual_work(solved, loads, [loads], transfer="eye-faces", error=0.0)
    solid = condense(displacement_space(mesh), body, [loads], E=E, nu=NU, density=1e-9)
    wrenches = np.concatenate([pin.wrench for pin in loads.pins])
    gives = [solid.give(pin.name, pin.wrench[:2]) for pin in loads.pins]
    plain = float(wrenches @ solid.flexibility @ wrenches)
    wide, narrow = (plain + size**2 * sum(getattr(give, law) for give in gives) for law in ("value", "narrow"))
    assert wide == pytest.approx(expected.mean.value, rel=1e-6)
    assert sorted((wide, narrow)) == pytest.approx([expected.mean.low, expected.mean.high], rel=1e-6)
    assert plain + size**2 * sum(give.sunk for give in gives) == pytest.approx(expected.sunk.high, rel=2e-3)
