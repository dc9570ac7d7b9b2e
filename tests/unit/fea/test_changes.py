"""What is told to change a verdict does so: loads, strengths and moduli are changed by it and checked anew."""

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest
from edited_cases import PLANAR, edited
from solved import by_hand

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.change import rounded
from alula.fea.common.source import CONTACT, PIN_PRESSURE, TORQUE_TRANSFER, Source, SourceKind, distinct, widest
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.frame.displacement_band import shares_of_work
from alula.fea.links.solid_result import _width
from alula.fea.refine.refinement import Effort
from alula.fea.sizing.changes import _change, changes
from alula.fea.sizing.size_range import _entry, _taken, size_range
from alula.fea.sizing.tried import Resized, Trials
from alula.geometry.materials.family import most_of_family
from alula.geometry.materials.material import library
from alula.loads.case.case_file import read_case, read_text
from alula.reports.sentences import told as in_words
from alula.reports.sentences.verdicts import headline, named

THICK = {
    "parts.bar.thickness": "8 mm",
    "load_cases.lift.own_weight": False,
    "checks.stiffness.maximum": "0.03 mm",
}
"""So that the undeformed pose is good enough."""


def checked(case):
    """By hand, with the outcomes by quantity and subject."""
    result = check_case(case, name=case.origin, fidelity="beam", threads=1)
    return result, {(c.quantity, str(c.subject)): c for lc in result.load_cases.values() for c in lc.checks}


@pytest.fixture(scope="module")
def thick():
    return checked(read_case("four-bar").with_values(THICK))


@pytest.mark.parametrize(("quantity", "link"), [(Quantity.SAFETY_FACTOR, "crank"), (Quantity.DEFLECTION, "crank")])
def test_all_loads_times_the_told_factor_take_a_check_to_its_limit(thick, quantity, link):
    result, found = thick
    change = _change(result, found[quantity, link])
    assert change.load is not None
    assert not change.faster
    assert change.load < change.until
    factor = change.load
    scaled = read_case("four-bar").with_values(
        THICK | {"load_cases.lift.forces.0.force": ["0 N", f"{-5.0 * factor!r} N"]}
    )
    again = checked(scaled)[1][quantity, link]
    end = again.value.low if again.at_least else again.value.high
    assert end == pytest.approx(again.limit, rel=1e-9)


@pytest.mark.parametrize(
    ("quantity", "field"), [(Quantity.SAFETY_FACTOR, "ultimate_strength"), (Quantity.DEFLECTION, "youngs_modulus")]
)
def test_the_told_strength_or_modulus_takes_a_check_to_its_limit(thick, quantity, field):
    """A card of its own, all of whose strengths or moduli are as many times as large."""
    result, found = thick
    change = _change(result, found[quantity, "crank"]).material
    assert change.stated == getattr(library()[change.material], field)
    ratio = change.needed / change.stated
    card = library()[change.material]
    ranges = {"ultimate_strength": "strength_range", "youngs_modulus": "youngs_modulus_range"}
    stated = getattr(card, ranges[field])
    values = {field: ratio * getattr(card, field), ranges[field]: tuple(ratio * end for end in stated)}
    case = read_case("four-bar").with_values(THICK)
    case = case.model_copy(update={"materials": {change.material: card.model_copy(update=values)}})
    again = checked(case)[1][quantity, "crank"]
    assert (again.value.low if again.at_least else again.value.high) == pytest.approx(again.limit, rel=1e-9)


def test_what_passes_by_far_is_told_as_far_as_linear_theory_is_enough(thick):
    """Loads by a factor just below that leave the undeformed pose good enough, and just above they do not."""
    result, found = thick
    change = _change(result, replace(found[Quantity.DEFLECTION, "crank"], limit=10.0, verdict=Verdict.PASS))
    assert 1.0 < change.until < change.load
    assert change.material.needed == pytest.approx(change.material.stated / change.until)
    for factor, state in ((0.99, "small"), (1.01, "deformed")):
        force = {"load_cases.lift.forces.0.force": ["0 N", f"{-5.0 * factor * change.until!r} N"]}
        again = checked(read_case("four-bar").with_values(THICK | force))[0]
        assert again.load_cases["lift"].large_displacement.state == state


