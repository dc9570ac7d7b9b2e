"""A plate with a waist in tension, against Neuber's stress of a strip between two deep notches.

Two eyes of 24 mm with arcs of 20 mm between them, 3 mm apart at the waist: hyperbolas of the same radius have a stress
concentration factor of 2 (a/r + 1) √(a/r) / ((a/r + 1) atan √(a/r) + √(a/r)) on the mean stress of the waist, of half
width a (Neuber, Kerbspannungslehre, 1937; Pilkey and Pi, Peterson's Stress Concentration Factors, section 2.3.1).
"""

import math

import numpy as np
import pytest

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.refine.refinement import START, Effort, LinkTask, refine_links
from alula.geometry.parts.part import Body, Pin, Plate

FORCE, THICKNESS, HALF, RADIUS = 100.0, 3.0, 1.5, 20.0


def neuber(ratio):
    root = math.sqrt(ratio)
    return 2.0 * (ratio + 1.0) * root / ((ratio + 1.0) * math.atan(root) + root)


@pytest.fixture(scope="module")
def solved():
    sizes = {"shape": "plate", "material": "resin", "thickness": "3 mm", "eye_diameter": "24 mm",
             "fillet_radius": "20 mm"}  # fmt: skip
    apart = 2.0 * math.sqrt((12.0 + RADIUS) ** 2 - (HALF + RADIUS) ** 2)
    pins = tuple(Pin(name=name, x=x, y=0.0, diameter=8.0) for name, x in (("A", 0.0), ("B", apart)))
    acting = tuple(
        PinLoad(name=p.name, centre=np.array([p.x, 0.0, 0.0]), diameter=8.0, wrench=np.array([f, 0, 0, 0, 0, 0]))
        for p, f in zip(pins, (-FORCE, FORCE), strict=True)
    )
    task = LinkTask(
        body=Body(part=Plate.model_validate(sizes), pins=pins, ends=(), holes=()),
        loads=(LinkLoads(name="pull", pins=acting),),
        E=2900.0, nu=0.38, density=1.2e-9, line=("bore:A", "bore:B"), brittle=False,
        stress_limits=(), displacement_limits=(),
    )  # fmt: skip
    return refine_links({"plate": task}, START, Effort(accuracy=0.2, stated=True))["plate"]


def test_the_band_of_the_peak_holds_the_stress_of_the_waist(solved):
    expected = neuber(HALF / RADIUS) * FORCE / (2.0 * HALF * THICKNESS)
    for found in solved.precision:
        assert found.low("von_mises") <= expected <= found.high("von_mises")
        assert found.von_mises.value == pytest.approx(expected, rel=0.02)
        assert found.high("von_mises") < 1.2 * expected
