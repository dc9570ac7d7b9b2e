import base64
import io
import json
import re

import numpy as np
import pytest
from edited_cases import edited
from PIL import Image
from solved import told

from alula.fea.check.run import check_case
from alula.fea.claims.sources import claims_of
from alula.fea.findings.of_check import with_findings
from alula.reports.check.folder import report_names, write_report
from alula.reports.check.whole_check import check_page, check_sections
from alula.reports.figures import figures
from alula.reports.sections.section import Picture, parts_of


@pytest.fixture
def without_renderer(monkeypatch):
    monkeypatch.setattr(figures, "_ask", lambda requests, choice, time_limit: ({}, "rendering crashed (signal 11)"))


def test_the_folder_is_complete(result, tmp_path):
    said = []
    write_report(result, tmp_path / "out", claims=claims_of(result), progress=said.append)
    found = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    diagrams = {f"pictures/diagram-{link}.png" for link in result.case.checked_links}
    pictures = {"pictures/linkage-weight.png", "pictures/stress-GF.png", *diagrams}
    assert found == {".alula-check.json", "report.html", "claims.html", "result.json", "vtu/GF.vtu", *pictures}
    # Names known before anything is solved, so that a file of the user's own under one of them is found by then.
    assert found - {".alula-check.json"} <= report_names(result.case)
    for name in pictures:
        assert (tmp_path / "out" / name).read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "out" / "report.html").read_text(encoding="utf-8").count("<svg ") == len(pictures)
    assert json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))["case"] == "owl-wing-static"
    _has_every_pixel(tmp_path / "out" / "pictures" / "stress-GF.png", tmp_path / "out" / "report.html")
    assert said == ["Drawing the linkage, the internal forces and the stress plots ..."]


def test_names_are_known_of_both_directions_against_friction():
    case = edited("four-bar", ["joints.A.friction=0.2", "motion.poses=3"])
    result = with_findings(check_case(case, fidelity="beam"))
    page = check_page(result, check_sections(result))
    parts = [part for section in page.every for part in parts_of(section.parts)]
    pictures = {part.name for part in parts if isinstance(part, Picture) and part.name}
    assert {"linkage-lift forward", "linkage-lift backward"} <= pictures
    assert {f"pictures/{name}.png" for name in pictures} <= report_names(case)


def test_a_folder_is_written_without_a_solution(result, tmp_path, monkeypatch):
    """Trials of what would change it take a third of a check by hand; wings in air were moved nine times in all."""
    solved = told("ornithopter")
    assert solved.changes
    for where in ("fea.check.run.solve_case_statics", "fea.whole.rubbed_motion.solve_case_motion"):
        monkeypatch.setattr(f"alula.{where}", lambda *asked, **options: pytest.fail("solved"))
    write_report(solved, tmp_path / "out")
    record = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert list(record["flapping"]) == ["wings-10-air", "wings-12-air"]
    assert len(list((tmp_path / "out" / "pictures").glob("air-*"))) == 2


def _has_every_pixel(picture, page):
    """The views of a stress plot stand in the page with the pixels of the file, below its labels."""
    packed = map(base64.b64decode, re.findall(r"data:image/webp;base64,([^\"]*)", page.read_text(encoding="utf-8")))
    views = [np.asarray(Image.open(io.BytesIO(one)).convert("RGB")) for one in packed]
    assert len(views) == 3  # the link, its hottest place, the scale of colours
    drawn = np.asarray(Image.open(picture).convert("RGB")).reshape(-1, 3)
    for view in views[:2]:
        shades, counts = np.unique(view.reshape(-1, 3), axis=0, return_counts=True)
        often = shades[counts > 50]
        assert len(often) > 20
        assert {tuple(shade) for shade in often} <= {tuple(shade) for shade in np.unique(drawn, axis=0)}


@pytest.mark.usefixtures("without_renderer")
def test_without_a_renderer_all_but_the_stress_plots_stands(result, tmp_path):
    write_report(result, tmp_path / "out")
    record = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    [warning] = [w for w in record["warnings"] if "stress plot" in w]
    assert warning == "no stress plot of GF: rendering crashed (signal 11)"
    assert warning[1:] in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")  # there it begins a sentence
    assert not list((tmp_path / "out" / "pictures").glob("stress-*"))
    assert (tmp_path / "out" / "vtu" / "GF.vtu").exists()
