from dataclasses import replace

import numpy as np
import pytest
import solid_meshes
from scipy.spatial.transform import Rotation

from alula.fea.calculix import program as calculix
from alula.fea.calculix import second_opinion
from alula.fea.calculix.program import read_dat, read_frd_stress
from alula.fea.calculix.second_opinion import ask, write_model
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.outcomes.opinion import Answer, SecondOpinion
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field, von_mises
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.bearing import WIDE
from alula.reports.sentences import told

E, NU = 2900.0, 0.38
needs_ccx = pytest.mark.skipif(calculix.installed() is None, reason="CalculiX (ccx) is not on PATH")


def pin(name, x, *force):
    return PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=np.array([*force, 0.0, 0, 0, 0]))


def bar_link(**options):
    """A coarse bar pulled and bent between its pins: solution, case, stress."""
    mesh = solid_meshes.bar(length=12.0, along=3, layers=1, tail=4.0, **({"around": 8, "radial": 2} | options))
    loads = LinkLoads(
        name="pull & bend",
        pins=(pin("A", 0.0, -6.0, 0.5), pin("B", 12.0, 6.0, -0.5)),
        couples=(),
    )
    turn = replace(loads.pins[0], wrench=loads.pins[0].wrench + np.array([0.0, 0, 0, 0, 0, 6.0]))
    solution = solve_solid(
        mesh, E=E, nu=NU, density=1e-9, loads=[replace(loads, pins=(turn, loads.pins[1]))],
        line=("bore:A", "bore:B"), laws=(WIDE,), transfers=("bore-shear",), threads=1,
    )  # fmt: skip
    case = solution.cases[0]
    return solution, case, stress_field(solution.space, case.displacement, E=E, nu=NU)


@pytest.fixture(params=["straight", "curved"])
def link(request):
    # Curved: on elements of 45° the stiffness by our 14 points and by CalculiX's 4 differs by 0.2 % in displacement.
    return bar_link(curved=False) if request.param == "straight" else bar_link(curved=True, around=16)


@needs_ccx
def test_calculix_agrees_on_the_same_mesh(link, tmp_path):
    solution, case, stress = link
    deck = tmp_path / "bar.inp"
    write_model(deck, solution, case, "a bar")
    answer = ask(deck, case.displacement, stress, threads=1, time_limit=60.0)
    assert answer.displacement_gap < 1e-3
    assert answer.stress_gap < 1e-2
    assert answer.agrees
    assert answer.displacement == pytest.approx(case.displacement_max, rel=1e-3)
    assert answer.von_mises == pytest.approx(stress.peak_at_points.value, rel=1e-2)
    assert answer.von_mises_nodal == pytest.approx(stress.peak.value, rel=2e-2)
    assert answer.seconds > 0.0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bar.inp"]


@pytest.mark.parametrize(("off", "agrees"), [(0.0, True), (0.03, False)])
def test_gaps_are_the_largest_difference_over_our_largest_value(monkeypatch, tmp_path, off, agrees):
    """Our answer, moved as a rigid body, but for the stress at one point and the displacement of one node."""
    _, case, stress = bar_link()
    space = stress.space
    turn = Rotation.from_rotvec([1e-7, -2e-7, 3e-7]).as_matrix() - np.eye(3)
    moved = case.displacement + space.nodes @ turn.T + np.array([0.1, -0.2, 0.3])
    node = int(np.argmax(np.linalg.norm(case.displacement, axis=1)))
    moved[node, 1] += off * np.linalg.norm(case.displacement[node])
    order = np.argsort(second_opinion._places(space))
    theirs = stress.at_points[:, order].copy()
    element, point = np.unravel_index(int(np.argmax(von_mises(theirs))), theirs.shape[:2])
    theirs[element, point] *= 1.0 + off
    monkeypatch.setattr(calculix, "run", lambda *a, **k: ("", ""))
    monkeypatch.setattr(calculix, "read_dat", lambda *a, **k: (moved, theirs))
    monkeypatch.setattr(calculix, "read_frd_stress", lambda *a: stress.nodal)
    answer = ask(tmp_path / "bar.inp", case.displacement, stress, threads=1, time_limit=1.0)
    assert answer.stress_gap == pytest.approx(off, abs=1e-9)
    assert answer.displacement_gap == pytest.approx(off, abs=max(0.03 * off, 1e-9))  # the alignment takes a little
    assert answer.agrees is agrees


