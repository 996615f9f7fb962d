"""The page at every size, in both schemes and in every state of a robot: nothing covered, nothing cut, all readable."""

from __future__ import annotations

import math
import os
import time
from pathlib import Path

import pytest
from matplotlib.image import imread
from page_states import STATES

from bench.console.browser import missing
from bench.console.process import wait_for

if missing():
    pytest.skip(missing(), allow_module_level=True)

AXE = Path(__file__).parents[3] / "build/browser"
SIZES = {
    "smallest": (320, 568),
    "phone": (390, 844),
    "phone_turned": (844, 390),
    "tablet": (820, 1180),
    "tablet_turned": (1180, 820),
    "desktop": (1300, 900),
    "large": (2560, 1440),
}
SHOWN = (*STATES, "disconnected")
DAILY = (
    ("wheels", "desktop", False),
    ("legs", "phone", True),
    ("stopped", "phone_turned", False),
    ("navigation", "tablet", True),
    ("no_robot", "smallest", False),
    ("disconnected", "large", True),
)
ALL = [(state, size, dark) for state in SHOWN for size in SIZES for dark in (False, True)]
PARTS = (
    "#bar, #e-stop, #tabs, #notes > *, #why, #help, #side > *, #mini, #look, #hint, #go-here, #pad, #pad-turn, #sheet"
)
FAULTS = """
const parts = [...document.querySelectorAll(arguments[0])], found = [];
const clip = (element) => {
  let { left, top, right, bottom } = element.getBoundingClientRect();
  for (let up = element.parentElement; up; up = up.parentElement) {
    if (!/auto|scroll|hidden/.test(getComputedStyle(up).overflow) || up === document.body) continue;
    const box = up.getBoundingClientRect();
    left = Math.max(left, box.left); top = Math.max(top, box.top);
    right = Math.min(right, box.right); bottom = Math.min(bottom, box.bottom);
  }
  return right > left + 2 && bottom > top + 2 ? { left, top, right, bottom } : null;
};
const name = (element) => element.id || `${element.tagName} ${element.textContent.trim().slice(0, 30)}`;
const root = document.documentElement;
if (root.scrollWidth > innerWidth) found.push(`the page is ${root.scrollWidth} px wide on ${innerWidth}`);
if (root.scrollHeight > innerHeight) found.push(`the page is ${root.scrollHeight} px high on ${innerHeight}`);
const shown = parts.map((part) => [part, clip(part)]).filter(([, box]) => box);
for (const [part, box] of shown) {
  const out = Math.min(box.left, box.top, innerWidth - box.right, innerHeight - box.bottom);
  if (out < -0.5) found.push(`${name(part)} is ${-out} px outside`);
  const [its, has] = [part.scrollWidth, part.clientWidth];
  if (has && its > has + 1) found.push(`${name(part)} is cut: ${its} px in ${has}`);
  for (const [other, its] of shown) {
    const wide = Math.min(box.right, its.right) - Math.max(box.left, its.left);
    const high = Math.min(box.bottom, its.bottom) - Math.max(box.top, its.top);
    if (part !== other && !part.contains(other) && !other.contains(part) && wide > 1 && high > 1) {
      found.push(`${name(part)} and ${name(other)} overlap by ${wide.toFixed()} x ${high.toFixed()} px`);
    }
  }
}
for (const element of document.querySelectorAll("button, select, input, textarea, a, summary")) {
  const box = element.offsetParent || element.id === "e-stop" ? clip(element) : null;
  if (!box || box.right - box.left < 8 || box.bottom - box.top < 8) continue;
  const at = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
  const free = !at || at === element || element.contains(at) || at.contains(element);
  if (!free) found.push(`${name(element)} is covered by ${name(at)}`);
}
return [...new Set(found)];
"""


def open_page(browser, served, state, size="desktop", *, dark=False, control=True):
    """The page with this robot, after its first values, with control."""
    served.stalled = False
    robot = served.show("wheels" if state == "disconnected" else state)
    browser.screen(*SIZES[size], dark=dark)
    browser.driver.get(served.address)
    wait_for("frames", lambda: int(browser.data("frames") or 0) > 2 and browser.data("look") not in {"", "off"})
    if state != "no_robot":
        wait_for("the model", lambda: browser.data("model"))
    browser.click("hints-close")
    browser.run("document.querySelector('[data-tab=drive]').click()")
    if control:
        browser.click("take")
        wait_for("control", lambda: browser.data("commands") == "true")
    if state in {"stopped", "no_robot"}:
        wait_for("what happened", lambda: not browser.run("return document.getElementById('why').hidden"))
    if state == "disconnected":
        served.stalled = True
        wait_for("the banner", lambda: "No connection" in browser.text("banner"))
    time.sleep(0.3)
    return robot


