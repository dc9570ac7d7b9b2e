"""The panels of the page to work in: entries, text, solids, what goes out; against what the commands say."""

import json
import os
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import chromium
import pytest

from alula.fea.check.run import check_case
from alula.loads.case.case_file import read_case, read_text
from alula.reports.sentences.verdicts import checks_of
from alula.reports.tools.part import inspect_file

SHOW = """
const select = document.querySelector("#panel-forms select");
select.value = arguments[0];
return select.value && select.dispatchEvent(new Event("change"));
"""
WIDTH = """[data-path='["parts","bar","width"]']"""
MINIMUM = """[data-path='["checks","strength","minimum"]']"""
STEP = Path(__file__).parents[1] / "data" / "step" / "bell_crank.step"
TEXT = "document.querySelector('#panel-text textarea').value"
BLOBS = """
window.handed = [];
const made = URL.createObjectURL;
URL.createObjectURL = (blob) => (window.handed.push(blob), made.call(URL, blob));
"""
READ = "const [kind, done] = arguments; window.handed.findLast(({ type }) => type.startsWith(kind)).text().then(done);"
LABELS = "[...document.querySelectorAll('#plane .texts text.link')].map((one) => one.textContent)"
COLOURS = (
    "return [...new Set([...document.querySelectorAll('#plane .links .part')].map((one) => one.getAttribute('fill')))]"
)
PUT = """
const [verdict, done] = arguments;
import(document.baseURI + "page/store.js").then(({ store }) => {
  const none = { linear: null, whole: null, solids: null };
  store.put("verdict", { ...none, [verdict.stage]: { revision: store.state.document.revision, ...verdict } });
  done();
});
"""
TYPE = """
const [was, now, ahead, other, done] = arguments;
const area = document.querySelector("#panel-text textarea");
const elsewhere = (store) => fetch("text", {
  method: "POST",
  headers: { "Content-Type": "application/json" },
  body: JSON.stringify({ revision: store.state.document.revision, text: store.state.document.text.replace(...other) }),
});
import(document.baseURI + "page/store.js").then(async ({ store }) => {
  area.focus();
  area.setRangeText(now, area.value.indexOf(was), area.value.indexOf(was) + was.length, "end");
  area.dispatchEvent(new Event("input"));
  const answer = elsewhere(store);
  if (ahead) area.dispatchEvent(new KeyboardEvent("keydown", { key: "Control", ctrlKey: true }));
  done((await answer).status);
});
"""
"""Type, and have another page change the text before what is typed is sent, or while it is on its way."""
PRESS = "[...document.querySelectorAll('button')].find((one) => one.textContent === arguments[0]).click()"


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path]]:
    """Address of a workbench on a copy of the four-bar, and that file."""
    case = tmp_path_factory.mktemp("bench") / "mine.toml"
    case.write_text(read_text("four-bar")[0], encoding="utf-8")
    own = os.environ | {"XDG_CACHE_HOME": str(tmp_path_factory.mktemp("cache"))}
    command = [sys.executable, "-m", "alula", "open", str(case), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=own) as served:
        assert served.stdout is not None
        try:
            yield served.stdout.readline().split()[-1], case
        finally:
            served.terminate()


def visit(browser: chromium.Browser, address: str, size: tuple[int, int] = chromium.DESKTOP) -> None:
    browser.open(address, size)
    browser.wait("document.querySelector('#panel-verdict .stamp')")


def open_panel(browser: chromium.Browser, name: str) -> None:
    browser.element(f"#tab-{name}").click()


def show(browser: chromium.Browser, table: str) -> None:
    """Choose a table of entries."""
    browser.wait(f"[...document.querySelectorAll('#panel-forms option')].some((one) => one.value === '{table}')")
    browser.run(SHOW, table)


def write(browser: chromium.Browser, selector: str, text: str) -> None:
    """Type into a field as a person does, and leave it by the keyboard."""
    browser.keys(selector, "\ue009a\ue000" + text + "\ue004")


