import pytest
from pydantic_core import PydanticCustomError

from alula.loads.text.shares import parse_accuracy


@pytest.mark.parametrize(
    ("stated", "share"), [("5 %", 0.05), ("5%", 0.05), ("0.05", 0.05), (0.05, 0.05), (".5 %", 0.005), (1, 1)]
)
def test_read(stated, share):
    assert parse_accuracy(stated) == pytest.approx(share)


@pytest.mark.parametrize(
    "stated", ["five", "5", "0 %", "-5 %", "5 %%", "", None, True, 0.0, 2.0, float("nan"), "0.05 %"]
)
def test_refused(stated):
    with pytest.raises(PydanticCustomError, match=r"from 0\.1 % to 100 %"):
        parse_accuracy(stated)