def axe(browser):
    """The violations that axe-core finds: rule, elements, and what it measured."""
    source = next(AXE.rglob("axe.min.js"), None)
    if source is None:
        pytest.skip("axe-core is not installed: scripts/setup --browser")
    browser.run(source.read_text())
    result = browser.driver.execute_async_script("axe.run(document).then(arguments[0])")
    return [
        (each["id"], [(node["target"], (node["any"] or [{}])[0].get("message", "")) for node in each["nodes"]][:4])
        for each in result["violations"]
    ]


@pytest.mark.parametrize(
    ("state", "size", "dark"),
    [pytest.param(*each, marks=[] if each in DAILY else [pytest.mark.nightly]) for each in ALL],
)
def test_nothing_is_cut_covered_or_unreadable(browser, served, state, size, dark):
    open_page(browser, served, state, size, dark=dark)
    picture = os.environ.get("CONSOLE_PICTURES")
    if picture:
        time.sleep(0.7)
        browser.picture(Path(picture, f"{state}_{size}{'_dark' if dark else ''}.png"))
    assert browser.run(FAULTS, PARTS) == []
    stop = browser.run("return document.getElementById('e-stop').getBoundingClientRect().toJSON()")
    assert stop["width"] >= 44
    assert stop["height"] >= 44
    if state not in {"stopped", "no_robot"}:
        width = browser.run("const b = document.getElementById('pad').getBoundingClientRect(); return b.width")
        assert width >= 100, "a stick is there without scrolling"
    if state not in {"stopped", "no_robot"}:
        for button in ("sentence", "help-open", "mini"):
            browser.click(button)
            time.sleep(0.3)
            assert browser.run(FAULTS, PARTS) == [], button
            browser.run("document.body.dataset.options = ''; document.getElementById('help').hidden = true")
        browser.click("why-close")
    for tab in ("map", "plots", "logs", "setup"):
        browser.run("document.querySelector(`#tabs [data-tab=${arguments[0]}]`).click()", tab)
        assert browser.run(FAULTS, PARTS) == [], tab
        assert browser.run("return document.getElementById('e-stop').getBoundingClientRect().width") >= 44
    browser.run("document.querySelector('[data-tab=drive]').click()")
    assert axe(browser) == []


def test_after_every_change_of_its_size_the_page_is_as_wide_as_the_window(browser, served):
    open_page(browser, served, "legs")
    for width, height in [(2560, 1440), (1180, 820), (820, 1180), (390, 844), (844, 390), (320, 568), (1300, 900)]:
        browser.screen(width, height)
        time.sleep(0.3)
        assert browser.run("return [document.documentElement.scrollWidth, innerWidth]") == [width, width]


def lowest(browser):
    """m above the ground of the lowest vertex that is drawn."""
    return browser.driver.execute_async_script("import('/scene.js').then((m) => arguments[0](m.lowest()))")


@pytest.mark.parametrize(
    ("knee", "roll", "pitch"),
    [(-1.5, 0.0, 0.0), (-2.6, 0.0, 0.0), (-1.2, 0.1, -0.15), (-1.5, 1.6, 0.2), (-2.0, 3.1, 0.0)],
)
def test_the_robot_touches_the_ground_standing_lying_and_fallen(browser, served, knee, roll, pitch):
    robot = open_page(browser, served, "legs", control=False)
    robot.pose = (1.0, -0.5, 0.7, roll, pitch, 0.4)
    robot.joints = {f"{foot}_knee_joint": knee for foot in ("front_left", "front_right", "rear_left", "rear_right")}
    time.sleep(0.4)
    assert abs(lowest(browser)) < 0.01


def seen(browser, plot):
    """Key, style, newest value and number of known values of each signal of a plot."""
    script = "const [name, done] = arguments; import('/plots.js').then((m) => done(m.seen(name)))"
    return browser.driver.execute_async_script(script, plot)


def test_what_is_silent_is_a_gap_in_numbers_and_plots(browser, served):
    robot = open_page(browser, served, "wheels")
    wait_for("a number", lambda: browser.text("measured-v") == "0.49")
    robot.silent = {"measured", "driven", "asked"}
    wait_for("a dash", lambda: browser.text("measured-v") == "–")
    time.sleep(0.4)
    newest = {each["key"]: each["value"] for each in seen(browser, "speed")}
    assert newest["measured"] is None
    assert newest["asked"] is None
    assert newest["true"] == pytest.approx(0.5)
    assert all(each["value"] is None for each in seen(browser, "torque"))