def test_a_width_changes_the_text_and_the_verdict(browser: chromium.Browser, bench: tuple[str, Path]) -> None:
    """A wider bar: the text has it, its comments stay, and the verdict is that of ``alula check --fidelity beam``."""
    address, case = bench
    visit(browser, address)
    open_panel(browser, "forms")
    show(browser, "parts")
    browser.wait(f"document.querySelector({WIDTH!r})")
    assert browser.element(WIDTH).get_attribute("value") == "8 mm"
    write(browser, WIDTH, "16")  # in the unit of what stood there
    browser.wait(f"""{TEXT}.includes('width = "16 mm"')""")
    text = browser.run(f"return {TEXT}")
    assert text.replace('width = "16 mm"', 'width = "8 mm"') == case.read_text(encoding="utf-8")
    mine = case.with_name("wide.toml")
    mine.write_text(text, encoding="utf-8")
    told = check_case(read_case(str(mine)), name="wide", fidelity="beam", threads=1)
    factor = next(one.value.value for one in checks_of(told) if one.name == "strength" and str(one.subject) == "crank")
    open_panel(browser, "verdict")
    shown = "[...document.querySelectorAll('#panel-verdict tbody tr')].map((row) => row.innerText).join()"
    browser.wait(f"{shown}.includes('{factor:.4g}') && !document.querySelector('#panel-verdict.old')")
    assert browser.element("#panel-verdict .stamp").text.lower() == told.verdict.value
    browser.wait("document.querySelector('#panel-verdict .stamp-line').innerText.includes('whole')")
    apply = "[...document.querySelectorAll('#panel-verdict .changes button')].some((one) => one.innerText === 'Apply')"
    browser.wait(apply)
    assert "is calibrated for links of part bar with" in browser.element("#panel-verdict .changes").text
    first = browser.element("#panel-verdict div p").text
    assert first.startswith("Hand calculation is not calibrated for links of part bar: it would be with ")
    browser.wait(f"{LABELS}.some((one) => one.startsWith('crank') && one.endsWith('% (no band) ?'))")
    assert browser.run(COLOURS) == ["#d9b8d0"], "a number without band is no colour of what is known"
    browser.run(PRESS, "Apply")
    browser.wait(f"!{TEXT}.includes('width = \"16 mm\"')")
    browser.wait("!document.querySelector('#panel-verdict.old')")
    assert "not calibrated" not in browser.element("#panel-verdict").text
    browser.wait(f"!{LABELS}.some((one) => one.includes('no band'))")
    browser.run("document.activeElement.blur()")
    undo = "[...document.querySelectorAll('button')].find((one) => one.textContent.startsWith('Undo')).click()"
    browser.run(undo)
    browser.wait(f"{TEXT}.includes('width = \"16 mm\"')")
    browser.run(undo)
    browser.wait(f"""{TEXT} === {json.dumps(case.read_text(encoding="utf-8"))}""")


def test_a_pure_number_stays_one_and_what_is_typed_is_saved(browser: chromium.Browser, bench: tuple[str, Path]) -> None:
    """With decimals as without; what is no number goes through and is told; Ctrl+S takes what has the cursor."""
    address, case = bench
    visit(browser, address)
    before = browser.run(f"return {TEXT}")
    open_panel(browser, "forms")
    show(browser, "checks")
    browser.wait(f"document.querySelector({MINIMUM!r})")
    for typed, stands in (("2.5", "2.5"), ("3.5", "3.5"), ("6..5", '"6..5"'), (".5", "0.5"), ("4", "4")):
        write(browser, MINIMUM, typed)
        browser.wait(f"/^minimum = {stands}(?![.0-9])/m.test({TEXT})")
        browser.wait(f"document.querySelector({MINIMUM!r}).value === {stands.strip(chr(34))!r}")
    browser.keys(MINIMUM, "\ue009a\ue000" + "2.75" + "\ue009s\ue000")
    browser.wait(f"/^minimum = 2.75/m.test({TEXT})")
    browser.wait("document.title.startsWith('mine')")
    assert tomllib.loads(case.read_text(encoding="utf-8"))["checks"]["strength"]["minimum"] == 2.75
    case.write_text(before, encoding="utf-8")
    browser.wait(f"{TEXT} === {json.dumps(before)}")


