"""Pins in shear and bending: by hand, and against an integral over the section."""

from collections import defaultdict
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import PLANAR, edited
from materials import SOURCED

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.sought import LEFT
from alula.fea.common.verdict import Verdict
from alula.fea.outcomes.pins import PinStress, crossing, pin_stress, shared_stress, stress_at
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.features import Ring
from alula.geometry.materials.material import Fatigue, library
from alula.loads.case.case_file import read_case
from alula.loads.case.forks import eyes
from alula.loads.records.conditions import Conditions
from alula.loads.statics.joint_reaction import JointReaction

WING = "owl-wing-static"


def eye(height, *gaps):
    """A hole without flat ring, from the gap between the links on."""
    return Ring(diameter=0.0, low=-height / 2.0, high=height / 2.0, gaps=tuple(gaps))


SOLID = eye(4.0)
TUBE = eye(8.0, (-2.5, 2.5))
"""Walls of 1.5 mm, 5 mm apart."""


def reaction(*wrench):
    return JointReaction(joint="A", on="AE", by="AG", wrench=np.array(wrench, dtype=float))


def test_stresses_by_hand():
    """10 N on a 2 mm pin, eyes of 4 mm 1 mm apart: a = 5, c = 7.5, M = 10 (2 + 1 + 16/60 - 64/5400) = 32.548 N mm."""
    found = pin_stress(10.0, 2.0, (SOLID, SOLID), 1.0, poisson=0.3)
    assert found.moment.value == found.moment.high == pytest.approx(32.548, abs=5e-4)
    assert found.moment.low == pytest.approx(5.0)  # 10 N over half of the gap
    assert found.bending.value == pytest.approx(32.548 / 0.785398, abs=5e-3)
    assert found.shear == pytest.approx(10.0 * 6.5**2 / 30.0 * 3.6 / 2.6 / np.pi)
    assert found.equivalent.high == found.equivalent.value == found.bending.value
    assert found.equivalent.low == pytest.approx(np.sqrt(3.0) * 10.0 * 3.6 / 2.6 / np.pi)


def test_two_eyes_of_four_millimetres_without_a_gap():
    """Both bearing linearly alike make 4/27 F t = 0.593 F; one taking the couple 2.315 F, from the integrals of q."""
    t, x = 4.0, np.linspace(0.0, 4.0, 400_001)
    alike = np.cumsum((6.0 * x / t - 2.0) / t) * x[1]
    assert np.abs(np.cumsum(alike) * x[1]).max() == pytest.approx(4.0 / 27.0 * t, rel=1e-4)
    taking = 1.0 - np.cumsum((1.0 + 6.0 * (1.0 - 2.0 * x / t)) / t) * x[1]  # the couple F t beside the even F/t
    largest = (t / 2.0 + np.cumsum(taking) * x[1]).max()
    found = pin_stress(1.0, 1.5, (SOLID, SOLID))
    assert found.moment.high == pytest.approx(largest, rel=1e-4)
    assert found.moment.low == 0.0
    assert found.moment.low < 4.0 / 27.0 * t < found.moment.high


