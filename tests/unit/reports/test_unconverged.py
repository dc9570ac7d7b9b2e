"""No picture, table or claim gives the peak of a mesh as a result where it is none."""

from dataclasses import replace
from typing import get_args

import pytest
from mesh_states import state
from told import flat, printed, result_record, tables

import alula.fea.claims.data
from alula.fea.claims.data import case_tree
from alula.fea.outcomes.opinion import SecondOpinion
from alula.fea.refine.discretisation import MeshStatus
from alula.geometry.base.errors import CannotRunError
from alula.loads.case.case_file import read_case
from alula.reports.figures import figures
from alula.reports.sentences import told


@pytest.fixture
def link(result):
    return result.load_cases["weight"].links["GF"]


def test_a_singular_peak_sets_neither_legend_nor_colours(link):
    peak = link.stress.peak.value
    scene = figures.scene_of(replace(link, discretisation=state("singular", screening=0.6 * peak)))
    assert figures.colour_range(scene) == (0.0, 0.6 * peak)
    told = "\n".join(figures.peak_lines(scene))
    assert "no result, singular at a sharp edge" in told
    assert "MPa" not in told
    [picture] = figures.stress_plots(
        {"GF": replace(link, discretisation=state("singular", screening=0.6 * peak))}, {"GF": {"G": (0.0, 0.0)}}
    )[0].values()
    assert picture.png().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("status", "words"),
    [("edge", "may be singular"), ("growing", "still growing"), ("unresolved", "too coarse")],
)
def test_other_peaks_that_are_no_results_have_no_number_in_the_legend(link, status, words):
    [first, *_] = figures.peak_lines(figures.scene_of(replace(link, discretisation=state(status))))
    assert words in first
    assert "MPa" not in first


@pytest.mark.parametrize("meshes", [state("converged"), state("far")])
def test_a_peak_with_a_band_has_its_number(link, meshes):
    scene = figures.scene_of(replace(link, discretisation=meshes))
    assert "MPa (circles)" in figures.peak_lines(scene)[0]
    assert scene.top == link.stress.peak.value


@pytest.mark.parametrize("status", get_args(MeshStatus))
def test_what_meshes_leave_open_says_nothing_of_a_verdict(status):
    """A check covers more than the mesh: one was undecided beside meshes with a verdict that was said to be clear."""
    assert "verdict" not in told(state(status, 0.5 if status == "singular" else None).reason)


def test_a_second_opinion_on_one_mesh_says_that_its_peak_is_no_result(result):
    opinion = SecondOpinion(
        link="AE", load_case="hover", variant="", deck="AE.inp", von_mises=9.0, von_mises_nodal=9.0, displacement=1.0,
        known=False, answer=None, reason="none",
    )  # fmt: skip
    told_of = replace(result, second_opinions=(opinion,))
    [table] = tables(told_of, "second-opinion")
    assert [row[0] for row in table.rows] == ["AE (no result)"]
    assert "AE (no result)" in flat(printed(told_of, 200))
    assert result_record(told_of)["second_opinions"]["AE"]["known"] is False


@pytest.mark.parametrize("status", ["far", "decided", "not reached", "edge", "unresolved"])
def test_no_claim_is_judged_on_a_stress_that_has_not_converged(monkeypatch, result, link, status):
    solids = replace(result.load_cases["weight"], links={"GF": replace(link, discretisation=state(status))})
    asked = []

    def check(case, *, effort, **options):
        asked.append(effort.stated)
        return replace(result, load_cases={"weight": solids})

    monkeypatch.setattr(alula.fea.claims.data, "check_case", check)
    tree = case_tree(read_case("owl-wing-static"), "owl-wing-static")
    with pytest.raises(CannotRunError, match="that of GF has not converged"):
        tree["solid"]
    assert asked == [True]
