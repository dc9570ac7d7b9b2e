"""What fuzzing found: symptom, cause, and a stable control beside each."""

import numpy as np
import pytest
from geometry.errors import CaseError
from loads.case_file import read_case

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
