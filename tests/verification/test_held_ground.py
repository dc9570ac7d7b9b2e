"""The ground's part, held at a point of its own, against closed forms of a cantilever."""

import math
import tomllib

import numpy as np
import pytest
import rocker_case
from held_ground import POISSON, THICKNESS, WIDTH, E, L, bracket
from scipy.optimize import brentq

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity, Subject
from alula.fea.motion.envelope import envelope_case
from alula.fea.motion.link_history import link_histories
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.states.case_motion import solve_case_motion
from alula.loads.states.masses import part_mass
from alula.reports.sentences import told

ALONG, ACROSS = 1.2, 1.6
"""Of the force on the bar, which the strut pushes [N]."""
I_Z, I_Y = THICKNESS * WIDTH**3 / 12.0, WIDTH * THICKNESS**3 / 12.0


def pushed(times):
    return [{"link": "strut", "at": "B", "force": [f"{times * ALONG} N", f"{times * ACROSS} N"]}]


def checked(fidelity="beam", **changes):
    return check_case(bracket(**changes), fidelity=fidelity, threads=1).load_cases["push"]


def test_the_root_bears_bending_and_compression():
    found = checked().links["bracket"].beam
    assert found.worst_x == pytest.approx(L)
    # 1 % less would be second order: the force is 1/70 of the load that buckles it in the plane.
    assert found.worst.bending == pytest.approx(ACROSS * L * (WIDTH / 2.0) / I_Z, rel=0.02)
    assert found.worst.axial == pytest.approx(-ALONG / (WIDTH * THICKNESS), rel=1e-9)


@pytest.mark.parametrize("weighs", [False, True])
def test_the_support_balances_joints_and_weight(weighs):
    case = bracket(load_cases__push__own_weight=weighs)
    statics = solve_case_statics(case)
    loads = link_loads("push", "bracket", case.body("bracket"), statics.reactions["push"], statics.loads["push"])
    [end] = loads.ends
    mass = {link: part_mass(case, link) for link in case.links} if weighs else {}
    # The linkage and its support as one body: all that acts from outside is known without any joint force.
    place = statics.pose.placement
    turns = {link: complex(place.origin(link)) + complex(place.direction(link)) * complex(*m.centroid)
             for link, m in mass.items()}  # fmt: skip
    force = complex(ALONG, ACROSS) - 1j * sum(9810.0 * m.mass for m in mass.values())
    about_base = (complex(-30.0, -40.0) - L).conjugate() * complex(ALONG, ACROSS)
    moment = about_base.imag - sum(9810.0 * m.mass * (turns[link].real - L) for link, m in mass.items())
    np.testing.assert_allclose(end.wrench, [-force.real, -force.imag, 0, 0, 0, -moment], rtol=1e-9, atol=1e-9)
    assert np.abs(loads.resultant()).max() < 1e-9


def buckling(times, **changes):
    found = checked(load_cases__push__forces=pushed(times), **changes)
    [outcome] = [o for o in found.checks if o.quantity is Quantity.BUCKLING_FACTOR and o.subject.name == "bracket"]
    return outcome


def test_it_buckles_as_a_column_clamped_at_one_end_and_free_at_the_other():
    euler = math.pi**2 * E * I_Y / (4.0 * L**2)
    outcome = buckling(1.0)
    assert outcome.value.value == pytest.approx(euler / ALONG, rel=1e-3)
    assert "built in at 80 mm" in told(outcome.reason)


def test_its_joints_hold_it_at_the_most():
    """Pins at 0 and 40 mm, built in at 80, of the stiffest material: the upper end of the band."""
    stiffest = 3200.0  # the card's range of moduli is 2400 to 3200 MPa
    outcome = buckling(1.0)
    # Across, pins keep its angle as well: two columns of 40 mm with both ends built in.
    assert outcome.value.high == pytest.approx(4.0 * math.pi**2 * stiffest * I_Y / 40.0**2 / ALONG, rel=3e-3)
    thick = {"parts__bar__thickness": "16 mm", "parts__bar__eye_thickness": "16 mm"}
    outcome = buckling(1.0, **thick)

    def stiffness(u):
        """Of the joint at 40 mm against turning, over EI/L (Livesley & Chandler, Stability functions)."""
        s = u * (math.sin(u) - u * math.cos(u)) / (2.0 - 2.0 * math.cos(u) - u * math.sin(u))
        c = (u - math.sin(u)) / (math.sin(u) - u * math.cos(u))
        return s * (1.0 - c**2) + s

    u = brentq(stiffness, 3.2, 4.4)
    inertia = 16.0 * WIDTH**3 / 12.0
    assert outcome.value.high == pytest.approx(u**2 * stiffest * inertia / 40.0**2 / ALONG, rel=3e-3)


def test_compression_adds_to_its_bending_though_the_frame_takes_it_for_rigid():
    times = 10.0
    found = checked(load_cases__push__forces=pushed(times))
    assert found.large_displacement.state == "small"
    k = math.sqrt(times * ALONG / (E * I_Z))
    # Timoshenko & Gere, section 1.3: a cantilever under P and a force F across its end bears F tan(kL)/k at its root.
    moment = times * ACROSS * math.tan(k * L) / k
    assert moment > 1.02 * times * ACROSS * L
    assert found.links["bracket"].beam.worst.bending == pytest.approx(moment * WIDTH / 2.0 / I_Z, rel=2e-3)


