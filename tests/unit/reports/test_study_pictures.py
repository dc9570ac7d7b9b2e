"""Pictures of a study show what its store holds, and what they state beside it (R², fronts, contours) is right."""

import math
import re
from dataclasses import replace
from io import StringIO
from itertools import product
from pathlib import Path

import numpy as np
import programs
import pytest
from edited_cases import PLANAR
from html_pages import Page, stands_alone
from rich.console import Console
from told import ends_of, numbers_of, tables_of, values_of

from alula.fea.common.verdict import Verdict
from alula.fea.study.margin import least_margin, margin, margin_band, nearest
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.fea.study.store import Store
from alula.geometry.base.errors import CaseError
from alula.reports.figures.study import style
from alula.reports.figures.study.curves import curves
from alula.reports.figures.study.many import front, parallel, pareto
from alula.reports.figures.study.maps import verdict_map
from alula.reports.figures.study.points import OUTCOMES, Parameter, Response
from alula.reports.figures.study.spread import histogram, tornado
from alula.reports.figures.study.style import LOOKS
from alula.reports.notebook.study_report import StudyReport
from alula.reports.renderers.console import print_sections
from alula.reports.renderers.record import as_record
from alula.reports.sections.section import Command, parts_of
from alula.reports.study.choice import picture_sections
from alula.reports.study.columns import read_study
from alula.reports.study.page import pictures_of, write_study
from alula.reports.study.regression import regression
from alula.reports.study.rows import results_section, study_rows
from alula.reports.study.sections import ALIKE, points_table, study_sections

CSS = Path(__file__).resolve().parents[3] / "reports" / "templates" / "report.css"


def checked(value, low, high, limit, quantity="safety factor", unit="1"):
    """A checked number with the verdict of its band."""
    at_most = unit == "mm"
    kept, missed = (high <= limit, low > limit) if at_most else (low >= limit, high < limit)
    return VariantNumber(
        check="strength", subject="AE", load_case="flight", quantity=quantity, unit=unit, value=value, low=low,
        high=high, limit=limit, verdict=Verdict.PASS if kept else Verdict.FAIL if missed else Verdict.UNDECIDED,
    )  # fmt: skip


def answer(factor, mass=None):
    """What became of a variant with that safety factor, of which 2 is asked."""
    numbers = [checked(factor, 0.9 * factor, 1.1 * factor, 2.0)]
    if mass is not None:
        numbers.append(VariantNumber.exact("mass", "g", mass, "the linkage"))
    return VariantResult(state="done", verdict=numbers[0].verdict, numbers=tuple(numbers))


def store_of(folder, points, link=(), case="owl-wing-static"):
    """Keep points in a store of their own."""
    plan = {"case": case, "analysis": "check", "fidelity": "beam", "set": {}, "vary": {}, "link": dict(link)}
    with Store.writing(folder) as store:
        store.begin({"plan": plan, "versions": ["0.1.0", "4.13.1"], "points": len(points)}, ())
        for position, (parameters, result) in enumerate(points):
            store.add(position, str(position), parameters, result)
    return folder


def columns_of(folder, points, most=40, **options):
    """Read a study of these points."""
    with Store.reading(store_of(folder, points, **options)) as store:
        return read_study(store, most=most)


def quantity(values, path="parts.bar.thickness"):
    return Parameter(path=path, unit="mm", values=np.array(values, dtype=float))


def response(values, limit=1.0, spread=0.1):
    value = np.array(values, dtype=float)
    return Response(label="n", value=value, low=(1 - spread) * value, high=(1 + spread) * value, limit=limit)


def marks(axes, name):
    """Places of the marks of an outcome."""
    [line] = [line for line in axes.lines if line.get_label() == name]
    return np.column_stack(line.get_data())


def counted(axes):
    """How many values the bars of each outcome hold."""
    names = axes.get_legend_handles_labels()[1]
    return {name: sum(bar.get_height() for bar in bars) for name, bars in zip(names, axes.containers, strict=True)}


