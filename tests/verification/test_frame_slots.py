"""Slots and sliders in frames: equilibrium alone in the plane, balance out of it and on the deformed shape, chains.

The chains are a second model of large displacement that shares nothing with the co-rotational frame: rigid segments
with rotational springs between them (Hencky's bar chain), their directions the unknowns, joints and slots as
constraints, equilibrium as the stationary point of the energy by scipy's SLSQP.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from edited_cases import PLANAR
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from slotted_cases import (
    imbalance,
    oscillating_cylinder,
    pin_on_the_ground,
    quick_return,
    scotch_yoke,
    slider_crank,
)

from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import FrameModel, Guide
from alula.fea.nonlinear.corotational import solve_large_displacement, subdivide
from alula.fea.nonlinear.corotational_element import guide_gap
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.standing.joint_forces import PINNED_FRAME, joint_forces
from alula.geometry.base.errors import CannotRunError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import PointLoad
from alula.loads.statics.statics import solve_statics


def bent_cylinder() -> Case:
    return oscillating_cylinder(bent=20.0)


MAKERS = [slider_crank, quick_return, scotch_yoke, oscillating_cylinder, bent_cylinder, pin_on_the_ground]


def loads_on(case: Case, *, plane: bool) -> tuple[PointLoad, ...]:
    """A force and a moment at every point of every moving link."""
    rng = np.random.default_rng(1)
    in_plane = np.array([1.0, 1, 0, 0, 0, 20]) if plane else np.array([1.0, 1, 1, 10, 10, 20])
    return tuple(
        PointLoad(link=link, point=point, wrench=in_plane * rng.normal(size=6))
        for link in case.linkage.moving
        for point in case.links[link].points
    )


def turned_points(case, pose, frame, displacements):
    moved = frame.at_points(displacements)
    return {
        key: np.array([*pose.position(*key), 0.0]) + moved.get(key, np.zeros(3)) for key in pose.closure.point_names
    }


def assert_same(found, expected):
    size = max(joint.magnitude for joint in expected.joints.values())
    longest = expected.pose.linkage.longest
    for name, joint in expected.joints.items():
        assert np.abs(found.joints[name].wrench - joint.wrench).max() < 1e-9 * size * longest, name
        assert np.abs(found.joints[name].wrench[:3] - joint.wrench[:3]).max() < 1e-9 * size, name
        assert found.joints[name].arm == pytest.approx(joint.arm, abs=1e-9 * longest)
    assert found.drive_torque == pytest.approx(expected.drive_torque, abs=1e-9 * size * longest)
    assert found.unknowns == pytest.approx(expected.unknowns, abs=1e-9 * size * longest)


@pytest.mark.parametrize("make", MAKERS)
def test_in_the_plane_the_frame_repeats_equilibrium(make: Callable[[], Case]) -> None:
    case = make()
    pose, loads = case.solve_pose(), loads_on(case, plane=True)
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    solution = solve_frame(frame.model)
    assert_same(
        frame.reactions(solution.joint_wrenches, solution.residual), solve_statics(pose, case.pinned_drive, loads)
    )


@pytest.mark.parametrize("angle", [90, 40, 200, -75])
def test_so_it_does_for_the_ornithopter(angle: float) -> None:
    """Three half joints at one pin: the guide on the ground and a slot in each lever."""
    case = read_case("ornithopter", [PLANAR, f'pose.angle="{angle} deg"'])
    pose = case.solve_pose()
    loads = tuple(
        PointLoad(link=link, point="W", wrench=np.array([0.1, -0.3, 0, 0, 0, 0.4]))
        for link in ("lever-left", "lever-right")
    )
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    solution = solve_frame(frame.model)
    assert_same(
        frame.reactions(solution.joint_wrenches, solution.residual), solve_statics(pose, case.pinned_drive, loads)
    )
    found = joint_forces(case, pose, (*loads, PointLoad(link="rod", point="C", wrench=np.array([0, 0, 0.2, 0, 0, 0]))))
    assert found.model == PINNED_FRAME
    size = max(joint.magnitude for joint in found.reactions.joints.values())
    assert imbalance(found.reactions, found.frame.loads) < 1e-9 * size
    for name in ("guide", "slot-right", "slot-left"):
        joint = case.joints[name]
        along = pose.angles[joint.links[0]] + joint.direction
        wrench = found.reactions.joints[name].wrench
        assert abs(wrench[:2] @ [np.cos(along), np.sin(along)]) < 1e-9 * size
        assert abs(wrench[5]) < 1e-9 * size


def test_the_ornithopter_is_looked_into_in_large_displacement() -> None:
    case = read_case("ornithopter")
    pose = case.solve_pose()
    loads = (PointLoad(link="lever-left", point="W", wrench=np.array([0, -0.3, 0, 0, 0, 0.0])),)
    found = examine(case, "slow", joint_forces(case, pose, loads), loads)
    assert found.state == "small"
    assert 0.0 < found.share < 1e-2


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("plane", [True, False])
def test_links_balance_on_the_deformed_shape(make: Callable[[], Case], plane: bool) -> None:
    case = make()
    pose, loads = case.solve_pose(), loads_on(case, plane=plane)
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    found = solve_large_displacement(frame.model, 2)
    count = len(frame.model.nodes)
    reactions = frame.reactions(found.joint_wrenches[:count], found.residual, found.displacements[:count])
    size = max(joint.magnitude for joint in reactions.joints.values())
    place = turned_points(case, pose, frame, found.displacements)
    assert np.abs(found.displacements).max() > 0.1
    assert imbalance(reactions, loads, place) < 1e-7 * size
    assert np.abs(found.joint_wrenches[:, :3].sum(axis=0) + sum(load.wrench[:3] for load in loads)).max() < 1e-7 * size
    for guide in found.model.guides:
        d = sum(sign * found.displacements[node] for node, sign in guide.nodes)
        turn = np.eye(3) if guide.carrier is None else found.rotations[guide.carrier]
        assert abs(d @ (turn @ guide.normal)) < 1e-9 * found.model.size


@pytest.mark.parametrize("make", [quick_return, slider_crank, oscillating_cylinder, pin_on_the_ground])
def test_the_tangent_with_guides_is_the_derivative_of_the_balance(make: Callable[[], Case]) -> None:
    """Central differences at a deformed state with forces in the guides, out of the plane as well."""
    case = make()
    frame = build_frame(case, case.solve_pose(), loads_on(case, plane=False), held=case.pinned_drive)
    path = EquilibriumPath(subdivide(frame.model, 2))
    rng = np.random.default_rng(3)
    unit = path.unit
    count = path.chain.count
    unit[count:] = 30.0
    state = path._moved(path.state, rng.normal(size=len(unit)) * unit * 0.02 * np.where(path.unit < 1, 5, 1))
    _, tangent = path.balance(state, 0.7)
    assert np.abs(state.guide_forces).max() > 0.1
    for _ in range(6):
        way = rng.normal(size=len(unit)) * unit
        h = 1e-5
        ends = [path.balance(path._moved(state, sign * h * way), 0.7)[0] for sign in (1.0, -1.0)]
        difference = (ends[0] - ends[1]) / (2.0 * h)
        scaled = difference * unit
        assert scaled == pytest.approx(tangent @ way * unit, abs=2e-8 * np.abs(scaled).max())
        # The gaps themselves, which are small beside the elements' forces.
        assert difference[count:] == pytest.approx((tangent @ way)[count:], abs=1e-7)


class Chain:
    """A bar as ``n`` rigid segments; springs of E I between their middles."""

    def __init__(self, first: int, start: complex, end: complex, n: int, stiffness: float) -> None:
        self.span = slice(first, first + n)
        self.rest = np.full(n, np.angle(end - start))
        self.length = abs(end - start) / n
        self.spring = stiffness / self.length

    def nodes(self, t: np.ndarray, start: complex) -> np.ndarray:
        return start + np.concatenate([[0], np.cumsum(self.length * np.exp(1j * t[self.span]))])

    def energy(self, t: np.ndarray, *, clamped: bool = False) -> float:
        bent = np.diff(t[self.span] - self.rest)
        held = 2.0 * (t[self.span][0] - self.rest[0]) ** 2 if clamped else 0.0
        return 0.5 * self.spring * float(np.sum(bent**2) + held)


def stationary(energy, constraint, start):
    """Directions [rad] of least energy, from the undeformed ones; SLSQP on unit-sized energy."""
    scale = 1e-2
    found = minimize(
        lambda t: energy(t) * scale,
        start,
        method="SLSQP",
        constraints={"type": "eq", "fun": constraint},
        options={"ftol": 1e-15, "maxiter": 500},
    )
    assert np.abs(constraint(found.x)).max() < 1e-7
    return found.x


def stiffness_of(case: Case) -> float:
    return case.material_of("crank").youngs_modulus * case.part_of("crank").section.i_z


def displaced(case: Case, loads, keys):
    """Places of points by the co-rotational frame, its beams without shear and lengthening, which chains lack too."""
    pose = case.solve_pose()
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    beams = [replace(e, section=replace(e.section, area=1e3 * e.section.area)) for e in frame.model.elements]
    found = solve_large_displacement(replace(frame.model, elements=tuple(beams)), 8)
    moved = turned_points(case, pose, frame, found.displacements)
    return found, [complex(*moved[key][:2]) for key in keys]


def extrapolated(coarse: complex, fine: complex) -> complex:
    """Chains converge with the square of the segment's length."""
    return fine + (fine - coarse) / 3.0


