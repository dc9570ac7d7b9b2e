"""The check of thin walls: modes, bands, the worst of links, plates, load cases and poses; and what it refuses."""

import math
import tomllib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import rocker_case
from edited_cases import edited
from wall_case import checked, strip, walls

from alula.fea.asked.asked import asked
from alula.fea.beam.cut_free import link_loads
from alula.fea.buckling.buckling import column
from alula.fea.buckling.lateral import ABOUT_Y, ABOUT_Z, lateral_factor
from alula.fea.buckling.wall import BENDING, COMPRESSION, flattening_moment, knock_down, perfect_stress
from alula.fea.check.run import check_case
from alula.fea.common.scatter import Scatter, compliance_scatter
from alula.fea.common.sought import LEFT
from alula.fea.common.source import COUPLES, Source, SourceKind
from alula.fea.common.verdict import Quantity, Subject, Verdict
from alula.fea.judging.walls import EXACT, ROUND, judge_walls, wall_factors, wall_outcome
from alula.fea.links.link_by_hand import HandStates, link_by_hand
from alula.fea.modes.wall_modes import WallFactor, WallMode
from alula.fea.motion.envelope import _Envelope
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.fea.motion.link_history import link_histories
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.superposition.link_answers import LinkAnswers, widest
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.records.check_spec import WallCheck
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.check.whole_check import check_record, check_sections
from alula.reports.sections.table import Table
from alula.reports.sentences import told

E, NU, STRENGTH = 71700.0, 0.33, 460.0
WIDE, NARROW = (20.0, 0.2), (10.0, 0.2)
"""Radius and thickness of both walls."""


def outcome_of(result, link):
    (found,) = (check for check in result.checks if check.quantity is Quantity.WALLS and check.link == link)
    return found


def modes_of(result, link):
    found = [one.numbers for one in result.found_of(WallFactor) if one.subject.name == link]
    return {one.mode: one for one in found}


def ring(radius, thickness):
    """Area, and second moment over the radius of the middle."""
    outer, inner = radius + thickness / 2.0, radius - thickness / 2.0
    return math.pi * (outer**2 - inner**2), math.pi * (outer**4 - inner**4) / 4.0 / radius


def used(wall, compression, moment):
    area, modulus = ring(*wall)
    shares = [(compression / area, COMPRESSION), (moment / modulus, BENDING)]
    return sum(stress / knock_down(*wall, most) for stress, most in shares) / perfect_stress(*wall, E, NU)


def test_a_bent_tube_and_a_pressed_one_by_hand():
    """The arm bears 200 N over 150 mm and 20 N along it, the strut twice 200 N."""
    found = checked(walls())
    arm, strut = modes_of(found, "arm"), modes_of(found, "strut")
    assert (arm[WallMode.WALL].moment, arm[WallMode.WALL].x) == pytest.approx((30000.0, 150.0))
    elastic = 0.3 * E * 0.2 / 20.0 / (20.0 / ring(*WIDE)[0] + 30000.0 / ring(*WIDE)[1])
    assert elastic < 1.0 / used(WIDE, 20.0, 30000.0)  # ISO's wall buckles before that of SP-8007
    assert arm[WallMode.WALL].factor.value == arm[WallMode.WALL].factor.low == pytest.approx(elastic)
    flat = flattening_moment(*WIDE, E, NU) / 30000.0
    band = arm[WallMode.FLATTENING].factor
    assert (band.value, band.low, band.high) == pytest.approx((flat, EXACT * flat, ROUND * flat))
    assert set(strut) == {WallMode.WALL}
    area, _ = ring(*NARROW)
    yields = (1.047 - 0.274 * STRENGTH / (0.3 * E * 0.2 / 10.0)) * STRENGTH / (400.0 / area)
    band = strut[WallMode.WALL].factor
    assert yields < 1.0 / used(NARROW, 400.0, 0.0)
    assert (band.value, band.low) == pytest.approx((yields, yields))
    assert strut[WallMode.WALL].bears == pytest.approx(yields * 400.0 / area * ring(*NARROW)[1])
    assert band.high == pytest.approx(perfect_stress(*NARROW, E, NU) / (400.0 / area))
    for of, yielding in (arm, False), (strut, True):
        assert (SourceKind.STRENGTH in {source.kind for source in of[WallMode.WALL].factor.sources}) is yielding
    worst = outcome_of(found, "arm")
    assert (worst.value.low, worst.verdict) == (pytest.approx(min(elastic, EXACT * flat)), Verdict.PASS)
    assert str(WallMode.WALL) in told(worst.reason)
    assert "R/t is 50; its material yields first" in told(outcome_of(found, "strut").reason)
    assert "extrapolated" not in told(arm[WallMode.WALL].told or "")


