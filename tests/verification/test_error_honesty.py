"""No band where a mesh tells nothing, the error that one mesh hides, and contact on top where a pin rules."""

import math
from dataclasses import replace

import arm_case
import numpy as np
import pytest
import solid_meshes
from validation.test_cook import plane_stress

from alula.fea.common.link_loads import EndLoad, LinkLoads, PinLoad
from alula.fea.common.source import CONTACT
from alula.fea.common.verdict import Verdict
from alula.fea.refine.error_estimate import energy_factor
from alula.fea.refine.level import level_of
from alula.fea.refine.link_series import Eye, energy_errors, precision
from alula.fea.refine.refinement import Effort
from alula.fea.solid.solution import solve_solid
from alula.loads.records.bearing import CONTACT_SHORTFALL, NARROW, WIDE
from alula.reports.sentences import told


def slender(length):
    """Tube of radii 0.5 and 1 as a cantilever under 1 N, 40 elements along it; and Timoshenko's deflection [mm]."""
    mesh = solid_meshes.ring(0.5, 1.0, length, around=12, radial=1, layers=40)
    names = {"bottom:A": "end:root", "top:A": "end:tip"}
    surfaces = {names.get(name, name): found for name, found in mesh.surfaces.items()}
    root, tip = np.array([0.0, 0.0, -length / 2.0]), np.array([0.0, 0.0, length / 2.0])
    ends = (
        EndLoad(name="tip", point=tip, wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0])),
        EndLoad(name="root", point=root, wrench=np.array([0.0, 1.0, 0.0, -length, 0.0, 0.0])),
    )
    solution = solve_solid(
        replace(mesh, surfaces=surfaces, areas=dict.fromkeys(surfaces, 0.0)),
        E=2900.0, nu=0.38, density=1e-9, loads=[LinkLoads(name="tip", ends=ends)],
        line=("end:root", "end:tip"), laws=(WIDE,), threads=1,
    )  # fmt: skip
    second = np.pi / 4.0 * (1.0 - 0.5**4)
    return solution, length**3 / (3.0 * 2900.0 * second)


def judged(solution, volume):
    levels = [level_of(solution, volume)]
    [case] = precision(levels, (), section=2.0, eyes=())
    return case, energy_errors(levels)[-1]


def test_elements_too_long_for_their_tube_get_no_band():
    """At 2.5 diameters an element the tube is 1 % too stiff, at 15 diameters 30 %; further the solver gives up."""
    for ratio, lost, known in ((100.0, 0.013, True), (600.0, 0.302, False)):
        solution, true = slender(2.0 * ratio)
        case, error = judged(solution, np.pi * 0.75 * 2.0 * ratio)
        assert 2.0 * solution.cases[0].strain_energy == pytest.approx((1.0 - lost) * true, rel=0.01)
        assert case.unreliable == ("" if known else "coarse")
        assert (error < 0.3) == known
        for quantity in ("von_mises", "principal", "displacement"):
            assert case.known(quantity) == known
            assert math.isinf(case.high(quantity)) != known
        if known:
            assert case.high("displacement") / case.displacement.value * (1.0 - lost) > 1.0


def test_energies_tell_what_the_recovered_stress_hides_at_a_clamped_corner():
    """Cook's membrane, whose error sits at a singular corner; its energy extrapolated from densities 4, 6 and 8."""
    solved = [plane_stress(n)[0][0] for n in (1, 2)]
    energies, found = [s.energy for s in solved], [s.estimate.total for s in solved]
    true = math.sqrt(2.0 * (12.02062 - energies[1]))
    assert found[1] / true < 0.5
    assert 0.8 < energy_factor(found, energies) * found[1] / true < 1.25


def test_no_factor_where_energies_do_not_tell():
    assert energy_factor([1.0], [1.0]) is None
    assert energy_factor([2.0, 1.0], [1.0, 0.9]) is None
    assert energy_factor([1.0, 1.0], [1.0, 1.1]) is None
    assert energy_factor([9.0, 2.0, 1.0], [0.0, 1.0, 2.5]) == pytest.approx(1.0)
    # True errors 2, 1 and 0.98, an energy 0.3 % off: the last two meshes alone would tell a factor of 1.5.
    energies = [10.0 - error**2 / 2.0 + scatter for error, scatter in ((2.0, 0.0), (1.0, 0.0), (0.98, 0.025))]
    assert energy_factor([2.0, 1.0, 0.98], energies) == pytest.approx(1.0, abs=0.02)


def test_contact_reaches_on_from_what_an_eye_bears():
    mesh = solid_meshes.bar()

    def pin(name, x, force):
        wrench = np.array([force, 0.0, 0.0, 0.0, 0.0, 0.0])
        return PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=1.5, wrench=wrench)

    loads = LinkLoads(name="pull", pins=(pin("A", 0.0, -10.0), pin("B", 20.0, 10.0)))
    solution = solve_solid(
        mesh, E=2900.0, nu=0.38, density=1e-9, loads=[loads], line=("bore:A", "bore:B"), laws=(WIDE, NARROW), threads=1
    )
    level = level_of(solution, level_of(solution, 1.0).volumes.sum())
    eyes = [Eye(x=x, y=0.0, radius=2.0) for x in (0.0, 20.0)]
    wide, narrow = precision([level], (), section=3.0, eyes=eyes)
    for quantity in ("von_mises", "principal"):
        assert narrow.series(quantity).value > wide.series(quantity).value
        assert wide.high(quantity) == wide.series(quantity).high
        assert narrow.high(quantity) == pytest.approx(narrow.series(quantity).high / (1.0 - CONTACT_SHORTFALL))
    assert narrow.high("displacement") == narrow.displacement.high
    _, apart = precision([level], (), section=3.0, eyes=[Eye(x=10.0, y=0.0, radius=2.0)])
    assert apart.high("von_mises") == apart.von_mises.high


def test_band_of_a_pulled_arm_holds_contact():
    link, _ = arm_case.checked(part=arm_case.BAR, fillet=1.0, force=-1.0)
    assert CONTACT in link.safety_factor.sources
    assert CONTACT not in link.displacement_max.sources


@pytest.mark.parametrize("meshes", [1, 2])
def test_sharp_edge_gets_no_factor_before_three_meshes(meshes):
    link, check = arm_case.checked(Effort(max_meshes=meshes), part=arm_case.BAR, fillet=0.0, force=-1.0)
    assert link.discretisation.status == "edge"
    assert link.safety_factor.unknowable
    assert link.von_mises_max.unknowable
    assert math.isnan(link.governing.von_mises)
    assert math.isfinite(link.displacement_max.high)
    assert check.verdict is Verdict.UNDECIDED
    assert "sharp inner edge" in told(check.reason)
    assert f"number of meshes, {meshes}, is reached" in told(check.reason)
