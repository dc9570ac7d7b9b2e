"""Meshing of bodies: what comes back, and what a mesher's failure turns into."""

import dataclasses
import math
import os
import re
import sys
from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from mesh_measures import shape_quality, volumes_and_moments

import alula.geometry.base.child_server
import alula.geometry.meshing.mesh
from alula.geometry.base.child_memory import allowed
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.imported.read import part_facts
from alula.geometry.meshing.element_geometry import TETRA_EDGES, scaled_jacobians
from alula.geometry.meshing.mesh import (
    COARSE,
    MeshSettings,
    export_step,
    mass_properties,
    mesh_bodies,
    mesh_body,
    reentrant_edges,
)
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube


def tube_body(unit: float = 1.0, **changes: str) -> Body:
    """Return a tube with an eye, two feather holes and a plain end; lengths in multiples of a unit [mm]."""
    sizes = {
        "outer_diameter": 5.0,
        "inner_diameter": 2.5,
        "eye_diameter": 8.0,
        "eye_thickness": 7.0,
        "fillet_radius": 0.8,
    }
    part = Tube.model_validate(
        {"shape": "tube", "material": "pvc"} | {k: f"{v * unit!r} mm" for k, v in sizes.items()} | changes
    )
    holes = HoleRow.model_validate(
        {"count": 2, "diameter": f"{unit!r} mm", "first": f"{7 * unit!r} mm", "last": f"{9 * unit!r} mm", "along": "y"}
    )
    return Body(
        part=part,
        pins=(Pin(name="A", x=0.0, y=0.0, diameter=1.5 * unit),),
        ends=(PlainEnd(name="H", x=15.0 * unit, patch=4.0 * unit),),
        holes=(holes,),
    )


def bar_body(fillet: str = "1 mm", eye_thickness: str = "3 mm") -> Body:
    part = Bar.model_validate(
        {
            "shape": "bar",
            "material": "resin",
            "width": "5 mm",
            "thickness": "3 mm",
            "eye_diameter": "9 mm",
            "eye_thickness": eye_thickness,
            "fillet_radius": fillet,
        }
    )
    pins = (Pin(name="A", x=0.0, y=0.0, diameter=1.5), Pin(name="B", x=15.0, y=0.5, diameter=1.5))
    return Body(part=part, pins=pins, ends=(), holes=())


@pytest.fixture(scope="module")
def mesh() -> TaggedMesh:
    return mesh_body(tube_body(), COARSE)


def test_elements_are_valid_and_in_vtk_order(mesh: TaggedMesh) -> None:
    assert mesh.curved
    assert (volumes_and_moments(mesh.points, mesh.cells)[0] > 0.0).all()
    assert scaled_jacobians(mesh.points, mesh.cells).min() >= 0.1
    assert shape_quality(mesh.points, mesh.cells).min() > 0.05
    corners = mesh.points[mesh.cells[:, :4]]
    middles = corners[:, TETRA_EDGES].mean(axis=2)
    lengths = np.linalg.norm(corners[:, TETRA_EDGES[:, 0]] - corners[:, TETRA_EDGES[:, 1]], axis=2)
    off = np.linalg.norm(mesh.points[mesh.cells[:, 4:]] - middles, axis=2)
    assert (off / lengths).max() < 0.4  # a mid-node of another edge would lie at least half an edge away
    assert np.unique(mesh.cells).size == len(mesh.points)


def test_surfaces_lie_where_their_names_say(mesh: TaggedMesh) -> None:
    def at(name: str) -> np.ndarray:
        return mesh.points[np.unique(mesh.surfaces[name])]

    assert set(mesh.surfaces) == {"bore:A", "top:A", "bottom:A", "end:H"}
    assert np.hypot(at("bore:A")[:, 0], at("bore:A")[:, 1]) == pytest.approx(0.75, abs=1e-6)
    assert at("top:A")[:, 2] == pytest.approx(3.5)
    assert at("bottom:A")[:, 2] == pytest.approx(-3.5)
    assert np.hypot(at("end:H")[:, 1], at("end:H")[:, 2]) == pytest.approx(2.5, abs=1e-6)
    assert at("end:H")[:, 0].min() == pytest.approx(11.0)
    assert at("end:H")[:, 0].max() == pytest.approx(15.0)


