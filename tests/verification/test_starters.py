"""Joint forces and drive torque of the built-in cases to start from, by closed forms: no matrix of equilibrium is made.

Places of joints are found anew by circles; forces by virtual work, instantaneous centres and lines of force.
"""

import math
import re
from cmath import exp, phase, polar

import numpy as np
import pytest
import solved
from edited_cases import PLANAR, tight_pins
from golden import STARTERS

from alula.fea.beam.calibration import uncalibrated
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.fea.standing.case_statics import solve_case_statics
from alula.loads.case.case_file import read_case, read_text
from alula.loads.statics.statics import Reactions


def statics(name: str, *overrides: str) -> dict[str, Reactions]:
    """Reactions of every load case, those of friction's directions too."""
    return dict(solve_case_statics(read_case(name, overrides), name).reactions)


def inplane(found: Reactions, joint: str) -> float:
    """Size of a joint force in the plane: thrusts between layers come on top of it."""
    return math.hypot(*found.joints[joint].force[:2])


def meet(first: complex, radius: float, second: complex, other: float, side: float) -> complex:
    """Where two circles meet: left of the way from the first centre to the second (side 1), or right of it (-1)."""
    apart, way = polar(second - first)
    along = (radius**2 - other**2 + apart**2) / (2.0 * apart)
    return first + (along + 1j * side * math.sqrt(radius**2 - along**2)) * exp(1j * way)


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def crossing(a: complex, b: complex, c: complex, d: complex) -> complex:
    """Where the line through a and b meets that through c and d."""
    return a + (b - a) * cross(c - a, d - c) / cross(b - a, d - c)


def test_four_bar() -> None:
    """The crank's torque by the ratio of angular speeds, by the pole of crank and rocker on the ground."""
    found = statics("four-bar", "load_cases.lift.own_weight=false")["lift"]
    o2, o4 = 0j, 100.0 + 0j
    a = 40.0 * exp(1j * math.radians(40.0))
    b = meet(a, 120.0, o4, 80.0, 1.0)
    pole = crossing(a, b, o2, o4).real
    ratio = pole / (pole - 100.0)  # of the rocker's speed to the crank's
    load = cross((b - o4) * 120.0 / 80.0, -5.0j)
    assert found.driving[0] == pytest.approx(-load * ratio, rel=1e-9)
    coupler = load / cross(b - o4, (b - a) / 120.0)  # its pull on B balances the load's moment about O4
    assert inplane(found, "B") == pytest.approx(abs(coupler), rel=1e-9)


@pytest.mark.parametrize(("direction", "sense"), [("forward", 1.0), ("backward", -1.0)])
def test_slider_crank(direction: str, sense: float) -> None:
    """The rod's line of force touches the friction circles of its pins; the guide rubs by what presses it."""
    found = statics("slider-crank", PLANAR, 'checks={strength={type="safety-factor"}}')[f"push {direction}"]
    circle = 0.12 * 2.25
    a = 40.0 * exp(1j * math.radians(70.0))
    tilt = -math.asin(a.imag / 140.0)
    # Speeds per unit of the crank's: the rod turns backward, the slider goes in, both times the sense.
    rod = -sense * 40.0 * math.cos(math.radians(70.0)) / (140.0 * math.cos(tilt))
    # What crank and slider exert on the rod against its turning in them: couples of the circle times the push.
    couples = -circle * (math.copysign(1.0, rod - sense) + math.copysign(1.0, rod))
    # The rod is pushed at B by S towards A, at an angle `lean` off its axis: 140 S sin(lean) + couples S = 0.
    lean = math.asin(couples / 140.0)
    line = exp(1j * (tilt + lean))  # of the push on the slider, along +x
    inward = -sense  # the slider's speed at this angle of the crank
    normal = abs(line.imag)
    push = 40.0 / (line.real - 0.15 * inward * normal)  # push line.real - 40 - friction against the speed = 0
    assert inplane(found, "A") == pytest.approx(push, rel=1e-9)
    assert inplane(found, "guide") == pytest.approx(push * normal, rel=1e-9)  # its friction is a load
    # On the crank: -S line at A, and the couples at A (against its turning in the rod) and O2 (in the base).
    rubbed = circle * push * (math.copysign(1.0, sense - rod) + math.copysign(1.0, sense))
    torque = -cross(a, -push * line) + rubbed
    assert found.driving[0] == pytest.approx(torque, rel=1e-9)