def on_foundations(eyes, gap, stiffness, tilting):
    """Largest moment and shear in a pin on two elastic foundations under 1 N, by beam elements (EI = 1).

    The first eye is pushed by 1 N in its middle; it turns freely with its link (``tilting``) or keeps its direction.
    """
    steps = 30
    second = eyes[0].height + gap
    walls = [(low - hole.low + start, high - hole.low + start)
             for hole, start in zip(eyes, (0.0, second), strict=True) for low, high in hole.walls]  # fmt: skip
    marks = sorted({place for wall in walls for place in wall})
    x = np.concatenate([[0.0], *(np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(marks))])
    n = len(x)
    k = np.zeros((2 * n + 2, 2 * n + 2))  # last two: displacement of the first eye's middle, and its turn
    elements, beside = [], defaultdict(list)
    points, weights = np.polynomial.legendre.leggauss(4)
    for i, h in enumerate(np.diff(x)):
        dofs = np.arange(2 * i, 2 * i + 4)
        b = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                      [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]) / h**3  # fmt: skip
        k[np.ix_(dofs, dofs)] += b
        elements.append((dofs, b))
        middle = (x[i] + x[i + 1]) / 2.0
        if not any(low < middle < high for low, high in walls):
            continue
        for point, weight in zip((points + 1.0) / 2.0, weights / 2.0, strict=True):
            row = np.zeros(6)
            row[:4] = [1 - 3 * point**2 + 2 * point**3, h * (point - 2 * point**2 + point**3),
                       3 * point**2 - 2 * point**3, h * (point**3 - point**2)]  # fmt: skip
            if middle < eyes[0].height:
                row[4:] = -1.0, -(x[i] + h * point - eyes[0].height / 2.0)
            places = np.array([*dofs, 2 * n, 2 * n + 1])
            k[np.ix_(places, places)] += stiffness * weight * h * np.outer(row, row)
            beside[i].append((places, row, stiffness * weight * h))
    free = np.arange(2 * n + (2 if tilting else 1))
    load = np.zeros(2 * n + 2)
    load[-2] = 1.0
    moved = np.zeros(2 * n + 2)
    moved[free] = np.linalg.solve(k[np.ix_(free, free)], load[free])
    moments, shears = [0.0], [0.0]
    for i, (dofs, b) in enumerate(elements):
        own = b @ moved[dofs]
        for places, row, weight in beside[i]:
            own = own + weight * row[:4] * (row @ moved[places])
        moments += [-own[1], own[3]]
        shears += [own[0], -own[2]]
    return np.abs(moments).max(), np.abs(shears).max()


@pytest.mark.parametrize(
    ("eyes", "gap"),
    [
        ((SOLID, SOLID), 0.0),
        ((eye(7.0), eye(3.0)), 0.0),
        ((eye(2.0), eye(5.0)), 1.5),
        ((eye(3.0), eye(3.0)), 12.0),
        ((TUBE, SOLID), 0.5),
        ((TUBE, TUBE), 0.0),
    ],
)
def test_pins_on_elastic_foundations_lie_in_the_band(eyes, gap):
    """Softest to stiffest pin, links that tilt and links that do not: a stiff pin in a tilting link reaches the end.

    Beside a tube, a pin that is not quite stiff reaches up to 0.7 % more.
    """
    reached, beyond = [], 1.01 if eyes[0].gaps else 1.001
    for turned in dict.fromkeys((eyes, eyes[::-1])):
        for stiffness in (1e-5, 1e-2, 1.0, 100.0):
            for tilting in (True, False):
                moment, shear = on_foundations(turned, gap, stiffness, tilting)
                found = pin_stress(1.0, 1.0, eyes, gap)
                assert found.moment.low * 0.999 <= moment <= found.moment.high * beyond
                if stiffness == 1e-5:
                    assert shear <= found.shear * np.pi / 4.0 * 2.6 / 3.6 * beyond
                reached.append(moment)
    assert max(reached) == pytest.approx(found.moment.high, rel=8e-3 if eyes[0].gaps else 2e-3)


def test_bending_stress_carries_its_moment():
    """Integrate σ = σ_max y/r over the circle: the moment comes back."""
    found = pin_stress(7.0, 1.5, (eye(6.0), eye(6.0)))
    r = 0.75
    y = np.linspace(-r, r, 200_001)
    width = 2.0 * np.sqrt(np.maximum(r**2 - y**2, 0.0))
    assert np.trapezoid(found.bending.value * y**2 / r * width, y) == pytest.approx(found.moment.value, rel=1e-6)