def test_a_bare_check_gives_the_same_load_cases_without_what_the_loads_do_not_make(thick):
    result, _ = thick
    case = result.case
    bare = check_case(case, name=case.origin, fidelity="beam", threads=1, bare=True)
    of_bare, of_result = ([repr(lc.checks) for lc in one.load_cases.values()] for one in (bare, result))
    assert of_bare == of_result
    assert bare.warnings == ()


def test_a_trial_looks_at_tilting_pins_in_the_links_that_it_compares_alone():
    """Numbers of the link that is compared, of pins and of the linkage stay; bands of the other links leave it out."""
    case = read_case("six-bar")
    every, few = (
        check_case(case, name=case.origin, fidelity="beam", threads=1, bare=True, told=links).load_cases["wind"].checks
        for links in (None, ("connector",))
    )
    pairs = list(zip(every, few, strict=True))
    others = {"crank", "coupler", "rocker", "flap"}
    assert all(one == other for one, other in pairs if one.subject.name not in others)
    assert {one.subject.name for one, other in pairs if one != other} == others


def test_the_linkage_holds_the_told_share_of_its_load():
    """The owl wing fails; just below that share of its load the same check passes, and just above it does not.

    The path to the limit load is followed in steps of about 2 %.
    """
    case = read_case("owl-wing-static", [PLANAR])
    result = by_hand("owl-wing-static", PLANAR)
    [change] = changes(result)
    assert change.check.quantity is Quantity.LOAD_SHARE
    assert change.load == pytest.approx(result.load_cases["weight"].linkage.limit_load.low)
    for factor, kept in ((0.97 * change.load, True), (1.03 * change.load, False)):
        force = {"load_cases.weight.forces.0.force": ["0 N", f"{-0.25 * factor} N"]}
        found = checked(case.with_values(force))[1]
        assert (found[Quantity.LOAD_SHARE, "the linkage"].verdict is Verdict.PASS) is kept


def test_the_softest_link_is_sized(thick):
    """Shares of work are strain energies, which Clapeyron's theorem sums to the work of the loads."""
    result, _ = thick
    case, moved = result.case, result.load_cases["lift"].large_displacement
    shares = shares_of_work(case, moved.frame, moved.solution)
    assert sum(shares.values()) == pytest.approx(1.0)
    assert set(shares) == {"crank", "coupler", "rocker"}
    owl = by_hand("owl-wing-static", PLANAR)
    [told] = changes(owl)
    entry, size = _entry(Trials(result=owl), told.check)
    assert (entry, size) == ("parts.tube.outer_diameter", 5.0)
    assert list(_taken(owl.case, entry, [2.0 * size, 1.8 * size])) == ["9 mm"]  # at 10 mm eyes keep no distance
    assert told.size is None  # no value up to there holds the load


