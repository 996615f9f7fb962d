"""Connections that have not shown a login yet are few, and live briefly.

If there are more than MAX_PENDING of them, the oldest are closed. So connections that send slowly, or nothing, keep no
user out.
"""

from collections.abc import Sequence

from aiohttp import web

MAX_PENDING = 100
PATIENCE = 10.0
"""s"""


class PendingConnections:
    """The connections that have shown no login. It reads no clock: time is an argument, s."""

    def __init__(self) -> None:
        self._known: set[web.RequestHandler] = set()
        self._since: dict[web.RequestHandler, float] = {}

    def admit(self, connection: web.RequestHandler) -> None:
        """A connection has shown a login."""
        self._known.add(connection)

    def check(self, connections: Sequence[web.RequestHandler], now: float) -> None:
        """Closes what is too old or too much; `connections`: the present ones, the oldest first."""
        self._known.intersection_update(connections)
        self._since = {each: self._since.get(each, now) for each in connections if each not in self._known}
        for position, (each, since) in enumerate(self._since.items()):
            crowded = position < len(self._since) - MAX_PENDING
            if (crowded or now - since > PATIENCE) and each.transport is not None:
                each.transport.abort()
