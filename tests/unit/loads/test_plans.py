"""What a study varies: ranges, lists, samples, tables of points, derived entries."""

from pathlib import Path

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.plans.axis import axis
from alula.loads.plans.derived import derived_value
from alula.loads.plans.plan import plan_of, read_plan, table_of
from alula.loads.plans.points import Points
from alula.loads.plans.variants import Variants

CASE = "owl-wing-static"
DIAMETER = "parts.tube.outer_diameter"


@pytest.mark.parametrize(
    ("stated", "values"),
    [
        ("2 mm..8 mm/4", ("2 mm", "4 mm", "6 mm", "8 mm")),
        ("2..8 mm by 3 mm", ("2 mm", "5 mm", "8 mm")),
        ("2 mm..1 cm by 4 mm", ("2 mm", "6 mm", "10 mm")),
        ("0.1 mm..0.3 mm/3", ("0.1 mm", "0.2 mm", "0.3 mm")),
        ("-1..1/3", (-1.0, 0.0, 1.0)),
        ("0.8..1.2 body_weight by 0.2 body_weight", ("0.8 body_weight", "1 body_weight", "1.2 body_weight")),
        ("0.1 body_weight*m..300 body_weight*mm/2", ("0.1 body_weight*m", "0.3 body_weight*m")),
        ("eye-faces, bore-shear", ("eye-faces", "bore-shear")),
        ("1, 2.5, true", (1, 2.5, True)),
        (["2 mm", 3], ("2 mm", 3)),
        ("1 N/mm..3 N/mm/3", ("1 N/mm", "2 N/mm", "3 N/mm")),
        ("5 rad/s .. 6 rad/s / 2", ("5 rad/s", "6 rad/s")),
        ("1 g/cm^3..2 g/cm^3 by 0.5 g/cm^3", ("1 g/cm^3", "1.5 g/cm^3", "2 g/cm^3")),
        ("1 N*mm/rad..2 N*mm/rad", ()),
    ],
)
def test_values_of_an_entry(stated, values):
    """Ranges hold both ends and equal steps, in the unit of the first end; lists are taken as they stand."""
    assert axis("p", stated).values == values


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        ("8 mm..2 mm/4", "larger than its first"),
        ("2 mm..2 mm/4", "larger than its first"),
        ("2 mm..8 N/4", "differ in kind"),
        ("500 N..1 body_weight/4", "'body_weight' and 'N' differ in kind"),
        ("1 body_weight..2 body_weight*m/4", "differ in kind"),
        ("1 my_weight..2 my_weight/4", "no number with a unit"),
        ("2 mm..8 mm by 5 mm", "whole steps"),
        ("2 mm..8 mm by 0 mm", "the step must be greater than zero; make it larger"),
        ("2 mm..8 mm by -1 mm", "the step must be greater than zero; make it larger"),
        ("2 mm..8 mm by 1 cm", "the step is longer than the range; make it smaller"),
        ("2 mm..8 mm by 1e-9 mm", "more than 1000000 values; make the step larger"),
        ("2 mm..8 mm/1", "from 2 to"),
        ("2 mm..8 mm/x", "from 2 to"),
        ("2 mm..8 mm/", "from 2 to"),
        ("a..b/3", "no number with a unit"),
        ("1e999 mm..2 mm/3", "no number with a unit"),
        ("2 mm,,3 mm", "missing"),
        ("2 mm, 2 mm", "twice"),
        ([], "missing"),
    ],
)
def test_wrong_values_are_refused_in_a_sentence(stated, said):
    """The entry, what stands there and the remedy are named."""
    with pytest.raises(CaseError, match=said) as told:
        axis(DIAMETER, stated)
    assert str(told.value).startswith(f"vary {DIAMETER}:")


def test_a_grid_runs_through_every_combination_the_last_entry_fastest():
    """Numbers of points are what a table of all combinations has."""
    points = Points((axis("a", "1, 2"), axis("b", "x, y, z")), [{"c": "5"}, {"c": "6"}])
    assert len(points) == 12
    assert [tuple(point.values()) for point in points][:4] == [(5, 1, "x"), (5, 1, "y"), (5, 1, "z"), (5, 2, "x")]
    assert len({tuple(point.items()) for point in points}) == 12


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol"])
def test_a_sample_fills_the_ranges_and_repeats(method):
    """One point a stratum in each entry (both methods have that for 16 points); equal seeds, equal points."""
    plan = {
        "case": CASE,
        "vary": {"a": "0 mm..16 mm", "b": "x, y"},
        "sample": {"method": method, "count": 16, "seed": 7},
    }
    study = plan_of(plan)
    found = [Points(study.axes(), [{}], study.sample) for _ in range(2)]
    assert list(found[0]) == list(found[1])
    numbers = [float(str(point["a"]).split()[0]) for point in found[0]]
    assert sorted(np.floor(numbers).astype(int)) == list(range(16))
    assert [point["b"] for point in found[0]].count("x") == 8
    other = plan_of(plan | {"sample": {"method": method, "count": 16, "seed": 8}})
    assert list(Points(other.axes(), [{}], other.sample)) != list(found[0])


