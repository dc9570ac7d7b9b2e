import importlib.resources
import json
import math
import re
from itertools import combinations

import pytest
import solved
from edited_cases import PLANAR
from pydantic import ValidationError

import alula.fea.check.run
import alula.fea.claims.data
from alula.fea.check.run import links_by_hand
from alula.fea.claims.audit import Finding, Names, check_claim
from alula.fea.claims.sources import check_claims
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.ornithopter import motors
from alula.loads.case.case_file import read_case
from alula.loads.sources.claim import (
    CaseSystem,
    Claim,
    FlappingSystem,
    OrnithopterSystem,
    SynthesisSystem,
    TableSystem,
    read_printed,
    read_source,
    sources,
)
from alula.loads.sources.expression import evaluate
from alula.loads.sources.quantity import Value
from alula.reports.check.published import as_json, as_markdown
from alula.reports.commands.telling import text_of
from alula.reports.sections.published import claims_section, count, note_of

TREE = {
    "pose": {
        "x": Value.of(12.34, "mm"),
        "zero": Value.of(0.0, "mm"),
        "angle": Value.of(30.004, "deg"),
        "branch": "open",
    },
    "beam": {"stress": Value.of(3.64, "MPa")},
}


def test_links_by_hand_alone_have_the_values_of_a_whole_check():
    result = solved.by_hand("owl-wing-static")
    for load_case, links in links_by_hand(solve_case_statics(result.case, result.name)).items():
        whole = result.load_cases[load_case].links
        assert list(links) == list(whole)
        for link, found in links.items():
            for name in ("von_mises_max", "principal_max", "displacement_max", "safety_factor"):
                band, checked = getattr(found, name), getattr(whole[link], name)
                assert band.value == checked.value
                assert checked.low <= band.low <= band.high <= checked.high


def claim(published: str, **entries: object) -> Claim:
    return Claim.model_validate({"name": "a.claim", "published": published, "source": "Someone (2000)", **entries})


def judge(published: str, given=None, **entries):
    stated = claim(published, **entries)
    return check_claim(stated, Names(TREE, given or {}, stated.not_stated))


@pytest.mark.parametrize(
    ("text", "number", "unit", "half"),
    [
        ("0.9520 N", 0.952, "N", 5e-5),
        ("-0.0372", -0.0372, "", 5e-5),
        ("45", 45, "", 0.5),
        ("5.027e-5 N", 5.027e-5, "N", 5e-9),
        ("4.14e7 Pa", 4.14e7, "Pa", 5e4),
        ("24 %", 24, "%", 0.5),
        ("1450 kg/m^3", 1450, "kg/m^3", 0.5),
        ("−3.5°", -3.5, "°", 0.05),
    ],
)
def test_printed_digits(text, number, unit, half):
    printed = read_printed(text)
    assert printed is not None
    assert (printed.number, printed.unit) == (number, unit)
    assert printed.half == pytest.approx(half)


def test_words_are_no_number():
    assert read_printed("open") is None
    assert read_printed("s + l > p + q") is None
    with pytest.raises(CaseError, match="'furlong_s' is no unit"):
        read_printed("3 furlong_s")


@pytest.mark.parametrize(
    ("published", "finding"),
    [
        ("12.34 mm", Finding.HOLDS),
        ("12.3 mm", Finding.HOLDS),
        ("1.234 cm", Finding.HOLDS),
        ("12 mm", Finding.HOLDS),
        ("12.35 mm", Finding.DOES_NOT_HOLD),
        ("12.4 mm", Finding.DOES_NOT_HOLD),
        ("13 mm", Finding.DOES_NOT_HOLD),
        ("12.340 mm", Finding.HOLDS),
        ("12.341 mm", Finding.DOES_NOT_HOLD),
    ],
)
def test_a_figure_holds_within_its_printed_digits(published, finding):
    assert judge(published, quantity="pose.x").finding is finding


def test_half_a_unit_of_the_last_digit_still_holds():
    assert judge("0.5", stated="0.55").finding is Finding.HOLDS
    assert judge("0.5", stated="0.5500001").finding is Finding.DOES_NOT_FOLLOW


