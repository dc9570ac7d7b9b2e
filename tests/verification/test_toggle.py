"""Toggles that snap through: the linear frame's factors, the deformed shape and the verdict against closed forms.

Two bars of half-span 50 mm push a lever of 100 mm, built in by the drive. With a lever of stiffness k and bars that
keep their length, the load on the knee is P(w) = (2k/L²)(2h²w - 3hw² + w³), derived in
``alula.fea.nonlinear.stability``.
"""

import math
import tomllib
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.change import rounded
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, Quantity, Verdict
from alula.fea.frame.build import build_frame
from alula.fea.motion.envelope import _Envelope
from alula.fea.motion.linkage_history import linkage_outcomes, over_motion
from alula.fea.nonlinear.equilibrium_path import NoEquilibriumError
from alula.fea.nonlinear.softened import followed
from alula.fea.nonlinear.stability import SNAP, growth
from alula.fea.outcomes.result import LoadCaseResult
from alula.fea.sizing.changes import _change, changes
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.study.numbers import of_motion
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import BearingCheck, LimitLoadCheck, PinCheck
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.check.changes import change_sentences
from alula.reports.sentences import told as in_words

HALF, LEVER = 50.0, 100.0
TOGGLE = """
schema_version = 1
title = "Toggle against a lever"
large_displacement = "{way}"
[links.base]
ground = true
points.O = ["0 mm", "0 mm"]
points.D = ["100 mm", "-100 mm"]
[links.left]
part = "{bars}"
points.O = ["0 mm", "0 mm"]
points.B = ["{length!r} mm", "0 mm"]
[links.right]
part = "{bars}"
points.B = ["0 mm", "0 mm"]
points.C = ["{length!r} mm", "0 mm"]
[links.lever]
part = "bar"
points.D = ["0 mm", "0 mm"]
points.C = ["100 mm", "0 mm"]
[joints]
O = {{ links = ["base", "left"], pin_diameter = "3 mm" }}
B = {{ links = ["left", "right"], pin_diameter = "3 mm" }}
C = {{ links = ["right", "lever"], pin_diameter = "3 mm" }}
D = {{ links = ["base", "lever"], pin_diameter = "3 mm" }}
[pose]
coordinate = "lever"
angle = "90 deg"
near = {{ left = "{slope!r} deg", right = "{down!r} deg" }}
[drive]
link = "lever"
joint = "D"
[parts.bar]
shape = "bar"
material = "pvc-paredes-2018"
width = "10 mm"
thickness = "10 mm"
eye_diameter = "16 mm"
eye_thickness = "10 mm"
fillet_radius = "3 mm"
[parts.slender]
shape = "bar"
material = "pvc-paredes-2018"
width = "3 mm"
thickness = "4 mm"
eye_diameter = "7 mm"
eye_thickness = "4 mm"
fillet_radius = "1 mm"
[load_cases.push]
forces = [{{ link = "left", at = "B", force = ["0 N", "{force!r} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 1.5
"""


def toggle(force: float, rise: float = 10.0, way: str = "auto", bars: str = "bar", eyes: str = "16 mm") -> Case:
    slope = math.degrees(math.atan2(rise, HALF))
    text = TOGGLE.format(force=force, length=math.hypot(HALF, rise), slope=slope, down=-slope, way=way, bars=bars)
    return validate(tomllib.loads(text.replace('eye_diameter = "16 mm"', f'eye_diameter = "{eyes}"')))


def compliance(case: Case) -> float:
    """Of the lever's tip [mm/N]: bending and shear of a cantilever."""
    material, section = case.material_of("lever"), case.part_of("lever").section
    shear = material.youngs_modulus / (2.0 * (1.0 + material.poissons_ratio)) * section.area
    bending = LEVER**3 / (3.0 * material.youngs_modulus * section.i_z)
    return bending + LEVER / (section.shear_coefficient(material.poissons_ratio) * shear)


