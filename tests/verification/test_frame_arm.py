"""A link with an arm in the spatial frame: a bell crank against the closed form of its two legs."""

import numpy as np
import pytest

from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.records.applied import PointLoad

SIDE, ARM, FORCE = 60.0, 40.0, 2.0
CASE = {
    "schema_version": 1,
    "title": "bell crank",
    "links": {
        "base": {"ground": True, "points": {"D": ["0 mm", "0 mm"], "P": ["100 mm", "40 mm"]}},
        "crank": {
            "part": "bar",
            "points": {"D": ["0 mm", "0 mm"], "Q": ["0 mm", f"{ARM} mm"], "E": [f"{SIDE} mm", "0 mm"]},
            "arms": {"Q": "D"},
        },
        "strut": {"part": "bar", "points": {"Q": ["0 mm", "0 mm"], "P": ["100 mm", "0 mm"]}},
    },
    "joints": {
        "D": {"links": ["base", "crank"], "pin_diameter": "3 mm"},
        "Q": {"links": ["crank", "strut"], "pin_diameter": "3 mm"},
        "P": {"links": ["base", "strut"], "pin_diameter": "3 mm"},
    },
    "parts": {
        "bar": {
            "shape": "bar", "material": "pla-fdm-xy", "width": "8 mm", "thickness": "4 mm", "eye_diameter": "11 mm",
            "eye_thickness": "4 mm", "fillet_radius": "1 mm",
        }
    },
    "pose": {"near": {"crank": "0 deg", "strut": "0 deg"}},
    "load_cases": {"push": {"forces": [{"link": "crank", "at": "E", "force": ["0 N", f"-{FORCE} N"]}]}},
}  # fmt: skip


def test_a_bell_crank_gives_as_two_cantilevers_and_its_strut() -> None:
    """Force F on a leg L, held by an arm H and a strut (Gere & Goodno, 8th ed., table of cantilevers).

    The strut's force is F L/H, its shortening u. E sinks by L/H (u + S H³/3EI + S H/κGA) + F L³/3EI + F L/κGA.
    """
    case: Case = validate(CASE)
    pose = case.solve_pose()
    load = PointLoad(link="crank", point="E", wrench=np.array([0.0, -FORCE, 0.0, 0.0, 0.0, 0.0]))
    frame = build_frame(case, pose, [load], held=None, bonded=False)
    moved = frame.at_points(solve_frame(frame.model).displacements)
    material, section = case.material_of("crank"), case.part_of("crank").section
    young = material.youngs_modulus
    shear = section.shear_coefficient(material.poissons_ratio) * section.area * young
    shear /= 2.0 * (1.0 + material.poissons_ratio)
    strut = FORCE * SIDE / ARM
    shorter = strut * 100.0 / (young * section.area)
    arm = strut * ARM**3 / (3.0 * young * section.i_z) + strut * ARM / shear
    leg = FORCE * SIDE**3 / (3.0 * young * section.i_z) + FORCE * SIDE / shear
    assert moved["crank", "E"][1] == pytest.approx(-(SIDE / ARM * (shorter + arm) + leg), rel=1e-9)
    assert moved["crank", "Q"][0] == pytest.approx(shorter, rel=1e-9)
