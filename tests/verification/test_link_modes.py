"""Natural frequencies of links by their beams: held as joints hold them, with the mass of their eyes, beside solids."""

import math
import tomllib

import numpy as np
import pytest
from held_ground import THICKNESS, WIDTH, L, bracket
from rocker_case import TOML
from slotted_cases import quick_return
from slotted_lever import slotted_lever

from alula.fea.vibration.link_frame import link_frame
from alula.fea.vibration.link_holding import link_holding
from alula.fea.vibration.link_modes import link_modes
from alula.fea.vibration.linkage_modes import divide
from alula.fea.vibration.mass_matrix import mass_matrix
from alula.fea.vibration.over_motion import case_frequencies
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.states.masses import laden_masses, part_mass
from alula.reports.sentences import told


@pytest.mark.parametrize(
    ("name", "link"),
    [
        ("owl-wing-static", "GF"),
        ("flapping-wing-chosen", "outer-right"),
        ("ornithopter", "lever-left"),
    ],
)
def test_beams_eyes_and_what_is_carried_weigh_what_the_link_weighs(name, link):
    """Mass, centroid and moment of inertia of the rigid link, from the mass matrix and from the kernel."""
    case = read_case(name)
    pose = case.solve_pose()
    frame = link_frame(case, link, pose, link_holding(case, link, pose))
    model, parents = divide(frame, 4)
    part = part_mass(case, link)
    mass = mass_matrix(case, frame, model, parents, {link: part})
    known = laden_masses(case, {link: part})[link]
    x, y = pose.origins[link] + pose.rotation(link) @ known.centroid
    about = np.cross([0.0, 0.0, 1.0], model.nodes - [x, y, 0.0])
    for direction in np.eye(3):
        moved = np.hstack([np.tile(direction, (len(model.nodes), 1)), np.zeros((len(model.nodes), 3))])
        assert mass.energies(moved)[0] == pytest.approx(known.mass, rel=1e-9)
    turned = np.hstack([about, np.tile([0.0, 0.0, 1.0], (len(model.nodes), 1))])
    assert mass.energies(turned)[0] == pytest.approx(known.inertia, rel=0.01)
    off = np.hstack([about + np.array([0.0, 1.0, 0.0]), turned[:, 3:]])
    assert mass.energies(off)[0] == pytest.approx(mass.energies(turned)[0] + known.mass, rel=1e-6)


def test_a_tube_between_its_pins_rings_as_its_solid_does():
    """GF by CalculiX and by its solid (test_link_frequencies.py); its eyes weigh as much as it, and stand still."""
    found = [mode.frequency for mode in link_modes(read_case("owl-wing-static"), "GF").modes]
    for band, solid in zip(found, (1087.1, 2923.9, 3945.4, 7230.4), strict=True):
        assert band.low < solid < band.high
    assert found[0].value == pytest.approx(1087.1, rel=0.01)


def test_a_link_that_is_all_eye_has_a_band_that_ends():
    """The disc of the ornithopter: 17.7 kHz by its solid, of which a strip between two near pins knows little."""
    found = link_modes(read_case("ornithopter"), "crank", count=1).modes[0].frequency
    assert 0.0 < found.low < 17712.0 < found.high < math.inf


@pytest.mark.parametrize(
    ("case", "link"),
    [(tomllib.loads(TOML), "rocker"), pytest.param(None, "lever", marks=pytest.mark.converged)],
    ids=["rocker", "slot"],
)
def test_bands_of_beams_hold_the_frequencies_of_solids(case, link):
    case = slotted_lever(mesh_size=4.0) if case is None else validate(case)
    beams, solid = link_modes(case, link, count=3), link_modes(case, link, count=3, solid=True, threads=1)
    assert (beams.model, solid.model, beams.held) == ("beam", "solid", solid.held)
    for one, other in zip(beams.modes, solid.modes, strict=True):
        assert one.frequency.low < other.frequency.high
        assert other.frequency.low < one.frequency.high
        assert one.in_plane == pytest.approx(other.in_plane, abs=0.1)
        for modes, found in ((beams, one), (solid, other)):
            assert found.shape.shape[0] == len(modes.nodes)
            assert np.linalg.norm(found.shape[:, :3], axis=1).max() == pytest.approx(1.0)
    assert solid.nodes.min(axis=0) == pytest.approx([-6.0, -6.0, -2.5], abs=4.0)


