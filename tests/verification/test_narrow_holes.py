"""A band holds the stress about every hole that the case allows, though the widest alone is drawn."""

import pytest
from edited_cases import edited

from alula.fea.check.run import check_case
from alula.fea.refine.refinement import Effort

ONE_MESH = Effort(max_meshes=1)
RANGES = {"0.1 to 0.9 mm": ("0.1 mm", "0.9 mm"), "half the wall": ("1 mm", "2.2 mm")}


@pytest.mark.parametrize(("least", "most"), RANGES.values(), ids=RANGES)
def test_a_band_holds_narrower_holes(least, most):
    """Eyes of 6.4 mm about pins of 3 mm; those of the same links with pins as wide as holes may be are held.

    Of the crank the narrower hole is the worse one as long as walls are thick, of the coupler the wider.
    """
    links, edits = ("crank", "coupler"), ['parts.bar.width="4 mm"', "load_cases.lift.own_weight=false"]
    both = ", ".join(f'{link}=["{least}", "{most}"]' for link in links)
    bands = _solids(edited("four-bar", [*edits, f"joints.A.clearance={{{both}}}"]))
    low, high = (3.0 + float(end.removesuffix(" mm")) for end in (least, most))
    for share in (0.0, 0.5, 1.0):
        found = _solids(edited("four-bar", [*edits, f'joints.A.pin_diameter="{low + share * (high - low)} mm"']))
        for link in links:
            band, one = bands[link].safety_factor, found[link].safety_factor
            assert band.low < one.low < one.value < one.high < band.high
            assert share < 1.0 or one.value == pytest.approx(band.value, rel=1e-6)


def _solids(case):
    return check_case(case, fidelity="solid", effort=ONE_MESH).load_cases["lift"].links
