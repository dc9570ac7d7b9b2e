"""A link that is made of a part from a STEP file."""

import os
import tomllib

import numpy as np
import pytest
from imported_case import imported_case

from alula.fea.beam.cut_beam import beam_sections, cut_remark
from alula.geometry.base.errors import AlulaError, CannotRunError, CaseError
from alula.geometry.imported import read
from alula.geometry.keeping.kept import keeping
from alula.geometry.meshing.mesh import COARSE, mass_properties, mesh_body, reentrant_edges
from alula.loads.case.case_file import read_case, read_text, validate
from alula.reports.sentences import told

FROM_PART = '"from-part"'
NAMED = 'bores = { O4 = "bore 1", B = "bore 2" }'


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return read_case(str(imported_case(tmp_path_factory.mktemp("imported"))))


def test_stated_points_move_to_the_bores(case):
    assert case.links["rocker"].points["B"][0] - case.links["rocker"].points["O4"][0] == pytest.approx(40.0, abs=1e-8)
    body = case.body("rocker")
    assert [(pin.name, pin.diameter) for pin in body.pins] == [("O4", 5.0), ("B", pytest.approx(6.0))]
    assert [(pin.ring.low, pin.ring.high) for pin in body.pins] == [(pytest.approx(-2.5), pytest.approx(2.5))] * 2


def test_points_from_the_part_are_those_of_its_bores(tmp_path):
    case = read_case(str(imported_case(tmp_path, points=FROM_PART, entries=NAMED)))
    assert case.links["rocker"].points["O4"] == (0.0, 0.0)
    assert case.links["rocker"].points["B"] == pytest.approx((40.0, 0.0))


def test_mass_is_that_of_the_file_in_the_frame_of_the_link(case):
    """By closed form; the points stand 20.01 mm from the middle of the plate, and the boss lies off the plane."""
    found = mass_properties(case.body("rocker"))
    boss = np.pi * 5.0**2 * 4.0
    plate = 60.0 * 20.0 * 5.0 - np.pi * 2.5**2 * 5.0 - np.pi * 3.0**2 * 5.0
    assert found.volume == pytest.approx(plate + boss, rel=1e-6)
    off = -np.pi / 4.0 * 5.0 * (6.0**2 - 5.0**2) * 20.0 / (plate + boss)
    assert found.centroid[0] == pytest.approx(20.01 + off, abs=1e-4)
    assert abs(found.centroid[2]) == pytest.approx(boss * 4.5 / (plate + boss), rel=1e-5)


def test_it_meshes_with_its_bores_and_rings(case):
    body = case.body("rocker")
    mesh = mesh_body(body, COARSE)
    assert set(mesh.surfaces) == {f"{kind}:{pin}" for kind in ("bore", "top", "bottom") for pin in ("O4", "B")}
    for pin in body.pins:
        assert mesh.areas[f"bore:{pin.name}"] == pytest.approx(np.pi * pin.diameter * 5.0, rel=1e-6)
        ring = pin.ring.diameter
        assert mesh.areas[f"top:{pin.name}"] == pytest.approx(np.pi / 4.0 * (ring**2 - pin.diameter**2), rel=1e-5)
    assert mesh.mirror is None  # the boss stands on one side
    edges = reentrant_edges(body)
    assert len(edges) == 1  # round the foot of the boss
    assert np.hypot(*(edges[0].points - [20.01, 0.0, 0.0])[:, :2].T) == pytest.approx(5.0, abs=1e-4)


def test_sections_are_those_of_the_plate(case):
    section = case.part_of("rocker").section
    assert section.area == pytest.approx(100.0, rel=0.1)
    assert section.width == pytest.approx(20.0, rel=1e-4)


def test_a_plate_says_that_it_is_no_beam(case):
    """Its pins are 40 mm apart, and it is 20 mm wide."""
    assert beam_sections(case.body("rocker")) == ()
    assert told(cut_remark(case.body("rocker"))).startswith("the part is no beam")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"file": "shell.step"}, "holds only surfaces without volume"),
        ({"file": "nothing.step"}, r"^parts\.own\.file: there is no file"),
        ({"file": "case.toml"}, "is no STEP file"),
        ({"points": '{ O4 = ["0 mm", "0 mm"], B = ["41 mm", "0 mm"] }'}, "no parallel bores lie as the link's points"),
        ({"points": FROM_PART}, "it must name two points or more"),
        ({"entries": 'bores = { O4 = "bore 7" }'}, "has no bore 'bore 7'; its bores are bore 1 .5 mm., bore 2 .6 mm."),
        ({"entries": 'bores = { O4 = "bore 2" }'}, "pin at O4 has a diameter of 5 mm, but bore 2 has 6 mm"),
    ],
)
def test_what_does_not_fit_is_one_sentence(tmp_path, change, said):
    with pytest.raises(CaseError, match=said) as found:
        read_case(str(imported_case(tmp_path, **change)))
    assert "\n" not in str(found.value)
    assert "own" in str(found.value) or "links.rocker" in str(found.value)


