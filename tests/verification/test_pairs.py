"""Pairs of side plates: how both share what acts, the pin in double shear, mass and stiffness; closed forms."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from bars_in_layers import TEXT

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.fea.common.plates import pair_forces, plates
from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import solve_frame
from alula.fea.judging.bearing import in_own_eyes, pressing
from alula.fea.outcomes.pins import crossing, shared_stress, stress_at, stresses_between
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.case.layers import slab
from alula.loads.records.applied import BodyForce, LineLoad, PartMass, shifted
from alula.loads.states.actions import stated_loads
from alula.loads.states.masses import laden_masses, part_mass, part_masses, rough_masses
from alula.reports.sentences import told

PLATE, WIDTH, PIN, APART, EYE = 2.5, 10.0, 4.0, 8.0, 2.0
BAR = {"shape": "bar", "material": "aluminium-6061-t6", "fillet_radius": "1 mm", "width": f"{WIDTH} mm"}


def mm(x, y=0.0):
    return [f"{x} mm", f"{y} mm"]


def pulled(*, arm=(), tip=(), base=(), joint=(), force=(100.0, 0.0), load_case=(), top=()):
    """An arm of two plates on the ground, 60 mm long, with a bar between them at B, bonded there and pulled."""
    return validate(
        {
            "schema_version": 1,
            "title": "an arm of two plates",
            "links": {
                "base": {"ground": True, "points": {"A": mm(0), "far": mm(1)}} | dict(base),
                "arm": {"part": "plate", "points": {"A": mm(0), "B": mm(60)}, "count": 2, "apart": f"{APART} mm"}
                | dict(arm),
                "tip": {"part": "bar", "points": {"B": mm(0), "P": mm(40)}} | dict(tip),
            },
            "joints": {
                "A": {"links": ["base", "arm"], "pin_diameter": f"{PIN} mm"},
                "B": {"links": ["arm", "tip"], "pin_diameter": f"{PIN} mm", "bonded": True, "angle": "0 deg"}
                | dict(joint),
            },
            "pose": {"coordinate": "arm", "angle": "0 deg"},
            "drive": {"link": "arm", "joint": "A"},
            "parts": {
                "plate": BAR | {"thickness": f"{PLATE} mm"},
                "bar": BAR | {"thickness": f"{EYE} mm"},
            },
            "load_cases": {
                "pull": {"forces": [{"link": "tip", "at": "P", "force": [f"{x} N" for x in force]}]} | dict(load_case)
            },
            "large_displacement": "off",
            "checks": {"pins": {"type": "pins", "minimum": 1.0}, "eyes": {"type": "bearing", "joints": ["B"]}},
        }
        | dict(top)
    )


def layers(arm, tip, **entries):
    """Changes that put the arm and what lies at B at heights."""
    heights = {"base": 0.0, "arm": arm, "tip": tip}
    return {link: {"z": f"{z} mm"} | entries.get(link, {}) for link, z in heights.items()}


def pin(name, x, wrench, y=0.0, **more):
    return PinLoad(name=name, centre=np.array([x, y, 0.0]), diameter=PIN, wrench=np.array(wrench, float), **more)


def random_loads(rng, places):
    """All kinds of loads in space on a link with pins at some places; the last pin balances them."""
    pins = [pin(f"P{i}", x, rng.normal(size=6) * 10.0, y) for i, (x, y) in enumerate(places)]
    loads = LinkLoads(
        name="all",
        pins=tuple(pins),
        couples=(DriveCouple(pin="P0", torque=7.0),),
        ends=(EndLoad(name="E", point=np.array([75.0, 0.0, 0.0]), wrench=rng.normal(size=6)),),
        inertia=BodyForce(
            link="",
            mass=PartMass(mass=2e-3, centroid=np.array([31.0, 2.0]), inertia=0.7),
            specific_force=np.array([300.0, -9810.0, 0.0]),
            angular_acceleration=40.0,
            angular_speed_squared=90.0,
            axes="link",
        ),
        lines=(LineLoad(link="", start=10.0, end=40.0, at_start=np.array([0.0, -1.0, 0.3]), at_end=np.ones(3)),),
    )
    last = pin("last", 30.0, shifted(-loads.resultant(), np.array([-30.0, -5.0, 0.0])), 5.0)
    return LinkLoads(**{**vars(loads), "pins": (*pins, last)})


@pytest.mark.parametrize("places", [[(0.0, 0.0)], [(0.0, 0.0), (60.0, 0.0)], [(0, 0), (20.0, 9.0), (60.0, -4.0)]])
def test_each_plate_balances_in_space_and_both_make_what_acts_on_the_link(places):
    loads = random_loads(np.random.default_rng(4), places)
    assert np.abs(loads.resultant()).max() < 1e-9
    both = plates(loads, APART)
    assert len(both) == 2
    for plate in both:
        assert np.abs(plate.resultant()).max() < 1e-9
    upper, lower = sorted(both, key=lambda plate: abs(_height(plate, both, loads) - APART / 2.0))
    for number, whole in enumerate(loads.pins):
        above, below = (plate.pins[number].wrench for plate in (upper, lower))
        total = shifted(above, np.array([0, 0, APART / 2.0])) + shifted(below, np.array([0, 0, -APART / 2.0]))
        assert total == pytest.approx(whole.wrench, abs=1e-9)


def _height(plate, both, loads):
    """z of a plate by the first pin's couple: the plate and its mate at z and -z make the couple of the link."""
    other = next(one for one in both if one is not plate)
    own, mate, whole = (one.pins[0].wrench for one in (plate, other, loads))
    difference = own[:2] - mate[:2]
    rest = (whole - own - mate)[3:5]
    return float(np.array([-difference[1], difference[0]]) @ rest / (difference @ difference))


