"""Stress on the layers of printed parts, against closed forms and turned tensors, and what their check says."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from mesh_states import state
from scipy.spatial.transform import Rotation

from alula.fea.common.band import Band
from alula.fea.common.scatter import layer_scatter
from alula.fea.common.verdict import Verdict
from alula.fea.judging.layers import in_any_direction, layer_outcomes
from alula.fea.motion.envelope_outcomes import layer_outcomes as envelope_layers
from alula.fea.motion.envelope_result import LayerEnvelope
from alula.fea.outcomes.layer_stress import LayerStress
from alula.fea.outcomes.limits import layer_limit, layer_limits, layers_of
from alula.fea.solid.layers import Layers, best_directions, build_directions, on_plane
from alula.fea.solid.stress import von_mises
from alula.fea.superposition.peaks import largest, of_stress
from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.coordinate import Coordinate
from alula.geometry.materials.material import library
from alula.loads.case.case_file import read_case
from alula.reports.sentences import told

RNG = np.random.default_rng(7)
PULL = np.array([10.0, 0.0, 0.0, 0.0, 0.0, 0.0])
OWL = "owl-wing-static"


def tensor(sigma):
    xx, yy, zz, xy, yz, xz = sigma
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 70.0, 90.0])
def test_a_bar_in_tension_at_an_angle(degrees):
    """σn = s cos²φ and τ = s sin φ cos φ (Timoshenko, Strength of Materials, part I, section 15)."""
    phi = np.radians(degrees)
    tension, shear = on_plane(PULL, (3.0 * np.cos(phi), 0.0, 3.0 * np.sin(phi)))
    assert tension == pytest.approx(10.0 * np.cos(phi) ** 2, abs=1e-12)
    assert shear == pytest.approx(10.0 * np.sin(phi) * np.cos(phi), abs=1e-12)
    layers = Layers(normal=(np.cos(phi), 0.0, np.sin(phi)), across=12.0, between=8.0)
    n = 12.0 / layers.stress(PULL)
    assert (tension / 12.0) ** 2 + (shear / 8.0) ** 2 == pytest.approx(1.0 / n**2)


def test_any_tensor_on_any_plane_against_the_turned_tensor():
    for sigma, turn in zip(RNG.normal(size=(50, 6)), Rotation.random(50, random_state=1), strict=True):
        turned = turn.as_matrix().T @ tensor(sigma) @ turn.as_matrix()
        tension, shear = on_plane(sigma, turn.as_matrix()[:, 2])
        assert tension == pytest.approx(turned[2, 2])
        assert shear == pytest.approx(np.hypot(turned[0, 2], turned[1, 2]))


def test_compression_neither_helps_nor_harms():
    layers = Layers(normal=(0.0, 0.0, 1.0), across=12.0, between=6.0)
    sheared = np.array([0.0, 0.0, 0.0, 0.0, 3.0, 4.0])
    pressed = sheared + np.array([-50.0, 9.0, -20.0, 7.0, 0.0, 0.0])
    assert layers.stress(sheared) == pytest.approx(12.0 / 6.0 * 5.0)
    assert layers.stress(pressed) == pytest.approx(10.0)
    assert replace(layers, between=None).stress(pressed) == 0.0


def test_without_a_shear_strength_tension_alone_counts():
    layers = Layers(normal=(1.0, 1.0, 0.0), across=12.0, between=None)
    assert layers.stress(PULL) == pytest.approx(5.0)


@pytest.mark.parametrize("between", [None, 20.0, 6.0, 1.0])
def test_no_deviator_of_the_error_is_felt_more_than_the_sensitivity_says(between):
    layers = Layers(normal=(0.0, 0.0, 1.0), across=12.0, between=between)
    sigma = RNG.normal(size=(200_000, 6))
    sigma[:, :3] -= sigma[:, :3].mean(axis=1, keepdims=True)
    felt = layers.stress(sigma / von_mises(sigma)[:, None]).max()
    assert felt <= layers.sensitivity
    assert felt > 0.98 * layers.sensitivity or layers.sensitivity == 1.0


def test_directions_cover_half_the_sphere():
    found = build_directions().reshape(-1, 3)
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.ones(len(found)))
    for vector in RNG.normal(size=(200, 3)):
        assert np.abs(found @ vector).max() > np.cos(np.radians(3.6)) * np.linalg.norm(vector)


def test_the_scan_is_that_of_every_node():
    """So many nodes that most are left out by their bound."""
    fields = [RNG.normal(size=(1700, 6)) * RNG.uniform(0.05, 1.0, size=(1700, 1)) ** 2 for _ in range(2)]
    layers = Layers(normal=(0.0, 0.0, 1.0), across=12.0, between=5.0)
    found = best_directions(fields, layers)
    for i, j in ((0, 0), (5, 11), (18, 0), (18, 71), (9, 40)):
        way = replace(layers, normal=tuple(build_directions()[i, j]))
        assert found[i, j] == pytest.approx(12.0 / max(way.stress(field).max() for field in fields))


def test_layers_along_the_pull_hold_best():
    found = best_directions([PULL[None]], Layers(normal=(1.0, 0.0, 0.0), across=12.0, between=6.0))
    i, j = np.unravel_index(np.argmax(found), found.shape)
    assert abs(build_directions()[i, j, 0]) < 1e-12
    assert found[18, 0] == pytest.approx(1.2)
    assert found.min() < 1.2  # shear is weaker than tension here, so that oblique layers are worse


CARD = library()["pla-fdm-xy"]


def printed(**changed):
    """The owl wing with its tubes printed upright along their length."""
    card = CARD.model_copy(update=changed)
    case = read_case(OWL, ['parts.tube.material="pla-fdm-xy"', "parts.tube.build_direction=[1,0,0]"])
    return case.model_copy(update={"materials": case.materials | {"pla-fdm-xy": card}})


def outcome_of(case, factor, *, decided=True, loaded=True):
    layers = layers_of(case, "AE")
    stress = LayerStress(
        layers=layers or Layers(normal=(1.0, 0.0, 0.0), across=1.0, between=1.0),
        safety_factor=factor,
        location=np.array([1.0, 2.0, -1e-9]),
        tension=3.0,
        shear=4.0,
        discretisation=state("far") if not factor.unknowable else state("singular"),
        scan=None,
    )
    beam = SimpleNamespace(idle=not loaded)
    hand = {"safety_factor": Band.unknown(), "principal_max": Band.unknown(), "von_mises_max": Band.unknown()}
    link = SimpleNamespace(layers=stress if decided and layers else None, beam=beam, **hand)
    [found] = layer_outcomes(case, "weight", {"AE": link})
    assert (found.name, found.limit, str(found.subject)) == ("layers", 3.0, "AE")
    return found


def band(low, high):
    return Band(value=(low + high) / 2.0, low=low, high=high)


@pytest.mark.parametrize(
    ("ends", "verdict"), [((4.0, 5.0), Verdict.PASS), ((2.0, 5.0), Verdict.UNDECIDED), ((1.0, 2.0), Verdict.FAIL)]
)
def test_the_band_decides(ends, verdict):
    found = outcome_of(printed(), band(*ends))
    assert found.verdict is verdict
    assert "x = 1.0, y = 2.0, z = 0.0 mm: 3 MPa of tension across the layers, 4 MPa of shear along them" in told(
        found.reason
    )


@pytest.mark.parametrize(
    ("ends", "verdict"), [((4.0, 5.0), Verdict.UNDECIDED), ((2.0, 5.0), Verdict.UNDECIDED), ((1.0, 2.0), Verdict.FAIL)]
)
def test_without_a_shear_strength_nothing_passes(ends, verdict):
    found = outcome_of(printed(shear_strength_between_layers=None), band(*ends))
    assert found.verdict is verdict
    assert ("states no shear_strength_between_layers; add it" in told(found.reason)) == (verdict is Verdict.UNDECIDED)


def test_what_is_not_known_is_undecided():
    bare = outcome_of(printed(strength_across_layers=None, shear_strength_between_layers=None), band(7.0, 8.0))
    assert bare.verdict is Verdict.UNDECIDED
    assert "states no strength_across_layers; add it" in told(bare.reason)
    by_hand = outcome_of(printed(), band(7.0, 8.0), decided=False)
    assert (by_hand.verdict, by_hand.value.unknowable) == (Verdict.UNDECIDED, True)
    assert "run the solid model" in told(by_hand.reason)
    assert outcome_of(printed(), Band.unknown()).verdict is Verdict.UNDECIDED
    idle = outcome_of(printed(), band(7.0, 8.0), decided=False, loaded=False)
    assert (idle.verdict, idle.value.low) == (Verdict.PASS, np.inf)


@pytest.mark.parametrize("size", [5e-324, 1.0, 1e308])
def test_a_direction_of_any_size_has_unit_length(size):
    case = read_case(OWL, [f"parts.tube.build_direction=[0,{-size},{size}]"])
    assert case.part_of("AE").build_direction == pytest.approx((0.0, -np.sqrt(0.5), np.sqrt(0.5)))
    with pytest.raises(CaseError, match=r"build_direction.*not all zero; write \[0, 0, 1\]"):
        read_case(OWL, ["parts.tube.build_direction=[0,0,0]"])


def test_which_links_are_checked():
    case = printed()
    assert layers_of(case, "AE") == Layers(normal=(1.0, 0.0, 0.0), across=12.0, between=6.0)
    assert layer_limit(case, "AE") == 3.0
    isotropic = read_case(OWL, ['parts.tube.material="pla-fdm-xy"'])
    assert (layers_of(isotropic, "AE"), layer_limits(isotropic, "AE")) == (None, ())
    assert list(layer_outcomes(isotropic, "weight", {"AE": SimpleNamespace()})) == []
    stiff = read_case(OWL, ["parts.tube.build_direction=[1,0,0]", 'checks={s={type="displacement",maximum="1 mm"}}'])
    assert layer_limit(stiff, "AE") is None


@pytest.mark.parametrize("minima", [(2.0, 5.0), (5.0, 2.0)])
def test_layers_have_the_greatest_limit_of_all_checks_of_their_link(minima):
    """And a check of another link has no part in it."""
    asked = [f'c{i}={{type="safety-factor",minimum={least}}}' for i, least in enumerate(minima)]
    asked.append('other={type="safety-factor",minimum=9,links=["CH"]}')
    more = ['parts.tube.material="pla-fdm-xy"', "parts.tube.build_direction=[1,0,0]"]
    case = read_case(OWL, [*more, f"checks={{{','.join(asked)}}}"])
    assert (layer_limit(case, "AE"), layer_limit(case, "CH")) == (5.0, 9.0)
    assert layer_limits(case, "AE")[0][0] == pytest.approx(12.0 / 5.0)


def test_peaks_over_many_loads_are_those_of_all_nodes():
    """Loads of a motion, of which most nodes are left out by their bounds."""
    turn = np.linspace(0.0, 2.0 * np.pi, 61)
    combination = np.array([np.cos(turn), np.sin(turn), 0.3 * np.cos(2.0 * turn)])
    stress = RNG.normal(size=(400, 6, 3)) * RNG.uniform(0.05, 1.0, size=(400, 1, 1))
    layers = Layers(normal=(1.0, 2.0, -0.5), across=12.0, between=5.0)
    found = largest(of_stress(stress, brittle=False, layers=layers), combination)
    every = layers.stress(np.moveaxis(stress @ combination, 1, -1))
    assert found.value == pytest.approx(every.max(axis=0))
    assert np.array_equal(found.node, every.argmax(axis=0))
    tension, shear = on_plane(np.moveaxis(stress, 1, -1), layers.normal)
    assert np.linalg.norm(layers.parts(stress), axis=1) == pytest.approx(np.hypot(tension, 12.0 / 5.0 * shear))


def over_motion(case, factor):
    angles = np.radians([0.0, 45.0])
    motion = SimpleNamespace(coordinate=Coordinate("GF"), angles=angles, progress=np.degrees(angles), instants=None)
    layers = (
        {"weight": LayerEnvelope(safety_factor=factor, pose=1, location=np.zeros(3), fatigue=None, no_fatigue="")}
        if factor
        else {}
    )
    envelope = SimpleNamespace(layers=layers, load_cases={"weight": SimpleNamespace(discretisation=state("singular"))})
    [found] = envelope_layers(SimpleNamespace(case=case, motion=motion), "AE", envelope)
    return found


def test_layers_over_a_motion():
    held = over_motion(printed(), band(4.0, 5.0))
    assert (held.name, held.verdict, held.limit) == ("layers", Verdict.PASS, 3.0)
    assert "at GF = 45 deg" in told(held.reason)
    unknown = over_motion(printed(), None)
    assert (unknown.verdict, unknown.reason) == (Verdict.UNDECIDED, state("singular").reason)
    sheared = printed(shear_strength_between_layers=None)
    assert over_motion(sheared, band(4.0, 5.0)).verdict is Verdict.UNDECIDED
    assert over_motion(sheared, band(1.0, 2.0)).verdict is Verdict.FAIL
    bare = over_motion(printed(strength_across_layers=None, shear_strength_between_layers=None), None)
    assert "states no strength_across_layers; add it" in told(bare.reason)


def test_scatter_of_both_strengths_bounds_the_factor():
    """12 (9 to 24) and 6 (5 to 7) MPa: any pair of them lies between the least and the largest of both factors."""
    ranges = {"strength_across_layers_range": (9.0, 24.0), "shear_strength_between_layers_range": (5.0, 7.0)}
    card = CARD.model_copy(update=ranges)
    scatter = layer_scatter(card)
    assert (scatter.low, scatter.high) == (pytest.approx(0.75), pytest.approx(2.0))
    base = 12.0 / Layers(normal=(1.0, 0.0, 1.0), across=12.0, between=6.0).stress(PULL)
    for across in (9.0, 24.0):
        for between in (5.0, 7.0):
            one = across / Layers(normal=(1.0, 0.0, 1.0), across=across, between=between).stress(PULL)
            assert scatter.low * base <= one <= scatter.high * base
    assert layer_scatter(CARD.model_copy(update=dict.fromkeys(ranges))).sources == ()
    [(low, high)] = layer_limits(printed(**ranges), "AE")
    assert (low, high) == (pytest.approx(4.0 * 0.75), pytest.approx(4.0 * 2.0))


@pytest.mark.parametrize("lost", [0, 1])
def test_without_one_of_both_stresses_the_weakest_direction_bears_nothing_that_is_known(lost):
    case = read_case(OWL, ['parts.tube.material="pla-fdm-xy"'])
    stresses = [Band.exact(5.0), Band.exact(5.0)]
    known = in_any_direction(case, "AE", Band.exact(6.0), *stresses)
    stresses[lost] = Band.unknown()
    found = in_any_direction(case, "AE", Band.exact(6.0), *stresses)
    assert 0.0 < known.low < 6.0
    assert (found.low, found.high) == (0.0, 6.0)
