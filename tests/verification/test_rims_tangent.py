"""The tangent of pins that stand in their holes: by hand, against further states, and in frequencies and stability."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tilting_pins import ALUMINIUM, PLA, TIGHT, checked, four_bar, loaded

from alula.fea.check.run import check_case
from alula.fea.common.verdict import LINKAGE, Quantity
from alula.fea.frame.build import build_frame
from alula.fea.nonlinear.corotational import SUBDIVISIONS
from alula.fea.nonlinear.on_rims import Extended, divided, rim_factors
from alula.fea.nonlinear.stability import COARSE_SUBDIVISIONS, LARGE, buckling_factor, span
from alula.fea.pins.clearances import HeadGap
from alula.fea.pins.programme import least_in_discs
from alula.fea.pins.states import PinStates
from alula.fea.pins.tangent import tangent_of
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.vibration.linkage_modes import RimModes, divide, linkage_modes, on_rims
from alula.fea.vibration.mass_matrix import mass_matrix
from alula.loads.case.case import Case
from alula.loads.states.actions import acting_loads, placed
from alula.loads.states.masses import part_masses
from alula.reports.sentences import told


def pins_of(case: Case) -> PinStates:
    found = solve_case_statics(case).forces["l"].pins
    assert found is not None
    return found


def with_clearance(pins: PinStates, size: float, apart: float | None = None) -> PinStates:
    """The same pins with one clearance in every hole that is not pressed, and heads that keep both rims so near."""
    kept = [replace(one, low=size, value=size, high=size) for one in pins.radii.clearances if one.value > 0.0]
    numbers = [n for n, one in zip(pins.radii.numbers, pins.radii.clearances, strict=True) if one.value > 0.0]
    every = tuple(k for own in numbers for k in own)
    held = (HeadGap(numbers=every, low=(apart,) * len(every), high=(apart,) * len(every)),) if apart else ()
    return replace(pins, radii=replace(pins.radii, clearances=tuple(kept), numbers=tuple(numbers), heads=held))


def test_a_pin_seated_on_two_rims_is_closed_along_its_force_and_a_pendulum_across():
    """A stub under F = 3 N along (4, 5)/√41 through the middle of its hole: R = F/2 at both rims, R/r across."""
    along = np.array([4.0, 5.0]) / math.sqrt(41.0)
    radius, forces = 0.02, np.tile(1.5 * along, 2)
    found = tangent_of(np.full(2, radius), np.tile(radius * along, 2), forces)
    assert found.touching == 2
    assert found.force == pytest.approx(1.5)
    assert found.stiffness == pytest.approx([75.0, 75.0])
    assert found.ways.shape == (4, 2)
    assert found.ways.reshape(2, 2, 2).swapaxes(1, 2) @ along == pytest.approx(np.zeros((2, 2)))


def test_a_rim_that_does_not_touch_is_free_and_a_pressed_hole_is_closed():
    forces, v = np.array([0.0, 2.0, 0.0, 0.0]), np.array([0.0, 0.01, 0.003, 0.0])
    found = tangent_of(np.full(2, 0.01), v, forces)
    assert found.stiffness == pytest.approx([200.0, 0.0, 0.0])
    assert np.abs(found.ways).sum(axis=1) == pytest.approx([1.0, 0.0, 1.0, 1.0])
    assert tangent_of(np.zeros(2), np.zeros(4), forces).ways.shape == (4, 0)


def test_a_pin_in_the_middle_of_its_hole_is_free_beside_one_that_is_pressed():
    """Where loads are but rounding, nothing of them presses there; the pressed hole bears its own force."""
    found = tangent_of(np.array([0.01, 0.0]), np.zeros(4), np.array([1.0, 0.0, 0.0, 3.0]))
    assert (found.touching, found.force) == (0, 3.0)
    assert found.stiffness == pytest.approx([0.0, 0.0])
    assert np.abs(found.ways).sum(axis=1) == pytest.approx([1.0, 1.0, 0.0, 0.0])


@pytest.mark.parametrize(("clearance", "apart"), [(0.002, None), (0.01, None), (0.01, 0.002), (0.01, 0.007)])
@pytest.mark.parametrize("material", [ALUMINIUM, PLA])
def test_the_tangent_says_how_pins_move_under_a_little_more_load(material, clearance, apart):
    """dv = N (Nᵀ K N + T)⁺ Nᵀ dg but for what strains nothing, against the state under other loads, found anew."""
    pins = with_clearance(pins_of(loaded(material, ["0 N", "-20 N"], TIGHT)), clearance, apart)
    ties = pins.radii.ties
    K, g, radii = pins.rims.K, pins.rims.g, pins.radii.of(pins.radii.value[None])[0]
    more = K @ np.random.default_rng(5).uniform(-1.0, 1.0, len(g))
    more *= 1e-4 * np.abs(g).max() / np.abs(more).max()
    ahead, behind = (least_in_discs(K, g + sign * more, radii, 1e-13, ties).v[0] for sign in (1.0, -1.0))
    between = np.diff(pins.value.reshape(-1, 2, 2), axis=1)
    assert (np.linalg.norm(between, axis=-1).max() > 0.999 * apart) if apart else not len(ties)
    found = pins.tangent(pins.radii.value, pins.value)
    held = found.ways.T @ K @ found.ways + np.diag(found.stiffness)
    moved = K @ found.ways @ np.linalg.pinv(held, rcond=1e-11, hermitian=True) @ found.ways.T @ more
    assert K @ (ahead - behind) / 2.0 == pytest.approx(moved, abs=1e-3 * np.abs(moved).max())


@pytest.mark.parametrize("material", [ALUMINIUM, PLA])
def test_without_clearance_the_factor_is_that_of_tight_pins(material):
    pins = pins_of(loaded(material, ["0 N", "-5 N"]))
    tight = buckling_factor(pins.rims.frame.model, COARSE_SUBDIVISIONS)
    path = divided(pins, COARSE_SUBDIVISIONS)
    for clearance, near in ((1e-6, 1e-4), (1e-5, 2e-3)):
        small = with_clearance(pins, clearance)
        assert path.extended(small.tangent(small.radii.value, small.value)).factor() == pytest.approx(tight, rel=near)


def test_a_factor_is_told_where_it_is_less_than_one_that_is_known():
    pins = with_clearance(pins_of(loaded(PLA, ["0 N", "-5 N"])), 0.01)
    known = divided(pins, COARSE_SUBDIVISIONS).extended(pins.tangent(pins.radii.value, pins.value))
    factor = known.factor()
    assert 0.0 < factor < math.inf
    for share in (0.5, 0.999):
        assert known.factor(below=share * factor) == share * factor
    for share in (1.001, 2.0):
        assert known.factor(below=share * factor) == pytest.approx(factor, rel=1e-9)
    late = replace(known, plain=np.diag([-1.0, 10.0]), pressed=np.diag([0.5, -2.0]), free=np.zeros((2, 0)))
    assert late.factor(below=3.0) == 0.0, "it is stable at 3, but not on the way there"


def test_condensed_to_its_rims_the_divided_frame_is_that_of_the_programme():
    pins = pins_of(loaded(PLA, ["0 N", "-1 N"]))
    path = divided(pins, COARSE_SUBDIVISIONS)
    found = path.extended(
        replace(
            pins.tangent(pins.radii.value, pins.value),
            ways=np.eye(len(pins.rims.g)),
            stiffness=np.ones(len(pins.rims.g)),
        )
    )
    count = found.allowed.shape[1]
    K, C, D = found.plain[:count, :count], found.plain[:count, count:], found.plain[count:, count:]
    left = np.linalg.eigvalsh(D - C.T @ np.linalg.solve(K, C))
    assert left == pytest.approx(np.linalg.eigvalsh(pins.rims.K), abs=1e-9 * np.abs(D).max())


def hung(force: float, clearance: str) -> tuple[RimModes, float]:
    """A bar that a force pulls along itself off a pin in the ground, and its moment of inertia about its axis."""
    data = four_bar(tight={})
    data["links"] = {name: data["links"][name] for name in ("base", "crank")}
    del data["links"]["base"]["points"]["O4"]
    data["joints"] = {"O2": {**data["joints"]["O2"], "clearance": {"crank": clearance, "base": "0 mm"}}}
    data["pose"] = {"coordinate": "crank", "angle": "0 deg"}
    pull = {"link": "crank", "at": "A", "force": [f"{force} N", "0 N"]}
    data["load_cases"] = {"l": {"forces": [pull], "own_weight": False}}
    case = checked(data)
    masses, pose = part_masses(case), case.solve_pose()
    loads = acting_loads(case, case.load_cases["l"], placed(pose, 0.0), masses)
    frame = build_frame(case, pose, loads, held=case.pinned_drive)
    modes = on_rims(case, linkage_modes(case, "l", frame, masses), masses)
    assert modes.rims is not None
    model, parents = divide(frame, 4)
    rolling = np.zeros((len(model.nodes), 6))
    rolling[:, 3] = 1.0
    inertia, _ = mass_matrix(case, frame, model, parents, masses).energies(rolling)
    return modes.rims, inertia


@pytest.mark.parametrize(("force", "clearance"), [(4.0, 0.1), (1.0, 0.1), (4.0, 0.2)])
def test_a_bar_hung_on_a_pin_rolls_as_a_pendulum(force, clearance):
    """R = F/2 at the rims of a hole of t = 4 mm gives 2 (R/r) (t/2)² against a roll about the force."""
    rims, inertia = hung(force, f"{clearance} mm")
    stiffness = 2.0 * (force / 2.0) / (clearance / 2.0) * 2.0**2
    assert (rims.touching, rims.rims, rims.force) == (2, 2, pytest.approx(force / 2.0))
    assert rims.frequency is not None
    assert rims.frequency.value == pytest.approx(math.sqrt(stiffness / inertia) / (2.0 * math.pi), rel=5e-3)


def test_a_tie_that_hangs_on_one_rim_at_either_end_rolls_without_stiffness():
    """Its coupler, of the aluminium four-bar at 20 N, turns about the line through both rims: forces do no work."""
    pins = pins_of(loaded(ALUMINIUM, ["0 N", "-20 N"], TIGHT))
    assert pins.tangent(pins.radii.value, pins.value).touching == 2
    known = divided(pins, COARSE_SUBDIVISIONS).extended(pins.tangent(pins.radii.value, pins.value))
    work = np.linalg.eigvalsh(known.free.T @ known.pressed @ known.free)
    assert np.abs(work).min() < 1e-9 * np.abs(work).max()
    assert (work > -1e-9 * np.abs(work).max()).all()
    assert 10.0 < known.factor() < 27.0


def test_a_lean_that_rims_stop_leaves_the_factor_of_all_else():
    """Two motions apart: one that strains nothing and that the load drives, one of stiffness 12 that it drives by 2."""
    known = Extended(
        allowed=np.eye(2), plain=np.diag([0.0, 12.0]), pressed=np.diag([-1.0, -2.0]), free=np.array([[1.0], [0.0]])
    )
    assert known.factor() == 0.0
    assert known.factor(stopped=True) == pytest.approx(6.0)
    held = replace(known, pressed=np.diag([1.0, -2.0]))
    assert held.factor() == pytest.approx(6.0)
    idle = replace(known, pressed=np.diag([0.0, -2.0]))
    assert idle.factor() == pytest.approx(6.0)


def test_pins_within_their_rims_move_points_no_further_than_told():
    """Against places in the discs, drawn: the bound adds up what the worst of them does at each rim by itself."""
    pins = with_clearance(pins_of(loaded(PLA, ["0 N", "-5 N"])), 0.1)
    radii = np.repeat(pins.radii.of(pins.radii.value[None])[0][0], 2)
    turns = np.random.default_rng(0).uniform(0.0, 2.0 * math.pi, (200, len(radii) // 2))
    tight = pins.answer(np.zeros_like(radii)).displacements[:, :3]
    moved = [
        np.linalg.norm(pins.answer(radii * at.ravel()).displacements[:, :3] - tight, axis=1).max()
        for at in np.stack([np.cos(turns), np.sin(turns)], axis=2)
    ]
    assert pins.reaches(pins.radii.largest)[0] / 2.0 < max(moved) <= pins.reaches(pins.radii.largest)[0]


@pytest.mark.parametrize(("share", "holds"), [(0.99, True), (1.01, False)])
def test_a_lean_counts_where_it_may_be_a_large_displacement(share, holds):
    pins = pins_of(loaded(PLA, ["0 N", "-5 N"]))
    limit = LARGE * span(pins.rims.frame.pose) / pins.reaches(with_clearance(pins, 1.0).radii.largest)[0]
    pins = with_clearance(pins, share * limit)
    assert divided(pins, COARSE_SUBDIVISIONS).extended(pins.tangent(pins.radii.value, pins.value)).factor() == 0.0
    found = rim_factors(pins)
    assert (found.value > 2.0, found.low > 2.0) == (holds, holds)


@pytest.mark.parametrize("load", ["-80 N", "80 N"])
def test_no_place_of_the_pins_that_is_drawn_leans_at_less_than_is_told(load):
    """Where holes are open the linkage leans in some, in none of those in which its links and pins bear most."""
    pins = pins_of(loaded(ALUMINIUM, ["0 N", load]))
    draw, count = np.random.default_rng(5), (40, len(pins.radii.value))
    drawn = np.choose(draw.integers(3, size=count), (draw.uniform(size=count), np.zeros(count), np.ones(count)))
    path = divided(pins, COARSE_SUBDIVISIONS)

    def least(shares):
        stood = zip(shares, pins.solved(shares).v, strict=True)
        return min(path.extended(pins.tangent(*one)).factor() for one in stood)

    assert rim_factors(pins).low <= least(drawn)
    assert least(pins.extremes) > least(drawn)


@pytest.mark.parametrize(("material", "young", "load"), [(ALUMINIUM, 70000.0, "20 N"), (PLA, 2500.0, "1 N")])
def test_a_link_by_itself_buckles_across_the_plane_as_a_bar_on_two_pins(material, young, load):
    """π² E I/L² with I = 8 · 4³/12 mm⁴, for pins that run hold no angle: tight ones are the upper end alone."""
    result = check_case(loaded(material, ["0 N", load]), fidelity="beam").load_cases["l"]
    [found] = [one for one in result.checks if one.link == "coupler" and one.quantity is Quantity.BUCKLING_FACTOR]
    compression = -result.links["coupler"].beam.forces.at(60.0, "before")[0]
    euler = math.pi**2 * young * 8.0 * 4.0**3 / 12.0 / 120.0**2
    assert found.value.value == pytest.approx(euler / compression, rel=0.02)
    assert found.value.high > 3.5 * found.value.value


@pytest.mark.parametrize("clearance", ["0.02 mm", "0.4 mm"])
def test_the_linkage_is_told_with_pins_in_their_holes(clearance):
    """Wide clearances let it lean or lower its factor, and no check passes by pins that nobody stated tight."""
    data = four_bar(tight=TIGHT, checks={"s": {"type": "safety-factor", "minimum": 2.0}})
    for joint, link in {"O2": "base", "A": "coupler", "B": "coupler", "O4": "base"}.items():
        data["joints"][joint]["clearance"] = {link: clearance}
    result = check_case(checked(data), fidelity="beam").load_cases["l"]
    [found] = [one for one in result.checks if one.subject == LINKAGE and one.quantity is Quantity.BUCKLING_FACTOR]
    pins = pins_of(checked(data))
    tight = buckling_factor(pins.rims.frame.model)
    factor = divided(pins, SUBDIVISIONS).extended(pins.tangent(pins.radii.value, pins.value)).factor()
    assert 0.0 < factor < 0.98 * tight
    assert found.value.value == pytest.approx(factor, rel=1e-3)
    assert found.value.low < factor
    assert found.value.high >= tight
    assert f"becomes unstable at {factor:.3g} times its load" in told(found.reason)


def test_no_state_is_sought_where_none_of_any_clearance_moves_points_far(monkeypatch):
    """The bound of the largest radii is above that of every state, and factors are those with a search."""
    pins = pins_of(loaded(PLA, ["0 N", "-5 N"]))
    shares = np.random.default_rng(2).uniform(size=(50, len(pins.radii.value)))
    [most] = pins.reaches(pins.radii.largest)
    assert 0.0 < pins.reaches(pins.radii.of(shares)[0]).max() <= most
    limit = LARGE * span(pins.rims.frame.pose) / most
    small = replace(pins, radii=scaled(pins.radii, 0.99 * limit))
    searched = rim_factors(replace(small))
    monkeypatch.setattr(PinStates, "extremes", property(lambda self: pytest.fail("sought")))
    assert rim_factors(replace(small)) == searched
    with pytest.raises(pytest.fail.Exception, match="sought"):
        rim_factors(replace(pins, radii=scaled(pins.radii, 1.01 * limit)))


def scaled(radii, factor):
    """The same with all clearances times a factor."""
    own = ((one, {end: factor * getattr(one, end) for end in ("low", "value", "high")}) for one in radii.clearances)
    return replace(radii, clearances=tuple(replace(one, **ends) for one, ends in own))