def test_a_slotted_lever_bends_as_its_chain_does() -> None:
    """The tip of the lever moves by a fifth of its length, the slot and the pin in it along with it."""
    case = quick_return()
    pose, stiffness = case.solve_pose(), stiffness_of(case)
    foot, B, E = (complex(*pose.position(*key)) for key in (("lever", "O"), ("crank", "B"), ("lever", "E")))
    force = -5.0 + 2.0j

    def chain(n: int) -> tuple[complex, complex]:
        crank = Chain(0, 0j, B, n, stiffness)
        lower, upper = Chain(n, foot, B, n, stiffness), Chain(2 * n, B, E, n, stiffness)
        joint = stiffness / ((lower.length + upper.length) / 2.0)

        def energy(t):
            tip = upper.nodes(t, lower.nodes(t, foot)[-1])[-1]
            knee = t[2 * n] - t[2 * n - 1]
            own = crank.energy(t, clamped=True) + lower.energy(t) + upper.energy(t) + 0.5 * joint * knee**2
            return own - (np.conj(force) * tip).real

        def constraint(t):
            # The slot is straight, along the lever's direction where the pin stands: the mean of its neighbours'.
            pin, station = crank.nodes(t, 0j)[-1], lower.nodes(t, foot)[-1]
            return np.array([(np.exp(-0.5j * (t[2 * n - 1] + t[2 * n])) * (pin - station)).imag])

        start = np.concatenate([crank.rest, lower.rest, upper.rest])
        t = stationary(energy, constraint, start)
        return crank.nodes(t, 0j)[-1], upper.nodes(t, lower.nodes(t, foot)[-1])[-1]

    load = (PointLoad(link="lever", point="E", wrench=np.array([force.real, force.imag, 0, 0, 0, 0])),)
    found, (b, e) = displaced(case, load, [("crank", "B"), ("lever", "E")])
    coarse, fine = chain(8), chain(16)
    moved = abs(e - E)
    assert found.stable
    assert moved > 0.2 * abs(E - foot)
    assert abs(b - B) > 1.0
    assert abs(b - extrapolated(coarse[0], fine[0])) < 3e-4 * moved
    assert abs(e - extrapolated(coarse[1], fine[1])) < 3e-4 * moved