def exact(case: Case, rise: float, bars: str = "bar") -> Callable[[float], tuple[float, float]]:
    """From the height of the knee to load and thrust: bars that shorten under their force, a spring along x."""
    material, section = case.material_of("left"), case.parts[bars].section
    spring, length = 1.0 / compliance(case), math.hypot(HALF, rise)
    stretch = material.youngs_modulus * section.area / length

    def at(height: float) -> tuple[float, float]:
        # Half a toggle: the spring moves by 2x under the thrust T, each bar shortens by T/(stretch cos).
        low, high = 0.0, HALF
        for _ in range(80):
            x = (low + high) / 2.0
            now = math.hypot(HALF + x, height)
            thrust = stretch * (length - now) * (HALF + x) / now
            low, high = (x, high) if thrust > spring * 2.0 * x else (low, x)
        thrust = spring * 2.0 * x
        return 2.0 * thrust * height / (HALF + x), thrust

    return at


def limit_load(case: Case, rise: float, bars: str = "bar") -> float:
    """Largest load of the exact toggle."""
    at = exact(case, rise, bars)
    found = minimize_scalar(lambda y: -at(y)[0], bounds=(0.0, rise), method="bounded")
    return -float(found.fun)


def linkage(case: Case):
    result = check_case(case, fidelity="beam")
    found = result.load_cases["push"]
    return result.verdict, found.large_displacement, [c for c in found.checks if c.subject == LINKAGE]


def test_the_limit_load_of_a_shallow_toggle_stands_at_three_root_three() -> None:
    """By the polynomial alone: where P(w) is largest, beside the linear displacement and the linear factor there."""
    w = np.linspace(0.0, 1.0, 200_001)
    load = 2.0 * w - 3.0 * w**2 + w**3
    linear = load.max() / 2.0
    assert linear == pytest.approx(0.19, abs=3e-3)
    assert 1.0 / linear == pytest.approx(SNAP, rel=1e-8)
    assert growth(SNAP * (1.0 + 1e-12)) == pytest.approx(w[load.argmax()] / linear, rel=1e-4)
    for factor in (5.3, 8.0, 30.0, 1e4, 1e7):
        below = np.interp(2.0 / factor, load[: load.argmax()], w[: load.argmax()])
        assert growth(factor) == pytest.approx(factor * below, rel=1e-4)
        assert growth(factor) > 1.0 / (1.0 - 1.0 / factor)
    assert growth(5.19) == math.inf


@pytest.mark.parametrize(("rise", "bars"), [(5.0, "bar"), (10.0, "slender")])
def test_a_toggle_fails_beyond_its_limit_load_and_passes_below(rise: float, bars: str) -> None:
    """Its stress is far below the limit, and its linear factor is five: above the three that sway asks for."""
    limit = limit_load(toggle(-1.0, rise, bars=bars), rise, bars)
    found = {}
    for share in (0.65, 0.95, 1.03, 1.5):
        _, moved, (found[share],) = linkage(toggle(-share * limit, rise, bars=bars))
        assert moved.state == ("deformed" if share < 1.0 else "no equilibrium")
        assert moved.held == pytest.approx(min(1.0, 1.0 / share), abs=0.012)
        assert moved.buckling == pytest.approx(SNAP / share, rel=0.1)
        assert moved.dead_point == pytest.approx(SNAP / share, rel=0.1)
    # Near it stands what is not known of the lever's eyes.
    assert [one.verdict for one in found.values()] == ["pass", "undecided", "undecided", "fail"]


@pytest.mark.parametrize(("rise", "bars"), [(1.5, "bar"), (10.0, "slender")])
@pytest.mark.parametrize("times", [1e-3, 0.3, 80.0, 1e3, 1e4])
def test_no_load_is_so_large_that_its_path_steps_over_the_limit_load(rise: float, bars: str, times: float) -> None:
    """Loads of 80 times the limit once landed beyond the snap-through, where the toggle hangs and holds all of them."""
    limit = limit_load(toggle(-1.0, rise, bars=bars), rise, bars)
    case = toggle(-times * limit, rise, bars=bars)
    statics = solve_case_statics(case)
    frame = build_frame(case, statics.pose, statics.loads["push"], held=case.pinned_drive)
    if times < 1.0:
        assert followed(frame, 1.0).stable
    with pytest.raises(NoEquilibriumError) as ended:
        followed(frame, max(1.0, 3.0 / times))
    shares = (ended.value.reached * max(times, 3.0), ended.value.failed * max(times, 3.0))
    assert shares[0] < 1.005
    assert shares[0] == pytest.approx(1.0, abs=0.02)
    assert shares[1] == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("times", [80.0, 1e3])
