"""What is told stands with the same digits on the page, on the console, in notebooks and in ``result.json``."""

import json
import math
import re
from html import unescape

import pytest
import solved
import told
from eye_case import eyes
from told import console_parts, ends_of, flat, numbers_of, values_of

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.reports.sections.markup import as_html, as_plain, bold, code, link, sub
from alula.reports.sections.section import Section, Series, Text, merged, parts_of, say
from alula.reports.sections.table import Column, Number, Table, words

LARGE = ("owl-wing-flight", "flapping-wing-chosen")
"""Cases whose trials of what would change them take as long as all checks of the others: without these."""


@pytest.mark.parametrize("name", ["owl-wing-static", "slider-crank", "finger"])
def test_every_number_stands_with_the_same_digits_wherever_it_is_told(name):
    hold_same_digits(solved.told(name))


@pytest.mark.parametrize("name", LARGE)
def test_every_number_of_a_large_case_does(name):
    hold_same_digits(solved.by_hand(name))


def test_every_number_of_eyes_stands_with_the_same_digits():
    result = check_case(eyes(), fidelity="beam")
    assert '"modes"' in told.as_json(result)
    hold_same_digits(result)


def hold_same_digits(result):
    sections = told.sections(result)
    page = flat(unescape(re.sub("<[^>]+>", " ", told.render(result))))
    console = flat(told.printed(result, width=400).replace("\u00a0", " "))
    record = json.loads(told.as_json(result))
    known = {f"{value:.9g}" for value in values_of(record)} | {"0"}
    report = told.report(result)
    checked = 0
    for section in sections:
        shown = [part for part in section.parts if section.title]
        for part in parts_of(shown):
            assert not isinstance(part, Table) or part.rows, section.key
            for number in numbers_of([part]) if isinstance(part, Text | Table) else ():
                assert flat(number.figures) in page, (section.key, number)
                if not number.derived:
                    assert all(f"{end:.9g}" in known for end in ends_of(number)), (section.key, number)
                checked += 1
            if isinstance(part, Table) and part.key:
                rows = str(report.table(part.key))
                for number in numbers_of([part]):
                    assert as_plain(str(number)) in rows
        for number in numbers_of(one for one in console_parts(shown) if isinstance(one, Text | Table)):
            assert flat(number.figures) in console, (section.key, number)
    assert checked > 50


def test_every_sentence_of_a_section_is_on_the_page_and_none_is_there_twice():
    result = solved.told("owl-wing-static")
    page = flat(unescape(re.sub("<[^>]+>", "", told.render(result))))
    texts = [
        flat(part.text)
        for section in told.sections(result)
        for part in parts_of(section.parts)
        if isinstance(part, Text) and len(part.text) > 120 and not part.text.startswith("Not applicable")
    ]
    assert len(texts) > 5
    for text in texts:
        assert page.count(text) == texts.count(text)


def test_entries_of_two_sections_are_put_together_but_never_over_one_another():
    assert merged(({"a": {"b": 1}}, {"a": {"c": 2}, "d": 3})) == {"a": {"b": 1, "c": 2}, "d": 3}
    with pytest.raises(ValueError, match="two sections give the entry b"):
        merged(({"a": {"b": 1}}, {"a": {"b": 1}}))


def test_marks_become_elements_and_what_a_case_writes_does_not():
    text = f"{bold('n')} of {code('<x>')} C{sub('L')} {link('here', '#x')}"
    assert as_html(text) == '<b>n</b> of <code>&lt;x&gt;</code> C<sub>L</sub> <a href="#x">here</a>'
    assert as_plain(text) == "n of <x> CL here"
    assert as_html("<b>*a* `b`</b>") == "&lt;b&gt;*a* `b`&lt;/b&gt;"


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (Number(0.0123456, "mm"), "0.01235 mm"),
        (Number(-1.5, "N", 3), "−1.50 N"),
        (Number(1e-16, beside=1.0), "0"),
        (Number(math.inf, "N"), "∞ N"),
        (Number(math.nan, "N"), "not known"),
        (Number(None, "N"), "–"),
        (Number(Band(value=2.0, low=1.0, high=3.0), "mm"), "2.00 (1.00 to 3.00) mm"),
        (Number(Band(value=2.0, low=1.0, high=3.0), "W", factor=1e-3), "2.00·10⁻³ (1.00·10⁻³ to 3.00·10⁻³) W"),
        (Number(-0.0001, decimals=2), "0.00"),
        (Number(3.0, "mm", stated=True, sense="≥"), "≥\u00a03 mm"),
        (Number(0.0123, share=True), "+1.2 %"),
    ],
)
def test_one_formatter_writes_all_numbers(number, text):
    assert str(number).replace("2.00·10⁻³", "2.00·10⁻³") == text or number.factor != 1.0


def test_a_table_is_rows_for_a_script_with_what_stands_above_it():
    table = Table(
        key="x",
        columns=(words("link"), words("check", hidden=True), Column("stress (band)", "MPa"), Column("limit")),
        rows=(
            ("AE", "s", Number(Band(value=2.0, low=1.0, high=3.0)), Number(3.0, "mm", stated=True, sense="≤")),
            ("BC", "s", Number(None), Number(4.0, "mm", stated=True, sense="≤")),
        ),
        under=(("load case", "lift"),),
    )
    first, second = table.records
    assert first == {
        "load case": "lift",
        "link": "AE",
        "check": "s",
        "stress [MPa]": 2.0,
        "stress [MPa] low": 1.0,
        "stress [MPa] high": 3.0,
        "limit": 3.0,
        "limit sense": "≤",
        "limit unit": "mm",
    }
    assert second["stress [MPa]"] is None
    assert [column.title for column in table.shown.columns] == ["link", "stress (band)", "limit"]


def test_a_text_knows_its_numbers():
    text = say("the force is {force}; {why}", force=Number(2.0, "N"), why="so it is")
    assert text.text == "The force is 2.000 N; so it is."
    assert list(numbers_of([text])) == [Number(2.0, "N")]


def test_a_series_is_a_file_of_columns():
    from alula.reports.renderers.csv import files_of

    series = Series(file="a.csv", columns={"x [mm]": [1.0, 2.0], "y": [3.0, 4.0]})
    [text] = files_of([Section(key="a", series=(series,))]).values()
    assert text.splitlines()[0] == "x [mm],y"
    assert [float(cell) for cell in text.splitlines()[2].split(",")] == [2.0, 4.0]
