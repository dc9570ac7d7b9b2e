"""Bars of varying width: volume, section forces, frames and columns against closed forms, and what does not fit."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from rocker_case import TOML as ROCKER
from scipy.optimize import brentq
from scipy.special import jv, yv

from alula.fea.beam.column_factor import AxialForce, column_factors
from alula.fea.beam.deflection import deflection
from alula.fea.beam.loads import BeamLoads, PointLoad
from alula.fea.beam.theory import check_beam
from alula.fea.buckling.holding import columns
from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.meshing.mesh import mass_properties, mesh_body
from alula.geometry.meshing.mesh_settings import COARSE
from alula.geometry.parts.part import Bar, Pin, PlainEnd
from alula.loads.case.case_file import validate
from alula.loads.records.applied import PointLoad as Acting

T, L, E, NU = 4.0, 90.0, 2400.0, 0.35
TAPER = ((0.0, 16.0), (L, 8.0))
STEPPED = ((0.0, 8.0), (40.0, 8.0), (60.0, 14.0), (60.0, 20.0))
SQUARE = {"ends": "square", "overhang": "12 mm", "fillet_radius": "0 mm"}


def bar(widths, pins=(("A", 0.0, 4.0), ("B", L, 5.0)), points=(), **entries):
    sizes = {"shape": "bar", "material": "resin", "thickness": f"{T} mm", "fillet_radius": "3 mm"}
    sizes |= {"widths": [[f"{x} mm", f"{width} mm"] for x, width in widths]} | entries
    holes = tuple(Pin(name=name, x=x, y=0.0, diameter=hole) for name, x, hole in pins)
    return Body(part=Bar.model_validate(sizes), pins=holes, ends=points, holes=())


def test_the_volume_is_that_of_lines_steps_and_arcs():
    """Trapezia, less the holes, plus what each fillet fills: r² (tan(φ/2) - φ/2) in a corner of angle π - φ."""
    radius = 2.0
    body = bar(STEPPED, shoulder_radius=f"{radius} mm", **SQUARE)
    check_body(body)
    area = 52.0 * 8.0 + 20.0 * 11.0 + 42.0 * 20.0 - math.pi / 4.0 * (16.0 + 25.0)
    rise = math.atan(3.0 / 20.0)
    for turn in (rise, math.pi / 2.0 - rise):
        area += 2.0 * radius**2 * (math.tan(turn / 2.0) - turn / 2.0)
    assert mass_properties(body).volume == pytest.approx(T * area, rel=1e-7)
    mesh = mesh_body(body, COARSE)
    assert mesh.volume == pytest.approx(T * area, rel=1e-3)
    assert np.ptp(mesh.points[:, 0]) == pytest.approx(L + 24.0)


@pytest.mark.parametrize("widths", [TAPER, ((L, 10.0), (L, 12.0))])
def test_eyes_are_1_6_times_as_wide_as_the_bar_at_their_pin(widths):
    """The outline is the greater of side and circles, by a sum over stations; sharp where they meet."""
    body = bar(widths, fillet_radius="0 mm")
    check_body(body)
    x = np.linspace(-20.0, L + 20.0, 400_001)
    xs, ws = (np.array(column) for column in zip(*widths, strict=True))
    half = np.interp(x, xs + 1e-9 * np.arange(len(xs)), ws) / 2.0 * ((x > 0.0) & (x < L))
    for place in (0.0, L):
        width = max(np.interp(place, xs, ws), *(w for at, w in widths if at == place), 0.0)
        half = np.maximum(half, np.sqrt(np.maximum((0.8 * width) ** 2 - (x - place) ** 2, 0.0)))
    area = 2.0 * np.trapezoid(half, x) - math.pi / 4.0 * (16.0 + 25.0)
    assert mass_properties(body).volume == pytest.approx(T * area, rel=1e-5)


def test_fillets_at_eyes_touch_a_slanted_side():
    """As the fillet between a circle and a line: in polar pieces about the eye's centre, by a ball of that radius."""
    radius, fillet, half = 12.8, 3.0, 8.0  # of the eye at A; half the width there
    sharp, round_ = (mass_properties(bar(TAPER, fillet_radius=f"{f} mm")).volume for f in (0.0, fillet))

    def added(radius, half, slope):
        """Area between circle, line y = half + slope x and the ball that touches both, on one side."""
        x = np.linspace(0.0, 40.0, 2_000_001)
        line = half + slope * x
        norm = math.hypot(1.0, slope)
        place = brentq(lambda c: math.hypot(c, half + slope * c + fillet * norm) - radius - fillet, 0.0, 40.0)
        height = half + slope * place + fillet * norm
        ball = height - np.sqrt(np.maximum(fillet**2 - (x - place) ** 2, 0.0))
        first, last = place * radius / (radius + fillet), place + fillet * slope / norm
        edge = np.maximum(line, np.sqrt(np.maximum(radius**2 - x**2, 0.0)))
        inside = (x > first) & (x < last)
        return np.trapezoid(np.where(inside, ball - edge, 0.0), x)

    slope = (TAPER[1][1] - TAPER[0][1]) / 2.0 / L
    total = 2.0 * (added(radius, half, slope) + added(6.4, 4.0, -slope))
    assert (round_ - sharp) / T == pytest.approx(total, rel=1e-4)


