#!/usr/bin/python3
"""Every way to let go of the robot, really done in a browser; once each, with --nightly 20 times."""

import contextlib
import os
import signal
import time
from collections.abc import Callable
from functools import partial

import rospy
import rostest
from geometry_msgs.msg import TwistStamped
from system_support import RobotTestCase, again_after_a_stall, wait_for

from bench.console.browser import Browser, missing
from bench.console.process import Console
from bench.console.proxy import Proxy

LET_GO = 0.25
"""s from an event of the page to the first command of zero"""
TIMEOUT = 1.25
"""s, cmd_vel_timeout, where the server itself is gone"""
SPEED = 0.3
"""m/s; its ramp is short"""
QUIET = 0.6
"""s in which nothing may move while something is still held"""
TRIALS = 20 if os.environ.get("ROBOT_CONTROL_NIGHTLY") else 1
PAD = """
window.fake = {connected: true, axes: [0, 0, 0, 0], buttons: Array.from({length: 8}, () => ({pressed: false}))};
navigator.getGamepads = () => window.fake ? [window.fake] : [];
"""
NOTED = """
for (const kind of ["keyup", "blur", "pointercancel", "visibilitychange"]) {
  addEventListener(kind, () => { window.noticed = Date.now() / 1000; }, true);
}
"""
"""The page's own time of an event; Selenium delivers it later than it was asked to."""
Event = Callable[[], object]


