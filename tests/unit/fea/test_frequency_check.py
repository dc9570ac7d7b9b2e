"""The check of natural frequencies: against a cantilever in closed form; harmonics, refusals, what would change it."""

import math
import tomllib
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import programs
import pytest
from frequency_cases import LEVER, cantilever, lever
from slotted_cases import piston_entries

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import LINKAGE, Quantity, Verdict
from alula.fea.sizing.changes import _change
from alula.fea.vibration import over_motion
from alula.fea.vibration.frequency_outcomes import (
    asked_frequencies,
    deciding_load_case,
    frequency_outcomes,
    least_at,
    least_frequency,
    lowest_frequency,
    most_moved,
    nearest_or_met,
)
from alula.fea.vibration.harmonics import meetings
from alula.fea.vibration.over_motion import _least_between, lowest_pose
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.reports.check.changes import change_sentences
from alula.reports.sentences import catalogue
from alula.reports.sentences import told as in_words
from alula.reports.sentences.verdicts import headline


@cache
def found():
    return asked_frequencies(lever())


def outcome(minimum):
    case = lever(minimum=minimum)
    [one] = [o for o in frequency_outcomes(replace(found(), case=case)) if o.subject == LINKAGE]
    return one


def test_a_driven_lever_vibrates_as_a_cantilever_with_a_mass_at_its_tip():
    one = outcome(4.0)
    known = cantilever(8.0, tip=4e-6) / 10.0  # 600 rpm
    assert one.quantity is Quantity.FREQUENCY_RATIO
    assert one.value.low <= known <= one.value.high
    assert one.value.value == pytest.approx(known, rel=0.01)
    assert one.verdict is Verdict.PASS
    assert "out of the plane, where lever moves most" in in_words(one.reason)
    assert "; over the driving frequency of 10 Hz that is " in in_words(one.reason)
    assert "; all harmonics up to the 10th, 100 Hz, stay below it" in in_words(one.reason)


def test_the_whole_band_decides():
    band = outcome(4.0).value
    assert outcome(1.01 * band.high).verdict is Verdict.FAIL
    assert outcome((band.low + band.value) / 2.0).verdict is Verdict.UNDECIDED


def history(low, high, driving=10.0, at=None):
    """A history of one natural frequency between curves."""
    low, high = np.asarray(low, dtype=float)[:, None], np.asarray(high, dtype=float)[:, None]
    at = np.radians(np.linspace(0.0, 90.0, len(low))) if at is None else at
    own = found().histories["turning"]
    return replace(own, driving=driving, at=at, low=low, high=high, frequencies=(low + high) / 2.0)


def test_over_a_motion_value_and_ends_of_the_lowest_frequency_are_each_the_least_of_all_poses():
    """They are least in three different poses; it is told at the one whose low end is least."""
    own = history([20.0, 15.0, 18.0], [31.0, 35.0, 26.0])
    own = replace(own, frequencies=np.array([[21.0], [30.0], [25.0]]))
    band = least_frequency(own)
    assert (band.value, band.low, band.high) == (21.0, 15.0, 26.0)
    assert math.degrees(least_at(own)) == pytest.approx(45.0)


@pytest.mark.parametrize("low", [lambda i: 0.0, lambda i: 5.0 + abs(i - 61.0)])
def test_the_pose_of_the_lowest_frequency_is_sought_by_low_ends_and_where_these_are_alike_by_values(monkeypatch, low):
    """The least of 81 poses is the 61st: by its low end, or by its value where pins that run leave all poses at 0.

    It alone is looked at with its pins elsewhere on their rims.
    """
    rimmed = []

    def at(case, name, pose, *_):
        value = 60.0 + abs(pose - 61.0)
        mode = SimpleNamespace(frequency=Band(value=value, low=low(pose), high=2.0 * value))
        return SimpleNamespace(modes=[mode], notes=(), pose=pose)

    monkeypatch.setattr(over_motion, "_at", at)
    monkeypatch.setattr(over_motion, "on_rims", lambda case, modes, masses: rimmed.append(modes.pose) or modes)
    case = SimpleNamespace(motion=SimpleNamespace(speed=0.0), load_cases={"turning": SimpleNamespace(speed=10.0)})
    motion = SimpleNamespace(angles=np.linspace(0.0, 80.0, 81), pose=lambda i: i)
    moved = SimpleNamespace(case=case, motion=motion, torque={"turning": np.zeros(81)}, loads={"turning": ()})
    own = over_motion._over(moved, "turning", {}, 1)
    assert own.lowest.pose == 61
    assert rimmed == [61]
    assert least_at(own) == 61.0
    assert len(own.at) < 30