def test_all_joints_of_all_legs_are_plotted_in_colours_of_their_own(browser, served):
    open_page(browser, served, "legs")
    names = browser.driver.execute_async_script("import('/plots.js').then((m) => arguments[0](m.names()))")
    torque = [name for name in names if name.startswith("torque")]
    signals = [(name, each) for name in torque for each in seen(browser, name)]
    assert len({each["key"] for _, each in signals}) == 12
    for name in torque:
        styles = [str(each["style"]) for of, each in signals if of == name]
        assert len(set(styles)) == len(styles)


def test_the_page_names_the_sender_of_what_is_asked_and_a_robot_that_stands_is_not_limited(browser, served):
    robot = open_page(browser, served, "wheels", control=False)
    wait_for("the sender", lambda: browser.text("asked-by") == "/move_base")
    assert browser.text("asked-v") == "0.50"
    robot.over = {"limits": ["the ramp"], "verdict": "idle", "headline": "Ready: no motion is requested."}
    time.sleep(2.0)
    assert browser.data("look") == "ready"
    assert browser.text("state") == "READY"


def test_a_broken_source_is_named(browser, served):
    robot = open_page(browser, served, "wheels", control=False)
    robot.over = {"broken": {"scan": 3}}
    wait_for("its name", lambda: "scan" in browser.text("banner"))


def test_no_word_is_broken_and_no_operator_reads_names_of_programs(browser, served):
    open_page(browser, served, "stopped", "desktop")
    page = browser.run("return document.body.innerText")
    for word in ("How well", "Why not", "Who commands", "Work", "loss_cycles", "rosservice", "Esc"):
        assert word not in page
    assert "A wheel is faster than allowed" in page
    assert browser.run("return getComputedStyle(document.querySelector('td')).overflowWrap") != "anywhere"


def test_the_keys_alone_reach_everything_and_esc_is_the_stop(browser, served):
    open_page(browser, served, "wheels")
    for number, tab in enumerate(("drive", "map", "plots", "logs", "setup"), 1):
        browser.run("dispatchEvent(new KeyboardEvent('keydown', {key: String(arguments[0])}))", number)
        assert browser.data("tab") == tab
    reached = browser.run(
        "return [...document.querySelectorAll('button, input, select, textarea, [tabindex]')]"
        ".filter((each) => each.offsetParent && each.tabIndex < 0 && !each.matches('#sheet')).map((each) => each.id)"
    )
    assert reached == []


def view_of(browser):
    """Heading of the view, rad; height over width of a square on the ground; pixels of a metre on the ground."""
    centre, ahead, left = (browser.pixel(x, y) for x, y in ((0.0, 0.0), (0.1, 0.0), (0.0, 0.1)))
    (ax, ay), (lx, ly) = ((10 * (x - centre[0]), 10 * (y - centre[1])) for x, y in (ahead, left))
    metre = math.sqrt(ax * ax + lx * lx)  # across the picture nothing is shortened
    return math.atan2(-lx, ax), math.sqrt(ay * ay + ly * ly) / metre, metre


def pressed(browser, key, code):
    """The view after a press of this key."""
    browser.run(
        "const [key, code] = arguments;"
        "document.body.dispatchEvent(new KeyboardEvent('keydown', {key, code, bubbles: true}))",
        key,
        code,
    )
    return view_of(browser)


def test_the_keys_turn_tilt_and_zoom_the_view_and_the_help_says_which(browser, served):
    robot = open_page(browser, served, "wheels", control=False)
    robot.pose = (0.0, 0.0, 0.1, 0.0, 0.0, 0.0)
    time.sleep(0.3)
    before = view_of(browser)
    for key, code, which, sign in (
        (",", "Comma", 0, 1),
        (".", "Period", 0, -1),
        ("PageUp", "PageUp", 1, 1),
        ("PageDown", "PageDown", 1, -1),
        ("+", "BracketRight", 2, 1),
        ("-", "Slash", 2, -1),
    ):
        after = pressed(browser, key, code)
        assert sign * (after[which] - before[which]) > 0.02 * (1 if which == 0 else before[which]), key
        before = after
    for _ in range(60):
        after = pressed(browser, "PageDown", "PageDown")
    assert after[1] > 0.0, "the view stays above the ground"
    browser.click("help-open")
    terms = browser.run("return [...document.querySelectorAll('#help dt')].map((each) => each.textContent)")
    assert {", .", "PageUp, PageDown", "+ -"} <= set(terms)