def test_a_slider_crank_bends_as_its_chain_does() -> None:
    """Rod and crank bend under a force on the block and one across the rod; the block stays on its guide."""
    case = slider_crank()
    pose, stiffness = case.solve_pose(), stiffness_of(case)
    B, M, C = (complex(*pose.position("rod", p)) for p in ("B", "M", "C"))
    push, across = -12.0 + 0j, 3 - 16j

    def chain(n: int) -> tuple[complex, complex]:
        crank, rod = Chain(0, 0j, B, n, stiffness), Chain(n, B, C, 2 * n, stiffness)

        def places(t):
            along = rod.nodes(t, crank.nodes(t, 0j)[-1])
            return along[n], along[-1]

        def energy(t):
            middle, block = places(t)
            work = (np.conj(across) * middle + np.conj(push) * block).real
            return crank.energy(t, clamped=True) + rod.energy(t) - work

        t = stationary(energy, lambda t: np.array([places(t)[1].imag - C.imag]), np.concatenate([crank.rest, rod.rest]))
        return places(t)

    loads = tuple(
        PointLoad(link=link, point=point, wrench=np.array([force.real, force.imag, 0, 0, 0, 0]))
        for link, point, force in (("rod", "M", across), ("block", "Q", push))
    )
    found, (middle, block) = displaced(case, loads, [("rod", "M"), ("rod", "C")])
    coarse, fine = chain(8), chain(16)
    moved = max(abs(middle - M), abs(block - C))
    assert found.stable
    assert moved > 0.1 * pose.linkage.longest
    assert block.imag == pytest.approx(C.imag, abs=1e-9 * pose.linkage.longest)
    assert abs(middle - extrapolated(coarse[0], fine[0])) < 1e-4 * moved
    assert abs(block - extrapolated(coarse[1], fine[1])) < 1e-4 * moved


