"""Requests the e-stop and the reset without delaying the keys: a thread calls, and the answer is read later.

The e-stop counts as done once the robot says so: by the answer of e_stop_trigger, or else by safety_status. Until then
it is repeated on the topic e_stop, whose connections outlive a restart of the master. An e-stop that reached no node,
or that nothing confirms, is reported as that.
"""

import queue
import threading
import time
from dataclasses import dataclass

import rospy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from robot_control.robot.diagnosis.state import Facts
from robot_control.robot.safety_watch import SafetyWatch

PATIENCE = 0.3
"""s for the answer of e_stop_trigger; then `true` goes out on the topic e_stop as well"""
CONFIRMED_WITHIN = 1.5
"""s after the first message on e_stop; safety_status comes at least once per second"""
LATEST = 5.0
"""s after which a reset that still waits behind a service without an answer is dropped"""
AGAIN = 0.5
"""s in which a repeated key is one request"""

E_STOP = "e_stop_trigger"
NO_RECEIVER = "no node receives the topic e_stop"


@dataclass(frozen=True)
class Answer:
    """Answer of a service."""

    service: str
    accepted: bool  # of the e-stop: the robot has confirmed it
    text: str


def in_words(answer: Answer, facts: Facts) -> str:
    """The answer for the screen. A reset does not take back a level of the topic e_stop that another node published,
    even after that node has ended. The level may be that of a pressed button; the text names the command to take it
    back.
    """
    if answer.service == E_STOP:
        return f"{'emergency stop confirmed' if answer.accepted else 'EMERGENCY STOP NOT CONFIRMED'}: {answer.text}"
    safety = facts.received()
    causes = () if safety is None else safety.causes
    if not answer.accepted and any(cause.name == "e_stop_topic" and cause.active for cause in causes):
        command = f"rostopic pub -1 {facts.path('e_stop')} std_msgs/Bool false"
        what = "reset REFUSED: the topic e_stop is still true; once its cause is removed"
        return f"{what}, publish false from the same node, or if it has ended: {command}, then call the reset again"
    return f"reset {'accepted' if answer.accepted else 'REFUSED'}: {answer.text}"


class Services:
    """Used by one thread; a second one, inside, makes the calls."""

    def __init__(self, watch: SafetyWatch) -> None:
        self._watch = watch
        self._topic = rospy.Publisher("e_stop", Bool, queue_size=1, tcp_nodelay=True)
        self._topic_said_true = False
        self._proxies = {name: rospy.ServiceProxy(name, Trigger) for name in (E_STOP, "e_stop_reset")}
        self._wanted: queue.Queue[tuple[str, float, int]] = queue.Queue()  # service, when it was requested, attempts
        self._answers: queue.Queue[Answer] = queue.Queue()
        self._e_stop_at: float | None = None  # when it was requested, until it is answered
        self._sent_at: float | None = None  # when that one was first sent on the topic
        self._refusal = ""  # of the service
        self._last_e_stop = float("-inf")
        threading.Thread(target=self._work, daemon=True).start()

    def e_stop(self) -> bool:
        """Calls the service: unlike the topic it leaves no level that a reset has to take back. Returns False for a
        request that repeats the last one: it has no answer of its own.
        """
        now = time.monotonic()
        if now - self._last_e_stop < AGAIN:
            return False
        self._last_e_stop = self._e_stop_at = now
        self._sent_at, self._refusal = None, ""
        self._wanted.put((E_STOP, now, 1))
        return True

    def reset(self) -> None:
        """Takes back the topic's level if it was raised here. The service may overtake the topic: a reset that is then
        refused is called once more. An emergency stop that is not answered yet stays requested, and comes first.
        """
        attempts = 1
        if self._topic_said_true:
            self._topic.publish(Bool(data=False))
            self._topic_said_true = False
            attempts = 2
        self._last_e_stop = float("-inf")  # the next one is another request
        self._wanted.put(("e_stop_reset", time.monotonic(), attempts))

    def poll(self) -> list[Answer]:
        """The answers that have arrived."""
        answers = []
        while not self._answers.empty():
            answer = self._answers.get()
            if answer.service == E_STOP and not answer.accepted:
                self._refusal = answer.text
                continue
            if answer.service == E_STOP:
                if self._e_stop_at is None:  # the topic has answered it
                    continue
                self._e_stop_at = None
            elif not answer.accepted and not self._topic_said_true:
                # A restarted safety_monitor holds the topic true for a publisher that it does not know and that is
                # silent.
                self._topic.publish(Bool(data=False))
            answers.append(answer)
        return answers + self._e_stop_on_topic(time.monotonic())

    def _e_stop_on_topic(self, now: float) -> list[Answer]:
        """Sends the e-stop that the service has not taken, again in each pass, until its answer is known."""
        if self._e_stop_at is None or not (self._refusal or now - self._e_stop_at > PATIENCE):
            return []
        self._sent_at = now if self._sent_at is None else self._sent_at
        self._topic_said_true = True
        self._topic.publish(Bool(data=True))
        state = self._watch.stopped_since(self._sent_at)
        if not state and now - self._sent_at < CONFIRMED_WITHIN:
            return []
        self._e_stop_at = None
        why = self._refusal or f"{E_STOP} does not answer"
        if state:
            return [Answer(E_STOP, accepted=True, text=f"sent on the topic e_stop ({why}); the robot is {state}")]
        receivers = self._topic.get_num_connections()
        silence = f"{receivers} nodes receive e_stop, and safety_status reports no stop" if receivers else NO_RECEIVER
        return [Answer(E_STOP, accepted=False, text=f"{why}; {silence}. Press the button on the robot")]

    def _work(self) -> None:
        while True:
            name, requested, attempts = self._wanted.get()
            if name == "e_stop_reset" and time.monotonic() - requested > LATEST:
                self._answers.put(Answer(name, accepted=False, text="no answer in time; request it again"))
                continue
            try:
                response = self._proxies[name]()
                if not response.success and attempts > 1:
                    time.sleep(PATIENCE)
                    response = self._proxies[name]()
                self._answers.put(Answer(name, accepted=bool(response.success), text=response.message))
            except (rospy.ServiceException, OSError) as error:
                self._answers.put(Answer(name, accepted=False, text=str(error)))
