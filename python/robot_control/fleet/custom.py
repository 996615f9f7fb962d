"""Actions of a node or at once: those that YAML maps to a service or a topic, waitForTrigger and logReport."""

import math
import queue
import subprocess
import threading
import time

import rospy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from robot_control.data.black_box import LOGS, incidents_of
from robot_control.fleet.settings import CustomAction
from robot_control.fleet.v2.order import Action
from robot_control.fleet.v2.vehicle import FAILED, FINISHED
from robot_control.robot.topic_sender import Sender

Result = tuple[str, str, str]
RELEASE = ("sh", "-c", 'read -r _ || for topic; do timeout 10 rostopic pub -1 "$topic" std_msgs/Bool false & done', "-")
"""Waits for a line. If the pipe ends without one, the program was killed, and each topic becomes false."""
MAX_CALLS = 32
"""services that do not answer, each with a thread of its own"""


class Actions:
    """Runs them beside each other; `begin`, `end` and `results` are called by one thread."""

    def __init__(self, custom: dict[str, CustomAction]) -> None:
        self._custom = custom
        self._results: queue.SimpleQueue[Result] = queue.SimpleQueue()
        self._calls: list[threading.Thread] = []
        self._ends: dict[str, tuple[float, str]] = {}  # s, monotonic; its topic or service, empty: waitForTrigger
        self._topics = {
            each.topic: Sender(rospy.Publisher(each.topic, Bool, queue_size=1, latch=True), Bool(data=False))
            for each in custom.values()
            if each.topic
        }
        for topic in self._topics.values():
            topic.send(Bool(data=False))  # a program that was killed could not
        names = [rospy.resolve_name(name) for name in self._topics]
        self._release = subprocess.Popen([*RELEASE, *names], stdin=subprocess.PIPE, start_new_session=True)

    def close(self) -> None:
        """The program ends by itself: each `Sender` sends the last false."""
        self._release.communicate(b"ended\n")

    def begin(self, action: Action) -> None:
        """Its end comes with `results`."""
        if action.kind == "waitForTrigger":
            self._ends[action.id] = math.inf, ""
        elif action.kind == "logReport":
            found = incidents_of(LOGS)
            self._results.put((action.id, FINISHED, found[-1].name if found else "there is no incident"))
        else:
            custom = self._custom[action.kind]
            seconds = custom.seconds if custom.topic else custom.timeout
            self._ends[action.id] = time.monotonic() + seconds, custom.topic or custom.service
            if custom.topic:
                self._topics[custom.topic].send(Bool(data=True))
                return
            self._calls = [each for each in self._calls if each.is_alive()]
            if len(self._calls) >= MAX_CALLS:
                self._results.put((action.id, FAILED, f"{MAX_CALLS} services do not answer"))
                return
            self._calls.append(threading.Thread(target=self._call, args=(action.id, custom), daemon=True))
            self._calls[-1].start()

    def end(self, action_id: str) -> bool:
        """True if it was interrupted; a service that was called goes on."""
        name = self._ends.get(action_id, (0.0, ""))[1]
        if action_id not in self._ends or (name and name not in self._topics):
            return False
        del self._ends[action_id]
        if name:
            self._topics[name].send(Bool(data=False))
        return True

    def trigger(self) -> str:
        """Ends every waitForTrigger; why not, empty if there is one."""
        waiting = [action_id for action_id, (_, name) in list(self._ends.items()) if not name]
        for action_id in waiting:
            self._results.put((action_id, FINISHED, "triggered"))
        return "" if waiting else "no waitForTrigger runs"

    def results(self) -> list[Result]:
        """Those that ended since the last call."""
        ended = []
        for action_id, (end, name) in list(self._ends.items()):
            if time.monotonic() < end:
                continue
            if name in self._topics:
                self._topics[name].send(Bool(data=False))
                ended.append((action_id, FINISHED, ""))
            else:
                ended.append((action_id, FAILED, f"{name} did not answer in time"))
        while not self._results.empty():
            ended.append(self._results.get())
        for action_id, _, _ in ended:
            self._ends.pop(action_id, None)
        return ended

    def _call(self, action_id: str, custom: CustomAction) -> None:
        """In a thread of its own; an answer that comes too late changes nothing."""
        try:
            rospy.wait_for_service(custom.service, custom.timeout)
            answer = rospy.ServiceProxy(custom.service, Trigger)()
            self._results.put((action_id, FINISHED if answer.success else FAILED, answer.message))
        except (rospy.ROSException, rospy.ServiceException) as error:
            self._results.put((action_id, FAILED, str(error)))