@pytest.mark.parametrize(
    ("published", "stated", "finding"),
    [
        ("1.93", "1.9356", Finding.HOLDS),  # rounded it would be 1.94
        ("-1.93", "-1.9356", Finding.HOLDS),
        ("1.93", "1.94", Finding.DOES_NOT_FOLLOW),  # a whole unit off
        ("1.94", "1.9356", Finding.HOLDS),
        ("1.95", "1.9444", Finding.DOES_NOT_FOLLOW),  # nothing is cut off upwards
        ("-1.93", "-1.9244", Finding.DOES_NOT_FOLLOW),
        ("5e-5", "5.9e-5", Finding.DOES_NOT_FOLLOW),  # one digit shows nothing
        ("5.2e-5", "5.29e-5", Finding.HOLDS),
        ("0", "0.9", Finding.DOES_NOT_FOLLOW),
    ],
)
def test_a_figure_may_be_cut_off(published, stated, finding):
    found = judge(published, stated=stated)
    assert found.finding is finding
    cut = finding is Finding.HOLDS and published != "1.94"
    assert note_of(found).startswith("It follows, cut off after its printed digits and not rounded.") == cut
    if finding is Finding.HOLDS and cut:  # a stated tolerance stands instead
        assert judge(published, stated=stated, tolerance="0.1 %").finding is Finding.DOES_NOT_FOLLOW


@pytest.mark.parametrize(
    ("tolerance", "finding"),
    [("0.1 mm", Finding.HOLDS), ("0.01 cm", Finding.HOLDS), ("1 %", Finding.HOLDS), ("0.1 %", Finding.DOES_NOT_HOLD)],
)
def test_tolerance(tolerance, finding):
    assert judge("12.40 mm", quantity="pose.x", tolerance=tolerance).finding is finding


def test_a_stated_quotient_is_evaluated_with_its_units():
    found = judge("36.42", stated="41.4 MPa / 11.37 MPa", quantity="")
    assert found.finding is Finding.DOES_NOT_FOLLOW
    assert found.ours == "3.64116"
    assert note_of(found) == "By the source's own figures it is 3.64116: the printed figure is 10 times too large."


def test_following_from_the_source_is_not_enough():
    found = judge("2.00 mm", stated="1 mm + 1 mm", quantity="pose.x")
    assert found.finding is Finding.DOES_NOT_HOLD
    assert note_of(found).endswith(
        "6.17 times too small. The printed figure does follow from the source's own relation."
    )
    right = judge("12.34 mm", stated="1 mm + 1 mm", quantity="pose.x")
    assert right.finding is Finding.DOES_NOT_FOLLOW
    assert note_of(right).endswith("The printed figure itself is right.")


def test_a_figure_that_is_not_what_its_name_says_is_told_as_both():
    found = judge("12.34 mm", quantity="pose.x", means="2 * pose.x")
    assert found.finding is Finding.HOLDS
    assert note_of(found) == "It follows from the source's own definition; what its name says is 24.68 mm."
    assert "definition" not in note_of(judge("12.34 mm", quantity="pose.x", means="pose.x + 0.006 mm"))


@pytest.mark.parametrize(
    ("published", "how"),
    [
        ("-12.34 mm", "so only the sign is wrong"),
        ("-3.00 mm", "of the other sign"),
        ("0.00 mm", "where the source prints zero"),
        ("123.4 mm", "10 times too large"),
        ("0.1234 mm", "100 times too small"),
        ("13.00 mm", "5.3 % too large"),
    ],
)
def test_how_far_off(published, how):
    assert how in note_of(judge(published, quantity="pose.x"))


def test_angles_are_off_by_degrees():
    assert note_of(judge("29 deg", quantity="pose.angle")).endswith("the printed figure is 1 deg too small.")
    assert note_of(judge("2 mm", quantity="pose.zero")) == "Re-derived, it is 0 mm."


def test_what_is_not_stated_is_named_and_not_called_wrong():
    missing = {"S": "the reference area S"}
    found = judge("0.87", quantity="1 m^2 / not_stated.S", not_stated=missing)
    assert found.finding is Finding.CANNOT_BE_REDERIVED
    assert not found.finding.refutes
    assert found.ours is None
    assert note_of(found) == "The source does not state the reference area S."
    # What the source shows of its arithmetic is checked all the same.
    assert judge("0.87", quantity="not_stated.S", not_stated=missing, stated="0.87").finding is Finding.HOLDS
    assert judge("0.87", quantity="not_stated.S", not_stated=missing, stated="1").finding is Finding.DOES_NOT_FOLLOW


