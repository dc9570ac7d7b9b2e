"""What a notebook and a script see of a result: numbers by name, tables, pictures, HTML without markup of others."""

import io
import math
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.image import imread
from rocker_case import TOML
from told import result_record

import alula
from alula.fea.common.verdict import by_nearness
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.notebook.check_report import CheckReport
from alula.reports.notebook.shown import ShownPicture, ShownTable
from alula.reports.sentences.verdicts import checks_of

HOSTILE = "<script>alert('&')</script>"


class Page(HTMLParser):
    """Tags and text of some HTML."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)

    def handle_data(self, data):
        self.texts.append(data)


@pytest.fixture(scope="module")
def report(result):
    return CheckReport(result)


def is_png(picture):
    return isinstance(picture, ShownPicture) and imread(io.BytesIO(picture._repr_png_())).ndim == 3


def test_numbers_are_those_of_result_json(report):
    record = result_record(report.result)
    assert record["version"] == alula.__version__
    assert report.verdict == record["verdict"]
    for link, found in record["links"].items():
        assert report.safety_factors[link].value == found["safety_factor"]["value"]
        high = report.displacements[link].high
        assert (None if math.isnan(high) else high) == found["displacement_max"]["high"]
        assert report.stresses[link].value == found["von_mises_max"]["value"]
    assert report.drive_torques == {name: case["drive_torque"] for name, case in record["load_cases"].items()}


def test_tables_have_a_row_each(report):
    record = result_record(report.result)
    ordered = by_nearness(checks_of(report.result))
    assert len(ordered) == len(record["checks"])
    assert [(row["link"], row["value"], row["verdict"]) for row in report.table()] == [
        (check.link, check.value.value, check.verdict) for check in ordered
    ]
    links = report.table("links")
    assert len(links) == sum(len(case["links"]) for case in record["load_cases"].values())
    forces = {(row["load case"], row["joint"]): row for row in report.table("joints")}
    for reaction in record["reactions"]:
        row = forces[reaction["load_case"], reaction["joint"]]
        assert (row["Fx [N]"], row["Fy [N]"]) == tuple(reaction["force"])
        assert row["size [N]"] == pytest.approx(math.hypot(*reaction["force"]))
    with pytest.raises(CaseError, match="there is no table 'check'; did you mean 'checks'"):
        report.table("check")


def test_rows_name_their_load_case_and_bodies_though_a_page_does_not():
    """With one load case, pages and consoles leave its column out; a script that reads it goes on."""
    found = alula.check("four-bar", fidelity="beam")
    assert {row["load case"] for of in ("checks", "links") for row in found.table(of)} == {"lift"}
    assert {(row["by"], row["on"]) for row in found.table("joints")} >= {("base", "crank"), ("coupler", "rocker")}
    assert "load case" not in str(found.table("links"))
    crank = found.table("links")[0]
    assert crank["safety factor low"] < crank["safety factor"] < crank["safety factor high"]


def test_a_table_as_text_keeps_its_columns():
    text = str(ShownTable(({"name": "a", "x [mm]": 3.0, "of": None}, {"name": "long", "x [mm]": math.inf, "of": None})))
    assert text.splitlines() == ["name  x [mm]  of", "a          3", "long       ∞"]
    assert str(ShownTable(())) == "(no rows)"


def test_numbers_stand_to_the_right_in_html():
    html = ShownTable(({"name": "a", "x [mm]": 3.0},))._repr_html_()
    assert '<td style="text-align: left">a</td><td style="text-align: right">3</td>' in html


def test_html_shows_verdict_and_checks_and_runs_nothing_of_the_case(report):
    case = report.result.case.model_copy(update={"title": HOSTILE})
    page = Page(CheckReport(replace(report.result, case=case, warnings=(HOSTILE,)))._repr_html_())
    assert "script" not in page.tags
    assert page.texts.count(HOSTILE) == 2
    assert page.tags.count("tr") == 1 + len(report.table())
    assert report.verdict.value.upper() in page.texts
    table = Page(ShownTable(({HOSTILE: HOSTILE},))._repr_html_())
    assert "script" not in table.tags
    assert table.texts.count(HOSTILE) == 2


def test_pictures(report, tmp_path):
    assert is_png(report.plot_linkage())
    stress = report.plot_stress("GF")
    assert is_png(stress)
    stress.save(tmp_path / "stress.png")
    assert (tmp_path / "stress.png").read_bytes() == stress.png


def test_what_cannot_be_drawn_is_told(report):
    beam = next(link for link in report.safety_factors if link != "GF")
    with pytest.raises(CaseError, match=f'link {beam} has no stress field.*fidelity="solid"'):
        report.plot_stress(beam)
    with pytest.raises(CaseError, match="there is no link 'GH'; choose one of GF"):
        report.plot_stress("GH")
    with pytest.raises(CaseError, match="there is no load case 'wind'; choose one of weight"):
        report.plot_linkage("wind")


@pytest.fixture(scope="module")
def rocker(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "rocker.toml"
    path.write_text(TOML, encoding="utf-8")
    return alula.read_case(path)


def test_a_motion_has_curves_and_their_extremes(rocker):
    moved = alula.motion(rocker)
    assert moved.coordinates == pytest.approx(np.linspace(40.0, 80.0, 7))
    assert moved.link_angles["crank"] == pytest.approx(moved.coordinates)
    assert moved.dead_points == ()
    torque = moved.drive_efforts["turn"]
    [row] = [row for row in moved.table() if row["quantity"] == "drive torque on crank"]
    assert (row["smallest"], row["largest"]) == (torque.min(), torque.max())
    assert row["largest at [deg]"] == pytest.approx(moved.coordinates[np.argmax(torque)])
    assert is_png(moved.plot_drive())
    assert is_png(moved.plot_linkage())
    assert "drive torque on crank" in Page(moved._repr_html_()).texts


def test_an_envelope_has_the_worst_pose_of_every_link(rocker, monkeypatch):
    """The moment is the rocker's own, so the least safety factor is strength over the largest stress of the curve."""
    found = alula.envelope(rocker, accuracy="60 %", threads=1)
    curve = found.stress("rocker", "turn")
    [row] = found.table()
    assert curve.shape == found.coordinates.shape
    assert row["stress [MPa]"] == found.result.links["rocker"].worst.stress.value >= np.nanmax(curve) * (1.0 - 1e-9)
    assert found.safety_factors["rocker"].value == pytest.approx(41.4 / row["stress [MPa]"])
    assert {row["verdict"] for row in found.table("checks")} == {found.verdict.value}
    assert is_png(found.plot_safety_factors())
    drawn = {"rocker": Canvas(72.0, 72.0)}  # rendering is tested above
    monkeypatch.setattr(
        "alula.reports.figures.figures.plots_of", lambda scenes, points: ({n: drawn[n] for n in scenes}, ())
    )
    assert is_png(found.plot_stress("rocker"))
    monkeypatch.setattr("alula.reports.figures.figures.plots_of", lambda scenes, points: ({}, ("rendering crashed",)))
    with pytest.raises(CannotRunError, match="rendering crashed"):
        found.plot_stress("rocker")
    assert found.verdict.value.upper() in Page(found._repr_html_()).texts
    assert "Not checked: " in found.headline
    assert str(found).startswith(found.headline)
    with pytest.raises(CaseError, match="there is no loaded link 'crank'"):
        found.plot_stress("crank")


def test_claims_are_counted():
    found = alula.claims("four-bar-synthesis")
    rows = [row["finding"] for row in found.table()]
    assert found.findings == {finding: rows.count(finding) for finding in set(rows)}
    assert sum(found.findings.values()) == 19