def test_tension_beside_bending_buckles_no_wall_and_a_thick_wall_yields():
    def pulled(tables):
        tables["load_cases"]["tip"]["forces"][0]["force"] = ["0 N", "200 N"]
        tables["parts"]["wide"]["inner_diameter"] = "32 mm"

    found = checked(walls(pulled))
    assert outcome_of(found, "strut").value.value == math.inf
    assert "no thin wall" in told(outcome_of(found, "strut").reason)
    thick = modes_of(found, "arm")[WallMode.WALL]
    assert "no thin shell" in told(thick.told)
    assert "yields first" in told(thick.told)
    assert thick.factor.value == pytest.approx(1.0 / used((18.05, 4.1), 0.0, 30000.0))


def with_ranges(case):
    """The modulus of the card from 60 to 90 GPa, its strength from 400 to 500 MPa."""
    ranges = {"youngs_modulus_range": (60e3, 90e3), "strength_range": (400.0, 500.0)}
    card = case.all_materials["aluminium-7075-t6"].model_copy(update=ranges)
    return case.model_copy(update={"materials": {**case.materials, "aluminium-7075-t6": card}})


def test_bands_hold_loads_modulus_and_strength():
    case = with_ranges(walls(lambda tables: tables["load_cases"]["tip"].update(scatter=[0.8, 1.25])))
    found, plain = checked(case), checked(walls())
    arm, before = modes_of(found, "arm"), modes_of(plain, "arm")
    for mode in arm:
        assert arm[mode].factor.low == pytest.approx(before[mode].factor.low * 60.0 / 71.7 / 1.25, rel=1e-3)
        assert arm[mode].factor.high == pytest.approx(before[mode].factor.high * 90.0 / 71.7 / 0.8, rel=1e-3)
        assert {SourceKind.LOAD, SourceKind.MODULUS} <= {source.kind for source in arm[mode].factor.sources}
    area, _ = ring(*NARROW)
    bears = (1.047 - 0.274 * 400.0 / (0.3 * 60e3 * 0.2 / 10.0)) * 400.0
    assert modes_of(found, "strut")[WallMode.WALL].factor.low == pytest.approx(bears / (400.0 / area) / 1.25, rel=1e-3)


def test_a_ductile_wall_that_may_be_stronger_is_judged_where_it_is_ductile_no_more():
    """R/t is 4.4: ductile up to 562 MPa, from where on yielding ends it."""
    case, name = walls(lambda tables: tables["parts"]["wide"].update(inner_diameter="32 mm")), "aluminium-7075-t6"
    edge = 0.115 * 0.3 * E * 4.1 / 18.05
    stress = 20.0 / ring(18.05, 4.1)[0] + 30000.0 / ring(18.05, 4.1)[1]
    for most, bears in ((550.0, None), (600.0, edge)):
        card = case.all_materials[name].model_copy(update={"strength_range": (440.0, most)})
        found = modes_of(checked(case.model_copy(update={"materials": {name: card}})), "arm")[WallMode.WALL].factor
        assert found.value == pytest.approx(1.0 / used((18.05, 4.1), 20.0, 30000.0))
        assert found.low == pytest.approx(found.value if bears is None else bears / stress)


