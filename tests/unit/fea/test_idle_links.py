"""Links on which nothing acts as stated: what pins, play and couples may make of them, and no trouble by rounding."""

import math
import tomllib
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.check.run import check_case
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter, differing
from alula.fea.common.source import COUPLES, Source, SourceKind
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.doubts.other_case import Doubt
from alula.fea.superposition.link_answers import widest
from alula.fea.vibration.harmonics import nearest_harmonic
from alula.loads.case.case_file import validate

PARALLELOGRAM = """
schema_version = 1
title = "A rocker that is pulled along"
links.base = { ground = true, points.O2 = ["0 mm", "0 mm"], points.O4 = ["100 mm", "0 mm"] }
links.crank = { part = "thin", points.O2 = ["0 mm", "0 mm"], points.A = ["80 mm", "0 mm"] }
links.coupler = { part = "bar", points.A = ["0 mm", "0 mm"], points.B = ["100 mm", "0 mm"] }
links.rocker.part = "bar"
links.rocker.points = { O4 = ["0 mm", "0 mm"], B = ["80 mm", "0 mm"], P = ["120 mm", "0 mm"] }
joints.O2 = { links = ["base", "crank"], pin_diameter = "3 mm", clearance = "0.2 mm" }
joints.A = { links = ["crank", "coupler"], pin_diameter = "3 mm", clearance = "0.2 mm" }
joints.B = { links = ["coupler", "rocker"], pin_diameter = "3 mm", clearance = "0.2 mm" }
joints.O4 = { links = ["base", "rocker"], pin_diameter = "3 mm", clearance = "0.2 mm" }
pose = { coordinate = "crank", angle = "90 deg", near = { coupler = "0 deg", rocker = "90 deg" } }
drive = { link = "crank", joint = "O2" }
checks.strength = { type = "safety-factor", minimum = 1.5, links = ["crank", "rocker"] }
load_cases.lift.forces = [{ link = "rocker", at = "P", force = [FORCE] }]
[parts.bar]
shape = "bar"
material = "aluminium-6061-t6"
width = "8 mm"
thickness = "4 mm"
fillet_radius = "2 mm"
[parts.thin]
shape = "bar"
material = "aluminium-6061-t6"
width = "4 mm"
thickness = "0.5 mm"
fillet_radius = "1 mm"
eye_diameter = "8 mm"
eye_thickness = "4 mm"
"""


def factors(force):
    """Safety factors by hand: link -> outcome."""
    found = check_case(validate(tomllib.loads(PARALLELOGRAM.replace("FORCE", force))), name="rocker", fidelity="beam")
    [load_case] = found.load_cases.values()
    return {str(one.subject): one for one in load_case.checks if one.quantity is Quantity.SAFETY_FACTOR}


def test_play_may_load_a_link_that_bears_nothing_as_stated():
    """With a force that is hardly off, its band has a low end: the exact case must not be known better."""
    exact, off = factors('"0 N", "500 N"'), factors('"0.05 N", "500 N"')
    assert exact["crank"].value.value == math.inf
    assert exact["crank"].value.low <= off["crank"].value.low < 0.1 * off["crank"].value.value
    assert exact["crank"].verdict is Verdict.UNDECIDED
    assert exact["rocker"].value.low == pytest.approx(off["rocker"].value.low, rel=1e-2)


def test_links_between_layers_that_bear_but_rounding_are_judged():
    """The crank bears all; the others have what pins in their holes make of them, and no sum that does not balance."""
    layers = {"base": 0, "crank": 1, "coupler": 2, "rocker": 1}
    entries = ['layer_spacing="4.5 mm"', *(f"links.{link}.layer={layer}" for link, layer in layers.items())]
    entries += ['load_cases.lift={forces=[{link="crank", at="A", force=["0 N", "-5 N"]}]}']
    entries += ['parts.bar.material="aluminium-6061-t6"']
    found = check_case(edited("four-bar", entries, bare=True), name="idle", fidelity="beam")
    [load_case] = found.load_cases.values()
    told = {str(one.subject): one for one in load_case.checks if one.quantity is Quantity.SAFETY_FACTOR}
    assert told["crank"].verdict is Verdict.PASS
    assert told["coupler"].value.value == told["rocker"].value.value == math.inf


def test_zero_times_what_has_no_end_is_not_known():
    source = Source(kind=SourceKind.PLAY)
    endless = Scatter.from_zero([0.0, 1e-3], (source,))
    assert Scatter.from_zero([0.0], (source,)) == Scatter()
    opened = endless.on(Band.exact(0.0))
    assert (opened.low, opened.value, opened.high) == (0.0, 0.0, math.inf)
    assert Scatter(high=2.0, sources=(source,)).times(endless).on(Band.exact(0.0)).high == math.inf
    strength = opened.inverse(40.0)
    assert endless.inverse.on(Band.exact(math.inf)).low == 0.0
    assert (strength.low, strength.value, strength.high) == (0.0, math.inf, math.inf)
    assert Scatter(low=0.5, high=2.0, sources=(source,)).on(Band.exact(0.0)).high == 0.0
    rule = widest(COUPLES)
    assert rule(0.0, [0.0, 0.0]) == Scatter()
    assert rule(0.0, [0.0, 1e-3]).high == math.inf
    assert differing([(0.0, endless), (1.0, Scatter())]) == math.inf
    np.testing.assert_array_equal(differing([(np.zeros(2), endless), (np.ones(2), Scatter())]), [math.inf] * 2)


def test_rounding_in_a_joint_that_bears_nothing_is_no_force_of_another_answer():
    """Of two joints; what the other bears differs as it does."""

    def answer(one, other):
        joints = {"A": SimpleNamespace(magnitude=one), "B": SimpleNamespace(magnitude=other)}
        return SimpleNamespace(reactions=SimpleNamespace(joints=joints), plates={})

    cause = Alternatives(source=Source(kind=SourceKind.FRICTION), others=(answer(1e-17, 3.0),))
    joints = Doubt(stated=answer(0.0, 2.0), cause=cause).growths.joints
    assert {name: one.high for name, one in joints.items()} == {"B": 1.5}


def test_the_nearest_harmonic_is_of_the_load_case_in_which_it_comes_nearest():
    """Of two at one speed, of which one carries a mass: whichever stands first."""
    cases = {"laden": "carried=true", "bare": "carried=false"}

    def told(*order):
        force = 'forces=[{link="rocker", at="P", force=["0 N", "-5 N"]}]'
        text = ", ".join(f'{name}={{speed="600 rpm", own_weight=true, {cases[name]}, {force}}}' for name in order)
        carried = 'carried=[{link="rocker", at="P", mass="60 g"}]'
        found = nearest_harmonic(edited("four-bar", [f"load_cases={{{text}}}", carried], bare=True))
        return dict(found.facts)["ratio"]

    alone = {name: told(name) for name in cases}
    nearest = min(alone.values(), key=lambda ratio: abs(math.log(ratio)))
    assert alone["laden"] != pytest.approx(alone["bare"])
    for order in (("laden", "bare"), ("bare", "laden")):
        assert told(*order) == pytest.approx(nearest)
