"""Sizes that follow the section of a part, so that hand calculation is calibrated, and a section that passes."""

import pytest

from alula.fea.beam.calibration import uncalibrated
from alula.fea.check.run import check_case
from alula.fea.sizing.section import following, larger, stated
from alula.loads.case.case_file import read_case, read_text
from alula.reports.sentences.verdicts import checks_of


def outside(case, *links):
    return [link for link in links if uncalibrated(case.body(link), case.material_of(link).poissons_ratio)]


LINKS = ("crank", "coupler", "rocker")


def test_nothing_follows_a_section_that_is_calibrated():
    assert following(read_case("four-bar").with_values({"links.rocker.end_patch": "6.4 mm"}), "bar") == {}


@pytest.mark.parametrize(
    ("width", "thickness", "entries"),
    [
        ("9 mm", "2 mm", {"parts.bar.thickness": "3.6 mm", "joints.O2.pin_diameter": "3.4 mm"}),
        ("3 mm", "3 mm", {"parts.bar.fillet_radius": "0.9 mm", "joints.O2.pin_diameter": "2.3 mm"}),
        ("20 mm", "8 mm", {"parts.bar.width": "8 mm"}),  # the crank of 40 mm takes no wider eyes
    ],
)
def test_what_follows_a_section_is_brought_to_the_ends_of_its_range(width, thickness, entries):
    """Thickness 0.4 and fillet 0.3 of the width, pins 0.23 and 0.486 of the eye, which is 1.6 times as wide."""
    case = read_case("four-bar").with_values({"parts.bar.width": width, "parts.bar.thickness": thickness})
    assert outside(case, *LINKS)
    found = following(case, "bar")
    assert {entry: found.get(entry) for entry in entries} == entries
    assert not outside(case.with_values(found), *LINKS)
    assert {path for path, was, now in stated(case, found) if was != now} == found.keys()


def test_a_larger_section_is_one_with_which_the_case_passes():
    case = read_case("four-bar").with_values(
        {
            "parts.bar.material": "aluminium-6061-t6",
            "links.rocker.end_patch": "6.4 mm",
            "load_cases.lift.forces.0.force.1": "-90 N",
            "checks.stiffness.maximum": "2 mm",
        }
    )
    result = check_case(case, name="four-bar", fidelity="beam", threads=1)
    assert result.verdict != "pass"
    found = larger(case, "four-bar", checks_of(result))
    assert {"parts.bar.width", "joints.O2.pin_diameter", "links.rocker.end_patch"} <= found.keys()
    assert check_case(case.with_values(found), fidelity="beam", threads=1).verdict == "pass"


def test_sections_are_tried_one_after_the_other_where_no_margin_tells_what_is_lacking(tmp_path):
    """A collapse that is open has no margin: the section is the first that passes, and no much heavier one."""
    text = read_text("four-bar")[0].replace("pla-fdm-xy", "aluminium-6061-t6").replace("build_direction", "# ")
    file = tmp_path / "case.toml"
    file.write_text(f'{text}\n[checks.collapse]\ntype = "plastic-collapse"\nminimum = 2.4\n', encoding="utf-8")
    values = {"parts.bar.thickness": "3.2 mm", "links.rocker.end_patch": "5 mm", "checks.stiffness.maximum": "2 mm"}
    case = read_case(str(file)).with_values(values | {"load_cases.lift.forces.0.force.1": "-160 N"})
    found = larger(case, str(file), checks_of(check_case(case, name=str(file), fidelity="beam", threads=1)))
    assert found["parts.bar.width"] == "9.6 mm"
    assert found["parts.bar.thickness"] == "8 mm"  # 9.6 mm with steps of 1.3
    assert check_case(case.with_values(found), fidelity="beam", threads=1).verdict == "pass"
