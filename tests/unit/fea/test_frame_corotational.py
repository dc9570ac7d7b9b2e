from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support, Tie
from alula.fea.nonlinear.corotational import solve_large_displacement, subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath, UnfollowedError
from alula.fea.nonlinear.stability import buckling_factor
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import rectangle, ring
from alula.loads.case.case_file import read_case
from alula.loads.states.actions import acting_loads

TUBE = ring(5.0, 2.5)
BAR = rectangle(6.0, 2.0)
PIN = frozenset({"ux", "uy", "uz", "rx", "ry"})
PLANE = frozenset({"uz", "rx", "ry"})


def element(a: int, b: int, **more: object) -> FrameElement:
    return FrameElement(**{"nodes": (a, b), "section": BAR, "young": 2400.0, "poisson": 0.35} | more)


def four_bar(force: float, **crank: object) -> FrameModel:
    """Four-bar with pins B and C, the crank held at A; a coupler with arms and a line load, loads in space."""
    return FrameModel(
        nodes=np.array([[0.0, 0, 0], [20, 60, 0], [20, 60, 0], [110, 80, 0], [110, 80, 0], [100, 0, 0]]),
        elements=(
            element(0, 1, **crank),
            element(
                2,
                3,
                offsets=np.array([[1.0, -3, 0], [-1, -3, 0]]),
                load_first=force * np.array([0.0, -0.01, 0.002]),
                load_last=force * np.array([0.005, -0.02, 0.0]),
            ),
            element(4, 5, section=TUBE),
        ),
        supports=(Support(node=0), Support(node=5, dofs=PIN)),
        ties=(Tie(nodes=(1, 2)), Tie(nodes=(3, 4))),
        loads=(NodeLoad(node=3, wrench=force * np.array([1.0, -0.4, 0.3, 2.0, -3.0, 0.0])),),
        names=("A", "B", "B'", "C", "C'", "D"),
    )


def turned(model: FrameModel, R: np.ndarray) -> FrameModel:
    return replace(
        model,
        nodes=model.nodes @ R.T,
        elements=tuple(
            replace(
                e, z_axis=R @ e.z_axis, offsets=e.offsets @ R.T, load_first=R @ e.load_first, load_last=R @ e.load_last
            )
            for e in model.elements
        ),
        loads=tuple(replace(p, wrench=(p.wrench.reshape(2, 3) @ R.T).ravel()) for p in model.loads),
    )


def test_small_loads_give_the_linear_frame() -> None:
    """With pins, arms and line loads; the difference falls with the load, so it is of second order."""
    differences = []
    for force in (1e-3, 1e-4):
        model = four_bar(force)
        linear, large = solve_frame(model), solve_large_displacement(model, 2)
        scale = np.abs(linear.displacements[:, :3]).max()
        differences.append(np.abs(large.displacements[:6] - linear.displacements[:, :3]).max() / scale)
        forces = np.abs(large.joint_wrenches[:6] - linear.joint_wrenches).max() / np.abs(linear.joint_wrenches).max()
        assert forces < 0.1 * np.sqrt(force)
    assert differences[1] < 2e-3
    assert differences[1] == pytest.approx(differences[0] / 10, rel=0.1)


def slider_crank(force: float) -> FrameModel:
    """The built-in case in its layers, where guides hold the slider."""
    case = read_case("slider-crank")
    loads = acting_loads(case, case.load_cases["push"], case.solve_pose().placement, {})
    model = build_frame(case, case.solve_pose(), loads, held=case.pinned_drive).model
    return replace(model, loads=tuple(replace(one, wrench=force * one.wrench) for one in model.loads))


@pytest.mark.parametrize("frame", [four_bar, slider_crank])
def test_answers_are_in_proportion_to_loads_however_small(frame: Callable[[float], FrameModel]) -> None:
    """Turns far below the rounding of a rotation matrix leave forces that balance all the same."""
    assert solve_large_displacement(frame(1e-5), 2).residual < 1e-8
    small = solve_large_displacement(frame(1e-8), 2)
    for force in (1e-9, 1e-11, 1e-13, 1e-15):
        found, times = solve_large_displacement(frame(force), 2), 1e-8 / force
        for name in ("displacements", "end_forces", "joint_wrenches"):
            one, other = getattr(small, name), times * getattr(found, name)
            assert other == pytest.approx(one, rel=0.0, abs=1e-6 * np.abs(one).max()), name


def test_reactions_balance_the_loads_on_the_deformed_shape() -> None:
    model = four_bar(5.0)
    out = solve_large_displacement(model, 4)
    applied = (
        model.loads[0].wrench[:3] + model.length(1) * (model.elements[1].load_first + model.elements[1].load_last) / 2
    )
    assert np.abs(out.displacements).max() > 5.0
    assert out.joint_wrenches[:, :3].sum(axis=0) == pytest.approx(-applied, abs=1e-8)
    assert out.residual < 1e-8


