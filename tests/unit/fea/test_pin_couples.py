"""Couples whose ends are sought are those along and across links, whichever way pins point."""

import numpy as np
import pytest

from alula.fea.standing.case_statics import solve_case_statics
from benchmarks import draws


@pytest.mark.parametrize("seed", [1, 11])
def test_couples_are_those_of_joint_forces_along_and_across_their_links(seed):
    """Of pins that rise, those about y once had the other sign than those about x."""
    case = draws.linkage(seed)
    forces, angles, signs = solve_case_statics(case).forces["l"], case.solve_pose().angles, set()
    assert forces.pins is not None
    assert forces.frame is not None
    found = forces.pins.couples(forces.pins.value[None])[0].reshape(-1, 5)
    for (name, ends), own in zip(forces.frame.pin_eyes.items(), found, strict=True):
        wrench, rise = forces.reactions.joints[name].wrench, case.linkage.rise(name)
        signs.add(np.sign(rise))
        first = wrench[3:5] + rise * np.array([-wrench[1], wrench[0]])
        for end, couple in enumerate((first, wrench[3:5])):
            angle = angles[ends[end][0]]
            turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]) @ couple
            sign = 1.0 if turned @ own[2 * end : 2 * end + 2] > 0.0 else -1.0
            assert sign * own[2 * end : 2 * end + 2] == pytest.approx(turned, rel=1e-6, abs=1e-6)
        assert abs(own[4]) == pytest.approx(abs(wrench[2]), rel=1e-6, abs=1e-6)
    assert signs == {-1.0, 1.0}
