"""The last message of each topic that the page shows, and its age; deserialized when it is looked at."""

from __future__ import annotations

import math
import time
from typing import Any

import rospy


class Latest:
    """One topic."""

    def __init__(self, topic: str, kind: type) -> None:
        self._kind, self._raw, self._read = kind, b"", b""
        self._message: Any = None
        self.received_at = -math.inf  # s, monotonic
        rospy.Subscriber(topic, rospy.AnyMsg, self._receive, queue_size=1, tcp_nodelay=True)

    def _receive(self, message: rospy.AnyMsg) -> None:
        if message._connection_header.get("type") != self._kind._type:  # type: ignore[attr-defined]  # noqa: SLF001
            return
        self._raw, self.received_at = message._buff, time.monotonic()  # noqa: SLF001 (all that AnyMsg has)

    def age(self, now: float) -> float | None:
        """s since it was received; None if none was."""
        return None if self.received_at == -math.inf else round(now - self.received_at, 2)

    @property
    def message(self) -> Any:  # noqa: ANN401 (of the topic's type)
        """The newest message, or None."""
        if self._raw is not self._read:
            self._read = self._raw
            self._message = self._kind().deserialize(self._read)
        return self._message
