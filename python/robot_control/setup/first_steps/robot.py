"""The ROS side of first_steps.py: reports of the robot, its few motions, and its stop."""

import math
import time
from collections.abc import Callable
from statistics import mean
from typing import Any, TypeVar

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from robot_control.msg import LegState, SafetyStatus
from robot_control.robot.boundary import Latest
from robot_control.robot.pose import pose_of, rotation, rpy
from robot_control.robot.running_robot import RefusedError, await_all
from robot_control.robot.safety_states import STOPPED
from robot_control.robot.safety_watch import SafetyWatch, status_of
from robot_control.robot.services import E_STOP, Answer, Services
from robot_control.robot.topic_sender import Sender, Signals
from robot_control.setup.first_steps.checks import StepError, require
from robot_control.srv import SetGait, SetPosture

Found = TypeVar("Found")
PERIOD = 0.05
"""s between two messages of a command, and between two looks"""
SILENCE = 2.5
"""s without a message after which a topic is silent"""
ANSWER = 10.0
"""s for an answer, and for a posture"""
ARRIVAL = 0.3
"""s that a joint needs after the end of its path"""
RAMP = 1.0
"""s until a walk has its speed"""
RESET = "e_stop_reset"
RESTS = STOPPED - {"STOPPING"}
"""The states of a robot that a stop has brought to rest"""
TOPICS = {"battery_state": BatteryState, "joint_states": JointState, "leg_state": LegState, "odom": Odometry}


def speed_along(yaw: float, odometry: Odometry) -> float:
    """m/s, in the time of the robot, towards the heading `yaw`, rad; negative if the robot walks backwards."""
    v, turn = odometry.twist.twist.linear, pose_of(odometry).yaw - yaw
    return float(v.x * math.cos(turn) - v.y * math.sin(turn))


def _awaited(found: Callable[[], Found]) -> Found:
    """The first result that counts as true, also after a signal; after ANSWER s whatever it is."""
    end = time.monotonic() + ANSWER
    while not (result := found()) and time.monotonic() < end:
        time.sleep(PERIOD)
    return result


