"""Half an hour of one page in a browser, and ten minutes of three pages without one, of a robot that drives: neither
browser nor server grow. CONSOLE_SOAK_MINUTES=N, CONSOLE_SERVER_MINUTES=N.
"""

import os
import time

from system.console.console_support import SPEED, ConsoleTestCase
from system.system_support import wait_for

from bench.console.page import Page
from bench.console.process import cost_of

MINUTES = float(os.environ.get("CONSOLE_SOAK_MINUTES", "30"))
SERVER_MINUTES = float(os.environ.get("CONSOLE_SERVER_MINUTES", "10"))
SETTLED = 1.5
"""min, after which the plots are full and the server has loaded all that it needs"""
GROWTH, SERVER_GROWTH = 1.0, 5.0
"""MiB"""
REDRAW = 10.0
"""ms, median"""


class ConsoleSoakTest(ConsoleTestCase):
    def memory(self) -> float:
        """MiB of the server."""
        return cost_of(self.console.process.pid)[1] / 2**20

    def test_browser_and_server_do_not_grow(self) -> None:
        browser = self.browser()
        browser.open(self.address)
        browser.command(SPEED)
        began, first, server = time.monotonic(), 0.0, 0.0
        while time.monotonic() - began < 60 * MINUTES:
            browser.key("KeyA")
            time.sleep(10.0)
            browser.key("KeyA", "keyUp")
            wait_for("a free stick", lambda: browser.text("dead-man") == "")
            time.sleep(0.5)
            if not first and time.monotonic() - began > 60 * SETTLED:
                first, server = browser.heap(), self.memory()
        grown, server_now = browser.heap() - first, self.memory()
        redraw = float(browser.data("redraw"))
        print(
            f"after {MINUTES:g} min: heap {first:.2f} MiB, grown by {grown:.2f}; server {server_now:.1f} MiB,", end=" "
        )
        print(f"grown by {server_now - server:.1f}; a redraw takes {redraw:.1f} ms")
        self.assertLessEqual(grown, GROWTH)
        self.assertLessEqual(server_now - server, SERVER_GROWTH)
        self.assertLessEqual(redraw, REDRAW)
        self.assertEqual(browser.problems(), [])

    def test_the_server_does_not_grow_with_three_pages(self) -> None:
        _, cookie = self.console.log_in()
        pages = [Page(self.console.origin, self.console.origin, cookie) for _ in range(3)]
        pages[0].send({"type": "take", "force": True})
        pages[0].await_link()
        pages[0].linear = SPEED
        began, used = time.monotonic(), cost_of(self.console.process.pid)[0]
        figures: list[float] = []  # MiB
        while time.monotonic() - began < 60 * SERVER_MINUTES:
            pages[0].held = not pages[0].held
            time.sleep(30.0)
            figures.append(self.memory())
        elapsed, cost = time.monotonic() - began, cost_of(self.console.process.pid)[0] - used
        settled = figures[len(figures) // 8]
        print(f"after {SERVER_MINUTES:g} min with three pages: {figures[-1]:.1f} MiB, grown by", end=" ")
        print(f"{figures[-1] - settled:.1f} since an eighth of it; {100 * cost / elapsed:.1f} % of a core")
        for page in pages:
            page.end()
        self.assertLessEqual(figures[-1] - settled, SERVER_GROWTH)