def test_from_part_needs_an_imported_part(tmp_path):
    path = imported_case(tmp_path)
    text = (
        path.read_text()
        .replace('A = ["0 mm", "0 mm"], B = ["60 mm", "0 mm"] }', "X = 1 }")
        .replace("{ X = 1 }", '"from-part"')
    )
    path.write_text(text)
    with pytest.raises(CaseError, match=r'links.coupler.points: "from-part" needs a part of shape "step"'):
        read_case(str(path))


def test_a_file_that_changes_meanwhile_is_noticed(tmp_path):
    case = read_case(str(imported_case(tmp_path)))
    body = case.body("rocker")
    with open(tmp_path / "plate.step", "a", encoding="ascii") as stream:
        stream.write(" ")
    os.utime(tmp_path / "plate.step")
    moved = body.part.model_copy(update={"shift": (0.0, 0.0, 1.0)})  # no worker has built it
    with pytest.raises(AlulaError, match=r"plate.step.* changed while it was used"):
        mass_properties(type(body)(part=moved, pins=body.pins, ends=(), holes=()))


def test_a_file_that_changes_while_it_is_read_is_not_kept_for_what_it_was(tmp_path, monkeypatch):
    monkeypatch.setenv("ALULA_CACHE", str(tmp_path / "cache"))
    imported_case(tmp_path)
    file, asked = tmp_path / "plate.step", []

    def kernel(*request, **limits):
        asked.append(request)
        if len(asked) == 1:
            file.write_bytes(file.read_bytes() + b" ")
        return "found"

    monkeypatch.setattr(read, "ask_kernel", kernel)
    before = file.read_bytes()
    with keeping() as store, pytest.raises(CannotRunError, match=r"plate.step.* changed while it was read"):
        read.part_surface(file)
    assert not list(store.folder.iterdir())
    file.write_bytes(before)
    assert read.part_surface(file) == "found"


@pytest.mark.parametrize(
    ("place", "size", "faces"),
    [(("50 mm", "0 mm"), 5.0, 1), (("10 mm", "-6.5 mm"), 5.0, 2), (("10 mm", "-6.5 mm"), 2.0, 2)],
    ids=["on the end face", "between top and bottom", "deeper below them than half the circle"],
)
def test_a_load_point_has_a_patch_on_the_nearest_faces(tmp_path, place, size, faces):
    """One circle on the face at x = 50, or one each on top and bottom, 2.5 mm away, which are equally near."""
    points = f'{{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"], P = ["{place[0]}", "{place[1]}"] }}'
    case = read_case(str(imported_case(tmp_path, points=f'{points}, end_patch = "{size} mm"')))
    mesh = mesh_body(case.body("rocker"), COARSE)
    assert mesh.areas["end:P"] == pytest.approx(faces * np.pi / 4.0 * size**2, rel=1e-5)


def test_a_load_point_beside_the_part_is_refused(tmp_path):
    points = '{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"], P = ["70 mm", "0 mm"] }'
    case = read_case(str(imported_case(tmp_path, points=points)))
    with pytest.raises(CaseError, match="the load point P lies outside of the part"):
        mesh_body(case.body("rocker"), COARSE)


def test_a_load_point_in_a_bore_without_a_joint_is_a_pin_there(tmp_path):
    """The third bore of the bell crank takes its load as one-sided pressure; it stands between the joints' pins."""
    points = '{ O4 = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"], P = ["0.03 mm", "-40 mm"] }'
    path = imported_case(tmp_path, file="bell_crank.step", points=points)
    path.write_text(
        path.read_text().replace('"5 mm" }', '"x" }').replace('"6 mm" }', '"5 mm" }').replace('"x" }', '"6 mm" }')
    )
    case = read_case(str(path))
    body = case.body("rocker")
    assert [(pin.name, pin.diameter) for pin in body.pins] == [("O4", 6.0), ("P", 4.0), ("B", 5.0)]
    assert body.ends == ()
    assert case.links["rocker"].points["P"] == pytest.approx((0.0, -40.0), abs=0.02)
    path.write_text(path.read_text() + 'bores = { P = "bore 2" }\n')
    with pytest.raises(CaseError, match=r"the point P stands .* mm from bore 2"):
        read_case(str(path))


