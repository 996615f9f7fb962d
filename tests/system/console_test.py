#!/usr/bin/python3
"""The console in a real browser, on a screen and on a phone: no error, and no violation of its policy.

CONSOLE_PICTURES=FOLDER keeps the pictures of docs/console.md, to be looked at.
"""

import os
import time
from pathlib import Path

import rostest
from system_support import RobotTestCase, again_after_a_stall, wait_for

from bench.console.browser import Browser, missing
from bench.console.process import Console


class ConsoleTest(RobotTestCase):
    def setUp(self) -> None:
        if missing():
            self.skipTest(missing())
        self.robot.await_ready()
        self.robot.await_rest()
        self.console = Console()
        self.addCleanup(self.console.end)

    def picture(self, browser: Browser, name: str) -> None:
        folder = os.environ.get("CONSOLE_PICTURES")
        if folder:
            time.sleep(1.0)
            browser.picture(Path(folder, f"console_{name}.png"))

    @again_after_a_stall
    def test_page_and_phone_show_the_robot_stop_and_reset_and_break_no_policy(self) -> None:
        browser = Browser()
        self.addCleanup(browser.end)
        began = time.monotonic()
        browser.open(self.console.address)
        wait_for("a state", lambda: browser.data("state") == "READY")
        wait_for("the model", lambda: browser.data("model") == "diffbot")
        print(f"usable after {time.monotonic() - began:.2f} s")
        browser.command()
        browser.key("KeyW")
        wait_for("motion", lambda: browser.data("verdict") == "moving" and self.robot.speed > 0.4)
        self.picture(browser, "desktop")
        browser.click("e-stop")
        wait_for("the stop", lambda: browser.data("state") == "STOPPED")
        wait_for("its cause", lambda: "e_stop_trigger" in browser.text("causes") or browser.text("causes"))
        self.picture(browser, "stopped")
        browser.key("KeyW", "keyUp")
        wait_for("standstill", self.robot.rests)
        browser.click("reset")
        wait_for("the second step", lambda: not browser.run("return document.getElementById('confirm').hidden"))
        time.sleep(0.6)
        browser.click("confirm-reset")
        wait_for("the end of the stop", lambda: browser.data("state") in ("READY", "DRIVE"))
        browser.run("document.querySelectorAll('details').forEach((each) => { each.open = true; })")
        browser.run("document.getElementById('plots').scrollIntoView()")
        self.picture(browser, "plots")
        browser.screen(400, 850, dark=True)
        browser.run("document.querySelectorAll('details').forEach((each) => { each.open = false; }); scrollTo(0, 0)")
        self.picture(browser, "phone")
        self.assertLessEqual(browser.run("return document.documentElement.scrollWidth"), 400)
        self.assertEqual(browser.problems(), [])
        browser.screen(1300, 900)
        self.console.kill()
        wait_for("the banner", lambda: "No connection" in browser.text("banner"))
        browser.run("scrollTo(0, 0)")
        self.picture(browser, "disconnected")


if __name__ == "__main__":
    rostest.rosrun("robot_control", "console", ConsoleTest)
