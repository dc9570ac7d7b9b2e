"""Springs, tendons and stops that fit nothing are refused in one sentence."""

import math

import pytest
from sprung_cases import CROWN, HANG, LEVER, case_of, stands

from alula.geometry.base.errors import CaseError

ENDS = [{"link": "base", "at": "S"}, {"link": "lever", "at": "H"}]
LINE = {"between": ENDS, "stiffness": "0.5 N/mm", "free_length": "20 mm"}
TURN = {"joint": "O", "stiffness": "3 N*mm/rad", "free_angle": "0 deg"}
CORD = {"through": ENDS, "tension": "2 N"}
LOW = {"joint": "O", "at_least": "-10 deg"}


def without(record, *names):
    return {key: value for key, value in record.items() if key not in names}


@pytest.mark.parametrize(("tables", "sentence"), [
    ({"springs": {"s": {**LINE, "between": [ENDS[0], {"link": "lever", "at": "X"}]}}},
     r"springs\.s\.between\.1\.at: 'X' is no point of link 'lever'; choose one of O, H, P"),
    ({"springs": {"s": {**LINE, "between": [{"link": "no", "at": "S"}, ENDS[1]]}}},
     r"springs\.s\.between\.0\.link: 'no' is no link; choose one of base, lever"),
    ({"springs": {"s": {**LINE, "between": [ENDS[0], {"link": "base", "at": "O"}]}}},
     r"springs\.s: both of its ends are on link 'base'; fasten one to another link"),
    ({"springs": {"s": without(LINE, "free_length")}}, r"springs\.s: it needs either free_length or preload"),
    ({"springs": {"s": {**LINE, "preload": "1 N"}}}, r"springs\.s: it needs either free_length or .* not both"),
    ({"springs": {"s": {**LINE, "stiffness": "0 N/mm"}}}, r"springs\.s\.stiffness \(it is '0 N/mm'\): .*than zero"),
    ({"springs": {"s": {**LINE, "stiffness": "3 N"}}}, r'springs\.s\.stiffness .*"N" is not a unit of stiffness'),
    ({"springs": {"s": without(LINE, "between")}}, r"springs\.s\.between: this entry is missing"),
    ({"springs": {"s": {**LINE, "free_lenght": "1 mm"}}}, r"springs\.s\.free_lenght: .*did you mean 'free_length'"),
    ({"springs": {"s": {**TURN, "joint": "X"}}}, r"springs\.s\.joint: 'X' is no revolute joint that turns; choose"),
    ({"springs": {"s": {**TURN, "stiffness": "3 N/mm"}}}, r'"N/mm" is not a unit of torsional stiffness'),
    ({"springs": {"s": without(TURN, "free_angle")}}, r"springs\.s: it needs either free_angle or preload"),
    ({"tendons": {"t": {**CORD, "stiffness": "1 N/mm"}}}, r"tendons\.t: it needs either a tension, or a stiff"),
    ({"tendons": {"t": {**CORD, "tension": "-1 N"}}}, r"tendons\.t\.tension .*greater than zero"),
    ({"tendons": {"t": {**CORD, "through": ENDS[:1]}}}, r"tendons\.t\.through .*: it has 1, but at least 2"),
    ({"tendons": {"t": {**CORD, "through": [ENDS[1], {"link": "lever", "at": "P"}]}}}, "to another link"),
    ({"tendons": {"t": {**CORD, "through": [ENDS[0], ENDS[0], ENDS[1]]}}}, r"point 'S' of link 'base' .*twice in a"),
    ({"stops": {"k": {**LOW, "joint": "X"}}}, r"stops\.k\.joint: 'X' is no joint that turns, and no slider"),
    ({"stops": {"k": {"joint": "O"}}}, r"stops\.k: it needs either at_least or at_most"),
    ({"stops": {"k": {**LOW, "at_most": "5 deg"}}}, r"stops\.k: it needs either at_least or at_most; .*not both"),
    ({"stops": {"k": {**LOW, "at_least": "5 N"}}}, r'stops\.k\.at_least .*"N" is not a unit of angle.*length such as'),
    ({"stops": {"k": {**LOW, "at_least": "5 mm"}}}, r"stops\.k\.at_least: joint 'O' is revolute, so it needs an angle"),
    ({"stops": {"k": LOW, "m": {"joint": "O", "at_most": "-20 deg"}}}, r"stops\.m\.at_most: .*leave no range"),
    ({"stops": {"k": LOW, "m": LOW}}, r"stops\.m\.at_least: .*another stop of this sense"),
    ({"pose": {"equilibrium": True}}, r"pose\.coordinate: "),
    ({"load_cases": {"a": {}, "b": {}}}, r"pose\.equilibrium: each of the 2 load cases has a balance of its own"),
    ({"load_cases": {"a": {"speed": "5 rpm"}}, "massless": ["lever"]}, r"load_cases\.a\.speed: .*at rest"),
    ({"joints": {"O": {"links": ["base", "lever"], "pin_diameter": "3 mm", "friction": 0.1}}},
     r"joints\.O\.friction: .* stops anywhere about its balance"),
    ({"joint_model": "bonded"}, r"pose\.equilibrium: joint 'O' is bonded"),
])  # fmt: skip
def test_what_does_not_fit_is_refused(tables, sentence):
    with pytest.raises(CaseError, match=sentence):
        case_of(LEVER, **tables)


def test_a_slider_needs_a_travel():
    pose = {"coordinate": "bar", "angle": "50 deg", "equilibrium": True}
    with pytest.raises(CaseError, match=r"stops\.k\.at_least: joint 'T' is a slider, so it needs a travel"):
        case_of(CROWN, pose=pose, stops={"k": {"joint": "T", "at_least": "5 deg"}})


def test_a_stated_pose_beyond_a_stop_is_refused():
    with pytest.raises(CaseError, match=r"angle of lever to base at joint 'O' is 0 deg, .* lets it be 5 deg at least"):
        stands(case_of(LEVER, stops={"k": {"joint": "O", "at_least": "5 deg"}}))


def test_points_that_coincide_leave_a_spring_without_direction():
    links = {"base": {"ground": True, "points": {"O": ["0 mm", "0 mm"], "S": ["40 mm", "0 mm"]}},
             "lever": {"points": {"O": ["0 mm", "0 mm"], "H": ["40 mm", "0 mm"]}}}  # fmt: skip
    pose, drive = {"coordinate": "lever", "angle": "0 deg"}, {"link": "lever", "joint": "O"}
    with pytest.raises(CaseError, match=r"springs\.s: points 'S' of link 'base' and 'H' of link 'lever' coincide"):
        stands(case_of(LEVER, links=links, pose=pose, drive=drive, springs={"s": LINE}))
    free = {**LINE, "free_length": "0 mm"}
    assert stands(case_of(LEVER, links=links, pose=pose, drive=drive, springs={"s": free}))[1].springs[0].effort == 0.0


@pytest.mark.parametrize(("start", "angle"), [("170 deg", 170.0), ("-170 deg", 190.0), ("260 deg", 260.0)])
def test_two_stops_leave_more_than_half_a_turn(start, angle):
    """Angles are reckoned within half a turn of the middle between both stops, here 130 deg."""
    stops = {"k": {"joint": "O", "at_least": "-10 deg"}, "m": {"joint": "O", "at_most": "270 deg"}}
    pose, drive = {"coordinate": "lever", "angle": start}, {"link": "lever", "joint": "O"}
    _, found = stands(case_of(LEVER + HANG, stops=stops, drive=drive, pose=pose))
    assert math.degrees(found.stops["k"]) == pytest.approx(angle)
