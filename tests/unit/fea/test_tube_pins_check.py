"""A tube pulled by pins through its walls, as a case: two walls bear, and hand calculation does not decide."""

import math
import tomllib

import numpy as np
import pytest
from slender_tube import text

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.loads.case.case_file import validate
from alula.reports.sentences import told

PULL, PIN, OUTER, INNER = 120.0, 2.0, 5.0, 2.5


def checked(**entries):
    """The slender tube without eyes, pulled at its pin B."""
    data = tomllib.loads(text(20.0))
    data["parts"]["tube"] = {
        "shape": "tube",
        "material": "pvc-paredes-2018",
        "outer_diameter": "5 mm",
        "inner_diameter": "2.5 mm",
        "eyes": "none",
    } | entries
    data["load_cases"]["tip"]["forces"] = [{"link": "tube", "at": "B", "force": [f"{PULL} N", "0 N"]}]
    data["checks"]["pins"], data["checks"]["bearing"] = {"type": "pins", "minimum": 1.0}, {"type": "bearing"}
    return check_case(validate(data), fidelity="beam").load_cases["tip"]


@pytest.fixture(scope="module")
def plain():
    return checked()


def of(result, name, link):
    return next(check for check in result.checks if check.name == name and check.link == link)


def test_a_pin_bears_on_both_walls(plain):
    assert of(plain, "bearing", "pin O").value.value == pytest.approx(52.0 / (PULL / (PIN * (OUTER - INNER))))


def test_a_plug_bears_as_well():
    found = of(checked(plug_length="8 mm"), "bearing", "pin O")
    assert found.value.value == pytest.approx(52.0 / (PULL / (PIN * OUTER)))


def test_a_pin_bends_otherwise_between_two_walls_than_in_a_plug(plain):
    """Ratio of the largest moments, by sums along the walls: both holes are 5 mm high, side by side, a = 5 mm."""
    z = np.linspace(0.0, OUTER, 100_001)

    def largest(wall):
        second = (wall * (z - OUTER / 2.0) ** 2).mean() * OUTER
        pressure = wall * (1.0 / (wall.mean() * OUTER) - OUTER * (z - OUTER / 2.0) / second)
        shear = 1.0 - np.cumsum(pressure) * z[1]
        return OUTER / 2.0 + (np.cumsum(shear) * z[1]).max()

    walls = abs(z - OUTER / 2.0) > INNER / 2.0
    hollow, solid = of(plain, "pins", "pin O"), of(checked(plug_length="8 mm"), "pins", "pin O")
    assert solid.value.low / hollow.value.low == pytest.approx(largest(walls) / largest(np.ones_like(z)), rel=1e-3)
    assert solid.value.low != pytest.approx(hollow.value.low, rel=0.02)


def test_hand_calculation_says_the_net_section_and_decides_nothing(plain):
    link = plain.links["tube"]
    holes = PIN * (OUTER - INNER)  # two walls, as if they were flat
    net = PULL / (math.pi / 4.0 * (OUTER**2 - INNER**2) - holes)
    assert link.von_mises_max.value == pytest.approx(net, rel=0.05)
    strength = of(plain, "strength", "tube")
    assert strength.verdict is Verdict.UNDECIDED
    assert "pins go through its walls" in told(strength.reason)