@needs_ccx
def test_another_material_is_found_out(tmp_path):
    solution, case, stress = bar_link()
    deck = tmp_path / "bar.inp"
    write_model(deck, solution, case, "a bar")
    deck.write_text(deck.read_text().replace(f"{NU!r}\n", "0.33\n"))
    answer = ask(deck, case.displacement, stress, threads=1, time_limit=60.0)
    assert not answer.agrees


@needs_ccx
def test_a_broken_deck_is_refused_with_what_calculix_says(tmp_path):
    _, case, stress = bar_link()
    deck = tmp_path / "bar.inp"
    deck.write_text("*HEADING\nnothing\n*STEP\n*STATIC\n*END STEP\n")
    with pytest.raises(CannotRunError, match="CalculiX"):
        ask(deck, case.displacement, stress, threads=1, time_limit=60.0)


def test_a_missing_program_is_said(tmp_path, monkeypatch):
    solution, case, stress = bar_link()
    deck = tmp_path / "bar.inp"
    write_model(deck, solution, case, "a bar")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(CannotRunError, match="not on PATH"):
        ask(deck, case.displacement, stress, threads=1, time_limit=60.0)


def test_a_program_that_hangs_is_ended(tmp_path, monkeypatch):
    solution, case, stress = bar_link()
    deck = tmp_path / "bar.inp"
    write_model(deck, solution, case, "a bar")
    program = tmp_path / "ccx"
    program.write_text("#!/bin/sh\nexec /bin/sleep 60\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(CannotRunError, match=r"more than 0\.2 s"):
        ask(deck, case.displacement, stress, threads=1, time_limit=0.2)


def test_the_deck_holds_the_model(link, tmp_path):
    solution, case, _ = link
    space = solution.space
    deck = tmp_path / "bar.inp"
    write_model(deck, solution, case, "title °\nof two lines")
    text = deck.read_text(encoding="ascii")
    sections = {block.split("\n", 1)[0]: block.split("\n")[1:-1] for block in text.split("*")[1:]}
    nodes = np.array([line.split(",") for line in sections["NODE, NSET=NALL"]], dtype=float)
    np.testing.assert_array_equal(nodes[:, 0], np.arange(1, len(space.nodes) + 1))
    np.testing.assert_allclose(nodes[:, 1:], space.nodes, atol=1e-11)
    cells = np.array([line.split(",") for line in sections["ELEMENT, TYPE=C3D10, ELSET=EALL"]], dtype=int)
    np.testing.assert_array_equal(cells[:, 1:], space.cells + 1)
    assert sections["ELASTIC"] == ["2900.0, 0.38"]
    assert len(sections["BOUNDARY"]) == 6
    loads = np.zeros_like(space.nodes)
    for line in sections["CLOAD"]:
        node, component, value = line.split(",")
        loads[int(node) - 1, int(component) - 1] += float(value)
    # Loads stand on the bores alone, and balance.
    bores = np.unique(space.faces("bore:A", "bore:B"))
    assert set(np.flatnonzero(np.abs(loads).max(axis=1) > 0.0)) <= set(bores)
    bore = np.unique(space.faces("bore:A"))
    np.testing.assert_allclose(loads[bore].sum(axis=0), [-6.0, 0.5, 0.0], atol=1e-8)
    arm = space.nodes
    np.testing.assert_allclose(np.cross(arm, loads).sum(axis=0), 0.0, atol=1e-7)
    members = " ".join(sections["NSET, NSET=BORE_A"]).replace(",", " ").split()
    np.testing.assert_array_equal(np.array(members, dtype=int), bore + 1)
    assert all(len(line) <= 80 or not line[0].isdigit() for line in sections["NSET, NSET=BORE_A"])
    assert "title ? of two lines" in sections["HEADING"]


DAT = """
 displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         1  1.000000E+00 -2.000000E+00  3.000000-100
         2  0.000000E+00  0.000000E+00 -4.000000E-05

 stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set EALL and time  0.1000000E+01

         1   1  1.000000E+00  2.000000E+00  3.000000E+00  4.000000E+00  6.000000E+00  5.000000E+00
"""


def test_dat_is_read_with_exponents_of_three_digits(tmp_path):
    path = tmp_path / "model.dat"
    path.write_text(DAT)
    u, s = read_dat(path, nodes=2, elements=1, points=1)
    np.testing.assert_allclose(u, [[1.0, -2.0, 3e-100], [0.0, 0.0, -4e-5]])
    np.testing.assert_array_equal(s, [[[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]])


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("         2  0.000000E+00  0.000000E+00 -4.000000E-05\n", "", "incomplete"),
        ("         2  0.0", "         3  0.0", "lacks"),
        ("         2  0.0", "         1  0.0", "not finite"),
        ("-4.000000E-05", "          NaN", "not finite"),
        ("-4.000000E-05", "*************", "no table"),
    ],
)
def test_dat_that_is_not_whole_is_refused(tmp_path, old, new, says):
    path = tmp_path / "model.dat"
    assert old in DAT
    path.write_text(DAT.replace(old, new))
    with pytest.raises(CannotRunError, match=says):
        read_dat(path, nodes=2, elements=1, points=1)


