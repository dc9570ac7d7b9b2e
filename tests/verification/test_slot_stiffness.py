"""The stiffness that a slot leaves a bar: frame, hand calculation and column against unit loads, solids and each other.

By unit loads the two flanks are beams built in at the slot's ends; see ``_flexibility``, which shares no code with the
program.
"""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from slotted_lever import slotted_lever

from alula.fea.beam.column_factor import AxialForce, Stretch, column_factors
from alula.fea.beam.cut_free import beam_loads, link_loads
from alula.fea.beam.deflection import deflection
from alula.fea.beam.flanks import flanks_of
from alula.fea.beam.theory import internal_forces
from alula.fea.buckling.buckling import link_factors
from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import Support
from alula.fea.nonlinear.corotational import solve_large_displacement
from alula.fea.nonlinear.stability import buckling_factor
from alula.loads.states.actions import acting_loads
from alula.loads.statics.statics import solve_statics

WIDE, HIGH, THICK, SLOT = 9.9, 10.0, 5.0, 4.0
FIRST, LAST, TIP = 11.0, 51.0, 80.0
"""Flanks from a quarter of the slot's width before its first round end's centre to as much behind its last."""


def loaded(case):
    pose = case.solve_pose()
    return pose, acting_loads(case, case.load_cases["tip"], pose.placement, {})


def frame_of(case):
    pose, loads = loaded(case)
    return build_frame(case, pose, loads, held=case.pinned_drive)


def _flexibility(case, at: float) -> tuple[float, float]:
    """Displacement of the tip under 1 N there with the pin at a place of the slot [mm]; and what the push adds.

    ∫mM/EI of the bar and, over the flanks, of (m - m̄)(M - M̄) with twice one flank's I, and of M̄m̄ with the pair of
    forces; ∫vV/κGA; and the pin's push by half on either flank and half against the other, each built in.
    """
    young, nu = case.material_of("lever").youngs_modulus, case.material_of("lever").poissons_ratio
    shear = young / (2.0 + 2.0 * nu) * 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
    high = (HIGH - SLOT) / 2.0
    own, pair = 2.0 * THICK * high**3 / 12.0, THICK * high * (high + SLOT) ** 2 / 2.0
    back, push = (TIP - at) / at, TIP / at

    def integral(function, places):
        total = 0.0
        for a, b in itertools.pairwise(places):
            nodes, weights = np.polynomial.legendre.leggauss(4)
            total += sum(
                w * (b - a) / 2.0 * function((a + b) / 2.0 + (b - a) / 2.0 * n)
                for n, w in zip(nodes, weights, strict=True)
            )
        return total

    def moment(x):
        return back * x if x < at else TIP - x

    def force(x):
        return back if x < at else 1.0

    breaks = sorted({FIRST, at, LAST})
    length = LAST - FIRST
    kept = integral(moment, breaks) / length * pair / (pair + own)
    solid = [sorted({0.0, min(FIRST, at), FIRST}), sorted({LAST, TIP})]
    bar = THICK * WIDE**3 / 12.0
    found = sum(integral(lambda x: moment(x) ** 2, part) for part in solid) / (young * bar)
    found += sum(integral(lambda x: force(x) ** 2, part) for part in solid) / (shear * WIDE * THICK)
    found += integral(lambda x: (moment(x) - kept) ** 2, breaks) / (young * own) + kept**2 * length / (young * pair)
    found += integral(lambda x: force(x) ** 2, breaks) / (shear * 2.0 * high * THICK)
    a, b = at - FIRST, LAST - at
    one = a**3 * b**3 / (3.0 * young * own / 2.0 * length**3)
    # Under a force the two parts of a beam built in at both ends shear by V = F b²(L + 2a)/L³ and F a²(L + 2b)/L³.
    stiff = shear * high * THICK
    v = np.linalg.solve(
        _built_in(a, young * own / 2.0, stiff) + _turned(_built_in(b, young * own / 2.0, stiff)), [1.0, 0.0]
    )
    assert v[0] > one
    return found, push**2 * v[0] / 2.0


def _built_in(length, bending, shear):
    """Stiffness (2, 2) of a cantilever's end, displacement and rotation, with shear."""
    flexibility = np.array(
        [
            [length**3 / 3.0 / bending + length / shear, length**2 / 2.0 / bending],
            [length**2 / 2.0 / bending, length / bending],
        ]
    )
    return np.linalg.inv(flexibility)


def _turned(stiffness):
    return stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])


@pytest.mark.parametrize("at", [31.0, 22.0])
def test_a_slotted_lever_gives_as_its_flanks_do(at: float) -> None:
    case = slotted_lever(at=at)
    frame = frame_of(case)
    found = frame.at_points(solve_frame(frame.model).displacements)["lever", "H"]
    whole, push = _flexibility(case, at)
    assert -found[1] == pytest.approx(whole + push, rel=1e-9)


def test_without_its_flanks_it_would_be_far_too_stiff() -> None:
    """As much as a slot of a user's bar, 38 mm long and 4 mm wide in 10 mm, takes off."""
    whole, push = _flexibility(slotted_lever(), 31.0)
    young = slotted_lever().material_of("lever").youngs_modulus
    plain = (TIP - 31.0) ** 2 * TIP / (3.0 * young * THICK * WIDE**3 / 12.0)
    assert whole + push > 1.3 * plain


