"""Senders and receivers for the tests of commands, in addition to system_support."""

import time

import rospy
from geometry_msgs.msg import TwistStamped
from robot_control.msg import DriveState
from system.system_support import CONTROLLER, SEND_PERIOD, Report, Robot


class StampedSender:
    """A sender on cmd_vel_stamped, and the controller's reports on commands."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.drive: DriveState | None = None
        self.publisher = rospy.Publisher(robot.name("cmd_vel_stamped"), TwistStamped, queue_size=1, tcp_nodelay=True)
        self._last_send = 0.0
        self._subscriber = rospy.Subscriber(robot.name("drive_state"), DriveState, self._receive_drive)

    def send(self, linear: float, angular: float, stamp: rospy.Time) -> None:
        """Sends on cmd_vel_stamped, at most every SEND_PERIOD; a revoked sender first sends a zero."""
        if rospy.get_name() in self.robot.revoked:
            linear = angular = 0.0
        if time.monotonic() - self._last_send < SEND_PERIOD:
            return
        self._last_send = time.monotonic()
        message = TwistStamped()
        message.header.stamp = stamp
        message.twist.linear.x, message.twist.angular.z = linear, angular
        self.publisher.publish(message)

    def send_aged(self, linear: float, age: float) -> None:
        """Sends a stamp `age` s ago on this process' clock."""
        self.send(linear, 0.0, rospy.Time.from_sec(rospy.get_time() - age))

    def connected(self) -> bool:
        return bool(self.publisher.get_num_connections() > 0)

    @property
    def report(self) -> Report:
        """The controller's."""
        return self.robot.reports[CONTROLLER]

    @property
    def reasons(self) -> set[str]:
        """Reasons in drive_state."""
        return set() if self.drive is None else set(self.drive.reasons)

    def _receive_drive(self, message: DriveState) -> None:
        self.drive = message
