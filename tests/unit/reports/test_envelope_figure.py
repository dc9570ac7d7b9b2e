"""The panel of an envelope shows the whole curve and every limit that the legend names."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from alula.fea.common.band import Band
from alula.fea.common.source import Source, SourceKind
from alula.reports.figures.motion.envelope_figures import _panel

ANGLES = np.linspace(0.0, 360.0, 73)
STRENGTH = 40.0

MESH = (Source(kind=SourceKind.DISCRETISATION),)


def link(stress, name="rocker"):
    pose = int(np.nanargmax(stress))
    peak = Band(value=stress[pose], low=0.9 * stress[pose], high=1.2 * stress[pose], sources=MESH)
    found = SimpleNamespace(
        value=stress, low=0.9 * stress, high=1.2 * stress, stress=peak, safety_factor=peak.inverse(STRENGTH), pose=pose
    )
    return SimpleNamespace(link=name, strength=STRENGTH, load_cases={"turn": found}, worst=found)


def panel(stress, limits, name="rocker"):
    axes = Figure().add_subplot()
    _panel(axes, ANGLES, link(stress, name), ["turn"], limits, {})
    return axes


@pytest.mark.parametrize("limit", [0.2, 3.0, 500.0])
@pytest.mark.parametrize("swing", [1.05, 20.0, 400.0])
def test_curve_and_limit_stand_in_the_panel(limit, swing):
    """The axis once ended at ten times the least factor, below limits and curves above that."""
    stress = 10.0 ** (1.0 + np.log10(swing) * (np.cos(np.radians(ANGLES)) - 1.0) / 2.0)  # from 10 MPa to 10/swing
    bottom, top = panel(stress, {limit}).get_ylim()
    assert bottom < limit < top
    assert bottom < STRENGTH / (1.2 * stress.max())
    assert STRENGTH / stress.min() < top


def test_a_curve_without_end_leaves_the_panel_and_that_is_said():
    stress = np.maximum(10.0 * np.cos(np.radians(ANGLES)), 0.0)
    stress[18] = 1e-7
    axes = panel(stress, {3.0})
    assert axes.get_ylim()[1] == pytest.approx(4.0 * 1e3)
    assert [text.get_text() for text in axes.texts] == ["above 4000 not drawn"]


def test_poses_left_out_are_gaps():
    stress = np.full(len(ANGLES), 10.0)
    stress[:9] = np.nan
    assert panel(stress, {3.0}).get_ylim()[0] < 3.0


def test_a_long_name_takes_a_line_of_its_own():
    title = panel(np.full(len(ANGLES), 10.0), {3.0}, "a-link-with-a-name-of-some-length").get_title(loc="left")
    assert title == "a-link-with-a-name-of-some-length:\nleast 4.00 at 0.0 deg"
