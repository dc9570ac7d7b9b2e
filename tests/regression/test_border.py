"""Mistakes at the border that alula once made: symptom, cause, and a stable control beside each."""

from pathlib import Path

import pytest
from edited_cases import edited
from pydantic_core import PydanticCustomError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse
from alula.loads.case.case_file import read_case, read_companion, read_text


def test_percent_was_taken_for_an_angle() -> None:
    """Pint counts radians as pure numbers, so 50 percent became 0.5 rad and 58 Hz became 58 rad/s."""
    for text, dimension in (("50 percent", "angle"), ("58 Hz", "angular speed"), ("5 mm*deg", "length")):
        with pytest.raises(PydanticCustomError, match=f"not a unit of {dimension}"):
            parse(text, dimension)
    assert parse("0.5 rad", "angle") == 0.5
    assert parse("60 rpm", "angular speed") == pytest.approx(6.283185307179586)


def test_a_number_of_thousands_of_digits_ended_in_a_traceback(tmp_path: Path) -> None:
    """Python limits the digits of an integer with a plain ValueError, which is no TOMLDecodeError."""
    path = tmp_path / "case.toml"
    for digits, words in ((5000, "not valid TOML"), (10, "schema_version")):
        path.write_text("a = " + "1" * digits)
        with pytest.raises(CaseError, match=words):
            read_case(str(path))


def test_a_byte_order_mark_made_a_case_invalid(tmp_path: Path) -> None:
    """UTF-8 with the mark that Windows editors put first was decoded with the mark left in."""
    text, _ = read_text("owl-wing-static")
    for mark in (b"\xef\xbb\xbf", b""):
        path = tmp_path / "case.toml"
        path.write_bytes(mark + text.encode())
        assert read_case(str(path)).title.startswith("Owl")


def test_an_overlong_companion_name_ended_in_a_traceback() -> None:
    """Path.is_file raises OSError for a name that the file system cannot hold."""
    with pytest.raises(CaseError, match="beside the case file"):
        read_companion("owl-wing-static", "x" * 5000)
    assert read_companion("owl-wing-static", "owl-wing-statics-printed.csv")


def test_a_force_named_pydantics_types_in_its_message() -> None:
    """A union of pairs and triples put the names of its members into the entry that the sentence named."""
    with pytest.raises(CaseError, match=r"^load_cases\.weight\.forces\.0\.force\.1 \(it is '1 mm'\): "):
        edited("owl-wing-static", ['load_cases.weight.forces.0.force=["0 N", "1 mm"]'])
    for force in ('["0 N", "1 N"]', '["0 N", "1 N", "2 N"]'):
        edited("owl-wing-static", [f"load_cases.weight.forces.0.force={force}"])


def test_pins_of_two_diameters_shared_one_hole() -> None:
    """Where two joints sit at one point of a link, the diameter of the last one won without a word."""
    more = [
        'links.X={layer=0,points={P=["0 mm","0 mm"],Q=["50 mm","0 mm"]}}',
        'links.Y={layer=0,points={Q=["0 mm","0 mm"],R=["50 mm","0 mm"]}}',
        'joints.Q={links=["X","Y"]}',
        'joints.R={links=["AG","Y"],points=["A","R"],pin_diameter="1.5 mm"}',
    ]
    third = 'joints.P={links=["CH","X"],points=["D","P"],pin_diameter="%s"}'
    with pytest.raises(CaseError, match=r"joints.P.pin_diameter: it differs from that of joint 'D'"):
        edited("owl-wing-static", [*more, third % "2 mm"])
    assert len(edited("owl-wing-static", [*more, third % "1.5 mm"]).body("CH").pins) == 2
