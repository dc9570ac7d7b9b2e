"""Every band holds what a direct calculation gives with a cause of doubt at its ends, and inside.

For every cause that a case may state (scatter of the load, ranges of strength, modulus, friction and C_N, play of
pins), on random four-bar linkages (``random_four_bars``): a check of one pose, a motion, variants of a study, samples
of tolerances. The same linkage is calculated again with the causes where they may stand and without doubt. Of what is
stated, the ends have to lie no further in than those of the direct calculation, whose bands hold calibration and meshes
alone. Forces of joints, bearing on both eyes, compression and the drive are compared with statics of the tests' own,
which know nothing of alula: a mistake that is made in both bands, such as the better of two eyes, shows there.

How pins share the couples between layers is left out: all is in one plane. The ways of sharing that are tried are no
bound of it, which is an issue of its own. Coefficients of friction stand at one end together in all joints, as
documented (``alula.fea.doubts.range_doubt``); each at an end of its own, forces may lie up to 1 % beyond.
"""

import cmath
import itertools
import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from random_four_bars import JOINTS, LINKS, LOAD_CASES, MATERIALS, PARTS, FourBar, Inputs

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter, load_scatter
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.fea.doubts.load_growth import LEAST
from alula.fea.motion import loosened
from alula.fea.motion.envelope import _Envelope, envelope_case
from alula.fea.motion.linkage_history import limit_load_outcomes, over_motion
from alula.fea.refine.refinement import Effort
from alula.fea.study.evaluate import Task, evaluate
from alula.fea.study.margin import least_margin
from alula.fea.study.numbers import VariantResult
from alula.fea.tolerance.analysis import tolerance_case
from alula.fea.whole.motor import motor_outcomes
from alula.fea.whole.rubbed_motion import rubbed_motion
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

Key = tuple[str, str, str, str]
"""Load case, check, what it is about, quantity."""
Bands = Mapping[Key, Band]

EXACT = 1e-5
"""Of what is in proportion to a cause; buckling factors of links are roots that are found to 3e-6."""
FAR = 0.03
"""Of buckling of the linkage where it is far: its factor is taken to fall as the largest joint force grows."""
LATE = 0.026
"""Of buckling of the linkage: from a factor of 30 on it is found by two elements a beam, by which the worst of Euler's
columns, clamped and pinned, buckles so late; below it by eight, by which none is late by more than 0.02 %."""
HARDLY = 100.0
"""Buckling factor from which on a column is hardly pressed: its ends go with the compression to a few per mille."""
TOGETHER = ("load", "strength", "modulus", "friction", "air")
ALONE = [*((cause,) for cause in TOGETHER), TOGETHER]


def bands(outcomes: Iterator[CheckOutcome] | Collection[CheckOutcome]) -> dict[Key, Band]:
    return {(one.load_case, one.name, str(one.subject), one.quantity.value): one.value for one in outcomes}


def checked(case: Case, fidelity: str = "beam") -> dict[Key, Band]:
    effort = Effort(max_meshes=1)
    result = check_case(case, fidelity=fidelity, effort=effort, threads=1, bare=True)
    return bands([one for found in result.load_cases.values() for one in found.checks])


def ends(of: FourBar, causes: Collection[str], *, swapped: bool) -> list[Inputs]:
    """All causes at the end that makes most of a number, at the other, crosswise, and inside.

    Crosswise, of two materials one is at its upper end and the other at its lower.
    """
    rng, found = np.random.default_rng(of.draw), []
    for up in ((1.0, 1.0), (0.0, 0.0), (1.0, 0.0) if swapped else (0.0, 1.0), tuple(rng.uniform(0.2, 0.8, 2).tolist())):

        def at(ranges: Mapping[str, tuple[float, float]], up: tuple[float, ...] = up) -> dict[str, float]:
            pairs = zip(ranges.items(), itertools.cycle(up), strict=False)
            return {name: low + share * (high - low) for (name, (low, high)), share in pairs}

        rubs = {name: low + up[0] * (high - low) for name, (low, high) in of.mu_ends.items()}
        weak = tuple(1.0 - share for share in up)  # the largest load meets the least strength and modulus
        found.append(
            Inputs(
                load=at(of.scatter) if "load" in causes else {},
                strength=at(of.strength_ends, weak) if "strength" in causes else {},
                modulus=at(of.young_ends, weak) if "modulus" in causes else {},
                friction=rubs if "friction" in causes else {},
                air=of.air_ends[0] + up[-1] * (of.air_ends[1] - of.air_ends[0]) if "air" in causes else None,
            )
        )
    return found


