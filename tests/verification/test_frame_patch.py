"""Constant strain on irregular meshes, superposition, rotation of the whole frame, and stiffness far apart."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from alula.fea.beam.deflection import deflection
from alula.fea.beam.loads import BeamLoads, PointLoad
from alula.fea.beam.theory import internal_forces
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support, Tie
from alula.geometry.parts.part import Section, rectangle, ring

E, NU = 2400.0, 0.35
BAR = rectangle(6.0, 2.0)
TUBE = ring(5.0, 2.5)
IRREGULAR = np.array([0.0, 3.0, 41.0, 43.0, 90.0, 100.0])


def straight(wrench: list[float], direction: np.ndarray, section: Section = BAR) -> FrameModel:
    return FrameModel(
        nodes=np.outer(IRREGULAR, direction),
        elements=tuple(
            FrameElement(nodes=(i, i + 1), section=section, young=E, poisson=NU, z_axis=np.array([0.2, -0.5, 1.0]))
            for i in range(len(IRREGULAR) - 1)
        ),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=len(IRREGULAR) - 1, wrench=np.array(wrench)),),
    )


DIRECTION = np.array([2.0, 3.0, 6.0]) / 7.0


@pytest.mark.parametrize(
    ("local", "strain"),
    [
        (0, 1 / (E * BAR.area)),
        (3, 1 / (E / (2 + 2 * NU) * BAR.torsion)),
        (4, 1 / (E * BAR.i_y)),
        (5, 1 / (E * BAR.i_z)),
    ],
    ids=["axial", "twist", "bending about y", "bending about z"],
)
def test_constant_strain_on_an_irregular_mesh(local: int, strain: float) -> None:
    R = straight([0.0] * 6, DIRECTION).axes(0)
    axis = R[local % 3]
    wrench = np.zeros(6)
    wrench[3 * (local // 3) : 3 * (local // 3) + 3] = axis
    out = solve_frame(straight(list(wrench), DIRECTION))
    for i in range(len(IRREGULAR) - 1):
        expected = np.zeros(6)
        expected[local] = 1.0
        assert out.end_forces[i, 1] == pytest.approx(expected, abs=1e-12)
    moved = out.displacements[:, :3] if local == 0 else out.displacements[:, 3:]
    assert moved == pytest.approx(np.outer(IRREGULAR * strain, axis), rel=1e-9, abs=1e-12 * strain)
    if local > 3:
        side = np.cross(axis, DIRECTION)
        assert out.displacements[:, :3] == pytest.approx(np.outer(IRREGULAR**2 * strain / 2, side), abs=1e-8 * strain)


number = st.floats(-5, 5).map(lambda v: round(v, 3))


@st.composite
def space_frame(draw: st.DrawFn) -> FrameModel:
    """A redundant spatial frame with ball joints, an arm, line loads and nodal loads."""
    shake = np.array([[draw(number) for _ in range(3)] for _ in range(6)])
    nodes = np.array([[0.0, 0, 0], [50, 0, 10], [50, 0, 10], [90, 40, 0], [20, 60, 15], [20, 60, 15]]) + shake
    nodes[2], nodes[5] = nodes[1], nodes[4]
    q = np.array([draw(number) for _ in range(6)]) / 100.0
    pairs = [(0, 1), (2, 3), (3, 4), (5, 1)]
    elements = [
        FrameElement(nodes=p, section=s, young=E, poisson=NU) for p, s in zip(pairs, [BAR, TUBE] * 2, strict=True)
    ]
    elements[1] = replace(elements[1], load_first=q[:3], load_last=q[3:])
    elements[2] = replace(elements[2], offsets=np.array([[1.0, 2, -1], [0, 0, 2]]))
    return FrameModel(
        nodes=nodes,
        elements=tuple(elements),
        supports=(Support(node=0), Support(node=3, dofs=frozenset({"ux", "uy", "uz"}))),
        ties=tuple(Tie(nodes=pair, dofs=frozenset({"ux", "uy", "uz"})) for pair in ((1, 2), (4, 5))),
        loads=(NodeLoad(node=4, wrench=np.array([draw(number) for _ in range(6)])),),
    )


@given(space_frame(), st.floats(0, 6.3), st.floats(0, 3.1))
def test_turning_the_frame_turns_the_answer(model: FrameModel, first: float, second: float) -> None:
    R = Rotation.from_euler("zx", [first, second]).as_matrix()

    def turn(wrench: np.ndarray) -> np.ndarray:
        return np.concatenate([R @ wrench[:3], R @ wrench[3:]])

    turned = replace(
        model,
        nodes=model.nodes @ R.T,
        elements=tuple(
            replace(
                e, z_axis=R @ e.z_axis, offsets=e.offsets @ R.T, load_first=R @ e.load_first, load_last=R @ e.load_last
            )
            for e in model.elements
        ),
        loads=tuple(replace(p, wrench=turn(p.wrench)) for p in model.loads),
    )
    # What is held and tied here (all, or the three displacements) does not depend on the axes.
    a, b = solve_frame(model), solve_frame(turned)
    force = max(model.load_scale, 1e-9)
    assert b.end_forces == pytest.approx(a.end_forces, abs=1e-9 * force * 100)
    expected = np.array([turn(d) for d in a.displacements])
    assert b.displacements == pytest.approx(expected, abs=1e-9 * max(np.abs(expected).max(), 1e-9))
    assert a.residual < 1e-12
    assert b.residual < 1e-12


@given(space_frame(), number, number)
def test_answers_add_up(model: FrameModel, factor: float, other: float) -> None:
    second = NodeLoad(node=1, wrench=np.array([other, 1.0, -2.0, 3.0, 0.0, factor]))
    bare = replace(
        model, elements=tuple(replace(e, load_first=np.zeros(3), load_last=np.zeros(3)) for e in model.elements)
    )
    scaled = replace(
        model,
        elements=tuple(
            replace(e, load_first=factor * e.load_first, load_last=factor * e.load_last) for e in model.elements
        ),
        loads=(*(replace(p, wrench=factor * p.wrench) for p in model.loads), second),
    )
    a, b, both = solve_frame(model), solve_frame(replace(bare, loads=(second,))), solve_frame(scaled)
    expected = factor * a.displacements + b.displacements
    assert both.displacements == pytest.approx(expected, abs=1e-9 * max(1.0, np.abs(expected).max()))


@given(st.lists(number, min_size=6, max_size=6), st.floats(0.05, 0.95))
def test_frame_and_hand_calculation_agree(values: list[float], fraction: float) -> None:
    """A beam on two supports in the frame, and the same as a free body under the frame's reactions."""
    x, length = 100.0 * fraction, 100.0
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [x, 0, 0], [length, 0, 0]]),
        elements=tuple(FrameElement(nodes=p, section=BAR, young=E, poisson=NU) for p in ((0, 1), (1, 2))),
        supports=(
            Support(node=0, dofs=frozenset({"ux", "uy", "uz", "rx"})),
            Support(node=2, dofs=frozenset({"uy", "uz"})),
        ),
        loads=(NodeLoad(node=1, wrench=np.array(values)),),
    )
    out = solve_frame(model)
    points = [
        PointLoad(point=model.nodes[i], wrench=out.reactions[i] + (values if i == 1 else np.zeros(6))) for i in range(3)
    ]
    forces = internal_forces(BeamLoads(points=tuple(points)))
    bent = deflection(forces, BAR, young=E, poisson=NU, line=(0.0, length)).functions
    assert bent.at(x)[:3] == pytest.approx(out.displacements[1, :3], rel=1e-9, abs=1e-12)
    assert bent.at(x)[3:] == pytest.approx(out.displacements[1, 3:], rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 1.0, 1e3, 1e6])
