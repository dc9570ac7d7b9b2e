"""The check of eyes: the worst of its eyes, modes, plates, load cases and poses; and what it refuses."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from edited_cases import PLANAR, edited
from eye_case import checked, eyes

from alula.fea.asked.asked import asked, asked_of
from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.scatter import Scatter
from alula.fea.common.sought import LEFT
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import Quantity, Subject, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging.bearing import sharing
from alula.fea.judging.eyes import EYES, strengths, worse_of
from alula.fea.modes.eye_modes import EyeFactors, EyeMode
from alula.fea.modes.eye_scatter import eye_scatter
from alula.fea.motion.envelope_outcomes import _at_worst_pose
from alula.fea.motion.link_history import link_histories
from alula.fea.motion.linkage_history import when
from alula.fea.motion.loading import loading_over
from alula.fea.outcomes.unchecked import caveats
from alula.geometry.base.errors import CaseError
from alula.geometry.base.ties import first_least
from alula.loads.records.check_spec import EyeCheck
from alula.loads.states.case_motion import solve_case_motion
from alula.reports.check.whole_check import check_record, check_sections
from alula.reports.sentences import told

NET = 2.0 * 3.5 * 0.6 * (260.0 / 240.0) * math.sqrt(5.0 / 3.5) * 2.0 * 260.0
"""Eyes of 12 mm about pins of 5 mm that fit, 2 mm thick, of aluminium 6061-T6 with 240 and 260 MPa [N]."""

SCATTER = eye_scatter()
PLAY = (Source(kind=SourceKind.PLAY),)


def eyes_of_level(result, point=None):
    every = [one.numbers for one in result.found_of(EyeFactors) if one.subject.name == "level"]
    return [eye for eye in every if point in (None, eye.eye)]


def level(result):
    (found,) = (check for check in result.checks if check.quantity is Quantity.EYES and check.link == "level")
    return found


def test_a_pulled_bar_by_hand():
    found = checked(eyes())
    outcome = level(found)
    assert outcome.value.value == pytest.approx(NET / 500.0)
    assert (outcome.limit, outcome.verdict) == (2.4, Verdict.PASS)
    [eye] = eyes_of_level(found, "O")
    assert eye.force == pytest.approx(500.0)
    assert eye.angle == pytest.approx(0.0, abs=1e-6)
    assert set(eye.factors) == {
        EyeMode.NET_SECTION,
        EyeMode.DISHING,
        EyeMode.FRACTURE,
        EyeMode.SHEAR_OUT,
        EyeMode.BEARING,
    }
    for mode, (low, high) in SCATTER.modes.items():
        band = eye.factors[mode].told
        assert (band.low, band.high) == pytest.approx((low * band.value, max(high, 1.0) * band.value))
    assert outcome.value.told.low == min(band.low for band in eye.factors.values())


def test_play_of_another_joint_widens_an_eye_by_what_it_makes_of_its_force():
    def loose(tables):
        tables["joints"]["B"]["clearance"] = "0.8 mm"
        tables["load_cases"]["pull"]["forces"][0]["force"] = ["500 N", "-400 N"]

    found = checked(eyes(loose))
    force = found.forces.play.forces["O"]
    assert force.high > 1.005 * force.value
    [eye] = eyes_of_level(found, "O")
    net = eye.factors[EyeMode.NET_SECTION]
    low, high = SCATTER.modes[EyeMode.NET_SECTION]
    across = 1.0 - SCATTER.across * math.sin(math.radians(eye.angle))
    assert net.low == pytest.approx(low * across * net.value * force.value / force.high, rel=1e-6)
    assert net.high == pytest.approx(high * net.value * force.value / force.low, rel=1e-6)


def two_eyes(tables, narrow, thin):
    """One eye is narrow and thick, the other wide and thin; a second load case presses into the shanks."""
    sizes = {narrow: {"diameter": "9 mm", "thickness": "3 mm"}, thin: {"diameter": "16 mm", "thickness": "2 mm"}}
    tables["links"]["level"]["eyes"] = sizes
    tables["parts"]["bar"] |= {"width": "8 mm", "fillet_radius": "0.4 mm"}
    tables["load_cases"]["push"] = {"forces": [{"link": "level", "at": "B", "force": ["-100 N", "0 N"]}]}


@pytest.mark.parametrize(("narrow", "thin"), [("O", "B"), ("B", "O")])
def test_each_load_case_has_its_worst_eye(narrow, thin):
    """Pulled, the narrow eye tears at 1.5 times its thickness; pressed into the shanks, the thin one bears more."""
    result = check_case(eyes(lambda tables: two_eyes(tables, narrow, thin)), fidelity="beam").load_cases
    pulled, pushed = level(result["pull"]), level(result["push"])
    effective = 2.0 * min(0.6 * (260.0 / 240.0) * math.sqrt(5.0 / 2.0), 1.0)
    fracture = (1.13 * 2.0 + 0.92 * 2.0 / 1.4) * 3.0 * 260.0
    assert 2.0 * effective * 3.0 * 260.0 > fracture
    found = {eye.eye: eye for eye in eyes_of_level(result["pull"])}
    assert pulled.value.value == pytest.approx(min(band.value for band in found[narrow].factors.values()))
    assert found[narrow].factors[EyeMode.FRACTURE].value == pytest.approx(fracture / 500.0)
    assert found[thin].worst[1].low > pulled.value.low
    assert f"eye at {narrow}" in told(pulled.reason)
    assert pushed.value.value == pytest.approx(1.25 * 240.0 * 5.0 * 2.0 / 100.0)
    assert f"{EyeMode.BEARING} of the eye at {thin}" in told(pushed.reason)


@pytest.mark.parametrize("tight", ["first", "second"])
def test_a_hole_about_which_two_joints_turn_is_as_wide_as_the_loosest_of_them_says(tight):
    """A third bar turns about the pin at B; the hole of the level one is 5.4 to 5.6 mm wide."""
    clearances = {"first": ["0.1 mm", "0.2 mm"], "second": ["0.4 mm", "0.6 mm"]}
    narrow, wide = clearances.values() if tight == "first" else reversed(clearances.values())

    def third(tables):
        plain = tables["joints"]["O"]
        tables["links"]["frame"]["points"]["Q"] = ["0 mm", "60 mm"]
        for name, first in (("post", "B"), ("stay", "Q")):
            tables["links"][name] = {"part": "bar", "points": {first: ["0 mm", "0 mm"], "D": ["60 mm", "0 mm"]}}
        tables["joints"] |= {"Q": plain | {"links": ["frame", "stay"]}, "D": plain | {"links": ["post", "stay"]}}
        tables["joints"]["C"] = plain | {"links": ["level", "post"], "points": ["B", "B"], "clearance": {"level": wide}}
        tables["joints"]["B"]["clearance"] = {"level": narrow}
        tables["pose"]["near"] |= {"post": "90 deg", "stay": "0 deg"}
        tables["checks"]["eye"]["standard"] = "EN 1993-1-8"

    [bears] = [one for one in strengths(eyes(third), "level", eyes(third).checks["eye"]) if one.name == "B"]
    side = bears.modes[EyeMode.SIDE]
    hole = [2.0 * 2.0 * 240.0 * ((12.0 - wide) / 2.0 - wide / 3.0) for wide in (5.5, 5.4, 5.6)]
    assert (side.value, side.high, side.low) == pytest.approx(hole, rel=1e-3)
    assert SourceKind.PLAY in {source.kind for source in side.sources}


def test_the_band_holds_loads_strength_and_clearance():
    def scattered(tables):
        tables["load_cases"]["pull"]["scatter"] = [0.8, 1.25]
        tables["checks"]["eye"]["standard"] = "EN 1993-1-8"
        tables["joints"]["O"]["clearance"] = {"level": ["0.1 mm", "0.3 mm"]}

    case, name = eyes(scattered), "aluminium-6061-t6"
    card = case.all_materials[name].model_copy(update={"strength_range": (220.0, 300.0)})
    found = checked(case.model_copy(update={"materials": {**case.materials, name: card}}))
    [eye] = eyes_of_level(found, "O")

    def bears(strength, hole):
        return 2.0 * 2.0 * strength * ((12.0 - hole) / 2.0 - hole / 3.0) / 500.0

    side = eye.factors[EyeMode.SIDE]
    assert side.value == pytest.approx(bears(240.0, 5.2))
    assert {source.kind for source in side.sources} == {SourceKind.LOAD, SourceKind.STRENGTH, SourceKind.PLAY}
    # Play of the pins changes the force by some tenths of a percent besides.
    assert side.low == pytest.approx(bears(220.0, 5.3) / 1.25, rel=5e-3)
    assert side.high == pytest.approx(bears(300.0, 5.1) / 0.8, rel=5e-3)


def test_the_plates_of_a_pair_bear_half_each():
    def pair(tables):
        tables["links"]["level"] |= {"count": 2, "apart": "6 mm"}

    assert level(checked(eyes(pair))).value.value == pytest.approx(2.0 * NET / 500.0)


def test_a_fork_bears_on_both_cheeks_and_dishes_as_one_of_them():
    def forked(tables):
        tables["parts"]["bar"] |= {"thickness": "4 mm", "eye_thickness": "4 mm"}
        tables["links"]["level"]["eyes"] = {"O": {"fork": "2 mm", "fork_depth": "8 mm"}}

    [eye] = eyes_of_level(checked(eyes(forked)), "O")
    assert eye.factors[EyeMode.NET_SECTION].value == pytest.approx(NET / 500.0)
    assert eye.factors[EyeMode.DISHING].value == pytest.approx(2.0 * 4.0 * 1.0 * 2.0 * 260.0 / 500.0)


@pytest.mark.parametrize("order", [1, -1])
def test_the_worse_of_two_plates_counts_and_the_direction_of_its_force(order):
    """One plate is drawn straight by 500 N; the other by 600 N at 30° to that, which takes off half of ``across``."""
    case, result = eyes(), checked(eyes())
    body = case.body("level")
    loads = link_loads("pull", "level", body, result.forces.reactions, result.loads)

    def plate(force):
        wrench = np.array([*force, 0.0, 0.0, 0.0, 0.0])
        return replace(loads, pins=tuple(replace(pin, wrench=wrench) for pin in loads.pins if pin.name == "B"))

    [one] = asked(case, EyeCheck, subject=Subject.link("level"))
    plates = [plate((500.0, 0.0)), plate((600.0 * math.cos(math.pi / 6.0), 300.0))]
    spread = Scatter(low=0.9, high=1.25, sources=(Source(kind=SourceKind.PLAY),))
    [strength] = [eye for eye in strengths(case, "level", one.check) if eye.name == "B"]
    found = worse_of(strength, plates[::order], spread)
    net = found.factors[EyeMode.NET_SECTION]
    assert (found.force, found.angle) == pytest.approx((600.0, 30.0))
    assert net.value == pytest.approx(NET / 600.0)
    low, high = SCATTER.modes[EyeMode.NET_SECTION]
    across = 1.0 - SCATTER.across / 2.0
    assert (net.low, net.high) == pytest.approx((NET / 600.0 * low * across / 1.25, NET / 600.0 * high / 0.9))
    assert {x.kind for x in net.sources} == {SourceKind.PLAY, SourceKind.DIRECTION, SourceKind.EYE_FORMULAS}
    assert {x.kind for x in found.factors[EyeMode.BEARING].sources} == {SourceKind.PLAY, SourceKind.EYE_FORMULAS}


@pytest.mark.parametrize("order", [1, -1])
def test_of_all_ways_of_sharing_couples_the_one_that_presses_most_counts(order):
    wrenches = np.zeros((3, 6))
    wrenches[:, :2] = (3.0, 0.0), (0.0, 4.0), (2.0, 0.0)
    beyond = LEFT * (4.0 - 2.0)  # what a search may have left
    found = sharing(eyes(), "level", [wrenches[0], *wrenches[1:][::order]])
    assert found.high == pytest.approx((4.0 + beyond) / 3.0)
    stands = sharing(eyes(), "level", [wrenches[1], *wrenches[::2][::order]])
    assert stands.high == pytest.approx((4.0 + beyond) / 4.0)
    assert sharing(eyes(), "level", wrenches[:1]) == Scatter()


def test_every_eye_of_a_link_bears_the_way_that_presses_it_most():
    case = edited("six-bar", [PLANAR, 'checks={eye={type="eye", minimum=2.4}}', "motion.poses=3"])
    [load_case], moved = case.load_cases, solve_case_motion(case)
    loaded = {link: link_histories(moved, link) for link in case.checked_links}
    over = loading_over(moved, load_case, np.ones(len(moved.motion.angles), dtype=bool), loaded, Growths())
    here, beyond = over.at(1), 2.0 + LEFT  # what a search may have left
    [way] = here.ways()
    more = replace(way, joints={name: replace(one, wrench=2.0 * one.wrench) for name, one in way.joints.items()})
    for one in asked(case, EyeCheck):
        plain, found = (
            {eye.eye: eye.worst[1] for eye in EYES.judge(replace(here, ways=lambda ways=ways: ways), one).numbers}
            for ways in ([way], [way, more])
        )
        assert {eye: band.low for eye, band in found.items()} == pytest.approx(
            {eye: band.low / beyond for eye, band in plain.items()}
        )
        assert {eye: band.value for eye, band in found.items()} == {eye: band.value for eye, band in plain.items()}


def test_page_and_file_have_every_mode():
    result = check_case(eyes(), fidelity="beam")
    sections = check_sections(result)
    [record] = [one for one in check_record(result, sections)["load_cases"]["pull"]["eyes"] if one["eye"] == "O"]
    assert record["link"] == "level"
    found = {one["mode"]: one["factor"]["value"] for one in record["modes"]}
    assert found[str(EyeMode.NET_SECTION)] == pytest.approx(NET / 500.0)


def test_over_a_motion_the_worst_pose_counts():
    """Every pose by itself, as in a check: none is lower; where the worst is left out, the next one counts.

    What the forces of some joints may grow by counts at each pose, too.
    """
    case = edited("six-bar", [PLANAR, 'checks={eye={type="eye", minimum=2.4}}', "motion.poses=13"])
    [load_case], moved = case.load_cases, solve_case_motion(case)
    grown = Growths(joints={joint: Scatter(high=4.0, sources=PLAY) for joint in list(case.joints)[::2]})
    loaded = {link: link_histories(moved, link) for link in case.checked_links}
    evaluated = np.ones(len(moved.motion.angles), dtype=bool)

    def judged_and_singly(one, counted):
        """Return the outcome, the pose at which a link's eyes bear least, and by what they do."""
        over = loading_over(moved, load_case, counted, loaded, grown)
        poses = [EYES.judge(over.at(pose), one).numbers for pose in range(len(counted))]
        singly = [min(eye.worst[1].low for eye in numbers) for numbers in poses]
        assert EYES.least(over, one) == pytest.approx(singly)
        pose = first_least(np.where(counted, singly, np.inf))
        assert singly[pose] < max(singly)
        return _at_worst_pose(moved, over, one), pose, singly[pose]

    every = [*asked(case, EyeCheck)]
    assert {one.subject.name for one in every} == set(case.checked_links)
    for one in every:
        found, pose, low = judged_and_singly(one, evaluated)
        assert found.value.low == pytest.approx(low)
        left = evaluated.copy()
        left[pose] = False
        again, second, low = judged_and_singly(one, left)
        assert again.value.low == pytest.approx(low)
        assert told(when(moved, second)) in told(again.reason)


