"""Friction in bores that couples press: the integral of pressure, and a slider-crank in layers by a frame of its own.

The frame below is a stiffness matrix of twelve by twelve numbers a beam with Lagrange multipliers for what the joints
hold. It shares no code with the program's, nor do its equilibrium and the integral of the pressure.
"""

import math
from functools import cache

import numpy as np
import pytest
import slotted_cases
from edited_cases import edited

from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.rubbing import bore_presses, presses_of
from alula.fea.whole.rubbed_motion import rubbed_motion
from alula.geometry.bodies.features import Ring
from alula.loads.records.load_case import LoadCase
from alula.loads.records.motion_spec import MotionSpec
from alula.loads.statics import foundation
from alula.loads.statics.friction import friction_wrenches
from alula.loads.statics.pressing import pressing

RADIUS, PIN, GUIDE = 2.25, 0.12, 0.15
PAIRS = {"O2": ("base", "crank"), "A": ("crank", "rod"), "B": ("rod", "slider")}
TIGHT = [f'joints.{name}.tight_in=["{one}", "{other}"]' for name, (one, other) in PAIRS.items()]


@pytest.fixture(autouse=True)
def stiff_pins(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pins press linearly here; those that bend in their holes have tests of their own."""
    monkeypatch.setattr(foundation, "STIFF", math.inf)


def numerically(force: complex, moment: complex, walls: list[tuple[float, float]], parts: int = 20001) -> float:
    """Integral of the size of the linear pressure that gives a force and a moment about z = 0, by the midpoint rule."""
    z = np.concatenate([low + (high - low) * (np.arange(parts) + 0.5) / parts for low, high in walls])
    weight = np.concatenate([np.full(parts, (high - low) / parts) for low, high in walls])
    zero, one, two = (float(np.sum(weight * z**k)) for k in range(3))
    # q = a + b z with the resultant a zero + b one = force and i (a one + b two) = moment
    a, b = np.linalg.solve([[zero, one], [one, two]], [force, -1j * moment])
    return float(np.sum(weight * np.abs(a + b * z)))


def test_what_presses_is_the_integral_of_the_size_of_the_pressure() -> None:
    """Of whole walls and of walls with a gap, on and off the plane, with F and M's pressure at any angle."""
    rng, kinds = np.random.default_rng(5), set()
    for i in range(120):
        length, off = float(rng.uniform(1.0, 10.0)), float(rng.normal()) * (i % 2)
        low, high = off - length / 2.0, off + length / 2.0
        gaps = ((off - 0.2 * length, off + 0.1 * length),) if i % 3 == 0 else ()
        ring = Ring(diameter=0.0, low=low, high=high, gaps=gaps)
        force = complex(*rng.normal(size=2))
        moment = complex(*rng.normal(size=2)) * 10.0 ** rng.uniform(-3.0, 2.0)
        if i % 4 == 0:
            moment = 1j * force * float(rng.normal()) * length  # its pressure is along the force
        found = float(pressing(np.array(force), np.array(moment), ring))
        assert found == pytest.approx(numerically(force, moment, list(ring.walls)), rel=1e-7)
        kinds.add(round(found / abs(force)))
    assert {1, 2, 3} < kinds


@pytest.mark.parametrize("turn", [1.0, np.exp(0.7j)])
def test_what_presses_where_force_and_couple_press_along_one_line(turn: complex) -> None:
    """|F| up to a couple of F t/6, and |F| (a/4 + 1/a) with a = 12 M/(F t) beyond; of a couple alone 3 M/t."""
    ring, force, t = Ring(diameter=0.0, low=-2.0, high=2.0), 3.0 * turn, 4.0
    for a in (0.0, 1e-9, 0.5, 1.999, 2.0, 2.001, 5.0, 13.0, 1e6):
        couple = 1j * force * a * t / 12.0
        expected = 3.0 * (a / 4.0 + 1.0 / a) if a > 2.0 else 3.0
        assert float(pressing(np.array(force), np.array(couple), ring)) == pytest.approx(expected, rel=1e-12)
    assert float(pressing(np.array(0j), np.array(7.0 * turn), ring)) == pytest.approx(3.0 * 7.0 / t, rel=1e-12)


def beam(start: np.ndarray, end: np.ndarray, wide: float, thick: float, young: float, poisson: float, round_: bool):
    """Stiffness (12, 12) of a Timoshenko beam in global axes; of a pin the sizes are its diameter."""
    along = end - start
    length = float(np.linalg.norm(along))
    x = along / length
    z = np.array([0.0, 1.0, 0.0]) if round_ else np.array([0.0, 0.0, 1.0])
    axes = np.array([x, np.cross(z, x), z])
    if round_:
        area, i_y = math.pi * wide**2 / 4.0, math.pi * wide**4 / 64.0
        i_z, torsion, shear = i_y, 2.0 * i_y, 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson)
    else:
        area, i_y, i_z = wide * thick, wide * thick**3 / 12.0, thick * wide**3 / 12.0
        r = thick / wide
        torsion = wide * thick**3 * (1.0 / 3.0 - 0.21 * r * (1.0 - r**4 / 12.0))
        shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson)
    g = young / (2.0 * (1.0 + poisson))
    k = np.zeros((12, 12))
    for i, stiff in ((0, young * area / length), (3, g * torsion / length)):
        k[np.ix_([i, i + 6], [i, i + 6])] = stiff * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for deflect, turn, second, sign in ((1, 5, i_z, 1.0), (2, 4, i_y, -1.0)):
        phi = 12.0 * young * second / (shear * g * area * length**2)
        own = young * second / (length**3 * (1.0 + phi)) * np.array([
            [12.0, 6.0 * length, -12.0, 6.0 * length],
            [6.0 * length, (4.0 + phi) * length**2, -6.0 * length, (2.0 - phi) * length**2],
            [-12.0, -6.0 * length, 12.0, -6.0 * length],
            [6.0 * length, (2.0 - phi) * length**2, -6.0 * length, (4.0 + phi) * length**2],
        ])  # fmt: skip
        at, signs = [deflect, turn, deflect + 6, turn + 6], np.array([1.0, sign, 1.0, sign])
        k[np.ix_(at, at)] += own * np.outer(signs, signs)
    turned = np.kron(np.eye(4), axes)
    return turned.T @ k @ turned


