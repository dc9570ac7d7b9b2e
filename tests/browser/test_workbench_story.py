"""The workbench from an empty folder to a saved case that solids have checked, as someone does it who has read nothing.

With ``ALULA_PICTURES=docs/images`` the story draws the pictures of the tutorial anew.
"""

import contextlib
import io
import json
import os
import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import pytest
from chromium import PHONE

from alula.fea.check.run import check_case
from alula.loads.case.case_file import read_case, read_text
from alula.reports.sentences.verdicts import checks_of

WIDE = (1400, 900)
SMALL = (1180, 720)
"""Of the pictures."""
CONTROL, ENTER, TAB, ESCAPE, RIGHT, UP = "\ue009", "\ue007", "\ue004", "\ue00c", "\ue014", "\ue013"
REACHED = """
const shown = (one) => one.checkVisibility() && !one.disabled && !one.closest("[hidden]");
const all = [...document.querySelectorAll("button, input, select, textarea, summary, a[href], [tabindex]")];
const wanted = all.filter((one) => shown(one) && (one.tabIndex >= 0 || !one.matches("[role=tab]")));
return [wanted.indexOf(document.activeElement), wanted.length];
"""


@contextmanager
def opened(browser, folder, name, size=WIDE):
    """A page of ``alula open`` for a file of a folder; it asks nobody else, and says nothing to the console."""
    own = os.environ | {"ALULA_CACHE": str(folder.parent / "cache")}
    command = [sys.executable, "-m", "alula", "open", name, "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=own, cwd=folder) as server:
        try:
            address = re.search(r"http://\S+", server.stdout.readline())[0]
            browser.open(address, size)
            browser.wait("document.querySelector('#start button, .handles circle')")
            yield Page(browser, server)
            assert [one for one in browser.requests() if not one.startswith((address, "blob:"))] == []
            browser.leave()
            assert browser.messages() == []
        finally:
            server.terminate()


class Page:
    """What hands do on the page, and what is seen there."""

    def __init__(self, browser, server):
        self.browser, self.server = browser, server

    def state(self, expression):
        return self.browser.driver.execute_async_script(
            "const done = arguments[arguments.length - 1];"
            "import(new URL('page/store.js', document.baseURI))"
            f".then(({{ store }}) => {{ const now = store.state; done({expression}); }})"
        )

    def until(self, expression, seconds=60.0):
        """Wait until something is so in the page's store."""
        script = f"import(document.baseURI + 'page/store.js').then(({{ store: {{ state: now }} }}) => ({expression}))"
        self.browser.wait(script, seconds)

    def press(self, label):
        """Press a button by what stands on it; once more where the page has drawn it anew in between."""
        from selenium.common.exceptions import StaleElementReferenceException

        shown = "one.checkVisibility() && one.innerText.startsWith(arguments[0])"
        found = f"[...document.querySelectorAll('button')].find((one) => {shown})"
        for _ in range(3):
            with contextlib.suppress(StaleElementReferenceException):
                self.browser.run(f"return {found}", label).click()
                return
        raise AssertionError(f"'{label}' is drawn anew again and again")

    def keys(self, *keys):
        from selenium.webdriver.common.action_chains import ActionChains

        ActionChains(self.browser.driver).send_keys(*keys).perform()

    def control(self, letters):
        """Press letters with Control held."""
        from selenium.webdriver.common.action_chains import ActionChains

        ActionChains(self.browser.driver).key_down(CONTROL).send_keys(letters).key_up(CONTROL).perform()

    def screen(self, x, y):
        """Return where a place of the plane [mm] is in the window [px]."""
        view = self.state("now.view")
        box = self.browser.run("return document.querySelector('#sheet').getBoundingClientRect().toJSON()")
        return box["x"] + view["left"] + x * view["scale"], box["y"] + view["top"] - y * view["scale"]

    def pull(self, start, end, steps=6):
        """Press at a place of the plane [mm], move, and release at another."""
        from selenium.webdriver.common.action_chains import ActionChains

        (x, y), (to_x, to_y) = self.screen(*start), self.screen(*end)
        chain = ActionChains(self.browser.driver, duration=20)
        pointer = chain.w3c_actions.pointer_action
        pointer.move_to_location(round(x), round(y)).pointer_down()
        for k in range(1, steps + 1):
            pointer.move_to_location(round(x + (to_x - x) * k / steps), round(y + (to_y - y) * k / steps))
        pointer.pointer_up()
        chain.perform()

    def drawn(self, links):
        """Wait until so many links move, and the drawing is of the newest text."""
        moving = "now.drawn.links.filter((one) => !one.ground).length"
        self.until(f"now.drawn?.revision === now.document.revision && {moving} === {links}")

    def verdict(self, stage="whole"):
        """Return the verdict on the newest text."""
        self.until(f"now.verdict.{stage}?.revision === now.document.revision && !now.held")
        return self.state(f"now.verdict.{stage}")

    def height_of_a(self, y):
        """Wait until joint A is drawn at a height [mm]."""
        self.until(f"Math.abs(now.drawn.joints.find((one) => one.name === 'A').at[1] - {y}) < 1e-6")

    def on_top(self, selector):
        """Return whether nothing is painted over the middle of an element."""
        return self.browser.run(
            "const one = document.querySelector(arguments[0]), { x, y, width, height } = one.getBoundingClientRect();"
            "one.style.pointerEvents = 'auto';"
            "const seen = document.elementFromPoint(x + width / 2, y + height / 2);"
            "one.style.pointerEvents = '';"
            "return seen === one",
            selector,
        )

    def stamp(self):
        return self.browser.element("#panel-verdict .stamp").text.lower()

    def picture(self, name):
        """Draw a picture of the tutorial, if it is asked for, in all its colours: its legend tells by them."""
        folder = os.environ.get("ALULA_PICTURES")
        if folder:
            from PIL import Image

            self.browser.run(
                "const style = new CSSStyleSheet(); style.replaceSync('.command { display: none !important }');"
                "document.adoptedStyleSheets = [style];"
                "return new Promise(requestAnimationFrame)"
            )  # commands name the folder of this run
            with Image.open(io.BytesIO(self.browser.driver.get_screenshot_as_png())) as image:
                image.convert("RGB").save(Path(folder) / f"{name}.png", optimize=True)


def test_from_an_empty_folder_to_a_case_that_solids_have_checked(browser, tmp_path):
    """Three links and a load are drawn; the crank fails, is pulled until it passes, is solved as a solid, and saved."""
    folder = tmp_path / "linkages"
    folder.mkdir()
    size = SMALL if os.environ.get("ALULA_PICTURES") else WIDE
    with opened(browser, folder, "clamp.toml", size) as page:
        page.press("Draw a linkage")
        page.browser.wait("document.querySelector('.handles circle')")
        hint = page.browser.element("#hint")
        assert "Begin with Add link" in hint.text
        page.press("Add link")
        page.pull((0, 0), (20, 36))
        page.drawn(1)
        page.pull((20, 36), (90, 50))
        page.drawn(2)
        assert "2 ways" in hint.text
        assert page.on_top("#hint"), "the drawing hides what is wanted next"
        assert not page.browser.element("#problem").is_displayed(), "what is only begun is no mistake"
        page.picture("workbench-links")
        page.pull((90, 50), (100, 0))
        page.drawn(3)
        assert "moves in one way" in hint.text
        page.press("Add load")
        page.pull((90, 50), (75, 50))
        page.until("now.drawn.loads.length === 1 && now.tool === 'select'")
        page.browser.wait("document.querySelector('.entry')")
        page.keys("200", ENTER)
        page.until("now.drawn.loads[0]?.vector[0] === -200")

        failed = page.verdict()
        assert failed["verdict"] == "fail" == page.stamp()
        assert failed["links"]["link-1"]["verdict"] == "fail"
        page.until("now.verdict.whole.changes")
        page.press("Fit")
        page.picture("workbench-fail")
        page.control("s")
        page.until("now.document.saved")
        same_as_the_command(page, folder / "clamp.toml", failed)

        page.pull((20, 36), (30, 20), 10)
        assert page.verdict()["verdict"] == "undecided"
        field = page.browser.element('.entry [aria-label="y in mm"]')
        field.clear()
        field.send_keys("19" + ENTER)
        page.height_of_a(19)
        passed = page.verdict()
        assert passed["verdict"] == "pass" == page.stamp()
        page.press("Fit")
        page.picture("workbench-pass")
        page.control("zz")
        page.height_of_a(36)
        assert page.verdict()["verdict"] == "fail"
        page.control("yy")
        page.height_of_a(19)

        assert page.browser.element("#brief").text == "PASS\nby hand"
        page.press("Check with solids")
        page.until("now.solids?.state === 'done'", 300)
        solid = page.verdict("solids")
        assert solid["verdict"] == "pass"
        assert page.browser.element("#brief").text == "PASS\nwith solids"
        assert page.browser.element("#panel-solids p").text.startswith("PASS Pass: all ")
        assert {one["state"] for one in page.state("now.solids.links").values()} == {"done"}
        page.browser.wait("document.querySelector('#panel-solids .model canvas')")
        page.picture("workbench-solids")
        page.browser.element("#tab-verdict").click()
        assert band_of(solid, "link-1") < band_of(passed, "link-1"), "solids narrow the band"
        page.browser.run("document.querySelector('#panel-verdict svg.bands').scrollIntoView({ block: 'center' })")
        page.picture("workbench-bands")
        page.press("Save")
        page.until("now.document.saved")
        told = page.state("now.document.text")
        beside_another_editor(page, folder / "clamp.toml")
    saved = (folder / "clamp.toml").read_text(encoding="utf-8")
    assert saved == told.replace('"New linkage"', '"Mine"')
    with opened(browser, folder, "clamp.toml") as page:
        page.drawn(3)
        assert page.verdict()["checks"] == passed["checks"]


def same_as_the_command(page, file, shown):
    """Forces, values, bands and verdicts on the page are those of ``alula check --fidelity beam`` of the saved file."""
    told = check_case(read_case(str(file)), name="clamp", fidelity="beam", threads=1)
    assert told.verdict.value == shown["verdict"]
    rows = {(one["check"], one["subject"]): one for one in shown["checks"]}
    found = {(one.name, str(one.subject)): one for one in checks_of(told)}
    assert rows.keys() == found.keys()
    for key, one in found.items():
        assert rows[key]["verdict"] == one.verdict.value
        if one.value is not None and rows[key]["value"] is not None:
            assert rows[key]["value"] == pytest.approx(one.value.value, rel=1e-9)
    [forces] = page.state("now.drawn.forces").values()
    [case] = told.load_cases.values()
    for name, joint in forces["joints"].items():
        assert joint["force"] == pytest.approx(case.reactions.joints[name].force[:2], rel=1e-9)


def band_of(verdict, link):
    """Return how wide the band of a link's safety factor is."""
    one = next(one for one in verdict["checks"] if one["check"] == "strength" and one["subject"] == link)
    return one["high"] / one["low"]


def beside_another_editor(page, file):
    """A change on the disk is taken over while nothing is unsaved here, and asked about otherwise; nothing is lost."""
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace('"New linkage"', '"Theirs"'), encoding="utf-8")
    page.until("now.document.tables.title === 'Theirs' && now.document.saved")
    page.browser.wait("document.querySelector('#notice').innerText.includes('another program')")
    page.browser.element("#notice button").click()
    page.browser.element("#tab-text").click()
    area = "const area = document.querySelector('#panel-text textarea');"
    page.browser.run(
        f"{area} area.focus(); const at = area.value.indexOf('Theirs'); area.setSelectionRange(at, at + 6)"
    )
    page.keys("Mine")
    page.until("now.document.tables.title === 'Mine' && !now.document.saved")
    file.write_text(text.replace('"New linkage"', '"Third"'), encoding="utf-8")
    page.until("now.document.disk === 'changed'")
    assert "Third" in file.read_text(encoding="utf-8")
    page.press("Keep mine")
    page.until("now.document.saved")