def slack_of(key: Key, causes: Collection[str], *, off: bool) -> float:
    """Share by which a direct number may lie beyond its band."""
    doubts = len({"friction", "air", "play"} & set(causes))
    if key[2] == "the linkage":
        return FAR if doubts else LATE
    if key[3] == Quantity.DISPLACEMENT and not doubts:
        return 2.0 * LEAST  # it grows by the linkage's factor
    # What a doubt, or the deformed shape, makes of a number is left out where it is less than LEAST.
    return EXACT if off and not doubts else 2.0 * LEAST * max(doubts, 1)


def assert_holds(stated: Bands, direct: Bands, slack: Callable[[Key], float], what: object) -> None:
    """Compare all bands of a direct calculation; what is next to nothing beside others of its kind is rounding."""
    assert direct
    for key, one in direct.items():
        if key not in stated:
            assert key[3] == Quantity.BUCKLING_FACTOR, (key, what)
            assert one.low > HARDLY, (key, what, one)
            continue
        hardly = key[3] == Quantity.BUCKLING_FACTOR and one.low > HARDLY
        band, share = stated[key], max(slack(key), LATE if hardly else 0.0)
        assert band.unknowable == one.unknowable, (key, what)
        if one.unknowable:
            continue
        least = 0.01 * max(x.value for k, x in direct.items() if (k[0], k[1], k[3]) == (key[0], key[1], key[3]))
        nothing = least if key[3] == Quantity.DEFLECTION else 0.0
        assert band.low <= one.low * (1.0 + share) + nothing, ("low", key, what, band, one)
        assert band.high >= one.high * (1.0 - share) - nothing, ("high", key, what, band, one)


def strength_of(of: FourBar, link: str, inputs: Inputs) -> float:
    material = MATERIALS[PARTS[link]]
    return of.strength[material] * inputs.strength.get(material, 1.0)


def bearing_by_hand(of: FourBar, joint: str, force: float, inputs: Inputs) -> float:
    """Strength over F/(d t) of the worse eye; eyes are as thick as their bars."""
    return min(
        strength_of(of, link, inputs) * of.diameters[joint] * of.thickness[PARTS[link]] / force
        for link in LINKS[joint]
        if link in PARTS
    )


def compression(of: FourBar, load_case: str, inputs: Inputs) -> dict[str, float]:
    """Along the links' axes [N]; the offset of a pin in its hole turns none, and that of the crank is held."""
    forces, _ = of.statics(load_case, inputs)
    at, offsets, nominal = of.assembled(inputs.play), inputs.play, of.assembled({})
    coupler, rocker = at["B"] - offsets.get("B", 0j) - at["A"], at["B"] - at["O4"]
    borne = {"crank": ("O2", nominal["A"]), "coupler": ("A", coupler), "rocker": ("O4", rocker)}
    return {link: (forces[joint] * (axis / abs(axis)).conjugate()).real for link, (joint, axis) in borne.items()}


@pytest.mark.parametrize("draw", [0, pytest.param(1, marks=pytest.mark.converged)])
@pytest.mark.parametrize("causes", ALONE, ids="-".join)
def test_a_check_of_a_pose_holds_every_cause(causes: tuple[str, ...], draw: int) -> None:
    compare(causes, draw)


@pytest.mark.converged
@pytest.mark.parametrize("draw", range(2, 12))
@pytest.mark.parametrize("causes", ALONE, ids="-".join)
def test_a_check_of_many_poses_holds_every_cause(causes: tuple[str, ...], draw: int) -> None:
    compare(causes, draw)


