"""The last message of each topic that the page shows, and its age.

rospy has one type for each topic of a process, that of its first subscriber. So a message arrives as bytes, which are
deserialized when it is read, unless another part of this process subscribes with the topic's type.
"""

from __future__ import annotations

import math
import time
from typing import Any

import rospy


class Latest:
    """One topic."""

    def __init__(self, topic: str, kind: type) -> None:
        self._kind, self._newest = kind, None
        self.received_at = -math.inf  # s, monotonic
        rospy.Subscriber(topic, rospy.AnyMsg, self._receive, queue_size=1, tcp_nodelay=True)

    def _receive(self, message: Any) -> None:  # noqa: ANN401 (AnyMsg, or the topic's type)
        raw = isinstance(message, rospy.AnyMsg)
        if not raw or message._connection_header["type"] == self._kind._type:  # type: ignore[attr-defined]  # noqa: SLF001
            self._newest, self.received_at = message, time.monotonic()

    def age(self, now: float) -> float | None:
        """s since it was received; None if none was."""
        return None if self.received_at == -math.inf else round(now - self.received_at, 2)

    @property
    def message(self) -> Any:  # noqa: ANN401 (of the topic's type)
        """The newest message, or None."""
        newest = self._newest
        if isinstance(newest, rospy.AnyMsg):
            newest = self._kind().deserialize(newest._buff)  # noqa: SLF001 (all that AnyMsg has)
            self._newest = newest
        return newest