@pytest.mark.parametrize("order", [1, -1])
def test_the_worse_of_two_plates_counts_and_what_grows(order):
    case = walls()
    result = checked(case)
    [one] = asked(case, WallCheck, subject=Subject.link("arm"))
    beam = result.links["arm"].beam
    worse = replace(beam, forces=replace(beam.forces, coefficients=1.5 * beam.forces.coefficients))
    growth = Scatter(low=0.9, high=1.2, sources=(Source(kind=SourceKind.PLAY),))
    found = tuple(wall_factors(case, "tip", one, [beam, worse][::order], growth))
    outcome = wall_outcome("tip", one, found)
    assert outcome.value.low == pytest.approx(outcome_of(result, "arm").value.low / 1.5 / 1.2)
    assert "45000" in told(outcome.reason).replace(" ", "")


def test_play_of_a_joint_widens_the_band_by_what_it_makes_of_stress():
    loose = checked(walls(lambda tables: tables["joints"]["B"].update(clearance="1 mm")))
    assert SourceKind.PLAY in {source.kind for source in outcome_of(loose, "arm").value.sources}


def test_a_strip_that_overhangs_turns_aside_by_its_closed_form():
    found = checked(walls(strip()))
    [lateral] = modes_of(found, "arm").values()
    weak, torsion = 40.0 * 2.0**3 / 12.0, 40.0 * 2.0**3 / 3.0 * (1.0 - 0.63 * 2.0 / 40.0)
    bears = 4.0126 * math.sqrt(E * weak * E / 2.0 / (1.0 + NU) * torsion) / 150.0
    assert (lateral.mode, lateral.ratio) == (WallMode.LATERAL, pytest.approx(20.0))
    assert lateral.bears == pytest.approx(bears, rel=2e-3)
    [pressed] = [one for one in found.checks if one.quantity is Quantity.BUCKLING_FACTOR and one.link == "arm"]
    together = 1.0 / (1.0 / lateral.factor.value + 1.0 / pressed.value.value)
    assert lateral.factor.low == pytest.approx(together / 3.0)
    stiff = 2.0 * 40.0**3 / 12.0
    higher = math.sqrt((1.0 - weak / stiff) * (1.0 - torsion / stiff / 2.0 / (1.0 + NU)))
    assert lateral.factor.high == pytest.approx(lateral.factor.value / higher, rel=1e-3)
    assert outcome_of(found, "arm").verdict is Verdict.UNDECIDED
    assert lateral.factor.low < found.large_displacement.buckling < lateral.factor.high


CRANK = """
schema_version = 1
title = "A strip held by its drive"
large_displacement = "off"
links.frame = { ground = true, points = { O = ["0 mm", "0 mm"] } }
links.arm = { part = "strip", points = { O = ["0 mm", "0 mm"], H = ["300 mm", "0 mm"] } }
joints.O = { links = ["frame", "arm"], pin_diameter = "5 mm", clearance = "0 mm" }
drive = { link = "arm", joint = "O" }
pose = { coordinate = "arm", angle = "0 deg" }
load_cases.tip = { forces = [{ link = "arm", at = "H", force = ["0 N", "-10 N"] }] }
checks.wall = { type = "wall", minimum = 1 }
[parts.strip]
shape = "bar"
material = "aluminium-7075-t6"
width = "20 mm"
thickness = "1 mm"
eye_diameter = "26 mm"
eye_thickness = "1 mm"
fillet_radius = "1 mm"
"""


def test_the_frame_turns_aside_as_the_strip_does():
    """Eight elements of the frame bend and twist apart from one another: 0.9 % above Prandtl's cantilever."""
    result = check_case(validate(tomllib.loads(CRANK)), fidelity="beam")
    [lateral], frame = result.load_cases["tip"].found, result.load_cases["tip"].large_displacement.buckling
    assert lateral.numbers.factor.value == pytest.approx(frame, rel=0.015)
    parts = [part for section in check_sections(result) for part in section.parts]
    [table] = [part for part in parts if isinstance(part, Table) and part.key == "walls"]
    assert f"buckles at {frame:.3g} times its load" in table.caption


