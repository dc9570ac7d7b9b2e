"""What the search over where pins stand seeks is what joint forces say, whichever way pins point."""

import math
from dataclasses import replace

import numpy as np
import pytest

from alula.fea.pins import holes
from alula.fea.pins.states import LEVELS
from alula.fea.standing.case_statics import solve_case_statics
from benchmarks import draws


def standing(seed):
    case = draws.linkage(seed)
    forces = solve_case_statics(case).forces["l"]
    assert forces.pins is not None
    return case, forces


@pytest.mark.parametrize("seed", [1, 11])
def test_ends_of_beams_bear_what_joint_forces_say(seed):
    """Of pins that rise, couples about y once had the other sign than those about x.

    Within an eye, by sums over thin slices of what presses there, even and linear.
    """
    case, forces = standing(seed)
    rims, angles, signs = forces.pins.rims, case.solve_pose().angles, set()
    parts = rims.beam_ends.tight + rims.beam_ends.by_rims @ forces.pins.value
    found = dict.fromkeys(rims.beam_ends.owners, ())
    for owner, part in zip(rims.beam_ends.owners, parts, strict=True):
        found[owner] = (*found[owner], part)
    couples = {}
    for name in forces.frame.pin_eyes:
        wrench, rise, diameter = (
            forces.reactions.joints[name].wrench,
            case.linkage.rise(name),
            case.joints[name].pin_diameter,
        )
        signs.add(np.sign(rise))
        couples[name] = (wrench[3:5] + rise * np.array([-wrench[1], wrench[0]]), wrench[3:5])
        half = [(case.links[link].thickness or 4.0) / 2.0 / abs(rise) for link in case.joints[name].links]
        faces, within = found["pin", name][:2], found["pin", name][2:]
        eyes = [(link, case.linkage.point_of(name, link)) for link in case.joints[name].links]
        for k, (eye, outwards) in enumerate(zip(eyes, (-np.sign(rise), np.sign(rise)), strict=True)):
            assert sum(eye in own for own in forces.frame.pin_eyes.values()) == 1  # so that the pin ends there
            length, couple = 2.0 * half[k] * abs(rise), couples[name][k]
            inwards = (np.arange(4000)[:, None] + 0.5) / 4000.0  # of the eye's length
            height = outwards * (0.5 - inwards) * length
            pressure = wrench[:2] / length + 12.0 * height * np.array([couple[1], -couple[0]]) / length**3
            moment = np.cumsum(np.cumsum(pressure, axis=0), axis=0) * (length / 4000.0) ** 2
            for part, at in zip(within[2 * k : 2 * k + 2], (1999, 2999), strict=True):
                bending = 32.0 * np.linalg.norm(moment[at]) / (math.pi * diameter**3)
                assert math.hypot(*part[1:3]) == pytest.approx(bending, rel=5e-3, abs=1e-3)
        for part, at in zip(faces, (half[0], 1.0 - half[1]), strict=True):  # at the faces of both eyes
            couple = (1.0 - at) * couples[name][0] + at * couples[name][1]
            assert math.hypot(*part[1:3]) == pytest.approx(32.0 * np.linalg.norm(couple) / (math.pi * diameter**3))
            assert abs(part[0]) == pytest.approx(4.0 * abs(wrench[2]) / (math.pi * diameter**2), abs=1e-9)
    assert signs == {-1.0, 1.0}
    modulus = 9.0 * 4.0**2 / 6.0  # of the bar, out of the plane
    coupler = np.array([math.cos(angles["coupler"]), math.sin(angles["coupler"])])
    for part, name in zip((found["link", "coupler"][0], found["link", "coupler"][-1]), "AB", strict=True):
        [couple] = [c for c, link in zip(couples[name], case.joints[name].links, strict=True) if link == "coupler"]
        across = abs(coupler @ [couple[1], -couple[0]])
        assert abs(part[2]) == pytest.approx(across / modulus, rel=1e-6)
        assert abs(part[3]) == pytest.approx(abs(found["link", "coupler"][0][3]), rel=1e-6)


