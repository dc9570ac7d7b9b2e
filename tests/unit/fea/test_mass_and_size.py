"""Total mass and the box about a linkage over its motion: closed forms, bounds between poses, and what is refused."""

import math
import tomllib
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import pytest
from bars_in_layers import four_bars, parallel_bars
from eye_case import eyes
from imported_case import imported_case
from told import render, result_record, tables

from alula.fea.check.run import check_case
from alula.fea.common.verdict import SIZES, Quantity, Verdict
from alula.fea.findings.of_check import with_findings
from alula.fea.study.numbers import of_check, of_motion
from alula.fea.whole.outcomes import KINDS, unloaded_outcomes, whole_numbers
from alula.fea.whole.size import size_band, size_limits
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.check_spec import MassCheck, SizeCheck
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.extent import Extent
from alula.loads.states.weighed import Weighed
from alula.reports.check.changes import change_records
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.sentences import told as in_words
from alula.reports.sentences.caveats import not_checked

PLA, STEEL = 1.24e-3, 7.8e-3
"""Densities of the cards that the bars and their pins name [g/mm³]."""
MASS = '[checks.mass]\ntype = "mass"\nmaximum = "{} g"\n'
SIZE = '[checks.size]\ntype = "size"\nmaximum = ["{} mm", "{} mm", "{} mm"]\n'


def bar(length: float, width: float = 16.0, pin: float = 8.0, thickness: float = 6.0) -> float:
    """Mass of a bar with round ends and two holes [g]."""
    return PLA * thickness * (width * length + math.pi * width**2 / 4.0 - 2.0 * math.pi * pin**2 / 4.0)


def rod(diameter: float, length: float) -> float:
    """Mass of a pin [g]."""
    return STEEL * math.pi / 4.0 * diameter**2 * length


def weighed(case: Case) -> Weighed:
    found = whole_numbers(case).mass
    assert found is not None
    return found


def extent(case: Case) -> Extent:
    found = whole_numbers(case).size
    assert found is not None
    return found


def grams(found: Weighed) -> dict[str, tuple[float, float, float]]:
    return {link: (1e6 * one.part, 1e6 * one.pins, 1e6 * one.carried) for link, one in found.links.items()}


def box(found: Extent) -> list[tuple[float, float]]:
    return [(low.value, high.value) for low, high in found.reaches]


CARRIED = '[[carried]]\nlink = "coupler"\nat = "C"\nmass = "2 g"\n'


def test_bars_pins_and_carried_masses_are_counted_link_by_link():
    """Pins B and C reach over 16 mm of two layers, 10 mm apart; A and D stand in the base, which has no part."""
    found = weighed(parallel_bars(more=CARRIED + MASS.format(100)))
    expected = {
        "crank": (bar(120.0), rod(8.0, 16.0), 0.0),
        "coupler": (bar(100.0), rod(8.0, 16.0), 2.0),
        "rocker": (bar(120.0), 0.0, 0.0),
    }
    got = grams(found)
    assert got.keys() == expected.keys()
    for link, masses in expected.items():
        assert got[link] == pytest.approx(masses, rel=1e-9), link
    assert tuple(map(in_words, found.not_counted)) == ("base (no part)", "pins A, D (in base, which has no part)")
    # The centroid in the pose: cranks at 60 degrees, the coupler along x above them.
    turn = np.exp(1j * math.radians(60.0))
    places = [
        (bar(120.0), 60.0 * turn), (bar(120.0), 100.0 + 60.0 * turn), (bar(100.0), 120.0 * turn + 50.0),
        (rod(8.0, 16.0), 120.0 * turn), (rod(8.0, 16.0) + 2.0, 120.0 * turn + 100.0),
    ]  # fmt: skip
    centre = sum(mass * at for mass, at in places) / sum(mass for mass, _ in places)
    assert found.centroid == pytest.approx([centre.real, centre.imag], rel=1e-9)


def test_a_mass_keeps_or_misses_its_limit_with_what_is_stated_besides():
    total = 2.0 * bar(120.0) + bar(100.0) + 2.0 * rod(8.0, 16.0) + 2.0
    for limit, others, verdict in ((total + 0.1, "", "pass"), (total - 0.1, "", "fail"), (total + 0.1, 0.2, "fail")):
        stated = f'others = "{others} g"\n' if others else ""
        case = parallel_bars(more=CARRIED + MASS.format(limit) + stated)
        outcomes = [one for one in unloaded_outcomes(whole_numbers(case)) if one.quantity is Quantity.MASS]
        assert [(one.name, one.link, one.verdict.value) for one in outcomes] == [("mass", "the linkage", verdict)]
        assert outcomes[0].value.value == pytest.approx(total + (others or 0.0), rel=1e-9)
        told = "others as stated 0.2 g, which stand for base" if others else "; not counted: base (no part)"
        assert told in in_words(outcomes[0].reason)


