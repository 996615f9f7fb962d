"""The estimate as files: CSV and rosbag, written row by row."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from robot_control.data.estimate.samples import InputError, IntArray
from robot_control.loop.estimator import SENSORS, Estimate

XYZ = ("x", "y", "z")
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
TWIST = (*(f"linear_{axis}" for axis in XYZ), *(f"angular_{axis}" for axis in XYZ))

SCALARS = ("distance", "radius_ratio", "radius_ratio_deviation", "wheel_base_factor", "wheel_base_deviation")
WHEELS = ("wheel_x", "wheel_y", "wheel_yaw", "wheel_linear", "wheel_angular")


class Sink(Protocol):
    """Takes the estimate a piece at a time."""

    def add(self, time_ns: IntArray, estimate: Estimate, /) -> None:
        """Rows in their order; `estimate` as `Estimator.process` gives it."""


class CsvSink:
    """A CSV of one header line; units as `Estimator.process`, variances in the squares of them."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("w", encoding="utf-8")
        self._head = True

    def add(self, time_ns: IntArray, estimate: Estimate) -> None:
        """Writes the rows."""
        columns = _columns(estimate)
        if self._head:
            self._file.write(",".join(["time", *columns]) + "\n")
            self._head = False
        cells = [_seconds(time_ns), *(map(repr, values.tolist()) for values in columns.values())]
        self._file.writelines(",".join(row) + "\n" for row in zip(*cells, strict=True))

    def close(self) -> None:
        """Writes everything to the disk; raises OSError if that fails."""
        self._file.close()


class BagSink:
    """nav_msgs/Odometry on /odom and its transform on /tf."""

    def __init__(self, path: Path, base_frame: str) -> None:
        try:
            import rosbag
            from geometry_msgs.msg import TransformStamped
            from nav_msgs.msg import Odometry
            from rospy import Time
            from tf2_msgs.msg import TFMessage
        except ImportError as error:
            what = "a bag needs Debian's python3-rosbag, python3-nav-msgs and python3-tf2-msgs"
            raise InputError(f"{what}: {error}. Run it with /usr/bin/python3, or write --csv") from None
        self._odometry, self._transform, self._transforms, self._time = Odometry, TransformStamped, TFMessage, Time
        self._base_frame = base_frame
        self._bag = rosbag.Bag(str(path), "w")

    def add(self, time_ns: IntArray, estimate: Estimate) -> None:
        """Writes a message on either topic for each row."""
        if time_ns[0] < 0:
            raise InputError("times below zero cannot be stamps of ROS: write --csv, or shift the time")
        for row, stamp_ns in enumerate(time_ns.tolist()):
            stamp = self._time(stamp_ns // 10**9, stamp_ns % 10**9)
            odometry = self._message(stamp, estimate, row)
            self._bag.write("/odom", odometry, stamp)
            self._bag.write("/tf", self._transforms([self._placed(odometry)]), stamp)

    def _message(self, stamp: Any, estimate: Estimate, row: int) -> Any:  # noqa: ANN401 (genpy has no types)
        message = self._odometry()
        message.header.stamp = stamp
        message.header.frame_id = "odom"
        message.child_frame_id = self._base_frame
        pose, twist = message.pose.pose, message.twist.twist
        pose.position.x, pose.position.y, pose.position.z = (float(estimate[axis][row]) for axis in XYZ)
        q = pose.orientation
        q.x, q.y, q.z, q.w = estimate["quaternion"][row].tolist()
        twist.linear.x, twist.linear.y, twist.linear.z = estimate["linear"][row].tolist()
        twist.angular.x, twist.angular.y, twist.angular.z = estimate["angular"][row].tolist()
        message.pose.covariance = estimate["pose_covariance"][row].ravel().tolist()
        message.twist.covariance = estimate["twist_covariance"][row].ravel().tolist()
        return message

    def _placed(self, odometry: Any) -> Any:  # noqa: ANN401
        transform = self._transform()
        transform.header, transform.child_frame_id = odometry.header, odometry.child_frame_id
        position = odometry.pose.pose.position
        to = transform.transform.translation
        to.x, to.y, to.z = position.x, position.y, position.z
        transform.transform.rotation = odometry.pose.pose.orientation
        return transform

    def close(self) -> None:
        """Closes the bag with its index."""
        self._bag.close()


def _seconds(time_ns: IntArray) -> Iterator[str]:
    """Decimal seconds, exact."""
    for stamp in time_ns.tolist():
        whole, rest = divmod(abs(stamp), 10**9)
        yield f"{'-' if stamp < 0 else ''}{whole}.{rest:09d}"


def _columns(estimate: Estimate) -> dict[str, np.ndarray[Any, Any]]:
    """Name → values (M,), everything but time."""
    columns = {name: estimate[name] for name in POSE}
    columns |= {f"q{axis}": estimate["quaternion"][:, i] for i, axis in enumerate((*XYZ, "w"))}
    for name in ("linear", "angular"):
        columns |= {f"{name}_{axis}": estimate[name][:, i] for i, axis in enumerate(XYZ)}
    pose, twist = estimate["pose_covariance"], estimate["twist_covariance"]
    columns |= {f"{name}_variance": pose[:, i, i] for i, name in enumerate(POSE)}
    columns |= {"x_y_covariance": pose[:, 0, 1], "x_yaw_covariance": pose[:, 0, 5], "y_yaw_covariance": pose[:, 1, 5]}
    columns |= {f"{name}_variance": twist[:, i, i] for i, name in enumerate(TWIST)}
    columns |= {f"gyro_bias_{axis}": estimate["gyro_bias"][:, i] for i, axis in enumerate(XYZ)}
    columns |= {f"gyro_bias_{axis}_deviation": estimate["gyro_bias_deviation"][:, i] for i, axis in enumerate(XYZ)}
    columns |= {f"accelerometer_bias_{axis}": estimate["accelerometer_bias"][:, i] for i, axis in enumerate(XYZ)}
    columns |= {name: estimate[name] for name in (*SCALARS, *WHEELS)}
    for name in ("confidence", "nis", "rejected"):
        columns |= {f"{name}_{sensor}": estimate[name][:, i] for i, sensor in enumerate(SENSORS)}
    columns |= {name: estimate[name] for name in ("flags", "slip")}
    columns["valid"] = estimate["valid"].astype(int)
    return columns
