"""Drives one path, from odometry to commands, until its end. drive_path.py and follow_path.py share it."""

import math
import threading
import time
from collections.abc import Callable, Iterable

import rospy
from geometry_msgs.msg import Point, Pose, PoseStamped
from nav_msgs.msg import Odometry, Path

from robot_control.drive.path.follower import Follower, Motion, State
from robot_control.drive.path.frames import PathFrame
from robot_control.drive.path.robot import SOURCE, Robot
from robot_control.drive.path.waypoints import PathError, Waypoint, from_poses
from robot_control.robot.command import Command
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.pose import pose_of
from robot_control.robot.ros_node import serve
from robot_control.robot.view import SILENCES

PAUSED = "paused; call ~resume to continue"
POLL_PERIOD = 0.005
"""s between two looks for a new odometry message"""
MAX_SHOWN = 2000
"""points of a path that is shown; a longer path is thinned evenly"""


class Drive:
    """A path from its first command on."""

    def __init__(
        self, robot: Robot, topic: CommandTopic, follower: Follower, frame: PathFrame, requested: float
    ) -> None:
        """The path was requested at `requested` s (monotonic)."""
        self._robot, self._topic, self.follower, self._frame = robot, topic, follower, frame
        self._requested = requested
        self._lock = threading.Lock()  # services come in threads of their own
        self._stamp: float | None = None  # s, of the last odometry
        self.paused_by = ""

    def run(self, going_on: Callable[[], bool], poll: Callable[[], None]) -> None:
        """Drives until the follower ends or `going_on` is false; `poll` is called in every pass. Sends no last zero."""
        last, waited = -math.inf, True
        while going_on() and not self.follower.over:
            revoked = self._robot.revoked(self._requested, waited=waited)
            against, waited = self._robot.against_driving(time.monotonic()) or revoked, False
            odometry, at = self._robot.odometry
            if against:
                self.follower.fail(against)
            elif at > last:
                last = at
                self._step(odometry)
            poll()
            time.sleep(POLL_PERIOD)

    def pause(self, why: str) -> str:
        """Stands until `resume` is called; empty, for nothing stands against it."""
        with self._lock:
            self.follower.pause()
            self.paused_by = why
            return ""

    def resume(self) -> str:
        """Why it does not go on; empty if it does."""
        with self._lock:
            if self._robot.masked_by:
                return f"{SOURCE} is {self._robot.masked_by}"
            self.follower.resume()
            self.paused_by = ""
            return ""

    def _step(self, odometry: Odometry) -> None:
        if self._robot.masked_by and self.follower.state is not State.PAUSED:
            self.pause(f"{SOURCE} is {self._robot.masked_by}")
            rospy.logwarn(f"paused: {self.paused_by}; call ~resume to continue")
        with self._lock:
            twist = odometry.twist.twist
            measured = Motion(twist.linear.x, twist.angular.z, twist.linear.y)
            try:
                pose = self._frame.pose(pose_of(odometry), time.monotonic())
                motion = self.follower.step(pose, measured, self._robot.speed_limit, self._elapsed(odometry))
            except PathError as error:
                self.follower.fail(str(error))
                return
        self._topic.send(Command(motion.linear, motion.angular, motion.lateral), odometry.header.stamp)

    def _elapsed(self, odometry: Odometry) -> float:
        """s since the last one; more than its silence would have ended the path."""
        last, self._stamp = self._stamp, odometry.header.stamp.to_sec()
        return min(max(0.0, self._stamp - (self._stamp if last is None else last)), SILENCES["odom"])

    def describe(self) -> str:
        """One line for the log."""
        f = self.follower
        what = f"{f.state.name.lower()}: {100 * f.progress:.0f} %, {f.remaining:.2f} m left"
        return f"{what}, {1000 * f.cross_track_error:z.0f} mm aside, {math.degrees(f.heading_error):z.1f} deg off"


class PauseServices:
    """~pause and ~resume, of the path that is driven at the moment."""

    def __init__(self) -> None:
        self.drive: Drive | None = None
        serve("~pause", lambda: self._of_drive(lambda drive: drive.pause("~pause was called")), PAUSED)
        serve("~resume", lambda: self._of_drive(Drive.resume), "goes on")

    def _of_drive(self, act: Callable[[Drive], str]) -> str:
        return "no path is driven" if (drive := self.drive) is None else act(drive)


def points_of(message: Path) -> list[Waypoint]:
    """In the frame of its header. Raises PathError: a pose lies in another one."""
    frame = message.header.frame_id
    others = {pose.header.frame_id for pose in message.poses} - {"", frame}
    if others:
        raise PathError(f"poses of the path lie in {', '.join(sorted(others))}, and the path in {frame!r}")
    return from_poses(stamped.pose for stamped in message.poses)


def shown(points: list[Waypoint], frame: str) -> Path:
    """For RViz and the console."""
    path = path_of([*points[: -1 : math.ceil(len(points) / MAX_SHOWN)], *points[-1:]], frame)
    path.header.stamp = rospy.Time.now()  # also that of the poses
    return path


def path_of(points: Iterable[Waypoint], frame: str) -> Path:
    """All points, without a time; the orientation of one without a yaw is zero, which is none."""
    path = Path()
    path.header.frame_id = frame
    path.poses = [PoseStamped(path.header, placed_pose(each.x, each.y, each.yaw)) for each in points]
    return path


def placed_pose(x: float, y: float, yaw: float | None) -> Pose:
    """A pose in the plane."""
    pose = Pose(position=Point(x, y, 0.0))
    if yaw is not None:
        pose.orientation.z, pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return pose
