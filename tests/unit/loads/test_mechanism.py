"""Which joints make a flapping wing, and what is told where they do not."""

import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case


def test_lengths_come_from_the_links() -> None:
    case = read_case("flapping-wing-chosen")
    wing = case.flapping_wing.wing(case.linkage)
    assert (wing.crank, wing.coupler, wing.rocker, wing.width, wing.height) == (15.0, 105.0, 45.0, 49.0, 102.5)


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ('flapping_wing.crank_pin="Z"', "no joint 'Z'"),
        ('flapping_wing.rocker_pin="QR"', "share no moving link"),
        ('flapping_wing.crank_pivot="O4R"', "share no moving link"),
        ('flapping_wing.rocker_pivot="DR"', "no joint of the ground"),
        ('links.frame.points.O2=["1 mm", "0 mm"]', "put the crank's pivot at the origin"),
    ],
)
def test_joints_that_do_not_fit_are_told(override: str, told: str) -> None:
    with pytest.raises(CaseError, match=told):
        read_case("flapping-wing-chosen", [override])