class OwnFrame:
    """The slider-crank to start from: nodes 0 to 7 along base, pins, crank, rod and slider; tight pins."""

    def __init__(self, angle: float) -> None:
        a = 40.0 * np.array([math.cos(angle), math.sin(angle)])
        b = np.array([a[0] + math.sqrt(140.0**2 - a[1] ** 2), 0.0])
        o = np.zeros(2)
        rows = [(o, 0.0), (o, 6.5), (o, 6.5), (a, 6.5), (a, 13.0), (a, 13.0), (b, 13.0), (b, 6.5), (b, 6.5)]
        places = [np.array([*xy, z]) for xy, z in rows]
        self.a, self.b = a, b
        aluminium, steel = (68900.0, 0.33), (193000.0, 0.29)
        parts = [
            *((0, 1, steel, True), (2, 3, aluminium, False), (3, 4, steel, True)),
            *((5, 6, aluminium, False), (6, 7, steel, True)),
        ]
        self.stiffness = np.zeros((54, 54))
        self.beams = {}
        for i, j, (young, poisson), round_ in parts:
            sizes = (4.5, 4.5) if round_ else (8.0, 6.0)
            own = beam(places[i], places[j], *sizes, young, poisson, round_)
            at = [*range(6 * i, 6 * i + 6), *range(6 * j, 6 * j + 6)]
            self.stiffness[np.ix_(at, at)] += own
            self.beams[i, j] = at, own
        held = [(6 * 0 + k, None) for k in range(6)]  # the base
        for i, j in ((1, 2), (4, 5), (7, 8)):  # all but the turning about z
            held += [(6 * i + k, 6 * j + k) for k in range(5)]
        held += [(6 * 2 + 5, None)]  # the drive
        held += [(6 * 8 + k, None) for k in range(1, 6)]  # the guide
        self.held = np.zeros((len(held), 54))
        for row, (i, j) in enumerate(held):
            self.held[row, i] = 1.0
            if j is not None:
                self.held[row, j] = -1.0
        self.drive, self.normal = held.index((17, None)), held.index((49, None))

    def solve(self, couples: dict[str, float], along: float):
        """Forces and couples that the holes bear, torque and normal force, under 40 N and what rubs."""
        loads = np.zeros(54)
        loads[48] = -40.0 + along
        for name, (first, second) in {"O2": (0, 2), "A": (3, 5), "B": (6, 8)}.items():
            loads[6 * second + 5] += couples[name]  # of the first link on the second
            loads[6 * first + 5] -= couples[name]
        n = len(self.held)
        scale = 1e4
        matrix = np.block([[self.stiffness, scale * self.held.T], [scale * self.held, np.zeros((n, n))]])
        solved = np.linalg.solve(matrix, np.concatenate([loads, np.zeros(n)]))
        held = -scale * solved[54:]
        ends = {key: own @ solved[at] for key, (at, own) in self.beams.items()}
        holes = {name: [ends[pin][:6], ends[pin][6:]] for name, pin in {"O2": (0, 1), "A": (3, 4), "B": (6, 7)}.items()}
        return holes, held[self.drive], held[self.normal]