def refused(*changes):
    with pytest.raises(CaseError) as error:
        eyes(*changes)
    return str(error.value)


def of(material, **more):
    def change(tables):
        tables["parts"]["bar"] |= {"material": material, **more}

    return change


def bare(tables):
    """The card of an aluminium without its ultimate strength."""
    card = {
        "title": "aluminium", "density": "2700 kg/m^3", "youngs_modulus": "70 GPa", "poissons_ratio": 0.33,
        "yield_strength": "240 MPa", "strength": "yield", "sources": {}, "status": {},
    }  # fmt: skip
    tables["materials"] = {"plain": card}
    tables["parts"]["bar"]["material"] = "plain"


def laid(tables):
    """A polymer that yields before it breaks, of which nothing but the part says that it is printed."""
    bare(tables)
    tables["materials"]["plain"]["title"] = "nylon"
    tables["parts"]["bar"]["build_direction"] = [0, 0, 1]


def test_without_an_ultimate_strength_the_sentence_says_what_to_state():
    assert re.search(r"materials\.plain\.ultimate_strength: .* state it, or .*EN 1993-1-8", refused(bare))
    by_yield = checked(eyes(bare, lambda tables: tables["checks"]["eye"].update(standard="EN 1993-1-8")))
    assert level(by_yield).value.value == pytest.approx(2.0 * 2.0 * 240.0 * (3.5 - 10.0 / 3.0) / 500.0)


