"""Code_Aster V3.01.011 (SSLL11/89 of the SFM's Guide VPCS, 1990): plane truss of four bars under a point load."""

import numpy as np
import pytest

from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.model import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support, Tie
from alula.geometry.parts.part import ring

PLANE = frozenset({"uz", "rx", "ry"})


def truss(*, hinged: bool) -> FrameSolution:
    """A (0, 0), B (1, 0), C (0.5, 0.5), D (2, 1) m; bars AC, BC of 2 cm², CD, BD of 1 cm²; 9.81 kN down at D.

    Solid rounds of those areas, E 196.2 GPa, ν 0.3 (``ssll11a.comm`` in Code_Aster's astest; N, mm here).
    """
    joints = np.array([[0.0, 0, 0], [1000, 0, 0], [500, 500, 0], [2000, 1000, 0]])
    bars = [((0, 2), 200.0), ((1, 2), 200.0), ((2, 3), 100.0), ((1, 3), 100.0)]
    elements = tuple(
        FrameElement(
            nodes=(4 + 2 * i, 5 + 2 * i),
            section=ring(2.0 * np.sqrt(area / np.pi), 0.0),
            young=196.2e3,
            poisson=0.3,
        )
        for i, (_, area) in enumerate(bars)
    )
    ends = [joint for pair, _ in bars for joint in pair]
    dofs = ALL_DOFS - {"rz"} if hinged else ALL_DOFS
    ties = tuple(Tie(nodes=(joint, 4 + k), dofs=dofs) for k, joint in enumerate(ends))
    nodes = np.vstack([joints, joints[ends]])
    pins = tuple(Support(node=i, dofs=PLANE | {"ux", "uy"}) for i in (0, 1))
    plane = tuple(Support(node=i, dofs=PLANE) for i in (2, 3))
    loads = (NodeLoad(node=3, wrench=np.array([0.0, -9810.0, 0, 0, 0, 0])),)
    return solve_frame(FrameModel(nodes=nodes, elements=elements, ties=ties, supports=pins + plane, loads=loads))


def test_displacements_as_published() -> None:
    """Published to 3e-4 (Code_Aster's own tolerance)."""
    out = truss(hinged=True)
    assert out.displacements[2, :2] == pytest.approx([0.26517, 0.08839], rel=3e-4)
    assert out.displacements[3, :2] == pytest.approx([3.47902, -5.60084], rel=3e-4)


def test_displacements_as_recomputed() -> None:
    """Recomputed by an independent high-order code: D moves (3.47903, -5.60035) mm; the printed -5.60084 is off."""
    out = truss(hinged=True)
    assert out.displacements[3, :2] == pytest.approx([3.47903, -5.60035], rel=1e-5)


def test_rigid_joints_stiffen_the_slender_truss_little() -> None:
    """Code_Aster models A welds the bars: bending carries less than 1 % here; normal stresses in AC and BD follow."""
    out = truss(hinged=False)
    assert abs(out.displacements[3, 1]) < abs(truss(hinged=True).displacements[3, 1])
    assert out.displacements[3, :2] == pytest.approx([3.47902, -5.60084], rel=3e-3)
    assert out.internal_forces(0).at(1.0)[0] / 200.0 == pytest.approx(69.3641, rel=3e-3)
    assert out.internal_forces(3).at(1.0)[0] / 100.0 == pytest.approx(-208.067, rel=3e-3)