def test_pins_carry_no_moment_about_their_own_axis() -> None:
    out = solve_large_displacement(four_bar(1.0), 4)
    for node in (1, 2, 4, 5):
        moment, axis = out.joint_wrenches[node, 3:], out.rotations[node][:, 2]
        assert np.linalg.norm(moment) > 0.1
        assert moment @ axis == pytest.approx(0.0, abs=1e-6)
    assert out.rotations[1][:, 2] == pytest.approx(out.rotations[2][:, 2], abs=1e-12)
    assert np.abs(out.rotations[1] - out.rotations[2]).max() > 0.01


def test_turning_the_frame_turns_the_answer() -> None:
    # Without pins, whose axes are global.
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [60, 20, 10], [110, -10, 30]]),
        elements=(
            element(0, 1, offsets=np.array([[0.0, 0, 0], [-2, 1, 3]])),
            element(1, 2, load_first=np.array([0.01, -0.02, 0.005])),
        ),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=2, wrench=np.array([0.3, -0.8, 0.9, 10, -20, 5.0])),),
    )
    R = Rotation.from_rotvec([0.4, -1.1, 2.0]).as_matrix()
    a, b = solve_large_displacement(model, 3), solve_large_displacement(turned(model, R), 3)
    assert np.abs(a.displacements).max() > 20.0
    assert b.displacements == pytest.approx(a.displacements @ R.T, abs=1e-6)
    assert b.end_forces.reshape(-1, 3) == pytest.approx(a.end_forces.reshape(-1, 3) @ R.T, abs=1e-6)


@pytest.mark.parametrize("arm", [(0.0, 0.0, 0.0), (5.0, 30.0, -20.0)])
def test_the_root_holds_what_lies_beyond(arm: tuple[float, ...]) -> None:
    """Force and moment at the root from the deformed tip's position, and from where its turned lever ends."""
    force, moment = np.array([0.2, 0.5, -0.3]), np.array([2.0, -1.0, 3.0])
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [100, 0, 0]]),
        elements=(element(0, 1, section=TUBE),),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=1, wrench=np.array([*force, *moment + np.cross(arm, force)]), lever=[arm, force]),),
    )
    out = solve_large_displacement(model, 8)
    end = np.array([100.0, 0, 0]) + out.displacements[1] + out.rotations[1] @ arm
    assert out.end_forces[0, 0] == pytest.approx([*-force, *-(moment + np.cross(end, force))], abs=1e-5)
    assert out.joint_wrenches[1] == pytest.approx(np.zeros(6), abs=1e-5), "nothing but the load is joined to the tip"


def test_the_tangent_of_a_lever_is_the_derivative_of_what_is_left_over() -> None:
    """Out of the plane, at a pin whose axis has turned, by differences; beside a load without a lever."""
    model = four_bar(3.0)
    lever = np.array([[9.0, -20.0, 35.0], [2.0, 5.0, -4.0]])
    pushed = NodeLoad(node=2, wrench=np.concatenate([lever[1], np.cross(*lever)]), lever=lever)
    path = EquilibriumPath(subdivide(replace(model, loads=(*model.loads, pushed)), 2))
    path.follow(1e-3, 20)
    assert np.abs(path.state.rotations[2] - np.eye(3)).max() > 0.05
    tangent = path.balance(path.state, 1.0)[1]
    for number, unknown in enumerate(np.eye(path.size)):
        step = 1e-5 * path.unit[number]
        ahead, behind = (path.balance(path._moved(path.state, sign * step * unknown), 1.0)[0] for sign in (1.0, -1.0))
        found = (ahead - behind) / (2.0 * step)
        assert tangent[:, number] == pytest.approx(found, abs=1e-5 * np.abs(tangent[:, number]).max())


def pulled(force: float, *across: float) -> FrameModel:
    return FrameModel(
        nodes=np.array([[0.0, 0, 0], [100, 0, 0]]),
        elements=(element(0, 1),),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=1, wrench=np.array([force, *across, *[0.0] * (5 - len(across))])),),
    )


@pytest.mark.parametrize("across", [1e-6, 1e-2])
def test_however_large_a_load_is_that_pulls_a_rod_straight_steps_of_it_are_few(across, monkeypatch) -> None:
    """4400 steps were taken where rounding alone bent the path; the rod lies along its load and is F L/(E A) longer."""
    steps, newton = [], EquilibriumPath._newton
    monkeypatch.setattr(EquilibriumPath, "_newton", lambda path, *more: [steps.append(1), newton(path, *more)][1])
    force = 1e12
    tip = solve_large_displacement(pulled(force, force * across), 2).displacements[1] + [100.0, 0.0, 0.0]
    assert len(steps) < 60
    assert np.linalg.norm(tip) == pytest.approx(
        100.0 + 100.0 * force * np.hypot(1.0, across) / (2400.0 * 12.0), rel=1e-6
    )
    assert tip[1] / tip[0] == pytest.approx(across, rel=1e-6)