def compare(causes: tuple[str, ...], draw: int) -> None:
    """In linear theory in every other draw, else on the deformed shape as well."""
    of = FourBar(draw, off=draw % 2 == 0)
    stated, done = checked(of.stated(causes)), []
    for inputs, load_case in itertools.product(ends(of, causes, swapped=of.backwards), LOAD_CASES):
        case = of.direct(causes, load_case, inputs)
        if case in done:  # crosswise is one of the ends, but for what has two members
            continue
        done.append(case)
        direct = checked(case)
        assert_holds(stated, direct, lambda key: slack_of(key, causes, off=of.off), inputs)
        if "air" in causes:
            continue
        forces, _ = of.statics(load_case, inputs)
        for joint in JOINTS:
            band = stated[load_case, "eyes", f"pin {joint}", "safety factor"]
            expected = bearing_by_hand(of, joint, abs(forces[joint]), inputs)
            assert band.low * (1.0 - LEAST) <= expected <= band.high * (1.0 + LEAST), (joint, inputs)


def stray(of: FourBar, number: Callable[[Inputs], float], count: int) -> list[Inputs]:
    """Offsets of all joints that make most and least of a number, to first order, and some at random."""
    rng, worst = np.random.default_rng(of.draw), {}
    for joint, radius in of.radii.items():
        step = 1e-4 * radius
        slopes = [number(Inputs(play={joint: step * u})) - number(Inputs(play={joint: -step * u})) for u in (1.0, 1.0j)]
        slope = complex(*slopes)
        worst[joint] = radius * slope / abs(slope) if slope else 0j
    found = [Inputs(play={joint: sign * one for joint, one in worst.items()}) for sign in (1.0, -1.0)]
    for _ in range(count):
        angles = rng.uniform(0.0, 2.0 * math.pi, len(JOINTS))
        found.append(Inputs(play={n: cmath.rect(of.radii[n], a) for n, a in zip(JOINTS, angles.tolist(), strict=True)}))
    return found


@pytest.mark.parametrize("draw", range(3))
def test_a_check_of_a_pose_holds_pins_anywhere_in_their_play(draw: int) -> None:
    """Joint forces, drive and bearing by statics of offset pins; columns by their compression; the rocker as it is.

    Where the pins of crank and coupler stand off, links of other lengths take their place. That of the rocker does not
    change, so that its numbers are those of a direct check.
    """
    of = FourBar(draw, off=draw % 2 == 0)
    result = check_case(of.stated(("play",)), fidelity="beam", threads=1, bare=True)
    stated = bands([one for found in result.load_cases.values() for one in found.checks])
    for load_case in LOAD_CASES:
        play, plain = result.load_cases[load_case].forces.play, checked(of.direct((), load_case, Inputs()))
        assert play is not None
        for joint in JOINTS:
            for inputs in stray(of, lambda one, joint=joint, lc=load_case: abs(of.statics(lc, one)[0][joint]), 8):
                force, span = abs(of.statics(load_case, inputs)[0][joint]), play.forces[joint]
                assert span.low * (1.0 - 1e-4) <= force <= span.high * (1.0 + 1e-4), (joint, inputs)
                band = stated[load_case, "eyes", f"pin {joint}", "safety factor"]
                expected = bearing_by_hand(of, joint, force, Inputs())
                assert band.low * (1.0 - LEAST) <= expected <= band.high * (1.0 + LEAST), (joint, inputs)
        for inputs in stray(of, lambda one, lc=load_case: of.statics(lc, one)[1], 8):
            slack = 1e-3 * (play.effort.high - play.effort.low)
            assert play.effort.low - slack <= of.statics(load_case, inputs)[1] <= play.effort.high + slack
        nominal = compression(of, load_case, Inputs())
        for link in ("crank", "coupler") if load_case == "one" else ("crank",):
            band = stated.get((load_case, "buckling", link, "buckling factor"))
            own = plain.get((load_case, "buckling", link, "buckling factor"))
            if band is None or own is None:
                assert nominal[link] <= 1e-9
                continue
            for inputs in stray(of, lambda one, link=link, lc=load_case: compression(of, lc, one)[link], 8):
                times = max(compression(of, load_case, inputs)[link], 0.0) / nominal[link]
                assert band.low * (1.0 - 2e-3) * times <= own.low, (link, inputs)
                assert band.high * (1.0 + 2e-3) * times >= own.high, (link, inputs)

        def far(one: Inputs) -> complex:
            at = of.assembled(one.play)
            return at["O4"] + of.tip * (at["B"] - at["O4"]) / abs(at["B"] - at["O4"])

        still = far(Inputs())
        for way in (1.0, 1.0j):
            inputs = stray(of, lambda one, way=way: (way * far(one)).real, 0)[0]
            point = load_case, "point", "point P of rocker", "displacement"
            assert stated[point].high >= math.hypot(plain[point].low, abs(far(inputs) - still)) * (1.0 - LEAST)
        pushed = stray(of, lambda one, lc=load_case: abs(of.statics(lc, one)[0]["B"]), 0)
        pushed += stray(of, lambda one, lc=load_case: compression(of, lc, one)["rocker"], 1)
        for inputs in pushed:
            direct = checked(of.direct(("play",), load_case, inputs))
            rocker = {key: one for key, one in direct.items() if key[2] == "rocker" or key[2].startswith("pin")}
            assert_holds(stated, rocker, lambda key: LEAST, inputs)
            linkage = {key: one for key, one in direct.items() if key[2] == "the linkage"}
            assert_holds(stated, linkage, lambda key: FAR, inputs)


