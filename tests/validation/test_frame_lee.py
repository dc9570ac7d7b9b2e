"""Lee's frame: two pinned legs of 120, rigidly joined at a right angle, pushed at a fifth of the level leg.

S.-L. Lee, F. S. Manuel, E. C. Rossow, Large deflections and stability of elastic frames, J. Eng. Mech. Div. ASCE 94
(1968) 521-547. E 7.2e6, A 6, I 2, in units that fit. The path by J. C. Simo, L. Vu-Quoc, Comput. Methods Appl. Mech.
Eng. 58 (1986) 79-116, as digitised from their figure in AeroBeams.jl (luizpancini/AeroBeams.jl,
test/referenceData/LeeFrameDeadLoad): displacement of the loaded point down and to the side, over the load in thousands.
"""

import numpy as np
import pytest

from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.equilibrium_path import NoEquilibriumError
from alula.geometry.parts.part import rectangle

DOWN = [(4.0306, 4.9238), (11.325, 10.487), (34.384, 17.026)]
SIDE = [(0.45486, 6.2357), (4.8272, 13.251), (12.551, 17.002)]
HIGHEST = 18.761
"""Of the digitised points, in thousands."""


def lee(load: float) -> FrameModel:
    """The frame in the plane x-y under a load in thousands."""
    nodes = np.array([[0.0, 0, 0], [0, 120, 0], [24, 120, 0], [120, 120, 0]])
    section = rectangle(2.0, 3.0)
    assert (section.area, section.i_z) == pytest.approx((6.0, 2.0))
    pinned = frozenset({"ux", "uy", "uz", "rx", "ry"})
    return FrameModel(
        nodes=nodes,
        elements=tuple(FrameElement(nodes=(i, i + 1), section=section, young=7.2e6, poisson=0.0) for i in range(3)),
        supports=(Support(node=0, dofs=pinned), Support(node=3, dofs=pinned)),
        loads=(NodeLoad(node=2, wrench=np.array([0, -1e3 * load, 0, 0, 0, 0])),),
    )


@pytest.mark.parametrize(("axis", "sign", "points"), [(1, -1, DOWN), (0, 1, SIDE)], ids=["down", "side"])
def test_the_path_up_to_the_limit_load(axis: int, sign: int, points: list[tuple[float, float]]) -> None:
    """Points read off a figure, to 2 % of their load and 0.3 of the leg's 120."""
    for displacement, load in points:
        below, above = (sign * solve_large_displacement(lee(f * load)).displacements[2, axis] for f in (0.98, 1.02))
        assert below - 0.3 < displacement < above + 0.3


def test_the_limit_load() -> None:
    """Beyond it the frame snaps through; 18.545 here, 1.2 % below the highest point that was read off."""
    with pytest.raises(NoEquilibriumError) as ended:
        solve_large_displacement(lee(30.0), 12)
    assert 30.0 * ended.value.reached == pytest.approx(HIGHEST, rel=0.02)