def test_line_ends_and_mark_stay_where_the_text_is_written(browser, tmp_path):
    """As editors of Windows have them; what is typed is sent before Control and S save it."""
    file = tmp_path / "linkages" / "mine.toml"
    file.parent.mkdir()
    before = b"\xef\xbb\xbf" + read_text("four-bar")[0].replace("\n", "\r\n").encode()
    file.write_bytes(before)
    with opened(browser, file.parent, "mine.toml") as page:
        page.browser.element("#tab-text").click()
        area = "const area = document.querySelector('#panel-text textarea'); area.focus();"
        at = "const at = area.value.indexOf('\"Four-bar') + 1; area.setSelectionRange(at, at + 8);"
        page.browser.run(area + at)
        page.keys("Mine")
        page.control("s")
        page.until("now.document.undo && now.document.saved")
    assert file.read_bytes() == before.replace(b'"Four-bar', b'"Mine')


def test_the_keyboard_alone_draws_and_reaches_everything(browser, tmp_path):
    folder = tmp_path / "linkages"
    folder.mkdir()
    with opened(browser, folder, "keys.toml") as page:
        for _ in range(6):
            page.keys(TAB)
            if "Draw" in page.browser.driver.switch_to.active_element.text:
                break
        page.keys(ENTER)
        page.browser.wait("document.querySelector('.handles circle')")
        page.keys("l")
        reach(page, "Point O2")
        page.keys(ENTER)
        reach(page, "Place")
        page.keys(RIGHT, UP, UP, ENTER)
        page.drawn(1)
        page.keys(ESCAPE)
        reached, wanted = set(), 0
        for _ in range(120):
            page.keys(TAB)
            place, wanted = page.browser.run(REACHED)
            reached.add(place)
        assert reached - {-1} == set(range(wanted))
        assert wanted > 15