@pytest.mark.parametrize(("material", "strength"), [("pvc-u", 41.4), ("pla-fdm-xy", 33.0), ("steel-wire", 240.0)])
def test_a_pin_weaker_than_its_eye_decides_bearing_though_it_breaks_before_it_yields(material, strength):
    def pinned(tables):
        tables["checks"]["eye"]["standard"] = "EN 1993-1-8"
        tables["joints"]["O"]["pin_material"] = material

    [eye] = eyes_of_level(checked(eyes(pinned)), "O")
    bearing = eye.factors[EyeMode.BEARING]
    assert bearing.value == pytest.approx(1.5 * 2.0 * 5.0 * strength / 500.0)
    low, high = eyes(pinned).all_materials[material].strength_range or (strength, strength)
    assert (bearing.low, bearing.high) == pytest.approx((low * 7.5 * 2.0 / 500.0, min(high, 240.0) * 7.5 * 2.0 / 500.0))
    assert [source.kind for source in bearing.sources] == [SourceKind.STRENGTH] * (low < high)


@pytest.mark.parametrize(
    ("change", "what", "instead"),
    [
        (of("pvc-u"), "a plastic", "plastic-collapse"),
        (of("pla-fdm-xy"), "printed", "safety-factor"),
        (of("resin-405nm"), "printed", "safety-factor"),
        (laid, "printed", "safety-factor"),
    ],
)
def test_plastics_and_prints_are_for_others_to_judge(change, what, instead):
    """The check that is named judges them: with it in the place of this one the case is a case."""
    assert re.search(rf"links: .* link 'level' .* is {what}; .* type \"{instead}\"", refused(change))
    eyes(change, lambda tables: tables["checks"].update(eye={"type": instead, "minimum": 2.0}))


