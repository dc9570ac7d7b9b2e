"""Bands that left out a cause that a case states; each was told as if nothing were open.

``tests/verification/test_every_band_holds.py`` found them, and looks for others of their kind.
"""

import numpy as np
import pytest
from random_four_bars import FourBar, Inputs

from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.motion.linkage_history import over_motion
from alula.fea.motion.loosened import column_growth
from alula.fea.whole.motor import motor_outcomes
from alula.fea.whole.rubbed_motion import rubbed_motion
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

MOTOR = {"type": "motor", "voltage": "6 V", "current": "2 A", "efficiency": 0.5, "no_load_speed": "60 rpm",
         "stall_torque": "5000 N*mm", "rated_torque": "800 N*mm"}  # fmt: skip


def moving(of: FourBar, causes: tuple[str, ...], *, poses: int = 3, factor: float = 1.0) -> Case:
    data = of.data(causes)
    data["motion"] = {"range": [f"{of.angle + turn!r} rad" for turn in (0.0, 0.5)], "poses": poses}
    data["checks"] = data["checks"] | {"motor": MOTOR}
    data["load_cases"] = {"one": data["load_cases"]["one"]}
    own = data["load_cases"]["one"]
    own["speed"] = "0.01 rpm"
    for load in own["forces"]:
        load["force"] = [f"{factor * float(part.split()[0])!r} N" for part in load["force"]]
    own.pop("direction", None)
    return validate(data)


def test_a_motor_bears_the_scatter_of_its_loads() -> None:
    """Power, torque share and torque of a load case with a scatter of 85 to 130 % were those of 100 % alone."""
    of = FourBar(0)

    def told(case: Case):
        return {one.quantity: one.value for one in motor_outcomes(case, "motor", case.checks["motor"])["one"]}

    plain, stated = told(moving(of, ())), told(moving(of, ("load",)))
    low, high = of.scatter["one"]
    for quantity in ("share of the motor's torque at its speed", "drive torque over time"):
        assert stated[quantity].low == pytest.approx(low * plain[quantity].low)
        assert stated[quantity].high == pytest.approx(high * plain[quantity].high)
        assert SourceKind.LOAD in {source.kind for source in stated[quantity].sources}
    assert stated["drive torque over time"].high == pytest.approx(
        told(moving(of, (), factor=high))["drive torque over time"].high, rel=1e-5
    )


def test_the_band_of_a_motor_holds_its_value_in_spite_of_rounding() -> None:
    """Of a motor x times x over x was asked, which may be less than x: the run ended with a ValueError."""
    for draw in range(4):
        case = moving(FourBar(draw), ())
        for one in motor_outcomes(case, "motor", case.checks["motor"])["one"]:
            assert one.value.low <= one.value.value <= one.value.high


def outcome(case: Case, load_case: str, name: str, subject: str):
    result = check_case(case, fidelity="beam", bare=True, threads=1)
    return next(
        one.value for one in result.load_cases[load_case].checks if (one.name, str(one.subject)) == (name, subject)
    )


def test_columns_over_a_motion_hold_the_play_of_pins() -> None:
    """The buckling factor of a link over a motion had no play in its band; that of a pose had."""
    of = FourBar(0)
    moved = rubbed_motion(moving(of, ("play",)))
    growth = column_growth(moved, "one", "rocker", np.arange(len(moved.motion.angles)) == 0)
    plain, stated = (outcome(of.stated(causes), "one", "buckling", "rocker") for causes in ((), ("play",)))
    assert growth.high == pytest.approx(plain.low / stated.low, rel=1e-4)
    assert growth.low == pytest.approx(plain.high / stated.high, rel=1e-4)
    assert growth.high > 1.001


def test_play_turns_the_force_of_a_link_that_bears_it_across_its_axis() -> None:
    """Of this crank the force changes by half a percent, but what of it goes along the crank by half.

    The band of its buckling factor was that of the force's size.
    """
    of, axis = FourBar(0), np.exp(1j * FourBar(0).angle)

    def along(play: dict[str, complex]) -> float:
        return float((of.statics("one", Inputs(play=play))[0]["O2"] * np.conj(axis)).real)

    offsets = {}
    for joint, radius in of.radii.items():
        slope = complex(*(along({joint: 1e-5 * u}) - along({joint: -1e-5 * u}) for u in (1.0, 1.0j)))
        offsets[joint] = radius * slope / abs(slope)
    plain, stated = (outcome(of.stated(causes), "one", "buckling", "crank") for causes in ((), ("play",)))
    times = along(offsets) / along({})
    size = abs(of.statics("one", Inputs(play=offsets))[0]["O2"]) / abs(of.statics("one")[0]["O2"])
    assert size < 1.01 < 1.5 < times
    assert stated.low == pytest.approx(plain.low / times, rel=1e-3)


@pytest.mark.parametrize(
    ("causes", "kinds"),
    [
        (("play", "friction"), {SourceKind.PLAY, SourceKind.FRICTION}),
        (("air",), {SourceKind.AIR}),
    ],
)
def test_the_limit_load_over_a_motion_holds_what_that_of_its_poses_does(
    causes: tuple[str, ...], kinds: set[SourceKind]
) -> None:
    """Over a motion it was that with pins in the middle of their holes, at the stated C_N and coefficients."""
    of = FourBar(0)
    case = moving(of, causes)
    if "air" in causes:
        own = case.load_cases["one"].model_copy(update={"speed": of.stated(causes).load_cases["one"].speed})
        case = case.model_copy(update={"load_cases": {"one": own}})
    moved = rubbed_motion(case)
    over = over_motion(moved, np.arange(len(moved.motion.angles)) == 0)["one"].limit_load
    assert {source.kind for source in over.sources} >= kinds
    pose = outcome(of.stated(causes), "one", "limit", "the linkage")
    assert (over.low, over.high) == pytest.approx((pose.low, pose.high), rel=0.01)


def test_what_two_materials_add_to_a_displacement_may_cancel() -> None:
    """A point's band was scaled by the outer ends of both moduli; with both at their stiffer ends it moves less here.

    The low end was 0.38 µm, where it is 0.25 µm.
    """
    of, where = FourBar(1), ("two", "point", "point P of rocker")
    stated = outcome(of.stated(("modulus",)), *where)
    direct = outcome(of.direct(("modulus",), "two", Inputs(modulus={"ductile": 1.2, "brittle": 1.6})), *where)
    assert direct.low == pytest.approx(2.466e-4, rel=1e-3)
    assert 0.95 * direct.low < stated.low <= direct.low


def test_a_point_moves_elsewhere_with_other_friction() -> None:
    """Its band went with the size of the displacement; eyes and bores that give elsewhere made it up to 0.6 % more."""
    of, where = FourBar(2), ("one", "point", "point P of rocker")
    stated = outcome(of.stated(("air",)), *where)
    for air in of.air_ends:
        direct = outcome(of.direct(("air",), "one", Inputs(air=air)), *where)
        assert stated.low <= direct.low * (1.0 + 1e-4)
        assert stated.high >= direct.high * (1.0 - 1e-4)
