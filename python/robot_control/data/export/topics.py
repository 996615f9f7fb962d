"""A log as the topics that a robot publishes: odom, tf, joint_states, cmd_vel."""

import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rosbag
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from rospy import Time
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from robot_control.data.run_log import FloatArray, RunLog, odom_frame, read_run

ODOM_RATE = 50.0
"""Hz, odom and tf; the default of a running robot"""
JOINT_STATES_RATE = 100.0


def write_topics(source: Path, target: Path) -> str:
    """Returns `RunLog.cut`. Raises LogError, OSError."""
    run = read_run(source)
    topics = Topics(run)
    with rosbag.Bag(str(target), "w") as bag:
        for row in range(run.ros_time.size):
            for topic, message, stamp in topics.of_row(row):
                bag.write(topic, message, stamp)
    return run.cut


class Topics:
    """Messages out of the rows of a log."""

    def __init__(self, run: RunLog) -> None:
        self._columns, self._time = run.columns, run.ros_time
        self._joints: list[str] = list(run.header["joints"])
        self._base = root_link(run.header["urdf"])
        self._odom = odom_frame(run.header["parameters"])
        period = float(run.header["period"])
        self._every_odom = max(1, round(1 / (ODOM_RATE * period)))
        self._every_joints = max(1, round(1 / (JOINT_STATES_RATE * period)))
        received = np.nan_to_num(run.columns["requests_received"])
        self._requested = np.flatnonzero(np.diff(received, prepend=0.0))
        self._requests = set(self._requested.tolist())

    def of_row(self, row: int) -> Iterator[tuple[str, Any, Any]]:
        """Topic, message and time of each message that is due in this row."""
        stamp = Time.from_sec(float(self._time[row]))
        if row in self._requests:
            yield "cmd_vel", self._twist(row), stamp
        if row % self._every_joints == 0 and not math.isnan(self._columns[f"{self._joints[0]}_position"][row]):
            yield "joint_states", self._joint_states(row, stamp), stamp
        if row % self._every_odom == 0 and not math.isnan(self._columns["estimate_x"][row]):
            odometry = self._odometry(row, stamp)
            yield "odom", odometry, stamp
            yield "tf", self._transform(odometry), stamp

    def _twist(self, row: int) -> Any:  # noqa: ANN401 (genpy has no types)
        twist = Twist()
        twist.linear.x = self._columns["requested_linear"][row]
        twist.angular.z = self._columns["requested_angular"][row]
        return twist

    def _joint_states(self, row: int, stamp: Any) -> Any:  # noqa: ANN401
        message = JointState()
        message.header.stamp = stamp
        message.name = self._joints
        message.position, message.velocity, message.effort = (
            [self._columns[f"{joint}_{what}"][row] for joint in self._joints]
            for what in ("position", "velocity", "effort")
        )
        return message

    def _odometry(self, row: int, stamp: Any) -> Any:  # noqa: ANN401
        at = self._columns
        message = Odometry()
        message.header.stamp = stamp
        message.header.frame_id = self._odom
        message.child_frame_id = self._base
        pose, twist = message.pose.pose, message.twist.twist
        pose.position.x, pose.position.y, pose.position.z = (at[f"estimate_{axis}"][row] for axis in "xyz")
        yaw = at["estimate_yaw"][row]
        pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        twist.linear.x, twist.linear.y = at["estimate_linear"][row], at["estimate_lateral"][row]
        twist.angular.z = at["estimate_angular"][row]
        message.pose.covariance = covariance(row, at, POSE_ENTRIES)
        message.twist.covariance = covariance(row, at, TWIST_ENTRIES)
        return message

    def _transform(self, odometry: Any) -> Any:  # noqa: ANN401
        transform = TransformStamped()
        transform.header, transform.child_frame_id = odometry.header, odometry.child_frame_id
        position, to = odometry.pose.pose.position, transform.transform.translation
        to.x, to.y, to.z = position.x, position.y, position.z
        transform.transform.rotation = odometry.pose.pose.orientation
        return TFMessage([transform])


# Row and column of a 6 × 6 matrix over x, y, z, roll, pitch, yaw.
POSE_ENTRIES = {
    (0, 0): "estimate_x_variance",
    (1, 1): "estimate_y_variance",
    (5, 5): "estimate_yaw_variance",
    (0, 1): "estimate_xy_covariance",
    (0, 5): "estimate_x_yaw_covariance",
    (1, 5): "estimate_y_yaw_covariance",
}
TWIST_ENTRIES = {
    (0, 0): "estimate_linear_variance",
    (1, 1): "estimate_lateral_variance",
    (5, 5): "estimate_angular_variance",
    (0, 5): "estimate_linear_angular_covariance",
}


def covariance(row: int, columns: Mapping[str, FloatArray], entries: Mapping[tuple[int, int], str]) -> list[float]:
    """36 numbers, row-major, symmetric."""
    matrix = np.zeros((6, 6))
    for (i, j), name in entries.items():
        matrix[i, j] = matrix[j, i] = columns[name][row]
    entries_in_order: list[float] = matrix.ravel().tolist()
    return entries_in_order


def root_link(urdf: str) -> str:
    """The link that is not the child of any joint."""
    robot = ET.fromstring(urdf)
    children = {child.get("link") for child in robot.iterfind("joint/child")}
    return next((link.get("name", "") for link in robot.iterfind("link") if link.get("name") not in children), "")
