"""What friction may be, in bands: against direct calculations at and between its ends, and where a linkage locks."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from edited_cases import PLANAR, edited
from numpy.typing import NDArray

from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.motion.loosened import column_growth, joint_growth, otherwise
from alula.fea.standing.case_statics import solve_case_statics, with_ends
from alula.fea.standing.joint_forces import JointForces
from alula.fea.standing.rubbing import at_end, bore_presses
from alula.fea.whole.motor import motor_outcomes
from alula.fea.whole.rubbed_motion import rubbed_motion, work_between
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.case.joint_rules import rubbing_joints
from alula.loads.records.applied import FrictionLoad
from alula.loads.states.rubbing import pose_friction
from alula.loads.statics.statics import solve_statics
from alula.reports.sentences import told as in_words

PINS = ("O2", "A", "B")


def toggle(friction: float, stated: tuple[float, float] | None, *more: str, fits: bool = False) -> Case:
    """A slider pushes the crank of the slider-crank a few degrees from its dead point; its pins rub.

    Without fits its pins have no play, which would take it through the dead point.
    """
    entries = [f"joints.{pin}.friction={friction}" for pin in PINS]
    if stated is not None:
        entries += [f"joints.{pin}.friction_range=[{stated[0]}, {stated[1]}]" for pin in PINS]
    checks = (
        '{ strength = { type = "safety-factor" }, point = { type = "displacement", at = "A", maximum = "1 mm" }, '
        'pins = { type = "pins" }, limit = { type = "limit-load", minimum = 1.0 } }'
    )
    return edited(
        "slider-crank",
        [
            *(PLANAR, *entries, "joints.guide.friction=0", 'drive.link="slider"', 'drive.joint="guide"'),
            *('pose.angle="2 deg"', f"checks={checks}", 'large_displacement="off"', *more),
            'load_cases.push.forces=[{link="crank",at="A",force=["0 N","-1 N"]}]',
            'load_cases.push.direction="forward"',
        ],
        fits=fits,
    )


def outcomes(case: Case):
    result = check_case(case, fidelity="beam")
    return result, {(one.name, str(one.subject), one.quantity): one for one in result.load_cases["push"].checks}


@cache
def stated():
    return outcomes(toggle(0.2, (0.15, 0.25)))


def test_bands_hold_the_forces_near_a_locked_pose() -> None:
    """From 0.20 to 0.25 the rod's force grows by four fifths; by the slope at 0.20 it is less than half."""
    result, found = stated()
    forces, slope = {}, 0.0
    for mu in (0.15, 0.2, 0.201, 0.23, 0.25):
        direct, others = outcomes(toggle(mu, (mu, mu)))
        forces[mu] = direct.load_cases["push"].reactions.joints["A"].magnitude
        for key, one in others.items():
            if one.value.unknowable:
                continue
            band = found[key].value
            assert band.low <= one.value.low * (1.0 + 1e-3), (key, mu)
            assert band.high >= one.value.high / 1.05, (key, mu)
    assert forces[0.25] / forces[0.2] > 1.8
    slope = (forces[0.201] - forces[0.2]) / 0.001
    assert forces[0.2] + 0.05 * slope < 0.9 * forces[0.25]
    told = {key[2].value for key, o in found.items() if SourceKind.FRICTION in {s.kind for s in o.value.sources}}
    assert told >= {"safety factor", "displacement", "buckling factor"}
    low, high = result.load_cases["push"].work.ends[:, 0]
    ends = [solve_case_statics(toggle(mu, (mu, mu))).reactions["push"].drive_force for mu in (0.15, 0.25)]
    assert sorted(ends) == pytest.approx([low, high], rel=1e-12)


def test_without_a_stated_range_thirty_percent_count() -> None:
    work = with_ends(solve_case_statics(toggle(0.15, None)), "push")
    same = with_ends(solve_case_statics(toggle(0.15, (0.105, 0.195))), "push")
    assert work is not None
    assert same is not None
    assert work.ends == pytest.approx(same.ends, rel=1e-12)
    assert work.ends[1, 0] - work.ends[0, 0] > 0.1 * abs(work.effort[0])