@pytest.mark.parametrize(
    ("low", "high", "apart"),
    [
        (-0.1, 0.3, True),
        (-0.6, 0.7, False),  # eyes that overlap
        (-0.1, 1.1, False),  # and beyond the middle of the other
        (0.1, 0.3, False),  # holes on one side of their links
        (-0.3, -0.1, False),
    ],
)
def test_a_pin_bends_between_the_faces_that_look_at_each_other(monkeypatch, low, high, apart):
    """Holes of no two links are alike, and reach further up than down; pins rise and fall."""
    case, forces = standing(1)
    frame, height, signs = forces.frame, case.linkage.heights, set()
    least = min(abs(case.linkage.rise(name)) for name in frame.pin_eyes)
    rims = {link: (low * least - 0.01 * k, high * least + 0.02 * k) for k, link in enumerate(height)}
    monkeypatch.setattr(holes, "known_hole", lambda case, joint, link: rims[link])
    found = holes.faces_of(case, frame)
    for name, ((one, _), (other, _)) in frame.pin_eyes.items() if apart else ():
        up = height[other] - height[one]
        near, far = (rims[one][1], rims[other][0]) if up > 0.0 else (rims[one][0], rims[other][1])
        assert tuple(face.near for face in found[name]) == pytest.approx((near / up, 1.0 + far / up))
        signs.add(np.sign(up))
    assert signs == ({-1.0, 1.0} if apart else set())
    assert apart or not found


def test_within_an_eye_is_looked_only_where_its_pin_ends_in_one_wall(monkeypatch):
    """Not where another joint's pin goes on from it, nor in a hole of two walls."""
    case, forces = standing(1)
    (one, *_), eyes = forces.frame.pin_eyes, forces.frame.pin_eyes

    def bounded(pin_eyes):
        faces = holes.faces_of(case, replace(forces.frame, pin_eyes=pin_eyes))
        return {name: tuple(math.isfinite(face.far) for face in own) for name, own in faces.items()}

    both = dict.fromkeys(eyes, (True, True))
    assert bounded(eyes) == both
    assert bounded({**eyes, "more": (("elsewhere", "X"), eyes[one][0])}) == both | {one: (False, True)}
    walls = {eyes[one][1]: ((-2.0, -1.0), (1.0, 2.0))}
    monkeypatch.setattr(holes, "_walls", lambda case, *eye: walls.get(eye, ((-2.0, 2.0),)))
    assert bounded(eyes) == both | {one: (True, False)}


def test_slopes_are_those_of_the_functions():
    _, forces = standing(11)
    aims, v = forces.pins.aims, np.random.default_rng(0).normal(scale=0.01, size=(1, len(forces.pins.value)))
    every = np.repeat(v, aims.count, axis=0)
    slopes = aims.slopes(every, np.arange(aims.count))
    step = 1e-7 * np.eye(v.shape[1])
    expected = (aims.values(v + step) - aims.values(v - step)) / 2e-7
    assert pytest.approx(expected, rel=1e-4, abs=1e-5 * np.abs(expected).max()) == slopes.T


def test_couples_and_thrusts_reach_as_far_either_way_as_any_draw_does():
    """On the ground without a beam, and along all pins; nearly, since a search finds nearly all."""
    _, forces = standing(1)
    pins = forces.pins
    rows = pins.rims.couples @ pins.rims.by_rims
    rows = rows[np.abs(rows).max(axis=1) > pins.rims.noise]
    shares = np.random.default_rng(5).integers(2, size=(300, len(pins.radii.value))).astype(float)
    drawn, told = pins.solved(shares).v @ rows.T, pins.states @ rows.T
    left = 0.02 * np.ptp(drawn, axis=0)
    assert len(rows) > 2
    assert (drawn.max(axis=0) <= told.max(axis=0) + left).all()
    assert (drawn.min(axis=0) >= told.min(axis=0) - left).all()
    alike = pins.solved(np.outer(LEVELS, np.ones(shares.shape[1]))).v  # which are told whatever they make of couples
    assert all(np.abs(pins.states - one).max(axis=1).min() < 1e-9 for one in alike)


def test_the_state_in_which_a_link_bears_least_is_told():
    case, forces = standing(1)
    aims, owners = forces.pins.aims, tuple(dict.fromkeys(forces.pins.aims.ends.owners))
    borne = -aims.stresses(forces.pins.states)
    least = [forces.pins.least(link) for link in case.checked_links]
    assert [
        borne[n, owners.index(("link", x)) - len(owners)] for n, x in zip(least, case.checked_links, strict=True)
    ] == [borne[:, owners.index(("link", link)) - len(owners)].min() for link in case.checked_links]
    assert len(set(least)) > 1
    assert forces.pins.least("base") is None
