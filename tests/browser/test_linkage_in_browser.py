"""The model of a linkage in a page: it plays, and its slider moves the joints as the lengths of its links say."""

import re

import numpy as np
import pytest
import solved
from chromium import changed, pixels

FIGURE = 'figure[data-name="linkage"]'
CANVAS = f"{FIGURE} .picture canvas"
STARTED = "window.alulaViewer.models.find((model) => model.kind === 'linkage').started"
LENGTHS = {"a": 1708.7280379405, "b": 10343.911286703, "c": 1997.8896643078, "d": 10000.0}
"""Of the four-bar linkage of Arango & Hurtado [mm]."""


def _report():
    from told import render

    from alula.reports.turnable.moving import LINKAGE, check_linkage
    from alula.reports.turnable.pack import data_block

    result = solved.told("four-bar-synthesis")
    return render(result, {}, models={LINKAGE: data_block(check_linkage(result))})


@pytest.fixture(scope="module")
def four_bar(tmp_path_factory):
    path = tmp_path_factory.mktemp("four-bar") / "report.html"
    path.write_text(solved.shared("report of a four-bar linkage", _report), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def shown(browser, four_bar):
    browser.open(four_bar)
    browser.run(f"document.querySelector('{FIGURE}').scrollIntoView()")
    browser.wait(f"document.querySelector('{FIGURE}').dataset.turnable !== 'waiting'")
    assert browser.element(FIGURE).get_attribute("data-turnable") == "ready"
    browser.run(f"document.querySelector('{FIGURE} .slider').scrollIntoView({{ block: 'center' }})")
    return browser


def told_angle(browser):
    """The angle of the crank that stands beside the slider [rad]."""
    text = browser.run(f"return {STARTED}.pose().text")
    assert text in browser.element(f"{FIGURE} .slider").text
    return np.radians(float(re.search(r"(−?[\d.]+) ?(°|deg)", text)[1].replace("−", "-")))


def test_its_slider_moves_the_joints_as_its_links_allow(shown):
    """At three poses the crank stands at the angle that is told, and joints are as far apart as links are long."""
    from selenium.webdriver.common.keys import Keys

    slider, looks, angles = shown.element(f"{FIGURE} .slider input"), [], []
    for keys in (Keys.HOME, Keys.END, 40 * Keys.ARROW_LEFT):
        slider.send_keys(keys)
        o2, a, b, o4 = (np.array(shown.run(f"return {STARTED}.joint('{name}')")) for name in ("O2", "A", "B", "O4"))
        for link, (first, second) in {"a": (o2, a), "b": (a, b), "c": (o4, b), "d": (o2, o4)}.items():
            assert np.linalg.norm(second - first) == pytest.approx(LENGTHS[link], rel=1e-4)
        angles.append(told_angle(shown))
        assert (a - o2) / LENGTHS["a"] == pytest.approx([np.cos(angles[-1]), np.sin(angles[-1])], abs=2e-3)
        looks.append(pixels(shown.element(CANVAS)))
    assert np.ptp(angles) == pytest.approx(np.radians(256.344047290847 - 35.775663524736), abs=2e-3)
    assert changed(looks[0], looks[1]) > 0.005
    assert changed(looks[1], looks[2]) > 0.005
    assert shown.messages() == []


def test_it_plays_until_it_is_stopped(shown):
    button = shown.element(f'{FIGURE} button[title="Play the motion"]')
    before = shown.run(f"return {STARTED}.pose().place")
    button.click()
    shown.wait(f"{STARTED}.playing() && {STARTED}.pose().place !== {before}")
    shown.element(
        f"{FIGURE} .tools button:not([title='Reset view']):not([title='Larger']):not([title='Smaller'])"
    ).click()
    assert not shown.run(f"return {STARTED}.playing()")
    stands = shown.run(f"return {STARTED}.pose().place")
    shown.run("return new Promise((done) => setTimeout(done, 150))")
    assert shown.run(f"return {STARTED}.pose().place") == stands
