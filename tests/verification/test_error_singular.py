"""Through the whole check: sharp edges have no safety factor, filleted ones do, and every band says where it stands."""

import math

import arm_case
import pytest
from arm_case import checked

from alula.fea.check.run import effort_of
from alula.fea.common.verdict import Verdict
from alula.fea.refine.refinement import Effort
from alula.geometry.base.errors import CaseError
from alula.reports.sentences import told


@pytest.mark.parametrize(
    ("part", "force"),
    [
        pytest.param(arm_case.BAR, -1.0, id="bar far below the limit"),
        pytest.param(arm_case.TUBE, -60.0, id="tube far above it", marks=pytest.mark.converged),
    ],
)
def test_sharp_edge_gets_no_safety_factor(part, force):
    link, check = checked(Effort(max_meshes=3), part=part, fillet=0.0, force=force)
    assert link.discretisation.status == "singular"
    assert all(math.isnan(band.value) for band in (link.safety_factor, link.von_mises_max, link.principal_max))
    assert math.isnan(link.governing.von_mises)
    assert math.isfinite(link.displacement_max.high)
    assert check.verdict is Verdict.UNDECIDED
    sharp = link.discretisation.sharp
    assert sharp.growth == pytest.approx(sharp.theory, rel=0.5)
    # The junction of arm and eye: 4 mm from a pin, on the arm's side.
    assert min(abs(math.hypot(sharp.place[0] - x, sharp.place[1]) - 4.0) for x in (0.0, 15.0)) < 0.05
    assert 0.0 < sharp.screening < link.discretisation.stress.value
    for word in ("singular", "fillet_radius", "screening"):
        assert word in told(check.reason)
    assert check.reason in link.notes


@pytest.mark.converged
def test_filleted_arm_is_decided_or_converged():
    link, check = checked(part=arm_case.BAR, fillet=1.0, force=-7.0)
    state = link.discretisation
    assert state.status in ("decided", "converged")
    assert len(state.meshes) >= 3
    assert state.stress.kind != "growing"
    assert not link.safety_factor.low <= 3.0 <= link.safety_factor.high or state.stress.index <= 0.05
    assert check.verdict is not Verdict.UNDECIDED


def test_link_far_from_its_limit_takes_one_mesh_and_says_so():
    link, check = checked(part=arm_case.BAR, fillet=1.0, force=-1.0)
    assert link.discretisation.status == "far"
    assert len(link.discretisation.meshes) == 1
    assert link.safety_factor.low > 2.0 * 3.0
    assert any("one mesh" in told(held) for held in link.safety_factor.texts)
    assert check.verdict is Verdict.PASS


def test_stated_accuracy_refines_what_is_clear_already():
    link, _ = checked(Effort(accuracy=0.1, stated=True), part=arm_case.BAR, fillet=1.0, force=-1.0)
    assert len(link.discretisation.meshes) >= 3
    assert link.discretisation.status == "converged"
    stress = link.discretisation.stress
    assert stress.index <= 0.1
    assert stress.kind != "growing"
    assert any("grid convergence" in told(held) for held in link.safety_factor.texts)
    assert link.von_mises_max.low <= stress.value <= link.von_mises_max.high


@pytest.mark.parametrize(
    ("limit", "words"),
    [
        ({"max_meshes": 2}, "number of meshes, 2, is reached"),
        ({"max_unknowns": 1, "max_meshes": 3}, "more than the 1 allowed"),
        ({"time_limit": 0.0}, "time limit of 0 s"),
    ],
)
def test_what_is_not_reached_is_said(limit, words):
    link, _ = checked(Effort(accuracy=0.01, stated=True, **limit), part=arm_case.BAR, fillet=1.0, force=-1.0)
    assert link.discretisation.status == "not reached"
    assert words in told(link.discretisation.stopped)
    assert link.discretisation.stress.index > 0.01
    assert any(words in told(note) for note in link.notes)


def test_open_verdict_names_the_limit_that_ended_the_refinement():
    link, _ = checked(Effort(max_meshes=1), part=arm_case.BAR, fillet=1.0, force=-1.0)
    minimum = link.safety_factor.value
    _, check = checked(Effort(max_meshes=1), part=arm_case.BAR, fillet=1.0, force=-1.0, minimum=minimum)
    assert check.verdict is Verdict.UNDECIDED
    assert "so it may pass or fail" in told(check.reason)
    assert "number of meshes, 1, is reached" in told(check.reason)


def test_accuracy_of_the_case_and_of_the_command():
    case = arm_case.arm(solid='accuracy = "2 %"')
    assert (effort_of(case).accuracy, effort_of(case).stated) == (0.02, True)
    assert effort_of(case, "10%").accuracy == pytest.approx(0.1)
    assert effort_of(arm_case.arm(solid="accuracy = 0.03")).accuracy == 0.03
    assert not effort_of(arm_case.arm()).stated
    with pytest.raises(CaseError, match="'five', but the accuracy must be a share"):
        effort_of(case, "five")
    with pytest.raises(CaseError, match=r"solid\.accuracy"):
        arm_case.arm(solid='accuracy = "0.01 %"')