MOTOR = {"type": "motor", "voltage": "6 V", "current": "2 A", "efficiency": 0.5, "no_load_speed": "60 rpm",
         "stall_torque": "5000 N*mm", "rated_torque": "800 N*mm"}  # fmt: skip
POSES = 5


def turning(of: FourBar, causes: Collection[str], inputs: Inputs | None = None, load_case: str = "") -> Case:
    """The case over a sixth of a turn, with a motor; so slowly without air that inertia is next to nothing."""
    data = of.data(causes, inputs, 1.0 if inputs is None else inputs.load.get(load_case, 1.0))
    data["motion"] = {"range": [f"{of.angle + turn!r} rad" for turn in (0.0, math.pi / 3.0)], "poses": POSES}
    data["checks"] = data["checks"] | {"motor": MOTOR}
    if "air" in causes:
        data["checks"]["motor"] = MOTOR | {"no_load_speed": "6000 rpm"}
    else:
        for one in data["load_cases"].values():
            one["speed"] = "3 rpm"
            del one["direction"]
    if load_case:
        data["load_cases"] = {load_case: data["load_cases"][load_case]}
    return validate(data)


def over_poses(case: Case) -> dict[Key, Band]:
    """All that an envelope tells without solids; of stress by hand the bands that it gives to that of solids."""
    moved = rubbed_motion(case)
    every = np.ones(len(moved.motion.angles), dtype=bool)
    over = _Envelope(moved, every, 1, lambda message: None)
    told = [*over.outcomes({}), *limit_load_outcomes(over.moved, over_motion(over.moved, every))]
    for outcomes in motor_outcomes(case, "motor", case.checks["motor"]).values():  # type: ignore[arg-type]
        told += outcomes
    found = bands(told)
    for link, load_case in itertools.product(case.checked_links, case.load_cases):
        most = max(loosened._hand(moved, load_case, link, pose) for pose in range(len(every)))
        share = over.shares.get((load_case, link), Scatter()).times(load_scatter(case, load_case))
        found[load_case, "stress", link, "stress"] = Band(
            value=most, low=min(share.low, 1.0) * most, high=max(share.high, 1.0) * most
        )
    return found


def test_a_motion_holds_all_causes_together() -> None:
    of = FourBar(3)
    most, least = ends(of, TOGETHER, swapped=of.backwards)[:2]
    over_motion_of(of, TOGETHER, [(most, "one"), (least, "two"), (most, "two")])


