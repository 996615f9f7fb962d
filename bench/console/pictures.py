"""The pictures and the film of docs/console.md, made of the programs as they are: scripts/pictures console."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import rosgraph
import rospy
from robot_control.ui.child import Child, children

from bench.console.browser import Browser
from bench.console.process import Console, wait_for
from bench.gif import write_gif

SIZE, FILM_SIZE = (1300, 900), (720, 498)
"""px of the window, and of the film"""
RATE, LENGTH, COLOURS = 5, 10.0, 96
"""pictures per second of the film, its length, s, and its colours"""
PHONE = (390, 844)
CLEAR = 1.5
"""s after which the page shows what was done"""


@contextmanager
def page_of(folder: Path, *launched: str) -> Iterator[Browser]:
    """The console of a robot, in a browser, with control."""
    with children() as started:
        started.append(Child(["roslaunch", "robot_control", *launched], folder / "launch.log"))
        wait_for("a master", rosgraph.is_master_online)
        rospy.wait_for_service("e_stop_reset", 60.0)
        console, browser = Console(), Browser(*SIZE)
        try:
            browser.load(console.address)
            browser.click("hints-close")
            browser.command(0.3)
            yield browser
        finally:
            browser.end()
            console.end()
    wait_for("the end of the master", lambda: not rosgraph.is_master_online())


def film(browser: Browser, folder: Path) -> None:
    """Pictures of ten seconds, faster than it happens: the robot drives a curve, is stopped, and is reset."""
    acts = {2: ("key", "KeyQ"), 26: ("click", "e-stop"), 36: ("click", "reset"), 43: ("click", "confirm-reset")}
    for number in range(round(RATE * LENGTH)):
        if number in acts:
            kind, name = acts[number]
            getattr(browser, kind)(name)
        browser.picture(folder / f"film_{number:03}.png")
        time.sleep(0.5 / RATE)
    browser.key("KeyQ", "keyUp")


def main(out: Path, folder: Path) -> int:
    """Writes them all; the exit code."""

    def keep(browser: Browser, name: str) -> None:
        time.sleep(CLEAR)
        browser.picture(out / f"console_{name}.png")

    with page_of(folder, "sim.launch") as browser:
        film(browser, folder)
        write_gif(out / "console.gif", [(folder / "film_%03d.png", RATE)], RATE, FILM_SIZE, COLOURS)
        browser.hold("KeyW", "motion", lambda: browser.data("look") == "moving")
        browser.screen(*PHONE, dark=True)
        keep(browser, "phone")
        browser.key("KeyW", "keyUp")
        browser.screen(*SIZE)
        browser.tab("plots")
        keep(browser, "plots")
        browser.tab("drive")
        browser.click("e-stop")
        wait_for("what happened", lambda: browser.data("why") == "stop")
        browser.screen(*SIZE, dark=True)
        keep(browser, "stopped")
    with page_of(folder, "sim.launch", "robot:=quadbot") as browser:
        browser.click("stand")
        wait_for("standing", lambda: browser.text("posture") == "standing")
        browser.hold("KeyW", "walking", lambda: browser.text("posture").startswith("walking"))
        keep(browser, "legs")
        browser.key("KeyW", "keyUp")
    with page_of(folder, "navigation.launch", "scene:=room", "unknown_is_free:=true") as browser:
        wait_for("a map", lambda: browser.data("map"))
        browser.tab("map")
        keep(browser, "navigation")
    return 0
