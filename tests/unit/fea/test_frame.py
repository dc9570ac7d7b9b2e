import pickle
from dataclasses import replace

import numpy as np
import pytest

from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support, Tie
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import rectangle, ring

TUBE = ring(5.0, 2.5)
BAR = rectangle(6.0, 2.0)
PLANE = frozenset({"uz", "rx", "ry"})
PIN = frozenset({"ux", "uy", "uz", "rx", "ry"})


def element(a: int, b: int, **more: object) -> FrameElement:
    return FrameElement(**{"nodes": (a, b), "section": TUBE, "young": 2400.0, "poisson": 0.35} | more)


def load(node: int, *wrench: float) -> NodeLoad:
    return NodeLoad(node=node, wrench=np.array([*wrench, *[0.0] * (6 - len(wrench))]))


CANTILEVER = FrameModel(
    nodes=np.array([[0.0, 0, 0], [60, 0, 0]]),
    elements=(element(0, 1, section=BAR),),
    supports=(Support(node=0),),
    loads=(load(1, 0, 0, 2.0),),
)


def test_cantilever_bends_about_the_axis_that_its_load_asks_for() -> None:
    out = solve_frame(CANTILEVER)
    g = 2400 / 2.7
    shear = 2 * 60 / (BAR.shear_coefficient(0.35) * g * BAR.area)
    assert out.displacements[1, 2] == pytest.approx(2 * 60**3 / (3 * 2400 * BAR.i_y) + shear, rel=1e-12)
    assert out.displacements[1, 4] == pytest.approx(-2 * 60**2 / (2 * 2400 * BAR.i_y), rel=1e-12)
    assert out.reactions[0] == pytest.approx([0, 0, -2, 0, 120, 0])
    turned = solve_frame(replace(CANTILEVER, loads=(load(1, 0, 2.0),)))
    assert turned.displacements[1, 1] == pytest.approx(2 * 60**3 / (3 * 2400 * BAR.i_z) + shear, rel=1e-12)
    assert turned.reactions[0] == pytest.approx([0, -2, 0, 0, 0, -120])


def test_z_axis_turns_the_section() -> None:
    upright = replace(CANTILEVER, elements=(element(0, 1, section=BAR, z_axis=np.array([0.3, 1.0, 0.0])),))
    assert solve_frame(upright).displacements[1, 2] == pytest.approx(
        solve_frame(replace(CANTILEVER, loads=(load(1, 0, 2.0),))).displacements[1, 1], rel=1e-12
    )


def test_internal_forces_follow_the_beam_module() -> None:
    out = solve_frame(replace(CANTILEVER, elements=(element(0, 1, load_first=np.array([0.1, 0.2, 0.0])),)))
    forces = out.internal_forces(0)
    # Load 0.1 and 0.2 N/mm at the root falling to zero at the tip, and 2 N along z at the tip.
    assert forces.at(0.0) == pytest.approx([3.0, 6.0, 2.0, 0.0, -120.0, 0.2 * 60**2 / 6], rel=1e-12)
    assert forces.at(60.0) == pytest.approx([0.0, 0.0, 2.0, 0.0, 0.0, 0.0], abs=1e-10)


def test_axis_displacements_join_the_nodes_and_match_a_finer_frame() -> None:
    q = np.array([0.02, -0.05, 0.03])
    one = FrameModel(
        nodes=np.array([[0.0, 0, 0], [70, 40, 0]]), elements=(element(0, 1, load_last=q),), supports=(Support(node=0),)
    )
    fine = FrameModel(
        nodes=np.array([[0.0, 0, 0], [28, 16, 0], [70, 40, 0]]),
        elements=(element(0, 1, load_last=0.4 * q), element(1, 2, load_first=0.4 * q, load_last=q)),
        supports=(Support(node=0),),
    )
    a, b = solve_frame(one), solve_frame(fine)
    along = a.axis_displacements(0, np.array([0.0, 0.4, 1.0]) * one.length(0))
    assert along == pytest.approx(b.displacements[:, :3], rel=1e-9, abs=1e-12)
    assert along[2] == pytest.approx(a.displacements[1, :3], rel=1e-9)


def test_an_end_on_a_pin_carries_no_moment() -> None:
    # Propped cantilever: end on a pin about z, uniform load; its wall moment is q L²/8 but for shear.
    q = np.array([0.0, -0.1, 0.0])
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [300, 0, 0]]),
        elements=(element(0, 1, load_first=q, load_last=q),),
        supports=(Support(node=0), Support(node=1, dofs=PIN)),
    )
    out = solve_frame(model)
    assert out.end_forces[0, 1, 5] == pytest.approx(0.0, abs=1e-9)
    g_area = TUBE.shear_coefficient(0.35) * 2400 / 2.7 * TUBE.area
    alpha = 3 * 2400 * TUBE.i_z / (g_area * 300**2)
    assert out.reactions[0, 5] == pytest.approx(0.1 * 300**2 / 8 / (1 + alpha), rel=1e-10)