@pytest.mark.parametrize("parts", [["front"], ["rear"]])
def test_a_check_of_all_eyes_leaves_out_those_it_has_no_formulas_for_and_says_so(parts):
    case = edited("knee", [f'parts.{part}.material="pvc-u"' for part in parts])
    assert set(asked_of(case, EyeCheck)) == set(case.checked_links) - set(parts)
    left = [caveat.what for caveat in caveats(case) if "eyes of" in told(caveat.what)]
    assert [told(what) for what in left] == [f"eyes of {' and '.join(parts)}"]
    assert not [caveat for caveat in caveats(edited("knee", [])) if "eyes of" in told(caveat.what)]


def disc(tables):
    tables["links"]["level"]["part"] = "disc"
    tables["parts"]["disc"] = {
        "shape": "disc", "material": "aluminium-6061-t6", "diameter": "140 mm", "thickness": "2 mm",
        "eye_diameter": "12 mm",
    }  # fmt: skip


def plate(tables):
    tables["links"]["level"]["part"] = "plate"
    tables["parts"]["plate"] = {
        "shape": "plate", "material": "aluminium-6061-t6", "thickness": "2 mm", "eye_diameter": "14 mm",
        "holes": [{"x": "51.75 mm", "y": "0 mm", "diameter": "3 mm"}],
    }  # fmt: skip