def test_a_size_out_of_calibration_is_refuted_without_solving_anything():
    """Fillets are smaller to a tube of 9 mm than any that was measured; a whole check finds that it does not hold."""
    owl = by_hand("owl-wing-static", PLANAR)
    trials, [check] = Trials(result=owl), [one for one in owl.load_cases["weight"].checks if one.gives_way]
    far, near = (Resized(entry="parts.tube.outer_diameter", value=value) for value in ("9 mm", "5.1 mm"))
    assert trials.beyond("weight", far)
    assert not trials.beyond("weight", near)
    assert size_range(trials, check) is None
    assert not trials._done
    assert not trials.holds(far)
    plain = owl.load_cases["weight"]
    strength = [one for one in plain.checks if one.quantity is Quantity.SAFETY_FACTOR]

    def beyond(checks=plain.checks, links=plain.links, case=owl.case):
        changed = replace(owl, case=case, load_cases={"weight": replace(plain, checks=checks, links=links)})
        return Trials(result=changed).beyond("weight", far)

    assert beyond(strength)
    assert not beyond([replace(one, value=Band.exact(10.0)).left_open("its model") for one in strength])
    idle = [replace(one, value=Band.exact(math.inf), verdict=Verdict.PASS) for one in strength]
    assert not beyond(idle)
    assert not beyond([replace(one, value=Band.unknown("singular")) for one in strength])
    assert not beyond([replace(one, quantity=Quantity.BUCKLING_FACTOR) for one in strength])  # that is not calibrated
    assert not beyond(links=plain.links | {"AE": "a solid"})
    assert not beyond(case=far.on(owl.case))  # it was out before


def test_nothing_is_told_of_what_does_not_go_with_the_loads(thick):
    """Growth towards buckling makes the factor a bound; a check that is open for its model has no factor."""
    result, found = thick
    grown = Source(kind=SourceKind.GROWTH)
    check = found[Quantity.SAFETY_FACTOR, "crank"]
    assert _change(result, replace(check, value=replace(check.value, sources=(grown,)))).faster
    coupler = found[Quantity.SAFETY_FACTOR, "coupler"]
    opened = _change(result, coupler.left_open("no model decides it"))
    assert opened.load is None
    assert not opened.sizable
    assert _change(result, replace(check, value=Band.unknown("singular"))).load is None
    gap = replace(check, quantity=Quantity.CLEARANCE, value=Band.exact(0.1))
    assert _change(result, gap).load is None
    assert size_range(Trials(result=result), gap) is None


def test_a_check_open_for_its_model_is_not_sized_and_one_open_for_its_band_is(thick):
    """No size calibrates hand calculation: by solids the finger's plate has a number at the size that it has."""
    finger = by_hand("finger")
    opened = [check for check in finger.load_cases["grip"].checks if "run the solid model" in in_words(check.reason)]
    assert {str(check.subject) for check in opened} == {"distal", "middle"}
    assert not any(_change(finger, check).sizable for check in opened)
    result, found = thick
    check = found[Quantity.SAFETY_FACTOR, "crank"]
    near = replace(check, limit=0.5 * (check.value.low + check.value.high), verdict=Verdict.UNDECIDED)
    assert _change(result, near).sizable


def test_the_widest_sources_are_those_of_the_largest_factor():
    """A band from 1 to 6: scatter makes 2 of it and contact 1.06, so that 2.83 is of what is not known alone."""
    load = Source(kind=SourceKind.LOAD, width=2.0)
    narrow, other = Source(kind=SourceKind.EYES), Source(kind=SourceKind.PATH)
    assert widest((load, CONTACT, narrow), 6.0) == (narrow,)
    assert widest((load, CONTACT, narrow, other), 6.0) == (narrow, other)
    assert widest((load, CONTACT, narrow), 3.0) == (load,)
    assert widest((load,), 1.0) == ()
    assert distinct((load,), (replace(load, width=3.0),))[0].width == 3.0
    assert distinct((load,), (Source(kind=SourceKind.LOAD),))[0].width == 2.0


def test_variants_of_a_solid_say_how_wide_their_kinds_are():
    """Stresses 10 and 12 by two spans, and by the other transfer 15 and 16: spans differ by 1.2, transfers by 1.5."""
    stresses = {(180, "eye-faces"): 10.0, (90, "eye-faces"): 12.0, (180, "bore-shear"): 15.0, (90, "bore-shear"): 16.0}
    refined = SimpleNamespace(
        solution=SimpleNamespace(cases=[SimpleNamespace(span=s, transfer=t) for s, t in stresses]),
        precision=[SimpleNamespace(series=lambda q, v=v: SimpleNamespace(value=v)) for v in stresses.values()],
    )
    assert _width(PIN_PRESSURE, "von_mises", refined, range(4)) == pytest.approx(1.2)
    assert _width(TORQUE_TRANSFER, "von_mises", refined, range(4)) == pytest.approx(1.5)
    assert _width(CONTACT, "von_mises", refined, range(4)) == pytest.approx(1.0 / 0.94)