@pytest.mark.converged
@pytest.mark.parametrize("draw", range(4, 8))
@pytest.mark.parametrize("causes", ALONE, ids="-".join)
def test_many_motions_hold_every_cause(causes: tuple[str, ...], draw: int) -> None:
    of = FourBar(draw)
    over_motion_of(of, causes, list(itertools.product(ends(of, causes, swapped=of.backwards), LOAD_CASES)))


def over_motion_of(of: FourBar, causes: tuple[str, ...], places: Collection[tuple[Inputs, str]]) -> None:
    """Bearing at the worst pose is that of statics at each."""
    stated = over_poses(turning(of, causes))
    for inputs, load_case in places:
        direct = over_poses(turning(of, causes, inputs, load_case))
        assert_holds(stated, direct, lambda key: slack_of(key, causes, off=True), inputs)
        for turn in (0.0, math.pi / 3.0):  # the worst of the poses is no better than either end
            pose = checked(of.turned(turn).direct(causes, load_case, inputs))
            limit = load_case, "limit", "the linkage", "limit-load factor"
            assert stated[limit].low <= pose[limit].low * (1.0 + FAR), (turn, inputs)
        for joint in JOINTS if "air" not in causes else ():
            found = [of.turned(turn) for turn in np.linspace(0.0, math.pi / 3.0, POSES)]
            forces = [abs(one.statics(load_case, inputs)[0][joint]) for one in found]
            band = stated[load_case, "eyes", f"pin {joint}", "safety factor"]
            expected = bearing_by_hand(of, joint, max(forces), inputs)
            assert band.low * (1.0 - LEAST) <= expected <= band.high * (1.0 + LEAST), (joint, inputs)


@pytest.mark.converged
def test_a_motion_holds_pins_anywhere_in_their_play() -> None:
    """Of bearing, columns and the motor, with pins that stand off alike at all poses, at their worst for one."""
    of, angles = FourBar(3), np.linspace(0.0, math.pi / 3.0, POSES)
    case = turning(of, ("play",))
    stated, plain = over_poses(case), over_poses(turning(of, (), Inputs()))
    poses = [of.turned(turn) for turn in angles]
    for load_case in LOAD_CASES:
        for joint, pose in itertools.product(JOINTS, (0, POSES - 1)):
            tried = stray(
                poses[pose], lambda one, p=pose, j=joint, lc=load_case: abs(poses[p].statics(lc, one)[0][j]), 1
            )
            for inputs in tried:
                forces = [abs(one.statics(load_case, inputs)[0][joint]) for one in poses]
                band = stated[load_case, "eyes", f"pin {joint}", "safety factor"]
                expected = bearing_by_hand(of, joint, max(forces), Inputs())
                assert band.low * (1.0 - LEAST) <= expected <= band.high * (1.0 + LEAST), (joint, inputs)
        nominal = max(compression(one, load_case, Inputs())["crank"] for one in poses)
        key = load_case, "buckling", "crank", "buckling factor"
        for pose in range(POSES) if key in stated else ():
            tried = stray(poses[pose], lambda one, p=pose, lc=load_case: compression(poses[p], lc, one)["crank"], 1)
            for inputs in tried:
                times = max(0.0, *(compression(one, load_case, inputs)["crank"] for one in poses)) / nominal
                assert stated[key].low * (1.0 - 2e-3) * times <= plain[key].low, inputs
                assert stated[key].high * (1.0 + 2e-3) * times >= plain[key].high, inputs
        rms = load_case, "motor", "crank", "drive torque over time"
        for inputs in stray(poses[2], lambda one, lc=load_case: poses[2].statics(lc, one)[1], 2):
            torque = np.array([one.statics(load_case, inputs)[1] for one in poses])
            effective = math.sqrt(float(np.trapezoid(torque**2, angles)) / (angles[-1] - angles[0]))
            assert stated[rms].low * (1.0 - LEAST) <= effective <= stated[rms].high * (1.0 + LEAST)


def banded(result: VariantResult) -> VariantResult:
    """A variant with those numbers alone that have a band."""
    return replace(result, numbers=tuple(one for one in result.numbers if not math.isnan(one.low)))


