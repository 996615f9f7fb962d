"""A robot and a console behind a proxy that all cases of a class share, and a browser for each case."""

import signal
import time
from collections.abc import Callable
from functools import partial

import rospy
from geometry_msgs.msg import TwistStamped
from system.system_support import LIMIT, RobotTestCase, again_after_a_stall, wait_for

from bench.console.browser import Browser, missing
from bench.console.process import Console
from bench.console.proxy import Proxy

LET_GO = 0.25
"""s from an event of the page to the first command of zero"""
SPEED = 0.2
"""m/s; its ramp is short, and a link that has just stalled allows it"""
QUIET = 0.5
"""s in which nothing may move while something is still held; longer than SETTLING of pad/law.py"""
SENDING = 0.08
"""s; a command is sent every 0.05 s"""
NOTED = """
for (const kind of ["keyup", "blur", "pointercancel", "visibilitychange"]) {
  addEventListener(kind, () => { window.noticed = Date.now() / 1000; }, true);
}
"""
"""The page's own time of an event; Selenium delivers it later than it was asked to."""
Event = Callable[[], object]


class ConsoleTestCase(RobotTestCase):
    """The page comes through the proxy; without a browser all cases skip with the remedy."""

    console: Console
    proxy: Proxy
    _browser: Browser | None = None

    @classmethod
    def setUpClass(cls) -> None:
        if missing():
            return
        super().setUpClass()
        cls.proxy = Proxy()
        cls.console = Console(proxied=cls.proxy.port)
        cls.proxy.target = cls.console.port

    @classmethod
    def tearDownClass(cls) -> None:
        if missing():
            return
        cls.end_browser()
        cls.console.end()
        cls.proxy.end()
        super().tearDownClass()

    @classmethod
    def end_browser(cls) -> None:
        if cls._browser is not None:
            cls._browser.end()
            cls._browser = None

    def setUp(self) -> None:
        if missing():
            self.skipTest(missing())
        self.addCleanup(self.end_browser)
        self.flow()
        self.console.revive()
        self.robot.await_ready()
        self.robot.await_rest()
        self.moved_at = 0.0
        subscriber = rospy.Subscriber("cmd_vel_stamped", TwistStamped, self._receive, tcp_nodelay=True)
        self.addCleanup(subscriber.unregister)

    def _receive(self, message: TwistStamped) -> None:
        if message.twist.linear.x or message.twist.angular.z:
            self.moved_at = time.time()

    @property
    def address(self) -> str:
        return self.console.through(self.proxy.port)

    def browser(self) -> Browser:
        """The browser of this case, which is started again after its end."""
        if self._browser is None:
            type(self)._browser = Browser()
        browser = type(self)._browser
        assert browser is not None
        return browser

    def open(self, browser: Browser) -> None:
        """The page, without its 3-D view, as commander of a link that is fast enough."""
        browser.open(self.address)
        browser.rest()
        self.await_link(browser)

    def await_link(self, browser: Browser) -> None:
        wait_for("frames", lambda: browser.data("link") == "open" and browser.data("state"))
        if browser.data("commands") != "true":
            browser.command(SPEED)
        wait_for("a link that is fast enough", lambda: browser.allowed() >= SPEED)

    def drive(self, browser: Browser, press: Event | None = None) -> None:
        """Drives at SPEED."""
        browser.run(
            f"const f = document.getElementById('linear'); f.value = {SPEED}; f.dispatchEvent(new Event('change'))"
        )
        wait_for("a free stick", lambda: browser.text("dead-man") == "")
        (press or partial(browser.key, "KeyW"))()
        self.waits_for(browser, "motion", lambda: self.robot.speed > 0.8 * SPEED and self.commanded())

    @staticmethod
    def waits_for(browser: Browser, what: str, condition: Callable[[], bool], limit: float = LIMIT) -> None:
        """As wait_for; a failure names what the page says."""
        try:
            wait_for(what, condition, limit)
        except AssertionError as error:
            raise AssertionError(f"{error}: {browser.text('dead-man')}; {browser.text('messages')}") from None

    def commanded(self) -> bool:
        """True if motion is commanded now."""
        return time.time() - self.moved_at < SENDING

    def lets_go(self, what: str, event: Event, still_held: Event | None = None, noticed: Browser | None = None) -> None:
        """Within LET_GO of the event the command is zero, and nothing moves again while something is held. `noticed`:
        by this page, whose own time of the event counts.
        """
        began = time.time()
        if noticed is not None:
            noticed.run(NOTED)
        event()
        wait_for(f"standstill after: {what}", self.robot.rests)
        began = began if noticed is None else noticed.run("return window.noticed")
        took = max(0.0, self.moved_at - began)
        print(f"{what}: zero {1000 * took:.0f} ms after it began")
        self.assertLessEqual(took, LET_GO, what)
        (still_held or (lambda: None))()
        time.sleep(QUIET)
        self.assertLessEqual(self.moved_at - began, LET_GO, f"{what}: it moved again")

    @again_after_a_stall
    def lets_go_of_what_the_page_notices(self) -> None:
        browser = self.browser()
        self.open(browser)
        up = partial(browser.key, "KeyW", "keyUp")
        repeat = partial(
            browser.driver.execute_cdp_cmd,
            "Input.dispatchKeyEvent",
            {"type": "keyDown", "code": "KeyW", "key": "w", "autoRepeat": True},
        )
        self.drive(browser)
        self.lets_go("release of the key", up, noticed=browser)
        self.drive(browser)
        self.lets_go("lost focus", lambda: browser.run("dispatchEvent(new Event('blur'))"), repeat, noticed=browser)
        up()
        self.drive(browser, partial(browser.touch, "touchStart"))
        self.lets_go("lost finger", lambda: browser.touch("touchCancel"), noticed=browser)
        self.drive(browser)
        self.lets_go("hidden tab", partial(browser.new_tab, show=False), noticed=browser)
        browser.first_tab()
        up()
        browser.pad()
        time.sleep(0.2)
        self.drive(browser, partial(browser.pad, pressed=True))
        unplug = partial(browser.pad, plugged=False)
        self.lets_go("unplugged pad (a stub)", unplug, still_held=partial(browser.pad, pressed=True))

    @again_after_a_stall
    def lets_go_when_something_falls_silent(self) -> None:
        browser = self.browser()
        self.open(browser)
        up, signals = partial(browser.key, "KeyW", "keyUp"), browser.signals()
        ways: list[tuple[str, Event, Event | None]] = [
            ("cut link", self.proxy.cut, None),
            ("stopped browser", partial(signals, signal.SIGSTOP), partial(signals, signal.SIGCONT)),
            ("stalled link", partial(setattr, self.proxy, "stalled", True), self.flow),
        ]
        server = self.console.process.send_signal
        ways.append(("stopped server", partial(server, signal.SIGSTOP), partial(server, signal.SIGCONT)))
        for what, event, still_held in ways:
            self.drive(browser)
            self.lets_go(what, event, still_held)
            up()
            self.await_link(browser)
        self.drive(browser)
        self.lets_go("reloaded page", browser.driver.refresh)
        browser.rest()
        self.await_link(browser)

    def flow(self) -> None:
        self.proxy.stalled = False

    @again_after_a_stall
    def lets_go_when_something_ends(self) -> None:
        browser = self.browser()
        self.open(browser)
        up = partial(browser.key, "KeyW", "keyUp")
        self.drive(browser)
        self.lets_go("server killed, and started again with the key held", self.console.kill, self.console.start)
        up()
        for what, event in (("frozen page", browser.freeze), ("closed page", browser.driver.close)):
            browser.new_tab()
            self.open(browser)
            self.drive(browser)
            self.lets_go(what, event)
            browser.first_tab()
        self.open(browser)
        self.drive(browser)
        self.lets_go("killed browser", partial(browser.signals(), signal.SIGKILL))
        self.end_browser()
