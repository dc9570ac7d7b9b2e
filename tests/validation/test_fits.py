"""Fits against the tables of ISO 286, which were not made by alula.

References
----------
Tolerance grades: ISO 286-1:2010, table 1, as reprinted by mechguru.com (IT5 to IT11) and engineersvault.blogspot.com
(IT12 up to 315 mm; beyond, ten times IT7, as five grades make everywhere in it but up to rounding). Deviations of
shafts d to h: ISO 286-1:2010, table 4, as reprinted by cobanengineering.com and by K. L. Narayana, Machine Drawing,
table 15.2. All in µm.
"""

import itertools

import pytest

from alula.geometry.joints.fits import COARSE, COARSE_AND_SMALL, DEVIATIONS, EXACT, STEPS, fit

GRADES = {
    5: (4, 5, 6, 8, 9, 11, 13, 15, 18, 20, 23, 25, 27),
    6: (6, 8, 9, 11, 13, 16, 19, 22, 25, 29, 32, 36, 40),
    7: (10, 12, 15, 18, 21, 25, 30, 35, 40, 46, 52, 57, 63),
    8: (14, 18, 22, 27, 33, 39, 46, 54, 63, 72, 81, 89, 97),
    9: (25, 30, 36, 43, 52, 62, 74, 87, 100, 115, 130, 140, 155),
    10: (40, 48, 58, 70, 84, 100, 120, 140, 160, 185, 210, 230, 250),
    11: (60, 75, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400),
    12: (100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630),
}
SHAFTS = {
    "d": (20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230),
    "e": (14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135),
    "f": (6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68),
    "g": (2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20),
    "h": (0,) * 13,
}


@pytest.mark.parametrize(
    ("code", "diameter", "hole", "shaft"),
    [
        ("H8/f7", 3.0, (0, 14), (-16, -6)),
        ("H7/g6", 10.0, (0, 15), (-14, -5)),
        ("H7/h6", 25.0, (0, 21), (-13, 0)),
        ("H8/f7", 50.0, (0, 39), (-50, -25)),
        ("H9/d9", 40.0, (0, 62), (-142, -80)),
        ("H8/e8", 100.0, (0, 54), (-126, -72)),
    ],
)
def test_limits_of_usual_fits(code, diameter, hole, shaft):
    """Limits as in ISO 286-2, which are sums of the tables above."""
    found = fit(code, diameter)
    assert [1e3 * limit for limit in (*found.hole, *found.shaft)] == pytest.approx([*hole, *shaft], abs=2.001)
    assert [1e3 * end for end in found.clearance] == pytest.approx([hole[0] - shaft[1], hole[1] - shaft[0]], abs=2.001)
    assert found.rounding >= EXACT


@pytest.mark.parametrize("letter", SHAFTS)
def test_every_fit_holds_the_tables_clearance_within_its_rounding(letter):
    """2 µm up to IT8 and 315 mm; coarser tables are rounded coarsely, above all up to 3 mm, by up to 13 µm."""
    for hole, shaft, step in itertools.product(GRADES, GRADES, range(13)):
        found, upper = fit(f"H{hole}/{letter}{shaft}", STEPS[step + 1]), SHAFTS[letter][step]
        published = upper, upper + GRADES[hole][step] + GRADES[shaft][step]
        for own, other in zip(found.clearance, published, strict=True):
            assert abs(own - 1e-3 * other) <= found.rounding + 1e-12
        assert found.bounds[0] <= 1e-3 * published[0] + 1e-12
        assert found.bounds[1] >= 1e-3 * published[1] - 1e-12
        if max(hole, shaft) <= 8 and STEPS[step + 1] <= 315.0:
            assert found.rounding == EXACT


def test_the_allowances_are_no_wider_than_the_tables_ask_for():
    """Each of the two shares is used to more than 90 % by some fit."""
    used = {COARSE: 0.0, COARSE_AND_SMALL: 0.0}
    for hole, letter, shaft in itertools.product(GRADES, DEVIATIONS, GRADES):
        for step, diameter in enumerate(STEPS[1:]):
            found = fit(f"H{hole}/{letter}{shaft}", diameter)
            share = round(found.rounding / found.clearance[1], 6)
            if share in used:
                off = abs(found.clearance[1] - 1e-3 * (SHAFTS[letter][step] + GRADES[hole][step] + GRADES[shaft][step]))
                used[share] = max(used[share], off / found.rounding)
    assert min(used.values()) > 0.9
