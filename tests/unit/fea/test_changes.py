"""What is told to change a verdict does so: loads, strengths and moduli are changed by it and checked anew."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from edited_cases import PLANAR
from solved import by_hand

from fea.check.run import check_case
from fea.common.band import Band
from fea.common.source import CONTACT, PIN_PRESSURE, TORQUE_TRANSFER, Source, SourceKind, distinct, widest
from fea.common.verdict import Quantity, Verdict
from fea.frame.displacement_band import shares_of_work
from fea.links.solid_result import _width
from fea.sizing.changes import _change, changes
from geometry.materials.material import library
from loads.case.case_file import read_case

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
    assert [lc.checks for lc in bare.load_cases.values()] == [lc.checks for lc in result.load_cases.values()]
    assert bare.warnings == ()


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
    owl = changes(by_hand("owl-wing-static", PLANAR))[0].size
    assert owl.entry == "parts.tube.outer_diameter"
    assert owl.first == "5 mm"
    read_case("owl-wing-static").with_values({owl.entry: owl.last})
    with pytest.raises(Exception, match="keep it more than"):
        read_case("owl-wing-static").with_values({owl.entry: "10 mm"})
    assert float(owl.last.split()[0]) < 10.0


def test_nothing_is_told_of_what_does_not_go_with_the_loads(thick):
    """Growth towards buckling makes the factor a bound; a check that is open for its model has no factor."""
    result, found = thick
    grown = Source(kind=SourceKind.GROWTH)
    check = found[Quantity.SAFETY_FACTOR, "crank"]
    assert _change(result, replace(check, value=replace(check.value, sources=(grown,)))).faster
    coupler = found[Quantity.SAFETY_FACTOR, "coupler"]
    opened = _change(result, coupler.left_open("no model decides it"))
    assert opened.load is None
    assert opened.size is None
    assert _change(result, replace(check, value=Band.unknown("singular"))).load is None
    gap = replace(check, quantity=Quantity.CLEARANCE, value=Band.exact(0.1))
    assert _change(result, gap).load is None
    assert _change(result, gap).size is None


def test_a_check_open_for_its_model_is_not_sized_and_one_open_for_its_band_is(thick):
    """No size calibrates hand calculation: by solids the finger's plate has a number at the size that it has."""
    opened = [change for change in changes(by_hand("finger")) if "run the solid model" in change.check.reason]
    assert {str(change.check.subject) for change in opened} == {"distal"}
    assert {change.size for change in opened} == {None}
    result, found = thick
    check = found[Quantity.SAFETY_FACTOR, "crank"]
    near = replace(check, limit=0.5 * (check.value.low + check.value.high), verdict=Verdict.UNDECIDED)
    assert _change(result, near).size is not None


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