@pytest.mark.parametrize(
    ("clearance", "ends"),
    [(["0 mm", "0.5 mm"], (0.0, 0.125, 0.5)), ({"level": ["0.2 mm", "0.6 mm"]}, (0.2, 0.4, 0.6))],
)
def test_a_mass_holds_all_widths_of_holes(clearance, ends):
    """A plain clearance may lie in either eye, half of it in each in the middle; one of a link is that of its eye."""

    def mass(stated):
        def loose(tables):
            tables["joints"]["B"]["clearance"] = stated
            tables["checks"]["mass"] = {"type": "mass", "maximum": "14 g"}

        [found] = [one for one in unloaded_outcomes(whole_numbers(eyes(loose))) if one.quantity is Quantity.MASS]
        return found.value.told

    tight, found = mass("0 mm").value, mass(clearance)
    holes = [2.7e-3 * 2.0 * math.pi / 4.0 * ((5.0 + wider) ** 2 - 25.0) for wider in ends]
    least, middle, most = (tight - (1 if "level" in clearance else 2) * hole for hole in holes)
    assert (found.high, found.value, found.low) == pytest.approx((least, middle, most), rel=1e-9)
    assert found.low < found.value < found.high


def bars(layers: tuple[int, int, int, int], edits: dict[str, str], more: str) -> Case:
    """Crank and rocker, 120 mm long and 100 mm apart, from 60 to 50 degrees."""
    lengths = (120.0, 100.0, 120.0, 100.0)
    return four_bars(layers, lengths, start=60.0, end=50.0, near=(0.0, 60.0), edits=edits, more=more)


def test_a_pair_weighs_twice_and_its_plates_stand_apart():
    """Plates of 6 mm, 34 mm apart about layer 1 at 10 mm, reach down to -10 mm; the base lies at 30 mm."""
    case = bars((3, 1, 1, 2), {"[links.crank]\n": '[links.crank]\ncount = 2\napart = "34 mm"\n'}, MASS.format(1))
    found = whole_numbers(case)
    assert found.mass is not None
    assert 1e6 * found.mass.links["crank"].part == pytest.approx(2.0 * bar(120.0), rel=1e-9)
    assert found.size is not None
    assert box(found.size)[2] == pytest.approx((-10.0, 30.0))
    assert (found.size.reaches[2][0].name, found.size.reaches[2][1].name) == ("link crank", "link base")


def test_the_part_of_the_ground_counts_with_the_pins_in_it():
    held = '[links.base]\npart = "bar"\nheld_at = "F"\npoints.F = ["50 mm", "0 mm"]\n'
    case = bars((0, 1, 2, 1), {"[links.base]\n": held}, MASS.format(1))
    found = weighed(case)
    assert grams(found)["base"] == pytest.approx((bar(100.0), 2.0 * rod(8.0, 16.0), 0.0), rel=1e-9)
    assert found.not_counted == ()


def test_a_box_holds_bars_over_the_motion_by_their_round_ends():
    """From 60 to 120 degrees the crank stands highest at 90, between the poses that are looked at first."""
    case = four_bars((0, 1, 2, 1), (120.0, 100.0, 120.0, 100.0), start=61.0, end=118.3, near=(0.0, 61.0))
    found = extent(case)
    (left, right), (below, above), (low, high) = box(found)
    assert above == pytest.approx(120.0 + 8.0, abs=1e-3)
    assert below == pytest.approx(-8.0, abs=1e-9)
    first, last = math.radians(61.0), math.radians(118.3)
    assert left == pytest.approx(120.0 * math.cos(last) - 8.0, abs=1e-9)
    assert right == pytest.approx(100.0 + 120.0 * math.cos(first) + 8.0, abs=1e-9)
    assert (low, high) == pytest.approx((0.0, 23.0))  # base without thickness at 0, bars of 6 mm at 10 and 20
    height = size_band(found, 1)
    assert height.value <= 136.0 <= height.high
    assert height.high - height.low < 2.1e-6 * 120.0  # on either side 1e-6 of the longest link
    highest = found.reaches[1][1].at
    assert highest is not None
    assert math.degrees(highest) == pytest.approx(90.0, abs=0.05)


