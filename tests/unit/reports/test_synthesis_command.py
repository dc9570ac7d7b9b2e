"""`alula synth`: the published linkage, its defects, bad input, the drawing."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from alula.geometry.base.errors import CaseError
from alula.reports.commands.cli import app
from alula.reports.commands.synthesis import (
    PUBLISHED_GROUND,
    PUBLISHED_POINTS,
    read_synthesis,
)
from alula.reports.commands.telling import text_of
from alula.reports.figures.four_bar import joints_at
from alula.reports.renderers.record import as_brief_record
from alula.reports.tools.synthesis import synthesis_section


@pytest.fixture(scope="module")
def found():
    return read_synthesis(PUBLISHED_POINTS, PUBLISHED_GROUND)


def test_lengths_are_told_in_the_unit_of_the_ground(found) -> None:
    text = text_of([synthesis_section(found)])
    for line in ("K1 = 0.966752, K2 = 5.005281, K3 = 5.034075", "a = 1.708728038 m", "d = 10 m"):
        assert line in text
    assert "12.05263932 m" in text
    assert "Non-Grashof" in text


def test_small_linkages_are_told_in_mm() -> None:
    assert "a = 17.08728038 mm" in text_of([synthesis_section(read_synthesis(PUBLISHED_POINTS, "100 mm"))])


def test_the_record_holds_points_branches_and_lock_ups(found) -> None:
    data = as_brief_record([synthesis_section(found)])
    assert data["lengths"]["b"] == pytest.approx(10343.91129, abs=5e-6)
    assert [point["branches"]["c"] for point in data["points"]] == ["open", "crossed", "open"]
    assert {lock["drive"] for lock in data["lock_ups"]} == {"a", "b", "c"}
    assert "branch-defect" in {finding["kind"] for finding in data["findings"]}


def test_drawn_joints_keep_the_lengths_and_the_angles(found) -> None:
    bar = found.four_bar
    for point in found.points:
        o2, a, b, o4 = joints_at(found, point)
        lengths = [np.linalg.norm(v) for v in (a - o2, b - a, b - o4, o4 - o2)]
        np.testing.assert_allclose(lengths, [bar.a, bar.b, bar.c, bar.d], rtol=1e-12)
        assert math.atan2(*(b - a)[::-1]) == pytest.approx(point.theta, abs=1e-12)
        assert math.atan2(*(b - o4)[::-1]) == pytest.approx(point.psi, abs=1e-12)


def test_negative_lengths_are_drawn_turned() -> None:
    found = read_synthesis(("10 deg, 200 deg", "40 deg, 220 deg", "80 deg, 270 deg"), "1 m")
    assert found.c_turned
    for point in found.points:
        _, a, b, _ = joints_at(found, point)
        assert np.linalg.norm(b - a) == pytest.approx(found.four_bar.b, rel=1e-9)


@pytest.mark.parametrize(
    ("points", "ground", "told"),
    [
        (PUBLISHED_POINTS[:2], "10 m", "give three"),
        (("30 deg", *PUBLISHED_POINTS[1:]), "10 m", "no pair of angles"),
        (("0 deg, 30", *PUBLISHED_POINTS[1:]), "10 m", "psi .* needs its unit"),
        (PUBLISHED_POINTS, "10", "--ground: .* needs its unit"),
        (PUBLISHED_POINTS, "-1 m", "greater than zero"),
        ((PUBLISHED_POINTS[0],) * 3, "10 m", "singular"),
    ],
)
def test_bad_input_is_told_in_one_sentence(points, ground, told) -> None:
    with pytest.raises(CaseError, match=told):
        read_synthesis(points, ground)


def test_the_command_writes_into_a_subfolder_again_and_again(tmp_path: Path) -> None:
    for _ in range(2):
        assert CliRunner().invoke(app, ["synth", "-o", str(tmp_path)]).exit_code == 0
    assert [path.name for path in tmp_path.iterdir()] == ["synth"]
    assert {path.name for path in (tmp_path / "synth").iterdir()} == {".alula-synth.json", "result.json", "linkage.png"}
    record = json.loads((tmp_path / "synth" / "result.json").read_text(encoding="utf-8"))
    assert record["condition"] == pytest.approx(76.849, abs=1e-3)
    assert (tmp_path / "synth" / "linkage.png").read_bytes().startswith(b"\x89PNG")
