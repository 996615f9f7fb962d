"""A node that sends on a topic and ends properly: its last message stops the robot before the node leaves.

    publish      queues; a thread of each connection writes later, and a node that ends closes its connections at once
    a signal     rospy shuts the node down inside the handler, while the main thread is in any call. If that is a call
                 to the master (every loginfo is one), the handler waits for that call's lock, which is never released

Hence a signal is only noted here. The main thread ends the node after the last message was written.
"""

import contextlib
import math
import signal
import threading
import time
from collections.abc import Callable, Iterator
from types import FrameType

import rospy

LIMIT = 5.0
"""s that the end of a node waits for a connection that takes nothing"""
GRACE = 0.1
"""s for roscpp's subscribers, which drop what they have not yet read when the master says that the publisher is gone"""
POLL_PERIOD = 0.005
"""s between two looks at the connections"""
NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Sender:
    """Publishes until the node is shut down, for whatever reason; the last message is then `last`."""

    def __init__(self, publisher: rospy.Publisher, last: object, said: Callable[[int], None] = lambda _: None) -> None:
        """`said` is called after the last message with the number of subscribers that were not sent it."""
        self._publisher, self._last, self._said = publisher, last, said
        self._lock = threading.Lock()
        self._over = False
        rospy.on_shutdown(self._end)  # the connections are still open there; in a `finally` they are not

    def send(self, message: object) -> None:
        """Queues it for all subscribers."""
        with self._lock:
            if not self._over:
                self._publisher.publish(message)

    def _end(self) -> None:
        with self._lock:
            self._over = True
        self._said(publish_last(self._publisher, self._last))


class Signals:
    """Notes SIGINT, SIGTERM and SIGHUP. A signal after the time of the node's end is over ends the program at once.

    A SIGHUP that is ignored stays so (nohup).
    """

    def __init__(self) -> None:
        self._came_at = math.inf
        for number in NUMBERS:
            if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, self._note)

    @property
    def came(self) -> bool:
        """True if at least one signal came."""
        return self._came_at < math.inf

    def going_on(self) -> bool:
        """True while no signal came and the node is not being shut down."""
        return not (self.came or rospy.core.is_shutdown_requested())

    def _note(self, number: int, _frame: FrameType | None) -> None:
        now = time.monotonic()
        if now - self._came_at > 2 * LIMIT:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        self._came_at = min(self._came_at, now)


@contextlib.contextmanager
def ended_by_signals() -> Iterator[Signals]:
    """Lets the node live as long as the block and then sends its last message; call it after init_node in the main
    thread.
    """
    signals = Signals()
    try:
        yield signals
    finally:
        rospy.signal_shutdown("a signal came" if signals.came else "all is done")
        for number in NUMBERS:
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, signal.SIG_DFL)


def written(publisher: rospy.Publisher) -> dict[int, int]:
    """Number of messages handed to the kernel, by open connection."""
    return {connection: messages for connection, _, messages, is_open in publisher.impl.get_stats()[2] if is_open}


def publish_last(publisher: rospy.Publisher, message: object, limit: float = LIMIT) -> int:
    """Publishes, waits until all present subscribers were sent it, and returns how many were not within `limit`
    seconds.

    The message is published twice: a connection's thread may have taken an earlier one from its queue. Then the first
    message written from now on is that one, and the second is this one.
    """
    end = time.monotonic() + limit
    before = written(publisher)
    for messages in (1, 2):
        publisher.publish(message)
        while behind := _behind(publisher, before, messages):
            if time.monotonic() > end:
                return behind
            time.sleep(POLL_PERIOD)
    if before:
        time.sleep(GRACE)
    return 0


def _behind(publisher: rospy.Publisher, before: dict[int, int], messages: int) -> int:
    """Number of connections that were open then, are still open, and have written fewer messages since."""
    now = written(publisher)
    return sum(now[connection] < count + messages for connection, count in before.items() if connection in now)