def test_force_off_the_middle_follows_the_lever_law():
    """F at e off the middle of a span a, as of a beam on two supports: F (a/2 + e)/a and F (a/2 - e)/a."""
    force, off = 100.0, 1.5
    wrench = np.array([force, 0.0, 0.0, 0.0, off * force, 0.0])  # (0, 0, e) x F
    near, far = plates(LinkLoads(name="", pins=(pin("A", 0.0, -wrench), pin("B", 60.0, wrench))), APART)
    for plate, share in ((near, 0.5 + off / APART), (far, 0.5 - off / APART)):
        assert plate.pins[1].wrench == pytest.approx([share * force, 0, 0, 0, 0, 0])
        assert plate.pins[0].wrench == pytest.approx([-share * force, 0, 0, 0, 0, 0])


def test_a_force_along_the_pins_sways_the_plates_as_columns_of_a_portal_frame():
    """Two equal columns of length L between stiff beams under H: end moments H L/4 each, normal forces H L/(2 a)."""
    sway, length = 12.0, 60.0
    pins = (pin("A", 0.0, [0, 0, -sway, 0, sway * length, 0]), pin("B", length, [0, 0, sway, 0, 0, 0]))
    loads = LinkLoads(name="", pins=pins)
    assert np.abs(loads.resultant()).max() == 0.0
    for plate in plates(loads, APART):
        normal, moments = [one.wrench[0] for one in plate.pins], [one.wrench[4] for one in plate.pins]
        assert np.abs(normal) == pytest.approx([sway * length / 2.0 / APART] * 2)
        assert np.abs(moments) == pytest.approx([sway * length / 4.0] * 2)


def test_twist_between_two_pins_is_borne_by_the_plates_themselves():
    """Pairs of forces across the link would turn a plate about its pins, which are free to turn."""
    loads = LinkLoads(name="", pins=(pin("A", 0.0, [0, 0, 0, -9.0, 0, 0]), pin("B", 60.0, [0, 0, 0, 9.0, 0, 0])))
    [plate] = plates(loads, APART)
    assert [one.wrench[3] for one in plate.pins] == pytest.approx([-4.5, 4.5])


