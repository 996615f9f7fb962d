"""Half an hour of one page that shows a robot which drives: neither browser nor server grow. CONSOLE_SOAK_MINUTES=N."""

import os
import time

from system.console.console_support import SPEED, ConsoleTestCase
from system.system_support import wait_for

from bench.console.process import cost_of

MINUTES = float(os.environ.get("CONSOLE_SOAK_MINUTES", "30"))
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
