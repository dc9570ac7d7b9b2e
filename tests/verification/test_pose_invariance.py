"""A pose does not depend on where the ground lies, how it is turned, mirrored or scaled (hypothesis)."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from planar_linkages import OPEN_WING, four_bar, six_bar

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.pose import CLOSED, Pose, solve_pose

LENGTHS = st.floats(20.0, 200.0)
ANGLES = st.floats(-math.pi, math.pi)


def _is_rigid(pose: Pose) -> bool:
    """Every pair of points of a link is as far apart as in the link's own frame."""
    for name, record in pose.linkage.links.items():
        local = np.array(list(record.points.values()))
        here = np.array([pose.position(name, point) for point in record.points])
        wanted = np.linalg.norm(local[:, None] - local[None], axis=-1)
        found = np.linalg.norm(here[:, None] - here[None], axis=-1)
        if not np.allclose(found, wanted, atol=1e-9 * pose.linkage.longest):
            return False
    return True


def _largest_gap(pose: Pose) -> float:
    gaps = [
        np.linalg.norm(
            np.subtract(*(pose.position(i, p) for i, p in zip(j.links, pose.linkage.joint_points(n), strict=True)))
        )
        for n, j in pose.linkage.joints.items()
    ]
    return float(max(gaps)) / pose.linkage.longest


@given(a=LENGTHS, b=LENGTHS, c=LENGTHS, d=LENGTHS, angle=ANGLES)
def test_four_bars_close_or_say_that_they_cannot(a: float, b: float, c: float, d: float, angle: float) -> None:
    """Closed form: the circle about the crank pin and the one about D meet, or the gap is their distance."""
    pin = a * np.exp(1j * angle)
    reach = abs(d - pin)
    gap = max(reach - (b + c), abs(b - c) - reach)
    assume(abs(gap) > 1e-3 and reach > 1e-3)
    # The open assembly has C on the left of the line from the crank pin to D.
    if gap > 0:
        with pytest.raises(CaseError, match=f"loop A-B-C-D stays open by {gap:.4g} mm|stays open by") as caught:
            solve_pose(four_bar(a, b, c, d), coordinate="crank", angle=angle)
        assert float(str(caught.value).split("open by ")[1].split(" mm")[0]) == pytest.approx(gap, rel=1e-3)
        return
    turn = math.acos(np.clip((b**2 + reach**2 - c**2) / (2 * b * reach), -1, 1))
    corner = pin + b * np.exp(1j * (np.angle(d - pin) + turn))
    near = {"coupler": float(np.angle(corner - pin)), "rocker": float(np.angle(corner - d))}
    pose = solve_pose(four_bar(a, b, c, d), coordinate="crank", angle=angle, near=near)
    assert pose.residual <= CLOSED
    assert _largest_gap(pose) <= 1e-9
    assert _is_rigid(pose)
    np.testing.assert_allclose(pose.points["C"], [corner.real, corner.imag], atol=1e-6 * pose.linkage.longest)


@given(
    scale=st.floats(1e-3, 1e3),
    turn=ANGLES,
    mirrored=st.booleans(),
    shift=st.tuples(st.floats(-500, 500), st.floats(-500, 500)),
    angle=st.floats(217.0, 240.0),
)
def test_the_owl_wing_moves_with_its_ground(
    scale: float, turn: float, mirrored: bool, shift: tuple[float, float], angle: float
) -> None:
    sign = -1.0 if mirrored else 1.0
    offset = complex(*shift) * scale
    plain = solve_pose(six_bar(), coordinate="GF", angle=math.radians(angle), near=OPEN_WING)
    moved = solve_pose(
        six_bar(scale, turn, sign, offset),
        coordinate="GF",
        angle=sign * math.radians(angle) + turn,
        near={name: sign * rough + turn for name, rough in OPEN_WING.items()},
    )
    assert moved.residual <= CLOSED
    assert _is_rigid(moved)
    for name, xy in plain.points.items():
        z = complex(xy[0], sign * xy[1]) * np.exp(1j * turn) * scale + offset
        np.testing.assert_allclose(moved.points[name], [z.real, z.imag], atol=1e-8 * moved.linkage.longest)
    for driven in ("AE", "GF"):
        assert moved.dead_point_distance(Coordinate(driven)) == pytest.approx(
            plain.dead_point_distance(Coordinate(driven)), rel=1e-6
        )