@pytest.mark.parametrize(("shape", "radius"), [(disc, 10.0), (plate, 6.75)])
def test_a_hole_in_a_plate_is_an_eye_as_wide_as_its_nearest_edge(shape, radius):
    """Of a disc its rim, 10 mm off; of a plate with eyes of 7 mm a hole that lightens it. Inward no mode is spared."""

    def pushed(tables):
        tables["load_cases"]["pull"]["forces"][0]["force"] = ["-500 N", "0 N"]

    for change, angle in ((lambda _: None, 0.0), (pushed, 180.0)):
        [eye] = eyes_of_level(checked(eyes(shape, change)), "B")
        beside = radius - 2.5
        net = 2.0 * min(beside, 0.6 * (260.0 / 240.0) * math.sqrt(5.0 * beside)) * 2.0 * 260.0
        assert eye.angle == pytest.approx(angle, abs=1e-6)
        assert eye.factors[EyeMode.NET_SECTION].value == pytest.approx(net / 500.0)
        assert eye.factors[EyeMode.NET_SECTION].told.low == pytest.approx(
            net / 500.0 * SCATTER.modes[EyeMode.NET_SECTION][0]
        )


def test_an_eye_unlike_those_that_were_drawn_has_no_band_and_never_passes():
    """A pin of 5 mm in a hole of 5.88 or 5.89 mm: 0.85 of it was drawn. Dishing has no band in any eye."""

    def loose(clearance, minimum):
        def change(tables):
            tables["joints"]["O"]["clearance"] = {"level": clearance}
            tables["checks"]["eye"]["minimum"] = minimum

        return checked(eyes(change))

    drawn, undrawn, failed = loose("0.88 mm", 1.0), loose("0.89 mm", 1.0), loose("0.89 mm", 50.0)
    found = {eye.eye: eye for eye in eyes_of_level(undrawn)}
    assert all("pin over hole is 0.849" in told(band.without) for band in found["O"].factors.values())
    assert {mode for mode, band in found["B"].factors.items() if band.without} == {EyeMode.DISHING}
    assert math.isnan(level(undrawn).value.told.low)
    # A worse eye has no better low end, and the verdict is open for what was not drawn, but for one that fails.
    assert 0.99 * level(drawn).value.low < level(undrawn).value.low < level(drawn).value.low
    assert [level(one).verdict for one in (drawn, undrawn, failed)] == [Verdict.PASS, Verdict.UNDECIDED, Verdict.FAIL]
    assert "eye at O" in told(level(undrawn).reason)
    assert "pin over hole is 0.849" in told(level(undrawn).reason)


def test_links_without_a_part_are_refused():
    assert "'frame'" in refused(lambda tables: tables["checks"]["eye"].update(links=["frame"]))


def test_links_may_be_named():
    def other(tables):
        tables["parts"]["other"] = tables["parts"]["bar"] | {"material": "pvc-u"}
        tables["links"]["level"]["part"] = "other"

    named = eyes(other, lambda tables: tables["checks"]["eye"].update(links=["rising"]))
    assert [one.subject.name for one in asked(named, EyeCheck)] == ["rising"]
