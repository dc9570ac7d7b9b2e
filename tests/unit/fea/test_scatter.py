"""Stated scatter of loads, strength and modulus in every band, and verdicts on what is not known."""

import math
from dataclasses import replace
from importlib.resources import files
from types import SimpleNamespace

import eye_link
import numpy as np
import pytest
from edited_cases import edited
from materials import SOURCED_ENTRIES
from pydantic_core import PydanticCustomError
from solved import by_hand

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, compliance_scatter, of_sum, strength_scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import Verdict
from alula.fea.doubts import load_growth
from alula.fea.judging.linkage import linkage_outcomes
from alula.fea.links.fidelity import decided_by_hand, hand_bands
from alula.fea.motion.envelope import envelope_case
from alula.fea.motion.envelope_outcomes import envelope_outcomes
from alula.fea.nonlinear import large_displacement, rim_growth
from alula.fea.nonlinear.stability import growth
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.refinement import Effort
from alula.fea.solid.layers import Layers, in_worst_direction
from alula.geometry.base.errors import CaseError
from alula.geometry.materials.material import library
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.text.shares import parse_scatter
from alula.reports.sentences import told

STARTER = files("alula.loads") / "cases" / "four-bar.toml"
PLA = library()["pla-fdm-xy"]
FIXED = [  # a material without any range, and without layers
    "materials.own.title=PVC", f'materials.own.density="{PLA.density * 1e12:.9g} kg/m^3"',
    f'materials.own.youngs_modulus="{PLA.youngs_modulus} MPa"', f"materials.own.poissons_ratio={PLA.poissons_ratio}",
    'materials.own.ultimate_strength="33 MPa"', "materials.own.strength=ultimate",
    "materials.own.minimum_safety_factor=6.0", *(f"materials.own.{entry}" for entry in SOURCED_ENTRIES),
    "parts.bar.material=own",
]  # fmt: skip

STIFF = ['parts.bar.width="12 mm"', 'parts.bar.thickness="20 mm"']  # bending grows by nothing under compression


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("case") / "four-bar.toml"
    path.write_text(STARTER.read_text(encoding="utf-8"), encoding="utf-8")
    return str(path)


def checked(path, *overrides, fidelity="beam"):
    [found] = check_case(edited(path, overrides), fidelity=fidelity).load_cases.values()
    return found


@pytest.mark.parametrize(
    ("stated", "ends"),
    [("20 %", (0.8, 1.2)), (0.2, (0.8, 1.2)), ({"low": "90 %", "high": "130 %"}, (0.9, 1.3)), ([0.5, 2], (0.5, 2.0))],
)
def test_scatter_as_people_state_it(stated, ends):
    assert parse_scatter(stated) == pytest.approx(ends)


@pytest.mark.parametrize(
    "stated", ["100 %", "20 N", -0.1, True, {"low": 0.9}, {"low": 1.1, "high": 1.2}, [0, 2], [1, 11], math.nan]
)
def test_what_is_no_scatter(stated):
    with pytest.raises(PydanticCustomError, match="the scatter must be one share below 100 %"):
        parse_scatter(stated)


def test_a_band_is_multiplied_at_its_ends():
    mesh, load = Source(kind=SourceKind.DISCRETISATION), Source(kind=SourceKind.LOAD)
    band = Band(value=2.0, low=1.0, high=4.0, sources=(mesh,))
    found = Scatter(low=0.5, high=3.0, sources=(load,)).on(band)
    assert (found.value, found.low, found.high, found.sources) == (2.0, 0.5, 12.0, (mesh, load))
    assert Scatter(low=0.5, sources=(load,)).on(found).sources == (mesh, load)
    assert Scatter().on(band) is band
    assert strength_scatter(PLA).low == pytest.approx(23 / 33)
    assert strength_scatter(PLA).high == pytest.approx(65 / 33)
    young = PLA.youngs_modulus
    assert (compliance_scatter(PLA).low, compliance_scatter(PLA).high) == pytest.approx((young / 3500, young / 2000))


