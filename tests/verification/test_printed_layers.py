"""A printed bar under tension: the stress on its layers is the closed form's, and its band that of the solid's peak."""

import numpy as np
import pytest

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.refine.refinement import Effort
from alula.fea.solid.stress import stress_field
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

FORCE, WIDTH, THICKNESS = 60.0, 8.0, 5.0
ANGLE = np.radians(30.0)


def bar(normal, **changed):
    """A bar held by its drive and pulled at the end, printed with its layers normal to a direction."""
    entries = ("density", "youngs_modulus", "poissons_ratio", "ultimate_strength", "strength_across_layers",
               "shear_strength_between_layers")  # fmt: skip
    card = {
        "title": "a printed plastic",
        "density": "1240 kg/m^3",
        "youngs_modulus": "2.5 GPa",
        "poissons_ratio": 0.36,
        "ultimate_strength": "60 MPa",
        "strength_across_layers": "30 MPa",
        "shear_strength_between_layers": "20 MPa",
        "strength": "ultimate",
        "minimum_safety_factor": 2.0,
        "sources": dict.fromkeys(entries, "coupons"),
        "status": dict.fromkeys(entries, "measured"),
    } | changed
    return validate(
        {
            "schema_version": 1,
            "title": "a printed bar",
            "links": {
                "base": {"ground": True, "points": {"O": ["0 mm", "0 mm"], "Q": ["9 mm", "0 mm"]}},
                "bar": {"part": "bar", "points": {"O": ["0 mm", "0 mm"], "P": ["50 mm", "0 mm"]}},
            },
            "joints": {"O": {"links": ["base", "bar"], "pin_diameter": "4 mm"}},
            "pose": {"coordinate": "bar", "angle": "0 deg"},
            "drive": {"link": "bar", "joint": "O"},
            "materials": {"printed": card},
            "parts": {
                "bar": {
                    "shape": "bar",
                    "material": "printed",
                    "width": f"{WIDTH} mm",
                    "thickness": f"{THICKNESS} mm",
                    "fillet_radius": "2 mm",
                    "build_direction": list(normal),
                }
            },
            "load_cases": {"pull": {"forces": [{"link": "bar", "at": "P", "force": [f"{FORCE} N", "0 N"]}]}},
        }
    )


@pytest.fixture(scope="module")
def checked():
    """Layers at 30° to the plane across the bar; two meshes at most."""
    return check_case(
        bar((2.0 * np.cos(ANGLE), 0.0, 2.0 * np.sin(ANGLE))), effort=Effort(max_meshes=2), threads=1
    ).load_cases["pull"]


def test_between_the_ends_the_stress_is_uniaxial(checked):
    """σn = s cos²φ, τ = s sin φ cos φ of s = F/A, in (σn/30)² + (τ/20)² = 1/n²."""
    link = checked.links["bar"]
    x = link.stress.space.nodes[:, 0]
    middle = link.layers.layers.stress(link.stress.nodal[(x > 22.0) & (x < 28.0)])
    s = FORCE / (WIDTH * THICKNESS)
    expected = s * np.hypot(np.cos(ANGLE) ** 2, 30.0 / 20.0 * np.sin(ANGLE) * np.cos(ANGLE))
    assert middle == pytest.approx(np.full_like(middle, expected), rel=0.03)


def test_the_factor_is_strength_over_the_largest_stress_of_all_variants(checked):
    link = checked.links["bar"]
    solid, found = link.solution, link.layers
    peaks = [
        found.layers.stress(stress_field(solid.space, one.displacement, E=solid.E, nu=solid.nu).nodal).max()
        for one in solid.cases
    ]
    assert len(peaks) == 2  # spans of the pins' pressure
    assert found.safety_factor.value == pytest.approx(30.0 / max(peaks), rel=1e-6)
    assert found.safety_factor.low < 30.0 / max(peaks) < 30.0 / min(peaks) <= found.safety_factor.high
    assert np.hypot(found.tension / 30.0, found.shear / 20.0) == pytest.approx(1.0 / found.safety_factor.value)
    assert np.hypot(*found.location[:2]) == pytest.approx(2.0, rel=0.1)  # at the hole
    assert any(source.kind.name == "CONTACT" for source in found.safety_factor.sources)
    assert found.scan.min() <= found.safety_factor.value <= found.scan.max()
    polar, azimuth = round(60.0 / 5.0), 0  # φ is counted from x, the scan's first angle from z
    assert found.scan[polar, azimuth] == pytest.approx(found.safety_factor.value, rel=1e-6)


def test_the_solid_decides_and_the_check_has_a_line(checked):
    assert checked.links["bar"].decided_by == "solid"
    [line] = [check for check in checked.checks if check.quantity is Quantity.LAYERS]
    assert (line.name, line.link, line.limit) == ("layers", "bar", 2.0)
    assert line.verdict is line.quantity.sense.verdict(line.value, line.limit)


def test_hand_calculation_leaves_layers_open():
    by_hand = check_case(bar((0.0, 0.0, 1.0)), fidelity="beam").load_cases["pull"]
    [line] = [check for check in by_hand.checks if check.quantity is Quantity.LAYERS]
    assert (line.verdict, line.value.unknowable) == (Verdict.UNDECIDED, True)


def test_without_a_shear_strength_the_band_reaches_down_to_nothing():
    case = bar((1.0, 0.0, 0.0), shear_strength_between_layers=None)
    found = check_case(case, effort=Effort(max_meshes=1), threads=1).load_cases["pull"]
    layers = found.links["bar"].layers
    assert (layers.safety_factor.low, layers.scan) == (0.0, None)
    assert layers.safety_factor.high > layers.safety_factor.value > 2.0
    [line] = [check for check in found.checks if check.quantity is Quantity.LAYERS]
    assert line.verdict is Verdict.UNDECIDED
    assert "states no shear_strength_between_layers; add it" in told(line.reason)
