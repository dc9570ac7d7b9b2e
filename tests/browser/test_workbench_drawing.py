"""The drawing of the workbench, as hands use it: mouse, finger and keyboard; the text and the numbers follow."""

import json
import math
import re
import subprocess
import sys
from pathlib import Path

import pytest
from chromium import PHONE

from alula.reports.workbench.editing.document import Document

WIDE = (1400, 900)
PRESS = "[...document.querySelectorAll('button')].find((one) => one.textContent === arguments[0]).click()"
CASE = Path(__file__).parents[2] / "loads" / "cases" / "four-bar.toml"


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """The address of a workbench with a four-bar."""
    case = tmp_path_factory.mktemp("bench") / "four-bar.toml"
    case.write_bytes(CASE.read_bytes())
    command = [sys.executable, "-m", "alula", "open", str(case), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            yield re.search(r"http://\S+", server.stdout.readline())[0]
        finally:
            server.terminate()


@pytest.fixture
def bench(browser, served):
    """The page with the four-bar as it stands in its file; the console has to be quiet at the end."""
    open_page(browser, served, WIDE)
    yield browser
    browser.driver.execute_async_script(
        "const done = arguments[arguments.length - 1];"
        "import(new URL('page/server.js', document.baseURI)).then((server) => server.change('reload')).then(done)"
    )
    assert browser.messages() == []


def open_page(browser, address, size):
    browser.open(address, size)
    browser.wait("document.querySelector('.forces .joint-force') && document.querySelector('.texts .load')")
    settle(browser)


def state(browser, expression):
    """Return what the page's store says."""
    return browser.driver.execute_async_script(
        "const done = arguments[arguments.length - 1];"
        "import(new URL('page/store.js', document.baseURI))"
        f".then(({{ store }}) => {{ const now = store.state; done({expression}); }})"
    )


def settle(browser, what="true"):
    """Wait until the drawing and its forces are of the newest text, nothing is held any more, and something is so."""
    followed = "now.drawn?.revision === now.document.revision && Object.keys(now.drawn.forces).length > 0"
    browser.wait(
        "import(new URL('page/store.js', document.baseURI))"
        f".then(({{ store: {{ state: now }} }}) => {followed} && !now.held && ({what}))"
    )


def handle(browser, label):
    return browser.element(f'.handles [aria-label^="{label}"]')


def pull(browser, label, *steps):
    from selenium.webdriver.common.action_chains import ActionChains

    chain = ActionChains(browser.driver, duration=20).click_and_hold(handle(browser, label))
    for step in steps:
        chain = chain.move_by_offset(*step)
    chain.release().perform()
    settle(browser)


def press(browser, *keys):
    from selenium.webdriver.common.action_chains import ActionChains

    ActionChains(browser.driver).send_keys(*keys).perform()


def length(browser, link):
    """Length of a link of two points, as the text says [mm]."""
    text = state(browser, "now.document.text")
    return float(re.search(rf"\[links\.{link}\].*?\[\"([1-9][\d.]*) mm\", \"0 mm\"\]", text, re.DOTALL)[1])


def forces(browser):
    browser.run("return new Promise(requestAnimationFrame)")
    return [one.text for one in browser.elements(".texts .joint-force")]


def test_a_pin_is_pulled_in_one_step_of_undo_and_numbers_follow(bench):
    from selenium.webdriver.common.action_chains import ActionChains

    before = forces(bench)
    pull(bench, "Joint A", (20, -10), (20, -10), (10, -10))
    x, y = state(bench, "now.drawn.joints.find((joint) => joint.name === 'A').at")
    step = state(bench, "10 ** Math.floor(Math.log10(6 / now.view.scale))")
    assert (x, y) == pytest.approx((round(x / step) * step, round(y / step) * step), abs=1e-6)  # a round place
    assert length(bench, "crank") == pytest.approx((x**2 + y**2) ** 0.5, abs=1e-6)
    assert length(bench, "crank") > 45.0
    assert forces(bench) != before
    ActionChains(bench.driver).key_down("\ue009").send_keys("z").key_up("\ue009").perform()  # Control and Z
    settle(bench, "!now.document.undo")
    assert length(bench, "crank") == 40.0


def test_a_length_is_typed(bench):
    from selenium.webdriver.common.action_chains import ActionChains

    ActionChains(bench.driver).double_click(handle(bench, "Joint A")).perform()
    field = bench.element('.entry [aria-label="crank O2–A in mm"]')
    assert field.get_attribute("value") == "40"
    field.clear()
    field.send_keys("45\n")
    settle(bench, "now.document.undo")
    assert length(bench, "crank") == 45.0
    assert bench.elements(".entry") == []


def test_a_number_is_typed_right_after_a_pull(bench):
    """Its sign and its first nought are no keys of the view, whose scale stays."""
    scale = state(bench, "now.view.scale")
    for typed in ("-10", "0"):
        pull(bench, "Joint A", (10, -10))
        press(bench, *typed, "\ue007")
        settle(bench, f"Math.abs(now.drawn.joints.find((joint) => joint.name === 'A').at[0] - ({typed})) < 1e-6")
    assert state(bench, "now.view.scale") == scale


def test_escape_takes_back_what_a_pull_has_changed(bench):
    from selenium.webdriver.common.action_chains import ActionChains

    pull(bench, "Joint A", (30, -20))
    before = state(bench, "now.document.text")
    ActionChains(bench.driver, duration=20).click_and_hold(handle(bench, "Joint A")).move_by_offset(40, 0).perform()
    pulled = f"now.document.text !== {json.dumps(before)}"
    bench.wait(f"import(document.baseURI + 'page/store.js').then(({{ store: {{ state: now }} }}) => {pulled})")
    press(bench, "\ue00c")
    ActionChains(bench.driver).release().perform()
    settle(bench, f"now.document.text === {json.dumps(before)}")


def test_the_width_of_a_link_is_typed_where_it_is_drawn(bench):
    """The part of the link has it, and the form says that other links have that part; the bar above stays as it is."""
    from selenium.webdriver.common.action_chains import ActionChains

    places = "return JSON.stringify([...document.querySelectorAll('header button')].map((one) => one.offsetLeft))"
    before = bench.run(places)
    ActionChains(bench.driver).double_click(bench.element('.bodies [aria-label^="Link rocker"]')).perform()
    field = bench.element('.entry [aria-label="width of bar (2 more links) in mm"]')
    assert field.get_attribute("value") == "8"
    field.clear()
    field.send_keys("9\n")
    settle(bench, "now.document.undo")
    assert state(bench, "now.document.tables.parts.bar.width") == "9 mm"
    assert bench.element("#name").text.endswith("not saved")
    assert bench.run(places) == before


def test_the_whole_arrow_of_a_load_takes_a_press(bench):
    """In its middle it opens its numbers, and pulled there its tip goes as far as the pointer."""
    from selenium.webdriver.common.action_chains import ActionChains

    arrow = "now.drawn.loads.find((load) => load.kind === 'force')"
    x, y, size = state(
        bench,
        f"[now.view.left + now.view.scale * {arrow}.at[0], now.view.top - now.view.scale * {arrow}.at[1],"
        f" {arrow}.vector[1]]",
    )
    tip = bench.element('.handles [aria-label^="Load on rocker"]')
    middle = round((y + float(tip.get_attribute("cy"))) / 2 - y)
    chain = ActionChains(bench.driver, duration=20)
    sheet = bench.run("return document.querySelector('#sheet').getBoundingClientRect().toJSON()")
    chain.w3c_actions.pointer_action.move_to_location(round(sheet["x"] + x), round(sheet["y"] + y + middle))
    chain.double_click().perform()
    assert bench.element(".entry strong").text == "Load on rocker"
    press(bench, "\ue00c")
    chain.click_and_hold().move_by_offset(0, 30).release().perform()
    settle(bench, "now.document.undo")
    longer = state(bench, f"{arrow}.vector[1]")
    assert longer / size == pytest.approx(1.0 + 30.0 / (2.0 * middle), rel=0.1)


def test_a_link_that_is_drawn_beyond_the_sheet_is_brought_into_view_and_no_other_is(bench):
    edit = "import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))"
    x, y = state(bench, "now.drawn.joints.find((one) => one.name === 'A').at")
    bench.run("import(document.baseURI + 'page/view.js').then(({ pan }) => pan(-900, 0))")
    bench.wait("import(document.baseURI + 'page/store.js').then(({ store }) => store.state.view.left < 0)")
    away = state(bench, "now.view")
    bench.run(edit, [{"op": "move", "joint": "A", "to": [x + 1.0, y]}])
    settle(bench, f"now.drawn.joints.find((one) => one.name === 'A').at[0] > {x + 0.5}")
    assert state(bench, "now.view") == away, "what is moved does not move the view"
    bench.run(
        edit, [{"op": "link", "name": "far", "from": {"joint": "A"}, "to": {"at": [-200.0, 150.0]}, "part": "bar"}]
    )
    bench.wait(
        "import(document.baseURI + 'page/store.js').then(({ store: { state: now } }) => "
        "now.drawn.links.some((one) => one.name === 'far'))"
    )
    assert state(bench, "now.view") != away
    bench.run("return new Promise(requestAnimationFrame)")
    box = bench.run("return document.querySelector('#sheet').getBoundingClientRect().toJSON()")
    for one in bench.elements("#plane .links path"):
        rect = one.rect
        assert rect["x"] >= box["x"]
        assert rect["y"] >= box["y"]
        assert rect["x"] + rect["width"] <= box["x"] + box["width"]
        assert rect["y"] + rect["height"] <= box["y"] + box["height"]


def test_an_arrow_and_the_pose_are_pulled(bench):
    pull(bench, "Load on rocker", (30, 10))
    vector = state(bench, "now.drawn.loads.find((load) => load.kind === 'force').vector")
    assert vector[0] > 0.0 > -5.0 > vector[1]
    assert f'force = ["{vector[0]:g} N", "{vector[1]:g} N"]' in state(bench, "now.document.text")
    pull(bench, "Pose", (0, -30))
    turned = state(bench, "now.drawn.coordinate.value")
    assert turned > 42.0
    assert turned == pytest.approx(round(turned))
    assert not any(one.text.startswith("beyond") for one in bench.elements(".texts text")), "it turns fully"
    the_motion_slides(bench)
    stated = [{"op": "set", "path": ["motion"], "value": {"range": ["30 deg", "40 deg"]}}]
    bench.run("import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))", stated)
    bench.wait("[...document.querySelectorAll('.texts text')].some((one) => one.textContent.startsWith('beyond'))")


def test_the_way_of_the_pose_its_ends_and_its_dead_points_are_marked(bench):
    """Unasked, in the plane and on the slider: a full turn, then a crank that gets as far as a dead point."""
    settle(bench, "now.motion?.points")
    bench.wait("document.querySelector('.paths .reach')")
    zoom = "import(document.baseURI + 'page/view.js').then(({ zoom }) => zoom(0.5, [300, 300]))"
    bench.run(f"return {zoom}")
    assert bench.elements(".paths .dead, .paths .end") == []
    edit = "import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))"
    bench.run(edit, [{"op": "set", "path": ["links", "crank", "points", "A", 0], "value": "75 mm"}])
    bench.wait("document.querySelectorAll('.paths .end').length === 1 && document.querySelector('.track .dead line')")
    dead, value = state(bench, "now.motion.dead[0]"), state(bench, "now.drawn.coordinate.value")
    assert [one.text for one in bench.elements(".texts .reach")] == [f"dead at {dead:.0f}°", f"{value:g}°"]
    assert [one.text for one in bench.elements("#motion small")] == [f"{value:g}°", f"{dead:.0f}°"]
    marked = angle_about_the_crank(bench, bench.element(".paths .dead")) - angle_about_the_crank(
        bench, handle(bench, "Pose")
    )
    assert marked % 360.0 == pytest.approx((dead - value) % 360.0, abs=0.5)
    bench.run(edit, [{"op": "remove", "path": ["motion"]}])  # what it could move through has two dead points
    bench.wait("document.querySelectorAll('.paths .dead').length === 2")
    assert bench.elements(".paths .end") == []
    slider = [{"op": "set", "path": ["motion"], "value": {"coordinate": "rocker", "range": ["55 deg", "70 deg"]}}]
    bench.run(edit, [{"op": "set", "path": ["links", "crank", "points", "A", 0], "value": "40 mm"}, *slider])
    bench.wait("document.querySelectorAll('.paths .end').length === 2")
    settle(bench, "now.motion?.pose")
    ends = state(bench, "[now.motion.pose[0], now.motion.pose.at(-1)]")
    told = sorted(float(one.text.rstrip("°")) for one in bench.elements(".texts .reach"))
    assert told == pytest.approx(sorted(ends), abs=0.5), "of the crank, which the pose turns"


def angle_about_the_crank(browser, element):
    """Return the direction from the crank's pivot to the middle of an element [deg]."""
    middle = "const box = arguments[0].getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]"
    (x, y), (x0, y0) = (browser.run(middle, one) for one in (element, handle(browser, "Joint O2")))
    return math.degrees(math.atan2(y0 - y, x - x0))


@pytest.mark.parametrize("size", [WIDE, (1180, 720)])
def test_the_bar_stands_in_one_row(bench, served, size):
    """Also where one of two load cases is chosen there."""
    edit = "import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))"
    bench.run(edit, [{"op": "set", "path": ["load_cases", "another-one"], "value": {"own_weight": True}}])
    open_page(bench, served, size)
    bench.wait("document.querySelector('header select').checkVisibility()")
    shown = "[...document.querySelectorAll('header :is(button, input, select)')].filter((one) => one.checkVisibility())"
    middles = bench.run(
        f"return {shown}.map((one) => one.getBoundingClientRect()).map(({{ y, height }}) => y + height / 2)"
    )
    assert len(middles) > 10
    assert max(middles) - min(middles) < 3.0


def the_motion_slides(browser):
    """A press on the track, a pull and keys each show the instant at which they leave the slider."""
    from selenium.webdriver.common.action_chains import ActionChains

    settle(browser, "now.motion?.points")
    slider, last = browser.element(".track input"), state(browser, "now.motion.values.length - 1")
    quarter = (slider.size["width"] - 16) / 4  # the knob's middle stays half its width from the ends
    chain = ActionChains(browser.driver, duration=20).move_to_element_with_offset(slider, round(-quarter), 0)
    chain.click().perform()
    pressed = state(browser, "now.instant")
    assert pressed == pytest.approx(last / 4, abs=0.03 * last)
    chain = ActionChains(browser.driver, duration=20).move_to_element_with_offset(slider, round(-quarter), 0)
    chain.click_and_hold().move_by_offset(round(quarter), 0).move_by_offset(round(quarter), 0).release().perform()
    assert state(browser, "now.instant") == pytest.approx(0.75 * last, abs=0.03 * last)
    slider.send_keys("\ue010")  # End
    assert state(browser, "now.instant") == last == int(slider.get_property("value"))
    slider.send_keys("\ue012")  # arrow left
    assert state(browser, "now.instant") == last - 1
    for letter in "zy":  # undo and redo, with the slider in focus as well
        before = state(browser, "now.document.revision")
        ActionChains(browser.driver).key_down("\ue009").send_keys(letter).key_up("\ue009").perform()
        settle(browser, f"now.document.revision > {before}")
    browser.run(PRESS, "Back to the case's pose")


def test_an_instant_of_a_motion_of_another_link_becomes_the_pose(bench):
    """The motion prescribes the rocker, the pose the crank: it is turned to where it stands at that instant."""
    stated = {"coordinate": "rocker", "range": ["55 deg", "70 deg"]}
    edit = "import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))"
    bench.run(edit, [{"op": "set", "path": ["motion"], "value": stated}])
    settle(bench, "now.motion?.pose")
    bench.element(".track input").send_keys("\ue010")  # End
    crank = state(bench, "now.motion.angles.crank.at(-1)")
    bench.run(PRESS, "Use this pose")
    settle(bench, f"now.instant === null && Math.abs(now.drawn.coordinate.value - {crank}) < 1e-3")
    assert bench.element("#motion output").text.startswith("70°")


def test_a_load_line_is_dashed_and_its_levers_are_dotted(bench):
    line = {"from": ["150 mm", "200 mm", "10 mm"], "to": ["90 mm", "120 mm", "0 mm"], "force": "10 N"}
    stated = [
        {"op": "set", "path": ["load_cases", "lift", "load_lines"], "value": [line | {"link": "rocker", "at": "P"}]}
    ]
    bench.run("import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))", stated)
    bench.wait("document.querySelector('.forces .lever')")
    settle(bench)
    dashes = [one.value_of_css_property("stroke-dasharray") for one in bench.elements(".forces :is(.line, .lever)")]
    assert dashes == ["6px, 3px", "1.5px, 3px"]


def test_a_linkage_of_twelve_links_is_pulled_without_a_halt(bench):
    """Five four-bars, one on the other: no task of the page holds up the hand, and the numbers follow."""
    text = "import(document.baseURI + 'page/server.js').then(({ change }) => change('text', { text: arguments[0] }))"
    bench.run(text, twelve_links())
    settle(bench, "now.drawn.links.length === 12")
    bench.run(
        "window.long = []; const told = (list) => long.push(...list.getEntries().map((one) => one.duration));"
        "new PerformanceObserver(told).observe({ type: 'longtask' })"
    )
    before = forces(bench)
    pull(bench, "Pose", *[(2, -4)] * 12)
    assert forces(bench) != before
    assert max(bench.run("return window.long"), default=0) < 500.0


def twelve_links():
    """The built-in four-bar, with four dyads more: each from the last rocker's point to a pin of the ground."""
    document = Document(CASE.read_text(encoding="utf-8"))
    end = {"link": "rocker", "point": "P"}
    for k in range(4):
        x, y = 190 + 90 * k, 130 + 4 * k
        for name, start, to in (("c", end, {"at": [x, y]}), ("r", None, {"ground": [x - 10, 5]})):
            start = start or {"link": f"c{k}", "point": last(document, f"c{k}")}
            document.apply([{"op": "link", "name": f"{name}{k}", "from": start, "to": to}], None)
        end = {"joint": joint_of(document, f"r{k}", f"c{k}")}
    return document.text


def last(document, link):
    return list(document.tables()["links"][link]["points"])[-1]


def joint_of(document, *links):
    return next(name for name, one in document.tables()["joints"].items() if set(one["links"]) == set(links))


def test_a_mistake_is_told_before_there_is_a_load(bench):
    """That loads are missing is none: the line at the bottom says what is wanted next."""
    edit = "import(document.baseURI + 'page/server.js').then(({ edit }) => edit(arguments[0]))"
    bench.run(edit, [{"op": "remove", "path": ["load_cases"]}])
    bench.wait("document.querySelector('#hint').innerText.includes('Add load')")
    bench.wait("document.querySelector('#problem').textContent.includes('load_cases')")
    assert not bench.element("#problem").is_displayed()
    bench.run(edit, [{"op": "set", "path": ["drive", "joint"], "value": "O9"}])
    bench.wait("document.querySelector('#problem').innerText.includes(\"'O9' is no joint\")")
    assert bench.element("#problem").is_displayed()


def test_the_keyboard_alone_moves_a_joint_and_adds_a_load(bench):
    left = state(bench, "now.view.left")
    for _ in range(60):
        press(bench, "\ue004")  # Tab
        if bench.driver.switch_to.active_element.get_attribute("id") == "sheet":
            break
    press(bench, "\ue014")  # arrow right, with no thing in focus: the view
    assert state(bench, "now.view.left") == left - 40
    for _ in range(60):
        press(bench, "\ue004")  # Tab
        label = bench.driver.switch_to.active_element.get_attribute("aria-label") or ""
        if label.startswith("Joint B"):
            break
    before = state(bench, "now.drawn.joints.find((joint) => joint.name === 'B').at")
    press(bench, "\ue013", "\ue013")  # arrow up
    settle(bench, "now.document.undo")
    after = state(bench, "now.drawn.joints.find((joint) => joint.name === 'B').at")
    assert after[1] > before[1]
    assert after[0] == pytest.approx(before[0], abs=1e-4)
    stated = "now.drawn.loads.filter((load) => load.kind === 'force').length"  # weights may come a moment later
    loads = state(bench, stated)
    press(bench, "f", "\ue007")  # the tool for loads, and Enter on the joint
    settle(bench, f"{stated} === {loads + 1}")
    press(bench, "\ue00c")  # Escape
    assert state(bench, "now.tool") == "select"


def test_a_finger_pulls_and_two_fingers_zoom_on_a_phone(bench, served):
    open_page(bench, served, PHONE)
    assert bench.run("return document.documentElement.scrollWidth") == PHONE[0]
    small = bench.run(
        "return [...document.querySelectorAll('.handles circle, #tools button, #tabs button, #layers .hold')]"
        ".map((one) => one.getBoundingClientRect()).filter(({ width, height }) => width < 24 || height < 24).length"
    )
    assert small == 0
    middle = "const box = arguments[0].getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]"
    x, y = bench.run(middle, handle(bench, "Joint B"))
    touch(bench, [[(x + 5 * k, y - 6 * k)] for k in range(5)])
    settle(bench, "now.document.undo")
    assert state(bench, "now.drawn.joints.find((joint) => joint.name === 'B').at[1]") > 72.0
    press(bench, "\ue00c")
    left, top, width, height = bench.run(
        "const box = document.querySelector('#sheet').getBoundingClientRect();"
        "return [box.x, box.y, box.width, box.height]"
    )
    scale, row = state(bench, "now.view.scale"), top + 0.9 * height
    touch(bench, [[(left + width * (0.4 - k), row), (left + width * (0.6 + k), row)] for k in (0.0, 0.1, 0.2)])
    assert state(bench, "now.view.scale") == pytest.approx(3.0 * scale, rel=0.05)


def touch(browser, places):
    """Put fingers down, move them from place to place, and lift them."""
    for k, fingers in enumerate(places):
        points = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(fingers)]
        browser.command("Input.dispatchTouchEvent", type="touchMove" if k else "touchStart", touchPoints=points)
    browser.command("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
