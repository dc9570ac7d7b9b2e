"""A strut between layers bends out of the plane from the first newton: the secant formula, on pins that tilt."""

import math

import numpy as np
import pytest
from bars_in_layers import parallel_bars

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.common.sought import LEFT
from alula.fea.links.link_by_hand import HandStates, link_by_hand
from alula.fea.links.second_order import on_tilting_pins, second_order_loads
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case import Case

WIDE, THICK, LONG, BESIDE = 16.0, 3.0, 100.0, 10.0
"""Of the coupler, 10 mm beside crank and rocker in one layer [mm]."""
OFF = BESIDE - 6.0 / 2.0
"""How far beside the coupler its force acts: at the rims of the holes in crank and rocker, 6 mm long, where pins run
that have tilted no further than these let them; they bear F t/2 of the couple F h [mm]."""


def pressed(share: float, *, running: float | None = None, **of_coupler: float) -> tuple[Case, float]:
    """Parallel bars whose coupler bears this share of its Euler load out of the plane, P, with pins tight in it.

    Elsewhere they are tight in both links. ``running``: their clearance in crank and rocker, where it is stated.
    """
    case = parallel_bars()
    thin = case.parts["bar"].model_copy(update={"width": WIDE, "thickness": THICK, **of_coupler})
    links = {**case.links, "coupler": case.links["coupler"].model_copy(update={"part": "thin"})}
    tight = {n: ("coupler",) if n in "BC" else j.links for n, j in case.joints.items()}
    plays = {n: running if n in "BC" else None for n in case.joints}
    joints = {n: j.model_copy(update={"tight_in": tight[n], "clearance": plays[n]}) for n, j in case.joints.items()}
    case = case.model_copy(update={"parts": {**case.parts, "thin": thin}, "links": links, "joints": joints})
    load = share * math.pi**2 * case.material_of("coupler").youngs_modulus * WIDE * THICK**3 / 12.0 / LONG**2
    # the rocker turns under a force along the coupler, which bears all of it
    push = case.load_cases["lift"].forces[0].model_copy(update={"force": (-load, 0.0)})
    lift = case.load_cases["lift"].model_copy(update={"forces": (push,)})
    return case.model_copy(update={"load_cases": {"lift": lift}}), load


def secant(share: float, load: float) -> float:
    """P/A (1 + e c/r² sec(L/2 √(P/(E I)))) (Timoshenko & Gere, Theory of Elastic Stability, 2nd ed., section 1.11)."""
    growth = 1.0 / math.cos(math.pi / 2.0 * math.sqrt(share))
    return load / (WIDE * THICK) * (1.0 + OFF * THICK / 2.0 / (THICK**2 / 12.0) * growth)


@pytest.mark.parametrize("share", [0.05, 0.15, 0.3])
def test_the_band_of_a_strut_in_layers_holds_the_secant_formula(share: float) -> None:
    case, load = pressed(share, running=0.8)
    statics = solve_case_statics(case)
    loose = statics.forces["lift"].reactions
    acting = link_loads("lift", "coupler", case.body("coupler"), loose, statics.loads["lift"])
    [found, plain] = HandStates(case, "coupler", [on_tilting_pins(case, "coupler", [acting]), (acting,)]).stress
    assert plain == pytest.approx(load / (WIDE * THICK) * (1.0 + OFF * 6.0 / THICK), rel=1e-3)
    assert found == pytest.approx(secant(share, load), rel=1e-3)


def test_the_check_of_a_strut_whose_frame_is_far_from_buckling_knows_it() -> None:
    """Its pins are tight in the frame, which takes bending for small; tilted, they let the strut bend."""
    share = 0.1
    case, load = pressed(share)
    result = check_case(case, fidelity="beam").load_cases["lift"]
    moved, link = result.large_displacement, result.links["coupler"]
    assert moved.state == "small", moved.buckling
    most = secant(share, load)  # scales the largest principal stress; the search may have left some beyond
    assert most * (1.0 - 5e-3) <= link.decisive.high <= most * (1.0 + LEFT)
    [buckling] = [one for one in result.checks if one.name == "buckling" and one.link == "coupler"]
    assert buckling.value.value == pytest.approx(1.0 / share, rel=1e-3)  # pinned, in the weaker plane
    assert buckling.value.low <= 1.0 / share / 3.0 * (1.0 + 1e-3)


def test_a_square_strut_grows_alike_in_both_planes() -> None:
    case, load = pressed(0.3, width=THICK)
    body = case.body("coupler")

    def worst(moments: tuple[float, float], *, tilts: bool) -> float:
        pins = tuple(
            PinLoad(
                name=pin.name,
                centre=np.array([pin.x, 0.0, 0.0]),
                diameter=pin.diameter,
                wrench=sign * np.array([load / 8.0, 0.0, 0.0, 0.0, *moments]),
            )
            for pin, sign in zip(body.pins, (1.0, -1.0), strict=True)
        )
        acting = LinkLoads(name="one", link="coupler", pins=pins)
        [grown] = on_tilting_pins(case, "coupler", [acting])
        if not tilts:
            grown = second_order_loads(case, "coupler", acting, stays=False)
        assert grown.lines  # what stands for the growth
        return link_by_hand(case, "coupler", grown).check.worst.equivalent

    turned = worst((50.0, 0.0), tilts=True)
    assert turned == pytest.approx(worst((0.0, 50.0), tilts=False), rel=1e-9)
    assert turned == pytest.approx(worst((50.0, 0.0), tilts=False), rel=1e-9)
