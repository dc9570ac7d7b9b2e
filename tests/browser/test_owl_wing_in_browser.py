"""The report of the owl wing with all its links as solids: its weight, its sheets of paper, and all of its models."""

import chromium
import programs
import pytest


@pytest.mark.converged
def test_it_can_be_mailed_printed_and_turned(browser, tmp_path):
    done = programs.inside("check", "owl-wing-static", "--fidelity", "solid", "-o", "out", folder=tmp_path)
    assert done.returncode == 1, done.stderr
    page = tmp_path / "out" / "report.html"
    assert page.stat().st_size < 6e6
    browser.open(page)
    figures = browser.elements("figure[data-name]")
    assert {figure.get_attribute("data-name") for figure in figures} == {"linkage", "AE", "CF", "CH", "ED", "GF"}
    for figure in figures:
        browser.run("arguments[0].scrollIntoView()", figure)
        name = figure.get_attribute("data-name")
        browser.wait(f"document.querySelector('figure[data-name={name}]').dataset.turnable === 'ready'")
    assert browser.messages() == []
    assert chromium.sheets(browser.pdf()) <= 13