def test_scatter_does_not_hide_that_a_band_covers_no_error_of_the_model():
    load = Scatter(low=0.5, high=3.0, sources=(Source(kind=SourceKind.LOAD),))
    bare = load.on(Band.exact(2.0, "beam theory alone"))
    assert (bare.low, bare.high, bare.without) == (1.0, 6.0, "beam theory alone")
    assert tuple(map(told, bare.texts)) == ("scatter of the load", "no error of the model: beam theory alone")


def test_strength_and_modulus_ranges_widen_factor_and_displacement(path):
    plain, ranged = (checked(path, *asked, *STIFF).links["rocker"] for asked in (FIXED, ()))
    # What the softest modulus makes of the growth of bending is less than a thousandth here.
    assert ranged.safety_factor.low == pytest.approx(plain.safety_factor.low * 23 / 33, rel=1e-3)
    assert ranged.safety_factor.high == pytest.approx(plain.safety_factor.high * 65 / 33, rel=1e-3)
    ours = ranged.displacement_max
    assert ours.high / ours.value == pytest.approx(
        plain.displacement_max.high / plain.displacement_max.value * PLA.youngs_modulus / 2000, rel=1e-3
    )
    assert "scatter of the strength (23 to 65 MPa)" in {told(one.text) for one in ranged.safety_factor.sources}
    assert any(source.kind is SourceKind.MODULUS for source in ours.sources)


def test_all_effects_of_a_load_scatter_with_it(path):
    asked = [
        *FIXED,
        *STIFF,
        'large_displacement="off"',
        'checks.shear={type="pins", minimum=2.0}',
        'checks.eyes={type="bearing"}',
    ]
    plain, wide = checked(path, *asked), checked(path, *asked, 'load_cases.lift.scatter="20 %"')
    rising = {c.quantity for c in plain.checks if c.quantity.startswith(("displacement", "deflection"))}
    assert len(plain.checks) == len(wide.checks)
    assert {"strength", "shear", "eyes", "buckling"} <= {c.name for c in plain.checks}
    for ours, theirs in zip(wide.checks, plain.checks, strict=True):
        low, high = (0.8, 1.2) if ours.quantity in rising else (1 / 1.2, 1 / 0.8)
        assert ours.value.low == pytest.approx(theirs.value.low * low), ours
        assert ours.value.high == pytest.approx(theirs.value.high * high), ours
        assert "scatter of the load (80% to 120%)" in {told(one.text) for one in ours.value.sources}


def test_hand_calculation_decides_on_the_whole_band():
    what = eye_link.task(1000.0)
    hand = hand_bands(what, what.loads[0], eye_link.beam(what))
    assert decided_by_hand(what, [hand])[0] is not None
    ranged = replace(what, stress_limits=((0.5 * hand.von_mises.low, 1000.0),))
    decision, why = decided_by_hand(ranged, [hand])
    assert decision is None
    assert "(with stated scatter)" in told(why)


def test_layers_are_decided_by_hand_with_all_that_other_causes_make_of_them():
    """The limits of two loads as sharing of couples or play leave them; the second one's lies in its band alone."""
    plain = eye_link.task(1000.0)
    hand = hand_bands(plain, plain.loads[0], eye_link.beam(plain))
    layers = Layers(normal=(0.0, 0.0, 1.0), across=1.0, between=1.0)
    most = in_worst_direction(hand.principal.high, hand.von_mises.high, 1.0)
    loads = plain.loads[0], replace(plain.loads[0], name="other")
    printed = replace(plain, loads=loads, layers=layers, layer_limits=((1.5 * most, 3.0 * most),))

    def found(*lower):
        limits = [{"layers": ((one * most, 3.0 * most),)} for one in lower]
        ranges = {one.name: OpenRanges(limits=of) for one, of in zip(loads, limits, strict=True)}
        return decided_by_hand(printed, [hand, hand], ranges)

    assert found(1.1, 1.1)[0] is not None
    decision, why = found(1.1, 0.9)
    assert decision is None
    assert "layers" in told(why)


