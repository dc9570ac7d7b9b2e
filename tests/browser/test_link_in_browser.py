"""The model of a link in a page, as a reader meets it: drawn, turned, asked for its stress, printed."""

import re
from unicodedata import normalize

import chromium
import numpy as np
import pytest
from chromium import DESKTOP, NO_WEBGL, PHONE, changed, pixels
from wing_with_solid import SOLID_LINK

FIGURE = f'figure[data-name="{SOLID_LINK}"]'
CANVAS = f"{FIGURE} .picture canvas"
MODEL = f"window.alulaViewer.models.find((model) => model.name === '{SOLID_LINK}')"
ADDRESS = re.compile(r"file:///.*/report\.html$")


@pytest.fixture
def shown(browser, file):
    """The page with the model before the reader, as it is at first; it is opened anew where another test left it."""
    if not browser.run("return window.alulaKept === true"):
        show(browser, file)
        browser.run("window.alulaKept = true")
    browser.element(f'{FIGURE} button[title="Reset view"]').click()
    browser.elements(f"{FIGURE} .choice button")[0].click()
    centre(browser)
    return browser


def show(browser, file, size=DESKTOP):
    browser.open(file, size)
    browser.run(f"document.querySelector('{FIGURE}').scrollIntoView()")
    browser.wait(f"document.querySelector('{FIGURE}').dataset.turnable !== 'waiting'")
    assert browser.element(FIGURE).get_attribute("data-turnable") == "ready"
    centre(browser)
    return browser


def centre(browser):
    browser.run(f"document.querySelector('{CANVAS}').scrollIntoView({{ block: 'center' }})")


def point(browser, x, y):
    """Move the pointer to a place of the visible part of the page."""
    from selenium.webdriver.common.action_chains import ActionBuilder

    actions = ActionBuilder(browser.driver, duration=0)
    actions.pointer_action.move_to_location(x, y)
    actions.perform()


def facts(browser):
    return browser.element(f"{FIGURE} .legend .facts").text.splitlines()


def number_in(text):
    return float(re.search(r"−?\d+(\.\d+)?", text)[0].replace("−", "-"))