def test_what_no_guide_can_be_is_refused() -> None:
    frame = build_frame(quick_return(), quick_return().solve_pose(), (), held=quick_return().pinned_drive)
    for wrong, message in (
        (lambda: Guide(carrier=0, pin=1, normal=np.array([0, 2.0, 0])), "unit length"),
        (lambda: Guide(carrier=None, pin=None, normal=np.array([0, 1.0, 0])), "two different nodes"),
        (lambda: rebuilt(frame.model, Guide(carrier=0, pin=1, normal=np.array([0, 1.0, 0]))), "different places"),
        (lambda: rebuilt(frame.model, Guide(carrier=99, pin=0, normal=np.array([0, 1.0, 0]))), "nodes 0 to"),
    ):
        with pytest.raises(CannotRunError, match=message):
            wrong()


def rebuilt(model: FrameModel, guide: Guide) -> FrameModel:
    return replace(model, guides=(guide,))


@pytest.mark.parametrize("axis", [None, np.array([0.0, 0.6, 0.8])])
@pytest.mark.parametrize("nodes", [(0, 1), (None, 1), (0, None)])
def test_a_guides_gradient_and_curvature_are_the_derivatives_of_its_gap(axis, nodes) -> None:
    """By central differences in displacements and spins; rows and columns of the ground stand for nothing."""
    rng = np.random.default_rng(7)
    guide = Guide(carrier=nodes[0], pin=nodes[1], normal=np.array([0.48, -0.6, 0.64]), axis=axis)
    displacements = rng.normal(size=(2, 3))
    rotations = Rotation.from_rotvec(rng.normal(size=(2, 3))).as_matrix()

    ground = np.array([node is None for node in nodes])
    displacements[ground], rotations[ground] = 0.0, np.eye(3)

    def at(change: np.ndarray):
        parts = change.reshape(2, 6)
        turned = Rotation.from_rotvec(parts[:, 3:]).as_matrix() @ rotations
        gap, unit = guide_gap(guide, displacements + parts[:, :3], turned)
        return gap, unit.forces[0], unit.tangent[0]

    free = [i for i in range(12) if nodes[i // 6] is not None]
    _, gradient, curvature = at(np.zeros(12))
    h = 1e-6
    for i in free:
        ends = [at(sign * h * np.eye(12)[i]) for sign in (1.0, -1.0)]
        assert gradient[i] == pytest.approx((ends[0][0] - ends[1][0]) / (2 * h), abs=1e-9)
        assert curvature[free, i] == pytest.approx((ends[0][1] - ends[1][1])[free] / (2 * h), abs=1e-9)
