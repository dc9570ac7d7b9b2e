"""What fuzzing found: symptom, cause, and a stable control beside each."""

import tomllib

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.closure import LoopClosure
from alula.loads.case.case_file import read_case, read_text, validate
from alula.loads.sources.claim import read_printed

WING = "owl-wing-flight"


@pytest.mark.parametrize("size", [1e-200, 1.0, 1e200])
def test_the_length_of_a_direction_does_not_count(size: float) -> None:
    """The square of 1e200 overflowed with a warning of NumPy's; that of 1e-200 vanished, so there was no direction."""
    case = read_case(WING)
    name = next(name for name, load in case.load_cases.items() if load.air)
    stated = case.load_cases[name].air[0].stream
    stream = [float(size * x) for x in stated]
    scaled = read_case(WING, [f"load_cases.{name}.air.0.stream={stream!r}"])
    for found, expected in zip(scaled.air_forces(name), case.air_forces(name), strict=True):
        np.testing.assert_allclose(found.total, expected.total, rtol=1e-12)
    with pytest.raises(CaseError, match="no direction"):
        read_case(WING, [f"load_cases.{name}.air.0.stream=[0.0, 0.0, 0.0]"])


@pytest.mark.parametrize("text", ['pose.angle="30 d\udce7%"', "pose.angle=30 d\udce7", 'title="a\udce7b"', "\udce7=1"])
def test_bytes_that_are_no_text_behind_set(text: str) -> None:
    """Python hands bytes of the command line that are not UTF-8 over as halves of surrogate pairs, which pydantic
    cannot quote and no file can hold: a UnicodeEncodeError."""
    with pytest.raises(CaseError, match="it is not UTF-8 text"):
        read_case(WING, [text])
    assert read_case(WING, ['title="Flügel ✓ \U0001f989"']).title == "Flügel ✓ \U0001f989"


def test_halves_of_surrogate_pairs_in_tables() -> None:
    """The same by way of the Python interface: quoted in an error, and in a text that the report would hold."""
    tables = tomllib.loads(read_text(WING)[0])
    with pytest.raises(CaseError, match="half of a surrogate pair"):
        validate(tables | {"pose": {"coordinate": "GF", "angle": "1 d\udce7"}})
    with pytest.raises(CaseError, match=r"^title .*control characters"):
        validate(tables | {"title": "a\udce7b"})
    assert validate(tables).title


@pytest.mark.parametrize("digits", ["0e400", "0.00E+309", "1e-999"])
def test_a_published_zero_with_a_huge_exponent(digits: str) -> None:
    """Zero times ten to the 400 is a finite number, but half a unit of its last digit is not: an OverflowError."""
    with pytest.raises(CaseError, match="too long or too large"):
        read_printed(f"{digits} N")
    found = read_printed("0e3 N")
    assert found is not None
    assert (found.number, found.half) == (0.0, 500.0)


def test_why_a_linkage_does_not_close_is_found_in_a_moment(monkeypatch: pytest.MonkeyPatch) -> None:
    """A slot made a plain joint left no freedom: the search for the open loop took 28,000 evaluations, 1.4 s.

    The bound on the search's iterations leaves a third of that.
    """
    evaluate, count = LoopClosure.residual, 0

    def counted(self: LoopClosure, q: np.ndarray) -> np.ndarray:
        nonlocal count
        count += 1
        return evaluate(self, q)

    monkeypatch.setattr(LoopClosure, "residual", counted)
    overrides = ['joints.slot-right.type="revolute"', 'links.crank.points.A=["0 mm", "0 mm"]']
    with pytest.raises(CaseError, match="mobility 0"):
        read_case("ornithopter", overrides)
    assert 1000 < count < 12_000