def test_a_slot_holds_no_force_along_it():
    loads = LinkLoads(name="", pins=(pin("A", 0.0, np.ones(6)), pin("S", 60.0, [0, 1, 0, 3, 5, 0], slotted=True)))
    assert pair_forces(loads.pins, APART)[:, 0] == pytest.approx([0.0, 0.0])


def test_poses_share_as_each_of_them_does():
    rng = np.random.default_rng(7)
    wrenches, xs = rng.normal(size=(5, 2, 6)), 50.0 + rng.normal(size=5)
    centre = np.zeros((5, 3))
    centre[:, 0] = xs
    pins = (
        PinLoad(name="A", centre=np.zeros((5, 3)), diameter=PIN, wrench=wrenches[:, 0]),
        PinLoad(name="S", centre=centre, diameter=PIN, wrench=wrenches[:, 1]),
    )
    every = pair_forces(pins, APART)
    for i in range(5):
        one = (pin("A", 0.0, wrenches[i, 0]), pin("S", xs[i], wrenches[i, 1]))
        assert every[i] == pytest.approx(pair_forces(one, APART))


def test_a_clevis_of_two_plates_bears_half_in_each():
    case = pulled(force=(100.0, 0.0))
    result = check_case(case, fidelity="beam").load_cases["pull"]
    arm = result.links["arm"]
    assert arm.beam.worst.axial == pytest.approx(50.0 / (WIDTH * PLATE))
    assert "one of two equal plates, 8 mm apart" in arm.notes[0]
    assert not any("plates" in told(note) for note in result.links["tip"].notes)
    # Of the pin: simply supported at the middles of the plates, even load on the eye: F L/4 - F h/8.
    moment = 100.0 * APART / 4.0 - 100.0 * EYE / 8.0
    assert result.pins["B"].moment.high == pytest.approx(moment)
    # Shigley's pin in a fork: F/2 (t1/2 + g + h/4)
    free = (APART - PLATE - EYE) / 2.0
    assert moment == pytest.approx(50.0 * (PLATE / 2.0 + free + EYE / 4.0))
    assert result.pins["B"].shear == pytest.approx(
        50.0 * (3 + 2 * 0.3) / (2 + 2 * 0.3) * 4 / (math.pi * PIN**2), rel=0.01
    )
    bearing = next(check for check in result.checks if check.name == "eyes")
    strength = case.material_of("tip").ultimate_strength
    assert bearing.value.value == pytest.approx(strength / (100.0 / (PIN * EYE)))  # the eye between is the weaker


def test_two_plates_bend_half_as_far_and_weigh_twice():
    moved, cases = [], [pulled(force=(0.0, -3.0)), pulled(arm={"count": 1, "apart": None}, force=(0.0, -3.0))]
    for case in cases:
        [load_case] = case.load_cases.values()
        frame = build_frame(case, case.solve_pose(), stated_loads(case, load_case), held=case.pinned_drive)
        moved.append(solve_frame(frame.model).displacements[frame.points["arm", "B"]])
    assert moved[0] == pytest.approx(moved[1] / 2.0)
    two, one = (part_mass(case, "arm") for case in cases)
    assert (two.mass, two.inertia) == pytest.approx((2.0 * one.mass, 2.0 * one.inertia))
    assert two.centroid == pytest.approx(one.centroid)
    assert rough_masses(cases[0])["arm"] == pytest.approx(2.0 * rough_masses(cases[1])["arm"])