def test_surfaces_are_boundary_triangles(mesh: TaggedMesh) -> None:
    faces = np.sort(mesh.cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    unique, counts = np.unique(faces, axis=0, return_counts=True)
    boundary = set(map(tuple, unique[counts == 1]))
    assert counts.max() == 2
    for triangles in mesh.surfaces.values():
        assert set(map(tuple, np.sort(triangles, axis=1))) <= boundary


def test_bore_has_the_elements_asked_for(mesh: TaggedMesh) -> None:
    at = mesh.points[np.unique(mesh.surfaces["bore:A"])]
    rim = at[np.abs(at[:, 2] - 3.5) < 1e-9]
    assert COARSE.bore_elements <= len(rim) <= COARSE.bore_elements + 1


def test_same_input_gives_the_same_mesh_whatever_the_process_has_done(mesh: TaggedMesh) -> None:
    fresh = mesh_body(tube_body(), COARSE)
    mesh_body(bar_body(), dataclasses.replace(COARSE, curved=False))
    mesh_body(tube_body(), dataclasses.replace(COARSE, size_points=fresh.points, size_values=fresh.points[:, 2] + 9.0))
    reentrant_edges(bar_body("0 mm"))
    later = mesh_body(tube_body(), COARSE)
    for again in (fresh, later):
        assert (again.points == mesh.points).all()
        assert (again.cells == mesh.cells).all()


def test_one_process_serves_bodies_in_turn_and_builds_each_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ALULA_TEST", "none waits with this environment")
    begun = alula.geometry.base.child_server.ChildServer
    started: list[object] = []
    monkeypatch.setattr("alula.geometry.base.child_server.ChildServer", lambda *a: started.append(a) or begun(*a))
    volumes = [mass_properties(body).volume for body in (tube_body(), bar_body(), tube_body())]
    assert volumes[0] == volumes[2] != volumes[1]
    with pytest.raises(CannotRunError, match="memory"):
        mesh_body(bar_body(), dataclasses.replace(COARSE, memory_limit=7e7))
    assert len(started) == 1
    assert mass_properties(tube_body()).volume == volumes[0]  # the limit was that request's, and its process is gone
    assert len(started) == 2


@pytest.mark.parametrize("unit", [1e-3, 1.0 / 7.0])
def test_a_scaled_part_gets_the_scaled_mesh(mesh: TaggedMesh, unit: float) -> None:
    other = mesh_body(tube_body(unit), COARSE)
    assert (other.cells == mesh.cells).all()
    assert np.abs(other.points / unit - mesh.points).max() < 1e-9
    assert other.volume / unit**3 == pytest.approx(mesh.volume, rel=1e-12)


def test_straight_elements() -> None:
    mesh = mesh_body(tube_body(), dataclasses.replace(COARSE, curved=False))
    assert mesh.cells.shape[1] == 4
    assert volumes_and_moments(mesh.points, mesh.cells)[0].sum() < 0.995 * mesh.volume
    assert mesh.notes == ()


def test_background_sizes_refine_where_they_are_small() -> None:
    plain = mesh_body(bar_body(), COARSE)
    grid = np.array([[x, y, z] for x in (-10.0, 7.5, 25.0) for y in (-9.0, 9.0) for z in (-9.0, 9.0)])
    sizes = np.interp(grid[:, 0], [-10.0, 7.5, 25.0], [2.0, 0.5, 2.0])
    fine = mesh_body(bar_body(), dataclasses.replace(COARSE, size_points=grid, size_values=sizes))

    def within(mesh: TaggedMesh, low: float, high: float) -> int:
        x = mesh.points[mesh.cells[:, :4]].mean(axis=1)[:, 0]
        return int(((low < x) & (x < high)).sum())

    assert within(fine, 6.5, 8.5) > 4 * within(plain, 6.5, 8.5)
    assert within(fine, -5.0, 0.0) < within(plain, -5.0, 0.0)


def test_too_many_elements_are_refused(mesh: TaggedMesh) -> None:
    count = len(mesh.cells)
    with pytest.raises(CannotRunError, match=f"{count:,} tetrahedra, more than max_elements {count - 1:,}; increase"):
        mesh_body(tube_body(), dataclasses.replace(COARSE, max_elements=count - 1))


def test_far_too_many_elements_are_refused_before_they_are_made() -> None:
    # 500 million would take a day.
    with pytest.raises(
        CannotRunError, match=r"would have about 5\.\de\+08 tetrahedra, more than max_elements 1,500,000"
    ):
        mesh_body(bar_body(), dataclasses.replace(COARSE, size=0.005, time_limit=30.0))


QUICK = [("bar", "at points"), ("tube", "coarse"), ("thin tube", "fine")]
SLOW = [pair for pair in product(("bar", "tube", "thin tube"), ("coarse", "fine", "at points")) if pair not in QUICK]


@pytest.mark.parametrize(
    ("shape", "settings"), [*QUICK, *(pytest.param(*pair, marks=pytest.mark.converged) for pair in SLOW)]
)
def test_the_number_of_elements_is_known_beforehand(shape: str, settings: str) -> None:
    thin = dataclasses.replace(tube_body(inner_diameter="4.7 mm"), holes=())
    body = {"bar": bar_body(), "tube": tube_body(), "thin tube": thin}[shape]
    wanted = dataclasses.replace(COARSE, size=0.2) if settings == "fine" else COARSE
    if settings == "at points":
        points = mesh_body(body, COARSE).points
        wanted = dataclasses.replace(COARSE, size_points=points, size_values=np.full(len(points), 1.0))
    with pytest.raises(CannotRunError, match="would have about") as refused:
        mesh_body(body, dataclasses.replace(wanted, max_elements=1))
    estimate = float(re.findall(r"about (\S+) tetrahedra", str(refused.value))[0])
    assert 0.67 < estimate / len(mesh_body(body, wanted).cells) < 1.5


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
def test_a_mesher_that_takes_too_much_memory_is_stopped_and_said_so() -> None:
    with pytest.raises(
        CannotRunError, match=r"needed more than the 0\.07 GB of memory that it may take; increase solid"
    ):
        mesh_body(bar_body(), dataclasses.replace(COARSE, memory_limit=7e7))


@pytest.mark.skipif(os.name == "nt", reason="asks as Unix does")
def test_a_mesher_may_take_half_of_the_machine_at_most() -> None:
    assert allowed(1.0) == 1.0
    assert allowed(1e18) == os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2.0


def test_thin_walls_are_meshed_finely_enough() -> None:
    thin = dataclasses.replace(tube_body(inner_diameter="4.7 mm"), holes=())
    mesh = mesh_body(thin, COARSE)
    assert volumes_and_moments(mesh.points, mesh.cells)[0].sum() == pytest.approx(mesh.volume, rel=3e-3)


def test_a_mesh_that_is_none_of_the_shape_is_made_anew_and_finer() -> None:
    """The rim of an eye 1.33 times as wide as the bar leaves cusps beside the fillets, in which elements go flat."""
    part = Bar.model_validate(
        {"shape": "bar", "material": "resin", "width": "3.861622932258501 mm", "thickness": "7.2386973237706815 mm",
         "eye_diameter": "5.134312398304288 mm", "fillet_radius": "1.759191754369836 mm"}
    )  # fmt: skip
    pins = (
        Pin(name="A", x=0.0, y=0.0, diameter=0.9142390520712832),
        Pin(name="B", x=33.61526947468871, y=0.0, diameter=1.1955586797347495),
    )
    end = PlainEnd(name="H", x=53.784431159501935, patch=3.861622932258501)
    first = MeshSettings(size=0.6, bore_elements=10, hole_elements=6, turn_elements=6, fillet_size=1.2, growth=1.0)
    mesh = mesh_body(Body(part=part, pins=pins, ends=(end,), holes=()), first)
    assert re.search(r"meshed with 0\.\d+ times the requested size, because .* in the mesh, but", mesh.notes[-1])
    assert volumes_and_moments(mesh.points, mesh.cells)[0].sum() == pytest.approx(mesh.volume, rel=5e-3)


@pytest.mark.parametrize(("eye", "fillet"), [(6.6, 0.0), (9.0, 0.6)])
def test_the_first_mesh_of_a_rod_has_its_volume(eye: float, fillet: float) -> None:
    """A rod of 6 mm, whose first mesh missed 2 % of its volume: six edges round it, and no node on its axis."""
    sizes = {"outer_diameter": 6.0, "inner_diameter": 0.0, "fillet_radius": fillet, "eye_diameter": eye}
    part = Tube.model_validate({"shape": "tube", "material": "m"} | {name: f"{v} mm" for name, v in sizes.items()})
    pins = tuple(Pin(name=name, x=x, y=0.0, diameter=2.0) for name, x in (("A", 0.0), ("B", 90.0)))
    first = MeshSettings(size=0.6, bore_elements=10, hole_elements=6, turn_elements=6, fillet_size=1.2, growth=1.0)
    mesh = mesh_body(Body(part=part, pins=pins, ends=(), holes=()), first)
    assert not any("meshed with" in note for note in mesh.notes)
    assert volumes_and_moments(mesh.points, mesh.cells)[0].sum() == pytest.approx(mesh.volume, rel=5e-3)


@pytest.mark.parametrize(("eye", "fillet"), [(8.0, 2.0), (8.05, 0.2), (8.2, 2.0), (8.6, 0.0)])
def test_eyes_as_wide_as_the_bar_or_just_wider(eye: float, fillet: float) -> None:
    part = Bar.model_validate(
        {"shape": "bar", "material": "resin", "width": "8 mm", "thickness": "4 mm", "eye_diameter": f"{eye} mm",
         "fillet_radius": f"{fillet} mm"}
    )  # fmt: skip
    pins = tuple(Pin(name=name, x=x, y=0.0, diameter=3.0) for name, x in (("A", 0.0), ("M", 15.0), ("B", 40.0)))
    mesh = mesh_body(Body(part=part, pins=pins, ends=(), holes=()), COARSE)
    assert shape_quality(mesh.points, mesh.cells).min() > 0.05
    straight = 4.0 * (8.0 * 40.0 + math.pi * 4.0**2 - 3.0 * math.pi * 1.5**2)  # bar with round ends and three holes
    if eye <= 1.01 * 8.0:
        assert mesh.volume == pytest.approx(straight, rel=1e-8)
    else:
        assert straight < mesh.volume < straight + 4.0 * 3.0 * math.pi / 4.0 * (eye**2 - 8.0**2) + fillet
    assert set(mesh.areas) == {f"{kind}:{pin}" for kind in ("bore", "top", "bottom") for pin in "AMB"}


def test_flattened_elements_are_told() -> None:
    coarse = dataclasses.replace(COARSE, turn_elements=4, fillet_size=3.0)
    [note] = mesh_body(tube_body(), coarse).notes
    assert re.fullmatch(r"\d+ of \d+ curved elements were flattened, by up to 0\.\d+ mm", note)


def test_fillet_that_the_kernel_cannot_make_though_the_rules_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("alula.geometry.meshing.mesh.check_body", lambda body: None)
    with pytest.raises(CaseError, match=r"fillet_radius 20 mm does not fit .* reduce it"):
        mesh_body(bar_body("20 mm"), COARSE)


def test_several_bodies_at_once_name_the_one_that_fails() -> None:
    meshes = mesh_bodies({"one": bar_body(), "two": bar_body("0 mm")}, COARSE)
    assert list(meshes) == ["one", "two"]
    assert meshes["one"].volume > meshes["two"].volume
    with pytest.raises(CaseError, match=r"^odd: the eyes at A and B, or their fillets, overlap"):
        mesh_bodies({"good": bar_body(), "odd": bar_body("20 mm")}, COARSE)


def test_reentrant_edges_are_those_without_fillet() -> None:
    assert reentrant_edges(bar_body()) == []
    edges = reentrant_edges(bar_body("0 mm"))
    assert len(edges) == 4
    # A line at height h meets a circle of radius R about (0, c) at 180° + asin((h - c) / R)'s complement.
    found = sorted(edge.angle for edge in edges)
    expected = sorted(np.pi + np.arccos(h / 4.5) for h in (2.5, 2.5, 2.0, 3.0))
    assert found == pytest.approx(expected, abs=1e-6)
    for edge in edges:
        assert np.abs(edge.points[:, 1]) == pytest.approx(2.5)
        assert np.ptp(edge.points[:, 2]) == pytest.approx(3.0)


def test_the_step_of_a_thick_eye_is_rounded_where_its_fillet_just_fits() -> None:
    assert reentrant_edges(bar_body("1 mm", "5.05 mm")) == []
    assert reentrant_edges(bar_body("0 mm", "5.05 mm"))


def test_the_fillet_of_a_tube_whose_eyes_are_as_thin_as_may_be() -> None:
    thin = tube_body(eye_thickness="6.64 mm")
    assert reentrant_edges(thin) == []


def test_step_files_hold_millimetres(tmp_path: Path) -> None:
    folder = tmp_path / "parts ü"
    folder.mkdir()
    paths = export_step({"AE": tube_body()}, folder)
    assert sorted(folder.iterdir()) == paths == [folder / "AE.step"]
    assert "SI_UNIT(.MILLI.,.METRE.)" in paths[0].read_text()
    found, built = part_facts(paths[0]), mass_properties(tube_body())
    assert found.volume == pytest.approx(built.volume, rel=1e-5)
    assert np.allclose(found.centroid, built.centroid, atol=1e-4)
    assert np.allclose(found.inertia, built.inertia, rtol=1e-4, atol=1e-4 * np.max(built.inertia))


def test_bores_are_found_in_what_is_exported(tmp_path: Path) -> None:
    """The pin's, the feathers' holes through both walls, and the tube's inside, open at its plain end alone."""
    [path] = export_step({"AE": tube_body()}, tmp_path)
    pin, one, other, inside = sorted(part_facts(path).bores, key=lambda bore: bore.centre[0])
    assert pin.centre == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert (pin.diameter, pin.length, pin.through) == (pytest.approx(1.5), pytest.approx(7.0), True)
    for bore, x in ((one, 7.0), (other, 9.0)):
        assert bore.centre == pytest.approx((x, 0.0, 0.0), abs=1e-6)
        assert bore.axis == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)
        assert np.allclose(bore.spans, [(-2.5, -np.sqrt(1.25**2 - 0.25)), (np.sqrt(1.25**2 - 0.25), 2.5)], atol=1e-5)
    assert (inside.diameter, inside.through, inside.around) == (pytest.approx(2.5), False, True)


