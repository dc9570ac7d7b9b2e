"""How far a point moves between layers: out of the plane as well, by solids as by beams, and as pins tilt.

An arm on one pin lies h beside its ground, where the pin is built in. A force F along the arm bends the pin as a
cantilever, whose end turns by F h²/(2 E I) (Roark's Formulas for Stress and Strain, 7th ed., table 8.1, case 1a) and
moves by F h³/(3 E I) + F h/(κ G A). So the arm's tip rises by that turn times the arm's length, far more than it moves
along.
"""

import math
import tomllib

import pytest
from bars_in_layers import four_bars

from alula.fea.check.run import check_case
from alula.fea.common.source import COUPLES
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.geometry.bodies.section import ring
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.reports.sentences import told as in_words

HEIGHT, LONG, ALONG, ACROSS = 10.0, 100.0, 20.0, 2.0
ARM = f"""
schema_version = 1
title = "An arm on one pin beside its ground"
layer_spacing = "{HEIGHT} mm"
links.base = {{ ground = true, layer = 0, points = {{ J = ["0 mm", "0 mm"], O = ["0 mm", "50 mm"] }} }}
joints.J = {{ links = ["base", "arm"], pin_diameter = "4 mm", tight_in = ["base", "arm"] }}
pose = {{ coordinate = "arm", angle = "0 deg" }}
drive = {{ link = "arm", joint = "J" }}
solid = {{ mesh_size = 2.0 }}
[links.arm]
layer = 1
part = "bar"
points = {{ J = ["0 mm", "0 mm"], M = ["50 mm", "0 mm"], T = ["{LONG} mm", "0 mm"] }}
end_patch = "4 mm"
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "10 mm"
thickness = "6 mm"
eye_diameter = "12 mm"
fillet_radius = "1 mm"
[load_cases]
pull = {{ forces = [{{ link = "arm", at = "T", force = ["{ALONG} N", "0 N"] }}] }}
side = {{ forces = [{{ link = "arm", at = "T", force = ["0 N", "{ACROSS} N"] }}] }}
[checks]
tip = {{ type = "displacement", link = "arm", at = "T", maximum = "0.1 mm" }}
half = {{ type = "displacement", link = "arm", at = "M", maximum = "0.1 mm" }}
"""


def of_points(found: list[CheckOutcome]) -> dict[str, CheckOutcome]:
    return {one.name: one for one in found if one.quantity is Quantity.DISPLACEMENT}


@pytest.mark.parametrize("fidelity", ["beam", "solid"])
def test_a_point_moves_out_of_the_plane_as_the_pin_bends(fidelity: str) -> None:
    case = validate(tomllib.loads(ARM))
    pin, arm = case.all_materials[case.joints["J"].pin_material], case.material_of("arm")
    section = ring(4.0, 0.0)
    shear = pin.youngs_modulus / (2.0 + 2.0 * pin.poissons_ratio) * section.area
    shear *= section.shear_coefficient(pin.poissons_ratio)
    give = HEIGHT**3 / (3.0 * pin.youngs_modulus * section.i_z) + HEIGHT / shear
    turn = HEIGHT**2 / (2.0 * pin.youngs_modulus * section.i_z)
    result = check_case(case, fidelity=fidelity, threads=1)
    pulled, pushed = (of_points(list(result.load_cases[name].checks)) for name in ("pull", "side"))
    for name, x in (("tip", LONG), ("half", LONG / 2.0)):
        along = ALONG * (give + x / (arm.youngs_modulus * 60.0))
        expected = math.hypot(along, ALONG * turn * x)
        assert expected > 5.0 * along
        assert pulled[name].value.value == pytest.approx(expected, rel=0.01)
        # Solids stretch by what their bores give as well, a thousandth of it all.
        assert 0.999 * pulled[name].value.low <= expected <= 1.001 * pulled[name].value.high
        assert in_words(pulled[name].reason).startswith(
            f"by {'the solid model' if fidelity == 'solid' else 'the frame'}"
        )
    bent = ACROSS * (LONG**3 / (3.0 * arm.youngs_modulus * 500.0) + give)
    assert pushed["tip"].value.value == pytest.approx(bent, rel=0.1)  # in the plane, with shear and eyes


FOUR_BARS = """
[load_cases.push]
forces = [{ link = "rocker", at = "C", force = ["-10 N", "0 N"] }]
[checks.far]
type = "displacement"
link = "rocker"
at = "C"
maximum = "5 mm"
"""


def four_bars_in_layers(*tight: list[str]) -> Case:
    """Parallel bars under two forces; pins A, B, C and D are tight in these links."""
    edits = {'["0 N", "-1 N"]': '["0 N", "10 N"]'}
    pairs = ('"base", "crank"', '"crank", "coupler"', '"coupler", "rocker"', '"base", "rocker"')
    for links, held in zip(pairs, tight, strict=bool(tight)):
        edits[f"[{links}]"] = f"[{links}], tight_in = {held}"
    return four_bars(
        (0, 1, 2, 1), (120.0, 100.0, 120.0, 100.0), near=(0.0, 60.0), start=60.0, end=5.0, more=FOUR_BARS, edits=edits
    )


def test_the_band_of_a_point_holds_pins_that_run_and_pins_that_are_tight() -> None:
    """It once had no upper end: hinges in all holes held the frame so softly that it might have given way."""
    pairs = (["base", "crank"], ["crank", "coupler"], ["coupler", "rocker"], ["base", "rocker"])
    loose, tight = (
        {
            name: of_points(list(one.checks))["far"]
            for name, one in check_case(four_bars_in_layers(*links), fidelity="beam").load_cases.items()
        }
        for links in ((), pairs)
    )
    for name in ("lift", "push"):
        band = loose[name].value
        assert math.isfinite(band.high)
        assert set(COUPLES) <= set(band.sources)
        assert band.low <= tight[name].value.value <= band.high
        assert band.high - band.low > 1.5 * (tight[name].value.high - tight[name].value.low)
        assert tight[name].verdict is Verdict.PASS