def test_hand_calculation_without_calibration_neither_passes_nor_fails(path):
    found = checked(path, *FIXED, 'parts.bar.fillet_radius="0 mm"', 'checks.stiffness.maximum="0.01 mm"')
    asked = [c for c in found.checks if c.name in ("strength", "stiffness")]
    assert len(asked) == 6
    assert {c.verdict for c in asked} == {Verdict.UNDECIDED}
    assert "not calibrated" in told(asked[0].reason)


def test_hand_calculation_decides_in_its_calibrated_bands(path):
    """Beam theory alone has no width: whatever limit lies off its number would be kept or missed."""
    value = checked(path, *FIXED).links["coupler"].displacement_max
    for factor, verdict in ((0.95, Verdict.UNDECIDED), (2.0, Verdict.PASS), (0.1, Verdict.FAIL)):
        found = checked(path, *FIXED, f'checks.stiffness.maximum="{factor * value.value} mm"')
        [outcome] = [c for c in found.checks if (c.name, c.link) == ("stiffness", "coupler")]
        assert outcome.verdict is verdict


MOTION = ["motion.poses=7"]


@pytest.fixture(scope="module")
def coupler(tmp_path_factory):
    text = STARTER.read_text(encoding="utf-8").replace('part = "bar"', "", 1)
    head, _, tail = text.rpartition('part = "bar"')
    path = tmp_path_factory.mktemp("coupler") / "coupler.toml"
    path.write_text((head + tail).replace("own_weight = true", "own_weight = false"), encoding="utf-8")
    return str(path)


def test_more_repetitions_than_the_card_knows_are_not_passed(coupler):
    case = edited(coupler, [*MOTION, "solid.mesh_size=3.0", "checks.strength.minimum=0.01"])
    effort = Effort(max_meshes=1)
    within = envelope_case(case, threads=1, effort=effort, repetitions=2e6)
    beyond = envelope_case(case, threads=1, effort=effort, repetitions=2.1e6)
    [known] = [c for c in within.checks if c.name == "fatigue"]
    assert known.value.value > 0.0
    [outcome] = [c for c in beyond.checks if c.name == "fatigue"]
    assert outcome.verdict is Verdict.UNDECIDED
    assert "ends at 2e+06 cycles" in told(outcome.reason)
    assert beyond.verdict is Verdict.UNDECIDED
    wide = edited(coupler, [*MOTION, "solid.mesh_size=3.0", 'load_cases.lift.scatter="20 %"'])
    scattered = envelope_case(wide, threads=1, effort=effort)
    [ours], [theirs] = (r.links["coupler"].load_cases.values() for r in (scattered, within))
    assert ours.safety_factor.low == pytest.approx(theirs.safety_factor.low / 1.2)
    assert ours.fatigue.stress.high > 1.15 * theirs.fatigue.stress.high
    moved = solve_case_motion(wide)
    assert envelope_outcomes(moved, {}, np.ones(7, dtype=bool)) == []


@pytest.mark.parametrize("repetitions", [math.inf, math.nan, 0.0])
def test_repetitions_are_a_number(coupler, repetitions):
    with pytest.raises(CaseError, match="repetitions: they are"):
        envelope_case(edited(coupler, MOTION), repetitions=repetitions)