def test_the_load_case_that_decides_is_the_one_nearest_to_its_own_driving_frequency():
    """30 Hz at 20 Hz is nearer than 15 Hz at 5 Hz, whichever comes first, though 15 Hz is the lower one."""
    near, far = history([30.0], [31.0], driving=20.0), history([15.0], [16.0], driving=5.0)
    turning = found().case.load_cases["turning"]
    for names in (("near", "far"), ("far", "near")):
        case = SimpleNamespace(load_cases=dict.fromkeys(names, turning))
        every = {name: {"near": near, "far": far}[name] for name in names}
        assert deciding_load_case(SimpleNamespace(case=case, histories=every)) == "near"
        loose = {name: replace(one, low=0.0 * one.low) for name, one in every.items()}  # pins may run: both begin at 0
        assert deciding_load_case(SimpleNamespace(case=case, histories=loose)) == "near"


def test_a_harmonic_meets_a_frequency_where_it_lies_in_its_band():
    """Its band is 24 to 28 Hz, then 34 to 38 Hz: 30 Hz enters it after 20 %, and leaves it after 60 % of the way."""
    [met] = meetings(history([24.0, 34.0], [28.0, 38.0]))
    [(first, last)] = met.ranges
    assert (met.harmonic, met.frequency, met.mode) == (3, 30.0, 1)
    assert (math.degrees(first), math.degrees(last)) == (pytest.approx(0.2 * 90.0), pytest.approx(0.6 * 90.0))


def test_ranges_of_a_harmonic_are_joined_over_poses_and_kept_apart_where_it_leaves():
    met = meetings(history([28.0, 26.0, 28.0, 33.0, 27.0], [33.0, 31.0, 33.0, 37.0, 32.0]))
    [third] = [one for one in met if one.harmonic == 3]
    told = [[round(math.degrees(end), 6) for end in ends] for ends in third.ranges]
    assert told == [[0.0, 54.0], [78.75, 90.0]]  # 28 to 33 reaches 30 after 2/5 of 22.5 deg, 33 to 27 after a half


def test_no_driving_frequency_has_no_harmonics():
    assert meetings(history([24.0, 34.0], [28.0, 38.0], driving=0.0)) == ()


@pytest.mark.parametrize(
    ("low", "high", "told"),
    [
        ([24.0, 34.0], [28.0, 38.0], "the 3rd harmonic, 30 Hz, meets the 1st natural frequency from lever = 18 to "
         "54 deg"),
        ([29.0, 29.0], [31.0, 31.0], "the 3rd harmonic, 30 Hz, meets the 1st natural frequency in every pose"),
        ([32.0, 33.0], [33.0, 37.0], "no harmonic up to the 10th meets a natural frequency; the 3rd, 30 Hz, comes "
         "nearest to the 1st one at lever = 0.0 deg"),
        ([0.0, 0.0], [35.0, 34.0], "harmonics up to the 3rd, 30 Hz, may meet the 1st natural frequency, since its band "
         "goes down to 0"),
        ([0.0, 0.0], [math.inf, math.inf], "which harmonics meet a natural frequency is not known, since the "
         "lowest one has no band"),
        ([101.0, 120.0], [110.0, 130.0], "all harmonics up to the 10th, 100 Hz, stay below it"),
    ],
)  # fmt: skip
def test_the_sentence_names_the_harmonic_and_where(low, high, told):
    assert catalogue.told(nearest_or_met(lever(), history(low, high))) == told


def test_an_unstable_pose_has_no_frequency():
    assert "does not swing but departs" in catalogue.told(lowest_frequency(lever(), history([0.0, 20.0], [0.0, 24.0])))


def test_the_link_that_moves_most_is_found_between_its_points_too():
    """The first frame nodes carry little of a shape that swells in the middle of a beam: nodes that divide it tell."""
    modes = found().histories["turning"].lowest
    shape = np.zeros_like(modes.modes[0].shape)
    shape[len(modes.frame.model.nodes), 2] = 1.0  # the first node of those that divide the lever
    assert most_moved(modes, replace(modes.modes[0], shape=shape)) == "lever"


BARE = tomllib.loads(LEVER)["links"]
BARE["lever"].pop("part")


@pytest.mark.parametrize(
    ("entries", "told"),
    [
        ({"links": BARE, "parts": {}}, "no moving link has a part, so nothing vibrates"),
        ({"load_cases": {"still": {"own_weight": False}}}, "no load case states the speed of the drive"),
        ({"checks": {"r": {"type": "frequency", "minimum": 4, "links": ["base"]}}}, "is no link with a part"),
        ({"checks": {"r": {"type": "frequency", "minimum": 0}}}, "checks.r.minimum"),
        ({"checks": {"r": {"type": "frequency"}}}, "checks.r.minimum"),
    ],
)
def test_refusals(entries, told):
    with pytest.raises(CaseError, match=told):
        validate(tomllib.loads(LEVER) | entries)


def test_a_slider_has_no_turn_rate():
    entries = piston_entries() | {"checks": {"r": {"type": "frequency", "minimum": 4}}}
    with pytest.raises(CaseError, match="is a slider; fix the pose by the angle of a link"):
        validate(entries)


def checked(case):
    """By hand, with the outcomes by subject."""
    result = check_case(case, name="lever.toml", fidelity="beam", threads=1)
    return result, {c.subject.kind: c for c in result.load_cases["turning"].checks}