def test_the_arm_of_a_pair_bends_half_as_far():
    """From M to Q, at both of which dyads hang that bear nothing."""
    moved = []
    ends = {"M": ("rod", "strut", mm(30, -60)), "Q": ("rod-2", "strut-2", mm(30, 85))}
    links = {
        "base": {"ground": True, "points": {"A": mm(0)} | {f"G{at}": place for at, (*_, place) in ends.items()}},
        "arm": {"part": "plate", "points": {"A": mm(0), "B": mm(60), "M": mm(30), "Q": mm(30, 25)}, "arms": {"Q": "M"}},
    }
    joints = {"A": ["base", "arm"]}
    for at, (rod, strut, _) in ends.items():
        links[rod] = {"part": "bar", "points": {at: mm(0), f"R{at}": mm(40)}}
        links[strut] = {"part": "bar", "points": {f"G{at}": mm(0), f"R{at}": mm(40)}}
        joints |= {at: ["arm", rod], f"R{at}": [rod, strut], f"G{at}": ["base", strut]}
    near = {"rod": "-45 deg", "strut": "45 deg", "rod-2": "45 deg", "strut-2": "-45 deg"}
    for plates_of in ({"count": 2, "apart": f"{APART} mm"}, {}):
        case = validate(
            {
                "schema_version": 1,
                "title": "an arm across two plates",
                "links": links | {"arm": links["arm"] | plates_of},
                "joints": {name: {"links": pair, "pin_diameter": f"{PIN} mm"} for name, pair in joints.items()},
                "pose": {"coordinate": "arm", "angle": "0 deg", "near": near},
                "drive": {"link": "arm", "joint": "A"},
                "parts": {"plate": BAR | {"thickness": f"{PLATE} mm"}, "bar": BAR | {"thickness": f"{EYE} mm"}},
                "load_cases": {"l": {"forces": [{"link": "arm", "at": "Q", "force": ["40 N", "0 N"]}]}},
            }
        )
        frame = build_frame(case, case.solve_pose(), stated_loads(case, case.load_cases["l"]), held=case.pinned_drive)
        foot, tip = solve_frame(frame.model).displacements[[frame.points["arm", name] for name in "MQ"]]
        moved.append((foot, tip, tip[:2] - foot[:2] - 25.0 * foot[5] * np.array([-1.0, 0.0])))
    for pair, plate in zip(*moved, strict=True):
        assert pair == pytest.approx(plate / 2.0, abs=1e-9)
    assert abs(moved[1][2][0]) > 1e-3  # the arm itself bends


def test_what_a_pair_carries_weighs_once():
    case = pulled(load_case={"own_weight": False}, top={"carried": [{"link": "arm", "mass": "20 g", "at": "B"}]})
    bare = part_mass(pulled(arm={"count": 1, "apart": None}), "arm").mass
    assert laden_masses(case, part_masses(case))["arm"].mass == pytest.approx(2.0 * bare + 2e-5)


def off_the_middle(off, **coupler):
    """Parallel bars whose coupler is a pair; crank and rocker lie between its plates, off their middle."""
    text = TEXT.format(
        layers=(0, 0, 0, 0),
        a=120.0,
        b=100.0,
        c=120.0,
        d=100.0,
        start=60.0,
        end=30.0,
        near=(0.0, 60.0),
        width=16.0,
        pin=8.0,
    )
    data = tomllib.loads(text)
    del data["layer_spacing"]
    for name, link in data["links"].items():
        del link["layer"]
        link["z"] = "0 mm" if name == "coupler" else f"{off} mm"
    data["links"]["coupler"] |= {"count": 2, "apart": "20 mm"} | coupler
    data["checks"] = {"eyes": {"type": "bearing"}, "pins": {"type": "pins", "minimum": 1.0}}
    return validate(data)


def borne_by_plates(case, reactions):
    """The same forces, with no couple of the pins at B and C on the bars."""
    joints = dict(reactions.joints)
    for name in "BC":
        wrench, rise = joints[name].wrench.copy(), case.linkage.rise(name)
        wrench[3:5] = (rise * wrench[1], -rise * wrench[0]) if case.joints[name].links[1] == "coupler" else 0.0
        joints[name] = replace(joints[name], wrench=wrench)
    return replace(reactions, joints=joints)


