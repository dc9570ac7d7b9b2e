"""A slotted bar in bending as a solid: against the hand calculation of its flanks, and over the length of the push.

Three-point bending of a bar 80 mm long, whose middle pin of 4 mm stands in a slot 16 mm longer than wide with flanks
2 mm high, in its middle or 5 mm beside.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.deflection import deflection
from alula.fea.beam.details import Detail, details, net_section
from alula.fea.beam.flanks import flanks_of
from alula.fea.beam.theory import BeamCheck, check_beam
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.solid.solution import SolidSolution, solve_solid
from alula.fea.solid.stress import StressField, stress_field
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.geometry.parts.part import Bar, Body, Pin
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw
from alula.reports.sentences import told

E, NU, FORCE, SLOT, WIDTH, EYE, T = 2000.0, 0.38, 10.0, 16.0, 4.0, 8.0, 4.0
PART = Bar(
    shape="bar",
    material="any",
    width="6 mm",
    thickness=f"{T} mm",
    eye_diameter=f"{EYE} mm",
    eye_thickness=f"{T} mm",
    fillet_radius="1 mm",
)
BODY = Body(
    part=PART,
    pins=(
        Pin(name="A", x=0.0, y=0.0, diameter=3.0),
        Pin(name="S", x=40.0, y=0.0, diameter=WIDTH, slot=SLOT),
        Pin(name="B", x=80.0, y=0.0, diameter=3.0),
    ),
    ends=(),
    holes=(),
)
PLACES = (40.0, 45.0)


@dataclass(frozen=True, kw_only=True)
class Eighth(PressureLaw):
    """A push half as long as that of the narrow law."""

    def patch(self, pin_diameter: float) -> float:
        return pin_diameter / 8.0


def bent(x: float) -> LinkLoads:
    def pin(name: str, at: float, force: float, diameter: float) -> PinLoad:
        wrench = np.array([0.0, force, 0.0, 0.0, 0.0, 0.0])
        return PinLoad(
            name=name, centre=np.array([at, 0.0, 0.0]), diameter=diameter, wrench=wrench, slotted=name == "S"
        )

    held = -FORCE * (80.0 - x) / 80.0, -FORCE * x / 80.0
    return LinkLoads(
        name=f"{x:g}", pins=(pin("A", 0.0, held[0], 3.0), pin("S", x, FORCE, WIDTH), pin("B", 80.0, held[1], 3.0))
    )


@pytest.fixture(scope="module")
def solutions() -> list[tuple[PressureLaw, SolidSolution]]:
    mesh = mesh_body(BODY, MeshSettings().scaled(1.25))
    return [
        (
            law,
            solve_solid(
                mesh, E=E, nu=NU, density=1e-9, loads=[bent(x) for x in PLACES], line=("bore:A", "bore:B"), laws=[law],
                threads=1,
            ),
        )
        for law in (WIDE, NARROW, Eighth(span=90))
    ]  # fmt: skip


@pytest.fixture(scope="module")
def solved(solutions) -> dict[tuple[str, type[PressureLaw], int], StressField]:
    found = {}
    for law, solution in solutions:
        for case in solution.cases:
            assert case.reaction < 1e-6
            assert case.imbalance < 1e-9
            found[case.load, type(law), law.span] = stress_field(solution.space, case.displacement, E=E, nu=NU)
    return found


def by_hand(x: float) -> tuple[BeamCheck, Detail]:
    loads = bent(x)
    beam = check_beam(beam_loads(loads, BODY, 1e-9), PART.section, 1.0)
    (found,) = details(BODY, loads, beam.forces)
    return beam, found


def along(field: StressField, *, x: float, y: float) -> float:
    """Mean over the thickness of the stress along x at a fibre."""
    nodes = field.space.nodes[: len(field.nodal)]
    near = (np.abs(nodes[:, 0] - x) < 0.4) & (np.abs(nodes[:, 1] - y) < 1e-3)
    return float(field.nodal[near, 0].mean())


def tension_at_slot(field: StressField) -> float:
    """Largest stress along x on the straight flanks."""
    nodes = field.space.nodes[: len(field.nodal)]
    return float(field.nodal[np.abs(nodes[:, 0] - 40.0) < SLOT / 2.0, 0].max())


@pytest.mark.parametrize("x", PLACES)
def test_the_largest_tension_is_that_of_the_hand_calculation(solved, x: float) -> None:
    _, found = by_hand(x)
    assert tension_at_slot(solved[f"{x:g}", PressureLaw, 90]) == pytest.approx(found.stress.bending, rel=0.05)
    assert "estimate" not in told(found.remark)


@pytest.mark.parametrize("number", [0, 1])
def test_the_axis_bends_as_by_hand_with_its_flanks(solutions, number: int) -> None:
    """At both ends of the slot the axis, in its middle the mean of both flanks; without flanks 30 % too much here.

    The bar is narrower than the slot's surroundings, so that it is not the flanks alone that tell.
    """
    _, solution = solutions[1]
    nodes, moved = solution.space.nodes, solution.cases[number].displacement[:, 1]

    def at(x: float, y: float) -> float:
        return float(moved[(np.abs(nodes[:, 0] - x) < 0.4) & (np.abs(nodes[:, 1] - y) < 0.4)].mean())

    beam, _ = by_hand(PLACES[number])
    bent = deflection(
        beam.forces, PART.section, young=E, poisson=NU, line=(0.0, 80.0), flanks=flanks_of(BODY)
    ).functions
    assert bent.at(40.0)[1] == pytest.approx((at(40.0, 3.0) + at(40.0, -3.0)) / 2.0, rel=0.03)
    for x in (28.0, 52.0):
        assert bent.at(x)[1] == pytest.approx(at(x, 0.0), rel=0.055)


@pytest.mark.parametrize("x", PLACES)
def test_flanks_bend_by_themselves_and_the_net_section_alone_would_be_too_little(solved, x: float) -> None:
    beam, found = by_hand(x)
    net = net_section(EYE, WIDTH, T)
    plain = abs(float(beam.forces.at(x)[5])) * net.half_y / net.i_z
    assert tension_at_slot(solved[f"{x:g}", PressureLaw, 90]) > 2.0 * plain
    assert found.stress.bending > 2.0 * plain


@pytest.mark.parametrize("x", PLACES)
@pytest.mark.parametrize("place", [34.0, 37.0, 43.0, 46.0])
def test_flanks_carry_the_mean_moment_as_a_pair_of_forces(solved, x: float, place: float) -> None:
    """Mean of a flank's outer and inner fibre: half the force pair M̄/c over its area, c between the flanks' axes."""
    beam, _ = by_hand(x)
    low, high = 40.0 - SLOT / 2.0 - WIDTH / 4.0, 40.0 + SLOT / 2.0 + WIDTH / 4.0
    stations = np.linspace(low, high, 401)
    mean = np.trapezoid([beam.forces.at(s)[5] for s in stations], stations) / (high - low)
    height = (EYE - WIDTH) / 2.0
    field = solved[f"{x:g}", PressureLaw, 90]
    for side in (1.0, -1.0):
        axial = (along(field, x=place, y=side * EYE / 2.0) + along(field, x=place, y=side * WIDTH / 2.0)) / 2.0
        assert axial == pytest.approx(-side * mean / ((EYE + WIDTH) / 2.0) / (height * T), rel=0.06)


@pytest.mark.parametrize("x", PLACES)
def test_how_wide_the_pin_pushes_is_worth_little(solved, x: float) -> None:
    """Towards a line the tension grows with the square of what is left of the width: the narrow law is within 0.7 %."""
    half, quarter, eighth = (
        tension_at_slot(solved[f"{x:g}", *law])
        for law in ((PressureLaw, 180), (PressureLaw, 90), (Eighth, 90))
    )  # fmt: skip
    assert half < quarter < eighth
    assert quarter == pytest.approx(half, rel=0.025)
    assert eighth == pytest.approx(quarter, rel=0.008)