def test_a_driven_strip_may_be_held_at_its_drive_alone():
    """A crank of a four-bar: at its least it is a cantilever, at its best both pins keep its slope."""
    case = edited("four-bar", ['checks.wall={type="wall", minimum=1, links=["crank"]}'])
    result = check(case)
    [lateral], beam = modes_of(result, "crank").values(), result.links["crank"].beam
    pins = beam.forces.breaks[[0, -1]].tolist()
    both, alone, best = (
        lateral_factor(beam.forces, ABOUT_Z, 1.0, held, kept=kept)
        for held, kept in ((pins, False), (pins[:1], False), (pins, True))
    )
    pressed = column(case, "crank", beam)
    least = 1.0 / (both / alone / lateral.factor.value + (0.0 if pressed is None else 1.0 / pressed.least))
    assert alone < 0.9 * both
    softer = compliance_scatter(case.material_of("crank")).high
    assert lateral.factor.low == pytest.approx(least / 3.0 / softer, rel=1e-3)
    assert lateral.factor.high > best / both * lateral.factor.value > lateral.factor.value


def check(case):
    return checked(case, next(iter(case.load_cases)))


def test_a_square_bar_and_one_bent_about_its_weak_axis_do_not_turn_aside():
    assert modes_of(checked(walls(strip("20 mm", "20 mm"))), "arm") == {}
    assert modes_of(checked(walls(strip("20 mm", "40 mm"))), "arm") == {}
    case = walls(strip("20 mm", "20 mm"))
    [one], beam = asked(case, WallCheck, subject=Subject.link("arm")), checked(case).links["arm"].beam
    both = beam.forces.coefficients.copy()
    both[:, ABOUT_Y] = both[:, ABOUT_Z]
    across = replace(beam, forces=replace(beam.forces, coefficients=both))
    assert not tuple(wall_factors(case, "tip", one, [across], Scatter()))


def test_a_brittle_wall_does_not_yield():
    case = walls()
    name = "aluminium-7075-t6"
    card = case.all_materials[name].model_copy(update={"strength": "ultimate", "ultimate_strength": STRENGTH})
    found = checked(case.model_copy(update={"materials": {**case.materials, name: card}}))
    band = modes_of(found, "strut")[WallMode.WALL].factor
    assert card.brittle
    assert band.value == band.low == pytest.approx(1.0 / used(NARROW, 400.0, 0.0))


def test_page_and_file_have_every_mode():
    result = check_case(walls(strip()), fidelity="beam")
    sections = check_sections(result)
    records = check_record(result, sections)["load_cases"]["tip"]["walls"]
    assert {(one["link"], one["mode"]) for one in records} == {
        ("arm", str(WallMode.LATERAL)),
        ("strut", str(WallMode.WALL)),
    }
    [arm] = [one for one in records if one["link"] == "arm"]
    assert arm["moment"] == pytest.approx(30000.0)


def test_over_a_motion_the_worst_pose_counts():
    """Every pose by itself, as in a check: none is lower; where the worst is left out, the next one counts."""
    case = edited("four-bar", ['checks.wall={type="wall", minimum=1}', "motion.poses=7"])
    [load_case], evaluated = case.load_cases, np.ones(7, dtype=bool)
    moved = solve_case_motion(case)
    loaded = {link: link_histories(moved, link) for link in case.checked_links}
    grown = Scatter(low=0.8, high=1.25, sources=(Source(kind=SourceKind.PLAY),))

    def over(counted):
        every = envelope_outcomes(moved, {}, counted, loaded=loaded, stressed=lambda *_: grown)
        return {one.link: one for one in every if one.quantity is Quantity.WALLS}

    found = over(evaluated)
    assert set(found) == set(case.checked_links)
    for one in asked(case, WallCheck):
        link = one.subject.name
        singly = []
        for pose in range(len(evaluated)):
            beams = [link_by_hand(case, link, history.chosen(pose)).check for history in loaded[link]]
            every = tuple(wall_factors(case, load_case, one, beams, grown))
            singly.append(min((mode.factor.low for mode in every), default=math.inf))
        pose = int(np.argmin(singly))
        assert found[link].value.low == singly[pose]
        left = evaluated.copy()
        left[pose] = False
        again = over(left)
        assert again[link].value.low == min(np.array(singly)[left])
        assert again[link].verdict is not Verdict.PASS