def test_a_beam_on_one_pin_turns_freely():
    """Pinned at one end and free at the other: β L = 3.9266 (Blevins, table 8-1); its eyes are as wide as the bar."""
    data = tomllib.loads(TOML)
    data["links"]["rocker"]["points"] = {"O4": ["0 mm", "0 mm"], "P": ["150 mm", "0 mm"]}
    data["parts"]["bar"] |= {"width": "3 mm", "thickness": "2 mm", "eye_diameter": "3.4 mm", "eye_thickness": "2 mm"}
    data["parts"]["bar"] |= {"fillet_radius": "0.1 mm"}
    data["links"].pop("coupler")
    data["links"].pop("crank")
    data["joints"] = {"O4": {"links": ["base", "rocker"], "pin_diameter": "0.5 mm"}}
    data["pose"] = {"coordinate": "rocker", "angle": "-60 deg", "equilibrium": True}
    data.pop("drive")
    data.pop("motion")
    data["load_cases"] = {"hangs": {"own_weight": True}}
    case = validate(data)
    modes = link_modes(case, "rocker", count=4)
    assert told(modes.held) == "on rigid pins at O4, a rigid motion of it left free"
    bending = [mode.frequency.value for mode in modes.modes if mode.in_plane > 0.5]
    material = case.material_of("rocker")
    stiff = math.sqrt(material.youngs_modulus * 3.0**2 / 12.0 / material.density)
    assert bending[0] == pytest.approx(3.9266**2 / (2.0 * math.pi * 150.0**2) * stiff, rel=0.02)


def test_a_link_without_part_has_no_frequency_of_its_own():
    with pytest.raises(CaseError, match=r"links\.crank: no link of that name has a part"):
        link_modes(validate(tomllib.loads(TOML)), "crank")


def test_a_slot_holds_its_link_where_the_pin_stands():
    """A quick return: its lever's slot has the lever's own pivot as its point, and the crank's pin stands further out.

    The lever is the softest link, and the linkage's lowest frequency is its own.
    """
    case = quick_return()
    found = case_frequencies(case, count=1)
    lever = found.links["lever"]
    assert told(lever.held) == "on rigid pins at O and held across the slot at B"
    [history] = found.histories.values()
    assert lever.modes[0].frequency.value == pytest.approx(history.frequencies[0, 0], rel=0.01)


def test_beams_leave_the_grounds_part_open_and_its_solid_tells():
    """A cantilever of 73 mm, held on its patch of 7 mm: Rayleigh's quotient of its sag under a load at the tip."""
    case = bracket(solid={"mesh_size": 4.0})
    [mode] = link_modes(case, "bracket").modes
    assert mode.frequency.unknowable
    assert "the frame takes the ground for rigid" in told(mode.frequency.without)
    found = link_modes(case, "bracket", count=1, solid=True, threads=1)
    assert told(found.held) == "built in at base"
    material, free = case.material_of("bracket"), L - 7.0
    ring = (math.pi * (6.0**2 - 1.5**2) - 12.0 * WIDTH) * THICKNESS
    tip = ring + 6.0 * WIDTH * THICKNESS  # beyond the pin there is no bar
    middle = (free - L / 2.0) / free
    sag = middle**2 * (3.0 - middle) / 2.0
    mass = material.density * (33.0 / 140.0 * free * WIDTH * THICKNESS + tip + ring * sag**2)
    stiff = 3.0 * material.youngs_modulus * WIDTH * THICKNESS**3 / 12.0 / free**3
    assert found.modes[0].frequency.value == pytest.approx(math.sqrt(stiff / mass) / (2.0 * math.pi), rel=0.03)
