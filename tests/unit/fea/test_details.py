"""Hand calculation at slots and arms, against closed forms."""

import numpy as np
import pytest

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.details import details, flank_moments, net_section, remarks
from alula.fea.beam.theory import check_beam
from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.geometry.parts.part import Bar, Body, Disc, Pin, PlainEnd, rectangle
from alula.reports.sentences import told

BAR = Bar(
    shape="bar",
    material="resin",
    width="6 mm",
    thickness="4 mm",
    eye_diameter="8 mm",
    eye_thickness="4 mm",
    fillet_radius="1 mm",
)


def pin(name: str, x: float, y: float, *force: float, slotted: bool = False) -> PinLoad:
    wrench = np.array([*force, *[0.0] * (6 - len(force))])
    return PinLoad(name=name, centre=np.array([x, y, 0.0]), diameter=3.0, wrench=wrench, slotted=slotted)


def test_a_beam_built_in_at_both_ends() -> None:
    """F L/8 in the middle and at the ends; beside the middle equilibrium and no turn of the ends."""
    found = flank_moments(8.0, 4.0, 10.0, np.array([0.0, 4.0, 8.0]))
    assert found == pytest.approx([-10.0, 10.0, -10.0])
    x = np.linspace(0.0, 8.0, 8001)
    beside = flank_moments(8.0, 2.0, 10.0, x)
    assert np.trapezoid(beside, x) == pytest.approx(0.0, abs=1e-4)
    assert np.trapezoid(beside * x, x) == pytest.approx(0.0, abs=1e-3)
    slope = np.gradient(beside, x)
    assert slope[100] - slope[-100] == pytest.approx(10.0)


def test_the_net_section_is_the_bar_less_the_slot() -> None:
    net, whole, cut = net_section(8.0, 3.0, 4.0), rectangle(8.0, 4.0), rectangle(3.0, 4.0)
    assert net.area == whole.area - cut.area
    assert net.i_z == pytest.approx(whole.i_z - cut.i_z)
    assert net.i_y == pytest.approx(whole.i_y - cut.i_y)
    assert (net.half_y, net.half_z) == (4.0, 2.0)
    assert net.torsion == 2.0 * rectangle(2.5, 4.0).torsion


def slotted(slot: float) -> Body:
    pins = (Pin(name="S", x=20.0, y=0.0, diameter=3.0, slot=slot), Pin(name="B", x=60.0, y=0.0, diameter=3.0))
    return Body(part=BAR, pins=(Pin(name="A", x=0.0, y=0.0, diameter=3.0), *pins), ends=(), holes=())


def test_a_pull_past_a_slot_bears_on_the_net_section_alone() -> None:
    loads = LinkLoads(name="pull", pins=(pin("A", 0.0, 0.0, -20.0), pin("S", 20.0, 0.0), pin("B", 60.0, 0.0, 20.0)))
    body = slotted(10.0)
    (found,) = details(body, loads, check_beam(beam_loads(loads, body, 1e-9), BAR.section, 1.0).forces)
    assert found.stress.axial == pytest.approx(20.0 / (5.0 * 4.0))
    assert found.stress.bending == pytest.approx(0.0, abs=1e-12)


def test_shear_past_a_slot_bends_each_flank_by_half() -> None:
    """V along a slot of effective length L, the pin elsewhere: M is linear, so each flank bears V L/4 at its ends."""
    # A force at the end of a slot of no push: shear of 2 N from A to B with the moment taken at A.
    wrench = (0.0, -2.0, 0.0, 0.0, 0.0, -120.0)
    loads = LinkLoads(
        name="shear", pins=(pin("A", 0.0, 0.0, *wrench), pin("S", 20.0, 0.0), pin("B", 60.0, 0.0, 0.0, 2.0))
    )
    body = slotted(10.0)
    beam = check_beam(beam_loads(loads, body, 1e-9), BAR.section, 1.0)
    (found,) = details(body, loads, beam.forces)
    length, height = 10.0 + 3.0 / 2.0, 2.5
    mean, net = 2.0 * 40.0, net_section(8.0, 3.0, 4.0)
    own = 6.0 * (2.0 * length / 4.0) / (4.0 * height**2)
    assert found.stress.bending == pytest.approx(mean * 4.0 / net.i_z + own, rel=1e-6)
    assert abs(found.x - 20.0) == pytest.approx(length / 2.0)


