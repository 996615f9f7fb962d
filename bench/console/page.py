"""A page without a browser: it answers pings and holds a key, as the real one does."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
import time
from typing import Any

from aiohttp import ClientError, ClientSession

from bench.console.process import wait_for

PERIOD = 0.05
"""s between two messages while it commands"""


class Page:
    """One page, in a thread of its own."""

    def __init__(self, address: str, origin: str, cookie: str) -> None:
        """`address`: http://HOST:PORT, perhaps of a proxy; `origin`: what it says it is."""
        self.held, self.linear = False, 0.0
        self.sends = True
        self.sent_at = 0.0  # s, monotonic: the last message that was handed to the connection while held
        self.last: dict[str, dict[str, Any]] = {}  # the newest message of each type
        self._going_on = True
        self._outbox: list[dict[str, Any]] = []
        self._thread = threading.Thread(target=lambda: asyncio.run(self._run(address, origin, cookie)), daemon=True)
        self._thread.start()

    def send(self, message: dict[str, Any]) -> None:
        """Sends a message at the next occasion."""
        self._outbox.append(message)

    @property
    def link(self) -> dict[str, Any]:
        """The server's figures of the link."""
        found: dict[str, Any] = self.last.get("authority", {}).get("link", {})
        return found

    def await_link(self) -> None:
        """Waits until the server knows its link."""
        wait_for("a page with a link", lambda: self.link)

    def end(self) -> None:
        """Closes it."""
        self._going_on = False
        self._thread.join(5)

    async def _run(self, address: str, origin: str, cookie: str) -> None:
        headers = {"Origin": origin, "Cookie": cookie, "Host": origin.split("://")[1]}
        with contextlib.suppress(ClientError, ConnectionError, asyncio.TimeoutError):
            async with ClientSession() as session, session.ws_connect(f"{address}/ws", headers=headers) as page:
                sending = asyncio.create_task(self._send(page))
                try:
                    async for message in page:
                        data = json.loads(message.data)
                        if data["type"] == "ping":
                            await page.send_json({"type": "pong", "name": data["name"]})
                        self.last[data["type"]] = data
                        if not self._going_on:
                            break
                finally:
                    sending.cancel()

    async def _send(self, page: Any) -> None:  # noqa: ANN401 (aiohttp's)
        number = 0
        while True:
            while self._outbox:
                await page.send_json(self._outbox.pop(0))
            authority = self.last.get("authority", {})
            if self.sends and authority.get("commander") == authority.get("you") and authority:
                number += 1
                now, held = time.monotonic(), self.held
                drive = {
                    "number": number,
                    "sent": now,
                    "held": held,
                    "linear": self.linear if held else 0.0,
                    "angular": 0.0,
                    "lateral": 0.0,
                }
                self.sent_at = now if held else self.sent_at
                await page.send_json({"type": "drive", **drive})
            await asyncio.sleep(PERIOD)
