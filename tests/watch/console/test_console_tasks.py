"""Each task of an operator takes two presses at most, counted in the browser."""

from __future__ import annotations

import time

import pytest
from robot_control.drive.keys.operator import ZEROS, Limits
from robot_control.robot.command import Command

from bench.console.browser import Browser, missing
from bench.console.process import wait_for

if missing():
    pytest.skip(missing(), allow_module_level=True)

MOST = 2
"""presses of a task"""
SIZES = {"desktop": (1300, 900), "phone": (390, 844), "phone_turned": (844, 390)}
MIDDLE = """
const b = document.querySelector(arguments[0]).getBoundingClientRect();
const [x, y] = [b.x + b.width / 2, b.y + b.height / 2], at = document.elementFromPoint(x, y);
return document.querySelector(arguments[0]).contains(at) ? [x, y] : null;
"""


class Person:
    """Presses with the pointer what can be seen; every press counts."""

    def __init__(self, browser: Browser) -> None:
        self.browser, self.presses = browser, 0

    def pointer(self, kind: str, x: float, y: float) -> None:
        event = {
            "type": kind,
            "x": x,
            "y": y,
            "button": "left",
            "buttons": int(kind != "mouseReleased"),
            "clickCount": 1,
        }
        self.browser.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def place(self, selector: str) -> tuple[float, float]:
        """The middle of an element that nothing covers."""
        wait_for(selector, lambda: self.browser.run(MIDDLE, selector))
        x, y = self.browser.run(MIDDLE, selector)
        return float(x), float(y)

    def press(self, selector: str, to: tuple[float, float] = (0.0, 0.0), hold: float = 0.0) -> None:
        """Presses it, drags so far, holds so long, and releases."""
        self.presses += 1
        x, y = self.place(selector)
        self.pointer("mousePressed", x, y)
        if hold or any(to):
            self.pointer("mouseMoved", x + to[0], y + to[1])
            time.sleep(hold)
        self.pointer("mouseReleased", x + to[0], y + to[1])

    def done(self, what: str) -> None:
        """The task is done; the next one begins with none."""
        print(f"{what}: {self.presses} presses")
        assert self.presses <= MOST, what
        self.presses = 0


def drives(person, browser, robot):
    """Holds the stick forward for a second: the server receives it. A page that a busy machine delays lets go, so that
    the press is repeated; it counts once.
    """
    dead_man = robot.authority.commander.dead_man
    dead_man.pad.permit(True)

    def holds():
        time.sleep(0.6)  # the release is seen
        shares = []
        x, y = person.place("#pad")
        person.pointer("mousePressed", x, y)
        person.pointer("mouseMoved", x, y - 60)
        for _ in range(20):
            time.sleep(0.05)
            shares.append(dead_man.share(time.monotonic()))
        person.pointer("mouseReleased", x, y - 60)
        wait_for("the release", lambda: browser.data("held") == "false")
        return any(share.linear > 0.5 for share in shares if share)

    person.presses += 1
    wait_for("a stick that drives", holds)


def sets_a_goal(person, browser, robot):
    """Presses on the map and drags to the heading, which is upwards as the robot looks."""
    x, y = browser.pixel(0.6, 0.2)
    person.presses += 1
    person.pointer("mousePressed", x, y)
    person.pointer("mouseMoved", x, y - 40)
    person.pointer("mouseReleased", x, y - 40)
    wait_for("a goal", lambda: robot.made[-1][0] == "goal")
    goal = robot.made[-1][1]
    assert (goal["x"], goal["y"]) == pytest.approx((0.6, 0.2), abs=0.05)
    assert goal["yaw"] == pytest.approx(0.0, abs=0.2)


@pytest.mark.parametrize("size", SIZES)
def test_each_task_takes_two_presses_at_most(browser, served, size):
    robot = served.show("navigation")
    browser.screen(*SIZES[size])
    browser.driver.get(served.address)
    wait_for("a page", lambda: browser.data("model") and browser.data("map"))
    browser.click("hints-close")
    browser.run("document.querySelector('[data-tab=drive]').click()")
    person = Person(browser)
    browser.rest()  # a busy machine that draws in software lets go of the stick

    person.press("#take-here")
    wait_for("control", lambda: robot.authority.commander is not None)
    person.done("take control")

    drives(person, browser, robot)
    person.done("drive")

    person.press("#e-stop")
    wait_for("the stop", lambda: ("e_stop", {}) in robot.made)
    person.done("stop")

    wait_for("what happened", lambda: browser.text("why-title") == "A wheel is faster than allowed")
    person.place("#why-title")
    assert "17.3 rad/s" in browser.text("evidence")
    person.done("find out why")

    robot.authority.give_back(robot.authority.commander, time.monotonic())
    time.sleep(0.6)
    person.press("#reset")
    wait_for(
        "its second step",
        lambda: browser.run("return Boolean(document.querySelector('#confirm-reset:enabled')?.offsetParent)"),
    )
    later = time.monotonic() + 2.0 * ZEROS
    assert robot.authority.command(Limits(1.0, 1.0, 1.0), later)[0] == Command(), "zeros are evidence for the reset"
    person.press("#confirm-reset")
    wait_for("the reset", lambda: ("reset", {}) in robot.made)
    person.done("reset, control included")

    wait_for("a robot that may drive", lambda: browser.data("look") == "moving")
    robot.state = "navigation"
    browser.run("document.getElementById('view').hidden = false")
    wait_for("a button", lambda: browser.run("return Boolean(document.querySelector('#go-here')?.offsetParent)"))
    person.press("#go-here")
    wait_for("a map to press on", lambda: "drawing" in browser.run("return document.getElementById('view').className"))
    time.sleep(0.5)
    sets_a_goal(person, browser, robot)
    person.done("set a goal")