def test_a_short_pin_shears_before_it_bends():
    found = pin_stress(10.0, 2.0, (eye(0.1), eye(0.1)))
    assert found.bending.high < np.sqrt(3.0) * found.shear
    assert found.equivalent.high == pytest.approx(np.sqrt(3.0) * found.shear)
    assert found.equivalent.high == pytest.approx(found.equivalent.low * 25.0 / 24.0)  # V = -F (c - 1)²/(4 c), c = 6


def test_the_eyes_of_a_joint_are_those_of_its_links():
    assert [hole.thickness for hole in eyes(read_case(WING, [PLANAR]), "B")] == [7.0, 7.0]
    stated = eyes(edited(WING, [PLANAR, 'links.AG.thickness="9 mm"']), "A")
    assert sorted((hole.low, hole.high) for hole in stated) == [(-4.5, 4.5), (-3.5, 3.5)]
    # The ground has no part: its eye is taken as thick as that of AE.
    assert (
        stress_at(edited(WING, [PLANAR, 'joints.A.pin_gap="0.4 mm"']), "A", {"A": reaction(1, 0, 0, 0, 0, 0)}).lever
        == 7.4
    )
    two = [
        'parts.thick={shape="tube",material="pvc-u",outer_diameter="5 mm",inner_diameter="2.5 mm",'
        'eye_diameter="8 mm",eye_thickness="9 mm",fillet_radius="0.8 mm"}',
        'links.AE.part="thick"',
    ]
    assert sorted(hole.thickness for hole in eyes(edited(WING, two), "B")) == [7.0, 9.0]


def test_moments_out_of_the_plane_add():
    case = read_case(WING, [PLANAR])
    plain, turned, more = (
        stress_at(case, "A", {"A": reaction(*wrench)})
        for wrench in ((3, 4, 0, 0, 0, 99), (3, 4, 9, 6, 8, 0), (3, 4, 9, 60, 80, 0))
    )
    assert turned.moment.value == pytest.approx(plain.moment.value + 10.0)
    # The eyes' couple makes up to 5 N x 3.5 mm in the middle, which may take off all of these 10 N mm, not all of 100.
    assert turned.moment.low == plain.moment.low == 0.0
    assert more.moment.low == pytest.approx(100.0 - 17.5)


@pytest.mark.parametrize(("force", "over"), [(0.0, 1.000001), (200.0, 1.12)])
def test_a_moment_out_of_the_plane_shears_the_pin(force, over):
    """An eye bears it linearly: 3 M/(2 t) where no force acts; beside a force the sum of both is no less than all."""
    eyes, moment = (Ring(diameter=6.0, low=-1.0, high=1.0), Ring(diameter=6.0, low=-1.5, high=1.5)), 1000.0
    z = np.linspace(0.0, 2.0, 200_001)
    couple = force * 2.5 + moment
    shear = force * (1.0 - z / 2.0) - couple * 6.0 * z * (2.0 - z) / 8.0
    most = np.abs(shear).max() * 3.6 / 2.6 * 4.0 / (np.pi * 36.0)
    found = pin_stress(force, 6.0, eyes, moment=moment, poisson=0.3)
    assert most * (1.0 - 1e-6) <= found.shear <= over * most


