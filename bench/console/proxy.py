"""A TCP proxy on the loopback that makes a bad link: delay, jitter, stalls, cuts, and halves that fall silent."""

from __future__ import annotations

import contextlib
import random
import socket
import threading
import time
from collections import deque

PIECE = 65536
"""bytes"""


class Proxy:
    """Passes connections on to a port. Bytes keep their order, so jitter only delays, as TCP does."""

    def __init__(self, target: int = 0, seed: int = 1) -> None:
        self.target = target
        self.delay = self.jitter = 0.0  # s, each way
        self.stalled = False  # nothing passes until it ends
        self.sent = 0  # bytes of the clients
        self._random = random.Random(seed)  # noqa: S311 (of a link, not of a key)
        self._listening = socket.create_server(("127.0.0.1", 0))
        self._listening.settimeout(None)  # rospy sets a default of 60 s
        self.port = int(self._listening.getsockname()[1])
        self._sockets: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Resets all connections."""
        for each in self._sockets:
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
        self._sockets.clear()

    def end(self) -> None:
        """Cuts, and accepts no more."""
        self._listening.close()
        self.cut()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                inner, _ = self._listening.accept()
                try:
                    outer = socket.create_connection(("127.0.0.1", self.target))
                except OSError:
                    inner.close()
                    continue
                self._sockets += [inner, outer]
                for source, sink in ((inner, outer), (outer, inner)):
                    source.settimeout(None)
                    source.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    self._pass(source, sink, counted=source is inner)

    def _pass(self, source: socket.socket, sink: socket.socket, *, counted: bool) -> None:
        waiting: deque[tuple[float, bytes]] = deque()
        there = threading.Condition()

        def read() -> None:
            due = 0.0
            data = b"begin"
            while data:
                try:
                    data = source.recv(PIECE)
                except OSError:
                    data = b""
                self.sent += len(data) if counted else 0
                due = max(due, time.monotonic() + self.delay + self._random.uniform(0.0, self.jitter))
                with there:
                    waiting.append((due, data))
                    there.notify()

        def write() -> None:
            with contextlib.suppress(OSError):
                while True:
                    with there:
                        while not waiting:
                            there.wait()
                        due, data = waiting.popleft()
                    time.sleep(max(0.0, due - time.monotonic()))
                    while self.stalled:
                        time.sleep(0.005)
                    if not data:
                        break
                    sink.sendall(data)
            for each in (source, sink):
                with contextlib.suppress(OSError):
                    each.shutdown(socket.SHUT_RDWR)

        for each in (read, write):
            threading.Thread(target=each, daemon=True).start()
