"""A stepped flat bar in tension: the solid's stress at the shoulder's fillet against Peterson's factor.

W. D. Pilkey, D. F. Pilkey, Peterson's Stress Concentration Factors, 3rd ed., chart 3.2a, for L/H > 1.89 (r/d - 0.15) +
5.5 and, here, 2 ≤ t/r ≤ 20: Kt = C1 + C2 (2t/H) + C3 (2t/H)² + C4 (2t/H)³ on P/(h d), with t the height of the step, H
and d the wide and the narrow width. It is for plane stress and a long shoulder; the fit is to within some percent.
"""

import math

import numpy as np

from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.fea.refine.refinement import START, Effort, LinkTask, refine_links
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.parts.part import Bar, Body, Pin, PlainEnd, Ring

WIDE, NARROW, RADIUS, THICKNESS, PULL, LENGTH, STEP = 16.0, 8.0, 1.5, 4.0, 100.0, 90.0, 50.0


def peterson(high: float, narrow: float, radius: float) -> float:
    """Kt in tension; chart 3.2a."""
    step = (high - narrow) / 2.0
    ratio, share = step / radius, 2.0 * step / high
    assert 2.0 <= ratio <= 20.0
    root = math.sqrt(ratio)
    factors = (
        1.020 + 1.009 * root - 0.048 * ratio,
        -0.065 - 0.165 * root - 0.007 * ratio,
        -3.459 + 1.266 * root - 0.016 * ratio,
        3.505 - 2.109 * root + 0.069 * ratio,
    )
    return sum(factor * share**power for power, factor in enumerate(factors))


def test_the_band_of_a_shoulder_in_tension_holds_the_published_factor() -> None:
    sizes = {
        "shape": "bar",
        "material": "resin",
        "thickness": f"{THICKNESS} mm",
        "fillet_radius": "6 mm",
        "widths": [[f"{STEP} mm", f"{width} mm"] for width in (WIDE, NARROW)],
        "shoulder_radius": f"{RADIUS} mm",
    }
    own = Ring(diameter=30.0, low=-THICKNESS / 2.0, high=THICKNESS / 2.0)
    pin = Pin(name="A", x=0.0, y=0.0, diameter=10.0, ring=own)
    end = PlainEnd(name="P", x=LENGTH, patch=10.0)
    body = Body(part=Bar.model_validate(sizes), pins=(pin,), ends=(end,), holes=())
    check_body(body)
    pull = np.array([PULL, 0.0, 0.0, 0.0, 0.0, 0.0])
    loads = LinkLoads(
        name="pull",
        pins=(PinLoad(name="A", centre=np.zeros(3), diameter=10.0, wrench=-pull),),
        ends=(EndLoad(name="P", point=np.array([LENGTH, 0.0, 0.0]), wrench=pull),),
    )
    task = LinkTask(
        body=body, loads=(loads,), E=69e3, nu=0.33, density=2.7e-9, line=("bore:A", "bore:A"), brittle=False,
        stress_limits=(), displacement_limits=(),
    )  # fmt: skip
    found = refine_links({"tie": task}, START, Effort(accuracy=0.1, stated=True))["tie"]
    precision = found.precision[0]
    expected = peterson(WIDE, NARROW, RADIUS) * PULL / (NARROW * THICKNESS)
    assert precision.low("von_mises") <= expected <= precision.high("von_mises")
    assert precision.high("von_mises") < 1.15 * precision.low("von_mises")