def test_what_is_wrong_stands_at_its_line_and_at_its_field(browser: chromium.Browser, bench: tuple[str, Path]) -> None:
    address, _ = bench
    visit(browser, address)
    open_panel(browser, "text")
    area = browser.element("#panel-text textarea")
    area.send_keys("\ue009\ue010\ue000" + "\n[parts.bar\n")
    browser.wait("!document.querySelector('#panel-text .at-line').hidden")
    lines = browser.run(f"return {TEXT}").split("\n")
    assert browser.element("#panel-text .numbers b").text == str(1 + lines.index("[parts.bar"))
    assert "TOML" in browser.element("#panel-text .at-line").text
    browser.wait("document.querySelector('#plane svg.old')")
    area.send_keys("\ue003" * len("\n[parts.bar\n"))
    browser.wait("document.querySelector('#panel-text .at-line').hidden")
    browser.wait("!document.querySelector('#plane svg.old')")
    browser.run(
        "const area = document.querySelector('#panel-text textarea'); area.focus();"
        "const at = area.value.indexOf('width = \"8 mm') + 12; area.setSelectionRange(at, at);"
    )
    area.send_keys("m")
    browser.wait("document.querySelector('#panel-text .at-line').innerText.includes('\"mmm\" is not a unit')")
    assert browser.element("#panel-text .numbers b").text == str(1 + lines.index('width = "8 mm"'))
    area.send_keys("\ue003")
    browser.wait("document.querySelector('#panel-text .at-line').hidden")

    open_panel(browser, "forms")
    show(browser, "parts")
    browser.wait(f"document.querySelector({WIDTH!r})")
    write(browser, WIDTH, "9 apples")
    browser.wait(f"""document.querySelector({WIDTH!r})?.getAttribute("aria-invalid") === "true" """)
    field = browser.element(WIDTH)
    told = browser.element(f"#{field.get_attribute('aria-describedby')}").text
    assert told.startswith("parts.bar.width")
    assert "unit of length" in told
    show(browser, "links")
    browser.wait("document.querySelector('#panel-forms .to-line')")
    browser.element("#panel-forms .to-line").click()
    browser.wait(f"document.querySelector({WIDTH!r})")
    write(browser, WIDTH, "9 mm")
    browser.wait("!document.querySelector('#plane svg.old')")
    a_range_waits_for_its_second_value(browser)


@pytest.mark.parametrize("ahead", [False, True])
def test_what_two_pages_write_at_once_stands_both(
    browser: chromium.Browser, bench: tuple[str, Path], ahead: bool
) -> None:
    """Lines of both stand in the text; where it is one line, the second page is told, and undo shows the first."""
    address, _ = bench
    visit(browser, address)
    open_panel(browser, "text")
    before = browser.run(f"return {TEXT}")
    server = 'return import(document.baseURI + "page/server.js").then(({ change }) => change(...arguments))'
    at_once = 'import(document.baseURI + "page/store.js").then(({ store: { state: now } }) => '
    title, part = ('title = "', 'title = "{}, '), ("[parts.bar]", "[parts.bar] # {}")
    for (was, typed), (elsewhere, put) in ((title, part), (part, title)):
        typed, other = typed.format("mine"), (elsewhere, put.format("theirs"))
        browser.driver.execute_async_script(TYPE, was, typed, ahead, other)
        both = f"now.document.text.includes({json.dumps(typed)}) && now.document.text.includes({json.dumps(other[1])})"
        browser.wait(f"{at_once} {both} && now.document.text === {TEXT})")
        assert not browser.element("#notice").is_displayed()
    browser.driver.execute_async_script(TYPE, "theirs, mine", "ours", ahead, ("theirs, mine", "others"))
    browser.wait("document.querySelector('#notice').innerText.includes('in which you write')")
    browser.wait(f"{at_once} now.document.text.includes('ours, ') && now.document.text === {TEXT})")
    browser.run("document.activeElement.blur()")
    browser.run(server, "undo")
    browser.wait(f"{TEXT}.includes('others, ')")
    browser.run(server, "text", {"text": before})
    browser.wait(f"{TEXT} === {json.dumps(before)}")
    browser.messages()  # that the server refused what came second