CLAMP = {
    "title": "A clamp whose rocker presses with 150 N; of printed plastic it gives way at 13 % of that",
    "links.base.points.O4": ["120 mm", "0 mm"],
    "links.crank.points.A": ["45 mm", "0 mm"],
    "links.coupler.points.B": ["130 mm", "0 mm"],
    "links.rocker.points.B": ["90 mm", "0 mm"],
    "links.rocker.points.P": ["140 mm", "0 mm"],
    "links.rocker.end_patch": "8 mm",
    "load_cases.lift.forces.0.force": ["0 N", "-150 N"],
    "load_cases.lift.own_weight": False,
}
METAL = {"parts.bar.material": "aluminium-6061-t6"}
ADVISED = {
    "gives way": CLAMP,
    "open by its band": CLAMP | METAL,
    "passes": CLAMP | METAL | {"parts.bar.thickness": "6 mm"},
    "light": THICK | METAL | {"links.rocker.end_patch": "8 mm"},
}


def more_loads(case, factor):
    """Forces times a factor; nothing else acts."""
    load_cases = {
        name: one.model_copy(
            update={
                "forces": [
                    force.model_copy(update={"force": tuple(factor * part for part in force.force)})
                    for force in one.forces
                ]
            }
        )
        for name, one in case.load_cases.items()
    }
    return case.model_copy(update={"load_cases": load_cases})


def another_card(case, change):
    """Strengths or moduli as they are told, with all that goes with them; every card where none is named."""
    kinds = ("modulus",) if "modul" in change.what else ("strength", "sustained_stress")
    times = rounded(change.needed, up=True) / change.stated
    cards = {}
    for name, card in case.all_materials.items():
        own = {key: value for key, value in card if any(kind in key for kind in kinds) and value is not None}
        scaled = {
            key: times * value if isinstance(value, float) else tuple(times * end for end in value)
            for key, value in own.items()
            if isinstance(value, float) or (isinstance(value, tuple) and value and isinstance(value[0], float))
        }
        if change.material in ("", name):
            cards[name] = card.model_copy(update=scaled)
    return case.model_copy(update={"materials": {**case.materials, **cards}})


@pytest.mark.parametrize(("most", "holds"), [("200 g", True), ("30 g", False)])
def test_a_size_that_leaves_a_linkage_small_is_told_where_the_whole_check_takes_it(most, holds, tmp_path):
    """At twice its thickness linear theory will do for the clamp, and has no share of the load: no size was told.

    It weighs 24 g as it is, which no load makes: the size was told whatever a check of mass asks.
    """
    file = tmp_path / "heavy.toml"
    file.write_text(f'{read_text("four-bar")[0]}\n[checks.light]\ntype = "mass"\nmaximum = "{most}"\n')
    bent = {"parts.bar.thickness": "3 mm", "load_cases.lift.forces.0.force": ["0 N", "-120 N"]}
    eased = {"checks.strength.minimum": 0.5, "checks.stiffness.maximum": "2 mm"}
    result, found = checked(read_case(str(file)).with_values(CLAMP | METAL | bent | eased))
    share = found[Quantity.LOAD_SHARE, "the linkage"]
    assert (share.verdict, found[Quantity.MASS, "the linkage"].verdict) == (Verdict.UNDECIDED, Verdict.PASS)
    trials, twice = Trials(result=result), Resized(entry="parts.bar.thickness", value="6 mm")
    again, stiff = checked(twice.on(result.case))
    assert again.load_cases["lift"].large_displacement.state == "small"
    assert trials.expected(share, twice) == stiff[Quantity.BUCKLING_FACTOR, "the linkage"].margin > 1.0
    assert trials.holds(twice) is holds
    assert not trials.holds(Resized(entry="parts.bar.width", value="1 mm"))  # its eyes are no wider than their holes
    [told] = changes(result)
    assert (told.size is not None) is holds