def test_stiffness_ratio_costs_no_accuracy(ratio: float) -> None:
    """Bar of two materials between walls, pulled in its middle: the forces share as the stiffnesses, to rounding."""
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [30, 0, 0], [100, 0, 0]]),
        elements=(
            FrameElement(nodes=(0, 1), section=TUBE, young=E, poisson=NU),
            FrameElement(nodes=(1, 2), section=TUBE, young=ratio * E, poisson=NU),
        ),
        supports=(Support(node=0), Support(node=2)),
        loads=(NodeLoad(node=1, wrench=np.array([1.0, 0, 0, 0, 0, 0])),),
    )
    out = solve_frame(model)
    soft = (ratio / 70) / (1 / 30 + ratio / 70)
    assert out.reactions[2, 0] == pytest.approx(-soft, rel=1e-10)
    assert out.reactions[0, 0] == pytest.approx(-(1 - soft), rel=1e-10)
    assert out.residual < 1e-14


@pytest.mark.parametrize("slenderness", [2, 10, 100, 1000])
@pytest.mark.parametrize("elements", [1, 7, 200])
def test_no_locking_from_stout_to_slender(slenderness: float, elements: int) -> None:
    length = 5.0 * slenderness
    x = np.linspace(0.0, length, elements + 1)
    model = FrameModel(
        nodes=np.column_stack([x, 0 * x, 0 * x]),
        elements=tuple(FrameElement(nodes=(i, i + 1), section=TUBE, young=E, poisson=NU) for i in range(elements)),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=elements, wrench=np.array([1.0, 1, 0, 0, 0, 0])),),
    )
    out = solve_frame(model)
    shear = length / (TUBE.shear_coefficient(NU) * E / (2 + 2 * NU) * TUBE.area)
    assert out.displacements[-1, 1] == pytest.approx(length**3 / (3 * E * TUBE.i_z) + shear, rel=1e-9)
    assert out.displacements[-1, 0] == pytest.approx(length / (E * TUBE.area), rel=1e-9)
    assert out.reactions[0, 5] == pytest.approx(-length, rel=1e-12)
