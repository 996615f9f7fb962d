"""drive_path.py's ROS side: odometry in, commands out."""

from __future__ import annotations

import argparse
import math
import sys
import threading
import time
from pathlib import Path as FilePath

import rospy
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry, Path
from std_srvs.srv import Trigger, TriggerResponse

from robot_control.common.command_topic import CommandTopic
from robot_control.common.orientation import yaw_of
from robot_control.common.ros_master import require_master
from robot_control.common.safety_states import DRIVABLE
from robot_control.common.topic_sender import Signals, ended_by_signals
from robot_control.drive.send_plan import positive
from robot_control.msg import DriveState, SafetyStatus
from robot_control.path.follower import Follower, FollowParameters, Motion, Pose, State
from robot_control.path.pieces import route
from robot_control.path.shapes import SHAPES
from robot_control.path.waypoints import PathError, Waypoint, from_poses, placed, read_csv

SOURCE = "path_vel"
SILENCE = 0.5
"""s without odometry; it comes at 50 Hz"""
PATIENCE = 10.0
"""s to wait for odometry and the permit to drive"""
LOOK = 0.005
"""s between two looks for a new odometry message"""
REPORT_PERIOD = 1.0
"""s"""


def pose_of(odometry: Odometry) -> Pose:
    """Of the robot, in the frame odom."""
    pose = odometry.pose.pose
    return Pose(pose.position.x, pose.position.y, yaw_of(pose.orientation))