def test_the_wings_pins_pass_and_thin_ones_fail():
    off = 'large_displacement="off"'  # the wing gives way under this load

    def checked(*entries, fits=False):
        case = edited(WING, [PLANAR, off, *entries], fits=fits)
        return [c for c in check_case(case, name=WING, fidelity="beam").load_cases["weight"].checks if c.name == "pins"]

    pins = checked()
    assert [c.link for c in pins] == [f"pin {name}" for name in "ABCDEFG"]
    assert all(c.verdict is Verdict.PASS and c.limit == 2.0 for c in pins)
    # A: 0.9520 N in eyes of 7 mm, 7 (1/2 + 1/12 - 1/216) N mm, over pi 1.5^3/32 = 0.33134 mm^3, against 1330 MPa.
    assert pins[0].value.value == pytest.approx(1330.0 / (0.9520 * 7.0 * 125.0 / 216.0 / 0.33134), rel=1e-3)
    # At least shear: 0.9520 N x 1.3876 (nu = 0.29) over 1.7671 mm^2, times root 3.
    assert pins[0].value.high == pytest.approx(1330.0 / (1.73205 * 0.9520 * 1.3876 / 1.7671), rel=1e-3)
    # As stated they have play, which lets their forces be others: the same factors in wider bands.
    loose = checked(fits=True)
    assert [c.verdict for c in loose] == [Verdict.PASS] * 7
    assert [c.value.value for c in loose] == pytest.approx([c.value.value for c in pins])
    for own, plain in zip(loose, pins, strict=True):
        assert 0.8 * plain.value.low < own.value.low < plain.value.low
        assert plain.value.high < own.value.high < 1.25 * plain.value.high
    for minimum, verdict in ((500.0, Verdict.UNDECIDED), (2000.0, Verdict.FAIL)):
        (one,) = checked(f'checks.pins={{type="pins",minimum={minimum},joints=["A"]}}', fits=True)
        assert (one.verdict, one.subject.long) == (verdict, "pin A")


@pytest.mark.parametrize(
    ("overrides", "sentence"),
    [
        (['joints.B.pin_material="tin"'], r"joints\.B\.pin_material: 'tin' is unknown; choose one of .*steel-wire"),
        (['checks.pins.joints=["Z"]'], r"checks\.pins\.joints: 'Z' is no revolute joint .*choose one of A, B"),
        (['joints.B.pin_gap="-1 mm"'], r"joints\.B\.pin_gap .*must not be negative"),
        (["checks.pins.minimum=0.0"], r"checks\.pins.*minimum"),
        (
            [
                'materials.tin={title="tin",density="7 g/cm^3",youngs_modulus="50 GPa",poissons_ratio=0.3,'
                'yield_strength="10 MPa",strength="yield",' + SOURCED + "}",
                'joints.B.pin_material="tin"',
            ],
            r"checks\.pins\.minimum: it is missing, and 'tin', the material of the pin at joint 'B', states no",
        ),
    ],
)
def test_what_is_wrong_with_a_pin(overrides, sentence):
    with pytest.raises(CaseError, match=sentence):
        edited(WING, overrides)


@pytest.mark.parametrize(
    ("diameter", "least"),
    [
        (0.3, 169e3 * 0.0118**-0.146),
        (1.5, 169e3 * 0.0591**-0.146),
        (3.0, 128e3 * 0.118**-0.263),
        (6.0, 90e3 * 0.236**-0.478),
    ],
)
def test_a_thicker_pin_of_drawn_wire_is_weaker(diameter, least):
    """Shigley, 9th ed., table 10-4, A313 type 302: S = A/d^m in psi and inches."""
    material = edited(WING, [f'joints.A.pin_diameter="{diameter} mm"']).pin_material("A")
    assert material.ultimate_strength == pytest.approx(least * 6.894757e-3, rel=0.035)
    assert material.allowable == pytest.approx(1330.0 / 1779.0 * material.ultimate_strength)


def test_a_warm_pin_of_drawn_wire_has_both_factors():
    """Of a card of its own, whose fatigue and lasting strength are those of thin wire."""
    lasts = Fatigue.model_validate({"stress": "600 MPa", "cycles": 1e6, "source": "made up"})
    half = ((20.0, 1.0), (300.0, 0.5))
    card = library()["steel-wire"].model_copy(
        update={"temperature_factors": half, "sustained_stress": 1000.0, "fatigue": lasts}
    )
    case = edited(WING, ['joints.B.pin_diameter="3 mm"', 'joints.B.pin_material="steel-wire"'])
    cold = case.model_copy(update={"materials": case.materials | {"steel-wire": card}})
    warm = cold.model_copy(update={"conditions": Conditions(temperature="300 degC")})
    found, before = warm.pin_material("B"), cold.pin_material("B")
    assert found.allowable == pytest.approx(0.5 * before.allowable)
    assert before.allowable < card.allowable
    share = before.allowable / card.allowable
    assert before.sustained_stress == pytest.approx(1000.0 * share)
    assert before.fatigue.stress == pytest.approx(600.0 * share)