def test_a_variant_of_a_study_holds_every_cause() -> None:
    """Its numbers, and the least margin of all of them, that of the worst of both load cases and all links."""
    of, causes = FourBar(5), ("load", "strength", "modulus")
    stated = evaluate(Task(tables=of.data(causes), fidelity="beam"), {})
    known = {(one.check, one.subject, one.load_case, one.quantity): one for one in stated.numbers if one.check}
    assert sum(math.isfinite(one.low) for one in known.values()) > len(known) // 3
    margins = {}
    for inputs, load_case in itertools.product(ends(of, causes, swapped=of.backwards), LOAD_CASES):
        tables = of.data(causes, inputs, inputs.load[load_case])
        tables["load_cases"] = {load_case: tables["load_cases"][load_case]}
        direct = evaluate(Task(tables=tables, fidelity="beam"), {})
        margins[load_case, inputs.load[load_case]] = least_margin(banded(direct))
        for one in direct.numbers:
            if one.check and math.isfinite(one.value):
                number = known[one.check, one.subject, one.load_case, one.quantity]
                assert math.isnan(number.low) == math.isnan(one.low)  # no band tells of its model
                assert not number.low > one.low * (1.0 + EXACT) + 1e-9
                assert not number.high < one.high * (1.0 - EXACT) - 1e-9
    assert 0.0 < least_margin(banded(stated))[1] <= min(low for _, low, _ in margins.values()) + EXACT


def rocker_alone(
    of: FourBar, causes: Collection[str], inputs: Inputs | None = None, load_case: str = "", **tables: Any
) -> Case:
    """The rocker alone has a part; over three poses."""
    data = of.data(causes, inputs, 1.0 if inputs is None else inputs.load[load_case])
    for link in ("crank", "coupler"):
        del data["links"][link]["part"]
    data |= {"solid": {"mesh_size": 3.0}, "motion": {"range": ["60 deg", "90 deg"], "poses": 3}}
    data["pose"] |= {"angle": "60 deg"}
    data["checks"] = {name: one for name, one in data["checks"].items() if name in ("strong", "stiff", "eyes")}
    if load_case:
        data["load_cases"] = {load_case: data["load_cases"][load_case]}
    return validate(data | tables)


def test_solids_and_an_envelope_of_them_hold_scattered_loads_and_strengths() -> None:
    """On one coarse mesh; the rocker alone has a part."""
    of, causes = FourBar(6), ("load", "strength", "modulus")

    def enveloped(of_case: Case) -> dict[Key, Band]:
        return bands(envelope_case(of_case, threads=1, effort=Effort(max_meshes=1)).checks)

    for calculated in (lambda one: checked(one, "solid"), enveloped):
        stated = calculated(rocker_alone(of, causes))
        for inputs in ends(of, causes, swapped=of.backwards)[:2]:
            for load_case in LOAD_CASES:
                assert_holds(stated, calculated(rocker_alone(of, causes, inputs, load_case)), lambda key: 1e-6, inputs)


def test_samples_of_tolerances_hold_scattered_loads_and_strengths() -> None:
    """A sample's band is that of the direct check of its load, with load and strength at their ends."""
    of, causes = FourBar(7), ("load", "strength")
    case = rocker_alone(of, causes, tolerances={"load_cases.one.forces.0": "10 %"})
    found = tolerance_case(case, samples=100, threads=1, effort=Effort(max_meshes=1))
    for sample, inputs in zip((0, 1), ends(of, causes, swapped=of.backwards), strict=False):
        drawn = Inputs(
            load={"one": inputs.load["one"] * (1.0 + float(found.deviations[sample, 0]))}, strength=inputs.strength
        )
        direct = checked(rocker_alone(of, causes, drawn, "one"), "solid")
        for number in found.numbers:
            key = number.load_case, number.check, number.subject, number.quantity
            if key in direct:
                low, high = number.low[sample], number.high[sample]
                assert low <= direct[key].low * (1.0 + 2e-3)
                assert high >= direct[key].high * (1.0 - 2e-3)
