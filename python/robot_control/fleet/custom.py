"""Actions of a node or at once: those that YAML maps to a service or a topic, waitForTrigger and logReport."""

from __future__ import annotations

import queue
import threading
import time

import rospy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from robot_control.blackbox.main import LOGS, incidents_of
from robot_control.fleet.settings import CustomAction
from robot_control.fleet.v2.order import Action
from robot_control.fleet.v2.vehicle import FAILED, FINISHED

Result = tuple[str, str, str]


class Actions:
    """Runs them beside each other; `begin`, `end` and `results` are called by one thread."""

    def __init__(self, custom: dict[str, CustomAction]) -> None:
        self._custom = custom
        self._results: queue.SimpleQueue[Result] = queue.SimpleQueue()
        self._ends: dict[str, tuple[float, str]] = {}  # s, monotonic, at which the topic of an action becomes false
        self._waiting: list[str] = []  # waitForTrigger
        self._topics = {
            each.topic: rospy.Publisher(each.topic, Bool, queue_size=1, latch=True)
            for each in custom.values()
            if each.topic
        }

    def begin(self, action: Action) -> None:
        """Its end comes with `results`."""
        if action.kind == "waitForTrigger":
            self._waiting.append(action.id)
        elif action.kind == "logReport":
            found = incidents_of(LOGS)
            newest = found[-1].name if found else "there is no incident"
            self._results.put((action.id, FINISHED, newest))
        elif self._custom[action.kind].topic:
            custom = self._custom[action.kind]
            self._topics[custom.topic].publish(data=True)
            self._ends[action.id] = time.monotonic() + custom.seconds, custom.topic
        else:
            threading.Thread(target=self._call, args=(action.id, self._custom[action.kind]), daemon=True).start()

    def end(self, action_id: str) -> bool:
        """True if it was interrupted; a service that was called goes on."""
        if action_id in self._waiting:
            self._waiting.remove(action_id)
            return True
        if action_id in self._ends:
            self._topics[self._ends.pop(action_id)[1]].publish(data=False)
            return True
        return False

    def trigger(self) -> bool:
        """Ends every waitForTrigger; False if there is none."""
        waiting, self._waiting = self._waiting, []
        for action_id in waiting:
            self._results.put((action_id, FINISHED, "triggered"))
        return bool(waiting)

    def results(self) -> list[Result]:
        """Those that ended since the last call."""
        for action_id, (end, topic) in list(self._ends.items()):
            if time.monotonic() >= end:
                del self._ends[action_id]
                self._topics[topic].publish(data=False)
                self._results.put((action_id, FINISHED, ""))
        ended = []
        while not self._results.empty():
            ended.append(self._results.get())
        return ended

    def _call(self, action_id: str, custom: CustomAction) -> None:
        """In a thread of its own. A service that does not answer in time has FAILED."""
        done = threading.Event()

        def call() -> None:
            try:
                rospy.wait_for_service(custom.service, custom.timeout)
                answer = rospy.ServiceProxy(custom.service, Trigger)()
                status, text = FINISHED if answer.success else FAILED, answer.message
            except (rospy.ROSException, rospy.ServiceException) as error:
                status, text = FAILED, str(error)
            if not done.is_set():
                done.set()
                self._results.put((action_id, status, text))

        threading.Thread(target=call, daemon=True).start()
        if not done.wait(custom.timeout):
            done.set()
            self._results.put((action_id, FAILED, f"no answer of {custom.service} within {custom.timeout:g} s"))