def test_where_the_largest_friction_locks_the_linkage_bands_have_no_end() -> None:
    result, found = outcomes(toggle(0.25, None))
    assert result.verdict is Verdict.UNDECIDED
    strength = found["strength", "rod", "safety factor"]
    assert (strength.verdict, strength.value.low) == (Verdict.UNDECIDED, 0.0)
    assert strength.value.high < math.inf
    assert found["point", "point A of crank", "displacement"].value.high == math.inf
    assert found["limit", "the linkage", "limit-load factor"].value.low == 0.0
    [warning] = [told for told in result.warnings if "locks itself" in in_words(told)]
    assert "with the largest friction that may be (0.175 to 0.325 at O2, A, B)" in in_words(warning)
    work = result.load_cases["push"].work
    assert sorted(np.abs(work.ends[:, 0])) == [pytest.approx(abs(with_least()), rel=1e-12), math.inf]
    assert math.copysign(1.0, work.ends[np.isinf(work.ends)][0]) == math.copysign(1.0, work.effort[0])
    loose, played = outcomes(toggle(0.25, None, fits=True))
    told = [in_words(one) for one in loose.warnings]
    assert any("play of pins may take the linkage through a dead point" in one for one in told)
    assert any("locks itself" in one for one in told)
    both = played["strength", "rod", "safety factor"].value
    assert (both.low, both.high) == (0.0, math.inf)
    assert {source.kind for source in both.sources} >= {SourceKind.PLAY, SourceKind.FRICTION}


def with_least() -> float:
    return solve_case_statics(toggle(0.175, (0.175, 0.175))).reactions["push"].drive_force


def layer_gap(friction: float, stated: tuple[float, float]):
    """Gap between the layers of the slider-crank, whose slider pushes the crank some degrees from its dead point."""
    rubs = [f"joints.{pin}.friction={friction}" for pin in PINS]
    rubs += [f"joints.{pin}.friction_range=[{stated[0]}, {stated[1]}]" for pin in PINS]
    case = edited(
        "slider-crank",
        [
            *(*rubs, "joints.guide.friction=0", 'drive.link="slider"', 'drive.joint="guide"', 'pose.angle="12 deg"'),
            *('load_cases.push.direction="forward"', 'large_displacement="off"'),
            'load_cases.push.forces=[{link="crank",at="A",force=["0 N","-100 N"]}]',
            'checks={room={type="clearance",minimum="0.5 mm"}}',
        ],
    )
    checks = check_case(case, fidelity="beam").load_cases["push"].checks
    return next(one for one in checks if one.quantity is Quantity.LAYER_GAP)


@pytest.mark.converged
def test_the_gap_between_layers_is_what_all_friction_that_may_be_leaves() -> None:
    """Links bend further with more friction; where the linkage may lock itself, no gap is sure."""
    told, locked = layer_gap(0.1, (0.05, 0.2)), layer_gap(0.1, (0.05, 2.0))
    direct = [layer_gap(mu, (mu, mu)).value for mu in (0.05, 0.2)]
    assert min(one.low for one in direct) < told.value.value
    assert told.value.low == pytest.approx(min(one.low for one in direct), rel=1e-3)
    assert told.value.high >= max(one.high for one in direct) - 1e-4  # with less, the next corner comes nearest
    assert (told.verdict, locked.verdict) == (Verdict.PASS, Verdict.UNDECIDED)
    assert locked.value.low == -math.inf
    assert SourceKind.FRICTION in {source.kind for source in locked.value.sources}


def torque(*entries: str) -> dict[str, float]:
    case = edited("slider-crank", ['checks={strength={type="safety-factor"}}', *entries])
    return {name: found.drive_torque for name, found in solve_case_statics(case).reactions.items()}


def test_in_layers_the_least_is_by_forces_alone_and_the_largest_by_the_worst_couples() -> None:
    """Each way in which pins may share couples makes a drive torque of its own: all of them lie in the band."""
    statics = solve_case_statics(read_case("slider-crank"))
    least = [f"joints.{pin}.friction=0.084" for pin in PINS] + ["joints.guide.friction=0.105"]
    alone = torque(PLANAR, *least)
    for name, reactions in statics.reactions.items():
        work, case = with_ends(statics, name), at_end(statics.standing[name].case, "largest")
        assert work is not None
        lost = np.abs(work.ends[:, 0] - work.without[0])
        assert min(lost) == pytest.approx(abs(alone[name] - work.without[0]), rel=1e-9)
        assert abs(reactions.drive_torque - work.without[0]) > 1.4 * min(lost)
        loads, found = [load for load in statics.loads[name] if not isinstance(load, FrictionLoad)], []
        for shared in statics.forces[name].sharings:
            wrenches = {joint: one.wrench[None] for joint, one in shared.joints.items()}
            rubbed = (*loads, *pose_friction(case, name, statics.pose, loads, bore_presses(case, wrenches)))
            found.append(abs(solve_statics(statics.pose, case.pinned_drive, rubbed).drive_torque - work.without[0]))
        assert max(found) < max(lost)
        assert max(found) > 0.6 * max(lost)


