"""One class is all that a new kind of part needs to be checked, built, meshed and weighed."""

import math
from pathlib import Path

import numpy as np
import pytest
from strip_part import Strip

from alula.fea.beam.calibration import uncalibrated
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.bodies.features import Pin
from alula.geometry.meshing.mesh import COARSE, mesh_body

STRIP = Strip(shape="strip", material="pla", width="10 mm", thickness="3 mm", overhang="6 mm")
HOLES = tuple(Pin(name=name, x=x, y=0.0, diameter=4.0) for name, x in (("A", 0.0), ("B", 50.0)))
BODY = Body(part=STRIP, pins=HOLES, ends=(), holes=())


def test_a_strip_is_built_and_meshed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).resolve().parents[2]))  # the child finds the class there
    mesh = mesh_body(BODY, COARSE)
    assert mesh.volume == pytest.approx(3.0 * (62.0 * 10.0 - 2.0 * math.pi * 4.0), rel=1e-9)
    np.testing.assert_allclose(mesh.centroid, [25.0, 0.0, 0.0], atol=1e-6)
    assert mesh.areas["bore:A"] == pytest.approx(math.pi * 4.0 * 3.0, rel=1e-9)
    assert set(mesh.surfaces) == {f"{kind}:{name}" for kind in ("bore", "top", "bottom") for name in "AB"}


def test_its_own_rule_and_its_features_hold() -> None:
    with pytest.raises(CaseError, match="set overhang above 2 mm"):
        check_body(Body(part=STRIP.model_copy(update={"overhang": 2.0}), pins=HOLES, ends=(), holes=()))
    slotted = Pin(name="S", x=25.0, y=0.0, diameter=3.0, slot=5.0)
    with pytest.raises(CaseError, match="S: a part of shape strip takes no slots"):
        check_body(Body(part=STRIP, pins=(*HOLES, slotted), ends=(), holes=()))


def test_hand_calculation_does_not_decide_on_it() -> None:
    assert uncalibrated(BODY, 0.35)["shape"] == "strip"
