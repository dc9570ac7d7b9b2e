"""Links in layers over a motion: at every pose each link balances in space, as by the frame of that pose alone."""

import numpy as np
import pytest
from edited_cases import PLANAR, edited

from alula.fea.beam.cut_free import link_loads
from alula.fea.doubts.force_doubt import sharing_answers
from alula.fea.links.link_by_hand import HandStates
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.fea.motion.layered import forces_at, with_couples
from alula.fea.outcomes.pins import stress_at
from alula.fea.standing.joint_forces import joint_forces
from alula.loads.records.applied import chosen
from alula.loads.states.case_motion import solve_case_motion

STACK = [f"links.{name}.layer={layer}" for name, layer in (("base", 0), ("crank", 1), ("coupler", 2), ("rocker", 1))]
HOLES = {"O2": ("base", "crank"), "A": ("crank", "coupler"), "B": ("coupler", "rocker"), "O4": ("base", "rocker")}
FITS = [
    f'joints.{name}.clearance={{{one} = ["0.01 mm", "0.3 mm"], {other} = ["0.01 mm", "0.3 mm"]}}'
    for name, (one, other) in HOLES.items()
]
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
        alone = joint_forces(case, moved.motion.pose(3), [chosen(load, 3) for load in loads]).reactions
        for joint, reaction in forces.joints.items():
            wanted = alone.joints[joint].wrench
            assert reaction.wrench[3] == pytest.approx(wanted, rel=1e-7, abs=1e-7 * np.abs(wanted).max())


def test_pins_and_links_are_open_in_the_pose_in_which_they_may_bear_most() -> None:
    """A pin that bears most with its stated clearance in one pose may bear more in another, with others than that."""
    more = [
        'layer_spacing="5 mm"',
        'links.base.thickness="6 mm"',
        "motion.turn=false",
        'motion.range=["30 deg", "200 deg"]',
        "motion.poses=5",
        'checks.pins={type="pins"}',
    ]
    case = edited("four-bar", [*STACK, *FITS, *more, 'load_cases.lift.forces.0.force=["0 N", "-4 N"]'])
    moved, every = solve_case_motion(case), np.ones(5, dtype=bool)
    layered, [name] = with_couples(moved, every), moved.forces
    told, left = (
        {one.subject.name: one.value for one in envelope_outcomes(layered.moved, {}, every, pins=pins)}
        for pins in (layered.pins, {})
    )
    there = [forces_at(moved, name, i) for i in range(5)]
    elsewhere = []
    for joint in HOLES:
        stress = [
            [stress_at(case, joint, one.joints).equivalent.value for one in (forces.reactions, *forces.sharings)]
            for forces in there
        ]
        most = [max(of_pose) for of_pose in stress]
        assert most[layered.pins[name, joint]] == pytest.approx(max(most))
        assert told[joint].low < case.pin_material(joint).allowable / max(most)
        elsewhere.append(layered.pins[name, joint] != int(np.argmax([value for value, *_ in stress])))
    assert any(elsewhere)
    # By the pose alone in which it bears most with its stated clearance, the band of such a pin would end before.
    assert [told[joint].low < left[joint].low for joint in HOLES] == elsewhere
    assert all(told[joint].low <= left[joint].low for joint in HOLES)
    for link in case.checked_links:
        found = max(HandStates(case, link, layered.ways[name, link].every).stress)
        loads = [[chosen(load, i) for load in moved.loads[name]] for i in range(5)]
        ways = [sharing_answers(case, name, link, *of, grown=True).every for of in zip(there, loads, strict=True)]
        assert found == pytest.approx(max(HandStates(case, link, way).stress.max() for way in ways))


def test_one_layer_is_left_as_it_was() -> None:
    moved = solve_case_motion(edited("four-bar-synthesis", ["motion.poses=5", PLANAR]))
    assert with_couples(moved, np.ones(5, dtype=bool)).moved is moved