def test_a_toggle_under_many_times_its_limit_load_fails(times: float) -> None:
    _, moved, (found,) = linkage(toggle(-times * limit_load(toggle(-1.0, 1.5), 1.5), 1.5))
    assert (moved.state, found.verdict) == ("no equilibrium", Verdict.FAIL)
    assert moved.limit_load.low < 1.0 / times < moved.limit_load.high < 2.0 / times


def test_the_toggle_at_three_newtons_gives_way() -> None:
    """Once a pass: it moves by 2.9 % of its span, and linear theory puts its factor at three."""
    case = toggle(-3.0)
    verdict, moved, (found,) = linkage(case)
    assert verdict is Verdict.FAIL
    assert moved.buckling > 3.0
    assert moved.share < 0.05
    polynomial = (2.0 / (compliance(case) * HALF**2)) * 10.0**3 * 2.0 / (3.0 * math.sqrt(3.0))
    # The polynomial is for shallow ones; the slope is one in five here.
    assert moved.held == pytest.approx(polynomial / 3.0, rel=0.05)
    assert found.value.value == pytest.approx(limit_load(case, 10.0) / 3.0, rel=0.01)


@pytest.mark.parametrize(("share", "verdict"), [(0.95, Verdict.UNDECIDED), (0.65, Verdict.PASS)])
def test_without_the_deformed_shape_a_toggle_passes_below_its_limit_load_alone(share: float, verdict: Verdict) -> None:
    limit = limit_load(toggle(-1.0, 5.0), 5.0)
    _, moved, (found,) = linkage(toggle(-share * limit, 5.0, way="off"))
    assert (moved.state, found.verdict) == ("off", verdict)


def test_a_load_that_opens_a_toggle_stiffens_it() -> None:
    """Pulled away from its dead point it holds what it cannot hold towards it."""
    _, moved, found = linkage(toggle(3.0))
    assert moved.state == "small"
    assert moved.factor > 50.0
    assert all(c.verdict is Verdict.PASS for c in found)


def test_just_outside_of_the_limits_the_linear_answer_is_near() -> None:
    """At a factor of ten the toggle has moved by a fifth more than linear theory says: the band holds it."""
    case = toggle(-1.0)
    _, one, _ = linkage(case)
    force = one.factor / 10.0
    _, inside, _ = linkage(toggle(-1.01 * force))
    _, outside, (found,) = linkage(toggle(-0.99 * force))
    assert (inside.state, outside.state, found.verdict) == ("deformed", "small", Verdict.PASS)
    true = np.linalg.norm(inside.points["left", "B"]) / 1.01
    linear = np.linalg.norm(outside.points["left", "B"]) / 0.99
    assert 1.1 < true / linear < growth(10.0)


@pytest.mark.parametrize(("force", "found"), [(-3.0, True), (-0.5, False)])
def test_a_motion_over_a_pose_that_may_snap_through_does_not_pass(force: float, found: bool) -> None:
    """The lever turns by two degrees about the pose; under a sixth of the load all of it is clear of its limit."""
    slope = math.degrees(math.atan2(10.0, HALF))
    text = TOGGLE.format(force=force, length=math.hypot(HALF, 10.0), slope=slope, down=-slope, way="auto", bars="bar")
    data = tomllib.loads(text) | {"motion": {"poses": 5, "range": ["90 deg", "92 deg"]}}
    outcomes = list(linkage_outcomes(solve_case_motion(validate(data)), np.ones(5, dtype=bool)))
    assert bool(outcomes) is found
    assert all(c.verdict is Verdict.UNDECIDED and c.subject == LINKAGE for c in outcomes)