def test_linked_entries_follow_from_others():
    """By the names beside the entry or by whole paths; the value is text with a unit, as in a case file."""
    plan = plan_of(
        {
            "case": CASE,
            "vary": {DIAMETER: "5 mm, 6 mm"},
            "link": {
                "parts.tube.eye_thickness": "outer_diameter + 2*fillet_radius",
                "parts.rod-4mm.fillet_radius": "parts.tube.fillet_radius / 2",
            },
        }
    )
    variants = Variants(plan, Path())
    tables = variants.tables(variants.points[1])
    assert tables["parts"]["tube"]["eye_thickness"] == "7.6 mm"  # 6 + 2 x 0.8
    assert tables["parts"]["rod-4mm"]["fillet_radius"] == "0.4 mm"


@pytest.mark.parametrize(
    ("stated", "value"),
    [
        ("count / 2", 1.5),
        ("count * 2", 6),
        ("20 % * count", 0.6),
        ("wide / 1 cm", 0.2),
        ("300 K", "300 K"),
        ("6 V", "6 V"),
    ],
)
def test_pure_numbers_and_temperatures_may_be_linked(stated, value):
    """A whole number stays one: some entries count."""
    found = derived_value({"made": {"count": 3, "wide": "2 mm"}}, "made.other", stated)
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        ({"vary": {"parts.tub.outer_diameter": "5 mm, 6 mm"}}, "did you mean 'tube'"),
        ({"vary": {"parts.tube.outer_diamter": "5 mm, 6 mm"}}, "did you mean 'outer_diameter'"),
        ({"vary": {DIAMETER: "5 mm..6 mm"}}, "how many values"),
        ({"vary": {}}, "nothing varies"),
        ({"vary": {DIAMETER: "5 mm"}, "link": {DIAMETER: "5 mm"}}, "varied and linked"),
        ({"vary": {DIAMETER: "5 mm"}, "link": {"parts.tube.eye_thickness": "outer_diamter"}}, "states no"),
        ({"vary": {DIAMETER: "5 mm"}, "link": {"parts.tube.eye_thickness": "outer_diameter + 1 N"}}, "adds"),
        ({"vary": {DIAMETER: "5 mm"}, "analysis": "chek"}, "analysis"),
        ({"vary": {DIAMETER: "5 mm"}, "sample": {"count": 0}}, "sample.count"),
        ({"points": "nowhere.csv"}, "cannot be read"),
        ({"vary": {DIAMETER: "5 mm"}, "case": "no-such-case"}, "no such file or built-in case"),
    ],
)
def test_a_wrong_plan_is_refused_before_anything_is_computed(plan, said):
    """One sentence, whichever part of the plan is wrong."""
    with pytest.raises(CaseError, match=said):
        Variants(plan_of({"case": CASE} | plan), Path())


def test_points_of_a_table_are_checked(tmp_path):
    """A first line that names the entries, and lines as long as it."""
    (tmp_path / "study.toml").write_text(f'case = "{CASE}"\npoints = "points.csv"\n', encoding="utf-8")
    for text, said in (
        ("a,b\n1,2\n3\n", "point 2 of 'points.csv' has 1 values for 2 entries"),
        ("a,a\n1,2\n", "names each entry once"),
        ("a\n", "points below it"),
        ("", "points below it"),
    ):
        (tmp_path / "points.csv").write_text(text, encoding="utf-8")
        with pytest.raises(CaseError, match=said):
            table_of(*read_plan(tmp_path / "study.toml"))
    (tmp_path / "points.csv").write_text(f"# made by hand\n{DIAMETER}\n5 mm\n6 mm\n", encoding="utf-8")
    assert [dict(point) for point in Variants(*read_plan(tmp_path / "study.toml")).points] == [
        {DIAMETER: "5 mm"},
        {DIAMETER: "6 mm"},
    ]


def test_a_first_point_that_the_rules_refuse_is_a_point_as_any():
    """A bore wider than its tube is for the study to tell, wherever it stands among the points."""
    plan = plan_of({"case": CASE, "vary": {"parts.tube.inner_diameter": "6 mm, 2 mm"}})
    assert len(Variants(plan, Path())) == 2
    plan = plan_of({"case": CASE, "vary": {"links.GF.points.F.0": "1 mm, 50 mm"}})  # eyes overlap
    assert len(Variants(plan, Path())) == 2