def a_range_waits_for_its_second_value(browser: chromium.Browser) -> None:
    """What was typed first stays, without a sentence, and both are stated at once."""
    edit = "return import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))"
    browser.run(edit, [{"op": "set", "path": ["motion"], "value": {}}])
    show(browser, "motion")
    first, second = (f"""[data-path='["motion","range",{place}]']""" for place in (0, 1))
    browser.wait("document.querySelector('#panel-forms details')")
    browser.run("document.querySelectorAll('#panel-forms details:not(.help)').forEach((one) => (one.open = true))")
    browser.wait(f"document.querySelector({first!r})")
    browser.run("return new Promise((done) => setTimeout(done, 900))")  # the edit is told once more when it is drawn
    write(browser, first, "30 deg")
    assert browser.run("return new Promise((done) => setTimeout(done, 600))") is None
    assert browser.element(first).get_property("value") == "30 deg"
    write(browser, second, "50 deg")
    browser.wait(f"""{TEXT}.includes('range = ["30 deg", "50 deg"]')""")
    browser.run(edit, [{"op": "remove", "path": ["motion"]}])
    browser.wait(f"!{TEXT}.includes('[motion]')")


def test_what_is_selected_in_the_drawing_is_shown(browser: chromium.Browser, bench: tuple[str, Path]) -> None:
    address, _ = bench
    visit(browser, address, chromium.PHONE)
    select = "import(document.baseURI + 'page/store.js').then(({ store }) => store.put('selected', arguments[0]))"
    open_panel(browser, "forms")
    browser.run(select, {"kind": "load", "path": ["load_cases", "lift", "forces", 0]})
    force = """[data-path='["load_cases","lift","forces",0,"force",1]']"""
    browser.wait(f"document.querySelector({force!r})?.value === '-5 N'")
    browser.run(select, {"kind": "link", "name": "rocker"})
    browser.wait(f"document.querySelector({WIDTH!r})?.value.endsWith(' mm')")
    assert "Part bar, shared with crank, coupler" in browser.element("#panel-forms form").text
    assert browser.run("return document.documentElement.scrollWidth") <= chromium.PHONE[0]


