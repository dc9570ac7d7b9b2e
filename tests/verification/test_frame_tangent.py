"""The co-rotational element's forces and tangent against differences of its potential, and its rigid motions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from alula.fea.frame.model import FrameElement, FrameModel, Guide
from alula.fea.nonlinear.corotational_element import CorotationalElements, guide_gap
from alula.geometry.parts.part import rectangle

MODEL = FrameModel(
    nodes=np.array([[0.0, 0, 0], [88, 10, 5]]),
    elements=(
        FrameElement(
            nodes=(0, 1),
            section=rectangle(6.0, 2.0),
            young=2900.0,
            poisson=0.38,
            offsets=np.array([[1.0, 2, 3], [-2, 1, 0.5]]),
            load_first=np.array([0.1, 0.2, -0.3]),
            load_last=np.array([0.3, -0.2, 0.1]),
        ),
    ),
    supports=(),
)
ELEMENT = CorotationalElements(MODEL)
STEP = 1e-5
small = st.lists(st.floats(-0.2, 0.2), min_size=12, max_size=12).map(np.array)
vector = st.lists(st.floats(-2, 2), min_size=3, max_size=3).map(np.array)


def placed(local: np.ndarray, rigid: np.ndarray, extra: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and rotations: deformed by ``local``, turned by ``rigid``, then moved a little by ``extra``."""
    R = Rotation.from_rotvec(rigid).as_matrix()
    local, extra = local.reshape(2, 6), extra.reshape(2, 6)
    displacements = (MODEL.nodes + 5 * local[:, :3]) @ R.T - MODEL.nodes + extra[:, :3]
    turns = Rotation.from_rotvec(extra[:, 3:]).as_matrix() @ (R @ Rotation.from_rotvec(local[:, 3:]).as_matrix())
    return displacements[None], turns[None]


@settings(max_examples=20, deadline=None)
@given(small, vector)
def test_forces_and_tangent_are_derivatives(local: np.ndarray, rigid: np.ndarray) -> None:
    answer = ELEMENT.respond(*placed(local, rigid, np.zeros(12)), 1.0)
    gradient, tangent = np.zeros(12), np.zeros((12, 12))
    for k, e in enumerate(np.eye(12) * STEP):
        after, before = (placed(local, rigid, sign * e) for sign in (1, -1))
        stored = [ELEMENT._potential(ELEMENT.natural(*at), *at, ELEMENT.loads).value.item() for at in (after, before)]
        gradient[k] = stored[0] - stored[1]
        tangent[:, k] = (ELEMENT.respond(*after, 1.0).forces - ELEMENT.respond(*before, 1.0).forces)[0]
    assert answer.forces[0] == pytest.approx(gradient / (2 * STEP), abs=1e-5 * np.abs(gradient).max() / STEP)
    assert answer.tangent[0] == pytest.approx(tangent / (2 * STEP), abs=1e-6 * np.abs(tangent).max() / STEP)


@given(vector, vector)
def test_rigid_motion_strains_nothing(rigid: np.ndarray, shift: np.ndarray) -> None:
    displacements, rotations = placed(np.zeros(12), rigid, np.zeros(12))
    deformations, _ = ELEMENT.natural(displacements + 100 * shift, rotations)
    assert np.abs(deformations.value).max() < 1e-12


@pytest.mark.parametrize("angle", [1e-4, 1e-8, 1e-12])
def test_small_rigid_turns_strain_nothing_in_proportion(angle: float) -> None:
    """Of a beam with arms, and of a guide's axis; though what it moves along itself is below the rounding of R."""
    normal, axis = np.array([0.8, -0.6, 0.0]), np.array([0.36, 0.48, 0.8])
    turn = np.array([[0.0, -0.64, -0.6], [0.64, 0.0, -0.48], [0.6, 0.48, 0.0]])
    change = np.sin(angle) * turn + 2.0 * np.sin(angle / 2.0) ** 2 * turn @ turn
    rotations = np.tile(np.eye(3) + change, (1, 2, 1, 1))
    deformations, _ = ELEMENT.natural((MODEL.nodes @ change.T)[None], rotations)
    assert np.abs(deformations.value).max() < 1e-13 * angle
    gap, _ = guide_gap(Guide(carrier=0, pin=1, normal=normal, axis=axis), np.zeros((2, 3)), rotations[0])
    assert abs(gap) < 1e-15 * angle


def test_tangent_at_rest_is_the_linear_stiffness() -> None:
    from alula.fea.frame.system import FrameSystem, natural_deformations, natural_flexibility

    rest = np.zeros((1, 2, 3)), np.tile(np.eye(3), (1, 2, 1, 1))
    e, length = MODEL.elements[0], MODEL.length(0)
    _, place = FrameSystem(MODEL).place(0)
    B = natural_deformations(length) @ place
    K = B.T @ np.linalg.solve(natural_flexibility(e.section, e.young, e.poisson, length), B)
    assert ELEMENT.respond(*rest, 0.0).tangent[0] == pytest.approx(K, abs=1e-12 * np.abs(K).max())