def test_six_bar() -> None:
    """The flap's moment times the ratio of speeds of each four-bar, by their poles on the lines of their pivots."""
    found = statics("six-bar", "load_cases.wind.own_weight=false")["wind"]
    o2, o4, o6 = 0j, 90.0 + 0j, 190.0 + 15.0j
    a = 30.0 * exp(1j * math.radians(130.0))
    b = meet(a, 90.0, o4, 60.0, 1.0)
    c = o4 + (b - o4) * 90.0 / 60.0
    d = meet(c, 130.0, o6, 60.0, 1.0)
    assert math.degrees(phase(d - o6)) == pytest.approx(97.378, abs=1e-3)
    first, second = crossing(a, b, o2, o4), crossing(c, d, o4, o6)
    ratio = ((first - o2) / (first - o4)).real * ((second - o4) / (second - o6)).real
    load = cross((d - o6) * 100.0 / 60.0, 8.0)
    assert found.driving[0] == pytest.approx(-load * ratio, rel=1e-9)
    connector = load / cross(d - o6, (d - c) / 130.0)
    assert inplane(found, "C") == pytest.approx(abs(connector), rel=1e-9)


def test_finger() -> None:
    """Pull of the tendon and grip at the tip by their arms about both joints, and the rest by lines of force."""
    found = solve_case_statics(read_case("finger"), "finger")
    middle = exp(1j * found.pose.angles["middle"])
    s, d = -3.0 - 5.2j, 22.0 * middle
    q = meet(s, 25.06, d, math.hypot(3.0, 5.2), 1.0)
    turned = (q - d) / (-3.0 + 5.2j)  # x of the distal phalanx
    h, t = d + (3.0 - 8.6j) * turned, d + (23.0 - 3.0j) * turned
    pull, cord = -9.7 - 1.04j - h, 80.0 - 2.4j - t
    pull, grip = 61.6 * pull / abs(pull), 10.0 * (abs(cord) - 58.8) * cord / abs(cord)
    efforts = {spring.name: spring.effort for spring in found.standing["grip"].springs}
    assert efforts["gauge"] == pytest.approx(abs(grip), rel=1e-9)
    coupler = -(cross(h - d, pull) + cross(t - d, grip)) / cross(q - d, (s - q) / 25.06)  # moments about D
    assert coupler > 0.0  # it pulls
    reactions = found.reactions["grip"]
    assert inplane(reactions, "S") == pytest.approx(coupler, rel=1e-8)
    line = coupler * (s - q) / 25.06
    assert inplane(reactions, "D") == pytest.approx(abs(pull + grip + line), rel=1e-8)
    spring = 182.0 + 36.0 * (math.radians(-25.0) - phase(middle))
    assert cross(h, pull) + cross(t, grip) + cross(q, line) + spring == pytest.approx(0.0, abs=1e-5)  # about P
    # At 30 deg one joint bends as far as the other, so that arms about both add up, as the source adds its own.
    assert math.degrees(phase(turned / middle)) == pytest.approx(-30.0, abs=0.2)
    arm, lever = (-(cross(x, force) + cross(x - d, force)) / abs(force) for x, force in ((h, pull), (t, -grip)))
    assert abs(arm / (7.3211 + 9.0) - 1.0) < 0.05
    assert 61.6 * arm == pytest.approx(12.0 * lever + spring, rel=0.003)
    assert abs(grip) == pytest.approx(12.0, abs=0.05)  # of the source


def test_knee() -> None:
    """The load's moment about the instant centre, which lies where the gallery says, decides what holds it."""
    a, b = 31.75 + 0j, -31.75 + 0j
    along = 25.4 * exp(1j * math.radians(-25.0))
    c = meet(b, 90.805, a - along, 95.25, 1.0)
    d = c + along
    centre = crossing(a, d, b, c)
    assert (round(centre.real), round(centre.imag)) == (-48, 120)
    found = solve_case_statics(read_case("knee"), "knee")
    rear = ((c - centre) / (c - b)).real  # its angle by the thigh's: C turns about both centres
    for name, start, end, by_stop in (
        ("heel-strike", 20.0 + 120.0j, -40.0 - 420.0j, True),
        ("late-stance", -60.0 + 120.0j, 150.0 - 400.0j, False),
    ):
        force = 940.0 * (end - start) / abs(end - start)
        held = -cross(start - centre, force) / (1.0 - rear)
        standing, reactions = found.standing[name], found.reactions[name]
        assert (standing.stop == "straight") == by_stop == (held > 0.0)  # the stop pushes counter-clockwise
        told = standing.contact if by_stop else reactions.driving[0]
        assert told == pytest.approx(held, rel=1e-8)
        # Moments about C on the thigh: load, what holds it, and the front plates, which bear along their line.
        front = (cross(start - c, force) + held) / cross(d - c, (d - a) / abs(d - a))
        assert inplane(reactions, "A") == pytest.approx(abs(front), rel=1e-8)