def test_the_gap_of_a_fork_is_no_wall(tmp_path):
    """A bore of 5 mm in two cheeks of 4 mm with 8 mm between them, beside a bore of 6 mm through 16 mm."""
    path = imported_case(tmp_path, file="fork.step", points='{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"] }')
    body = read_case(str(path)).body("rocker")
    fork, plain = body.ring(body.pins[0]), body.ring(body.pins[1])
    assert (fork.thickness, fork.height) == (pytest.approx(8.0), pytest.approx(16.0))
    assert fork.gaps == ((pytest.approx(-4.0), pytest.approx(4.0)),)
    assert (plain.thickness, plain.gaps) == (pytest.approx(16.0), ())
    mesh = mesh_body(body, COARSE)
    assert mesh.areas["bore:O4"] == pytest.approx(np.pi * 5.0 * 8.0, rel=1e-6)
    assert mesh.mirror is not None


def test_of_a_bore_that_is_not_round_all_the_way_the_mesh_has_what_is_there(tmp_path):
    """One with a keyway of 2 mm, and one that the end of the part cuts 2 mm from its middle; both of 6 mm."""
    named = 'bores = { O4 = "bore 1", B = "bore 6" }'
    path = imported_case(tmp_path, file="open_bores.step", points=FROM_PART, entries=named)
    path.write_text(path.read_text().replace('pin_diameter = "5 mm"', 'pin_diameter = "6 mm"'), encoding="utf-8")
    mesh = mesh_body(read_case(str(path)).body("rocker"), COARSE)
    shares = {"bore:O4": 1.0 - np.arcsin(1.0 / 3.0) / np.pi, "bore:B": 1.0 - np.arccos(2.0 / 3.0) / np.pi}
    # There are no flat rings.
    assert mesh.areas == pytest.approx({name: share * np.pi * 6.0 * 6.0 for name, share in shares.items()}, rel=1e-4)


def test_a_shape_that_is_a_table_is_refused_like_any_other(tmp_path):
    path = imported_case(tmp_path)
    path.write_text(path.read_text().replace('shape = "step"', "shape = { step = 1 }"))
    with pytest.raises(CaseError, match=r"parts\.own"):
        read_case(str(path))


@pytest.mark.parametrize(
    "entry",
    [
        'eyes = { B = { diameter = "14 mm" } }',
        'arms = { B = "O4" }',
    ],
)
def test_features_that_a_file_cannot_take_are_not_ignored(tmp_path, entry):
    path = imported_case(tmp_path)
    path.write_text(path.read_text().replace('part = "own",', f'part = "own", {entry},'))
    name = entry.partition(" ")[0]
    with pytest.raises(CaseError, match=rf"links\.rocker\.{name}\.B: a part of shape step takes no {name}"):
        read_case(str(path))


def test_a_missing_pin_diameter_is_named(tmp_path):
    path = imported_case(tmp_path)
    path.write_text(path.read_text().replace(', pin_diameter = "5 mm"', ""))
    with pytest.raises(CaseError, match=r"joints\.O4\.pin_diameter: .* needs a diameter"):
        read_case(str(path))


@pytest.mark.parametrize("name", ["\U0010ffff", "bell\ncrank"])
def test_what_does_not_print_comes_into_no_sentence(name: str) -> None:
    """Neither as the name of a link, which is refused later than its part is read, nor as that of a file."""
    link, file = (tomllib.loads(read_text("step")[0]) for _ in range(2))
    link["links"][name] = link["links"].pop("bell-crank")
    link["parts"]["bell-crank"]["file"] = "nowhere.step"
    file["parts"]["bell-crank"]["file"] = f"{name}.step"
    for data, said in ((link, "there is no file"), (file, "characters that do not print")):
        with pytest.raises(CaseError, match=said) as refused:
            validate(data)
        assert str(refused.value).isprintable()