@pytest.mark.parametrize("lengths", [(40.0, 120.0, 90.0, 110.0), (30.0, 80.0, 70.0, 60.0)])
def test_no_pose_reaches_beyond_the_bound(lengths):
    """Every bar's ends with their radius at 4,001 poses, solved by circles, lie within the box; it is no larger."""
    a, b, c, d = lengths
    case = four_bars((0, 1, 2, 1), lengths, start=70.0, end=250.0, near=(20.0, 80.0), width=4.0, pin=2.0)
    found = extent(case)
    crank = a * np.exp(1j * np.radians(np.linspace(70.0, 250.0, 4001)))
    way = d - crank  # from the crank's end to D; the coupler's end lies on two circles
    along = (b**2 - c**2 + np.abs(way) ** 2) / (2.0 * np.abs(way))
    ends = crank + way / np.abs(way) * (along + 1j * np.sqrt(b**2 - along**2))
    every = np.concatenate([crank, ends, [0.0, d]])
    for k, part in enumerate((every.real, every.imag)):
        low, high = found.reaches[k]
        assert low.value - low.more <= part.min() - 2.0 <= low.value + 1e-4
        assert high.value - 1e-4 <= part.max() + 2.0 <= high.value + high.more


def winged(more: str = "", edits: Mapping[str, str] = MappingProxyType({})) -> Case:
    """A crank that turns once about O with a wing that it carries, alone on the ground."""
    text = """
schema_version = 1
title = "A wing"
[links.base]
ground = true
points.O = ["0 mm", "0 mm"]
points.far = ["-90 mm", "5 mm"]
[links.arm]
part = "bar"
points.O = ["0 mm", "0 mm"]
points.W = ["30 mm", "0 mm"]
end_patch = "2 mm"
[joints]
O = { links = ["base", "arm"], pin_diameter = "4 mm" }
[pose]
coordinate = "arm"
angle = "0 deg"
[drive]
link = "arm"
joint = "O"
[motion]
range = ["0 deg", "360 deg"]
[parts.bar]
shape = "bar"
material = "pla-fdm-xy"
width = "10 mm"
thickness = "3 mm"
eye_diameter = "10 mm"
fillet_radius = "0 mm"
[load_cases.still]
"""
    for old, new in edits.items():
        assert old in text
        text = text.replace(old, new)
    return validate(tomllib.loads(text + more))


def test_wings_count_as_plates_and_links_without_part_by_their_points():
    wing = '[[wings]]\nlink = "arm"\nat = "W"\nspan = ["30 mm", "70 mm"]\nchord = ["20 mm", "8 mm"]\n'
    found = extent(winged(wing + SIZE.format(150, 150, 30)))
    assert np.ravel(box(found)) == pytest.approx([-90.0, 70.0, -70.0, 70.0, -10.0, 10.0], abs=1e-3)
    assert found.reaches[0][0].name == "link base"
    assert found.reaches[0][1].name == "wing of arm"
    outcomes = list(unloaded_outcomes(whole_numbers(winged(wing + SIZE.format(150, 150, 30)))))
    assert [(one.quantity, one.verdict) for one in outcomes] == [
        (Quantity.SIZE_X, Verdict.FAIL), (Quantity.SIZE_Y, Verdict.PASS), (Quantity.SIZE_Z, Verdict.PASS),
    ]  # fmt: skip
    assert outcomes[0].value.value == pytest.approx(160.0, abs=1e-3)
    assert "from link base at x = −90 mm" in in_words(outcomes[0].reason)
    bare = extent(winged(SIZE.format(150, 150, 30)))
    assert np.ravel(box(bare)[1:]) == pytest.approx([-math.hypot(30, 5), math.hypot(30, 5), -1.5, 1.5], abs=1e-3)


def test_an_arm_off_the_axis_reaches_as_far_as_its_eye():
    """Over a full turn the eye of 5 mm at (20, 33) mm reaches to the root of 20² + 33² and its radius."""
    lines = {
        "points.W": 'points.Q = ["20 mm", "33 mm"]\npoints.M = ["20 mm", "0 mm"]\narms.Q = "M"\npoints.W',
        "[joints]\n": '[links.rod]\npoints.Q = ["0 mm", "0 mm"]\npoints.S = ["1 mm", "0 mm"]\n'
        '[links.hub]\npoints.M = ["0 mm", "0 mm"]\npoints.S = ["1 mm", "0 mm"]\n[joints]\n'
        'Q = { links = ["arm", "rod"], pin_diameter = "4 mm", bonded = true, angle = "0 deg" }\n'
        'M = { links = ["arm", "hub"], pin_diameter = "4 mm", bonded = true, angle = "0 deg" }\n',
    }
    found = extent(winged(SIZE.format(150, 150, 30), edits=lines))
    far = math.hypot(20.0, 33.0) + 5.0
    assert np.ravel(box(found)[:2]) == pytest.approx([-90.0, far, -far, far], abs=1e-3)
    assert found.reaches[1][1].name == "link arm"