def test_pin_tie_passes_moments_in_the_plane_of_the_linkage_only() -> None:
    nodes = np.array([[0.0, 0, 0], [50, 0, 0], [50, 0, 0], [90, 30, 0]])
    model = FrameModel(
        nodes=nodes,
        elements=(element(0, 1), element(2, 3)),
        supports=(Support(node=0), Support(node=3, dofs=frozenset({"ux", "uy"}))),
        ties=(Tie(nodes=(1, 2)),),
        loads=(load(3, 0, 0, 1.5), load(2, 0.3, -0.7)),
    )
    out = solve_frame(model)
    pin = out.joint_wrenches[2]
    assert pin[2] == pytest.approx(-1.5)
    assert pin[3:5] == pytest.approx([-1.5 * 30, 1.5 * 40])
    assert pin[5] == pytest.approx(0.0, abs=1e-12)
    assert out.joint_wrenches[1] == pytest.approx(-pin, abs=1e-12)
    assert out.displacements[1, :5] == pytest.approx(out.displacements[2, :5])
    assert out.displacements[1, 5] != pytest.approx(out.displacements[2, 5], rel=0.1)
    assert out.residual < 1e-13


def test_rigid_arm_moves_the_load_off_the_axis() -> None:
    arm = np.array([[0.0, 0.0, 0.0], [0.0, -3.0, 4.0]])
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [60, 3, -4]]),
        elements=(element(0, 1, offsets=arm),),
        supports=(Support(node=0),),
        loads=(load(1, 5.0),),
    )
    out = solve_frame(model)
    # 5 N along x at y = 3, z = -4 of the axis: N = 5 N with M_y = -20, M_z = -15 N·mm all along.
    assert out.internal_forces(0).at(30.0) == pytest.approx([5, 0, 0, 0, -20, -15], abs=1e-12)
    bent = 15 * 60**2 / (2 * 2400 * TUBE.i_z)
    turn = -15 * 60 / (2400 * TUBE.i_z)
    assert out.end_displacements[0, 1, 1] == pytest.approx(-bent)
    assert out.displacements[1, 5] == pytest.approx(turn)
    by_work = 5 * 60 / (2400 * TUBE.area) + (15**2 + 20**2) * 60 / (2400 * TUBE.i_z) / 5
    assert out.displacements[1, 0] == pytest.approx(by_work)


def test_the_pin_lies_at_the_node_and_the_arm_belongs_to_the_beam() -> None:
    # A pin 3 mm off the axis at each end and a pull along the line of pins: the beam feels the moment of 3 mm.
    arms = np.array([[0.0, -3.0, 0.0], [0.0, -3.0, 0.0]])
    model = FrameModel(
        nodes=np.array([[0.0, 0, 0], [60, 0, 0]]),
        elements=(element(0, 1, offsets=arms),),
        supports=(Support(node=0, dofs=PIN), Support(node=1, dofs=PIN - {"ux"})),
        loads=(load(1, 2.0),),
    )
    forces = solve_frame(model).internal_forces(0).at(30.0)
    assert forces == pytest.approx([2, 0, 0, 0, 0, -6], abs=1e-12)


@pytest.mark.parametrize(
    ("model", "moving"),
    [
        (replace(CANTILEVER, supports=(Support(node=0, dofs=PIN),)), "node 1 along y"),
        (replace(CANTILEVER, supports=()), "node"),
        (replace(CANTILEVER, supports=(Support(node=0, dofs=ALL_DOFS - {"rx"}),)), "about x"),
    ],
)
def test_mechanism_is_refused_and_named(model: FrameModel, moving: str) -> None:
    with pytest.raises(CannotRunError, match=f"is a mechanism: .*{moving}"):
        solve_frame(model)


def test_unbraced_four_bar_is_a_mechanism_and_a_held_drive_stops_it() -> None:
    nodes = np.array([[0.0, 0, 0], [20, 60, 0], [20, 60, 0], [110, 80, 0], [110, 80, 0], [100, 0, 0]])
    model = FrameModel(
        nodes=nodes,
        elements=(element(0, 1), element(2, 3), element(4, 5)),
        supports=(Support(node=0, dofs=PIN), Support(node=5, dofs=PIN)),
        ties=(Tie(nodes=(1, 2)), Tie(nodes=(3, 4))),
        loads=(load(3, 1.0, 0.0, 0.0),),
        names=("A", "B", "B'", "C", "C'", "D"),
    )
    with pytest.raises(CannotRunError, match=r"mechanism.*node (B|C)"):
        solve_frame(model)
    held = solve_frame(replace(model, supports=(Support(node=0), Support(node=5, dofs=PIN))))
    assert held.reactions[0, 5] != 0.0
    assert held.residual < 1e-13


