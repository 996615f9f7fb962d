"""The listening sockets' first line: connections that have not shown a login yet are few, and live briefly.

A connection is a stranger until the application admits it. If there are MAX_STRANGERS already, the oldest is closed. So
strangers that send slowly, or nothing, keep no user out.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, cast

MAX_STRANGERS = 100
PATIENCE = 10.0
"""s"""


class Strangers:
    """The connections that have shown no login."""

    def __init__(self) -> None:
        self._timers: dict[asyncio.Transport, asyncio.TimerHandle] = {}

    def enter(self, transport: asyncio.Transport) -> None:
        """A connection is made."""
        if len(self._timers) >= MAX_STRANGERS:
            self._close(next(iter(self._timers)))
        loop = asyncio.get_running_loop()
        self._timers[transport] = loop.call_later(PATIENCE, self._close, transport)

    def admit(self, transport: asyncio.BaseTransport | None) -> None:
        """A connection has shown a login, or has ended."""
        timer = self._timers.pop(cast(asyncio.Transport, transport), None)
        if timer is not None:
            timer.cancel()

    def _close(self, transport: asyncio.Transport) -> None:
        self.admit(transport)
        transport.abort()


class Door(asyncio.Protocol):
    """Hands one connection to the HTTP server's protocol."""

    def __init__(self, strangers: Strangers, inner: Callable[[], Any]) -> None:
        self._strangers, self._inner = strangers, inner()
        self._transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """A connection was accepted; with TLS its handshake is done."""
        self._transport = cast(asyncio.Transport, transport)
        self._strangers.enter(self._transport)
        self._inner.connection_made(transport)

    def connection_lost(self, exc: Exception | None) -> None:
        """The connection has ended."""
        self._strangers.admit(self._transport)
        self._inner.connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Bytes have come."""
        self._inner.data_received(data)

    def eof_received(self) -> bool | None:
        """The other side sends no more."""
        result: bool | None = self._inner.eof_received()
        return result

    def pause_writing(self) -> None:
        """The other side reads too slowly."""
        self._inner.pause_writing()

    def resume_writing(self) -> None:
        """The other side has read."""
        self._inner.resume_writing()