def test_step() -> None:
    """Moments about O and O4: the weight of what is small is left out, the bores of the file are the points."""
    found = statics("step", "load_cases.pull.own_weight=false")["pull"]
    o4 = 80.0 + 0j
    b = o4 + 40.0 * exp(1j * math.radians(80.0))
    a = meet(0j, 30.0, b, 85.0, 1.0)
    load = a / 30.0 * 40.0j
    pull = -cross(load, -30.0j) / cross(a, (b - a) / 85.0)
    assert pull > 0.0
    assert inplane(found, "A") == pytest.approx(pull, rel=1e-6)
    assert found.driving[0] == pytest.approx(-cross(b - o4, -pull * (b - a) / 85.0), rel=1e-6)


def test_pylon() -> None:
    """The clamp bears an oblique line in space; its section N, both bendings and torsion of the line."""
    start, end = np.array([0.0, 400.0, 20.0]), np.array([50.0, -80.0, -20.0])
    force = 1000.0 * (end - start) / np.linalg.norm(end - start)
    held = solve_case_statics(read_case("pylon"), "pylon").reactions["stance"].joints["O"]
    assert held.force == pytest.approx(-force, rel=1e-9)
    assert held.wrench[3:] == pytest.approx(-np.cross(start, force), rel=1e-9)
    bend, twist, turn = np.cross(start, force)
    second = math.pi / 4.0 * (15.0**4 - 12.5**4)
    along = abs(force[1]) / (math.pi * (15.0**2 - 12.5**2)) + math.hypot(bend, turn) * 15.0 / second
    told = solved.by_hand("pylon").load_cases["stance"].links["pylon"].von_mises_max.value
    assert told == pytest.approx(math.hypot(along, math.sqrt(3.0) * twist * 7.5 / second), rel=0.005)


def test_numbers_of_prostheses_have_a_source_or_are_assumed() -> None:
    """What a source gives stands beside its number; what none gives is said to be assumed, once for all."""
    for name in ("finger", "knee", "pylon"):
        told = " ".join(read_case(name).assumptions)
        assert re.search(r"All (other )?dimensions[^.;:]*assumed", told), name
    stated = re.findall(r'"([\d.]+) mm".*# US 5,746,774: ([\d.]+) in', read_text("knee")[0])
    assert [float(inches) for _, inches in stated] == [2.5, 3.75, 3.575, 1.0]
    # Metres of the source, in the frames of its links; its pulley stands 43 mm along and 1.4554 mm below the knuckle.
    finger, pulley = read_text("finger")[0], (0.0333 - 0.043, -0.0025 + 0.0014554)
    for point, of in {"G": pulley, "D": (0.022, 0.0), "H": (0.003, -0.0086), "T": (0.023, -0.003)}.items():
        x, y = re.search(rf'points.{point} = \["(.*) mm", "(.*) mm"\] +# \[1\]', finger).groups()
        assert (float(x), float(y)) == pytest.approx([1000.0 * one for one in of], abs=0.005), point
    shares = [
        float(mm) / float(inches) / 25.4 for mm, inches in stated
    ]  # the shin's pins stand either side of its middle
    assert shares == pytest.approx([0.5, 1.0, 1.0, 1.0])


@pytest.mark.converged
@pytest.mark.parametrize("name", STARTERS)
def test_bands_by_hand_and_by_solids_overlap(name: str) -> None:
    """Wherever hand calculation gives a band; by solids every check is decided to pass, with pins that do not tilt."""
    case = tight_pins(read_case(name))
    by_solids, by_hand = (check_case(case, name=name, fidelity=fidelity) for fidelity in ("solid", "beam"))
    assert by_solids.verdict is Verdict.PASS
    compared = 0
    for load_case, found in by_solids.load_cases.items():
        for link, solid in found.links.items():
            hand = by_hand.load_cases[load_case].links[link]
            if uncalibrated(case.body(link), case.material_of(link).poissons_ratio):
                continue  # plain sections, which decide nothing: what pins and loads may do is all of their bands
            if not hand.safety_factor.low < hand.safety_factor.high:
                continue  # nothing acts on it
            for one, other in (
                (solid.safety_factor, hand.safety_factor),
                (solid.displacement_max, hand.displacement_max),
            ):
                compared += 1
                assert one.low <= other.high, (load_case, link)
                assert other.low <= one.high, (load_case, link)
    assert compared or name == "pylon"  # whose shape no calibration knows