def test_words_are_compared_as_words():
    assert judge("Open", quantity="pose.branch").finding is Finding.HOLDS
    found = judge("crossed", quantity="pose.branch")
    assert (found.finding, found.ours, note_of(found)) == (
        Finding.DOES_NOT_HOLD,
        "open",
        "Re-derived, the answer is open.",
    )


def test_given_figures_may_build_on_each_other():
    figures = {"a": "2 mm", "b": "given.a * 3", "c": "given.c"}
    assert judge("6 mm", given=figures, stated="given.b").finding is Finding.HOLDS
    with pytest.raises(CaseError, match=r"given\.c: it refers to itself"):
        judge("6 mm", given=figures, stated="given.c")


@pytest.mark.parametrize(
    ("published", "entries", "sentence"),
    [
        ("1 mm", {"quantity": "pose.y"}, "claims.a.claim: path 'pose.y': pose has no 'y'; choose one of x, zero"),
        ("1 mm", {"quantity": "pose"}, "it is no quantity; go on with one of x"),
        ("1 mm", {"quantity": "pose.x.y"}, "it holds nothing further"),
        ("1 mm", {"quantity": "not_stated.S"}, "'not_stated.S' is unknown"),
        ("1 N", {"quantity": "pose.x"}, "cannot be given in N"),
        ("open", {"quantity": "pose.x"}, "not of one kind"),
        ("1 mm", {"quantity": "pose.branch"}, "not of one kind"),
        ("1 mm", {"stated": "1 +"}, "claims.a.claim: expression '1 +': it ends too early"),
    ],
)
def test_claims_that_cannot_be_read(published, entries, sentence):
    with pytest.raises(CaseError) as error:
        judge(published, **entries)
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    "entries",
    [
        {"published": "1 mm"},
        {"published": "1 mm", "stated": "1 mm", "tolerance": "1 N"},
        {"published": "1 mm", "stated": "1 mm", "tolerance": "-1 mm"},
        {"published": "open", "quantity": "pose.branch", "tolerance": "1 %"},
    ],
)
def test_claims_that_say_too_little_or_too_much(entries):
    with pytest.raises(CaseError, match=r"^claims\.a\.claim"):
        claim(**entries)


@pytest.mark.parametrize("entries", [{"published": "1 furlong_s"}, {"published": "1", "name": "a b"}])
def test_names_and_figures_are_validated(entries):
    with pytest.raises(ValidationError):
        claim(**{"stated": "1", **entries})


# ---- cases and sources


CLAIMS = """
[[claims]]
name = "mobility"
quantity = "pose.mobility"
published = "1"
source = "Someone (2000)"

[[claims]]
name = "torque"
quantity = "abs(statics.weight.drive_torque)"
published = "0.13 N*m"
source = "Someone (2000)"
"""
SOLID = """
[[claims]]
name = "stress"
quantity = "solid.weight.links.AE.von_mises"
published = "11.36 MPa"
source = "Someone (2000)"
"""


@pytest.fixture
def case_file(tmp_path):
    folder = importlib.resources.files("alula.loads.cases")
    for name in ("owl-wing-static.toml", "owl-wing-statics-exact.csv", "owl-wing-statics-printed.csv"):
        (tmp_path / name).write_text(folder.joinpath(name).read_text(encoding="utf-8"), encoding="utf-8")
    return tmp_path / "owl-wing-static.toml"


def test_claims_of_a_case_file(case_file):
    case_file.write_text(case_file.read_text(encoding="utf-8") + CLAIMS, encoding="utf-8")
    assert [result.finding for result in check_claims(str(case_file))] == [Finding.HOLDS, Finding.HOLDS]
    heavier = check_claims(str(case_file), overrides=['load_cases.weight.forces.0.force=["0 N", "-0.5 N"]'])
    assert [result.finding for result in heavier] == [Finding.HOLDS, Finding.DOES_NOT_HOLD]


