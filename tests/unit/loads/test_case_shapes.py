"""What a case may say about plates, strips and eyes of their own, and what the program answers."""

import tomllib
from dataclasses import replace

import pytest

from alula.fea.check.run import check_case
from alula.fea.common.verdict import Verdict
from alula.geometry.base.errors import CaseError
from alula.geometry.parts.part import Bar, Body, Plate, Ring
from alula.loads.case.case import Case
from alula.loads.case.case_file import validate
from alula.loads.case.core import CoreCase
from alula.reports.sentences import told

FOUR_BAR = """
schema_version = 1
title = "A four-bar with a ternary coupler"
[links.ground]
ground = true
points.O = ["0 mm", "0 mm"]
points.D = ["70 mm", "0 mm"]
[links.crank]
points.O = ["0 mm", "0 mm"]
points.A = ["25 mm", "0 mm"]
part = "bar"
eyes.A = { diameter = "15 mm", thickness = "6 mm" }
[links.coupler]
points.A = ["0 mm", "0 mm"]
points.B = ["60 mm", "0 mm"]
points.C = ["22 mm", "34 mm"]
part = "plate"
eyes.C = { diameter = "16 mm" }
[links.rocker]
points.B = ["0 mm", "0 mm"]
points.D = ["50 mm", "0 mm"]
[links.rod]
points.C = ["0 mm", "0 mm"]
points.G = ["40 mm", "0 mm"]
[links.slide]
points.G = ["0 mm", "0 mm"]
points.S = ["10 mm", "0 mm"]
[joints]
O = { links = ["ground", "crank"], pin_diameter = "5 mm" }
A = { links = ["crank", "coupler"], pin_diameter = "5 mm" }
B = { links = ["coupler", "rocker"], pin_diameter = "4 mm" }
D = { links = ["ground", "rocker"] }
C = { links = ["coupler", "rod"], pin_diameter = "6 mm" }
G = { links = ["rod", "slide"] }
S = { links = ["ground", "slide"], type = "slider", points = ["O", "S"], direction = "0 deg" }
[pose]
coordinate = "crank"
angle = "60 deg"
near = { coupler = "-69 deg", rocker = "44 deg", rod = "-19 deg" }
[drive]
link = "crank"
joint = "O"
[parts.bar]
shape = "bar"
material = "steel-wire"
width = "9 mm"
thickness = "3 mm"
fillet_radius = "1 mm"
[parts.plate]
shape = "plate"
material = "steel-wire"
thickness = "3 mm"
eye_diameter = "12 mm"
holes = [{ x = "25 mm", y = "10 mm", diameter = "8 mm" }]
[load_cases.push]
forces = [{ link = "slide", at = "S", force = ["10 N", "0 N"] }]
"""


def case(old: str = "", new: str = "") -> Case:
    assert old in FOUR_BAR
    return validate(tomllib.loads(FOUR_BAR.replace(old, new, 1)))


def test_an_eye_of_its_own_keeps_what_it_does_not_state() -> None:
    found = case()
    crank, coupler = found.body("crank"), found.body("coupler")
    assert crank.ring(crank.pin("A")) == Ring(diameter=15.0, low=-3.0, high=3.0)
    assert crank.ring(crank.pin("O")) == Ring(diameter=1.6 * 9.0, low=-1.5, high=1.5)
    assert coupler.ring(coupler.pin("C")) == Ring(diameter=16.0, low=-1.5, high=1.5)
    assert coupler.ring(coupler.pin("B")) == Ring(diameter=12.0, low=-1.5, high=1.5)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("eyes.A = {", "eyes.X = {", r"links.crank.eyes: 'X' is no point with a joint.*O, A"),
        ('diameter = "15 mm"', 'diameter = "8 mm"', r"links.crank: the eye at A has sizes.*8 mm must be at least"),
        ('thickness = "6 mm"', 'thickness = "4 mm"', r"links.crank: the eye at A .*4 mm makes a step too low"),
        ('{ diameter = "16 mm" }', '{ thickness = "4 mm" }', "links.coupler: the eye at C is 4 mm thick.*plate, 3 mm"),
        ('{ diameter = "16 mm" }', '{ diameter = "6 mm" }', "links.coupler: the pin hole at C has a diameter of 6 mm"),
        ('points.G = ["40 mm", "0 mm"]\n', 'points.G = ["40 mm", "0 mm"]\neyes.C = {}\n', "rod.part: it is missing"),
        ('points.C = ["22', 'points.W = ["6 mm", "0 mm"]\npoints.C = ["22', "W is 5 mm wide, but the eye at A"),
        ('points.C = ["22', 'points.W = ["9 mm", "3 mm"]\nend_patch = "9 mm"\npoints.C = ["22', "W is 9 mm wide"),
        ('points.C = ["22', 'points.W = ["25 mm", "4 mm"]\npoints.C = ["22', r"a wall of 0 mm to the patch of W"),
        ('eye_diameter = "12', 'fillet_radius = "9 mm"\neye_diameter = "12', "coupler: fillet_radius 9 mm is too"),
        ('fillet_radius = "1 mm"', 'fillet_radius = "0 mm"\nends = "square"', "parts.bar.*overhang is missing"),
        ('fillet_radius = "1 mm"', 'fillet_radius = "1 mm"\noverhang = "9 mm"', 'parts.bar.*belongs to ends'),
        (
            'fillet_radius = "1 mm"', 'fillet_radius = "0 mm"\nends = "square"\noverhang = "9 mm"',
            'links.crank: the eye at A.*ends = "square" has no eyes',
        ),
        (
            'fillet_radius = "1 mm"',
            'fillet_radius = "0 mm"\nends = "square"\noverhang = "9 mm"\neye_diameter = "12 mm"',
            'parts.bar.*ends = "square" has no eyes; leave eye_diameter',
        ),
    ],
)  # fmt: skip
def test_shapes_that_do_not_fit_are_refused(old: str, new: str, message: str) -> None:
    with pytest.raises(CaseError, match=message):
        case(old, new)


def test_a_torque_on_flat_faces_is_refused_where_there_are_none(monkeypatch: pytest.MonkeyPatch) -> None:
    stated = ('joint = "O"', 'joint = "O"\ntransfer = "eye-faces"')
    assert case(*stated).drive is not None
    whole = CoreCase.body

    def bare(self: CoreCase, link: str) -> Body:
        body = whole(self, link)
        half = body.part.eye_thickness / 2.0
        return replace(body, pins=tuple(replace(p, ring=Ring(diameter=0.0, low=-half, high=half)) for p in body.pins))

    monkeypatch.setattr(CoreCase, "body", bare)
    monkeypatch.setattr(Bar, "check", lambda self, body: None)
    monkeypatch.setattr(Plate, "check", lambda self, body: None)
    case()
    with pytest.raises(CaseError, match=r"drive.transfer: the part of link crank has no flat ring.* at O.*bore-shear"):
        case(*stated)


def test_how_far_a_plate_gives_is_left_open() -> None:
    """The frame takes it for a strip, and pins off its axis for rigidly joined."""
    check = '[checks.far]\ntype = "displacement"\nat = "C"\nlink = "coupler"\nmaximum = "9 mm"\n\n[load_cases.push]'
    found = check_case(case("[load_cases.push]", check), name="four-bar", fidelity="beam")
    outcome = next(outcome for outcome in found.load_cases["push"].checks if outcome.name == "far")
    assert outcome.verdict is Verdict.UNDECIDED
    assert "takes link coupler for a beam along its axis" in told(outcome.reason)