def test_a_point_of_the_linkage_moves_with_the_ground_where_solids_tell():
    check = {"type": "displacement", "at": "B", "link": "strut", "maximum": "50 mm"}
    by_frame, by_solid = (
        next(o for o in checked(fidelity, checks__tip=check).checks if o.subject == Subject.point("B", "strut"))
        for fidelity in ("beam", "solid")
    )
    assert by_frame.value.unknowable
    assert "the frame takes link bracket for rigid" in told(by_frame.reason)
    # Unit loads at B, which the struts carry to A and O, do work on the bar's bending and shear; all else is steel.
    struts = np.array([[-0.6, -0.8], [-70.0, -40.0] / np.hypot(70.0, 40.0)]).T
    stiff = 5.0 / 6.0 * E / (2.0 * (1.0 + POISSON)) * WIDTH * THICKNESS
    x, moved = np.linspace(0.0, L - 3.5, 8001), []  # the support holds the middle of its patch
    eye, hole = (2.0 * np.sqrt(np.maximum(r**2 - np.minimum(x, np.abs(x - 40.0)) ** 2, 0.0)) for r in (6.0, 1.5))
    inertia = THICKNESS * (np.maximum(eye, WIDTH) ** 3 - hole**3) / 12.0
    for load in np.eye(2):
        at_a, at_o = (struts * np.linalg.solve(struts, load))[1]
        m, v = at_a * x + at_o * np.maximum(x - 40.0, 0.0), at_a + at_o * (x > 40.0)
        moved.append(np.trapezoid(ACROSS * x * m / (E * inertia) + ACROSS * v / stiff, x))
    assert by_solid.value.value == pytest.approx(math.hypot(*moved), rel=0.05)
    assert by_solid.value.low < by_solid.value.value < by_solid.value.high < 2.0 * by_solid.value.value


PLATE = {"shape": "plate", "material": "pvc-u", "thickness": "4 mm", "eye_diameter": "12 mm"}
TURNED = {
    "links__bracket__points": {"A": ["0 mm", "0 mm"], "O": ["0 mm", "40 mm"], "base": ["0 mm", "80 mm"]},
    "pose__near": {"strut": "323.13 deg", "idle": "299.74 deg"},
    "load_cases__push__forces": [{"link": "strut", "at": "B", "force": ["-1.6 N", "1.2 N"]}],
}
"""The same linkage, turned by 90 degrees."""


def test_a_plate_across_the_x_axis_is_judged_by_its_solid_and_has_no_beam():
    coarse = {"parts__bar": PLATE, "solid__mesh_size": 2.0}
    results = [check_case(bracket(**coarse, **turned), threads=1) for turned in ({}, TURNED)]
    along, across = (result.load_cases["push"].links["bracket"] for result in results)
    assert across.von_mises_max.value == pytest.approx(along.von_mises_max.value, rel=0.05)
    assert across.displacement_max.value == pytest.approx(along.displacement_max.value, rel=0.02)
    assert along.beam.worst.equivalent > 0.0
    assert (along.beam.without, across.beam.worst.equivalent) == ("", 0.0)
    assert any("80 mm apart across that axis and 0 mm along it" in told(note) for note in across.notes)
    for result in results:
        [outcome] = [
            o
            for o in result.load_cases["push"].checks
            if o.quantity is Quantity.BUCKLING_FACTOR and o.subject == Subject.link("bracket")
        ]
        assert "its solid buckles" in told(outcome.reason)
        assert "built in at base" in told(outcome.reason)
        # Within a force of 1.6 N across, which bends the plate in its plane, as a column of its width alone.
        assert 3.0 * outcome.value.low < math.pi**2 * E * 12.0 * 4.0**3 / 12.0 / (4.0 * L**2) / ALONG
    by_hand = check_case(bracket(**coarse, **TURNED), fidelity="beam")
    assert by_hand.load_cases["push"].links["bracket"].von_mises_max.unknowable
    assert by_hand.verdict == "undecided"


def test_over_a_motion_it_bears_what_it_bears_at_every_pose():
    data = tomllib.loads(rocker_case.TOML)
    data["links"]["base"] |= {"part": "bar", "held_at": "wall", "end_patch": "8 mm"}
    data["links"]["base"]["points"]["wall"] = ["100 mm", "0 mm"]
    case = validate(data)
    [history] = link_histories(solve_case_motion(case), "base")
    for pose, angle in ((0, "40 deg"), (6, "80 deg")):
        data["pose"]["angle"] = angle
        one = validate(data)
        at = solve_case_statics(one)
        # All joints are inside: what is outside is the moment of 20 N mm on the rocker, and no force.
        np.testing.assert_allclose(history.ends[0].wrench[pose], [0.0, 0.0, 0.0, 0.0, 0.0, -20.0], atol=1e-9)
        loads = link_loads("turn", "base", one.body("base"), at.reactions["turn"], at.loads["turn"])
        for pin, alone in zip(history.pins, loads.pins, strict=True):
            np.testing.assert_allclose(pin.wrench[pose], alone.wrench, atol=1e-9)
    over = envelope_case(case, threads=1).links["base"].load_cases["turn"].safety_factor
    assert 1.0 < over.low <= over.value <= over.high < 1e4


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"links__bracket__held_at": None}, ["links.bracket.held_at", "it is missing", "without a joint"]),
        (
            {"links__bracket__held_at": "wall"},
            ["links.bracket.held_at", "'wall'", "no point of the link", "A, O, base"],
        ),
        ({"links__bracket__held_at": "O"}, ["links.bracket.held_at", "'O'", "joint 'O'", "without a joint"]),
        ({"links__bracket__part": None}, ["links.bracket.held_at", "no part"]),
        ({"links__strut__held_at": "B"}, ["links.strut.held_at", "'strut' moves", "remove"]),
    ],
)
def test_what_does_not_fit_is_refused(changes, words):
    with pytest.raises(CaseError) as caught:
        bracket(**changes)
    assert all(word in str(caught.value) for word in words), str(caught.value)