@pytest.mark.parametrize(
    ("number", "band"),
    [
        (checked(3.0, 2.4, 4.0, 2.0), (1.5, 1.2, 2.0)),
        (checked(0.5, 0.4, 0.8, 1.0, "displacement", "mm"), (2.0, 1.25, 2.5)),
        (checked(0.7, 0.0, 0.9, 1.0, "share of the load that is held"), (0.7, 0.0, 0.9)),
        (checked(1.0, 0.6, 1.0, 1.0, "share of the load that is held"), (math.inf, 0.6, math.inf)),
        (checked(math.nan, math.nan, math.nan, 2.0), (math.nan, 0.0, math.inf)),
    ],
)
def test_a_margin_is_a_factor_with_a_band(number, band):
    assert margin_band(number) == pytest.approx(band, nan_ok=True)
    assert margin(number) == band[1]


def test_a_load_that_is_held_whole_says_nothing_of_the_margin():
    held, factor = checked(1.0, 1.0, 1.0, 1.0, "share of the load that is held"), checked(9.0, 8.0, 10.0, 2.0)
    found = VariantResult(state="done", verdict=Verdict.PASS, numbers=(held, factor))
    assert nearest(found) is factor
    assert least_margin(found) == (4.5, 4.0, 5.0)


UNKNOWN = checked(math.nan, math.nan, math.nan, 2.0, "buckling factor")


def test_the_least_margin_is_not_known_where_that_of_a_check_is_not():
    """The unknown one may be the least, so that no contour goes through its point."""
    found = VariantResult(state="done", verdict=Verdict.UNDECIDED, numbers=(checked(9.0, 8.0, 10.0, 2.0), UNKNOWN))
    assert least_margin(found) == pytest.approx((math.nan, 0.0, 5.0), nan_ok=True)


def test_points_that_are_open_alike_have_no_best_and_no_worst(tmp_path):
    alike = VariantResult(state="done", verdict=Verdict.UNDECIDED, numbers=(UNKNOWN,))
    points = [({"a": f"{i} mm", "b": f"{j} mm"}, alike) for i in (1, 2) for j in (1, 2)]
    assert columns_of(tmp_path / "alike", points).extremes == {}
    page = write_study(tmp_path / "alike", tmp_path / "out").read_text(encoding="utf-8")
    assert ALIKE in page
    assert "The report of the best point" not in page
    assert "not known" in page
    assert "contours" not in page
    assert "Distribution of the least margin" not in page
    [one, other] = [columns_of(tmp_path / name, points[:1] + more).extremes for name, more in
                    (("one", []), ("other", [({"a": "3 mm", "b": "1 mm"}, answer(3.0))]))]  # fmt: skip
    assert one == {}
    assert (other["best"].position, other["worst"].position) == (1, 0)


def test_a_point_that_passes_is_better_than_one_with_more_margin_that_nobody_can_decide(tmp_path):
    """Hand calculation beyond its calibration may have a band far above the limit without deciding anything."""
    open_end = VariantResult(state="done", verdict=Verdict.UNDECIDED, numbers=(checked(9.0, 8.0, 10.0, 2.0),))
    study = columns_of(tmp_path, [({"a": "1 mm"}, answer(3.0)), ({"a": "2 mm"}, open_end), ({"a": "3 mm"}, answer(1))])
    assert (study.extremes["best"].position, study.extremes["worst"].position) == (0, 2)