class ConsoleReleaseTest(RobotTestCase):
    def setUp(self) -> None:
        if missing():
            self.skipTest(missing())
        self.robot.await_ready()
        self.robot.await_rest()
        self.moved_at = 0.0
        subscriber = rospy.Subscriber("cmd_vel_stamped", TwistStamped, self._receive, tcp_nodelay=True)
        self.addCleanup(subscriber.unregister)
        self.proxy = Proxy()
        self.addCleanup(self.proxy.end)
        self.console = Console(proxied=self.proxy.port)
        self.addCleanup(self.console.end)
        self.proxy.target = self.console.port

    def _receive(self, message: TwistStamped) -> None:
        if message.twist.linear.x or message.twist.angular.z:
            self.moved_at = time.time()

    def browser(self, *, direct: bool = True) -> Browser:
        browser = Browser(900, 700)
        self.addCleanup(browser.end)
        browser.open(self.console.address if direct else self.console.through(self.proxy.port))
        browser.rest()
        return browser

    def commanded(self) -> bool:
        """True if motion is commanded now; it is sent every 50 ms."""
        return time.time() - self.moved_at < 0.08

    def drive(self, browser: Browser, press: Event | None = None, release: Event | None = None) -> None:
        """Drives at SPEED. A page that stood still for 300 ms on a busy machine has let go, and presses again."""
        browser.run(
            f"const f = document.getElementById('linear'); f.value = {SPEED}; f.dispatchEvent(new Event('change'))"
        )
        for _ in range(5):
            wait_for("a free stick", lambda: browser.text("hold") == "")
            (press or partial(browser.key, "KeyW"))()
            with contextlib.suppress(AssertionError):
                wait_for("motion", lambda: self.robot.speed > 0.8 * SPEED and self.commanded(), limit=4.0)
                return
            (release or partial(browser.key, "KeyW", "keyUp"))()
            time.sleep(0.5)
        raise AssertionError(f"it does not drive: {browser.text('hold')}; {browser.text('messages')}")

    def lets_go(self, what: str, event: Event, still_held: Event | None = None, noticed: Browser | None = None) -> None:
        """Within LET_GO of the event the command is zero, and nothing moves again while something is held. `noticed`:
        by this page, whose own time of the event counts.
        """
        limit, began = LET_GO, time.time()
        if noticed is not None:
            noticed.run(NOTED)
        event()
        wait_for(f"standstill after: {what}", self.robot.rests)
        began = began if noticed is None else noticed.run("return window.noticed")
        took = max(0.0, self.moved_at - began)
        print(f"{what}: zero {1000 * took:.0f} ms after it began")
        self.assertLessEqual(took, limit, what)
        (still_held or (lambda: None))()
        time.sleep(QUIET)
        self.assertLessEqual(self.moved_at - began, limit, f"{what}: it moved again")

    @again_after_a_stall
    def test_whatever_the_page_notices_is_zero_at_once(self) -> None:
        browser = self.browser()
        browser.command(SPEED)
        up = lambda: browser.key("KeyW", "keyUp")  # noqa: E731
        repeat = lambda: browser.driver.execute_cdp_cmd(  # noqa: E731
            "Input.dispatchKeyEvent", {"type": "keyDown", "code": "KeyW", "key": "w", "autoRepeat": True}
        )
        for _ in range(TRIALS):
            self.drive(browser)
            self.lets_go("release of the key", up, noticed=browser)
            self.drive(browser)
            self.lets_go("lost focus", lambda: browser.run("dispatchEvent(new Event('blur'))"), repeat, noticed=browser)
            up()
            self.drive(browser, partial(browser.touch, "touchStart"), partial(browser.touch, "touchEnd"))
            self.lets_go("lost finger", lambda: browser.touch("touchCancel"), noticed=browser)
            self.drive(browser)
            self.hide(browser)
            up()
            browser.run(PAD)
            time.sleep(0.2)
            pressed = "fake.axes[1] = -1; fake.buttons[4].pressed = "
            self.drive(browser, partial(browser.run, pressed + "true"), partial(browser.run, pressed + "false"))
            self.lets_go(
                "unplugged pad (a stub)",
                lambda: browser.run("window.was = fake; window.fake = null"),
                still_held=lambda: browser.run("window.fake = was"),
            )
            browser.run("delete navigator.getGamepads; window.fake = null")

    def hide(self, browser: Browser) -> None:
        """Another tab hides the page."""
        driver = browser.driver
        first = driver.current_window_handle

        def hide() -> None:
            driver.switch_to.new_window("tab")
            driver.switch_to.window(first)

        self.lets_go("hidden tab", hide, noticed=browser)
        others = [each for each in driver.window_handles if each != first]
        driver.switch_to.window(others[0])
        driver.close()
        driver.switch_to.window(first)

    @again_after_a_stall
    def test_a_page_that_falls_silent_is_zero_and_has_to_release(self) -> None:
        browser = self.browser(direct=False)
        browser.command(SPEED)
        for _ in range(TRIALS):
            self.drive(browser)
            signals = browser.signals()
            self.lets_go("stopped browser", partial(signals, signal.SIGSTOP), partial(signals, signal.SIGCONT))
            browser.key("KeyW", "keyUp")
            self.await_link(browser)
            self.drive(browser)
            self.lets_go("stalled link", self.stall, still_held=self.flow)
            browser.key("KeyW", "keyUp")
            self.await_link(browser)
            self.drive(browser)
            self.lets_go("cut link", self.proxy.cut)
            browser.key("KeyW", "keyUp")
            self.await_link(browser)
            self.drive(browser)
            self.lets_go("frozen page", browser.freeze)
            browser.driver.switch_to.new_window("tab")  # one that was frozen stays hidden in a browser without a screen
            browser.open(self.console.through(self.proxy.port))
            browser.rest()
            self.await_link(browser)
            self.drive(browser)
            self.lets_go("reloaded page", browser.driver.refresh)
            self.await_link(browser)

    def await_link(self, browser: Browser) -> None:
        wait_for("frames again", lambda: browser.data("link") == "open" and browser.data("state"))
        if browser.data("commands") != "true":
            browser.command(SPEED)
        wait_for("a link that is fast enough", lambda: browser.allowed() >= SPEED)

    def stall(self) -> None:
        self.proxy.stalled = True

    def flow(self) -> None:
        self.proxy.stalled = False

    @again_after_a_stall
    def test_the_end_of_the_browser_or_of_the_server_is_the_end_of_the_motion(self) -> None:
        for _ in range(TRIALS):
            browser = self.browser()
            browser.command(SPEED)
            self.drive(browser)
            self.lets_go("closed page", browser.driver.close)
            browser.end()
            browser = self.browser()
            browser.command(SPEED)
            self.drive(browser)
            self.lets_go("killed browser", partial(browser.signals(), signal.SIGKILL))
            browser.end()
            browser = self.browser()
            browser.command(SPEED)
            self.drive(browser)
            server = self.console.process.send_signal
            self.lets_go("stopped server", partial(server, signal.SIGSTOP), partial(server, signal.SIGCONT))
            browser.key("KeyW", "keyUp")
            self.await_link(browser)
            self.drive(browser)
            self.lets_go(
                "killed server, started again with the key held", self.console.kill, still_held=self.console.start
            )
            browser.end()


if __name__ == "__main__":
    rostest.rosrun("robot_control", "console_release", ConsoleReleaseTest)