def test_a_pin_thicker_than_any_wire_of_its_card_is_refused():
    with pytest.raises(CaseError, match=r"^joints\.A\.pin_diameter: 12 mm is thicker than .*; set at most 11\.1\d* mm"):
        library()["steel-wire"].drawn("joints.A.pin_diameter", 12.0)


@pytest.mark.parametrize("forces", [(10.0, 30.0, 20.0), (30.0, 20.0, 10.0)])
def test_between_eyes_the_least_force_of_all_states_crosses_at_least(forces):
    case = read_case(WING)
    every = [{"A": reaction(0.6 * force, 0.8 * force, 0, 0, 0, 0)} for force in forces]
    least = crossing(case, "A", [{"A": reaction(6, 8, 0, 0, 0, 0)}])
    assert crossing(case, "A", every) == pytest.approx(least)
    assert least > 0.0


@pytest.mark.parametrize("worst", [0, 1, 2])
def test_a_pin_between_layers_has_the_widest_of_all_ways_in_which_couples_are_shared(monkeypatch, worst):
    """Shares of 2 N are 1 and, of three ways, two and one of 3: of bending, and of the shear that is told.

    The search may have left a tenth of what lies between beyond either end, but no less than crosses between the eyes.
    """
    sizes = [0.5, 1.2, 0.8]
    sizes[worst] = 3.0

    def at(size):
        bands = {name: Band.exact(10.0 * size) for name in ("moment", "bending", "equivalent")}
        return PinStress(lever=1.0, shear=size, **bands)

    def ways(size):
        return SimpleNamespace(joints={"B": SimpleNamespace(wrench=size)})

    least = 15.0
    for name, instead in (
        ("stress_at", lambda case, joint, of: at(of[joint].wrench)),
        ("stresses", lambda case, joint, every: [at(one) for one in every[joint]]),
        ("crossing", lambda *_: least),
        ("between_layers", lambda *_: True),
        ("joints_of_pin", lambda case, joint: (joint,)),
    ):
        monkeypatch.setattr(f"alula.fea.outcomes.pins.{name}", instead)
    forces = SimpleNamespace(reactions=ways(2.0), sharings=[ways(2.0 * size) for size in sizes])
    found = shared_stress(None, "B", ways(4.0).joints, forces)
    beyond = LEFT * (3.0 - min(sizes))
    assert found.shear == pytest.approx(4.0 * (3.0 + beyond))
    for name in ("moment", "bending", "equivalent"):
        band, low = getattr(found, name), 40.0 * (min(sizes) - beyond)
        low = max(low, least) if name == "equivalent" else low
        assert (band.value, band.low, band.high) == pytest.approx((40.0, low, 40.0 * (3.0 + beyond)))
        assert [source.width for source in band.sources] == pytest.approx([band.high / band.low])


def test_no_state_of_a_pin_between_layers_bears_less_than_its_force_in_shear():
    """Love's largest shear stress of a circle, (3 + 2 nu)/(2 + 2 nu) of the mean."""
    case = edited("slider-crank", [])
    result = check_case(case, fidelity="beam").load_cases["push forward"]
    for joint, pin in result.pins.items():
        record = case.joints[joint]
        nu, area = case.all_materials[record.pin_material].poissons_ratio, np.pi * record.pin_diameter**2 / 4.0
        force = np.hypot(*result.forces.reactions.joints[joint].wrench[:2])
        least = np.sqrt(3.0) * (3.0 + 2.0 * nu) / (2.0 + 2.0 * nu) * force / area
        assert pin.equivalent.low >= least * (1.0 - 1e-9), joint