def test_a_study_is_read_into_columns(tmp_path):
    """Values of one kind in one unit, words apart, linked entries left out; what was refused has no numbers."""
    refused = VariantResult(state="refused", sentence="parts.a.width: it must be positive")
    points = [
        ({"width": "5 mm", "kind": "tube", "pin": "3 mm", "same": 1}, answer(3.0, 10.0)),
        ({"width": "0.6 cm", "kind": "bar", "pin": "4 mm", "same": 1}, answer(1.0, 12.0)),
        ({"width": "7 mm", "kind": "bar", "pin": "5 mm", "same": 1}, refused),
    ]
    study = columns_of(tmp_path, points, link={"pin": "width - 2 mm"})
    assert [(one.path, one.unit, one.words) for one in study.parameters] == [
        ("width", "mm", ()), ("kind", "", ("tube", "bar")),
    ]  # fmt: skip
    assert study.parameters[0].values == pytest.approx([5.0, 6.0, 7.0])
    assert study.margin.value == pytest.approx([1.5, 0.5, math.nan], nan_ok=True)
    assert study.margin.low == pytest.approx([1.35, 0.45, math.nan], nan_ok=True)
    assert study.mass == pytest.approx([10.0, 12.0, math.nan], nan_ok=True)
    assert list(study.outcome) == ["pass", "fail", "refused"]
    assert (study.extremes["best"].position, study.extremes["worst"].position) == (0, 1)
    assert study.sentences == {("refused", refused.sentence): [2]}


GRID = {"a": ["1 mm", "2 mm", "3 mm"], "b": ["1 mm", "2 mm", "3 mm"], "c": ["1 mm", "2 mm"], "k": ["x", "y"]}


@pytest.mark.parametrize(
    ("varied", "expected"),
    [
        ("a", "curve"),
        ("ak", "curve"),
        ("ab", "map"),
        ("abk", "map"),
        ("k", "values"),
        ("abc", "sensitivity parallel"),
    ],
)
def test_what_varies_chooses_the_pictures(varied, expected, tmp_path):
    points = []
    for values in product(*(GRID[name] for name in varied)):
        size = math.prod(float(value[0]) if value[0].isdigit() else ord(value) / 100 for value in values)
        points.append((dict(zip(varied, values, strict=True)), answer(size, 3.0 * size)))
    study = columns_of(tmp_path, points)
    assert [one.key for one in picture_sections(study)] == [*expected.split(), "margins", "pareto"]
    assert "pareto" not in [one.key for one in picture_sections(replace(study, mass=None))]


def test_a_curve_shows_values_verdicts_and_limit():
    """Marks of each outcome where its points are; refused ones at the lower edge; the scale holds the limit."""
    outcome = np.array(["fail", "undecided", "pass", "refused"])
    figure = curves(quantity([2, 3, 4, 5]), response([0.5, 1.0, 2.0, math.nan]), outcome, [("", np.ones(4, bool))])
    [axes] = figure.axes
    assert marks(axes, "fail").tolist() == [[2.0, 0.5]]
    assert marks(axes, "undecided").tolist() == [[3.0, 1.0]]
    assert marks(axes, "refused")[0, 0] == 5.0
    assert any(np.allclose(line.get_ydata(), 1.0) and len(line.get_xdata()) == 2 for line in axes.lines)
    assert axes.get_ylim()[0] < 0.45
    assert axes.get_xlabel() == "parts.bar.thickness [mm]"
    band = np.vstack([path.vertices for area in axes.collections for path in area.get_paths()])
    assert band[:, 1].min() == pytest.approx(0.45)
    assert band[:, 1].max() == pytest.approx(2.2)


@pytest.mark.parametrize("scattered", [False, True])
def test_contours_of_a_map_lie_where_the_number_is(scattered):
    """A number whose logarithm is linear is interpolated exactly, on a grid as between scattered points."""
    x, y = (values.ravel() for values in np.meshgrid(np.linspace(2.0, 8.0, 7), np.linspace(1.0, 4.0, 5)))
    if scattered:
        random = np.random.default_rng(1)
        x, y = x + random.uniform(-0.3, 0.3, x.size), y + random.uniform(-0.3, 0.3, y.size)
    number = response(np.exp(0.4 * (x - 5.0) - 0.7 * (y - 2.5)))
    outcome = np.where(number.value >= 1.0, "pass", "fail")
    figure = verdict_map((quantity(x), quantity(y, "b")), number, outcome, [("", np.ones(x.size, bool))])
    [axes] = figure.axes
    [contours] = [one for one in axes.collections if hasattr(one, "levels")]
    assert 0.0 in contours.levels  # the logarithm of the limit
    for level, path in zip(contours.levels, contours.get_paths(), strict=True):
        at = path.vertices
        assert 0.4 * (at[:, 0] - 5.0) - 0.7 * (at[:, 1] - 2.5) == pytest.approx(np.full(len(at), level), abs=1e-9)
    assert len(marks(axes, "pass")) + len(marks(axes, "fail")) == x.size
    assert bool(axes.patches) != scattered  # cells of a grid alone


