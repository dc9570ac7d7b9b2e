"""Numbers on the deformed shape have tight pins: bands hold what pins that run change of these, and growth of these."""

from functools import cache

import numpy as np
import pytest
from tilting_pins import checked, four_bar

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.load_case import LoadCaseByHand
from alula.fea.doubts.load_growth import beyond_undeformed
from alula.fea.links.link_by_hand import HandStates, link_by_hand, on_plates
from alula.fea.nonlinear.large_displacement import examine, with_growth
from alula.fea.outcomes.pins import shared_stress, stresses_between
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.standing.thrust import thrusts


@cache
def leaning(*clearance):
    """A four-bar at a fifth of its buckling load; the clearance is stated of every hole."""
    data = four_bar(tight={})
    data["materials"]["m"]["youngs_modulus"] = "7000 MPa"
    for joint in data["joints"].values():
        joint["clearance"] = {link: list(clearance) for link in joint["links"]}
    data["load_cases"]["l"]["forces"][0]["force"] = ["60 N", "0 N"]
    case = checked(data)
    statics = solve_case_statics(case)
    return case, statics, examine(case, "l", statics.forces["l"], statics.loads["l"])


def stress(case, statics, link, reactions):
    acting = link_loads("l", link, case.body(link), reactions, statics.loads["l"])
    return HandStates(case, link, [on_plates(case, link, acting)]).stress[0]


def test_bands_hold_all_ways_of_sharing_beside_tight_pins():
    case, statics, moved = leaning("0.02 mm", "0.1 mm")
    assert moved.state == "deformed"
    forces, hand = statics.forces["l"], LoadCaseByHand.of(statics, "l", moved, ())
    tight, ways = forces.on_tight_pins, (forces.reactions, *forces.sharings)
    for link in case.checked_links:
        plain, growth = stress(case, statics, link, tight), hand.shared.stress[link]
        every = [stress(case, statics, link, one) for one in ways]
        assert growth.low * plain <= min(every)
        assert max(every) <= growth.high * plain
    told = thrusts(forces, tight)
    for joint in case.joints:
        band = shared_stress(case, joint, tight.joints, hand.shared_forces).equivalent
        every = [one.equivalent.value for one in stresses_between(case, joint, {joint: _wrenches(joint, ways)})]
        assert band.low <= min(every) * (1.0 + 1e-9)
        assert max(every) <= band.high * (1.0 + 1e-9)
        thrust = np.abs(_wrenches(joint, ways)[:, 2])
        assert told[joint].low <= thrust.min() * (1.0 + 1e-9)
        assert thrust.max() <= told[joint].high * (1.0 + 1e-9)


def _wrenches(joint, ways):
    return np.array([one.joints[joint].wrench for one in ways])


def test_growth_beyond_the_undeformed_pose_is_that_of_the_linkage_with_tight_pins():
    """Not what pins that run do to couples, which lower these by 5 % at the crank."""
    found = []
    for clearance in ("0.1 mm", "0 mm"):
        case, statics, moved = leaning(clearance, clearance)
        loads, reactions = statics.loads["l"], statics.reactions["l"]
        hands = {
            link: link_by_hand(case, link, link_loads("l", link, case.body(link), reactions, loads))
            for link in case.checked_links
        }
        shape = with_growth(case, "l", moved, loads)
        found.append(beyond_undeformed(case, "l", statics.pose, loads, shape, reactions, hands).stress)
    running, tight = found
    assert min(one.low for one in tight.values()) < 0.95
    for link, one in tight.items():
        assert (running[link].low, running[link].high) == pytest.approx((one.low, one.high), rel=1e-3)