def scattered(force: float, way: str, high: float | None = None):
    case = toggle(force, way=way)
    load = case.load_cases["push"].model_copy(update={"scatter": (1.0, high)} if high else {})
    checks = {"pins": PinCheck(type="pins", minimum=1.0), "bearing": BearingCheck(type="bearing", minimum=1.0)}
    case = case.model_copy(update={"load_cases": {"push": load}, "checks": {**case.checks, **checks}})
    return check_case(case, fidelity="beam").load_cases["push"]


def test_bands_hold_what_the_deformed_shape_bears_on_both_sides_of_a_factor_of_ten() -> None:
    """The undeformed pose once told 13 % too little of joint forces, and what pins and links bear, just beyond ten."""
    case = toggle(-1.0)
    at, (_, one, _) = exact(case, 10.0), linkage(case)
    subjects = ("pin B", "pin C", "left", "lever")

    def checked(force: float) -> tuple[LoadCaseResult, dict[tuple[str, str], Band]]:
        found, strengths = scattered(-force, "auto"), (Quantity.SAFETY_FACTOR, Quantity.BUCKLING_FACTOR)
        return found, {(c.name, c.link): c.value for c in found.checks if c.quantity in strengths}

    least = one.factor / 2000.0
    _, plain = checked(least)
    asked = [key for key in plain if key[1] in subjects and key != ("buckling", "lever")]  # pressed by the load alone
    assert len(asked) == 7  # both pins by shear and bending, and by bearing; both links by stress; the bar as a column
    states, before = [], None
    for factor in (40.0, 20.0, 12.0, 10.05, 9.95, 8.0):
        force = one.factor / factor
        height = brentq(lambda y, force=force: at(y)[0] - force, 7.0, 10.0, xtol=1e-13)
        thrusts = at(height)[1], force * HALF / 20.0  # the latter in the undeformed pose
        along, grown = (np.divide(*(math.hypot(t, p) for t in thrusts)) for p in (force / 2.0, 0.0))
        result, found = checked(force)
        states.append(result.large_displacement.state)
        assert result.linkage.displacement.low <= 10.0 - height <= result.linkage.displacement.high
        lows = {}
        for key in asked:
            # Without growth a band would be that at the least load over the load; thrust bends the lever.
            band, share = found[key], least / force / (grown if key[1] == "lever" else along)
            lows[key] = band.low * force
            assert band.low == pytest.approx(plain[key].low * share, rel=2e-3), (factor, key)
            assert band.low * 0.998 <= plain[key].value * share <= band.high * 1.002, (factor, key)
        if before is not None and factor == 9.95:
            assert all(lows[key] == pytest.approx(before[key], rel=5e-3) for key in asked)
        before = lows
    assert states == ["small"] * 4 + ["deformed"] * 2


def turning(force: float, high: float = 1.0, ends: tuple[float, float] = (90.0, 91.0)) -> tuple[Case, list[Case]]:
    """The toggle over a motion of its lever of three poses, and each of these poses; scattered loads."""
    slope = math.degrees(math.atan2(10.0, HALF))
    text = TOGGLE.format(force=force, length=math.hypot(HALF, 10.0), slope=slope, down=-slope, way="auto", bars="bar")
    data = tomllib.loads(text)
    data["load_cases"]["push"]["scatter"] = ["100 %", f"{100.0 * high} %"]
    data["checks"] |= {name: {"type": name, "minimum": 1.0} for name in ("pins", "bearing")}
    poses = [
        validate(data | {"pose": data["pose"] | {"angle": f"{angle} deg"}}) for angle in np.linspace(*ends, 3).tolist()
    ]
    return validate(data | {"motion": {"poses": 3, "range": [f"{angle} deg" for angle in ends]}}), poses