def test_a_closed_cavity_is_no_bore(tmp_path: Path) -> None:
    body = dataclasses.replace(
        tube_body(), pins=(*tube_body().pins, Pin(name="B", x=15.0, y=0.0, diameter=1.5)), ends=(), holes=()
    )
    [path] = export_step({"AE": body}, tmp_path)
    assert [bore.diameter for bore in part_facts(path).bores] == pytest.approx([1.5, 1.5])


def _instead(script: str) -> Callable[[], list[str]]:
    return lambda: [sys.executable, "-c", script]


@pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")
@pytest.mark.parametrize(
    ("script", "message"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", r"the mesher crashed \(SIGSEGV\)"),
        (
            "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
            r"killed \(SIGKILL\), .* memory runs out",
        ),
        ("raise SystemExit('no more disk')", "ended with status 1 and no answer: no more disk"),
        ("import os; os.read(0, 1); os.write(1, bytes([9] + 7 * [0]) + b'half')", "status 0 and no answer"),
    ],
)
def test_a_crash_of_the_mesher_is_contained(monkeypatch: pytest.MonkeyPatch, script: str, message: str) -> None:
    monkeypatch.setattr(alula.geometry.base.kernel_child, "_command", _instead(script))
    with pytest.raises(CannotRunError, match=message):
        mesh_body(bar_body(), COARSE)


def test_an_endless_mesher_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(alula.geometry.base.kernel_child, "_command", _instead("while True: pass"))
    with pytest.raises(CannotRunError, match=r"stopped after its time limit of 0\.5 s"):
        mesh_body(bar_body(), dataclasses.replace(COARSE, time_limit=0.5))


def test_a_folder_of_the_same_name_is_not_taken_for_this_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "geometry").mkdir()
    (tmp_path / "geometry" / "__init__.py").write_text("raise SystemExit(9)")
    monkeypatch.chdir(tmp_path)
    assert mass_properties(bar_body("0 mm")).volume > 0.0