@cache
def by_own_frame(degrees: float, sense: float, mu: float = PIN, guide: float = GUIDE) -> tuple[float, dict[str, float]]:
    """Drive torque, and what presses in the bore of each pin that is pressed more, over its force."""
    frame = OwnFrame(math.radians(degrees))
    rod = -sense * frame.a[0] / (frame.b[0] - frame.a[0])
    speed = sense * (-frame.a[1] - frame.a[1] * frame.a[0] / (frame.b[0] - frame.a[0]))  # of the slider
    turns = {"O2": sense, "A": rod - sense, "B": -rod}
    couples, along = dict.fromkeys(turns, 0.0), 0.0
    for _ in range(12):
        holes, torque, normal = frame.solve(couples, along)
        ratios = {}
        for name, ends in holes.items():
            force = float(np.hypot(*ends[0][:2]))
            found = [numerically(complex(*e[:2]), complex(*e[3:5]), [(-3.0, 3.0)], 2001) for e in ends]
            ratios[name] = max(found) / force
            couples[name] = -math.copysign(mu * RADIUS * max(found), turns[name])
        along = -math.copysign(guide * abs(normal), speed)
    return float(torque), ratios


@pytest.mark.parametrize(("degrees", "rod"), [(70.0, -15.0), (285.0, 15.0)])
def test_slider_crank_in_layers_by_a_frame_of_its_own(degrees: float, rod: float) -> None:
    """Drive torque and what presses in all three bores; by the forces alone the torque was 3.5 % less at 285°."""
    entries = [f'pose.angle="{degrees} deg"', f'pose.near.rod="{rod} deg"', *TIGHT]
    statics = solve_case_statics(edited("slider-crank", entries, fits=False))
    for name, sense in (("push forward", 1.0), ("push backward", -1.0)):
        torque, ratios = by_own_frame(degrees, sense)
        assert statics.reactions[name].drive_torque == pytest.approx(torque, rel=2e-4)
        found = presses_of(statics.case, statics.forces[name])
        assert {joint: float(ratio[0]) for joint, ratio in found.items()} == pytest.approx(ratios, rel=0.01)
        assert max(ratios.values()) > 4.0


def test_the_motion_of_the_slider_crank_by_a_frame_of_its_own() -> None:
    """Its greatest drive torque, 1827 N mm where the forces alone made 1766; and that of poses between the frames."""
    moved = rubbed_motion(edited("slider-crank", TIGHT, fits=False))
    for name, sense in (("push forward", 1.0), ("push backward", -1.0)):
        torque, angles = moved.torque[name], np.degrees(moved.motion.angles)
        i = int(np.nanargmax(np.abs(torque)))
        assert abs(torque[i]) == pytest.approx(1827.4, abs=0.5)
        for k in (i, 3, 101, 222):
            own, _ = by_own_frame(float(angles[k]), sense)
            assert torque[k] == pytest.approx(own, abs=2e-4 * 1827.4)


