"""What stays elastic and what does not break: which checks are of which, and what decides each of the two."""

import itertools

import pytest
from edited_cases import NYLON, edited
from slotted_lever import slotted_lever

from alula.fea.asked.tiers import tier_of, tiers_of
from alula.fea.common.band import Band
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Sense, Subject, Tier, Verdict
from alula.loads.case.case_file import read_case
from alula.loads.records.check_spec import MassCheck
from alula.reports.sections.checks import tier_records
from alula.reports.sentences.verdicts import decision, tier_lines
from alula.reports.words.terminal import KEPT

CHECKS = ('checks.bearing={type="bearing"}', 'checks.eyes={type="eye", minimum=2.4, links=["pedal"]}')
BRITTLE = (
    *CHECKS,
    'parts.rod.material="resin-405nm"',
    'joints.R.pin_material="resin-405nm"',
)
PEDAL, ROD = Subject.link("pedal"), Subject.link("rod")


@pytest.fixture(scope="module")
def ductile():
    """A pedal and a rod of aluminium: strength of both, eyes of the pedal, pins and bearing."""
    return edited("spring-pedal", CHECKS)


@pytest.fixture(scope="module")
def mixed():
    """The same with a rod, and a pin at R, of resin."""
    return edited("spring-pedal", BRITTLE)


def outcome(subject, low, high=None, *, name="strength", quantity=Quantity.SAFETY_FACTOR, limit=2.0):
    band = Band(value=low, low=low, high=low if high is None else high)
    return CheckOutcome.of(name, subject, "push", quantity, band, limit)


def eyes(low, high=None):
    return outcome(PEDAL, low, high, name="eyes", quantity=Quantity.EYES, limit=2.4)


def collapse(subject, low, high=None):
    return outcome(subject, low, high, name="collapse", quantity=Quantity.PLASTIC_COLLAPSE, limit=1.0)


def buckling(low, high=None):
    return outcome(LINKAGE, low, high, name="buckling", quantity=Quantity.BUCKLING_FACTOR, limit=1.0)


def test_each_quantity_is_of_one_tier():
    """What loads make of a link is about breaking, but for first yield and for lengths; the rest is of neither."""
    assert {one for one in Quantity if one.tier is Tier.ELASTIC} == {Quantity.SAFETY_FACTOR, Quantity.LINE_CONTACT}
    lengths = {Quantity.DEFLECTION, Quantity.DISPLACEMENT, Quantity.LAYER_GAP, Quantity.PERMANENT_SET}
    neither = {one for one in Quantity if one.tier is Tier.NEITHER}
    assert {one for one in neither if one.origin == "loads"} == lengths
    assert {one for one in Quantity if one.origin != "loads"} < neither
    for one in (Quantity.PLASTIC_COLLAPSE, Quantity.EYES, Quantity.SUSTAINED_STRESS, Quantity.FATIGUE_LIFE):
        assert one.tier is Tier.BREAK


@pytest.mark.parametrize(
    ("subject", "name", "of_ductile", "of_brittle"),
    [
        (PEDAL, "strength", Tier.ELASTIC, Tier.ELASTIC),
        (ROD, "strength", Tier.ELASTIC, Tier.BREAK),
        (Subject.pin("O"), "pins", Tier.ELASTIC, Tier.ELASTIC),
        (Subject.pin("R"), "pins", Tier.ELASTIC, Tier.BREAK),
        (Subject.pin("O"), "bearing", Tier.BREAK, Tier.BREAK),
    ],
)
def test_a_safety_factor_is_of_the_tier_of_the_strength_that_it_is_against(
    ductile, mixed, subject, name, of_ductile, of_brittle
):
    assert [tier_of(case, outcome(subject, 3.0, name=name)) for case in (ductile, mixed)] == [of_ductile, of_brittle]


