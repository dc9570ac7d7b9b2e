"""Plastic paths beside those of CalculiX on the same meshes: as it found them once, and where it is installed now.

``benchmarks/plastic_peers.py`` keeps what it found. What differs is what both leave out of balance, here
1e-4 of the load, whose error in the factor goes with its square.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from calculix_plasticity import calculix_path, our_path, square_eyes, strip

from alula.fea.calculix import program as calculix

KEPT = json.loads((Path(__file__).parents[2] / "benchmarks/results/plastic_peers.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("body", [strip, square_eyes])
def test_the_load_follows_what_calculix_found(body):
    kept, load = KEPT[body.__name__], body()
    states = our_path(load)
    assert load.body.space.unknowns == kept["unknowns"]
    assert [state.control for state in states] == pytest.approx(kept["control"], rel=1e-9)
    assert [state.factor for state in states] == pytest.approx(kept["calculix"], rel=2e-5)
    assert states[-1].factor < 1.01 * states[-2].factor  # it has levelled off


@pytest.mark.skipif(calculix.installed() is None, reason="CalculiX (ccx) is not on PATH")
@pytest.mark.parametrize("hardening", [(), ((0.01, 1.2), (0.05, 1.5))], ids=["perfect", "hardening"])
def test_calculix_follows_the_same_path(hardening):
    load = strip(hardening=hardening)
    states = our_path(load)
    factors, displacements = calculix_path(load, states)
    assert [state.factor for state in states] == pytest.approx(factors, rel=1e-4)
    for state, u in zip(states, displacements, strict=True):
        assert np.abs(state.displacement.reshape(-1, 3) - u).max() < 2e-4 * np.abs(u).max()
