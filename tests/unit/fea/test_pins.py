"""Pins in shear and bending: by hand, and against an integral over the section."""

import numpy as np
import pytest
from edited_cases import edited
from materials import SOURCED

from fea.check import check_case
from fea.pins import lever, pin_stress, stress_at
from fea.verdict import Verdict
from geometry.errors import CaseError
from loads.case_file import read_case
from loads.statics import JointReaction

WING = "owl-wing-static"


def reaction(*wrench):
    return JointReaction(joint="A", on="AE", by="AG", wrench=np.array(wrench, dtype=float))


def test_stresses_by_hand():
    """10 N on a 2 mm pin, eyes' middles 5 mm apart: W = π 8/32 = 0.7854 mm³, A = 3.1416 mm²."""
    found = pin_stress(10.0, 2.0, 5.0)
    assert (found.moment.value, found.moment.low, found.moment.high) == (50.0, 25.0, 50.0)
    assert found.bending.value == pytest.approx(63.662, abs=5e-4)
    assert found.bending.low == pytest.approx(31.831, abs=5e-4)
    assert found.shear == pytest.approx(4.0 * 10.0 / (3.0 * 3.14159265), rel=1e-8)
    assert found.equivalent == found.bending.__class__(
        value=found.bending.value, low=found.bending.low, high=found.bending.high, holds=found.equivalent.holds
    )


def test_bending_stress_carries_its_moment_and_shear_stress_its_force():
    """Integrate σ = σ_max y/r and τ = τ_max (1 - (y/r)²) over the circle: the moment and the force come back."""
    force, diameter, distance = 7.0, 1.5, 6.0
    found = pin_stress(force, diameter, distance)
    r = diameter / 2.0
    y = np.linspace(-r, r, 200_001)
    width = 2.0 * np.sqrt(np.maximum(r**2 - y**2, 0.0))
    assert np.trapezoid(found.bending.value * y**2 / r * width, y) == pytest.approx(force * distance, rel=1e-6)
    assert np.trapezoid(found.shear * (1.0 - (y / r) ** 2) * width, y) == pytest.approx(force, rel=1e-6)


def test_a_short_pin_shears_before_it_bends():
    found = pin_stress(10.0, 2.0, 0.1)
    assert found.equivalent.value == pytest.approx(np.sqrt(3.0) * found.shear)
    assert found.equivalent.low == found.equivalent.high


def test_the_lever_is_half_of_each_eye_and_the_gap():
    assert lever(read_case(WING), "B") == 7.0
    # The ground has no part: its eye is taken as thick as that of AE.
    assert lever(edited(WING, ['joints.A.pin_gap="0.4 mm"']), "A") == pytest.approx(7.4)
    two = [
        'parts.thick={shape="tube",material="pvc-u",outer_diameter="5 mm",inner_diameter="2.5 mm",'
        'eye_diameter="8 mm",eye_thickness="9 mm",fillet_radius="0.8 mm"}',
        'links.AE.part="thick"',
    ]
    assert lever(edited(WING, two), "B") == 8.0


def test_moments_out_of_the_plane_add():
    case = read_case(WING)
    plain, turned = stress_at(case, "A", reaction(3, 4, 0, 0, 0, 99)), stress_at(case, "A", reaction(3, 4, 9, 6, 8, 0))
    assert plain.moment.value == pytest.approx(5.0 * 7.0)
    assert turned.moment.value == pytest.approx(5.0 * 7.0 + 10.0)
    assert turned.moment.low == pytest.approx(5.0 * 3.5 + 10.0)


def test_the_wings_pins_pass_and_thin_ones_fail():
    result = check_case(read_case(WING), name=WING, fidelity="beam")
    pins = [c for c in result.load_cases["weight"].checks if c.name == "pins"]
    assert [c.link for c in pins] == [f"pin {name}" for name in "ABCDEFG"]
    assert all(c.verdict is Verdict.PASS and c.limit == 2.0 for c in pins)
    # A: 0.9520 N x 7 mm over pi 1.5^3/32 = 0.33134 mm^3, against 1330 MPa.
    assert pins[0].value.value == pytest.approx(1330.0 / (0.9520 * 7.0 / 0.33134), rel=1e-3)
    assert pins[0].value.high == pytest.approx(2.0 * pins[0].value.low)
    for minimum, verdict in ((100.0, Verdict.UNDECIDED), (1000.0, Verdict.FAIL)):
        limits = [f'checks.pins={{type="pins",minimum={minimum},joints=["A"]}}']
        result = check_case(edited(WING, limits), name=WING, fidelity="beam")
        (one,) = [c for c in result.load_cases["weight"].checks if c.name == "pins"]
        assert (one.verdict, one.what) == (verdict, "pin A")


@pytest.mark.parametrize(
    ("overrides", "sentence"),
    [
        (['joints.B.pin_material="tin"'], r"joints\.B\.pin_material: 'tin' is unknown; choose one of .*steel-wire"),
        (['checks.pins.joints=["Z"]'], r"checks\.pins\.joints: 'Z' is no revolute joint .*choose among A, B"),
        (['joints.B.pin_gap="-1 mm"'], r"joints\.B\.pin_gap .*must not be negative"),
        (["checks.pins.minimum=0.0"], r"checks\.pins.*minimum"),
        (
            [
                'materials.tin={title="tin",density="7 g/cm^3",youngs_modulus="50 GPa",poissons_ratio=0.3,'
                'yield_strength="10 MPa",strength="yield",' + SOURCED + "}",
                'joints.B.pin_material="tin"',
            ],
            r"checks\.pins\.minimum: it is missing, and 'tin', the material of the pin at joint 'B', states no",
        ),
    ],
)
def test_what_is_wrong_with_a_pin(overrides, sentence):
    with pytest.raises(CaseError, match=sentence):
        edited(WING, overrides)