def test_line_contact_is_of_breaking_where_pin_or_flank_is_brittle():
    case = slotted_lever(force=-40.0)
    one = outcome(Subject.pin("P"), 3.0, name="slot", quantity=Quantity.LINE_CONTACT)
    assert tier_of(case, one) is Tier.ELASTIC
    part, card = case.links["lever"].part, "resin-405nm"
    flank = case.model_copy(
        update={"parts": {**case.parts, part: case.parts[part].model_copy(update={"material": card})}}
    )
    joints = {**case.joints, "P": case.joints["P"].model_copy(update={"pin_material": card})}
    assert [tier_of(own, one) for own in (flank, case.model_copy(update={"joints": joints}))] == [Tier.BREAK] * 2


def test_the_worst_outcome_of_a_tier_decides_it_in_any_order(ductile):
    near, far, open_yet = outcome(PEDAL, 2.5), outcome(ROD, 9.0), outcome(ROD, 1.0, 3.0)
    failing, weak, strong = outcome(PEDAL, 1.9), eyes(2.5), eyes(9.0)
    for elastic, decides in (((near, far), near), ((near, open_yet), open_yet), ((open_yet, failing), failing)):
        for order in itertools.permutations((*elastic, weak, strong)):
            found = tiers_of(ductile, order)
            assert [one.decides for one in found] == [decides, weak]
            assert [one.verdict for one in found] == [decides.verdict, None]
            assert [one.unasked for one in found] == [
                (() if far in order or open_yet in order else ("rod",)),
                ("pedal", "rod"),
            ]


def test_a_link_counts_as_asked_as_a_whole_alone(ductile, mixed):
    """A link may collapse whose eyes, walls and connections bear; so no other quantity makes its tier a pass."""
    parts = [
        outcome(subject, 9.0, name=quantity, quantity=quantity)
        for quantity in Quantity
        if quantity.tier is Tier.BREAK and quantity.sense is Sense.AT_LEAST
        if quantity not in (Quantity.PLASTIC_COLLAPSE, Quantity.NOTCHES)
        for subject in (PEDAL, ROD)
    ]
    bearing = [outcome(Subject.pin(joint), 9.0, name="bearing") for joint in ("O", "R")]
    assert {one.quantity for one in parts} > {Quantity.EYES, Quantity.WALLS, Quantity.FATIGUE_STRESS}

    def broken(case, *more):
        found = tiers_of(case, [outcome(PEDAL, 9.0), outcome(ROD, 9.0), *parts, *bearing, *more])[1]
        return found.verdict, found.unasked, found.asks

    assert broken(ductile) == (None, ("pedal", "rod"), "plastic-collapse")
    assert broken(ductile, collapse(ROD, 2.0)) == (None, ("pedal",), "plastic-collapse")
    assert broken(ductile, collapse(ROD, 2.0), collapse(PEDAL, 2.0))[:2] == (Verdict.PASS, ())
    assert broken(mixed) == (None, ("pedal",), "plastic-collapse")
    assert broken(mixed, collapse(PEDAL, 2.0))[:2] == (Verdict.PASS, ())
    brittle_left = tiers_of(mixed, [collapse(PEDAL, 2.0)])[1]
    assert (brittle_left.unasked, brittle_left.asks) == (("rod",), "safety-factor")
    for one, verdict in ((parts[0], Verdict.FAIL), (bearing[1], Verdict.UNDECIDED)):
        band = Band(value=0.5, low=0.5, high=0.6 if verdict is Verdict.FAIL else 9.0)
        worse = CheckOutcome.of(one.name, one.subject, "push", one.quantity, band, 1.0)
        assert broken(ductile, worse)[0] is verdict
    brittle = [
        outcome(Subject.link(name), 9.0, name="sharp", quantity=Quantity.NOTCHES) for name in ("crank", "rocker")
    ]
    assert tiers_of(read_case("four-bar"), brittle)[1].unasked == ("coupler",)
    pins = [outcome(Subject.pin(joint), 9.0, name="pins") for joint in ("O", "R")]
    elastic = tiers_of(ductile, pins)[0]
    assert (elastic.verdict, elastic.unasked, elastic.asks) == (None, ("pedal", "rod"), "safety-factor")