def test_an_imported_part_counts_by_its_own_outline(tmp_path):
    """A plate of 60 x 20 x 5 mm about the middle of two bores, 40.02 mm apart, on a pose known by circles."""
    path = imported_case(tmp_path)
    path.write_text(path.read_text() + SIZE.format(100, 100, 100) + MASS.format(30))
    case = read_case(str(path)).model_copy(update={"motion": None})
    found = whole_numbers(case)
    assert found.size is not None
    assert found.mass is not None
    crank = 20.0 * np.exp(1j * math.radians(40.0))
    way = 60.0 - crank
    along = (60.0**2 - 40.02**2 + abs(way) ** 2) / (2.0 * abs(way))
    tip = crank + way / abs(way) * (along + 1j * math.sqrt(60.0**2 - along**2))
    turn = (tip - 60.0) / abs(tip - 60.0)
    corners = 60.0 + turn * (20.01 + np.array([-30.0, -30.0, 30.0, 30.0]) + 1j * np.array([-10.0, 10.0, 10.0, -10.0]))
    pins = [at + r * k for at, r in ((0.0, 1.5), (crank, 1.5), (tip, 3.0), (60.0, 2.5)) for k in (1, -1, 1j, -1j)]
    every = np.concatenate([corners, pins])
    (left, right), (below, above), (low, high) = box(found.size)
    assert (left, right) == pytest.approx((every.real.min(), every.real.max()), abs=0.02)
    assert (below, above) == pytest.approx((every.imag.min(), every.imag.max()), abs=0.02)
    boss = math.pi * 5.0**2 * 4.0
    plate = 60.0 * 20.0 * 5.0 - math.pi * 2.5**2 * 5.0 - math.pi * 3.0**2 * 5.0
    assert high - low == pytest.approx(9.0)
    assert 1e6 * found.mass.total.total == pytest.approx(1.45e-3 * (plate + boss), rel=1e-4)


def test_the_box_that_is_drawn_about_a_linkage_has_the_least_limit_of_all_checks_along_each_axis():
    limits = [(300.0, 250.0, 40.0), (280.0, 260.0, 30.0), (290.0, 270.0, 50.0)]
    more = "".join(SIZE.replace("size]", f"size-{i}]").format(*one) for i, one in enumerate(limits))
    assert size_limits(bars((0, 1, 2, 1), {}, more)) == (280.0, 250.0, 30.0)
    assert size_limits(bars((0, 1, 2, 1), {}, "")) == ()


def test_without_motion_the_box_is_that_of_the_pose():
    case = winged(SIZE.format(150, 150, 30)).model_copy(update={"motion": None})
    assert np.ravel(box(extent(case))) == pytest.approx([-90.0, 30.0, -5.0, 5.0, -1.5, 1.5], abs=1e-12)
    assert [one.at for sides in extent(case).reaches for one in sides] == [None] * 6


def test_a_mass_without_anything_that_weighs_is_refused():
    bare = {'part = "bar"\n': "", 'end_patch = "2 mm"\n': ""}
    with pytest.raises(CaseError, match=r"checks\.mass: no link has a part or carries a mass, and no others"):
        winged(MASS.format(1), edits=bare)
    [outcome] = unloaded_outcomes(whole_numbers(winged(MASS.format(1) + 'others = "2 g"\n', edits=bare)))
    assert (outcome.value.value, outcome.verdict) == (2.0, Verdict.FAIL)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (SIZE.format(0, 1, 1), r"checks\.size\.maximum"),
        ('[checks.size]\ntype = "size"\nmaximum = ["1 mm", "1 mm"]\n', r"checks\.size\.maximum"),
        ('[checks.mass]\ntype = "mass"\nmaximum = "1 mm"\n', r"checks\.mass\.maximum"),
    ],
)
def test_limits_that_are_none_are_refused(more, message):
    with pytest.raises(CaseError, match=message):
        parallel_bars(more=more)


