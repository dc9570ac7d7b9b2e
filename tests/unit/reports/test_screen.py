"""What decides a check stands on one screen: 25 lines of 80 columns, with its progress and the name of the report."""

import io
from dataclasses import replace

import pytest
from rich.console import Console
from solved import by_hand, told
from told import print_result, print_screen

from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict, deciding, worst_of_each
from alula.reports.check.screen import MATTER, SCREEN
from alula.reports.sentences.verdicts import brief, checks_of, decision

CASES = ("owl-wing-static", "ornithopter", "slider-crank", "four-bar", "spring-pedal")


def printed(show, result, *, terminal=True, width=80):
    console = Console(width=width, file=io.StringIO(), force_terminal=terminal, color_system=None)
    show(result, console)
    return console.file.getvalue().splitlines()


@pytest.mark.parametrize("terminal", [True, False])
@pytest.mark.parametrize("name", CASES)
def test_it_has_one_screen_whatever_the_case(name, terminal):
    result = told(name)
    lines = printed(print_screen, result, terminal=terminal)
    assert len(lines) <= SCREEN
    assert lines[0].startswith(f" {result.verdict.upper()} ")
    why = decision(result.verdict, checks_of(result), several=len(result.load_cases) > 1)
    assert why.split(".")[0].split(":")[0] in " ".join(lines)
    assert [line.split(":")[0] for line in lines if line.startswith(("Stays ", "Does not "))] == [
        "Stays elastic",
        "Does not break",
    ]
    if name in ("slider-crank", "spring-pedal"):  # starters of ductile links ask for both
        assert "plastic-collapse factor" in next(line for line in lines if line.startswith("Does not break"))
    first = deciding(checks_of(result))[0]
    rule = next(i for i, line in enumerate(lines) if line.startswith("──"))
    assert first.quantity.split()[0] in lines[rule + 1]
    assert first.link in lines[rule + 1]
    assert lines[-1].endswith("ll numbers: --verbose")
    warned = [line for line in lines if line.startswith("Warning: ")]
    left = len(result.warnings) - len(warned)
    assert len(warned) <= MATTER
    assert (f"{left} more warning" in lines[-1]) == (left > 0)


def test_a_check_under_several_load_cases_stands_once_with_the_worst():
    """Of either order of the load cases."""
    result = by_hand("ornithopter")
    for cases in (result.load_cases, dict(reversed(result.load_cases.items()))):
        shown = replace(result, load_cases=cases, warnings=())
        every = [check for check in checks_of(shown) if check.applies]
        worst = min(
            (check for check in every if (check.quantity, check.link) == ("safety factor", "lever-right")),
            key=lambda check: (check.verdict is not Verdict.FAIL, check.margin),
        )
        rows = [line for line in printed(print_screen, shown, terminal=False) if line.startswith("safety factor ")]
        assert len({row.split()[2] for row in rows}) == len(rows)
        [row] = [row for row in rows if " lever-right " in row]
        assert worst.load_case in row
        assert f"{worst.value.value:.3g}" in row


def test_checks_of_two_names_and_links_stand_for_themselves_and_what_does_not_apply_for_none():
    def outcome(name, link, load_case, value):
        band = Band(value=value, low=0.9 * value, high=1.1 * value)
        return CheckOutcome.of(name, Subject.link(link), load_case, Quantity.SAFETY_FACTOR, band, 1.0)

    light, heavy = (outcome("own", "a", load_case, value) for load_case, value in (("light", 9.0), ("heavy", 2.0)))
    other, second = outcome("other", "a", "light", 5.0), outcome("own", "b", "light", 4.0)
    gone = outcome("own", "c", "light", 0.5).not_applicable("gone")
    for order in ([light, heavy, other, second, gone], [gone, second, other, heavy, light]):
        assert worst_of_each(order) == [heavy, second, other]


def test_under_the_worst_load_case_least_is_known_of_a_number():
    """Though how near to its limit that is nobody knows, so that it decides less than one that is known."""

    def outcome(load_case, band):
        return CheckOutcome.of("own", Subject.link("a"), load_case, Quantity.PLASTIC_COLLAPSE, band, 1.0)

    known = [
        outcome("first", Band(value=9.0, low=8.0, high=9.0)),
        outcome("second", Band(value=9.0, low=5.0, high=9.0)),
    ]
    for least, worst in ((2.0, "third"), (6.0, "second")):
        every = [known[0], outcome("third", Band.at_least(least)), known[1]]
        for order in (every, every[::-1]):
            assert [one.load_case for one in worst_of_each(order)] == [worst]
            assert deciding(order)[0].load_case == "second"


def test_many_names_are_counted_alone(monkeypatch):
    result = by_hand("ornithopter")
    named = decision(result.verdict, checks_of(result), several=True)
    for most, text in ((len(named), named), (len(named) - 1, "Undecided: 15 of 44 checks are open. ")):
        monkeypatch.setattr("alula.reports.sentences.verdicts.BRIEF", most)
        assert brief(result.verdict, checks_of(result), several=True).startswith(text)
    assert printed(print_screen, result)[-1] == "39 more checks and all numbers: --verbose"


def test_long_texts_lose_their_ends_and_never_the_verdict():
    long = "word " * 400
    result = by_hand("four-bar")
    case = result.case.model_copy(update={"title": f"Title {long}"})
    shown = replace(result, case=case, warnings=(f"first {long}", f"second {long}", "third", *("more",) * 9))
    lines = printed(print_screen, shown)
    assert len(lines) <= SCREEN
    assert lines[0].endswith("...")
    assert len(lines[0]) <= 80
    assert sum(line.startswith("Warning: ") for line in lines) >= 1
    assert "more warnings and all numbers: --verbose" in lines[-1]
    short = by_hand("four-bar")
    assert len(printed(print_result, short)) > SCREEN
    assert len(printed(print_screen, short, width=40)) < len(printed(print_result, short, width=40))