def cantilever(force=1.0, pull=0.0):
    """Held at x = 0, its thick end, by what balances forces at x = L."""
    wrenches = ([-pull, -force, 0, 0, 0, -force * L], [pull, force, 0, 0, 0, 0])
    return BeamLoads(points=tuple(
        PointLoad(point=np.array([x, 0.0, 0.0]), wrench=np.array(w, dtype=float))
        for x, w in zip((0.0, L), wrenches, strict=True)
    ))  # fmt: skip


def tapered_tip(force, young=E, poisson=NU):
    """Of the wedge b(x) = b0 + k x: ∫F (L - x)²/(E I) dx + ∫F/(κ G A) dx, in closed form by u = b(x)."""
    (_, b0), (_, b1) = TAPER
    k = (b1 - b0) / L
    ratio = math.log(b1 / b0)
    # (L - x) = (b1 - u)/k, I = t u³/12: ∫(b1 - u)²/u³ du = -b1²/(2u²) + 2 b1/u + ln u
    integral = -(b1**2) / 2.0 * (1.0 / b1**2 - 1.0 / b0**2) + 2.0 * b1 * (1.0 / b1 - 1.0 / b0) + ratio
    kappa, shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson), young / (2.0 * (1.0 + poisson))
    return 12.0 * force / (young * T * k**3) * integral + force * ratio / (kappa * shear * T * k)


def test_the_tapered_cantilever_and_tie_move_as_their_closed_forms():
    body = bar(TAPER)
    check = check_beam(cantilever(2.0, 30.0), body.part.section, 1.0, NU, body.cuts)
    bent = deflection(
        check.forces, body.part.section, young=E, poisson=NU, line=(0.0, 0.0), cuts=body.cuts
    ).functions.at(L)
    assert bent[1] == pytest.approx(tapered_tip(2.0), rel=5e-4)
    assert bent[0] == pytest.approx(30.0 * L / (E * T * -8.0) * math.log(8.0 / 16.0), rel=5e-4)
    # σ = 6 F (L - x)/(t b²) is largest where b' (L - x) = -b/2: here at the support, since the taper ends at b0/2.
    assert check.bending.max() == pytest.approx(6.0 * 2.0 * L / (T * 16.0**2), rel=5e-3)


def test_a_step_takes_each_section_up_to_it():
    """Two prisms in series, and the stress of the thin one right at the step."""
    body = bar(((30.0, 16.0), (30.0, 8.0)))
    check = check_beam(cantilever(2.0), body.part.section, 1.0, 0.0, body.cuts)
    bent = deflection(
        check.forces, body.part.section, young=E, poisson=0.0, line=(0.0, 0.0), cuts=body.cuts
    ).functions.at(L)
    thick, thin = (T * width**3 / 12.0 for width in (16.0, 8.0))
    bending = 2.0 / (3.0 * E) * ((L**3 - 60.0**3) / thick + 60.0**3 / thin)
    shear = 2.0 / (10.0 / 12.0 * E / 2.0) * (30.0 / (T * 16.0) + 60.0 / (T * 8.0))
    assert bent[1] == pytest.approx(bending + shear, rel=1e-9)
    assert check.bending.max() == pytest.approx(6.0 * 2.0 * 60.0 / (T * 8.0**2), rel=5e-3)


def test_a_tapered_column_buckles_at_its_closed_form():
    """Out of the plane I ∝ b ∝ x: v = √x (A J1(2κ√x) + B Y1(2κ√x)) with κ² = P x/(E I), zero at both ends."""
    body = bar(TAPER)
    _, (second, stretches) = columns(body)
    force = AxialForce(breaks=np.array([0.0, L]), values=np.ones((1, 3, 1)))
    (found,) = column_factors(force, E * second, held=(0.0, L), stretches=stretches)

    def both(kappa):
        near, far = (2.0 * kappa * math.sqrt(x) for x in (L, 2.0 * L))  # from where the width would be none
        return jv(1, near) * yv(1, far) - jv(1, far) * yv(1, near)

    kappa = brentq(both, 0.25, 0.6)
    assert both(0.1) * both(0.25) > 0.0  # the first root
    assert found == pytest.approx(kappa**2 * E * T**3 / 12.0 * 8.0 / L, rel=2e-3)