@pytest.mark.parametrize("at", [31.0, 22.0])
def test_by_hand_it_gives_as_much_but_for_what_the_pin_pushes_one_flank_further(at: float) -> None:
    case = slotted_lever(at=at)
    pose, loads = loaded(case)
    body = case.body("lever")
    link = link_loads("tip", "lever", body, solve_statics(pose, case.pinned_drive, loads), loads)
    forces = internal_forces(beam_loads(link, body, 1e-9))
    material = case.material_of("lever")
    bent = deflection(
        forces,
        case.part_of("lever").section,
        young=material.youngs_modulus,
        poisson=material.poissons_ratio,
        line=(0.0, at),
        flanks=flanks_of(body),
    )
    assert -bent.functions.at(TIP)[1] == pytest.approx(_flexibility(case, at)[0], rel=1e-9)


@pytest.mark.parametrize("at", [31.0, 22.0])
def test_a_small_load_moves_the_deformed_shape_as_the_linear_frame(at: float) -> None:
    case = slotted_lever(at=at, force=-1e-4)
    frame = frame_of(case)
    found = solve_large_displacement(frame.model, 2).displacements
    linear = solve_frame(frame.model).displacements
    assert found[: len(linear), 1] == pytest.approx(linear[:, 1], rel=1e-4, abs=1e-12)


def compressed(first: float, last: float, **changes: float) -> tuple[float, float]:
    """Factor of a lever pushed by 1 N at its tip, held at its ends, by the column and by the frame with its flanks."""
    case = slotted_lever(first=first, last=last, at=(first + last) / 2.0, force=0.0, pull=-1.0, **changes)
    section, material = case.part_of("lever").section, case.material_of("lever")
    (slot,) = flanks_of(case.body("lever"))
    force = AxialForce(breaks=np.array([0.0, TIP]), values=np.ones((1, 3, 1)))
    stretch = Stretch(
        first=slot.first, last=slot.last, bending=slot.together.i_z / section.i_z, pair=slot.pair / section.i_z
    )
    (column,) = column_factors(force, material.youngs_modulus * section.i_z, held=(0.0, TIP), stretches=[stretch])
    return float(column), material.youngs_modulus


@pytest.mark.parametrize(("first", "last"), [(12.0, 50.0), (30.0, 50.0), (12.0, 60.0)])
def test_a_slotted_column_buckles_as_by_vianello(first: float, last: float) -> None:
    """By iteration from shape to moment to shape. Short slots sway: their column buckles to either side of the slot."""
    column, young = compressed(first, last)
    high = (HIGH - SLOT) / 2.0
    a, b = first - 1.0, last + 1.0
    bar, own = THICK * WIDE**3 / 12.0, 2.0 * THICK * high**3 / 12.0
    pair = THICK * high * (high + SLOT) ** 2 / 2.0
    x = np.linspace(0.0, TIP, 16001)
    h = x[1] - x[0]
    inside = (x > a) & (x < b)
    shape = np.sin(math.pi * x / TIP) + np.sin(2.0 * math.pi * x / TIP)
    for _ in range(60):
        # The moment of the compressed shape bends the column, which gives the next shape (Vianello).
        kept = np.trapezoid(np.where(inside, shape, 0.0), x) / (b - a) * pair / (pair + own)
        curvature = np.where(inside, (shape - kept) / own, shape / bar) / young
        slope = np.concatenate([[0.0], np.cumsum((curvature[1:] + curvature[:-1]) / 2.0) * h])
        fallen = np.concatenate([[0.0], np.cumsum((slope[1:] + slope[:-1]) / 2.0) * h])
        bent = fallen[-1] * x / TIP - fallen
        factor = np.trapezoid(shape * bent, x) / np.trapezoid(bent * bent, x)
        shape = bent / np.abs(bent).max()
    assert column == pytest.approx(float(factor), rel=2e-3)
    assert column < 0.95 * math.pi**2 * young * bar / TIP**2


def test_the_frame_of_the_same_flanks_buckles_where_the_column_does() -> None:
    """Held at its ends instead of in its slot; so thick that it buckles in its plane. The frame has shear as well."""
    case = slotted_lever(first=12.0, last=66.0, at=39.0, force=0.0, pull=-1.0, thickness=30.0)
    frame = frame_of(case)
    tip = Support(node=frame.points["lever", "H"], dofs=frozenset({"uy", "uz", "rx", "ry"}))
    model = replace(frame.model, guides=(), supports=(*frame.model.supports, tip))
    column, _ = compressed(12.0, 66.0, thickness=30.0)
    found = buckling_factor(model, 8)
    assert found == pytest.approx(column, rel=0.06)
    assert found < column


def test_the_check_of_a_link_takes_its_slot_into_account() -> None:
    """A link on two pins with a slot between them, wide enough to buckle in its plane: far below Euler's load."""
    case = slotted_lever(first=12.0, last=66.0, at=40.0, force=0.0, pull=-1.0, thickness=30.0)
    section, young = case.part_of("lever").section, case.material_of("lever").youngs_modulus
    force = AxialForce(breaks=np.array([0.0, TIP]), values=np.ones((1, 3, 1)))
    (found,) = link_factors(case, "lever", force).value
    # On one pin it is a cantilever (k = 2), whose slot makes it softer.
    assert found < 0.7 * math.pi**2 * young * section.i_z / (2.0 * TIP) ** 2