def over_toggle(case: Case) -> tuple[_Envelope, dict[tuple[str, str], Band], dict[str, Scatter]]:
    """Bands of pins and columns over a motion, and what widens those of its links' stress."""
    over = _Envelope(solve_case_motion(case), np.ones(3, dtype=bool), 1, print)
    # Stress of links is that of solids, which these bands do without.
    checks = over.outcomes({})
    return over, {(c.name, c.link): c.value for c in checks}, {link: s for (_, link), s in over.shares.items()}


def test_bands_of_a_motion_hold_the_deformed_shape_on_both_sides_of_a_factor_of_ten() -> None:
    """Over a motion pins, eyes, columns and stress were once those of the undeformed poses alone."""
    case = toggle(-1.0)
    at, (_, one, _) = exact(case, 10.0), linkage(case)
    before: dict[tuple[str, str], float] = {}
    for factor in (40.0, 10.05, 9.95, 8.0):
        force = one.factor / factor
        height = brentq(lambda y, force=force: at(y)[0] - force, 7.0, 10.0, xtol=1e-13)
        thrusts = at(height)[1], force * HALF / 20.0  # the latter in the undeformed pose
        along, grown = (np.divide(*(math.hypot(t, p) for t in thrusts)) for p in (force / 2.0, 0.0))
        motion, poses = turning(-force)
        _, found, stress = over_toggle(motion)
        single = [check_case(pose, fidelity="beam").load_cases["push"] for pose in poses]
        # The lever at a right angle is the flattest toggle of the motion, where most acts.
        assert stress["lever"].high == pytest.approx(grown, rel=2e-3)
        assert stress["left"].high == pytest.approx(along, rel=2e-3)
        lows = {}
        for key in (("pins", "pin B"), ("pins", "pin C"), ("bearing", "pin B"), ("buckling", "left")):
            alone = [c.value for result in single for c in result.checks if (c.name, c.link) == key]
            assert found[key].low == pytest.approx(min(band.low for band in alone), rel=5e-3), (factor, key)
            assert found[key].low <= 1.002 * min(band.value for band in alone)
            assert found[key].value / found[key].low > (0.999 * along if key[0] != "buckling" else 3.0 * 0.99 * along)
            lows[key] = found[key].low * force
        if factor == 9.95:
            assert all(lows[key] == pytest.approx(before[key], rel=5e-3) for key in lows)
        before = lows


def test_growth_over_a_motion_holds_scattered_loads_and_poses_that_give_way() -> None:
    """The largest load is as one that is stated; where the flattest pose does not hold the load, nothing is known."""
    force = linkage(toggle(-1.0))[1].factor / 8.0
    _, wide, stress = over_toggle(turning(-force, 1.3)[0])
    _, larger, theirs = over_toggle(turning(-1.3 * force)[0])
    for key in (("pins", "pin B"), ("bearing", "pin C")):
        assert wide[key].low == pytest.approx(larger[key].low, rel=2e-3)
    assert stress["lever"].high == pytest.approx(theirs["lever"].high, rel=2e-3)
    for ends in ((90.0, 95.0), (95.0, 90.0)):
        over, found, stress = over_toggle(turning(-3.0, ends=ends)[0])
        assert stress["lever"].high == math.inf
        assert all(found[name, "pin B"].low == 0.0 for name in ("pins", "bearing"))
        assert {c.verdict for c in over.outcomes({})} == {Verdict.UNDECIDED}


@pytest.mark.parametrize("way", ["auto", "off"])
def test_the_upper_end_of_scatter_is_what_the_larger_load_does(way: str) -> None:
    """The flatter a toggle gets, the more it presses: pins, eyes and bars bear more than the load's share."""
    nominal, wide, larger = scattered(-1.0, way), scattered(-1.0, way, 1.7), scattered(-1.7, way)
    for plain, ours, theirs in zip(nominal.checks, wide.checks, larger.checks, strict=True):
        if ours.quantity is Quantity.SAFETY_FACTOR:
            assert (ours.value.value, ours.value.high) == (plain.value.value, plain.value.high), ours
            assert ours.value.low == pytest.approx(theirs.value.low, rel=2e-3), ours
            assert not (way == "auto" and ours.link == "pin B") or ours.value.low < plain.value.low / 1.8
    assert sum(c.quantity is Quantity.SAFETY_FACTOR for c in wide.checks) > 10