def test_missing_files_are_said(tmp_path):
    with pytest.raises(CannotRunError, match="left no file"):
        read_dat(tmp_path / "model.dat", nodes=1, elements=1, points=1)
    with pytest.raises(CannotRunError, match="cannot be read"):
        read_frd_stress(tmp_path / "model.frd")
    (tmp_path / "model.frd").write_text("    1C\n 9999\n")
    with pytest.raises(CannotRunError, match="no stresses"):
        read_frd_stress(tmp_path / "model.frd")


def test_frd_numbers_that_touch_are_told_apart(tmp_path):
    path = tmp_path / "model.frd"
    row = " -1         7-1.00000E+00-2.00000E+00-3.00000E+00-4.00000E+00-5.00000E+00-6.00000E+00\n"
    other = " -1         7 9.00000E+00 9.00000E+00 9.00000E+00\n"
    path.write_text(f" -4  DISP        4    1\n{other} -3\n -4  STRESS      6    1\n{row} -3\n 9999\n")
    np.testing.assert_array_equal(read_frd_stress(path), [[-1.0, -2.0, -3.0, -4.0, -5.0, -6.0]])


def opinion(**gaps):
    answer = Answer(von_mises=1.0, von_mises_nodal=1.0, displacement=1.0, seconds=1.0, **gaps) if gaps else None
    return SecondOpinion(
        link="AE", load_case="hover", variant="", deck="AE.inp", von_mises=1.0, von_mises_nodal=1.0, displacement=1.0,
        known=True,
        answer=answer, reason="" if gaps else "CalculiX (ccx) is not on PATH",
    )  # fmt: skip


def test_what_is_told():
    assert opinion(stress_gap=0.009, displacement_gap=0.0009).warning is None
    assert "differs by 0.20% in displacement" in told(opinion(stress_gap=0.0, displacement_gap=0.002).warning)
    assert "1.10% in von Mises" in told(opinion(stress_gap=0.011, displacement_gap=0.0).warning)
    assert told(opinion().warning) == "AE: no second opinion: CalculiX (ccx) is not on PATH; its deck is AE.inp"
