"""The e-stop and the reset as requests that never delay the keys: a thread calls, the answer is read later."""

from __future__ import annotations

import queue
import threading
import time
from dataclasses import dataclass

import rospy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

PATIENCE = 0.3
"""s for the answer of e_stop_trigger; then `true` goes out on the topic e_stop as well"""
LATEST = 5.0
"""s after which a reset that could not be called yet, behind a service that does not answer, is dropped"""
AGAIN = 0.5
"""s in which a repeated key is one request"""


@dataclass(frozen=True)
class Answer:
    """Of a service."""

    service: str
    accepted: bool
    text: str


class Services:
    """Main thread alone, but for the worker inside."""

    def __init__(self) -> None:
        self._topic = rospy.Publisher("e_stop", Bool, queue_size=1, tcp_nodelay=True)
        self._topic_said_true = False
        self._wanted: queue.Queue[tuple[str, float]] = queue.Queue()  # service, when it was asked for
        self._answers: queue.Queue[Answer] = queue.Queue()
        self._e_stop_at: float | None = None  # when it was asked for, until it is answered
        self._last_e_stop = float("-inf")
        threading.Thread(target=self._work, daemon=True).start()

    def e_stop(self) -> None:
        """By the service, which leaves no level behind that a reset would have to take back."""
        now = time.monotonic()
        if now - self._last_e_stop < AGAIN:
            return
        self._last_e_stop = now
        self._e_stop_at = now
        self._wanted.put(("e_stop_trigger", now))

    def reset(self) -> None:
        """Takes back the topic's level, if it was raised here."""
        if self._topic_said_true:
            self._topic.publish(Bool(data=False))
            self._topic_said_true = False
        self._last_e_stop = float("-inf")  # the next one is another request
        self._wanted.put(("e_stop_reset", time.monotonic()))

    def look(self) -> list[Answer]:
        """The answers that have come."""
        answers = []
        while not self._answers.empty():
            answer = self._answers.get()
            answers.append(answer)
            if answer.service == "e_stop_trigger" and answer.accepted:
                self._e_stop_at = None
            elif answer.service == "e_stop_trigger":
                self._say_on_topic()
        if self._e_stop_at is not None and time.monotonic() - self._e_stop_at > PATIENCE:
            self._say_on_topic()
        return answers

    def _say_on_topic(self) -> None:
        self._e_stop_at = None
        self._topic_said_true = True
        self._topic.publish(Bool(data=True))

    def _work(self) -> None:
        while True:
            name, asked = self._wanted.get()
            if name == "e_stop_reset" and time.monotonic() - asked > LATEST:
                self._answers.put(Answer(name, accepted=False, text="it could not be called in time; ask again"))
                continue
            try:
                response = rospy.ServiceProxy(name, Trigger)()
                self._answers.put(Answer(name, accepted=bool(response.success), text=response.message))
            except (rospy.ServiceException, OSError) as error:
                self._answers.put(Answer(name, accepted=False, text=str(error)))
