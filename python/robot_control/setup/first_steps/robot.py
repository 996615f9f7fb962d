"""The ROS side of first_steps.py: reports of the robot, its few motions, and its stop."""

import math
import time
from collections.abc import Callable
from typing import Any

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
from robot_control.robot.services import Answer, Services
from robot_control.robot.topic_sender import Sender, Signals
from robot_control.setup.first_steps.checks import StepError
from robot_control.srv import SetGait, SetPosture

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
TOPICS = {"battery_state": BatteryState, "joint_states": JointState, "leg_state": LegState, "odom": Odometry}


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
        if message is None:
            raise StepError(f"{topic} is silent: run why.py")
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
            if not self._signals.going_on():
                raise StepError("interrupted")
            if time.monotonic() > end:
                return False
            act()
            time.sleep(PERIOD)
        return True

    def require_release(self) -> None:
        """Raises StepError where the robot may not move."""
        if not self._watch.drivable():
            status = status_of(self.safety)
            raise StepError(f"{status.why()}: {status.remedy or 'run why.py'}")

    def stop(self) -> str:
        """Brakes the robot until a reset; returns what came of it. Works after a signal, too."""
        self._services.e_stop()
        answer = self._answer()
        if answer and answer.accepted:
            return "The robot is stopped, until rosservice call e_stop_reset."
        return "THE STOP WAS NOT CONFIRMED: press the emergency stop."

    def reset(self) -> None:
        """Ends a stop, as soon as the joints rest."""
        answers: list[Answer | None] = []

        def ask() -> None:
            self._services.reset()
            answers.append(self._answer())

        def released() -> bool:
            return bool(answers) and answers[-1] is not None and answers[-1].accepted

        if not self.wait(released, ANSWER, ask):
            raise StepError(f"e_stop_reset: {answers[-1].text if answers[-1] else 'no answer, run why.py'}")
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
        """Walks straight ahead, then stands; returns the gait in use and the mean speed, m/s."""
        self._call("set_gait", SetGait, gait)
        twist = Twist()
        twist.linear.x = speed
        self._move_until("walking", twist)
        self._move(RAMP, twist)
        begin, began = pose_of(self.newest("odom")), time.monotonic()
        self._move(seconds, twist)
        end, took = pose_of(self.newest("odom")), time.monotonic() - began
        used = self.newest("leg_state").gait
        self._move_until("standing", Twist())
        return used, math.hypot(end.x - begin.x, end.y - begin.y) / took

    def _move(self, seconds: float, twist: Twist | None = None, over: Callable[[], bool] = lambda: False) -> bool:
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

    def _answer(self) -> Answer | None:
        end = time.monotonic() + ANSWER
        while not (answers := self._services.poll()) and time.monotonic() < end:
            time.sleep(PERIOD)
        return answers[-1] if answers else None

    def _call(self, name: str, kind: type, word: str) -> None:
        try:
            answer = rospy.ServiceProxy(name, kind)(word)
        except rospy.ServiceException as error:
            raise StepError(f"{name}: {error}") from None
        if not answer.success:
            raise StepError(f"{name} '{word}' is {answer.message}")