def test_pictures_and_the_report_leave_the_page(
    browser: chromium.Browser, bench: tuple[str, Path], tmp_path: Path
) -> None:
    """The picture alone looks as on the page, a solid is read again; the report opens, of the text that is shown."""
    address, _ = bench
    visit(browser, address)
    browser.wait("document.querySelector('.texts .link')")
    open_panel(browser, "forms")
    show(browser, "parts")
    browser.wait(f"document.querySelector({WIDTH!r})")
    write(browser, WIDTH, "9 mm")
    browser.wait(f"""{TEXT}.includes('width = "9 mm"')""")
    browser.wait("!document.querySelector('#panel-verdict.old')")
    browser.run(BLOBS)
    open_panel(browser, "out")
    browser.run(PRESS, "Picture, SVG")
    browser.run(PRESS, "Picture, PNG")
    browser.run(PRESS, "Case file")
    browser.wait("window.handed.length === 4")
    browser.wait("window.handed.map((one) => one.type).join().includes('png')")
    drawn = browser.driver.execute_async_script(READ, "image/svg")
    assert "class=" not in drawn
    assert 'fill="rgb(' in drawn
    picture = ElementTree.fromstring(drawn)
    assert picture.tag == "{http://www.w3.org/2000/svg}svg"
    told = [one.text.partition(":")[0] for one in picture.iter() if one.text]
    assert {"may be more", "joint force", "layer 1"} <= {*told}, "legend and layers are seen as well"
    assert all(told.count(link) == 2 for link in ("crank", "coupler", "rocker")), "in the plane and in the layers"
    below = [float(one.get("y")) for one in picture.iter() if one.text in ("joint force", "x, y [mm]")]
    assert below == sorted(below)
    assert float(picture.get("height")) > below[-1]
    case = browser.driver.execute_async_script(READ, "application")
    assert tomllib.loads(case)["parts"]["bar"]["width"] == "9 mm"
    browser.run(PRESS, "STEP")
    browser.wait("window.handed.length === 5")
    solid = tmp_path / "crank.step"
    solid.write_text(browser.driver.execute_async_script(READ, "application/octet-stream"), encoding="utf-8")
    assert len(inspect_file(solid, None).facts.bores) == 2
    page = browser.driver.current_window_handle
    browser.element("#panel-out a.button").click()
    browser.driver.switch_to.window(next(one for one in browser.driver.window_handles if one != page))
    try:
        browser.wait("document.querySelector('.verdict .stamp')?.textContent")
        assert "undecided" in browser.element(".verdict .stamp").text.lower()
        assert browser.wait("document.querySelector('main').offsetHeight > 500"), "the report's own style holds"
    finally:
        browser.driver.close()
        browser.driver.switch_to.window(page)
    assert [one for one in browser.messages() if "favicon" not in one] == []


def copied_commands_run(browser: chromium.Browser, case: Path) -> None:
    """What the page gives to be copied runs as a shell takes it, beside the case; by hand alone, which takes less."""
    entry = "return import(document.baseURI + 'page/store.js').then(({ store }) => store.put('entry', arguments[0]))"
    browser.run(entry, ["parts", "bar", "width"])
    commands = [one.text for one in browser.elements("#panel-out .command code")]  # sizes that the verdict names
    for button in ("Study this", "Least size"):
        browser.run(PRESS, button)
        commands.append(browser.element("#panel-out .command code").text)
        assert "parts.bar.width=4.5" in commands[-1]
    for command in commands:
        program, *words = shlex.split(command)
        assert program == "alula"
        typed = [sys.executable, "-m", program, *words, "--fidelity", "beam"]
        done = subprocess.run(typed, cwd=case.parent, capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1, 3), done.stderr
    assert (case.parent / "mine-study" / "study.sqlite").is_file()


def open_check(link: str, text: str, verdict: str = "undecided") -> dict[str, object]:
    told = {"check": "collapse", "quantity": "plastic-collapse factor", "load_case": "lift", "unit": ""}
    return told | {
        "subject": link,
        "value": 2.0,
        "low": 1.0,
        "high": 3.0,
        "limit": 2.4,
        "verdict": verdict,
        "text": text,
    }


@pytest.mark.parametrize("verdict", ["pass", "fail", "undecided"])
def test_the_panel_says_what_the_verdict_is_by_what_is_sought_and_each_reason_once(
    browser: chromium.Browser, bench: tuple[str, Path], verdict: str
) -> None:
    visit(browser, bench[0])
    browser.wait("document.querySelector('#panel-verdict .changes')")
    two = [open_check("crank", "It needs a solid."), open_check("rocker", "It needs a solid.")]
    checks = [*two, open_check("crank", "Its band is wide."), open_check("coupler", "It passes.", "pass")]
    shown = {"stage": "whole", "verdict": verdict, "sentences": ["So it is."], "checks": checks, "links": {}}
    shown |= {"warnings": [], "ms": 1.0, "changes": None}
    browser.driver.execute_async_script(PUT, shown)
    panel = browser.element("#panel-verdict")
    assert browser.element("#brief").text.lower() == f"{verdict}\nby hand"
    assert [one.text for one in browser.elements("#panel-verdict .why")] == [
        "crank, rocker: It needs a solid.",
        "Its band is wide.",
    ]
    assert ("A section that passes is sought" in panel.text) == (verdict != "pass")
    assert "Check with solids" in panel.text
    command = "alula size mine.toml --vary x"
    change = {"text": "It passes with less.", "command": command, "operations": None}
    browser.driver.execute_async_script(PUT, shown | {"changes": [change]})
    assert "It passes with less." in panel.text
    assert "is sought" not in panel.text
    assert command not in panel.text, "commands stand in Out"
    browser.driver.execute_async_script(PUT, shown | {"changes": [], "stage": "solids"})
    assert browser.element("#brief").text.lower() == f"{verdict}\nwith solids"
    assert "Check with solids" not in panel.text
    open_panel(browser, "solids")
    assert browser.element("#panel-solids p").text.lower() == f"{verdict} so it is."
    browser.driver.execute_async_script(PUT, shown | {"stage": "solids", "revision": -1})
    assert browser.element("#panel-solids .stamp.late").text.lower() == verdict


