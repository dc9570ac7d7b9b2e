"""Links in layers over a motion: at every pose each link balances in space, as by the frame of that pose alone."""

import numpy as np
import pytest
from edited_cases import PLANAR, edited

from alula.fea.beam.cut_free import link_loads
from alula.fea.motion.layered import with_couples
from alula.fea.standing.joint_forces import joint_forces
from alula.loads.records.applied import chosen
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.dead_point_reach import pose_at

LAYERS = [f"links.{name}.layer={layer}" for name, layer in zip("dabc", (0, 1, 2, 1), strict=True)]
SHARED = ['layer_spacing="40 mm"', "motion.poses=5"]


def test_all_poses_balance_in_space_and_are_those_of_their_frames() -> None:
    case = edited("four-bar-synthesis", [*LAYERS, *SHARED])
    moved, every = solve_case_motion(case), np.ones(5, dtype=bool)
    layered = with_couples(moved, every).moved
    for name, forces in layered.forces.items():
        loads = layered.loads[name]
        for link in case.checked_links:
            acting = link_loads(name, link, case.body(link), forces, loads)
            scale = acting.size(case.linkage.longest)
            assert np.abs(acting.resultant()[:, 2:5]).max() < 1e-9 * max(scale.max(), 1.0) * case.linkage.longest
        alone = joint_forces(case, pose_at(moved.motion, 3), [chosen(load, 3) for load in loads]).reactions
        for joint, reaction in forces.joints.items():
            wanted = alone.joints[joint].wrench
            assert reaction.wrench[3] == pytest.approx(wanted, rel=1e-7, abs=1e-7 * np.abs(wanted).max())


def test_one_layer_is_left_as_it_was() -> None:
    moved = solve_case_motion(edited("four-bar-synthesis", ["motion.poses=5", PLANAR]))
    assert with_couples(moved, np.ones(5, dtype=bool)).moved is moved
