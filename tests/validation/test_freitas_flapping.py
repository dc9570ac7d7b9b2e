"""Freitas (2022), flapping wing: all rows of tables 1 to 5, by the source's definitions, to the printed digits.

What does not hold within half a unit of the last printed digit stands in ``MISPRINTS`` with the reason.
"""

import csv
import itertools
import math
import time
from importlib import resources

import pytest

from alula.geometry.mechanisms.flapping import FlappingWing

MISPRINTS = {
    ("5", "10", "ground_d_mm"): 24.274,  # printed 24.7, the value of row 20 of the same table
    ("5", "13", "oscillation_deg"): 36.839,  # printed 36.836
    # Row 16 of table 5 repeats row 16 of table 4 (y = 20.5 mm); its own design is row 17 of table 4.
    ("5", "16", "phase_lag_deg"): 0.8765,
    ("5", "16", "oscillation_deg"): 36.865,
    ("5", "16", "asymmetry_deg"): 20.499,
}


def rows():
    text = resources.files("alula.loads.cases").joinpath("flapping-wing-tables.csv").read_text(encoding="utf-8")
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


def wing(row) -> FlappingWing:
    return FlappingWing(
        crank=float(row["crank_a_mm"]),
        coupler=float(row["coupler_b_mm"]),
        rocker=float(row["rocker_c_mm"]),
        width=float(row["width_x_mm"]),
        height=float(row["height_y_mm"]),
    )


def row_of(table, model):
    return next(row for row in rows() if (row["table"], row["model"]) == (table, model))


def assert_printed(printed: str, value: float):
    assert abs(value - float(printed)) <= 0.5000001 * 10.0 ** -len(printed.partition(".")[2])


def test_there_are_a_hundred_rows():
    assert len(rows()) == 100


@pytest.mark.parametrize("row", rows(), ids=lambda row: f"{row['table']}.{row['model']}")
def test_row(row):
    design = wing(row)
    values = {"ground_d_mm": design.ground}
    assert design.grashof.satisfied == (row["grashof_satisfied"] == "yes")
    assert design.turns_fully == design.grashof.satisfied
    if design.turns_fully:
        published = design.published_metrics()
        values["phase_lag_deg"] = math.degrees(published.phase_lag)
        values["oscillation_deg"] = math.degrees(published.oscillation)
        values["asymmetry_deg"] = math.degrees(published.asymmetry)
    for column in ("ground_d_mm", "phase_lag_deg", "oscillation_deg", "asymmetry_deg"):
        if not row[column]:
            continue
        misprint = MISPRINTS.get((row["table"], row["model"], column))
        if misprint is None:
            assert_printed(row[column], values[column])
        else:
            with pytest.raises(AssertionError):
                assert_printed(row[column], values[column])
            assert values[column] == pytest.approx(misprint, abs=5e-4)


def test_the_copied_row():
    copied, own, other = row_of("5", "16"), row_of("4", "17"), row_of("4", "16")
    columns = ("phase_lag_deg", "oscillation_deg", "asymmetry_deg")
    assert wing(copied) == wing(own)
    assert [copied[column] for column in columns] == [other[column] for column in columns]


def test_published_oscillation_fails_where_the_wing_stays_above_or_below():
    """max β + |min β| is the swing only where β changes sign; three rows of table 2 stay above the horizontal."""
    wrong = {}
    for row in rows():
        design = wing(row)
        if design.turns_fully:
            excess = design.published_metrics().oscillation - design.metrics().oscillation
            if abs(excess) > math.radians(0.01):
                wrong[row["table"], row["model"]] = round(math.degrees(design.metrics().oscillation), 2)
    assert wrong == {("2", "2"): 46.32, ("2", "11"): 45.80, ("2", "12"): 37.17}


def test_published_phase_lag_is_the_difference_at_crank_angle_zero():
    turning = [design for design in map(wing, rows()) if design.turns_fully]
    assert len(turning) > 80
    for design in turning:
        metrics = design.metrics()
        assert design.published_metrics().phase_lag == pytest.approx(metrics.side_difference_at_zero, abs=1e-12)
        assert metrics.side_difference >= metrics.side_difference_at_zero


def test_reference_and_chosen_design():
    reference, chosen = row_of("1", "9"), row_of("5", "4")
    ours = {
        name: (design.published_metrics(), design.metrics())
        for name, design in (("reference", wing(reference)), ("chosen", wing(chosen)))
    }
    for name, lag, oscillation, asymmetry in (
        ("reference", 1.9474, 39.085, 21.962),
        ("chosen", 1.4791, 38.943, 21.141),
    ):
        published, _ = ours[name]
        assert math.degrees(published.phase_lag) == pytest.approx(lag, abs=5.1e-5)
        assert math.degrees(published.oscillation) == pytest.approx(oscillation, abs=5.1e-4)
        assert math.degrees(published.asymmetry) == pytest.approx(asymmetry, abs=5.1e-4)
    # "The lag falls by 24 %", and so it does by that definition; the time between the reversals falls by 29 %.
    assert 1 - ours["chosen"][0].phase_lag / ours["reference"][0].phase_lag == pytest.approx(0.24, abs=5e-3)
    true = [math.degrees(ours[name][1].phase_lag) for name in ("reference", "chosen")]
    assert true == pytest.approx([10.393, 7.423], abs=1e-3)
    differences = [math.degrees(ours[name][1].side_difference) for name in ("reference", "chosen")]
    assert differences == pytest.approx([2.018, 1.586], abs=1e-3)


def test_conclusions():
    """A longer coupler gives less asymmetry up to 24 mm only; oscillation over height is least in rows 6 and 16."""
    asymmetry = {
        float(row["coupler_b_mm"]): wing(row).published_metrics().asymmetry
        for row in rows()
        if row["table"] == "2" and 2 <= int(row["model"]) <= 10
    }
    ordered = [asymmetry[length] for length in sorted(asymmetry)]
    assert all(a > b for a, b in itertools.pairwise(ordered[:8]))
    assert ordered[8] > ordered[7]
    worst = {
        row["model"]: wing(row).metrics().asymmetry for row in rows() if row["table"] == "2" and row["model"] != "1"
    }
    assert min((model for model in worst if int(model) <= 10), key=worst.__getitem__) == "6"  # b = 21 mm
    swing = {int(row["model"]): wing(row).metrics().oscillation for row in rows() if row["table"] == "4"}
    assert min(range(1, 11), key=swing.__getitem__) == 6
    assert min(range(11, 21), key=swing.__getitem__) == 16


def test_published_asymmetry_hides_a_side():
    """Mean deviation within 30°, worst beyond it: rows that pass by the source's figure and leave 60° to 120°."""
    hidden = []
    for row in rows():
        design = wing(row)
        if design.turns_fully and row["asymmetry_deg"]:
            published, metrics = design.published_metrics(), design.metrics()
            if published.asymmetry <= math.radians(30) < metrics.asymmetry:
                hidden.append(f"{row['table']}.{row['model']}")
    assert hidden == ["1.11", "1.12", "4.1", "4.2", "4.8", "4.9", "4.10", "4.11", "4.12", "4.19", "4.20",
                      "5.9", "5.10", "5.19", "5.20"]  # fmt: skip


def test_a_hundred_rows_take_well_under_a_second():
    designs = [wing(row) for row in rows()]
    start = time.perf_counter()
    for design in designs:
        if design.turns_fully:
            design.published_metrics()
            design.metrics()
    assert time.perf_counter() - start < 1.0