def test_no_safety_factor_is_known_at_a_load_under_which_the_toggle_gives_way() -> None:
    found = scattered(-1.0, "auto", 3.0)
    assert all(c.value.low == 0.0 and c.verdict is Verdict.UNDECIDED for c in found.checks if c.link == "pin B")
    assert found.links["left"].safety_factor.low == 0.0


def test_what_bears_nothing_is_not_broken_by_a_load_that_nothing_holds() -> None:
    band = Band.exact(0.0)
    growth = Scatter(high=math.inf, sources=(Source(kind=SourceKind.GROWTH),))
    found = growth.on(band)
    assert (found.low, found.high) == (0.0, 0.0)
    assert growth.inverse.on(band.inverse(1.0)).low == math.inf


def whole(result):
    return result.load_cases["push"].linkage


@pytest.mark.parametrize("share", [0.15, 0.6, 0.995])
def test_a_toggle_on_a_spring_gives_way_at_the_load_of_its_exact_equilibrium(share):
    limit = limit_load(toggle(-1.0, 5.0), 5.0)
    found = whole(check_case(toggle(-share * limit, 5.0), fidelity="beam")).limit_load
    assert found.value == pytest.approx(1.0 / share, rel=0.02)
    assert found.low < 1.0 / share < found.high
    assert found.value >= 1.0  # whatever the steps beyond the load, that is held
    off = whole(check_case(toggle(-share * limit, 5.0, way="off"), fidelity="beam")).limit_load
    assert off.low < 1.0 / share < off.high


@pytest.mark.parametrize(("share", "verdict"), [(0.4, Verdict.PASS), (0.5, Verdict.UNDECIDED), (0.9, Verdict.FAIL)])
def test_a_case_may_ask_for_a_margin_which_does_not_say_that_the_linkage_gives_way(share, verdict):
    case = toggle(-share * limit_load(toggle(-1.0, 5.0), 5.0), 5.0)
    case = case.model_copy(update={"checks": {"holds": LimitLoadCheck(type="limit-load", minimum=1.5)}})
    result = check_case(case, fidelity="beam").load_cases["push"]
    (asked,) = [check for check in result.checks if check.name == "holds"]
    assert (asked.subject, asked.quantity, asked.verdict) == (LINKAGE, Quantity.LIMIT_LOAD, verdict)
    assert not result.gives_way
    assert all("gives way" not in in_words(check.reason) for check in result.checks if check.subject != LINKAGE)


def test_over_a_motion_the_least_factor_is_that_of_its_worst_pose():
    """The toggle's lever turns by two degrees; a check of the pose in which it is flattest has the same number."""
    slope = math.degrees(math.atan2(10.0, HALF))
    text = TOGGLE.format(force=-0.5, length=math.hypot(HALF, 10.0), slope=slope, down=-slope, way="auto", bars="bar")
    data = tomllib.loads(text) | {"motion": {"poses": 5, "range": ["90 deg", "92 deg"]}}
    data["checks"] = {"holds": {"type": "limit-load", "minimum": 1.5}}
    moved = solve_case_motion(validate(data))
    over = over_motion(moved, np.ones(5, dtype=bool))["push"]
    assert over.poses == (0, 1, 2, 3, 4)
    alone = [
        whole(check_case(validate(data | {"pose": data["pose"] | {"angle": f"{angle} deg"}}), fidelity="beam"))
        for angle in (90.0, 92.0)
    ]
    worst = min(alone, key=lambda one: one.limit_load.value)
    assert alone[0].limit_load.value != pytest.approx(alone[1].limit_load.value, rel=0.05)
    assert over.limit_load.value == pytest.approx(worst.limit_load.value, rel=1e-6)
    assert over.displacement.value == pytest.approx(max(one.displacement.value for one in alone), rel=1e-6)
    verdict, numbers = of_motion(moved, weighs=False)
    asked, plain = (n for n in numbers if n.quantity == "limit-load factor")
    assert (asked.check, plain.check, asked.value) == ("holds", "", plain.value) == ("holds", "", over.limit_load.value)
    assert verdict is asked.verdict