def test_no_contour_crosses_a_point_without_value():
    x, y = (values.ravel() for values in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    value = np.where(x == 2.0, np.nan, 1.0 + y)
    figure = verdict_map(
        (quantity(x), quantity(y, "b")), response(value), np.where(x == 2.0, "refused", "pass"), [("", x > -1.0)]
    )
    [contours] = [one for one in figure.axes[0].collections if hasattr(one, "levels")]
    at = np.vstack([path.vertices for path in contours.get_paths()])
    assert not np.any((at[:, 0] > 1.0) & (at[:, 0] < 3.0))


def test_a_histogram_counts_every_value_once_and_divides_at_the_limit():
    random = np.random.default_rng(3)
    values = np.append(np.exp(random.normal(0.5, 1.0, 400)), np.inf)
    outcome = np.where(values >= 1.2, "pass", np.where(values < 0.8, "fail", "undecided"))
    axes = histogram(values, 1.0, label="n", outcome=outcome).axes[0]
    assert counted(axes) == {name: np.sum(outcome[:-1] == name) for name in ("pass", "undecided", "fail")}
    edges = np.array([bar.get_x() for bar in axes.containers[0]])
    assert np.abs(np.log(edges)).min() == pytest.approx(0.0, abs=1e-9)
    assert "1 points without" in axes.get_title(loc="right")


def test_a_histogram_of_plain_values_tells_those_beyond_their_limit():
    axes = histogram(np.linspace(0.0, 10.0, 101), 4.05, label="sag [mm]", at_least=False, counted="samples").axes[0]
    assert counted(axes) == {"pass": 41, "fail": 60}
    histogram([2.0, 2.0], label="n")
    histogram([math.nan], 3.0, label="n")


def test_sensitivities_of_a_linear_model_are_its_coefficients():
    """Of ln n = 2 a - 3 b + (1 for steel): coefficient times deviation of the entry, over that of the number."""
    a, b, k = (np.array(values, dtype=float) for values in zip(*product(range(4), range(3), range(2)), strict=True))
    parameters = (quantity(a, "a"), quantity(b, "b"), Parameter(path="k", unit="", values=k, words=("pvc", "steel")))
    found = regression(parameters, response(np.exp(2.0 * a - 3.0 * b + k)))
    parts = np.array([2.0 * math.sqrt(15 / 12), -3.0 * math.sqrt(8 / 12), 0.5])  # of 0 to 3, 0 to 2, 0 and 1
    assert found.coefficients == pytest.approx(parts / np.linalg.norm(parts))
    assert found.r_squared == pytest.approx(1.0)
    assert (found.unsigned, found.points) == ((False, False, True), 24)
    axes = tornado(found.names, found.coefficients, label="", unsigned=found.unsigned).axes[0]
    assert [text.get_text() for text in axes.get_yticklabels()] == ["b", "a", "k"]
    assert [bar.get_width() for bar in axes.patches] == pytest.approx(sorted(found.coefficients, key=abs, reverse=True))


def test_r_squared_tells_that_a_model_is_not_linear():
    a = np.linspace(-1.0, 1.0, 21)
    found = regression((quantity(a, "a"),), response(a**2))
    assert found.r_squared == pytest.approx(0.0, abs=1e-12)
    assert "too few" in regression((quantity(a[:3], "a"),), response(a[:3] + 2.0))
    assert "together" in regression((quantity(a, "a"), quantity(2.0 * a, "b")), response(a + 2.0))


def test_indices_of_first_and_total_order_stand_beside_each_other():
    axes = tornado(["pin", "load"], [0.1, 0.5], [0.3, 0.6], label="Sobol' index").axes[0]
    assert [bar.get_width() for bar in axes.patches] == [0.5, 0.1, 0.6, 0.3]


def test_the_front_is_what_no_other_point_beats():
    """Point 1 is heavier than 0 without gain, 3 is beaten by 2, 4 fails, 5 is not known."""
    mass, gain = np.array([1.0, 2.0, 3.0, 3.0, 4.0, 5.0, 6.0]), np.array([1.0, 1.0, 4.0, 2.0, 9.0, np.nan, 5.0])
    assert front(mass, gain, np.arange(7) != 4).tolist() == [0, 2, 6]


def test_parallel_coordinates_hold_every_point_and_end_where_nothing_is_known():
    values = response([0.5, 2.0, math.nan])
    outcome = np.array(["fail", "pass", "refused"])
    axes = parallel((quantity([1, 2, 3], "a"), quantity([4, 6, 5], "b")), (values,), outcome).axes[0]
    lines = [line for lines in axes.collections for line in lines.get_segments()]
    assert sorted(len(line) for line in lines) == [2, 3, 3]
    assert any(np.allclose(line[:, 1], [0.5, 1.0, 1.0]) for line in lines if len(line) == 3)


def test_colours_of_verdicts_are_those_of_the_report():
    stated = dict(re.findall(r"--(pass|fail|undecided): (#\w+)", CSS.read_text(encoding="utf-8")))
    assert {name: LOOKS[name].colour for name in stated} == stated
    assert tuple(LOOKS) == OUTCOMES
    assert len({look.mark for look in LOOKS.values()}) == len(LOOKS) - 1  # "done" never stands beside "pass"


def test_the_page_stands_alone_and_leaves_the_study_as_it_is(tmp_path):
    """It also stands a text of the case that is no HTML."""
    hostile = "<script>alert(1)</script>"
    refused = VariantResult(state="refused", sentence=hostile)
    points = [({"width": f"{i + 2} mm", hostile: i % 2}, answer(0.7 * i + 0.5, 10.0 + i)) for i in range(6)]
    folder = store_of(tmp_path / "study", [*points, ({"width": "9 mm", hostile: 1}, refused)], case="x/four-bar.toml")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    page = write_study(folder, tmp_path / "out")
    text = page.read_text(encoding="utf-8")
    stands_alone(Page(text))
    words = Page(text).words
    assert "7 points: 3 pass, 1 undecided, 2 fail and 1 refused." in words
    assert "Best, point 5: pass, safety factor of AE 4.00" in words
    assert "Refused, point 6: <script>alert(1)</script>" in words
    assert "<script" not in text
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    names = {path.stem for path in (page.parent / "pictures").iterdir()}
    assert names == {"map", "margins", "pareto"}
    assert text.count("data:image/png;base64,") == len(names)
    assert len(text) < 400_000


def test_the_page_of_many_points_is_bounded_and_says_how(tmp_path, monkeypatch):
    """The table holds the ends and the undecided; a map some marks of every panel, the front all of its own."""
    factors = [1.0 + 0.01 * ((37 * i) % 200) for i in range(200)]  # 1 to 2.99, each once, in no order
    points = [({"a.x": f"{i % 20} mm", "a.y": f"{i // 20} mm"}, answer(f, mass=f)) for i, f in enumerate(factors)]
    monkeypatch.setattr("alula.reports.study.choice.MOST_MARKS", 50)
    monkeypatch.setattr("alula.reports.figures.study.many.MOST_MARKS", 50)
    study = columns_of(tmp_path / "s", points)
    assert study.rows[0].position == factors.index(2.99)
    assert study.rows[-1].position == factors.index(1.0)
    undecided = [i for i, f in enumerate(factors) if 0.9 * f < 2.0 <= 1.1 * f]
    shown = [row.position for row in study.rows if row.answer.verdict is Verdict.UNDECIDED]
    assert shown == undecided[: len(shown)]
    assert len(study.rows) == 3 * len(shown) <= 40
    drawn = {picture.name: picture for picture in pictures_of(list(picture_sections(study)))}
    for name, extra in (("map", 0), ("pareto", 120)):
        assert "of the 200 points" in drawn[name].caption
        lines = drawn[name].draw().figure.axes[0].lines
        count = sum(len(line.get_xdata()) for line in lines if line.get_label() in LOOKS)
        assert 50 <= count <= 50 + extra
    page = write_study(tmp_path / "s", tmp_path / "out").read_text(encoding="utf-8")
    assert "the first undecided ones, and the worst" in page
    few = columns_of(tmp_path / "few", points[:40])
    assert [row.position for row in few.rows] == list(range(40))
    assert not any("points are drawn" in picture.caption for picture in pictures_of(list(picture_sections(few))))


def test_a_legend_is_as_wide_as_its_picture_at_most():
    """Five entries with large counts once ran over both edges."""
    x = np.tile(np.arange(200.0), 200)
    outcome = np.array(["pass", "undecided", "fail", "refused"] * 10_000)
    least = Response(label="least margin (1 at the limit)", value=x + 1.0, low=x + 1.0, high=x + 1.0)
    figure = pareto(x, least, outcome, np.arange(len(x)))
    style.legend(figure, outcome, [(style.limit_handle(), least.label), (style.limit_handle(), "limit")])
    figure.draw_without_rendering()
    for legend in figure.legends:
        assert 0.0 <= legend.get_window_extent().x0 < legend.get_window_extent().x1 <= figure.bbox.width


def test_the_best_and_the_worst_are_those_of_all_points_sorted(tmp_path):
    """Against a sort of all; of equal points, the first."""
    factors = [round(float(factor), 1) for factor in np.random.default_rng(3).uniform(1.0, 4.0, 300)]
    study = columns_of(tmp_path, [({"a": f"{i} mm"}, answer(factor)) for i, factor in enumerate(factors)], most=21)
    with Store.reading(tmp_path) as store:
        every = list(study_rows(store))
    best = sorted(every, key=lambda row: (-row.merit[0], -row.merit[1]))[:7]
    worst = sorted(every, key=lambda row: row.merit)[:7]
    shown = [row.position for row in study.rows]
    assert shown[:7] == [row.position for row in best]
    assert shown[-7:] == [row.position for row in worst][::-1]
    assert (study.extremes["best"].position, study.extremes["worst"].position) == (best[0].position, worst[0].position)


def test_console_page_notebook_and_store_tell_the_same_of_a_study(tmp_path):
    """Every number of the sections stands on console and page as it is written, and in the tables with its value."""
    refused = VariantResult(state="refused", sentence="it must be positive")
    points = [
        ({"a": f"{i} mm", "b": f"{j} mm", "c": f"{k} mm", "pin": f"{i + 1} mm"}, answer(i**2 * j / k, 3.0 * i + j))
        for i, j, k in product((1, 2, 3), (1, 2), (1, 2, 3))
    ]
    folder = store_of(tmp_path / "study", [*points, (points[0][0], refused)], link={"pin": "a + 1 mm"})
    with Store.reading(folder) as store:
        study, rows, record = read_study(store), list(study_rows(store)), as_record([results_section(store)])
    sections = study_sections(study)
    with Console(file=StringIO(), width=300, color_system=None) as console:
        print_sections(sections, console)
    printed = " ".join(console.file.getvalue().split())
    page = Page(write_study(folder, tmp_path / "out").read_text(encoding="utf-8")).words
    parts = [part for section in sections for part in parts_of(section.parts)]
    for text in (*map(str, numbers_of(parts)), "Refused, point 18: it must be positive", "= a + 1 mm"):
        assert " ".join(text.split()) in printed, text
        assert " ".join(text.split()) in " ".join(page.split()), text
    known = set(values_of(record))
    assert all(known.issuperset(ends_of(number)) for number in numbers_of(parts) if not number.derived)
    tables = tables_of(sections)
    assert set(tables) == {"entries", "sensitivity", "limits", "points"}
    assert [row["how many"] for row in tables["entries"]] == [3.0, 2.0, 3.0, None]
    assert tables["limits"] == [{"check": "safety factor of AE", "points": 18.0}]
    for row, told in zip(rows[:-1], tables["points"], strict=False):
        found = row.answer.numbers[0]
        assert (told["point"], told["verdict"], told["a"]) == (row.position, row.outcome, row.parameters["a"])
        assert (told["value"], told["value low"], told["value high"]) == (found.value, found.low, found.high)
        assert (told["margin"], told["limit"], told["mass [g]"]) == (row.margin, 2.0, row.mass)
    assert [row["standardised coefficient"] for row in tables["sensitivity"]] == pytest.approx(
        sorted(regression(study.parameters, study.margin).coefficients, key=abs, reverse=True)
    )
    [command] = [part.command for part in parts if isinstance(part, Command)]
    assert "--set 'a=3 mm' --set 'b=2 mm' --set 'c=1 mm'" in command
    asked = points_table(rows, ["mass of the linkage [g]"]).records
    assert [row["mass of the linkage [g]"] for row in asked] == [row.mass for row in rows]
    report = StudyReport(folder, {})
    assert (len(report.table()), report.table("limits").rows[0]["points"]) == (19, 18.0)
    assert [row["margin"] for row in report.table()][-1] is None
    with pytest.warns(DeprecationWarning, match="nearest to its limit"):
        assert report.table()[0]["nearest"] == "safety factor of AE"
    assert {row["mass [g]"] for row in points_table(rows[-1:]).records} == {None}


def test_a_study_without_a_result_yet_is_told_so(tmp_path):
    folder = tmp_path / "empty"
    with Store.writing(folder) as store:
        plan = {"case": "x", "analysis": "check", "fidelity": "beam", "set": {}, "vary": {}, "link": {}}
        store.begin({"plan": plan, "versions": ["0.1.0", "4.13.1"], "points": 7}, ())
    shown = programs.inside("study", "show", "empty", folder=tmp_path)
    assert (shown.returncode, "0 of 7 points: none yet." in shown.stdout) == (0, True), shown.stderr


def test_mistakes_are_one_sentence(tmp_path):
    """A study without points, a number that there is not, the folder of the study itself."""
    empty = store_of(tmp_path / "empty", [])
    with pytest.raises(CaseError, match="no point of it has a result yet"):
        write_study(empty, tmp_path / "out")
    full = store_of(tmp_path / "full", [({"a": "1 mm"}, answer(1.0)), ({"a": "2 mm"}, answer(2.0))])
    with pytest.raises(CaseError, match=r"'phase lag'.*there are: safety factor"):
        write_study(full, tmp_path / "out", ["phase lag"])
    with pytest.raises(CaseError, match="stays as it is"):
        write_study(full, full)
    assert not (tmp_path / "out").exists()


def test_the_command_draws_a_study_of_motions(tmp_path):
    """Without checks the first numbers that vary are drawn, or those that are asked for."""
    arguments = ("study", "four-bar-synthesis", "--analysis", "motion", "--threads", "1", "--set", "motion.poses=31",
                 "--set", PLANAR, "--vary", "links.a.points.A.0=1.6 m..1.7 m/4", "-o", "out", "--pictures")  # fmt: skip
    refused = programs.inside(*arguments, "out", folder=tmp_path)
    assert (refused.returncode, list(tmp_path.iterdir())) == (2, []), refused.stderr
    done = programs.inside(*arguments, "drawn", folder=tmp_path)
    assert "Pictures: drawn/study/study.html" in done.stdout, done.stderr
    names = {path.stem for path in (tmp_path / "drawn/study/pictures").iterdir()}
    assert names == {"curve", "curve-2", "curve-3", "histogram", "histogram-2", "histogram-3"}
    shown = programs.inside("study", "show", "out", "-o", "drawn", "--number", "swing of b", folder=tmp_path)
    assert shown.returncode == 0, shown.stderr
    assert sorted(path.name for path in (tmp_path / "drawn/study/pictures").iterdir()) == ["curve.png", "histogram.png"]