def test_a_linkage_that_resonates_does_not_give_way():
    result, outcomes = checked(lever(speed="18000 rpm"))
    assert result.verdict is Verdict.FAIL
    assert not result.load_cases["turning"].gives_way
    assert "gives way" not in headline(result)
    assert outcomes["the linkage"].verdict is Verdict.FAIL


def test_what_would_change_it_is_the_root_of_the_modulus():
    """A link by itself keeps its limit at the modulus that is told; the linkage is told none."""
    result, outcomes = checked(lever(speed="3000 rpm"))
    own, whole = _change(result, outcomes["link"]), _change(result, outcomes["the linkage"])
    assert (own.load, whole.load, whole.material, own.size) == (None, None, None, None)
    assert change_sentences(whole, result) == [
        "It goes with one over the speed of the drive, and with the root of stiffness over mass."
    ]
    assert own.material is not None
    changed = lever(speed="3000 rpm")
    card = changed.all_materials["aluminium-6061-t6"].model_copy(update={"youngs_modulus": own.material.needed})
    changed = changed.model_copy(update={"materials": {"aluminium-6061-t6": card}})
    again = checked(changed)[1]["link"]
    assert again.value.low == pytest.approx(4.0, rel=1e-6)


def test_the_least_thickness_that_passes_is_found(tmp_path):
    """The ratio goes with thickness over the root of mass: the closed form tells that 2 mm fails and 4 mm passes."""
    (tmp_path / "lever.toml").write_text(LEVER, encoding="utf-8")
    vary = (
        "--vary",
        'parts.bar.thickness="2 mm..4 mm"',
        "--step",
        "2 mm",
        "--fidelity",
        "beam",
        "--threads",
        "1",
        "--set",
    )
    done = programs.inside("size", "lever.toml", *vary, "checks.resonance.minimum=11", folder=tmp_path)
    assert "Least parts.bar.thickness that passes: 4 mm.\nThe greatest that fails: 2 mm." in done.stdout
    assert "natural over driving frequency of" in done.stdout  # the linkage is that lever
    known = [cantilever(8.0, tip=4e-6, height=h) / 10.0 for h in (2.0, 4.0)]
    assert known[0] < 11.0 < known[1]


def test_a_link_is_checked_by_itself_with_and_without_what_it_carries():
    """Under the fastest load case of either: the bare lever at 1200 rpm, and with its tip mass at 600 rpm."""
    more = {"bare": {"speed": "1200 rpm", "carried": False}, "slow": {"speed": "60 rpm", "own_weight": False}}
    data = tomllib.loads(LEVER)
    case = validate(data | {"load_cases": data["load_cases"] | more})
    own = {o.load_case: o for o in frequency_outcomes(asked_frequencies(case)) if o.subject.kind == "link"}
    for load_case, tip, driving in (("turning", 4e-6, 10.0), ("bare", 0.0, 20.0)):
        assert own[load_case].value.value == pytest.approx(cantilever(8.0, tip=tip) / driving, rel=0.03)
    assert set(own) == {"turning", "bare"}


def test_a_solid_decides_on_a_link_that_its_beams_leave_open(monkeypatch):
    """Its band by beams is 10.8 to 14.1: against 13.5 it is open, against 4 it is not, and no solid is solved."""
    closed, solved = cantilever(8.0, tip=4e-6), []

    def by_solid(case, link, **options):
        solved.append((link, options["solid"]))
        own = known.links[link]
        modes = (replace(own.modes[0], frequency=Band(value=closed, low=0.99 * closed, high=1.01 * closed)),)
        return replace(own, model="solid", modes=modes)

    known, room = found(), "alula.fea.vibration.frequency_outcomes"
    monkeypatch.setattr(f"{room}.link_modes", by_solid)
    monkeypatch.setattr(f"{room}.case_frequencies", lambda case, **options: replace(known, case=case))
    assert asked_frequencies(lever(), solids=True) is not None
    assert asked_frequencies(lever(minimum=13.5)) is not None
    assert solved == []
    again = asked_frequencies(lever(minimum=13.5), solids=True)
    [one] = [o for o in frequency_outcomes(again) if o.subject.kind == "link"]
    assert (solved, again.links["lever"].model, one.verdict) == ([("lever", True)], "solid", Verdict.FAIL)


@pytest.mark.parametrize("at", [3, 11, 17])
def test_between_poses_that_are_all_at_zero_the_least_value_is_sought(at: int) -> None:
    """Low ends and values once counted as one list: the wrong side was followed, or a pose that is not there."""
    known: dict[int, tuple[float, float]] = {}
    _least_between(lambda i: known.setdefault(i, (0.0, 5.0 + (i - at) ** 2)), 0, 20)
    assert at in known
    assert len(known) < 15
    assert lowest_pose(np.array([2.0, 1.0, 1.0]), np.array([3.0, 9.0, 8.0])) == 2