@pytest.mark.parametrize("name", ADVISED)
def test_what_is_told_is_of_the_headline_and_passes_where_it_is_done(name):
    """The clamp was told a strength of 1750 MPa in place of 33, which does not hold it, and sizes of which none did."""
    case = read_case("four-bar").with_values(ADVISED[name])
    result, _ = checked(case)
    [told] = changes(result)
    assert any(named(told.check, long=long) in headline(result).lower() for long in (False, True))
    assert told.check.verdict is result.verdict
    failing = {c.quantity for lc in result.load_cases.values() for c in lc.checks if c.verdict is Verdict.FAIL}
    assert (told.check.quantity is Quantity.LOAD_SHARE) is (Quantity.LOAD_SHARE in failing)

    def kept(changed):
        return checked(changed)[1][told.check.quantity, str(told.check.subject)].verdict is Verdict.PASS

    done = []
    if told.load is not None:
        done.append(kept(more_loads(case, rounded(told.load, up=False))))
    if told.material is not None:
        done.append(kept(another_card(case, told.material)))
        if "strength" in told.material.what:
            assert told.material.needed <= max(460.0, told.material.stated)
    if told.size is not None:
        done.append(any(kept(case.with_values({told.size.entry: end})) for end in (told.size.first, told.size.last)))
    assert all(done)
    assert done, "nothing was told"


def test_a_family_is_told_by_its_density_and_its_strongest_card_bounds_what_is_told():
    """Printed plastics reach 52 MPa, aluminium 460 MPa at yield, and steel 1330 MPa as wire; no card adds or takes."""
    cards = library()
    most = {name: most_of_family(cards, cards[name], "yield_strength") for name in cards}
    assert (most["pla-fdm-xy"], most["aluminium-6061-t6"], most["steel-s235"]) == (41.4, 460.0, 1330.0)
    assert most_of_family(cards, cards["pla-fdm-xy"], "ultimate_strength") == 52.0
    assert most_of_family({}, cards["pla-fdm-xy"], "sustained_stress") == 0.0


@pytest.mark.parametrize(("force", "verdict"), [(-12, Verdict.UNDECIDED), (-20, Verdict.FAIL)])
def test_a_load_is_tried_of_a_link_that_hand_calculation_alone_does_not_decide(force, verdict):
    """On its deformed shape; by hand the rocker's band holds the limit or is below it, with an end not calibrated."""
    case = edited("four-bar", [f'load_cases.lift.forces=[{{link="rocker", at="P", force=["0 N", "{force} N"]}}]'])
    result = check_case(case, fidelity="solid", effort=Effort(max_meshes=1))
    assert result.load_cases["lift"].large_displacement.state == "deformed"
    [change] = changes(result)
    assert (change.check.subject.name, change.check.verdict) == ("rocker", verdict)
    assert change.load == pytest.approx(change.check.margin, rel=0.05)


def test_the_limit_that_is_told_is_the_one_that_was_passed():
    """Eyes as soft as they may be raise it above 10."""
    case = edited("four-bar", ['load_cases.lift.forces=[{link="rocker", at="P", force=["0 N", "-2.2 N"]}]'])
    moved = check_case(case, fidelity="beam").load_cases["lift"].large_displacement
    assert moved.state == "deformed"
    assert f"buckles at {moved.buckling:.3g} times its load, too near for linear theory (limit 12.5)" in in_words(
        moved.reason
    )
    assert 10.0 < moved.buckling < 12.5