@pytest.fixture(scope="module")
def heavy():
    """Bars that hold their load, checked by hand, with a mass and a length that miss their limits."""
    limits = MASS.format(40) + SIZE.format(190, 150, 30)
    return check_case(bars((0, 1, 2, 1), {}, limits), fidelity="beam")


@pytest.fixture(scope="module")
def plain():
    """The same bars without a check of either."""
    return check_case(bars((0, 1, 2, 1), {}, ""), fidelity="beam")


def test_a_check_says_what_would_change_a_mass_and_a_size(heavy):
    assert heavy.verdict is Verdict.FAIL
    total = 2.0 * bar(120.0) + bar(100.0) + 2.0 * rod(8.0, 16.0)
    [told] = change_records(with_findings(heavy))
    assert (told["quantity"], told["load_factor"]) == ("total mass", None)
    shrink = f"{math.floor(1000.0 * 40.0 / total) / 1000.0:g}"
    assert told["sentences"] == [f"It does not depend on the loads; it passes at {shrink} times what it is."]


def test_what_is_not_counted_is_not_checked(heavy):
    assert [what for what in not_checked(heavy.caveats) if "base" in what] == [
        "mass of base (no part)", "mass of pins A, D (in base, which has no part)",
        "size of base beyond its points (no part)",
    ]  # fmt: skip


def test_mass_and_size_are_in_the_record(heavy, plain):
    """In grams and mm, whether a check asks for them or not."""
    found = result_record(heavy)
    crank = {"part": bar(120.0), "pins": rod(8.0, 16.0), "carried": 0.0}
    assert found["mass"]["links"]["crank"] == pytest.approx(crank)
    assert found["mass"]["total"] == pytest.approx(sum(sum(one.values()) for one in found["mass"]["links"].values()))
    sides = [(side["axis"], side["side"], round(side["value"], 3)) for side in found["size"]["sides"][:2]]
    right = 100.0 + 120.0 * math.cos(math.radians(50.0)) + 8.0
    assert sides == [("x", "low", -8.0), ("x", "high", pytest.approx(right, abs=1e-3))]
    assert found["size"]["x"]["value"] == pytest.approx(right + 8.0, abs=1e-3)
    alone = result_record(plain)
    assert alone["mass"] is None  # nothing weighs or moves
    assert alone["size"]["x"]["value"] == pytest.approx(right + 8.0, abs=1e-3)


def test_the_page_says_what_is_counted_where_a_check_asks(heavy, plain):
    page = render(heavy, {"box": Canvas(72.0, 72.0)})
    assert "<h2>Mass and size</h2>" in page
    [masses] = tables(heavy, "whole")
    assert masses.caption in page
    assert [column.unit for column in masses.columns] == ["", "g", "g", "g", "g"]
    [row] = [[str(cell) for cell in row[1:]] for row in masses.rows if row[0] == "crank"]
    total = bar(120.0) + rod(8.0, 16.0)
    assert row == [f"{bar(120.0):.2f}", f"{rod(8.0, 16.0):.3f}", "–", f"{total:.2f}"]
    assert "The box about all parts over the motion of crank" in page
    assert "Mass and size" not in render(plain, {})


def test_where_nothing_acts_mass_and_size_keep_their_verdict():
    force = '[[load_cases.lift.forces]]\nlink = "rocker"\nat = "C"\nforce = ["0 N", "-1 N"]\n'
    strength = '[checks.strength]\ntype = "safety-factor"\nminimum = 2.0\n'
    case = bars((0, 1, 2, 1), {force: ""}, MASS.format(99) + SIZE.format(200, 150, 30) + strength)
    found = {one.quantity: one.verdict for one in check_case(case, fidelity="beam").load_cases["lift"].checks}
    assert found[Quantity.SAFETY_FACTOR] is Verdict.UNDECIDED
    assert {found[one] for one in (Quantity.MASS, *SIZES, Quantity.CLEARANCE)} == {Verdict.PASS}


def test_a_study_and_an_envelope_judge_mass_and_size(heavy):
    """The numbers of a variant name the checks; over a motion alone they are judged as well."""
    kept = {number.quantity: number for number in of_check(heavy, weighs=False)[1] if number.check in ("mass", "size")}
    assert kept.keys() == {"total mass", "size along x", "size along y", "size along z"}
    assert kept["total mass"].verdict is Verdict.FAIL
    verdict, numbers = of_motion(solve_case_motion(heavy.case), weighs=False)
    assert verdict is Verdict.FAIL
    assert {number.quantity for number in numbers if number.check} >= kept.keys()
    assert {MassCheck, SizeCheck} <= set(KINDS)