def turning(friction: float, stated: tuple[float, float], fits: bool) -> Case:
    """The slider-crank in one plane, turning at a speed with a motor."""
    motor = 'type = "motor", voltage = "6 V", current = "400 mA", efficiency = 0.5, rated_torque = "1500 N*mm"'
    rubs = [f"joints.{pin}.friction={friction}" for pin in PINS]
    rubs += [f"joints.{pin}.friction_range=[{stated[0]}, {stated[1]}]" for pin in PINS]
    speed = ["load_cases.push.speed=60 rpm", "motion.poses=25", "joints.guide.friction=0"]
    return edited("slider-crank", [PLANAR, *rubs, *speed, f"checks={{ motor = {{ {motor} }} }}"], fits=fits)


@pytest.mark.parametrize("fits", [False, True])
def test_over_a_motion_bands_hold_direct_calculations(fits: bool) -> None:
    """Of the motor, the drive torque, joint forces, stresses and columns; the play of fits adds to joint forces."""
    case = turning(0.3, (0.1, 0.45), fits)
    moved = rubbed_motion(case)
    others = [rubbed_motion(turning(mu, (mu, mu), fits)) for mu in (0.1, 0.2, 0.45)]
    [name], every = moved.loads, np.ones(len(moved.motion.angles), dtype=bool)
    asked = motor_outcomes(moved.case, "motor", moved.case.checks["motor"])[name]
    told = [motor_outcomes(one.case, "motor", one.case.checks["motor"])[name] for one in others]
    for outcome, *direct in zip(asked, *told, strict=True):
        if outcome.quantity == "drive speed":
            continue
        assert SourceKind.FRICTION in {source.kind for source in outcome.value.sources}
        assert outcome.value.low <= min(one.value.low for one in direct) * (1.0 + 1e-12)
        assert outcome.value.high == pytest.approx(max(one.value.high for one in direct), rel=1e-12)
    ends = work_between(moved, name).ends
    for one in others:
        assert (ends[0] <= one.torque[name] + 1e-9).all()
        assert (ends[1] >= one.torque[name] - 1e-9).all()
    for joint in moved.case.joints:
        growth = joint_growth(moved, name, joint, every)
        sizes = [np.linalg.norm(one.forces[name].forces[joint], axis=1).max() for one in (moved, *others)]
        assert growth.low - 1e-9 <= min(sizes) / sizes[0]
        assert growth.high >= max(sizes) / sizes[0] - 1e-9
        assert growth.high == pytest.approx(max(sizes) / sizes[0], rel=5e-3 if fits else 1e-9)
        assert (SourceKind.PLAY in {source.kind for source in growth.sources}) == fits
    shares = otherwise(moved, every)
    for link in moved.case.checked_links:
        assert shares[name, link].low < 1.0 < shares[name, link].high
        assert column_growth(moved, name, link, every).high > 1.0


def test_a_motion_that_the_largest_friction_locks_has_no_end() -> None:
    """The slider drives the crank to two degrees from its dead point."""
    moved = rubbed_motion(toggle(0.25, None, 'motion={ range = ["2 deg", "20 deg"], poses = 19 }'))
    [name] = moved.loads
    assert np.isfinite(moved.torque[name]).all()
    ends = work_between(moved, name).ends
    assert np.isinf(ends).any(axis=0).tolist() == [True] + [False] * 18
    every = np.ones(len(moved.motion.angles), dtype=bool)
    assert joint_growth(moved, name, "A", every).high == math.inf
    assert joint_growth(moved, name, "A", every & (np.arange(19) > 0)).high < 3.0


def test_a_range_is_about_its_coefficient() -> None:
    for stated, friction in (((0.1, 0.2), 0.3), ((0.3, 0.2), 0.25)):
        with pytest.raises(CaseError, match=r"joints\.O2\.friction_range: it goes from .* but friction is"):
            toggle(friction, stated)


def test_friction_that_swings_about_what_it_settles_at_is_no_lock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bores are pressed by less, the more they rub: each round goes 0.95 times as far to the other side as the last.

    That settles, though in hundreds of rounds where no mean is taken; it was told to lock the linkage.
    """
    case = read_case("slider-crank")
    pushed = case.load_cases["push"].model_copy(update={"direction": "forward"})
    case = case.model_copy(update={"load_cases": {"push": pushed}})

    def torque(press: Callable[[JointForces], float]) -> float:
        def pressed(case: Case, found: JointForces, end: str = "stated") -> dict[str, NDArray[np.float64]]:
            return {name: np.array([press(found)]) for name in rubbing_joints(case)}

        monkeypatch.setattr("alula.fea.standing.rubbing.presses_of", pressed)
        return float(solve_case_statics(case).reactions["push"].drive_torque)

    plain, doubled = torque(lambda found: 1.0), torque(lambda found: 2.0)

    def ratio(effort: float) -> float:
        return 1.0 + (effort - plain) / (doubled - plain)

    settled = torque(lambda found: 3.0 - 0.95 * ratio(float(found.reactions.drive_torque)))
    assert ratio(settled) == pytest.approx(3.0 / 1.95, rel=0.02)  # friction is nearly in proportion to what presses