def changed(case: Case, modulus: float = 1.0, strength: float = 1.0) -> Case:
    """The case with a card of its own, as many times as stiff and as strong."""
    card = case.material_of("left")
    update = {"youngs_modulus": modulus * card.youngs_modulus, "yield_strength": strength * card.yield_strength}
    return case.model_copy(update={"materials": {"pvc-paredes-2018": card.model_copy(update=update)}})


@pytest.mark.parametrize("times", [3.0, 60.0])
def test_what_is_told_to_save_a_toggle_that_gives_way_does(times: float) -> None:
    """At 80 times its limit load moduli 64 times as large were once told where 84 are needed, and were never tried."""
    force = times * limit_load(toggle(-1.0, 1.5), 1.5)
    told = changes(check_case(toggle(-force, 1.5), fidelity="beam"))[0]
    assert (told.check.quantity, told.refuted, told.material.material) == (Quantity.LOAD_SHARE, False, "")
    modulus, load = rounded(told.material.needed, up=True), rounded(told.load, up=False)
    assert modulus > times
    for case, kept in (
        (changed(toggle(-force, 1.5), modulus), True),
        (changed(toggle(-force, 1.5), modulus / 1.04), False),
        (toggle(-force * load, 1.5), True),
        (toggle(-force * load * 1.04, 1.5), False),
    ):
        _, moved, (found,) = linkage(case)
        assert (found.verdict is Verdict.PASS) is kept
        assert (moved.held_share.low >= 1.0) is kept


def test_a_change_that_fails_when_it_is_tried_is_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """Proposals of which each is too little: another one is found that holds, or none is told."""
    force = 3.0 * limit_load(toggle(-1.0, 5.0), 5.0)
    plain = _change
    monkeypatch.setattr(
        "alula.fea.sizing.changes._change",
        lambda result, check: replace(
            (found := plain(result, check)),
            load=1.3 * found.load,
            material=replace(found.material, needed=found.material.needed / 1.3),
        ),
    )
    result = check_case(toggle(-force, 5.0), fidelity="beam")
    again = changes(result)[0]
    assert again.load * again.material.needed == pytest.approx(1.0, rel=0.03)
    for case in (toggle(-force * again.load, 5.0), changed(toggle(-force, 5.0), again.material.needed)):
        assert linkage(case)[2][0].verdict is Verdict.PASS
    monkeypatch.setattr("alula.fea.sizing.changes.TRIES", 1)
    none = changes(replace(result))[0]
    assert (none.load, none.material, none.refuted) == (None, None, True)
    assert "with none within reach does it pass" in " ".join(change_sentences(none, result))


def test_no_strength_is_told_for_a_link_of_a_linkage_that_gives_way() -> None:
    """At twice the limit load stronger links hold no more, so that the linkage alone is told; below it they do."""
    limit = limit_load(toggle(-1.0), 10.0)
    told = {}
    for times in (0.4, 2.0):
        case = changed(toggle(-times * limit, eyes="13 mm"), strength=0.01)
        found = changes(check_case(case, fidelity="beam"))
        told[times] = found
    assert [one.check.quantity for one in told[2.0]] == [Quantity.LOAD_SHARE]
    assert [one.check.subject.kind for one in told[0.4]] == ["link"]
    for one in told[0.4]:
        stronger = rounded(one.material.needed, up=True) / one.material.stated
        again = check_case(changed(toggle(-0.4 * limit, eyes="13 mm"), strength=0.01 * stronger), fidelity="beam")
        (same,) = [c for c in again.load_cases["push"].checks if (c.name, c.link) == (one.check.name, one.check.link)]
        assert same.margin >= 1.0