@pytest.mark.parametrize(
    ("state", "held", "lost", "eyes", "ends"),
    [
        ("no equilibrium", 0.9, 0.92, Scatter(), (0.9 / 1.25, 1.0)),
        ("unstable", 0.7, 0.72, Scatter(), (0.7 / 1.25, 0.72 / 0.8)),
        ("unstable", 0.7, 0.72, Scatter(low=0.85, high=1.1), (0.7 / 1.25 / 1.1, 1.0)),
        ("deformed", 1.2, 1.22, Scatter(), (1.2 / 1.25, 1.0)),
        ("deformed", 1.3, 1.32, Scatter(), (1.0, 1.0)),
        ("deformed", 1.3, 1.32, Scatter(low=0.85, high=1.1), (1.3 / 1.25 / 1.1, 1.0)),
    ],
)
def test_the_share_that_is_held_covers_load_over_least_stiffness(monkeypatch, state, held, lost, eyes, ends):
    monkeypatch.setattr(large_displacement, "_end", lambda frame, reached: (held, lost))
    found = large_displacement.LargeDisplacement(
        state=state,
        span=1.0,
        held=min(held, 1.0),
        lost=lost,
        buckling=math.inf,
        dead_point=2.0,
        scatter=Scatter(low=0.8, high=1.25),
        eyes=eyes,
        points={},
        links={},
        reason=reason("large_displacement_off"),
        frame=object(),
    )
    band = found.held_share
    assert (band.low, band.high) == pytest.approx(ends, rel=1e-12)
    [outcome] = linkage_outcomes("lift", found, {"link": _Idle()})
    expected = Verdict.PASS if band.low == 1.0 else Verdict.FAIL if band.high < 1.0 else Verdict.UNDECIDED
    assert outcome.verdict is expected


class _Idle:
    """A link on which nothing acts."""

    strength = 1.0

    class worst:  # noqa: N801
        equivalent = 0.0


@pytest.mark.parametrize("order", [("stiff", "soft", "plain"), ("soft", "plain", "stiff"), ("plain", "stiff", "soft")])
def test_what_grows_is_asked_at_the_outer_ends_of_the_load_and_of_the_moduli_of_all_links(monkeypatch, order):
    """The load is 0.9 to 1.2 times its own, one modulus down to half of its own, and another up to twice it."""
    ranges = {"stiff": (1000.0, 2000.0), "soft": (500.0, 1000.0), "plain": None}
    cards = {x: SimpleNamespace(youngs_modulus=1000.0, youngs_modulus_range=ends) for x, ends in ranges.items()}
    case = SimpleNamespace(material_of=cards.get, load_cases={"push": SimpleNamespace(scatter=(0.9, 1.2))})
    asked = []
    monkeypatch.setattr(load_growth, "by_hand_numbers", lambda hands, reactions: ({}, {}, {}, {}))
    monkeypatch.setattr(load_growth._Stated, "at", lambda self, pose, factor: asked.append(factor))
    moved = SimpleNamespace(state="deformed", reactions=None)
    load_growth.growths(case, "push", None, (), moved, None, dict.fromkeys(order))
    assert asked == [pytest.approx(0.9 * 0.5), pytest.approx(1.2 * 2.0)]


def test_what_running_pins_make_of_couples_is_no_growth():
    """Far from buckling stress grows by no more than a shallow toggle's; couples on tight pins would be 3 % more."""
    found, *_ = by_hand("slider-crank").load_cases.values()
    bands = [one.value for one in found.checks if SourceKind.COUPLES in {source.kind for source in one.value.sources}]
    sources = [source for band in bands for source in band.sources if source.kind is SourceKind.GROWTH]
    widths = [source.width for source in sources if source.detail != rim_growth.SOURCE.detail]
    most = growth(found.large_displacement.factor)
    assert most < 1.01
    assert bands
    assert max(widths, default=1.0) < most


def test_what_is_left_of_two_forces_against_each_other_differs_by_what_both_do():
    """10 N of which 10 % more may act, against 6 N that may lack 20 %: 4 N and up to 2.2 N more or less."""
    loads, play = (Source(kind=kind) for kind in (SourceKind.LOAD, SourceKind.PLAY))
    one, other = Scatter(high=1.1, sources=(loads,)), Scatter(low=0.8, sources=(play,))
    left = of_sum([(10.0, one), (6.0, other)], 4.0)
    assert (left.low, left.high) == pytest.approx((1.0 - 2.2 / 4.0, 1.0 + 2.2 / 4.0))
    assert {source.kind for source in left.sources} == {SourceKind.LOAD, SourceKind.PLAY}
    assert of_sum([(10.0, one), (6.0, other)], 1.0).low == 0.0
    assert of_sum([(10.0, one)], 10.0) is one