def test_bars_off_the_middle_of_a_pair_between_layers():
    """Where the bars bear no couple, as on rounded bores, the plates bear all of it, by the lever law."""
    off, span = 3.0, 20.0
    case = off_the_middle(off)
    assert slab(case, "coupler") == (-13.0, 13.0)
    statics = check_case(case, fidelity="beam").load_cases["lift"]
    tilts = borne_by_plates(case, statics.forces.reactions)
    force = float(np.hypot(*tilts.joints["C"].wrench[:2]))
    assert force > 0.1
    near, far = plates(link_loads("lift", "coupler", case.body("coupler"), tilts, statics.loads), span)
    for plate, share in ((near, 0.5 + off / span), (far, 0.5 - off / span)):
        for pin_load in plate.pins:
            assert np.linalg.norm(pin_load.wrench[:2]) == pytest.approx(share * force, rel=1e-3)
            assert np.abs(pin_load.wrench[3:5]).max() < 1e-2 * force
    pressed = {link: pressing(case, link, one) for link, one in in_own_eyes(case, "C", tilts.joints).items()}
    assert pressed["coupler"] == pytest.approx(2.0 * (0.5 + off / span) * force, rel=1e-3)
    assert pressed["rocker"] == pytest.approx(force)
    assert statics.links["coupler"].von_mises_max.high >= (0.5 + off / span) * force / (16.0 * 6.0) * (1.0 - 1e-3)
    # The pin: a beam on the plates with R = F (1/2 + e/a) in the nearer one, under the bar's even load; t and h 6 mm.
    near_share, step = (0.5 + off / span) * force, 1e-3
    z = np.arange(0.0, span + 6.0, step)
    pressure = -near_share / 6.0 * (z < 6.0) - (force - near_share) / 6.0 * (z > span)
    middle = span / 2.0 + 3.0 - off
    pressure += force / 6.0 * (np.abs(z - middle) < 3.0)
    bending = np.abs(np.cumsum(np.cumsum(pressure)) * step**2).max()
    assert stress_at(case, "C", tilts.joints).moment.value == pytest.approx(bending, rel=0.02)


def test_between_the_plates_of_a_pair_no_place_of_the_pin_need_bear_the_whole_force():
    """Half of it crosses each gap: a short thick pin bears less than the whole in shear, in every state."""
    case = off_the_middle(0.05, apart="12.2 mm")
    forces = solve_case_statics(case).forces["lift"]
    found, every = shared_stress(case, "C", forces.reactions.joints, forces), (forces.reactions, *forces.sharings)
    states = stresses_between(case, "C", {"C": np.array([one.joints["C"].wrench for one in every])})
    assert found.equivalent.low < min(one.equivalent.value for one in states)
    least = np.sqrt(3.0) * min(one.shear for one in states)
    assert 0.9 * least < crossing(case, "C", [forces.reactions.joints]) <= least


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"arm": {"count": 3}}, r"links\.arm\.count"),
        ({"arm": {"count": 0}}, r"links\.arm\.count"),
        ({"arm": {"apart": None}}, r"links\.arm\.apart: it is missing"),
        ({"arm": {"count": 1}}, r"links\.arm\.apart: only a pair of plates has it"),
        ({"arm": {"apart": f"{PLATE} mm"}}, r"links\.arm\.apart: 2.5 mm .* leave no room"),
        ({"arm": {"apart": "4.4 mm"}}, r"joints\.B: the plates of link 'arm' leave 1.9 mm .* 'tip', 2 mm thick, runs"),
        (layers(0.0, 2.0), r"joints\.B: .* 2 mm off the pair's middle, runs into one"),
        ({"base": {"count": 2, "apart": "9 mm"}}, r"links\.base\.count: the ground is no pair"),
        ({"tip": {"part": None, "count": 2, "apart": "20 mm"}}, r"links\.tip\.count: .* its part twice"),
        ({"arm": {"eyes": {"B": {"fork": "1 mm"}}}}, r"links\.arm\.eyes\.B\.fork: the plates of a pair have no forks"),
        ({"joint": {"pin_gap": "1 mm"}}, r"joints\.B\.pin_gap: it is 1 mm, but plates and eye leave 1.75 mm"),
    ],
)
def test_what_does_not_fit_is_refused(changes, said):
    with pytest.raises(CaseError, match=said):
        pulled(**changes)