def test_what_nobody_asked_for_does_not_say_that_nothing_breaks_but_tells_where_something_does(ductile):
    named_alike = MassCheck(type="mass", maximum="25 g")
    for case in (ductile, ductile.model_copy(update={"checks": {**ductile.checks, "buckling": named_alike}})):
        elastic, broken = tiers_of(case, [outcome(PEDAL, 2.5), outcome(ROD, 2.5), buckling(5.0)])
        assert (elastic.verdict, broken.verdict, broken.asks) == (Verdict.PASS, None, "plastic-collapse")
        assert broken.unasked == ("pedal", "rod")
    lost, open_yet = buckling(0.5), buckling(0.9, 1.2)
    for more in ([outcome(PEDAL, 2.5)], [eyes(9.0), eyes(2.5)], [collapse(PEDAL, 2.0), collapse(ROD, 2.0)]):
        for worst in (lost, open_yet):
            broken = tiers_of(ductile, [*more[:1], worst, *more[1:]])[1]
            assert (broken.decides, broken.verdict) == (worst, worst.verdict)
    deflected = outcome(PEDAL, 9.0, name="bend", quantity=Quantity.DEFLECTION, limit=1.0)
    assert deflected.verdict is Verdict.FAIL
    assert [one.decides for one in tiers_of(ductile, [deflected])] == [None, None]


def test_brittle_links_have_no_elastic_tier(mixed):
    elastic, broken = tiers_of(mixed, [outcome(PEDAL, 2.5), outcome(ROD, 2.2)])
    assert (elastic.links, elastic.decides.subject) == (("pedal",), PEDAL)
    assert (broken.links, broken.decides.subject, broken.unasked) == (("pedal", "rod"), ROD, ("pedal",))
    starter = read_case("four-bar")
    checks = [outcome(Subject.link(name), 7.0, limit=6.0) for name in starter.checked_links]
    elastic, broken = tiers_of(starter, checks)
    assert (elastic.links, elastic.verdict, broken.verdict, broken.unasked) == ((), None, Verdict.PASS, ())
    assert tiers_of(starter, [])[1].asks == "safety-factor"


def test_a_link_printed_in_layers_is_never_said_to_want_a_check_that_it_is_refused():
    """Its layers come apart before it flows, whatever its card: its safety factor is of breaking."""
    laid = [(f'parts.{part}.material="nylon"', f"parts.{part}.build_direction=[0, 0, 1]") for part in ("lever", "rod")]
    strength = [f'checks.{name}={{type="safety-factor", minimum=2}}' for name in ("collapse", "eyes")]
    one = edited("spring-pedal", (NYLON, *strength, laid[0][0], *laid[1]))  # the lever of the same, not in layers
    both = edited("spring-pedal", (NYLON, *strength, *laid[0], *laid[1]))
    stock = edited("spring-pedal", (*CHECKS[:1], "parts.rod.build_direction=[0, 0, 1]"))
    assert tiers_of(stock, [collapse(PEDAL, 2.0)])[1].asks == "plastic-collapse"
    asked = [outcome(PEDAL, 2.5), outcome(ROD, 2.2)]
    elastic, broken = tiers_of(one, asked)
    assert [tier_of(one, check) for check in asked] == [Tier.ELASTIC, Tier.BREAK]
    assert (elastic.links, elastic.verdict) == (("pedal",), Verdict.PASS)
    assert (broken.unasked, broken.asks, broken.decides.subject) == (("pedal",), "plastic-collapse", ROD)
    assert tiers_of(one, [collapse(PEDAL, 2.0)])[1].asks == "safety-factor"
    elastic, broken = tiers_of(both, asked)
    assert (elastic.links, broken.verdict, broken.decides.subject) == ((), Verdict.PASS, ROD)
    assert tiers_of(both, [])[1].asks == "safety-factor"


