"""The robot as a program sees it: the newest message of each topic, when it came, and whether the topic is silent."""

from typing import Any

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState

from robot_control.msg import DriveState, GuardState, LegState, RobotStatus, SafetyStatus
from robot_control.robot.boundary import Latest, UnfitError
from robot_control.robot.diagnosis.state import SILENCE
from robot_control.robot.pose import FARTHEST, pose_of

KINDS = {
    "battery_state": BatteryState,
    "drive_state": DriveState,
    "guard_state": GuardState,
    "leg_state": LegState,
    "odom": Odometry,
    "robot_status": RobotStatus,
    "safety_status": SafetyStatus,
}
SILENCES = dict.fromkeys(KINDS, SILENCE) | {"odom": 0.5}
"""s without a message after which a topic is silent: the slowest come once per second, and odometry at 50 Hz"""


def _check(message: Any) -> None:  # noqa: ANN401 (of any topic)
    if not isinstance(message, Odometry):
        return
    pose, twist = pose_of(message), message.twist.twist
    if not all(abs(each) <= FARTHEST for each in (pose.x, pose.y, pose.yaw, twist.linear.x, twist.angular.z)):
        raise UnfitError(f"holds a number beyond {FARTHEST:g}")


class View:
    """The newest message of each topic that passed the checks; the pose of odometry is a place, its speeds are some.
    Usable from every thread.
    """

    def __init__(self, *topics: str) -> None:
        self._topics = {topic: Latest(topic, KINDS[topic], check=_check) for topic in topics}

    def newest(self, topic: str) -> tuple[Any, float]:
        """The newest message and when it came, s, monotonic; None, minus infinity without one."""
        return self._topics[topic].newest

    def fresh(self, topic: str, now: float) -> Any:  # noqa: ANN401 (of the topic)
        """The newest message; None without one, or where the topic is silent."""
        return self._topics[topic].fresh(now, SILENCES[topic])

    @property
    def refused(self) -> bool:
        """True if the controller refuses what this node requested before a stop, by drive_state or leg_state."""
        newest, _ = max(map(self.newest, ("drive_state", "leg_state")), key=lambda newest: newest[1])
        return newest is not None and rospy.get_name() in newest.revoked