def test_only_what_a_claim_asks_for_is_computed(case_file, monkeypatch):
    asked = []
    original = alula.fea.claims.data.check_case

    def check(case, *, fidelity, **options):
        asked.append(fidelity)
        return original(case, fidelity="beam", **options)

    monkeypatch.setattr(alula.fea.claims.data, "check_case", check)
    text = case_file.read_text(encoding="utf-8")
    case_file.write_text(text + CLAIMS, encoding="utf-8")
    check_claims(str(case_file))
    assert asked == []
    case_file.write_text(text + CLAIMS + SOLID, encoding="utf-8")
    left_out = check_claims(str(case_file), fidelity="beam")[-1]
    assert asked == []
    assert left_out.finding is Finding.CANNOT_BE_REDERIVED
    assert note_of(left_out) == "This run leaves out the solid model, which runs with --fidelity solid."
    assert check_claims(str(case_file))[-1].finding is Finding.HOLDS
    assert asked == ["solid"]


CHANGED = ['pose.angle="230 deg"']


def test_a_source_and_its_cases():
    whole, part = solved.claims()["owl-wing"], check_claims("owl-wing-static", overrides=CHANGED, fidelity="beam")
    of_the_case = [result.claim.name for result in whole if result.claim.case == "owl-wing-static"]
    assert [result.claim.name for result in part] == of_the_case
    assert 100 < len(part) < len(whole)
    # The override reaches them.
    assert {result.claim.name: result for result in part}["pose.CD-text"].finding is Finding.DOES_NOT_HOLD
    assert {result.claim.name: result for result in whole}["pose.CD-text"].finding is Finding.HOLDS


def test_a_check_that_is_there_is_not_made_again(monkeypatch):
    """The page once solved all frames of its case a second time."""
    whole = {result.claim.name: result for result in solved.claims()["owl-wing"]}
    known = solved.by_hand("owl-wing-static", PLANAR)
    heavier = solved.by_hand("owl-wing-static", PLANAR, 'load_cases.weight.forces.0.force=["0 N", "-0.5 N"]')
    sought = []
    original = alula.fea.check.run.examine
    monkeypatch.setattr(alula.fea.check.run, "examine", lambda *what: sought.append(what) or original(*what))
    found = check_claims("owl-wing-static", fidelity="beam", overrides=[PLANAR], known=known)
    assert sought == []
    by_hand = [result for result in found if result.finding is not Finding.CANNOT_BE_REDERIVED]
    assert len(by_hand) > 80
    assert all(result == whole[result.claim.name] for result in by_hand)
    assert (
        check_claims("owl-wing-static", fidelity="beam", overrides=[PLANAR], known=heavier) == found
    )  # the frames of another case
    assert len(sought) == len(known.load_cases)


def test_unknown_names_are_refused():
    with pytest.raises(CaseError, match="no such file or built-in case"):
        check_claims("nobody")
    with pytest.raises(CaseError, match="is a source document, not a case"):
        check_claims("owl-wing", overrides=["pose.angle=1"])
    with pytest.raises(CaseError, match="fidelity: 'cheap' is unknown"):
        check_claims("owl-wing", fidelity="cheap")
    with pytest.raises(CaseError, match="source 'nobody' is unknown"):
        read_source("nobody")


@pytest.fixture
def found():
    return solved.claims()


def test_every_source_has_its_claims_under_names_of_their_own(found):
    assert tuple(found) == sources()
    assert set(found) == {"owl-wing", "flapping-wing", "flapping-wing-tables", "ornithopter", "four-bar-synthesis"}
    for results in found.values():
        names = [result.claim.name for result in results]
        assert len(set(names)) == len(names)
        assert all(result.claim.source and note_of(result).endswith(".") for result in results)
    # An accusation gives its reason; that of a cell of a table is the number beside it.
    refuted = [r for name in sources() if name != "flapping-wing-tables" for r in found[name] if r.finding.refutes]
    assert not [result.claim.name for result in refuted if not result.claim.note]


