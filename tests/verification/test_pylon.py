"""A pylon under oblique load lines, by first principles: by hand, in the frame and as a solid.

A round tube is clamped on the ground, upright along y; forward is x, outward z. Each load line enters its top over a
rigid lever. What a section bears is the force and its moment about the section's centre, r × F.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity
from alula.fea.links.link_by_hand import link_by_hand
from alula.fea.nonlinear.large_displacement import examine
from alula.fea.refine.refinement import Effort
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.joint_forces import solved_frame
from alula.loads.case.case_file import validate

LENGTH, HELD, OUTER, INNER = 300.0, 40.0, 30.0, 24.0
AREA, SECOND = np.pi / 4.0 * (OUTER**2 - INNER**2), np.pi / 64.0 * (OUTER**4 - INNER**4)
OBLIQUE = ((40.0, 400.0, 30.0), (-10.0, -80.0, -20.0), 2000.0)
STEEP = ((-25.0, 350.0, 60.0), (30.0, -60.0, -5.0), 900.0)
ALONG = ((0.0, 420.0, 0.0), (0.0, -50.0, 0.0), 3000.0)
THROUGH_TOP = ((30.0, 360.0, 20.0), (-30.0, 240.0, -20.0), 1500.0)
UPWARDS = ((-10.0, -80.0, -20.0), (40.0, 400.0, 30.0), -2000.0)
LEANING = (((5.0, 400.0, 10.0), (90.0, -80.0, 50.0), 1500.0), ((-5.0, 380.0, 5.0), (20.0, -60.0, 60.0), 500.0))
LINES = {
    "oblique": (OBLIQUE,),
    "two": (OBLIQUE, STEEP),
    "the other way round": (STEEP, OBLIQUE),
    "along the link": (ALONG,),
    "through its point": (THROUGH_TOP,),
    "begins behind": (UPWARDS,),
}
"""The line, from and to [mm], and its force [N]."""


def pylon(*lines, leaves=None, **tables):
    stated = [
        {"from": [f"{v} mm" for v in start], "to": [f"{v} mm" for v in end], "force": f"{force} N"}
        | {"link": "pylon", "at": "T"}
        | ({} if leaves is None else {"leaves": leaves})
        for start, end, force in lines
    ]
    return validate(
        {
            "schema_version": 1,
            "title": "A pylon",
            "links": {
                "ground": {"ground": True, "points": {"O": ["0 mm", "0 mm"]}},
                "pylon": {
                    "part": "tube",
                    "points": {"O": ["0 mm", "0 mm"], "T": [f"{LENGTH} mm", "0 mm"]},
                    "end_patch": "40 mm",
                },
            },
            "joints": {
                "O": {"links": ["ground", "pylon"], "clamped": True, "clamp_length": f"{HELD} mm", "angle": "90 deg"}
            },
            "parts": {
                "tube": {
                    "shape": "tube",
                    "material": "aluminium-6061-t6",
                    "outer_diameter": f"{OUTER} mm",
                    "inner_diameter": f"{INNER} mm",
                    "fillet_radius": "1 mm",
                }
            },
            "load_cases": {"stand": {"load_lines": stated}},
            **tables,
        }
    )


def section(lines, height):
    """What is above a section does to it: N, V_y, V_z [N], T, M_y, M_z [N mm] in the link's axes, where x is up.

    The force and its moment about the section's centre, r × F; y of the link is backward, z outward.
    """
    force, moment = np.zeros(3), np.zeros(3)
    for start, end, size in lines:
        a, b = np.array(start), np.array(end)
        own = size * (b - a) / np.linalg.norm(b - a)
        force, moment = force + own, moment + np.cross(a - [0.0, height, 0.0], own)
    return np.array([force[1], -force[0], force[2], moment[1], -moment[0], moment[2]])


def stress_at_rim(forces):
    """Von Mises stress (n,) round the outer rim: N/A, both bendings, torsion, and V as a thin ring bears it."""
    n, v_y, v_z, t, m_y, m_z = forces
    way = np.linspace(0.0, 2.0 * np.pi, 3601)
    y, z = np.cos(way), np.sin(way)
    axial = n / AREA + (m_y * z - m_z * y) * OUTER / 2.0 / SECOND
    shear = t * OUTER / 4.0 / SECOND + 2.0 * (v_z * y - v_y * z) / AREA
    return np.sqrt(axial**2 + 3.0 * shear**2)


def moved(lines, case):
    """The top of a cantilever from its mouth up (3,), global axes: bending, tension and shear of a ring [mm]."""
    material, free = case.material_of("pylon"), LENGTH - HELD
    young = material.youngs_modulus
    n, v_y, v_z, _, m_y, m_z = section(lines, LENGTH)
    shear = free / (young / (2.0 * (1.0 + material.poissons_ratio)) * AREA / 2.0)
    up = n * free / (young * AREA)
    back, out = (
        (v * free**3 / 3.0 + m * free**2 / 2.0) / (young * SECOND) + v * shear for v, m in ((v_y, m_z), (v_z, -m_y))
    )
    return np.array([-back, up, out])


@pytest.mark.parametrize("lines", LINES.values(), ids=list(LINES))
def test_by_hand_and_in_the_frame_it_is_a_cantilever(lines):
    """Sections bear N, two bendings and torsion; the rim's stress and the top's displacement agree within 1 %."""
    case = pylon(*lines)
    statics = solve_case_statics(case)
    loads = statics.loads["stand"]
    found = statics.forces["stand"]
    fixed, sizes = found.reactions.joints["O"].wrench, [size for *_, size in lines]
    up, out, round_it = section(lines, 0.0)[[0, 2, 3]]
    assert fixed[[1, 2, 4]] == pytest.approx([-up, -out, -round_it], rel=1e-6, abs=1e-6 * max(map(abs, sizes)))
    hand = link_by_hand(case, "pylon", link_loads("stand", "pylon", case.body("pylon"), found.reactions, loads))
    for at in (HELD, 150.0, 290.0):
        assert hand.check.forces.at(at, "after") == pytest.approx(section(lines, at), rel=1e-6, abs=1e-3)
    for at in (HELD, 150.0):  # at the top V may count for more than a thin ring has
        most = stress_at_rim(section(lines, at)).max()
        assert hand.check.stress_at(at).equivalent == pytest.approx(most, rel=0.01)
    frame, solution = solved_frame(case, statics.pose, loads, None)
    top, expected = frame.at_points(solution.displacements)["pylon", "T"], moved(lines, case)
    assert top == pytest.approx(expected, abs=0.01 * np.linalg.norm(expected))


@pytest.mark.parametrize("leaves", [None, {"link": "pylon", "at": "O"}], ids=["to the ground", "as between levers"])
def test_a_set_up_with_offsets_at_top_and_bottom_has_these_moments_half_way_up(leaves):
    """Invented round numbers: at the top, 420 mm up, the line is 80 mm forward and 90 mm inward, at the bottom 60 mm
    backward and 120 mm outward; 2² + 6² + 3² = 7², so that 700 N have components of 200, 600 and 300 N.

    Half-way up it is 10 mm forward and 15 mm outward: 600 N · 15 mm about forward, 600 N · 10 mm about outward, and
    200 N · 15 mm + 300 N · 10 mm about the pylon. Where it leaves by a lever at the bottom, the ground bears nothing.
    """
    case = pylon(((80.0, 420.0, -90.0), (-60.0, 0.0, 120.0), 700.0), leaves=leaves)
    statics = solve_case_statics(case)
    reactions, loads = statics.forces["stand"].reactions, statics.loads["stand"]
    hand = link_by_hand(case, "pylon", link_loads("stand", "pylon", case.body("pylon"), reactions, loads))
    n, _, _, torsion, m_y, m_z = hand.check.forces.at(210.0, "after")
    assert (n, torsion) == pytest.approx((-600.0, -6000.0), rel=1e-6)
    forward, outward = -m_y, m_z  # y of the link is backward
    assert (forward, outward) == pytest.approx((9000.0, -6000.0), rel=1e-6)
    borne = np.array([200.0, 600.0, -300.0]) if leaves is None else np.zeros(3)
    assert reactions.joints["O"].wrench[:3] == pytest.approx(borne, abs=1e-6)


def test_the_lever_leans_with_the_pylon_and_brings_it_down_sooner():
    """A force P straight down, e beside the axis and h above the top: with k² = P/(E I), E I y'' = P (d - y), of which
    the lever's end is off by d = e + y(L) + h y'(L). So d = e/(cos kL - k h sin kL), and y(L) = d (1 - cos kL); it
    gives way where k h tan kL = 1.
    """
    beside, above, free, force = 20.0, 100.0, LENGTH - HELD, 6000.0
    case = pylon(((beside, LENGTH + above, 0.0), (beside, 0.0, 0.0), force))
    statics = solve_case_statics(case)
    found = examine(case, "stand", statics.forces["stand"], statics.loads["stand"])
    k = np.sqrt(force / (case.material_of("pylon").youngs_modulus * SECOND))
    off = beside / (np.cos(k * free) - k * above * np.sin(k * free))
    assert found.points["pylon", "T"][0] == pytest.approx(off * (1.0 - np.cos(k * free)), rel=0.01)
    assert off * (1.0 - np.cos(k * free)) > 1.2 * beside * (k * free) ** 2 / 2.0, "it grows"
    assert found.reactions.joints["O"].wrench[5] == pytest.approx(force * off, rel=0.01)
    bent = link_by_hand(case, "pylon", found.links["pylon"]).check.forces
    top, mouth = off * np.cos(k * free), off  # how far the line is beside the pylon
    assert [bent.at(at)[5] for at in (LENGTH - 1e-6, HELD)] == pytest.approx([-force * top, -force * mouth], rel=0.01)
    ends = brentq(lambda x: x * above / free * np.tan(x) - 1.0, 0.5, 1.5)
    assert found.buckling == pytest.approx((ends / (k * free)) ** 2, rel=0.02)


@pytest.fixture(scope="module")
def solid():
    checks = {
        "strength": {"type": "safety-factor", "minimum": 1.0},
        "top": {"type": "displacement", "link": "pylon", "at": "T", "maximum": "9 mm"},
    }
    return check_case(pylon(*LEANING, checks=checks), effort=Effort(max_meshes=2))


def test_the_solid_bears_it_within_its_bands(solid):
    """Its stress at the mouth and its top's displacement."""
    [load_case] = solid.load_cases.values()
    own = load_case.links["pylon"]
    assert own.decided_by == "solid"
    assert own.von_mises_max.low < stress_at_rim(section(LEANING, HELD)).max() < own.von_mises_max.high
    [top] = [one.value for one in load_case.checks if one.quantity is Quantity.DISPLACEMENT]
    assert top.low < np.linalg.norm(moved(LEANING, solid.case)) < top.high


def test_half_way_up_the_solid_has_the_stress_of_the_beam_at_every_node(solid):
    """N/A + M_y z/I - M_z y/I along it, and T r/J round it, where clamp and lever are far."""
    stress = solid.load_cases["stand"].links["pylon"].stress
    nodes = stress.space.nodes
    x, y, z = nodes[(middle := np.abs(nodes[:, 0] - 140.0) < 10.0)].T
    xx, _, _, xy, _, xz = stress.nodal[middle].T
    n, v_y, v_z, t, m_y, m_z = section(LEANING, 140.0)
    m_y, m_z = m_y + v_z * (x - 140.0), m_z - v_y * (x - 140.0)
    bent = n / AREA + (m_y * z - m_z * y) / SECOND
    assert len(x) > 40
    assert xx == pytest.approx(bent, abs=0.02 * np.abs(bent).max())
    twisted = t * np.hypot(y, z) / 2.0 / SECOND
    assert np.mean((y * xz - z * xy) / np.hypot(y, z)) == pytest.approx(np.mean(twisted), rel=0.03)
