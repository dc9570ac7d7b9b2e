"""What does not pass where the linkage, or a solid of it, gives way: growth, limit load and outcomes, each by hand."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from edited_cases import PLANAR

from alula.fea.check import known_stiffness
from alula.fea.check.known_stiffness import with_known_stiffness
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Subject, Verdict
from alula.fea.judging.linkage import NO_EQUILIBRIUM, linkage_outcomes, unless_it_gives_way
from alula.fea.judging.solid_buckling import _outcome, solid_growth
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.nonlinear.stability import SNAP
from alula.fea.outcomes.result import SolidResult
from alula.fea.refine.link_buckling import SolidBuckling
from alula.loads.case.case_file import read_case
from alula.reports.sentences import told

AB = ("a", "b")


def buckling(value, least, error=0.0, most=30.0):
    return SolidBuckling(value=value, least=least, most=most, error=error, holding="on pins")


def test_bending_of_a_solid_grows_as_towards_the_least_factor_that_its_mesh_allows():
    """1/(1 - 1/n) with n = 4 (1 - 0.2), and not with the 8 at which it buckles on joints that stay."""
    assert solid_growth(buckling(8.0, 4.0, 0.2)).high == pytest.approx(3.2 / 2.2)
    assert solid_growth(buckling(30.0, 4.0)).high == pytest.approx(4.0 / 3.0)
    assert solid_growth(buckling(30.0, 10.0)).high == pytest.approx(10.0 / 9.0)
    assert solid_growth(buckling(300.0, 100.0)).high == pytest.approx(100.0 / 99.0)
    for least in (0.9, 1.1):  # 1.1 may be 0.99
        assert solid_growth(buckling(30.0, least, 0.1)).high == 1.0
    assert solid_growth(buckling(8.0, 4.0, 0.2), 1.3).high == pytest.approx(3.2 / (3.2 - 1.3))
    assert solid_growth(None).sources == solid_growth(SolidBuckling.unknown("coarse")).sources == ()


def test_the_band_of_a_solids_factor_has_its_own_least_and_most_with_the_error_of_its_mesh():
    """Imperfections take a factor of three more, and the modulus of the card has a range."""
    case = read_case("owl-wing-static", [PLANAR, 'parts.tube.material="pla-fdm-xy"'])
    card = case.material_of("AE")
    soft, stiff = (end / card.youngs_modulus for end in card.youngs_modulus_range)
    assert soft < 1.0 < stiff
    found = _outcome(case, "weight", "AE", buckling(8.0, 4.0, error=0.2)).value
    assert (found.value, found.low, found.high) == pytest.approx((8.0, 3.2 / 3.0 * soft, 36.0 * stiff))
    assert "at 4 times where its joints move with it" in told(_outcome(case, "weight", "AE", buckling(8.0, 4.0)).reason)


def passing(subject, quantity, load_case, value=5.0):
    return CheckOutcome.of("c", subject, load_case, quantity, Band.exact(value), 1.0)


def every(load_case):
    """A link, a pin and a motor that pass, and a link that fails."""
    return [
        passing(Subject.link("one"), Quantity.SAFETY_FACTOR, load_case),
        passing(Subject.pin("B"), Quantity.SAFETY_FACTOR, load_case),
        passing(Subject.link("crank"), Quantity.TORQUE_SHARE, load_case, 0.5),
        passing(Subject.link("other"), Quantity.SAFETY_FACTOR, load_case, 0.5),
    ]


HELD = [Verdict.PASS, Verdict.PASS, Verdict.PASS, Verdict.FAIL]
LOST = [Verdict.UNDECIDED, Verdict.UNDECIDED, Verdict.PASS, Verdict.FAIL]


@pytest.mark.parametrize("lost", AB)
def test_under_a_load_case_that_is_lost_links_and_pins_are_left_open_and_under_another_not(lost):
    """Whether it was found so on the deformed shape, or the linkage fails as a whole."""
    both = [*every("a"), *every("b")]
    found = unless_it_gives_way(both, {lost: NO_EQUILIBRIUM})
    for name, verdicts in (("a", LOST if lost == "a" else HELD), ("b", LOST if lost == "b" else HELD)):
        assert [one.verdict for one in found if one.load_case == name] == verdicts
        reasons = [told(NO_EQUILIBRIUM) in told(one.reason) for one in found if one.load_case == name]
        assert reasons == [name == lost, name == lost, False, name == lost]
    whole = passing(LINKAGE, Quantity.LOAD_SHARE, lost, 0.4)
    assert unless_it_gives_way([*both, whole]) == [*found, whole]
    assert unless_it_gives_way(both) == both


def linear(factor, **entries):
    """A linkage of which linear theory alone tells, whose limit load is factor/SNAP to factor."""
    entries = {
        "state": "off",
        "dead_point": 2.0 * factor,
        "frame": SimpleNamespace(),
        "reason": reason("large_displacement_off"),
        "points": {},
        "links": {},
    } | entries
    return LargeDisplacement(span=100.0, buckling=factor, **entries)


PLAY, AIR, FRICTION = SourceKind.PLAY, SourceKind.AIR, SourceKind.FRICTION


def cause(kind, *factors, **more):
    """A cause whose answers have these limit loads by linear theory."""
    return Alternatives(source=Source(kind=kind), others=tuple(map(linear, factors)), **more)


def test_a_limit_load_holds_those_of_all_places_of_its_pins_of_all_airs_and_of_all_friction():
    """The outer ends come from the second of two other places, and from the second of two other airs."""
    one = linear(8.0)
    assert (one.limit_load.low, one.limit_load.high) == pytest.approx((8.0 / SNAP, 8.0))
    shaken = replace(one, causes=(cause(PLAY, 7.0, 5.0, 9.0),))
    assert (shaken.limit_load.low, shaken.limit_load.high) == pytest.approx((5.0 / SNAP, 9.0))
    blown = replace(shaken, causes=(*shaken.causes, cause(AIR, 9.5, 4.0, 6.0, coefficients=(2.0, 1.0, 3.0, 2.5))))
    assert (blown.limit_load.low, blown.limit_load.high) == pytest.approx((4.0 / SNAP, 9.5))
    rubbed = replace(blown, causes=(*blown.causes, cause(FRICTION, 7.0, 3.0)))
    assert (rubbed.limit_load.low, rubbed.limit_load.high) == pytest.approx((3.0 / SNAP, 9.5))
    assert {PLAY, AIR, FRICTION} <= {one.kind for one in rubbed.limit_load.sources}


def test_what_solids_tell_of_their_links_is_told_with_other_air_play_and_friction_as_well(monkeypatch):
    soft, solid = Band(value=0.5, low=0.4, high=0.6), object.__new__(SolidResult)
    object.__setattr__(solid, "buckling", SimpleNamespace(least=3.0, error=0.0))
    answers = {"_tells": True, "_beams": 1.0, "_solids": soft, "blind_link": "", "softness": soft}
    for name, answer in {**answers, "works_of_links": [("bar", Band.exact(1.0))]}.items():
        monkeypatch.setattr(known_stiffness, name, lambda *_, answer=answer: answer)
    causes = cause(PLAY, 7.0), cause(AIR, 6.0), cause(FRICTION, 5.0, 9.0)
    one = linear(8.0, solution=object(), causes=causes)
    case, cut = SimpleNamespace(bending_links=("bar",)), {"bar": SimpleNamespace(name="a")}
    found = with_known_stiffness(case, one, None, {"bar": solid}, cut)
    every = [found, *(other for each in found.causes for other in each.others)]
    assert [(other.softness.value, other.alone) for other in every] == [(0.5, 3.0)] * 5


def test_where_the_linkage_gives_way_no_gap_between_layers_passes():
    gap = CheckOutcome.of("c", LINKAGE, "a", Quantity.LAYER_GAP, Band.exact(0.4), 0.0)
    plane = CheckOutcome.of("c", LINKAGE, "a", Quantity.CLEARANCE, Band.exact(0.4), 0.0)
    one, other = unless_it_gives_way([gap, plane], {"a": NO_EQUILIBRIUM})
    assert (one.verdict, one.applies, other) == (Verdict.UNDECIDED, False, plane)
    assert unless_it_gives_way([gap], {"b": NO_EQUILIBRIUM}) == [gap]


def test_play_that_may_pass_a_dead_point_leaves_no_load_that_is_held_for_sure():
    """With a limit load of 1.6 to 8 it passes, unless play may take it through."""
    one = replace(linear(8.0), causes=(cause(PLAY, 7.0, 9.0),))
    assert one.limit_load.low > 1.0
    through = replace(one, causes=(cause(PLAY, 7.0, 9.0, endless=True),))
    assert (through.limit_load.low, through.held_share.low) == (0.0, 0.0)
    assert through.limit_load.high == one.limit_load.high


def test_friction_with_which_it_may_lock_itself_leaves_no_load_that_is_held_for_sure():
    one = replace(linear(8.0), causes=(cause(AIR, 7.0), cause(FRICTION, 7.0)))
    assert one.limit_load.low > 1.0
    locks = replace(one, causes=(cause(AIR, 7.0), cause(FRICTION, 7.0, endless=True)))
    assert (locks.limit_load.low, locks.held_share.low) == (0.0, 0.0)


def test_what_is_stated_and_what_eyes_do_both_take_of_a_limit_load():
    both = linear(8.0, scatter=Scatter(low=0.8, high=1.5), eyes=Scatter(low=0.5, high=1.25)).limit_load
    assert (both.low, both.value, both.high) == pytest.approx((8.0 / SNAP / 1.5 / 1.25, 8.0, 8.0 / 0.8 / 0.5))


@pytest.mark.parametrize("order", [("thick", "thin"), ("thin", "thick")])
def test_the_linkage_holds_no_more_than_its_weakest_solid(order):
    """Of two solids the one whose least factor is less decides, though it may hold more at its best."""
    factors = {"thick": (4.0, 5.0), "thin": (2.0, 6.0)}
    light = SimpleNamespace(worst=SimpleNamespace(equivalent=1.0), strength=10.0)
    [found] = linkage_outcomes("a", linear(20.0), {"thick": light}, {link: factors[link] for link in order})
    assert "link thin by itself buckles at 2 times its load" in told(found.reason)
    assert (found.value.value, found.value.low, found.value.high) == pytest.approx((2.0, 2.0 / SNAP, 6.0))


@pytest.mark.parametrize("order", [("thick", "thin"), ("thin", "thick")])
@pytest.mark.parametrize(("least", "verdict"), [(2.9, Verdict.UNDECIDED), (3.1, Verdict.PASS)])
def test_a_load_that_the_frame_holds_is_left_open_by_a_solid_that_small_faults_may_buckle(order, least, verdict):
    """The frame was followed and holds ten times the load; of two solids the weaker one has less than three."""
    light = SimpleNamespace(worst=SimpleNamespace(equivalent=1.0), strength=10.0)
    factors = {"thick": (5.0, 6.0), "thin": (least, 9.0)}
    held = linear(100.0, state="deformed")
    [found] = linkage_outcomes("a", held, {"thin": light}, {link: factors[link] for link in order})
    assert (found.quantity, found.verdict) == (Quantity.LOAD_SHARE, verdict)
    assert ("link thin by itself buckles at 2.9 times its load" in told(found.reason)) == (verdict is Verdict.UNDECIDED)
