"""The page of a level on paper: all sheets, each with its foot, and lines to sign on."""

import chromium
from levels import pylon

from alula.fea.level.check_level import check_level
from alula.loads.compose.stated_case import StatedCase
from alula.reports.level.page import level_page, level_sections
from alula.reports.renderers.folder import drawn_pictures
from alula.reports.renderers.page import as_page


def test_it_prints_on_few_sheets_and_each_says_of_what(browser, tmp_path):
    result = check_level(StatedCase.from_dict(pylon()).record, fidelity="beam")
    sections = level_sections(result)
    page, path = level_page(result, sections), tmp_path / "level.html"
    path.write_text(as_page(page, drawn_pictures(page)), encoding="utf-8")
    browser.open(path)
    browser.wait("document.readyState === 'complete'")
    sheets = chromium.texts(browser.pdf())
    assert len(sheets) in (3, 4)
    foot = sections[-1].running
    assert all(text.startswith(f"{k} / {len(sheets)}{foot}") for k, text in enumerate(sheets, 1))
    assert "What all numbers stand on" in sheets[0]
    last = "".join(sheets[-2:])
    assert "Calculated by" in last
    assert sections[-1].data["provenance"]["sources"] in last
    assert browser.messages() == []
    browser.command("Emulation.setEmulatedMedia", media="print")
    wide = browser.run("return document.querySelector('#set-up :is(img, svg)').getBoundingClientRect().width")
    browser.command("Emulation.setEmulatedMedia", media="")
    assert wide >= 450.0  # of 710 pixels on the screen, so that its letters stay legible
