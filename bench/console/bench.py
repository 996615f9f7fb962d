"""`scripts/bench console`: latency of a key, speed and ways on a bad link, cost of the server."""

from __future__ import annotations

import itertools
import statistics
import time
from typing import Any

import numpy as np
from robot_control import ClosedLoop
from robot_control.data.run_log import read_log
from robot_control.watch.console.settings import Settings

from bench.console.browser import Browser
from bench.console.page import Page
from bench.console.process import Console, cost_of, wait_for
from bench.console.proxy import Proxy
from bench.console.robot import Robot
from bench.rows import Result, Say, compared

PRESSED = """
addEventListener("keydown", (event) => { window.at = Date.now() - (performance.now() - event.timeStamp); }, true);
"""
"""Notes the time of day, ms, at which the browser made the event; performance.timeOrigin may have drifted from it."""
PRESSES = 50
DELAYS = ((0.0, 0.0), (0.01, 0.0), (0.05, 0.02), (0.1, 0.05), (0.2, 0.0), (0.4, 0.0), (0.1, 0.2))
"""s each way, and jitter"""
LOSSES = 7
"""of each kind and delay: 7 · 7 cuts and as many stalls of up to 5 s"""
COST_SECONDS, PICTURES_SECONDS, PAINTS = 60.0, 20.0, 5
EMPTY = "data:text/html,<!doctype html><title>empty</title><p>empty"
PAINT = "return performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? 0"
WIRE = """
return ["navigation", "resource"]
  .flatMap((kind) => performance.getEntriesByType(kind)).map((each) => each.transferSize);
"""
"""Bytes of each answer with its headers; the first load finds nothing in the browser's memory"""
BOUNDS = {
    "page usable": 3.0,
    "page and libraries on the wire": 400.0,
    "first paint": 3.0,
    "between two pictures of the scene": 1000 / 15,
    "server, one page": 6.0,
    "key to torque, median": 60.0,
    "key to torque, worst": 120.0,
    "speed cap beside its law, worst": 10.0,
    "way beyond the promise, worst": 0.0,
    "server, three pages": 10.0,
    "server, memory": 120.0,
    "server, memory, growth": 5.0,
    "p99 of the chain": 1.2,
}


def bench(share: float, say: Say) -> Result:
    """All figures; `share` of the presses, losses and seconds."""
    robot = Robot()
    proxy = Proxy()
    console = Console(proxied=proxy.port)
    proxy.target = console.port
    try:
        found: dict[str, tuple[float, str]] = {}
        say("key presses in the browser")
        usable, presses = _presses(console, robot, max(3, round(PRESSES * share)))
        found["page usable"] = usable, "s"
        say("size, first paint, pictures of the scene")
        found |= _page(console, robot, PAINTS, PICTURES_SECONDS * share)
        say("bad links")
        found |= _links(console, proxy, robot, max(1, round(LOSSES * share)), say)
        say("cost")
        window, figures = _cost(console, COST_SECONDS * share)
        found |= figures
    except AssertionError:
        say(console.output + console.journal[-2000:])
        raise
    finally:
        console.end()
        proxy.end()
        bag = robot.end()
    log = read_log(bag)
    found |= _latency(log, presses) | _chain(log, window)
    robot.remove()
    rows = [
        compared(name, value, unit, BOUNDS.get(name, 0.0), "what is promised") for name, (value, unit) in found.items()
    ]
    return {"bench": "console", "rows": rows}, all(
        row["value"] <= row["reference"] for row in rows if row["name"] in BOUNDS
    )


def _page(console: Console, robot: Robot, paints: int, seconds: float) -> dict[str, tuple[float, str]]:
    browser = Browser()
    try:
        browser.load(console.address)
        size = sum(browser.run(WIRE))
        paint = {}
        for name, address in (("console", console.origin), ("empty", EMPTY)):
            times = []
            for _ in range(paints):
                browser.driver.get(address)
                wait_for("a paint", lambda: browser.run(PAINT))
                times.append(float(browser.run(PAINT)))
            paint[name] = statistics.median(times)
        browser.load(console.address)
        time.sleep(3.0)
        with robot.on_a_circle():  # a robot that stands needs no pictures
            used = cost_of(console.process.pid)[0]
            before, began = int(browser.data("pictures") or 0), time.monotonic()
            time.sleep(seconds)
            pictures, elapsed = int(browser.data("pictures") or 0) - before, time.monotonic() - began
        server = cost_of(console.process.pid)[0] - used
        return {
            "page and libraries on the wire": (size / 1000, "kB"),
            "first paint": (paint["console"] / paint["empty"], f"times the {paint['empty']:.0f} ms of an empty page"),
            "between two pictures of the scene": (
                1000 * elapsed / max(1, pictures),
                "ms, 1300 x 900, drawn in software",
            ),
            "server, one page": (100 * server / elapsed, "% of a core"),
        }
    finally:
        browser.end()


