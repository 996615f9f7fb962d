"""Locates a path's frame relative to odometry's by tf; for a planar robot that is x, y and yaw."""

import math
import threading
import time
from dataclasses import dataclass

import rospy
import tf2_py
from tf2_msgs.msg import TFMessage

from robot_control.drive.path.waypoints import PathError, Waypoint, placed
from robot_control.robot.boundary import subscribe
from robot_control.robot.pose import FARTHEST, Pose, yaw_of

SILENCE = 1.0
"""s without a newer transform between two frames that move against each other"""
PATIENCE = 2.0
"""s that a new subscriber needs at most to know all frames"""
POLL_PERIOD = 0.05
"""s"""


@dataclass(frozen=True)
class Transform:
    """Pose of the frame `source` in the frame `target`."""

    pose: Pose
    stamp: float  # s; 0: the two are fixed to each other


class Tf:
    """The topics tf and tf_static of the robot's namespace."""

    def __init__(self) -> None:
        self._buffer = tf2_py.BufferCore(rospy.Duration(10))
        self._lock = threading.Lock()
        self._complete_at = time.monotonic() + PATIENCE
        static = self._buffer.set_transform_static
        subscribe("tf", TFMessage, lambda message: self._receive(message, self._buffer.set_transform), tcp_nodelay=True)
        subscribe("tf_static", TFMessage, lambda message: self._receive(message, static))

    def lookup(self, target: str, source: str) -> Transform:
        """The newest transform; a missing one is waited for in the first PATIENCE seconds. Raises PathError: tf does
        not connect them.
        """
        while True:
            try:
                with self._lock:
                    found = self._buffer.lookup_transform_core(target, source, rospy.Time(0))
                break
            except tf2_py.TransformException as error:
                if time.monotonic() > self._complete_at:
                    raise PathError(f"tf does not connect the path's frame with the robot's: {error}") from None
            time.sleep(POLL_PERIOD)
        shift, yaw = found.transform.translation, yaw_of(found.transform.rotation)
        if not all(abs(number) <= FARTHEST for number in (shift.x, shift.y, yaw)):  # NaN is none, either
            raise PathError(f"tf from {source!r} to {target!r} is beyond {FARTHEST:g} m")
        return Transform(Pose(shift.x, shift.y, yaw), found.header.stamp.to_sec())

    def _receive(self, message: TFMessage, store: object) -> None:
        with self._lock:
            for transform in message.transforms:
                store(transform, "tf")  # type: ignore[operator]


class PathFrame:
    """Poses by odometry → poses in the path's frame, which may move against odometry's (map)."""

    def __init__(self, name: str, odom: str, frames: Tf) -> None:
        self.name = name
        self._odom, self._frames = odom, frames
        self._stamp, self._newer_at = math.nan, math.inf

    @property
    def scale_error(self) -> float:
        """Share by which the wheels' speed and the poses may differ: a localisation does not measure the wheels."""
        return 0.01 if self.name == self._odom else 0.05

    def pose(self, pose: Pose, now: float) -> Pose:
        """`now`: s of a clock that never jumps.

        Raises:
            PathError: tf does not connect the two any more, or has been silent for SILENCE.
        """
        if self.name == self._odom:
            return pose
        found = self._frames.lookup(self.name, self._odom)
        if found.stamp != self._stamp:
            self._stamp, self._newer_at = found.stamp, now
        if found.stamp > 0 and now - self._newer_at > SILENCE:
            raise PathError(f"tf from {self._odom!r} to {self.name!r} is silent for {SILENCE:g} s")
        return Pose(*found.pose.holding(pose.x, pose.y), pose.yaw + found.pose.yaw)


def located(points: list[Waypoint], frame: str, own: tuple[str, str], frames: Tf) -> tuple[list[Waypoint], PathFrame]:
    """The path as it is driven, and the frame in which it is given. A frame that is fixed to the robot is replaced by
    that of odometry, with the path at its present place. `own`: frames of odometry and of the robot.

    Raises:
        PathError: the frame is unknown.
    """
    frame, (odom, base) = frame.lstrip("/"), own
    if not frame:
        raise PathError("the path has no frame: set header.frame_id")
    if frame == odom:
        return points, PathFrame(odom, odom, frames)
    if frame == base or frames.lookup(base, frame).stamp == 0:
        return placed(points, frames.lookup(odom, frame).pose), PathFrame(odom, odom, frames)
    return points, PathFrame(frame, odom, frames)
