"""Pages of the console without a browser: requests, WebSockets, and one that drives."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
import urllib.error
import urllib.request
from collections.abc import AsyncIterator
from typing import Any

from bench.console.process import Console

PERIOD = 0.05
"""s between two messages of a page that commands"""
TRIES = 5


class NoRedirect(urllib.request.HTTPRedirectHandler):
    def redirect_request(self, *_: Any) -> None:
        return None


def answer(
    console: Console, path: str, body: object = None, cookie: str = "", **headers: str
) -> tuple[int, dict[str, Any], str]:
    """Status, JSON and new cookie of a request of a page; `body`: of a POST."""
    data = None if body is None else json.dumps(body).encode()
    given = {"Origin": console.origin, "Content-Type": "application/json", "Cookie": cookie, **headers}
    request = urllib.request.Request(console.origin + path, data, given)
    try:
        with urllib.request.build_opener(NoRedirect).open(request, timeout=10) as found:
            text, new = found.read().decode(), found.headers.get("Set-Cookie") or ""
            return int(found.status), json.loads(text) if text.startswith("{") else {}, new.split(";")[0]
    except urllib.error.HTTPError as error:
        return int(error.code), {}, ""


@contextlib.asynccontextmanager
async def socket_of(console: Console, cookie: str) -> AsyncIterator[Any]:
    """A WebSocket of a page."""
    from aiohttp import ClientSession

    given = {"Origin": console.origin, "Cookie": cookie}
    address = f"{console.origin}/ws"
    async with ClientSession() as session, session.ws_connect(address, headers=given, max_msg_size=0) as page:
        yield page


class DrivingPage:
    """A page that answers pings, and sends its state as the page of a browser does."""

    def __init__(self, page: Any) -> None:
        self._page, self._number = page, 0
        self.newest: dict[str, dict[str, Any]] = {}
        self.said: list[str] = []
        self.held = False
        self.ended = 0
        """code with which it was closed"""
        self.tasks = [asyncio.create_task(self._read()), asyncio.create_task(self._send())]

    async def _read(self) -> None:
        async for received in self._page:
            message = json.loads(received.data)
            self.newest[message["type"]] = message
            if message["type"] == "ping":
                await self._page.send_json({"type": "pong", "name": message["name"]})
            elif message["type"] == "said":
                self.said.append(message["text"])
        self.ended = self._page.close_code or -1

    async def _send(self) -> None:
        while not self._page.closed:
            self._number += 1
            drive = {"type": "drive", "number": self._number, "sent": time.monotonic(), "held": self.held}
            await self._page.send_json({**drive, "linear": float(self.held), "angular": 0.0, "lateral": 0.0})
            await asyncio.sleep(PERIOD)

    async def take(self, speed: float) -> None:
        """Takes the command, at this speed, m/s."""
        await self._page.send_json({"type": "take", "force": True})
        await self._page.send_json({"type": "speeds", "linear": speed, "angular": 1.0, "lateral": 0.0})

    async def drive(self, speed: float) -> None:
        """Holds until it drives. A machine that stalls lets go of it; then everything is released and held again."""
        for _ in range(TRIES):
            self.held = False
            await until("a page that may drive", lambda: self.ready)
            self.held = True
            with contextlib.suppress(AssertionError):
                return await until("motion", lambda: self.speed > 0.8 * speed, limit=5.0)
        raise AssertionError(f"it does not drive: {self.authority}; {self.said}; {self.newest.get('slow')}")

    @property
    def speed(self) -> float:
        """m/s, measured."""
        return float(self.newest["fast"].get("measured", [0.0])[0]) if "fast" in self.newest else 0.0

    @property
    def authority(self) -> dict[str, Any]:
        """The newest state of this page."""
        return self.newest.get("authority", {})

    @property
    def ready(self) -> bool:
        """True if it commands over a link that allows some speed, and everything was released."""
        state = self.authority
        return (
            bool(state) and state["commander"] == state["you"] and state["link"]["cap"] > 0.3 and not state["dead_man"]
        )


@contextlib.asynccontextmanager
async def driving_page(console: Console, cookie: str, speed: float) -> AsyncIterator[DrivingPage]:
    """A page that drives at this speed, m/s."""
    async with socket_of(console, cookie) as socket:
        page = DrivingPage(socket)
        try:
            await page.take(speed)
            await page.drive(speed)
            yield page
        finally:
            for task in page.tasks:
                task.cancel()


async def until(what: str, condition: Any, limit: float = 30.0) -> None:
    """Polls until the condition holds; AssertionError names `what`."""
    end = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < end, f"not within {limit:g} s: {what}"
        await asyncio.sleep(0.02)
