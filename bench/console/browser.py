"""Chromium without a screen, with software rendering, driven by Selenium; all of them Debian's."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import re
import signal
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robot_control.drive.pad_law import SETTLING

from bench.console.process import wait_for

CHROMIUM = "/usr/bin/chromium"
SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-dev-shm-usage",
    "--no-first-run",
)
NEEDED = (
    ("browser", ("selenium",), ("bin/chromedriver", "bin/chromium")),
    ("console", ("aiohttp",), ("share/javascript/three/build/three.module.js",)),
)
"""Sections of scripts/shell/dependencies.txt with their modules, and files below /usr."""


def missing() -> str:
    """A sentence about what is not installed, with the remedy; empty if all is there."""
    for section, modules, files in NEEDED:
        if not all(map(importlib.util.find_spec, modules)) or not all(Path("/usr", name).exists() for name in files):
            return f"without a {section}: scripts/setup --{section}"
    return ""


class Browser:
    """One browser with one page."""

    def __init__(self, width: int = 1300, height: int = 900) -> None:
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        self._profile = tempfile.TemporaryDirectory(prefix="console-browser-", ignore_cleanup_errors=True)
        options = webdriver.ChromeOptions()
        options.binary_location = self._modest() if os.geteuid() == 0 else CHROMIUM
        for switch in (*SWITCHES, f"--user-data-dir={self._profile.name}", f"--window-size={width},{height}"):
            options.add_argument(switch)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self._service = Service("/usr/bin/chromedriver")
        self.driver = webdriver.Chrome(service=self._service, options=options)
        self.driver.set_script_timeout(60)
        self.screen(width, height)

    def _modest(self) -> str:
        """The browser of root, as nice as this process: with the right to raise its priority it disturbs others."""
        path = Path(self._profile.name, "chromium")
        path.write_text(f'#!/bin/sh\nexec nice -n {os.nice(0)} setpriv --bounding-set=-sys_nice {CHROMIUM} "$@"\n')
        path.chmod(0o700)
        return str(path)

    def screen(self, width: int, height: int, *, dark: bool = False) -> None:
        """Sets the size [px] and the colours of the screen; a narrow one is a phone's."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 700}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})

    def open(self, address: str) -> None:
        """Opens the console and waits until its first frames have come."""
        self.driver.get(address)
        wait_for("frames of the robot", lambda: int(self.data("frames") or 0) > 3)

    def load(self, address: str) -> float:
        """Opens the console; s until it shows the state and the model of the robot."""
        began = time.monotonic()
        self.driver.get(address)
        wait_for("a state and a model", lambda: self.data("state") and self.data("model"))
        return time.monotonic() - began

    def new_tab(self, *, show: bool = True) -> None:
        """Opens another tab, which hides this one. `show`: what follows is asked of the new one."""
        first = self.driver.current_window_handle
        self.driver.switch_to.new_window("tab")
        if not show:
            self.driver.switch_to.window(first)

    def first_tab(self) -> None:
        """Ends all tabs but the first."""
        first, *others = self.driver.window_handles
        for other in others:
            self.driver.switch_to.window(other)
            self.driver.close()
        self.driver.switch_to.window(first)

    def pad(self, *, plugged: bool = True, pressed: bool = False) -> None:
        """A stub of a game pad, forward with all its buttons pressed."""
        self.run(
            "const [plugged, pressed] = arguments, buttons = Array.from({length: 8}, () => ({pressed}));"
            "const pad = {connected: true, axes: [0, pressed ? -1 : 0, 0, 0], buttons};"
            "navigator.getGamepads = () => plugged ? [pad] : [];",
            plugged,
            pressed,
        )

    def heap(self) -> float:
        """MiB that scripts use, after a collection."""
        self.driver.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
        return float(self.driver.execute_cdp_cmd("Runtime.getHeapUsage", {})["usedSize"]) / 2**20

    def rest(self) -> None:
        """Hides the 3-D view, whose software rendering takes the processors from everything else."""
        self.run("document.getElementById('view').hidden = true")

    def run(self, script: str, *arguments: object) -> Any:  # noqa: ANN401 (JSON)
        """The result of a script of the test."""
        return self.driver.execute_script(script, *arguments)

    def data(self, name: str) -> str:
        """A value that the page states about itself."""
        value = self.run("return document.body?.dataset[arguments[0]]", name)
        return "" if value is None else str(value)

    def text(self, element: str) -> str:
        """The text of an element, by id."""
        return str(self.run("return document.getElementById(arguments[0])?.textContent ?? ''", element))

    def number(self, element: str) -> float:
        """The number that an element shows, by id; NaN for the dash of a value that is not there."""
        return float(self.text(element).replace("–", "nan"))

    def click(self, element: str) -> None:
        """Clicks on an element, by id."""
        self.run("document.getElementById(arguments[0]).click()", element)

    def tab(self, name: str) -> None:
        """Opens a part of the console: drive, map, plots, logs or setup."""
        self.run("document.querySelector(`#tabs [data-tab=${arguments[0]}]`).click()", name)

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """The pixel of a place in odom, m."""
        script = "const [x, y, done] = arguments; import('/scene.js').then((m) => done(m.toScreen(x, y)))"
        across, down = self.driver.execute_async_script(script, x, y)
        return float(across), float(down)

    def key(self, code: str, kind: str = "keyDown") -> None:
        """A real key of the browser: keyDown or keyUp."""
        self.driver.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": kind, "code": code, "key": code[-1].lower()})

    def hold(self, code: str, what: str, condition: Callable[[], object]) -> None:
        """Holds a key until the condition holds; presses it again, as operators do, where the page does not drive.

        A page that stood still has released its keys; after a silent link it has to see a release.
        """

        def held() -> object:
            if not self.text("dead-man").startswith("drives"):
                self.key(code, "keyUp")
                time.sleep(2 * SETTLING)
                self.key(code)
                time.sleep(SETTLING)
            return condition()

        wait_for(what, held)

    def touch(self, kind: str) -> None:
        """A finger on the upper edge of the stick: touchStart, touchEnd or touchCancel."""
        points = []
        if kind == "touchStart":
            self.run("document.getElementById('pad').scrollIntoView({block: 'center'})")
            x, y = self.run(
                "const b = document.getElementById('pad').getBoundingClientRect(); return [b.x + b.width / 2, b.y + 8]"
            )
            points = [{"x": x, "y": y}]
        self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def command(self, speed: float = 0.5) -> None:
        """Takes the command, and waits until the link allows the speed."""
        wait_for("a page that knows its state", lambda: self.data("state"))
        self.click("take")
        wait_for("the command", lambda: self.data("commands") == "true")
        wait_for("a link that is fast enough", lambda: self.allowed() >= speed)

    def allowed(self) -> float:
        """m/s that the link allows."""
        found = re.search(r"allows ([0-9.]+) m/s", self.text("link"))
        return float(found[1]) if found else 0.0

    def problems(self) -> list[str]:
        """Errors and violations of the policy in the browser's console since the last call."""
        log = self.driver.get_log("browser")
        return [each["message"] for each in log if each["level"] == "SEVERE" or "Content Security" in each["message"]]

    def picture(self, path: Path) -> None:
        """A picture of the window."""
        self.driver.save_screenshot(str(path))

    def processes(self) -> list[int]:
        """Chromium's, without its driver."""
        parents = {int(path.name): _parent(path) for path in Path("/proc").iterdir() if path.name.isdecimal()}
        found = {pid for pid, parent in parents.items() if parent == self._service.process.pid}
        while more := {pid for pid, parent in parents.items() if parent in found} - found:
            found |= more
        return sorted(found)

    def freeze(self) -> None:
        """The page stands still, as a browser does with one in the background."""
        self.driver.execute_cdp_cmd("Page.setWebLifecycleState", {"state": "frozen"})

    def signals(self) -> Callable[[signal.Signals], None]:
        """Sends a signal to all of its present processes."""
        pids = self.processes()

        def send(number: signal.Signals) -> None:
            for pid in pids:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, number)

        return send

    def end(self) -> None:
        """Ends the browser, dead or alive."""
        with contextlib.suppress(Exception):
            self.signals()(signal.SIGCONT)
        with contextlib.suppress(Exception):
            self.driver.quit()
        self._profile.cleanup()


def _parent(process: Path) -> int:
    try:
        return int((process / "stat").read_text().rpartition(")")[2].split()[1])
    except (OSError, IndexError, ValueError):
        return 0
