"""identify.py's view of a running robot: its reports and its commands."""

import math
import time

import rospy
from geometry_msgs.msg import Twist

from robot_control.robot.diagnosis.recent import Diagnostics, values_of
from robot_control.robot.pose import pose_of
from robot_control.robot.process_start import process_began
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.topic_sender import Sender
from robot_control.robot.view import View
from robot_control.setup.excitation_watch import Observation
from robot_control.setup.recorded_log import RunningTelemetry


class RunningRobot:
    """Receives the reports of one robot; sends commands on cmd_vel, a zero when the node is shut down."""

    def __init__(self, *, sends: bool = True) -> None:
        """If `sends` is false, it only receives and does not count as a sender on cmd_vel."""
        self._reports = Diagnostics(math.inf)
        self._view = View("odom")
        self.requested = process_began()
        """s (monotonic), of the motion that follows"""
        self._watch = SafetyWatch()
        self._publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True) if sends else None
        self._sender = None if self._publisher is None else Sender(self._publisher, Twist())

    @property
    def logs(self) -> dict[str, RunningTelemetry]:
        """The newest report of each telemetry, by node."""
        values = {node: values_of(status) for node, (_, status) in self._reports.items(time.monotonic()).items()}
        return {
            node: RunningTelemetry(node, each["bag"], each.get("recording") == "1")
            for node, each in values.items()
            if each.get("bag")
        }

    def send(self, linear: float, angular: float) -> None:
        """m/s, rad/s."""
        if self._sender is None:
            return
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        self._sender.send(message)

    def has_receiver(self) -> bool:
        """True if a controller receives what is sent."""
        return self._publisher is not None and int(self._publisher.get_num_connections()) > 0

    def reports(self) -> bool:
        """True if odometry and a report of the safety monitor have arrived."""
        return self._view.newest("odom")[0] is not None and self._watch.message is not None

    def observe(self, senders: tuple[str, ...] = ()) -> Observation:
        """The present state; `senders` are the others on cmd_vel."""
        revoked = self._watch.revoked(self.requested, waited=True)
        now = time.monotonic()
        (odometry, at), status = self._view.newest("odom"), self._watch.message
        return Observation(
            pose=None if odometry is None else pose_of(odometry),
            linear=0.0 if odometry is None else odometry.twist.twist.linear.x,
            angular=0.0 if odometry is None else odometry.twist.twist.angular.z,
            pose_age=now - at,
            state="" if status is None else status.state_name,
            status_age=now - self._watch.received_at,
            revoked=revoked,
            sentences=() if status is None else tuple(status.sentences),
            missing=() if status is None else tuple(status.missing),
            speed_limit=math.inf if status is None else status.speed_limit,
            senders=senders,
        )