def test_tangents_know_the_forces_that_go_with_the_last_change_so_that_steps_take_few_iterations(monkeypatch) -> None:
    """Forces of a stretch that turns do not make took eight."""
    iterations, newton = [], EquilibriumPath._newton

    def counted(path, *more):
        found = newton(path, *more)
        iterations.append(0 if found is None else found[1])
        return found

    monkeypatch.setattr(EquilibriumPath, "_newton", counted)
    solve_large_displacement(four_bar(20.0), 2)
    assert 0 not in iterations
    assert max(iterations) <= 5


def test_a_path_that_bends_too_much_ends_without_a_word_on_what_the_frame_bears(monkeypatch) -> None:
    monkeypatch.setattr("alula.fea.nonlinear.equilibrium_path.MOST_STEPS", 5)
    with pytest.raises(UnfollowedError, match=r"5 steps of load reach .* of the whole load") as ended:
        solve_large_displacement(four_bar(20.0), 2)
    assert 0.0 < ended.value.reached < 1.0
    assert ended.value.failed == np.inf


def test_division_keeps_the_linear_answer() -> None:
    model = four_bar(1.0)
    divided = subdivide(model, 3)
    a, b = solve_frame(model), solve_frame(divided)
    assert b.displacements[:6] == pytest.approx(a.displacements, rel=1e-8, abs=1e-9)


def toggle(force: float) -> FrameModel:
    # E A 4000 N as of a bar 2 x 2 mm, but too stiff in bending to buckle before the truss snaps.
    square = replace(rectangle(2.0, 2.0), i_y=1e3, i_z=1e3)
    return FrameModel(
        nodes=np.array([[0.0, 0, 0], [100, 10, 0], [200, 0, 0], [100, 10, 0]]),
        elements=tuple(element(*pair, section=square, young=1000.0) for pair in ((0, 1), (3, 2))),
        supports=(Support(node=0, dofs=PIN), Support(node=2, dofs=PIN), Support(node=1, dofs=PLANE)),
        ties=(Tie(nodes=(1, 3)),),
        loads=(NodeLoad(node=1, wrench=np.array([0, -force, 0, 0, 0, 0.0])),),
    )


def toggle_force(drop: np.ndarray | float) -> np.ndarray:
    """Two bars, engineering strain: P = 2 E A (1/l - 1/L) (h - w)."""
    return 2 * 4000 * (1 / np.hypot(100, 10 - drop) - 1 / np.hypot(100, 10)) * (10 - drop)


LIMIT = float(toggle_force(np.linspace(0, 10, 100001)).max())


@pytest.mark.parametrize("share", [0.3, 0.99, 0.9999])
def test_flat_truss_up_to_its_limit_load(share: float) -> None:
    out = solve_large_displacement(toggle(share * LIMIT), 1)
    assert toggle_force(-out.displacements[1, 1]) == pytest.approx(share * LIMIT, rel=1e-7)
    assert -out.displacements[1, 1] < 4.3
    assert out.stable


@pytest.mark.parametrize("share", [1.0001, 1.3, 10.0])
def test_snap_through_is_an_error_and_no_answer(share: float) -> None:
    with pytest.raises(CannotRunError, match=r"gives way at .* % of its load"):
        solve_large_displacement(toggle(share * LIMIT), 1)


def test_straight_column_beyond_eulers_load_is_told_unstable() -> None:
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [100, 0, 0]]),
        elements=(element(0, 1, section=TUBE),),
        supports=(Support(node=0),),
        loads=(NodeLoad(node=1, wrench=np.array([-1.0, 0, 0, 0, 0, 0])),),
    )
    critical = buckling_factor(model)
    for share, stable in ((0.98, True), (1.02, False)):
        scaled = replace(model, loads=(NodeLoad(node=1, wrench=np.array([-share * critical, 0, 0, 0, 0, 0])),))
        assert solve_large_displacement(scaled).stable is stable


def test_mechanism_is_refused() -> None:
    model = replace(four_bar(1.0), supports=(Support(node=0, dofs=PIN), Support(node=5, dofs=PIN)))
    with pytest.raises(CannotRunError, match="mechanism"):
        solve_large_displacement(model, 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"supports": (Support(node=0, dofs=PIN - {"ry"}), Support(node=5))}, "about x alone"),
        ({"ties": (Tie(nodes=(1, 2), dofs=PIN - {"ry"}), Tie(nodes=(3, 4)))}, "tie shares"),
        ({"ties": (Tie(nodes=(1, 2), dofs=PIN - {"uz"}), Tie(nodes=(3, 4)))}, "tie shares"),
    ],
)
def test_what_makes_no_sense_for_finite_turns_is_refused(change: dict, message: str) -> None:
    model = replace(four_bar(1.0), **change)
    with pytest.raises(CannotRunError, match=message):
        solve_large_displacement(model, 2)
