"""Natural frequencies under loads that scatter: their bands hold those under every load of the range."""

import tomllib

import numpy as np
import pytest
from frequency_cases import LEVER

from alula.fea.common.source import SourceKind
from alula.fea.frame.build import build_frame
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import stiffness_parts
from alula.fea.vibration import flexibility_doubt
from alula.fea.vibration.linkage_modes import _Held, frame_modes
from alula.fea.vibration.modes import NaturalModes, ends_between, frequency
from alula.fea.vibration.over_motion import case_frequencies
from alula.loads.case.case_file import validate
from alula.loads.states.actions import acting_loads, placed
from alula.loads.states.masses import part_masses


def pressed(force, scatter=None):
    """The lever without inertia, under a force along it at its tip [N] that pulls, or presses where negative."""
    case = tomllib.loads(LEVER)
    del case["motion"], case["checks"], case["load_cases"]["turning"]["speed"]
    case["load_cases"]["turning"]["forces"] = [{"link": "lever", "at": "T", "force": [f"{force} N", "0 N"]}]
    case["load_cases"]["turning"] |= {} if scatter is None else {"scatter": scatter}
    return validate(case)


def found(force, scatter=None):
    """Its modes."""
    [history] = case_frequencies(pressed(force, scatter)).histories.values()
    return history.lowest.modes


def solved(force):
    """Its lowest frequencies with the softest and the stiffest beams that the doubt leaves."""
    case = pressed(force)
    pose, masses = case.solve_pose(), part_masses(case)
    loads = acting_loads(case, case.load_cases["turning"], placed(pose, 0.0), masses)
    own = _Held(case, "turning", build_frame(case, pose, loads, held=case.pinned_drive, spatial=True), masses)
    for end in (2, 1):
        path = EquilibriumPath(own.model)
        for i, flexible, scatter in own.doubt.doubtful():
            least = flexible[1] * scatter.low + 1e-9 * flexible[0]  # eyes may leave nothing of it
            path.elements.stiffness[i] = np.linalg.inv(flexible[2] * scatter.high if end == 2 else least)
        K, G = stiffness_parts(path, own.held.end_forces, own.guide_forces)
        yield frequency(frame_modes(path, K + G, own.mass, 4).values[0])


def buckling():
    """Force at which the lowest frequency is 0, from two forces: f² falls in proportion but for a change of shape."""
    low, high = 0.0, 1.0
    while found(-high)[0].frequency.value > 0.0:
        low, high = high, 2.0 * high
    for _ in range(12):
        middle = (low + high) / 2.0
        low, high = (middle, high) if found(-middle)[0].frequency.value > 0.0 else (low, middle)
    return low


def test_the_low_end_of_a_pressed_lever_is_that_under_the_largest_load():
    critical = buckling()
    stated, least, most = (found(-s * 0.8 * critical) for s in (1.0, 0.8, 1.2))
    own = found(-0.8 * critical, "20 %")
    for k, mode in enumerate(own):
        assert mode.frequency.value == stated[k].frequency.value
        assert mode.frequency.low <= most[k].frequency.value
        assert mode.frequency.high >= least[k].frequency.value
    assert most[0].frequency.value < 0.5 * stated[0].frequency.value
    [source] = [one for one in own[0].frequency.sources if one.kind is SourceKind.LOAD]
    assert source.width == pytest.approx(least[0].frequency.value / most[0].frequency.value, rel=0.01)


@pytest.mark.parametrize(("share", "scatter"), [(-0.4, 0.2), (-0.6, 0.3), (-0.7, 0.1), (0.5, 0.5)])
def test_the_band_holds_whole_solutions_at_both_ends_of_flexibility_under_every_load(monkeypatch, share, scatter):
    """Bores, which give beside the beams, are rigid here."""
    both = flexibility_doubt.give_of_links
    monkeypatch.setattr(flexibility_doubt, "give_of_links", lambda *args: (both(*args)[0], []))
    force = share * buckling()
    own = found(force, scatter)[0].frequency
    every = np.array([[*solved(s * force)] for s in np.linspace(1.0 - scatter, 1.0 + scatter, 5)])
    assert 0.999 * every.min() <= own.low <= 1.00001 * every.min()
    assert 0.999 * every.max() <= own.high <= 1.002 * every.max()


@pytest.mark.parametrize("scatter", [{"low": "100 %", "high": "130 %"}, {"low": "70 %", "high": "100 %"}, 0.3])
def test_tension_raises_the_high_end(scatter):
    own, stated, least, most = found(40.0, scatter), *(found(s * 40.0) for s in (1.0, 0.7, 1.3))
    down, up = scatter != {"low": "100 %", "high": "130 %"}, scatter != {"low": "70 %", "high": "100 %"}
    for k, mode in enumerate(own):
        low, high = (least if down else stated)[k].frequency.low, (most if up else stated)[k].frequency.high
        assert mode.frequency.low == pytest.approx(low, rel=0.03)
        assert mode.frequency.high == pytest.approx(high, rel=0.03)


def test_the_low_end_is_zero_where_the_lever_may_buckle():
    own, stated = (found(-0.9 * buckling(), scatter)[0].frequency for scatter in (0.2, None))
    assert own.low == 0.0 < stated.low
    assert own.value == stated.value > 0.0


@pytest.mark.parametrize("start", range(40))
def test_bounds_hold_every_eigenvalue_at_every_load_between(start):
    """Loads that press some shapes and pull others: the lowest is highest, and others are least, between the ends."""
    rng = np.random.default_rng(start)
    size, low, high = 6, *((1.0, 1.6), (0.5, 1.0), (0.4, 1.8))[start % 3]
    G = rng.normal(size=(size, size))
    G = G + G.T
    K = np.diag(np.sort(rng.uniform(2.0, 8.0, size)))

    def solved(share):
        return np.linalg.eigh(K + share * G)

    values, vectors = solved(1.0)
    bounds = ends_between(NaturalModes(values=values, vectors=vectors), vectors.T @ G @ vectors, (low, high), 4)
    every = np.array([solved(share)[0][:4] for share in np.linspace(low, high, 301)])
    for k, (least, most) in enumerate(bounds):
        assert least - 1e-9 <= every[:, k].min()
        assert every[:, k].max() <= most + 1e-9
    assert bounds[0][0] == pytest.approx(every[[0, -1], 0].min())