def test_over_a_motion_play_and_the_sharing_of_couples_widen_the_band_and_edges_of_clamps_do_not():
    text = rocker_case.TOML.replace(
        'B = { links = ["coupler", "rocker"]', 'B = { clearance = "0.3 mm", links = ["coupler", "rocker"]'
    )
    case = validate(tomllib.loads(text) | {"checks": {"wall": {"type": "wall", "minimum": 1.0}}})
    over = _Envelope(solve_case_motion(case), np.ones(7, dtype=bool), 1, print)
    [plain] = [one for one in over.outcomes({}) if one.quantity is Quantity.WALLS]
    assert SourceKind.PLAY in {source.kind for source in plain.value.sources}
    key = ("turn", "rocker")
    over.shares[key] = Scatter(high=9.0)
    [history] = over.loaded["rocker"]
    ways = [(history.chosen(pose),) for pose in (0, 6)]
    stressed = HandStates(case, "rocker", ways).stress.tolist()
    high = max(stressed) / min(stressed)
    assert high > 1.0
    high += LEFT * (high - 1.0)  # what a search may have left
    first, second = (ways[i] for i in np.argsort(stressed))
    over.ways[key] = LinkAnswers(stated=first, others=(second,), stress=widest(COUPLES), displacement=widest(COUPLES))
    [shared] = [one for one in over.outcomes({}) if one.quantity is Quantity.WALLS]
    assert shared.value.low == pytest.approx(plain.value.low / high)


def wavy(tables):
    strip()(tables)
    part = tables["parts"]["wide"]
    part["widths"] = [["0 mm", "40 mm"], ["300 mm", "30 mm"]]
    del part["width"], part["eye_diameter"]


def plate(tables):
    sizes = {"thickness": "2 mm", "eye_diameter": "12 mm", "fillet_radius": "2 m"}
    tables["parts"]["narrow"] = {"shape": "plate", "material": "aluminium-7075-t6"} | sizes


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (plate, "link 'strut' is a plate"),
        (wavy, "link 'arm' is a bar of varying width"),
        (lambda tables: tables["checks"]["wall"].update(links=["frame"]), "'frame'"),
    ],
)
def test_other_shapes_are_refused(change, said):
    with pytest.raises(CaseError) as error:
        walls(change)
    assert said in str(error.value)


def test_a_link_that_is_pressed_in_other_air_alone_has_a_low_end():
    """As stated the strut is pulled; in the other answer it is pressed as in the case, and lets its wall buckle."""

    def lifted(tables):
        tables["load_cases"]["tip"]["forces"][0]["force"] = ["20 N", "200 N"]

    def hand(case):
        moved = solve_case_statics(case)
        loads = link_loads("tip", "strut", case.body("strut"), moved.reactions["tip"], moved.loads["tip"])
        return link_by_hand(case, "strut", loads)

    pressed, pulled = walls(), walls(lifted)
    [one] = [one for one in asked(pulled, WallCheck) if one.subject.name == "strut"]

    def judged(others):
        return judge_walls(
            SimpleNamespace(
                case=pulled,
                load_case="tip",
                hands=lambda link: [hand(pulled)],
                others=lambda link: others,
                link_growth=lambda link: Scatter(),
            ),
            one,
        )

    alone, found = judged([]), judged([hand(pulled), hand(pressed)])
    assert alone.outcome.value.low == math.inf
    assert found.outcome.value.value == math.inf
    assert found.outcome.value.low == pytest.approx(outcome_of(checked(pressed), "strut").value.low)
    assert found.numbers == ()
