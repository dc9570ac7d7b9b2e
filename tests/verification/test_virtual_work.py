"""Virtual work: the drive torque from velocities alone equals the one from joint forces.

With the drive at unit angular speed the power of all loads plus that of the drive vanishes,
T w_drive + sum F·v + sum M w = 0, whatever the joint forces are.
"""

import numpy as np
import pytest
from planar_linkages import OPEN_WING, four_bar, joint, link, quick_return, slider_crank

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.closure import LoopClosure
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.loads.records.applied import PointLoad
from alula.loads.statics.statics import Drive, solve_statics


def random_six_bar(rng: np.random.Generator) -> Linkage:
    """The owl wing's topology with lengths within 8 % of its own and pins off the links' axes."""

    def off() -> float:
        return float(rng.normal() * 3.0)

    def about(length: float) -> float:
        return float(length * rng.uniform(0.92, 1.08))

    return Linkage(
        {
            "AG": link(ground=True, A=(off(), off()), G=(off(), about(125))),
            "GF": link(G=(0.0, 0.0), F=(about(50), off())),
            "AE": link(A=(0.0, 0.0), B=(about(112), off()), E=(about(190), off())),
            "CF": link(F=(0.0, 0.0), B=(about(60), off()), C=(about(150), off())),
            "CH": link(C=(0.0, 0.0), D=(about(77), off()), H=(about(124), 0.0)),
            "ED": link(E=(0.0, 0.0), D=(about(88), off())),
        },
        {
            "A": joint("AG", "AE"),
            "B": joint("AE", "CF"),
            "C": joint("CF", "CH"),
            "D": joint("CH", "ED"),
            "E": joint("AE", "ED"),
            "F": joint("GF", "CF"),
            "G": joint("AG", "GF"),
        },
    )


def _random(kind: str, rng: np.random.Generator) -> tuple[Linkage, dict[str, float], list[Drive]]:
    if kind == "four-bar":
        a, b, c, d = rng.uniform(40, 160, size=4)
        drives = [Drive(link="crank", joint="A"), Drive(link="rocker", joint="D"), Drive(link="coupler", joint="B")]
        return four_bar(a, b, c, d), {"coupler": rng.uniform(-3, 3), "rocker": rng.uniform(-3, 3)}, drives
    if kind == "six-bar":
        return random_six_bar(rng), dict(OPEN_WING), [Drive(link="AE", joint="A"), Drive(link="GF", joint="G")]
    if kind == "slider-crank":
        linkage = slider_crank(rng.uniform(20, 60), rng.uniform(90, 160), rng.uniform(-25, 25))
        return linkage, {"coupler": 0.0}, [Drive(link="crank", joint="A"), Drive(link="coupler", joint="C")]
    linkage = quick_return(rng.uniform(20, 60), rng.uniform(70, 120))
    return linkage, {"lever": np.pi / 2}, [Drive(link="crank", joint="A"), Drive(link="lever", joint="O")]


def _torque_by_virtual_work(pose: Pose, drive: Drive, loads: list[PointLoad]) -> float:
    linkage, closure = pose.linkage, LoopClosure(pose.linkage)
    row = np.zeros(closure.unknowns)
    for name in linkage.joints[drive.joint].links:
        if name != linkage.ground:
            row[linkage.moving.index(name)] = 1.0 if name == drive.link else -1.0
    qdot = np.linalg.solve(np.vstack([closure.jacobian(pose.q), row]), [*np.zeros(closure.unknowns - 1), 1.0])
    velocity = dict(zip(closure.point_names, closure.velocities(pose.q, qdot), strict=True))
    power = 0.0
    for load in loads:
        v = velocity[load.link, load.point]
        spin = qdot[linkage.moving.index(load.link)]
        power += load.wrench[0] * v.real + load.wrench[1] * v.imag + load.wrench[5] * spin
    return -power


@pytest.mark.parametrize("kind", ["four-bar", "six-bar", "slider-crank", "quick return"])
def test_drive_torque_from_velocities_and_from_joint_forces(kind: str) -> None:
    rng = np.random.default_rng(11)
    compared = 0
    for _ in range(60):
        linkage, near, drives = _random(kind, rng)
        coordinate = linkage.moving[0]
        angle = rng.uniform(3.8, 4.2) if kind == "six-bar" else rng.uniform(-3, 3)
        try:
            pose = solve_pose(linkage, coordinate=coordinate, angle=angle, near=near)
        except CaseError:
            continue  # not every random linkage closes, nor on the branch guessed for it
        loads = []
        for name in linkage.moving:
            for point in linkage.links[name].points:
                wrench = rng.normal(size=6) * [1, 1, 1, 30, 30, 30]
                loads.append(PointLoad(link=name, point=point, wrench=wrench))
        for drive in drives:
            if pose.dead_point_distance(Coordinate(drive.link)) < 1e-3:
                continue
            torque = solve_statics(pose, drive, loads).drive_torque
            expected = _torque_by_virtual_work(pose, drive, loads)
            assert torque == pytest.approx(expected, rel=1e-8, abs=1e-7)
            compared += 1
    assert compared >= 25  # of some 120 tries: else the test would be empty