def test_solids_bring_models_and_stand_beside_the_hand(browser: chromium.Browser, bench: tuple[str, Path]) -> None:
    """The crank alone has a part, so that one link is solved, not finely: its model turns, and both bands are told."""
    address, case = bench
    visit(browser, address)
    bare = [{"op": "set", "path": ["links", link, "part"], "value": None} for link in ("rocker", "coupler")]
    bare.append({"op": "set", "path": ["load_cases", "lift", "own_weight"], "value": False})
    bare.append({"op": "set", "path": ["solid", "accuracy"], "value": "30 %"})
    bare.append({"op": "set", "path": ["parts", "bar", "width"], "value": "9 mm"})
    browser.run("import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))", bare)
    browser.wait(f"{TEXT}.includes('own_weight = false')")
    open_panel(browser, "solids")
    browser.element("#solids-auto").click()  # by itself, once nothing has changed for three seconds
    browser.wait("document.querySelector('#panel-solids [role=status]').innerText.includes('links are solved')")
    browser.wait("document.querySelector('#panel-solids .model canvas')")
    browser.wait("document.querySelector('#panel-solids th')?.innerText === 'crank'")
    open_panel(browser, "verdict")
    browser.wait("document.querySelector('#panel-verdict svg.bands')")
    told = browser.element("#panel-verdict svg.bands").get_attribute("aria-label")
    assert told.startswith("crank: by hand ")
    assert "; solid " in told
    assert "with solids" in browser.element("#panel-verdict .stamp-line").text
    browser.element("[aria-keyshortcuts='Control+S']").click()
    browser.wait("document.querySelector('#name').innerText.endsWith('\\nsaved')")
    open_panel(browser, "out")
    copied_commands_run(browser, case)


def test_a_part_from_cad_is_offered_to_the_pins_of_a_link(browser: chromium.Browser, bench: tuple[str, Path]) -> None:
    """Two bores get the points of the coupler; the third one of the file is left over."""
    address, case = bench
    visit(browser, address)
    select = "import(document.baseURI + 'page/store.js').then(({ store }) => store.put('selected', arguments[0]))"
    browser.run(select, {"kind": "link", "name": "coupler"})
    open_panel(browser, "out")
    browser.element("#panel-out input[type=file]").send_keys(str(STEP))
    browser.wait("document.querySelectorAll('#panel-out tbody tr').length === 3")
    points = "[...document.querySelectorAll('#panel-out tbody select')].map((one) => one.value)"
    assert browser.run(f"return {points}") == ["A", "B", ""]
    browser.run(PRESS, "Use this part")
    browser.wait(f"{TEXT}.includes('shape = \"step\"')")
    tables = tomllib.loads(browser.run(f"return {TEXT}"))
    assert tables["links"]["coupler"]["part"] == "bell_crank"
    assert set(tables["parts"]["bell_crank"]["bores"]) == {"A", "B"}
    assert case.with_name("bell_crank.step").read_bytes() == STEP.read_bytes()