def test_the_lines_name_what_decides_and_what_asks(ductile, mixed):
    def lines(case, *checks, several=False):
        return [line.replace(KEPT, " ") for line in tier_lines(tiers_of(case, checks), several=several)]

    assert lines(ductile, outcome(ROD, 1.5, 1.9), outcome(PEDAL, 3.0), eyes(2.5, 3.0)) == [
        "Stays elastic: FAIL, safety factor of rod 1.50 (1.50 to 1.90) < 2.",
        "Does not break: not asked of whole links (add a plastic-collapse check); all else passes, "
        "safety factor of the eyes of pedal 2.50 (2.50 to 3.00) ≥ 2.4.",
    ]
    assert lines(ductile, outcome(ROD, 3.0), outcome(PEDAL, 4.0), eyes(2.5), collapse(PEDAL, 8.0)) == [
        "Stays elastic: PASS, safety factor of rod 3.00 ≥ 2.",
        "Does not break: PASS for 1 of 2 links: safety factor of the eyes of pedal 2.50 ≥ 2.4; not asked of rod.",
    ]
    assert lines(ductile, outcome(ROD, 1.0, 3.0), eyes(2.0, 3.0)) == [
        "Stays elastic: UNDECIDED, asked of 1 of 2 links: safety factor of rod 1.00 (1.00 to 3.00), limit ≥ 2; "
        "not asked of pedal.",
        "Does not break: UNDECIDED, asked of none of 2 links: "
        "safety factor of the eyes of pedal 2.00 (2.00 to 3.00), limit ≥ 2.4; not asked of pedal and rod.",
    ]
    assert lines(ductile, outcome(ROD, 1.5, 2.5), outcome(PEDAL, 3.0), several=True) == [
        "Stays elastic: UNDECIDED, safety factor of rod (push) 1.50 (1.50 to 2.50), limit ≥ 2.",
        "Does not break: not asked; a check of type plastic-collapse asks for it.",
    ]
    lost = outcome(LINKAGE, 0.2, name="held", quantity=Quantity.LOAD_SHARE, limit=1.0)
    assert lines(
        ductile, outcome(ROD, 9.0).not_applicable("gone"), outcome(PEDAL, 9.0).not_applicable("gone"), lost
    ) == [
        "Stays elastic: UNDECIDED, safety factor of rod is not applicable.",
        "Does not break: FAIL, the linkage gives way.",
    ]
    stays = outcome(ROD, 12.0, name="long", quantity=Quantity.SUSTAINED_STRESS, limit=11.0)
    assert lines(ductile, stays)[1] == "Does not break: FAIL, sustained stress of rod 12.0 > 11 MPa."
    assert lines(read_case("four-bar"), outcome(Subject.link("crank"), 7.0)) == [
        "Stays elastic: not asked of links that break before they yield.",
        "Does not break: PASS for 1 of 3 links: safety factor of crank 7.00 ≥ 2; not asked of coupler and rocker.",
    ]
    six = read_case("six-bar")
    assert lines(six, outcome(Subject.link("crank"), 7.0))[0] == (
        "Stays elastic: PASS for 1 of 5 links: safety factor of crank 7.00 ≥ 2."
    )


def test_what_decides_a_tier_is_not_told_twice(ductile):
    near, bend = outcome(PEDAL, 2.5), outcome(PEDAL, 0.9, name="bend", quantity=Quantity.DEFLECTION, limit=1.0)
    for checks, tail in (((near, eyes(9.0)), False), ((near, eyes(9.0), bend), True)):
        told = decision(Verdict.PASS, checks, several=False, tiers=tiers_of(ductile, checks))
        assert ("Closest to its limit" in told) == tail


def test_data_of_the_tiers(ductile):
    elastic, broken = tier_records(ductile, [outcome(PEDAL, 1.5), outcome(ROD, 3.0)])
    decides = {"name": "strength", "link": "pedal", "load_case": "push", "quantity": "safety factor"}
    assert elastic == {
        "tier": "stays elastic", "verdict": "fail", "asks": "safety-factor", "decides": decides, "not_asked_of": []
    }  # fmt: skip
    assert (broken["verdict"], broken["decides"], broken["not_asked_of"]) == (None, None, ["pedal", "rod"])
