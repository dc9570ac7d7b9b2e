"""Every link cut free balances: the sum of all that acts on it, about its own origin, at every pose of every motion.

The sum takes pins, couples, ends, spread loads, weight and inertia one by one, and knows nothing of the equations that
gave the joint forces.
"""

import numpy as np
import pytest
from edited_cases import tight_pins

from alula.fea.motion.layered import with_couples
from alula.fea.motion.link_history import link_histories
from alula.loads.case.case_file import read_case
from alula.loads.states.case_motion import solve_case_motion

CASES = {
    "owl-wing-static": [],
    "flapping-wing-chosen": [],
    "ornithopter": [],
    "spring-pedal": [],
    "four-bar-synthesis": ["load_cases.weight.own_weight=true", "load_cases.weight.speed=300 rpm"],
}
POSES = 4
TIGHT = ("flapping-wing-chosen",)
"""Cases of which many pins share couples between layers in many ways; here in one, and in the others in all."""


@pytest.mark.parametrize("name", CASES)
def test_the_loads_on_every_link_sum_to_nothing(name: str) -> None:
    case = read_case(name, [*CASES[name], f"motion.poses={POSES}"])
    case = tight_pins(case) if name in TIGHT else case
    moved = with_couples(solve_case_motion(case), np.ones(POSES, dtype=bool)).moved
    compared = 0
    for link in case.checked_links:
        length = case.linkage.longest
        for loads in link_histories(moved, link):
            size = loads.size(length)
            held = np.isfinite(size) & (size > 0.0)
            left = np.abs(loads.resultant())[held] / np.array([1.0] * 3 + [length] * 3)
            assert (left.max(axis=1) <= 1e-10 * size[held]).all(), (link, loads.name)
            one = loads.chosen(int(np.flatnonzero(held)[0])) if held.any() else None
            if one is not None:
                assert one.resultant().shape == (6,)
                compared += int(held.sum())
    assert compared >= 2 * POSES