class Robot:
    """The last of each message."""

    def __init__(self) -> None:
        self.odometry: Odometry | None = None
        self.odometry_at = -math.inf
        self.safety: SafetyStatus | None = None
        self.commands = False  # what is sent here reaches the wheels
        self.masked_by = ""
        rospy.Subscriber("odom", Odometry, self._receive_odometry, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("safety_status", SafetyStatus, self._receive_safety, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber("drive_state", DriveState, self._receive_state, queue_size=1, tcp_nodelay=True)

    @property
    def drivable(self) -> bool:
        """The monitor permits to drive."""
        return self.safety is not None and self.safety.state_name in DRIVABLE

    def stop_in_words(self) -> str:
        """Why it may not drive."""
        if self.safety is None:
            return "no safety_status: safety_monitor does not run"
        why = "; ".join(self.safety.sentences) or "it is not ready"
        return f"{self.safety.state_name}: {why}. Call e_stop_reset, then start drive_path.py again"

    def _receive_odometry(self, message: Odometry) -> None:
        self.odometry, self.odometry_at = message, time.monotonic()

    def _receive_safety(self, message: SafetyStatus) -> None:
        self.safety = message

    def _receive_state(self, message: DriveState) -> None:
        states = dict(text.split(": ", 1) for text in message.sources)
        state = states.get(SOURCE, "")
        self.masked_by = state if state.startswith(("masked", "locked")) else ""
        self.commands = state in {"", "commands"}


class Drive:
    """One path, from the permit to drive to its end."""

    def __init__(self, robot: Robot, topic: CommandTopic, follower: Follower) -> None:
        self._robot, self._topic, self._follower = robot, topic, follower
        self._lock = threading.Lock()  # services come in threads of their own
        rospy.Service("~pause", Trigger, self._pause)
        rospy.Service("~resume", Trigger, self._resume)

    def run(self, signals: Signals) -> None:
        """Until the follower's end, or a signal."""
        last, reported = -math.inf, time.monotonic()
        while signals.going_on() and not self._follower.over:
            now = time.monotonic()
            if now - self._robot.odometry_at > SILENCE:
                self._follower.fail(f"odom is silent for {SILENCE:g} s")
            elif not self._robot.drivable:
                self._follower.fail(self._robot.stop_in_words())
            elif self._robot.odometry_at > last:
                last = self._robot.odometry_at
                self._step(self._robot.odometry)
            if now - reported >= REPORT_PERIOD:
                reported = now
                rospy.loginfo(self.describe())
            time.sleep(LOOK)
        self._topic.send(0.0, 0.0)

    def _step(self, odometry: Odometry) -> None:
        with self._lock:
            if self._robot.masked_by and self._follower.state is not State.PAUSED:
                self._follower.pause()
                rospy.logwarn(f"paused: {SOURCE} is {self._robot.masked_by}; goes on after ~resume")
            limit = self._robot.safety.speed_limit if self._robot.safety is not None else math.inf
            measured = Motion(odometry.twist.twist.linear.x, odometry.twist.twist.angular.z)
            command = self._follower.step(pose_of(odometry), measured, limit)
        self._topic.send(command.linear, command.angular)

    def describe(self) -> str:
        """One line for the log."""
        f = self._follower
        return (
            f"{f.state.name.lower()}: {100 * f.progress:.0f} %, {f.remaining:.2f} m left, "
            f"{1000 * f.cross_track_error:.0f} mm aside, {math.degrees(f.heading_error):.1f} deg off"
        )

    def _pause(self, _request: object) -> TriggerResponse:
        with self._lock:
            self._follower.pause()
        return TriggerResponse(success=True, message="paused; goes on after ~resume")

    def _resume(self, _request: object) -> TriggerResponse:
        with self._lock:
            if self._robot.masked_by:
                return TriggerResponse(success=False, message=f"{SOURCE} is {self._robot.masked_by}")
            self._follower.resume()
        return TriggerResponse(success=True, message="goes on")


def message_of(points: list[Waypoint], frame: str) -> Path:
    """For RViz."""
    path = Path()
    path.header.frame_id, path.header.stamp = frame, rospy.Time.now()
    for point in points:
        pose = PoseStamped(header=path.header)
        pose.pose.position.x, pose.pose.position.y = point.x, point.y
        pose.pose.orientation.z, pose.pose.orientation.w = (
            math.sin((point.yaw or 0) / 2),
            math.cos((point.yaw or 0) / 2),
        )
        path.poses.append(pose)
    return path


def await_robot(robot: Robot, topic: CommandTopic, signals: Signals) -> str:
    """With zeros until it may drive; why it may not within PATIENCE, or empty."""
    end = time.monotonic() + PATIENCE
    while signals.going_on() and time.monotonic() < end:
        if robot.drivable and robot.odometry is not None and topic.connected and robot.commands:
            return ""
        topic.send(0.0, 0.0)
        time.sleep(0.1)
    if robot.odometry is None:
        return "no odom: state_estimator does not run"
    if not robot.drivable:
        return robot.stop_in_words()
    return f"{SOURCE} is {robot.masked_by}" if robot.masked_by else "diff_drive_controller does not take commands"


def received(name: str, frame: str) -> list[Waypoint]:
    """The next message on that topic, or its last one if it is latched. Raises PathError."""
    try:
        message = rospy.wait_for_message(name, Path, PATIENCE)
    except rospy.ROSException:
        raise PathError(f"nothing came on {rospy.resolve_name(name)} within {PATIENCE:g} s") from None
    poses = [
        (pose.position.x, pose.position.y, (q.x, q.y, q.z, q.w))
        for pose in (stamped.pose for stamped in message.poses)
        for q in [pose.orientation]
    ]
    return from_poses(message.header.frame_id, frame, poses)


def drive(points: list[Waypoint] | None, given: argparse.Namespace, signals: Signals) -> str:
    """The reason why the path was not driven to its end; empty: it was. `points` None: the topic's.

    Raises:
        PathError: the topic brings none.
    """
    robot, topic = Robot(), CommandTopic(SOURCE)
    wrong = await_robot(robot, topic, signals)
    if wrong or robot.odometry is None:
        return wrong or "interrupted"
    start = pose_of(robot.odometry)
    if points is None:
        here = received(given.topic, robot.odometry.header.frame_id)
    else:
        here = points if given.in_odom else placed(points, start.x, start.y, start.yaw)
    planned = route(here)
    wanted = rospy.Publisher("path_wanted", Path, queue_size=1, latch=True)
    wanted.publish(message_of(here, robot.odometry.header.frame_id))
    follower = Follower(planned, FollowParameters(speed=given.speed))
    run = Drive(robot, topic, follower)
    run.run(signals)
    rospy.loginfo(run.describe())
    if follower.state is State.DONE:
        rospy.loginfo(f"done; at most {1000 * follower.worst_cross_track_error:.0f} mm aside by odometry")
        return ""
    return follower.reason or "interrupted"


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line, without the program's name; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="drive_path.py",
        description="Drives the robot along a path, from where it stands. Commands go to path_vel where the robot "
        "has a list of command sources, else to cmd_vel_stamped. Services: drive_path/pause, drive_path/resume.",
        epilog="Exit code 0: the end of the path was reached; else 1, with the reason.",
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--topic", help="a topic with a nav_msgs/Path in the frame odom, for instance a planner's")
    which.add_argument(
        "path", nargs="?", help=f"{', '.join(SHAPES)}, or a CSV file with the header x,y[,yaw[,speed]] (m, rad, m/s)"
    )
    parser.add_argument("--size", type=positive, default=2.0, help="m, side or width of a shape (default %(default)s)")
    parser.add_argument("--speed", type=positive, default=FollowParameters.speed, help="m/s (default %(default)s)")
    parser.add_argument(
        "--in-odom", action="store_true", help="the points of the CSV file lie in the frame odom, not before the robot"
    )
    return parser.parse_args(given)


def points_of(path: str, size: float) -> list[Waypoint]:
    """Of a shape, or of a file. Raises PathError, OSError."""
    points = SHAPES[path](size) if path in SHAPES else read_csv(FilePath(path))
    route(points)
    return points


def main() -> None:
    """Entry point of scripts/drive_path.py."""
    given = arguments(rospy.myargv(sys.argv)[1:])
    try:
        points = None if given.path is None else points_of(given.path, given.size)
    except (PathError, OSError) as error:
        sys.exit(f"drive_path.py: {error}")
    require_master()
    rospy.init_node("drive_path")
    try:
        with ended_by_signals() as signals:
            reason = drive(points, given, signals)
    except PathError as error:
        sys.exit(f"drive_path.py: {error}")
    if reason:
        sys.exit(f"drive_path.py: {reason}")