class WatchedRobot:
    """A running robot on legs. Each method but `stop` raises StepError after a signal, or if the robot may not move."""

    def __init__(self, signals: Signals) -> None:
        self._signals, self._watch = signals, SafetyWatch()
        self._services = Services(self._watch)
        self._topics = {topic: Latest(topic, kind) for topic, kind in TOPICS.items()}
        self._path = rospy.Publisher("joint_trajectory", JointTrajectory, queue_size=1, tcp_nodelay=True)
        velocity = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        self._twist = Sender(velocity, Twist())

        def ready() -> bool:
            received = [self._topics[topic].message for topic in ("joint_states", "leg_state", "odom")]
            taken = self._path.get_num_connections() and velocity.get_num_connections()
            return None not in (self._watch.message, *received) and bool(taken)

        await_all(ready, signals)
        if not ready():
            raise RefusedError("no robot on legs answers: start it first, and check it with why.py")

    def newest(self, topic: str) -> Any:  # noqa: ANN401 (of the topic)
        """The newest message of one of TOPICS."""
        message = self._topics[topic].fresh(time.monotonic(), SILENCE)
        require(message is not None, f"{topic} is silent: run why.py")
        return message

    @property
    def safety(self) -> SafetyStatus:
        """The newest safety_status."""
        return self._watch.message

    @property
    def loads(self) -> dict[str, float]:
        """N, of each foot, as estimated or measured."""
        state = self.newest("leg_state")
        return dict(zip(state.foot, state.load, strict=True))

    @property
    def voltage(self) -> float | None:
        """V, of the battery; None if it is not measured."""
        battery = self._topics["battery_state"].message
        return None if battery is None or math.isnan(battery.voltage) else battery.voltage

    @property
    def tilt(self) -> tuple[float, float]:
        """Roll and pitch, rad."""
        q = self.newest("odom").pose.pose.orientation
        return rpy(rotation((q.x, q.y, q.z, q.w)))[:2]

    @property
    def stopped(self) -> bool:
        """True while a stop is latched."""
        return self.safety.state_name in STOPPED

    def wait(self, over: Callable[[], object], limit: float, act: Callable[[], None] = lambda: None) -> bool:
        """Calls `act` until it is over, at most `limit` s; returns whether it is."""
        end = time.monotonic() + limit
        while not over():
            require(self._signals.going_on(), "interrupted")
            if time.monotonic() > end:
                return False
            act()
            time.sleep(PERIOD)
        return True

    def require_release(self) -> None:
        """Raises StepError where the robot may not move."""
        status = status_of(self.safety)
        require(bool(self._watch.drivable()), f"{status.why()}: {status.remedy or 'run why.py'}")

    def stop(self) -> bool:
        """Brakes the robot until a reset; returns whether it is stopped. Works after a signal, too."""
        _awaited(self._services.e_stop)
        answer = self._answer(E_STOP)
        return answer is not None and answer.accepted and _awaited(lambda: self.safety.state_name in RESTS)

    def reset(self) -> None:
        """Ends a stop, as soon as the joints rest."""
        answers: list[Answer | None] = [None]

        def released() -> bool:
            self._twist.send(Twist())  # evidence that no motion is requested; silence takes longer
            self._services.reset()
            answers.append(self._answer(RESET))
            return answers[-1] is not None and answers[-1].accepted

        accepted, last = self.wait(released, ANSWER), answers[-1]
        require(accepted, f"{RESET}: {last.text if last else 'no answer, run why.py'}")
        self.wait(self._watch.drivable, ANSWER)
        self.require_release()
        self._path.publish(JointTrajectory())
        self._twist.send(Twist())

    def take(self, posture: str) -> None:
        """Lets the robot stand up or lie down."""
        self._call("set_posture", SetPosture, posture)
        self._move_until(posture)

    def turn(self, angles: dict[str, float], seconds: float) -> None:
        """Moves some joints of a robot that lies to `angles`, rad."""
        point = JointTrajectoryPoint(positions=list(angles.values()), time_from_start=rospy.Duration(seconds))
        self._path.publish(JointTrajectory(joint_names=list(angles), points=[point]))
        self._move(seconds + ARRIVAL)

    def walk(self, gait: str, speed: float, seconds: float) -> tuple[str, float]:
        """Walks straight ahead, then stands; returns the gait in use and the mean speed towards its first heading, m/s.

        It is the mean of the speeds of odom: a simulation that is late has less time than this clock and the stamps.
        """
        self._call("set_gait", SetGait, gait)
        twist = Twist()
        twist.linear.x = speed
        self._move_until("walking", twist)
        self._move(RAMP, twist)
        walk = [self.newest("odom")]
        self._move(seconds, twist, lambda: walk.append(self.newest("odom")))
        used, yaw = self.newest("leg_state").gait, pose_of(walk[0]).yaw
        self._move_until("standing", Twist())
        return used, mean(speed_along(yaw, each) for each in walk)

    def _move(self, seconds: float, twist: Twist | None = None, over: Callable[[], object] = lambda: False) -> bool:
        def act() -> None:
            self.require_release()
            if twist is not None:
                self._twist.send(twist)

        return self.wait(over, seconds, act)

    def _move_until(self, posture: str, twist: Twist | None = None) -> None:
        if not self._move(ANSWER, twist, lambda: self.newest("leg_state").posture == posture):
            state = self.newest("leg_state")
            why = "; ".join(state.sentences) or "run why.py"
            raise StepError(f"the posture is '{state.posture}' after {ANSWER:g} s, ordered '{posture}': {why}")

    def _answer(self, service: str) -> Answer | None:
        """The answer of this service; one of another service came late, and is dropped."""
        return _awaited(lambda: next((each for each in self._services.poll() if each.service == service), None))

    def _call(self, name: str, kind: type, word: str) -> None:
        try:
            answer = rospy.ServiceProxy(name, kind)(word)
        except rospy.ServiceException as error:
            raise StepError(f"{name}: {error}") from None
        require(answer.success, f"{name} '{word}' is {answer.message}")