def test_loaded_rotation_without_stiffness_is_refused_and_an_idle_one_dropped() -> None:
    truss = FrameModel(
        nodes=np.array([[0.0, 0, 0], [100, 0, 0], [50, 40, 0], [50, 40, 0], [50, 40, 0]]),
        elements=(element(0, 3), element(1, 4)),
        supports=(Support(node=0, dofs=PIN), Support(node=1, dofs=PIN), Support(node=2, dofs=PLANE)),
        ties=(Tie(nodes=(2, 3)), Tie(nodes=(2, 4))),
        loads=(load(2, 0.0, -1.0),),
    )
    out = solve_frame(truss)
    assert out.internal_forces(0).at(10.0)[0] == pytest.approx(-0.5 / np.sin(np.arctan2(40, 50)))
    with pytest.raises(CannotRunError, match="node 2 about z"):
        solve_frame(replace(truss, loads=(load(2, 0, -1, 0, 0, 0, 1e-3),)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"nodes": np.array([[0.0, 0, 0], [0, 0, 0]])}, "no length"),
        ({"nodes": np.array([[0.0, 0, 0], [0, 0, 5]])}, "along its own z_axis"),
        ({"nodes": np.array([[0.0, 0], [60, 0]])}, "finite numbers"),
        ({"nodes": np.array([[0.0, 0, 0], [np.nan, 0, 0]])}, "finite numbers"),
        ({"loads": (load(2, 1.0),)}, "nodes 0 to 1"),
        ({"ties": (Tie(nodes=(0, 1)),)}, "different places"),
        ({"names": ("A",)}, "as many names"),
        ({"elements": ()}, "at least one element"),
    ],
)
def test_bad_models_are_refused(change: dict, message: str) -> None:
    with pytest.raises(CannotRunError, match=message):
        replace(CANTILEVER, **change)


def test_bad_stiffness_is_refused() -> None:
    with pytest.raises(CannotRunError, match="positive stiffness"):
        element(0, 1, young=0.0)
    with pytest.raises(CannotRunError, match="positive stiffness"):
        element(0, 1, poisson=0.6)


def test_unloaded_frame_rests() -> None:
    out = solve_frame(replace(CANTILEVER, loads=()))
    assert not out.displacements.any()
    assert out.residual == 0.0


def test_forces_that_do_not_balance_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """A factor that leaves out a part of the element's answer: the whole frame no longer balances."""
    import alula.fea.frame.equations

    wrong = alula.fea.frame.equations.natural_deformations(60.0) * (1.0 + 1e-7)
    monkeypatch.setattr(alula.fea.frame.equations, "natural_deformations", lambda length: wrong)
    alula.fea.frame.equations._known.cache_clear()
    with pytest.raises(CannotRunError, match=r"leave .* of the load unbalanced"):
        solve_frame(CANTILEVER)
    alula.fea.frame.equations._known.cache_clear()


def test_frames_that_differ_in_their_loads_alone_share_one_factorisation() -> None:
    from alula.fea.frame.equations import equations_of

    first = equations_of(CANTILEVER)
    spread = element(0, 1, section=BAR, load_first=np.array([0.1, 0.2, 0.0]))
    assert equations_of(replace(CANTILEVER, elements=(spread,), loads=(load(1, 2.0, 0, 3.0),))) is first
    for other in (
        replace(CANTILEVER, nodes=CANTILEVER.nodes * 1.01),
        replace(CANTILEVER, elements=(replace(CANTILEVER.elements[0], young=1.0),)),
        replace(CANTILEVER, elements=(replace(CANTILEVER.elements[0], offsets=np.full((2, 3), 0.1)),)),
        replace(CANTILEVER, supports=(Support(node=1),)),
    ):
        assert equations_of(other) is not first


def test_a_solved_frame_can_be_pickled() -> None:
    """A result keeps the frame of its pins, and could not be written to a file with the factors in it."""
    from alula.fea.frame.linear import FactorisedFrame

    solved = FactorisedFrame(replace(CANTILEVER, loads=(load(1, 0.0, 0.0, -3.0),)))
    kept = pickle.loads(pickle.dumps(solved))
    rows = np.array([0, 2])
    assert np.abs(solved.opened(rows)).max() > 0.0
    np.testing.assert_array_equal(kept.opened(rows), solved.opened(rows))
    np.testing.assert_array_equal(kept.own, solved.own)


def test_a_moment_about_what_nothing_turns_is_refused_beside_a_known_frame() -> None:
    tied = replace(CANTILEVER, nodes=np.vstack([CANTILEVER.nodes, CANTILEVER.nodes[1]]), ties=(Tie(nodes=(1, 2)),))
    solve_frame(tied)
    with pytest.raises(CannotRunError, match=r"the frame is a mechanism"):
        solve_frame(replace(tied, loads=(load(2, 0, 0, 0, 0, 0, 1.0),)))


def test_forces_along_an_element_that_do_not_balance_are_refused() -> None:
    out = solve_frame(replace(CANTILEVER, loads=(load(1, 0, 2.0),)))
    ends = out.end_forces[0, 1]
    assert out.internal_forces(0).at(60.0) == pytest.approx(ends, abs=1e-9)
    forces = out.end_forces.copy()
    forces[0, 1, 5] += 0.1
    with pytest.raises(CannotRunError, match="do not balance"):
        _ = replace(out, end_forces=forces).forces_along