def drag(browser, dx, dy):
    from selenium.webdriver.common.action_chains import ActionChains

    canvas = browser.element(CANVAS)
    ActionChains(browser.driver, duration=20).move_to_element(canvas).click_and_hold().move_by_offset(
        dx, dy
    ).release().perform()
    browser.run("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def test_it_is_drawn_and_turns_with_a_drag(shown):
    """A drag changes the picture, the reset brings the first one back; no message appears and no request leaves."""
    first = pixels(shown.element(CANVAS))
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 50
    drag(shown, 120, 40)
    turned = pixels(shown.element(CANVAS))
    assert changed(first, turned) > 0.02
    shown.element(f'{FIGURE} button[title="Reset view"]').click()
    drag(shown, 0, 0)
    assert changed(first, pixels(shown.element(CANVAS))) < 0.005
    assert shown.messages() == []
    assert [address for address in shown.requests() if not ADDRESS.search(address)] == []


def test_a_model_that_comes_later_is_shown_and_taken_away(shown):
    """A page may get a model after it was opened, and others in its place: as drawn by itself, and nothing stays."""
    shown.run(
        f"const block = document.querySelector('{FIGURE} script'); const late = document.createElement('div');"
        "late.id = 'late'; document.querySelector('main, body').prepend(late);"
        "window.late = window.alulaViewer.show(late, 'link', block.textContent); late.scrollIntoView()"
    )
    shown.run("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert len(np.unique(pixels(shown.element("#late .picture canvas")).reshape(-1, 3), axis=0)) > 50
    assert shown.run("return window.late.hottest()") == shown.run(f"return {MODEL}.start().hottest()")
    assert shown.run("return window.late.reading()")
    shown.run("window.late.remove()")
    shown.run("return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert not shown.elements("#late *")
    shown.run("document.querySelector('#late').remove()")
    assert shown.messages() == []
    shown.run(
        f"const block = document.querySelector('{FIGURE} script'); window.late = "
        "window.alulaViewer.show(document.body.appendChild(document.createElement('div')), 'link', '{}')"
    )
    assert shown.run("return window.late") is None
    shown.run("window.alulaKept = false")


def test_the_legend_agrees_with_the_result(shown, page):
    """Unit, ends and the largest value; each variant that a button chooses has its own."""
    record = page.record["load_cases"]["weight"]["links"][SOLID_LINK]
    assert shown.element(f"{FIGURE} .legend .title").text.lower() == "von mises stress [mpa]"
    assert number_in(facts(shown)[0]) == pytest.approx(record["von_mises_max"]["value"], rel=5e-4)
    assert " MPa at x = " in facts(shown)[0]
    place = [float(at.replace("−", "-")) for at in re.findall(r"= (−?[\d.]+)", facts(shown)[0])]
    assert place == pytest.approx(record["location"], abs=0.051)
    ticks = [number_in(mark.text) for mark in shown.elements(f"{FIGURE} .legend .scale span")]
    assert ticks[0] == 0.0
    assert ticks == sorted(ticks)
    buttons = shown.elements(f"{FIGURE} .choice button")
    assert len(buttons) == len(record["variants"]) == 2
    for button, variant in zip(buttons, record["variants"], strict=True):
        button.click()
        assert button.get_attribute("aria-pressed") == "true"
        assert str(variant["span"]) in button.text
        assert number_in(facts(shown)[0]) == pytest.approx(variant["von_mises"], rel=5e-4)
        told = next(line for line in facts(shown) if line.startswith("largest displacement"))
        assert number_in(told) == pytest.approx(variant["displacement"], rel=5e-3)
        assert told.endswith(" mm")


def test_the_pointer_tells_the_stress_of_the_node_below_it(shown, page):
    """Five nodes that can be seen: value and place are those of the finite elements, to the page's 16 bits."""
    for button, values in zip(shown.elements(f"{FIGURE} .choice button"), page.stresses, strict=True):
        button.click()
        centre(shown)
        seen = shown.run(
            f"const {{ started }} = {MODEL};"
            "const told = (_, node) => ({ ...started.screen(node), ...started.value(node) });"
            "return Array.from({ length: started.nodes }, told)"
            ".filter((node) => node.seen)"
        )
        screen = np.array([[node["x"], node["y"]] for node in seen])
        away = np.linalg.norm(screen[:, None] - screen, axis=2) + 1e9 * np.eye(len(seen))
        seen = [node for node, near in zip(seen, away.min(axis=1), strict=True) if near > 3.0]  # pointers: whole pixels
        assert len(seen) > 20
        for node in np.random.default_rng(4).choice(seen, 5, replace=False):
            known = int(np.argmin(np.linalg.norm(page.surface - node["place"], axis=1)))
            assert page.surface[known] == pytest.approx(node["place"], abs=1e-3)
            point(shown, round(node["x"]), round(node["y"]))
            reading = shown.element(f"{FIGURE} .reading").text
            assert re.match(r"[\d.]+ MPa at x = ", reading)
            stress, *place = (float(text.replace("−", "-")) for text in re.findall(r"(?:^|= )(−?[\d.]+)", reading))
            assert place == pytest.approx(page.surface[known], abs=0.006)
            assert stress == pytest.approx(values[known], rel=6e-4, abs=np.ptp(values) / 65535)


def test_the_slider_scales_the_deformation(shown):
    """At its lower end the link is undeformed and says so; at its upper end it is bent more than at first."""
    from selenium.webdriver.common.keys import Keys

    slider, told = shown.element(f"{FIGURE} .slider input"), shown.element(f"{FIGURE} .slider output")
    looks, words = [], []
    for key in (Keys.HOME, Keys.END):
        slider.send_keys(key)
        drag(shown, 0, 0)
        looks.append(pixels(shown.element(CANVAS)))
        words.append(told.text)
    assert words[0] == "undeformed"
    assert re.fullmatch(r"× [\d.]+", words[1])
    assert changed(*looks) > 0.005


def test_what_is_injected_does_not_run_and_nothing_is_fetched(browser, file):
    """Scripts, handlers and addresses that are not alula's own are refused by the page's policy."""
    browser.open(file)
    browser.run(
        "window.refused = new Set();"
        "document.addEventListener('securitypolicyviolation', (event) => refused.add(event.effectiveDirective));"
        "const script = document.createElement('script'); script.textContent = 'window.injected = 1';"
        "document.head.append(script);"
        "const box = document.createElement('div'); document.body.append(box);"
        'box.innerHTML = \'<img src="data:," onerror="window.injected = 2"><style>main { display: none }</style>\';'
        "const image = new Image(); image.src = 'http://127.0.0.1:9/pixel.png';"
        "fetch('http://127.0.0.1:9/').catch(() => 0);"
    )
    for directive in ("script-src-elem", "script-src-attr", "style-src-elem", "img-src", "connect-src"):
        browser.wait(f"window.refused.has('{directive}')", seconds=10.0)
    assert browser.run("return window.injected === undefined")
    assert browser.element("main").is_displayed()


def test_on_a_phone_nothing_runs_over_the_edge(browser, file):
    """The page does not scroll sideways, and every control of the model can be touched."""
    show(browser, file, PHONE)
    assert browser.run("return document.documentElement.scrollWidth") <= PHONE[0]
    controls = browser.elements(f"{FIGURE} .model button, {FIGURE} .model input")
    assert len(controls) >= 6
    for control in controls:
        hit = browser.run(
            "const [control] = arguments; control.scrollIntoView({ block: 'center' });"
            "const box = control.getBoundingClientRect();"
            "const found = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);"
            "return [box.left, box.right, box.height, found === control]",
            control,
        )
        assert hit[0] >= 0.0
        assert hit[1] <= PHONE[0]
        assert hit[2] >= 16.0
        assert hit[3], control.text


def test_paper_has_the_picture_in_place_of_the_model(shown, page):
    """All pictures of the page are there, whole, and no canvas; lists are open, and each sheet tells of what it is."""
    shown.command("Emulation.setEmulatedMedia", media="print")
    try:
        assert not shown.element(f"{FIGURE} .model").is_displayed()
        assert shown.element(f"{FIGURE} .still svg").is_displayed()
        assert shown.element(f"{FIGURE} .still svg image").size["width"] > 100
        assert shown.run("return [...document.images].every((image) => image.complete && image.naturalWidth > 0)")
    finally:
        shown.command("Emulation.setEmulatedMedia", media="")
    printed = shown.pdf()
    assert printed.count(b"/Subtype /Image") >= len(shown.elements("img, svg image")) >= 1
    sheets, made = chromium.texts(printed), page.record["provenance"]
    foot = f"{made['date'][:16].replace('T', ' ')} UTC · alula {page.record['version']}"
    assert len(sheets) == chromium.sheets(printed) >= 2
    assert all(text.startswith(f"{k} / {len(sheets)}") for k, text in enumerate(sheets, 1))
    assert all(foot in text[:120] for text in sheets)
    assert made["sources"] in sheets[-1]
    rows = shown.run("return [...document.querySelectorAll('details:not([open]) tr')].map((row) => row.textContent)")
    printed = "".join(normalize("NFKC", "".join(sheets)).split())
    assert len(rows) > 5
    assert all("".join(normalize("NFKC", row).split()) in printed for row in rows)


@pytest.mark.usefixtures("browser")
def test_without_webgl_the_picture_stays(file, tmp_path):
    """And no message says that anything is wrong."""
    with chromium.chromium(tmp_path / "profile", *NO_WEBGL) as plain:
        plain.open(file)
        plain.wait("document.documentElement.dataset.turnable")
        assert plain.element(FIGURE).get_attribute("data-turnable") == "still"
        assert plain.element(f"{FIGURE} .still svg").is_displayed()
        assert plain.elements("canvas") == []
        assert plain.messages() == []