def inputs_of(system):
    """What a system is told, in mm and rad."""
    if isinstance(system, FlappingSystem):
        return [system.crank, system.coupler, system.rocker, system.width, system.height], []
    if isinstance(system, OrnithopterSystem):
        rules, motor = system.rules, motors()[system.rules.motor]
        lengths = [rules.throw, rules.pin_diameter, motor.shaft_diameter, motor.shaft_height, motor.diameter]
        return lengths, [rules.wing_angle]
    if isinstance(system, SynthesisSystem):
        return [system.d], [*system.theta, *system.psi]
    case = read_case(system.case)
    pairs = [pair for link in case.links.values() for pair in combinations(link.points.values(), 2)]
    return [math.dist(*pair) for pair in pairs], [case.pose.angle]


def echoes(claim: Claim, ours: str | None, systems) -> bool:
    """Whether our value is the printed figure itself, or an input of a system, turned by right angles or not at all."""
    printed = read_printed(claim.published)
    if printed is None or ours is None:
        return False
    for text in (claim.quantity, claim.stated):
        if re.fullmatch(r"-?[\d.e-]+( [A-Za-z]+(/[A-Za-z]+(\^\d)?)*)?", text) and evaluate(text) == printed.value:
            return True
    if not re.search(r"[a-z_]\.", claim.quantity):
        return False
    value = read_printed(ours).value
    for lengths, angles in map(inputs_of, systems):
        long = value.dimensions == Value.of(1.0, "mm").dimensions
        if long and any(math.isclose(value.to("mm"), told, rel_tol=1e-6) for told in lengths):
            return True
        if value.dimensions == Value.of(1.0, "deg").dimensions:
            turns = [math.remainder(value.to("rad") + s * told, math.pi / 2) for told in angles for s in (1, -1)]
            if any(abs(turn) < 1e-6 for turn in turns):
                return True
    return False


def test_no_claim_repeats_an_input(found):
    for name, results in found.items():
        systems = [s for s in read_source(name).systems.values() if not isinstance(s, TableSystem)]
        assert not [r.claim.name for r in results if r.finding is Finding.HOLDS and echoes(r.claim, r.ours, systems)]


@pytest.mark.parametrize(
    ("entries", "ours"),
    [
        ({"published": "2.5 mm", "stated": "0.0025 m"}, "2.5 mm"),
        ({"published": "0.05 m", "quantity": "hypot(open.pose.points.G.x - open.pose.points.F.x, 0 mm)"}, "0.05 m"),
        ({"published": "48.15 deg", "quantity": "pose.angles.GF - 180 deg"}, "48.15 deg"),
        ({"published": "55.38 deg", "quantity": "180 deg - closed.pose.angles.GF"}, "55.38 deg"),
    ],
)
def test_a_repeated_input_would_be_seen(entries, ours):
    systems = [CaseSystem(type="case", case=f"owl-wing-{pose}") for pose in ("static", "closed")]
    assert echoes(claim(**entries), ours, systems)


def test_every_name_of_a_source_is_used():
    for record in map(read_source, sources()):
        texts = [*record.given.values(), *(f"{c.quantity} {c.stated} {c.means}" for c in record.claims)]
        used = set(re.findall(r"[\w-]+(?:\.[\w-]+)?", " ".join(texts)))
        for kind, names in (("given", record.given), ("not_stated", record.not_stated)):
            assert {f"{kind}.{key}" for key in names} <= used


def test_reports_of_findings():
    results = check_claims("four-bar-synthesis")
    records = json.loads(as_json(results))
    assert list(records[0]) == ["name", "quantity", "published", "ours", "finding", "source", "note"]
    assert {record["finding"] for record in records} == {"holds", "does-not-hold", "does-not-follow"}
    text = text_of([claims_section(results)])
    row = next(line.split() for line in text.splitlines() if "grashof.condition" in line)
    assert " ".join(row).startswith("grashof.condition s + l > p + q s + l <= p + q does not hold")
    page = as_markdown({"four-bar-synthesis": results}, {"four-bar-synthesis": "A source"})
    assert page.count("| does not hold |") == sum(result.finding is Finding.DOES_NOT_HOLD for result in results) + 1
    assert "s + l &lt;= p + q" in page
    assert count(()) == "0 claims: 0 hold, 0 do not hold, 0 do not follow, 0 cannot be re-derived."