def reach(page, label):
    for _ in range(60):
        page.keys(TAB)
        if (page.browser.driver.switch_to.active_element.get_attribute("aria-label") or "").startswith(label):
            return
    pytest.fail(f"Tab does not reach {label}")


def test_what_is_begun_from_is_legible_on_a_phone_and_refuses_in_a_sentence(browser, tmp_path):
    folder = tmp_path / "linkages"
    folder.mkdir()
    (folder / "mine.toml").write_text(read_text("finger")[0], encoding="utf-8")
    with opened(browser, folder, "new.toml", PHONE) as page:
        assert page.browser.run("return document.documentElement.scrollWidth") == PHONE[0]
        name = page.browser.element("#start input")
        name.clear()
        name.send_keys("mine.toml")
        page.press("Draw a linkage")
        page.browser.wait("document.querySelector('#start [role=alert]').innerText.includes('exist')")
        page.browser.messages()  # that the server refused
        page.press("mine.toml")
        page.browser.wait("document.querySelector('.handles circle')")
        assert page.browser.run("return document.documentElement.scrollWidth") == PHONE[0]
        assert json.loads(page.state("JSON.stringify(now.document.saved)"))
        page.until("now.drawn && Object.keys(now.drawn.forces).length")
        page.browser.wait("!document.querySelector('#brief').hidden")
        verdict = page.browser.element("#brief")
        assert verdict.location["y"] + verdict.size["height"] < PHONE[1], "it is seen without scrolling"
        page.server.kill()
        page.browser.wait("document.querySelector('#notice').innerText.includes('alula open mine.toml')")
        page.browser.leave()
        page.browser.messages()  # that nobody answered