def layered(case, friction: float = 0.1, **changed):
    """A case with friction everywhere, a load in the plane and one across it, and each link in a layer of its own."""
    joints = {
        n: joint.model_copy(update={"friction": friction} | changed.get(n, {})) for n, joint in case.joints.items()
    }
    links = {name: link.model_copy(update={"layer": i}) for i, (name, link) in enumerate(case.links.items())}
    link = case.linkage.moving[-1]
    at = next(iter(case.links[link].points))
    load = LoadCase.model_validate(
        {
            "forces": [{"link": link, "at": at, "force": ["3 N", "-5 N"]}],
            "moments": [{"link": link, "at": at, "moment": "40 N*mm"}],
        }
    )
    motion = MotionSpec.model_validate({"turn": True, "poses": 61})
    return case.model_copy(
        update={
            "joints": joints,
            "links": links,
            "layer_spacing": 6.0,
            "load_cases": {"pull": load},
            "motion": motion,
        }
    )


@pytest.mark.parametrize("tight", [None, 0, 1])
def test_a_pin_rubs_in_the_bore_in_which_it_turns(tight: int | None) -> None:
    """The couple of friction is mu r times the integral, of the link in which it is not tight, else of the larger."""
    case = slotted_cases.slider_crank()
    pins = [name for name, joint in case.joints.items() if joint.type == "revolute"]
    if tight is not None:
        case = layered(case, **{name: {"tight_in": (case.joints[name].links[tight],)} for name in pins})
    else:
        case = layered(case)
    statics, more = solve_case_statics(case), set()
    for name, reactions in statics.reactions.items():
        rubbed = friction_wrenches(statics.loads[name])
        for joint in pins:
            record, second = case.joints[joint], reactions.joints[joint].wrench
            rise = case.linkage.rise(joint)
            first = second.copy()
            first[3:5] += np.array([-rise * second[1], rise * second[0]])  # the force acts so much higher
            pressed = []
            for link, wrench in zip(record.links, (first, second), strict=True):
                part = case.body(link) if case.links[link].part is not None else case.body(_with_part(case, joint))
                half = part.ring(part.pins[0]).thickness / 2.0
                pressed.append(numerically(complex(*wrench[:2]), complex(*wrench[3:5]), [(-half, half)]))
            here = max(pressed) if tight is None else pressed[1 - tight]
            assert abs(rubbed[joint][5]) == pytest.approx(0.1 * record.pin_diameter / 2.0 * here, rel=1e-6)
            more.add(round(here / float(np.hypot(*second[:2])), 1))
    assert max(more) > 1.5


def _with_part(case, joint: str) -> str:
    return next(link for link in case.joints[joint].links if case.links[link].part is not None)


def test_a_pin_that_is_tight_in_both_links_rubs_in_the_bore_on_which_more_presses() -> None:
    """It tilts in neither and turns in one of them; tight in one it rubs in the other. Running it is pressed less."""
    pressed = []
    for stated in ("[]", '["crank", "rod"]', '"crank"', '"rod"'):
        entry = [one for one in TIGHT if ".A." not in one]
        entry += [] if stated == "[]" else [f"joints.A.tight_in={stated}"]
        statics = solve_case_statics(edited("slider-crank", entry, fits=False))
        wrenches = {name: one.wrench[None] for name, one in statics.reactions["push forward"].joints.items()}
        pressed.append(float(bore_presses(statics.case, wrenches)["A"][0]))
    unstated, both, crank, rod = pressed
    assert both == pytest.approx(by_own_frame(70.0, 1.0)[1]["A"], rel=0.01)
    assert both > unstated
    assert min(crank, rod) < max(crank, rod)