def test_the_frame_bends_and_stretches_as_the_tapered_cantilever():
    """The rocker is held by the drive at its thick end, and the other links bear nothing."""
    widths = "widths = [['0 mm', '16 mm'], ['60 mm', '8 mm']]"
    text = ROCKER.replace('width = "8 mm"', widths).replace('eye_diameter = "12 mm"\neye_thickness = "4 mm"\n', "")
    text = text.replace('P = ["60 mm"', f'P = ["{L} mm"').replace("'60 mm'", f"'{L} mm'")
    case = validate(tomllib.loads(text.replace('link = "crank", joint = "O2"', 'link = "rocker", joint = "O4"')))
    material, pose = case.material_of("rocker"), case.solve_pose()
    along, across = np.array([*pose.rotation("rocker")[:, 0], 0.0]), np.array([*pose.rotation("rocker")[:, 1], 0.0])
    load = Acting(link="rocker", point="P", wrench=np.array([*(30.0 * along + 2.0 * across), 0.0, 0.0, 0.0]))
    frame = build_frame(case, pose, [load], held=case.drive)
    tip = solve_frame(frame.model).displacements[frame.points["rocker", "P"]][:3]
    young, poisson = material.youngs_modulus, material.poissons_ratio
    assert tip @ across == pytest.approx(tapered_tip(2.0, young, poisson), rel=1e-3)
    assert tip @ along == pytest.approx(30.0 * L / (young * T * 8.0) * math.log(2.0), rel=1e-3)


@pytest.mark.parametrize(
    ("widths", "entries", "message"),
    [
        (((0.0, 8.0), (0.0, 9.0), (0.0, 10.0)), {}, "at most two with one x; remove one"),
        (((9.0, 8.0), (0.0, 9.0)), {}, r"sort them \(x = 0 mm follows 9 mm\)"),
        (TAPER, {"width": "9 mm"}, "width and widths are both stated"),
        ((), {}, "width is missing"),
        ((), {"width": "8 mm", "shoulder_radius": "1 mm"}, "shoulder_radius belongs to widths"),
        (TAPER, {"eye_diameter": "30 mm"}, "1.6 times the width at their pin; leave eye_diameter out"),
        (TAPER, {"eye_thickness": "9 mm"}, "eyes as thick as itself"),
    ],
)
def test_widths_that_cannot_be_read_are_refused(widths, entries, message):
    with pytest.raises(ValueError, match=message):
        bar(widths, **entries)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (bar(STEPPED, shoulder_radius="4 mm"), "fit the step at x = 60 mm of widths, which is 3 mm long: set it to at"),
        (bar(((84.0, 8.0), (84.0, 9.0))), "fillet of the eye at B .* does not touch a straight side .* smaller x"),
        (bar(TAPER, pins=(("A", 0.0, 4.0), ("M", 22.0, 4.0), ("B", L, 5.0))), "the eyes at A and M, .* overlap"),
        (bar(TAPER, pins=(("A", 0.0, 26.0), ("B", L, 5.0))), "less than eye diameter 25.6 mm"),
        (
            bar(STEPPED, pins=(("A", 0.0, 4.0),), points=(PlainEnd(name="P", x=60.0, patch=30.0),)),
            "patch of P runs from x = 30 to 60 mm, over a station",
        ),
    ],
)  # fmt: skip
def test_widths_that_do_not_fit_are_refused(body, message):
    with pytest.raises(CaseError, match=message):
        check_body(body)


def test_arms_slots_and_pins_off_the_axis_are_refused():
    whole = bar(TAPER)
    for changed in ({"slot": 3.0}, {"y": 2.0}, {"y": 30.0, "foot": (0.0, 0.0)}):
        body = replace(whole, pins=(*whole.pins, replace(whole.pins[1], x=45.0, **changed)))
        with pytest.raises(CaseError, match="round pin holes on its axis alone"):
            check_body(body)


@pytest.mark.parametrize("slope", [-0.1, 0.1])
def test_a_load_enters_all_four_sides_of_a_slanted_stretch(slope):
    points = (PlainEnd(name="P", x=60.0, patch=8.0), PlainEnd(name="Q", x=36.0, patch=8.0))
    body = bar(((0.0, 12.0), (60.0, 12.0 + slope * 60.0)), pins=(("A", 0.0, 4.0),), points=points)
    areas = mesh_body(body, COARSE).areas
    for name, middle in (("P", 56.0), ("Q", 36.0)):
        sides = 2.0 * T * 8.0 * math.hypot(1.0, slope / 2.0)
        assert areas[f"end:{name}"] == pytest.approx(2.0 * 8.0 * (12.0 + slope * middle) + sides, rel=1e-9)