@pytest.mark.parametrize("tab", ["drive", "map"])
def test_the_stick_shows_what_the_keys_hold_while_a_goal_is_driven(browser, served, tab):
    open_page(browser, served, "navigation")
    browser.tab(tab)
    place = "const b = document.getElementById('stick').getBoundingClientRect(); return [b.x, b.y, b.width]"
    x, y, width = browser.run(place)

    def moved():
        return [(now - then) / width for now, then in zip(browser.run(place), (x, y), strict=False)]

    browser.key("KeyQ")
    wait_for("a knob to the left, ahead", lambda: max(moved()) < -0.4)
    browser.key("KeyQ", "keyUp")
    wait_for("a knob in the middle", lambda: max(map(abs, moved())) < 0.02)


def test_a_robot_that_stands_is_drawn_once(browser, served):
    robot = open_page(browser, served, "stopped", control=False)
    robot.joints = {"left_wheel_joint": 0.0, "right_wheel_joint": 0.0}

    def drawn(seconds):
        time.sleep(1.5)
        before = int(browser.data("pictures"))
        time.sleep(seconds)
        return int(browser.data("pictures")) - before

    assert drawn(2.0) == 0
    robot.pose = (0.002, 0.0, 0.1, 0.0, 0.0, 0.0)
    wait_for("a new picture", lambda: drawn(0.0) == 0)
    robot.joints = {}
    assert drawn(2.0) > 4


def test_the_one_picture_of_a_robot_that_stands_shows_its_joints_and_feet(browser, served, tmp_path):
    open_page(browser, served, "legs", control=False)
    time.sleep(1.5)
    browser.picture(tmp_path / "drawn.png")
    browser.run("import('/scene.js').then((module) => module.redraw())")
    time.sleep(0.5)
    browser.picture(tmp_path / "again.png")
    drawn, again = (imread(tmp_path / f"{name}.png")[100:700, 120:950] for name in ("drawn", "again"))
    assert abs(drawn - again).max() < 0.05


def test_esc_closes_what_is_open_on_a_robot_at_rest_and_stops_one_that_moves(browser, served):
    robot = open_page(browser, served, "wheels")
    script = (
        "window.pressed = 0; document.getElementById('e-stop').addEventListener('click', () => { ++window.pressed; })"
    )
    browser.run(script)
    escape = "document.dispatchEvent(new KeyboardEvent('keydown', {code: 'Escape', key: 'Escape', bubbles: true}))"
    browser.click("help-open")
    browser.run(escape)
    assert browser.run("return window.pressed") == 1, "it moves"
    robot.silent = {"measured"}
    time.sleep(0.3)
    browser.run(escape)
    assert browser.run("return window.pressed") == 2, "whether it moves is not known"
    robot.silent, robot.fast = set(), lambda: {"type": "fast", "ages": {}, "joints": {}, "measured": (0.0, 0.0, 0.0)}

    def closes_the_help():
        before = browser.run("return window.pressed")
        browser.click("help-open")
        browser.run(escape)
        return browser.run("return window.pressed") == before

    wait_for("a page that knows that the robot stands", closes_the_help)
    assert browser.run("return document.getElementById('help').hidden")
    del robot.fast


def test_the_labels_are_there_in_chinese(browser, served):
    open_page(browser, served, "wheels", control=False)
    browser.driver.get(f"http://127.0.0.1:{served.port}/?lang=zh")
    wait_for("Chinese", lambda: "急停" in browser.text("e-stop"))
    wait_for("the state", lambda: browser.text("state") == "运动中")
    assert "跟随" in browser.text("look")
    browser.click("help-open")
    assert "旋转视角" in browser.text("help")


def test_a_recording_without_a_map_says_how_one_is_recorded(browser, served):
    def empty():
        return browser.run("return document.getElementById('no-map').innerText")

    robot = open_page(browser, served, "wheels", control=False)
    browser.run("document.querySelector('[data-tab=map]').click()")
    wait_for("the words", lambda: "Start navigation" in empty())
    robot.over["replay"] = {"at": 1.0, "length": 5.0, "speed": 0.0, "loading": "", "marks": []}
    wait_for("the words", lambda: "record:=true" in empty())
    assert "Start navigation" not in empty()