def test_a_torque_past_a_slot_twists_each_flank_by_half() -> None:
    """Flanks of 3 x 5 mm: T/2 over k2 h² t of each, interpolated in Timoshenko & Goodier's table of section 109."""
    wide = BAR.model_copy(update={"eye_diameter": 10.0, "eye_thickness": 5.0})
    pins = (Pin(name="S", x=31.0, y=0.0, diameter=4.0, slot=38.0), Pin(name="B", x=80.0, y=0.0, diameter=3.0))
    body = Body(part=wide, pins=(Pin(name="A", x=0.0, y=0.0, diameter=3.0), *pins), ends=(), holes=())
    ends = pin("A", 0.0, 0.0, 0.0, 0.0, 0.0, -50.0), pin("S", 31.0, 0.0), pin("B", 80.0, 0.0, 0.0, 0.0, 0.0, 50.0)
    loads = LinkLoads(name="twist", pins=ends)
    (found,) = details(body, loads, check_beam(beam_loads(loads, body, 1e-9), BAR.section, 1.0).forces)
    k2 = 0.231 + (0.239 - 0.231) * (5.0 / 3.0 - 1.5) / 0.25  # of the ratios 1.5 and 1.75
    assert found.stress.torsion == pytest.approx(25.0 / (k2 * 3.0**2 * 5.0), rel=5e-3)
    assert found.stress.equivalent == pytest.approx(np.sqrt(3.0) * found.stress.torsion)


def test_short_flanks_are_said_to_be_an_estimate() -> None:
    loads = LinkLoads(name="pull", pins=(pin("A", 0.0, 0.0, -20.0), pin("S", 20.0, 0.0), pin("B", 60.0, 0.0, 20.0)))
    for slot, kind in ((10.0, "net_section_of_flanks"), (2.0, "net_section_of_stocky_flanks")):
        body = slotted(slot)
        found = details(body, loads, check_beam(beam_loads(loads, body, 1e-9), BAR.section, 1.0).forces)
        assert found[0].remark.kind == kind
        said = told(remarks(body, found)[0])
        assert said.startswith("by hand the slot at S bears 1 MPa")
        assert ("an estimate, since they are only 1.4 times as long as high" in said) is (slot == 2.0)


def test_an_arm_is_a_bar_built_in_at_its_eye_and_loads_the_axis_at_its_foot() -> None:
    """Arm of 40 mm at a right angle under 3 N along the axis: 3 (40 - 4) N mm at the eye's rim, 120 in the bar."""
    pins = (Pin(name="A", x=0.0, y=0.0, diameter=3.0), Pin(name="Q", x=0.0, y=40.0, diameter=3.0, foot=(0.0, 0.0)))
    body = Body(part=BAR, pins=pins, ends=(PlainEnd(name="E", x=60.0, patch=5.0),), holes=())
    hold = np.array([0.0, -2.0, 0.0, 0.0, 0.0, 0.0])
    loads = LinkLoads(
        name="crank",
        pins=(pin("A", 0.0, 0.0, 3.0, 2.0), pin("Q", 0.0, 40.0, -3.0, 0.0)),
        ends=(EndLoad(name="E", point=np.array([60.0, 0.0, 0.0]), wrench=hold),),
    )
    beam = check_beam(beam_loads(loads, body, 1e-9), BAR.section, 1.0)
    assert beam.forces.at(0.0)[5] == pytest.approx(-120.0)
    assert beam.forces.at(60.0, "before")[5] == pytest.approx(0.0, abs=1e-9)
    (found,) = details(body, loads, beam.forces)
    assert found.name == "the arm to Q"
    assert found.stress.bending == pytest.approx(3.0 * 36.0 * 3.0 / BAR.section.i_z)
    assert found.stress.axial == pytest.approx(0.0, abs=1e-12)


def test_a_disc_is_said_to_be_no_beam() -> None:
    part = Disc(shape="disc", material="resin", diameter="9 mm", thickness="2 mm", eye_diameter="2.6 mm")
    body = Body(part=part, pins=(Pin(name="O", x=0.0, y=0.0, diameter=1.0),), ends=(), holes=())
    (said,) = remarks(body, ())
    assert "narrowest net section" in said
    assert "an estimate" in said