def _presses(console: Console, robot: Robot, count: int) -> tuple[float, list[int]]:
    """s until the page is usable; ns on the clock of the log, of each press by the browser's own event."""
    browser = Browser()
    try:
        usable = browser.load(console.address)
        browser.rest()
        browser.command()
        browser.run(PRESSED)
        times: list[int] = []
        while len(times) < count:
            wait_for("a free stick", lambda: browser.text("dead-man") == "")
            robot.await_rest()
            browser.key("KeyW")
            time.sleep(0.25)
            browser.key("KeyW", "keyUp")
            offset = time.monotonic_ns() - time.time_ns()
            times.append(int(1e6 * browser.run("return window.at")) + offset)
        return usable, times
    finally:
        browser.end()


def _latency(log: Any, presses: list[int]) -> dict[str, tuple[float, str]]:  # noqa: ANN401 (of run_log)
    torque = (log["requested_linear"] > 0) & (np.abs(log["left_wheel_joint_effort_command"]) > 0.01)
    stamps = _clock(log)[torque]
    delays = sorted(1e-6 * float(stamps[stamps > at][0] - at) for at in presses)
    return {
        "key to torque, median": (statistics.median(delays), "ms"),
        "key to torque, worst": (delays[-1], f"ms of {len(delays)}"),
    }


def _clock(log: Any) -> Any:  # noqa: ANN401 (of run_log)
    """Monotonic ns of each cycle; on a busy machine a simulated plant lets time slip."""
    return log["stamp_ns"] + log["slipped_ns"]


def _links(console: Console, proxy: Proxy, robot: Robot, losses: int, say: Say) -> dict[str, tuple[float, str]]:
    loop, beside, beyond, count, refused = ClosedLoop(), [], [], 0, 0
    _, cookie = console.log_in()
    for delay, jitter in DELAYS:
        proxy.delay, proxy.jitter, page = delay, jitter, None
        for number in range(2 * losses):
            if page is None:
                page = Page(f"http://127.0.0.1:{proxy.port}", f"http://127.0.0.1:{proxy.port}", cookie)
                page.send({"type": "take", "force": True})
                page.send({"type": "speeds", "linear": 2.0, "angular": 1.0, "lateral": 0.3})
                page.await_link()
                time.sleep(14.0 if number == 0 else 6.0)  # 100 pings take 10 s
            if number == 0:
                round_trip = max(page.link["p95"], 2 * delay)  # the second one is the proxy's own
                law = Settings().distance / (round_trip + Settings().reaction)
                beside.append(100 * abs(page.link["cap"] / law - 1))
            page.held, page.linear = True, 1.0
            time.sleep(2.5)
            if robot.speed < 0.05:
                refused += 1  # the link is so bad that gaps end every motion
            if number % 2:
                page.sends = False
                proxy.stalled = True
                lost = page.sent_at
                time.sleep(min(5.0, 0.4 * (number + 1)))
                proxy.stalled = False
            else:
                lost = page.sent_at
                proxy.cut()
            robot.await_rest()
            way, speed = robot.at(lost)
            beyond.append(robot.moves[-1][1] - way - Settings().distance - loop.stop_distance(max(speed, 0.0)))
            count += 1
            page.held, page.sends = False, True
            if not number % 2:
                page.end()
                page = None
            else:
                time.sleep(1.0)
        if page is not None:
            page.end()
        say(f"  {1000 * delay:.0f} ms each way, jitter {1000 * jitter:.0f} ms: cap {beside[-1]:.1f} % beside its law")
    proxy.delay = proxy.jitter = 0.0
    return {
        "speed cap beside its law, worst": (max(beside), "%"),
        "way beyond the promise, worst": (max(beyond), f"m of {count} cuts and stalls; below zero: kept"),
        "drives that a bad link refused": (float(refused), f"of {count}"),
    }


def _cost(console: Console, seconds: float) -> tuple[tuple[int, int, int], dict[str, tuple[float, str]]]:
    """Times on the clock of the log: without pages from, with pages from, until."""
    _, cookie = console.log_in()
    quiet = time.monotonic_ns()
    time.sleep(seconds / 2)
    pages = [Page(console.origin, console.origin, cookie) for _ in range(3)]
    pages[0].send({"type": "take", "force": True})
    time.sleep(3.0)
    busy, (before, memory) = time.monotonic_ns(), cost_of(console.process.pid)
    time.sleep(seconds)
    after, grown = cost_of(console.process.pid)
    window = (quiet, busy, time.monotonic_ns())
    used = (after - before) / (1e-9 * (window[2] - busy))
    for page in pages:
        page.end()
    return window, {
        "server, three pages": (100 * used, "% of a core"),
        "server, memory": (grown / 2**20, "MiB"),
        "server, memory, growth": ((grown - memory) / 2**20, f"MiB in {seconds:.0f} s"),
    }


def _chain(log: Any, window: tuple[int, int, int]) -> dict[str, tuple[float, str]]:  # noqa: ANN401 (of run_log)
    chain, stamps = log["command_published_ns"], _clock(log)
    parts = [chain[(stamps > a) & (stamps < b) & ~np.isnan(chain)] for a, b in itertools.pairwise(window)]
    without, with_pages = (float(np.percentile(part, 99)) for part in parts)
    return {"p99 of the chain": (with_pages / without, f"times the {1e-3 * without:.0f} us without pages")}
