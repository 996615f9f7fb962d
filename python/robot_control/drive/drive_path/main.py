"""drive_path.py's ROS side: odometry in, commands out."""

import argparse
import sys
import time
from pathlib import Path as FilePath

import rospy
from nav_msgs.msg import Path

from robot_control.drive.path.follower import Follower, FollowParameters, State
from robot_control.drive.path.frames import PathFrame, Tf, located
from robot_control.drive.path.pieces import route
from robot_control.drive.path.robot import PATIENCE, SOURCE, Robot
from robot_control.drive.path.run import Drive, PauseServices, points_of, shown
from robot_control.drive.path.shapes import SHAPES
from robot_control.drive.path.waypoints import PathError, Waypoint, placed, read_csv
from robot_control.files.files import in_words, one_message
from robot_control.robot.boundary import MAX_LONG_BYTES, next_message
from robot_control.robot.command import Command
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.pose import pose_of
from robot_control.robot.process_start import process_began
from robot_control.robot.ros_node import running_node
from robot_control.robot.send_plan import positive
from robot_control.robot.topic_sender import Signals

REPORT_PERIOD = 1.0
"""s"""


def received(name: str) -> Path:
    """The next message on that topic, or its last one if it is latched. Raises PathError."""
    message: Path | None = next_message(name, Path, PATIENCE, MAX_LONG_BYTES)
    if message is None:
        raise PathError(f"nothing received on {rospy.resolve_name(name)} within {PATIENCE:g} s")
    return message


def drive(points: list[Waypoint] | None, given: argparse.Namespace, signals: Signals) -> str:
    """The reason why the path was not driven to its end; empty if it was. `points` None stands for those of the topic.
    The request is as old as this process: a plan or a file that comes after a stop and its reset is refused.

    Raises:
        PathError: the topic brings none.
    """
    requested = process_began()
    robot, topic, tf = Robot(), CommandTopic(SOURCE), Tf()
    services = PauseServices()
    wrong = robot.await_drivable(topic, signals.going_on, requested)
    odometry, _ = robot.odometry
    if wrong or odometry is None:
        return wrong
    odom, _ = robot.frames
    if points is None:
        message = received(given.topic)
        here, frame = located(points_of(message), message.header.frame_id, robot.frames, tf)
    else:
        here = points if given.in_odom else placed(points, pose_of(odometry))
        frame = PathFrame(odom, odom, tf)
    planned = route(here)
    wanted = rospy.Publisher("path_wanted", Path, queue_size=1, latch=True)
    wanted.publish(shown(here, frame.name))
    follower = Follower(planned, FollowParameters(speed=given.speed, scale_error=frame.scale_error))
    run = services.drive = Drive(robot, topic, follower, frame, requested)
    reported = time.monotonic()

    def report() -> None:
        nonlocal reported
        if time.monotonic() - reported >= REPORT_PERIOD:
            reported = time.monotonic()
            rospy.loginfo(run.describe())

    run.run(signals.going_on, report)
    topic.send(Command())
    rospy.loginfo(run.describe())
    if follower.state is State.DONE:
        rospy.loginfo(f"done; at most {1000 * follower.worst_cross_track_error:.0f} mm off the path by odometry")
        return ""
    return follower.reason or "interrupted"


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line, without the program's name; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="drive_path.py",
        description="Drives the robot along a path, from its present pose. Commands go to path_vel where the robot "
        "has a list of command sources, else to cmd_vel_stamped. Services: drive_path/pause, drive_path/resume.",
        epilog="Exit code 0: the end of the path was reached; else 1, with the reason.",
    )
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--topic", help="a topic with a nav_msgs/Path, for instance a planner's, in any frame of tf")
    meaning = f"{', '.join(SHAPES)}, or a CSV file with the header x,y[,yaw[,speed]] (m, rad, m/s)"
    which.add_argument("path", nargs="?", help=meaning)
    parser.add_argument("--size", type=positive, default=2.0, help="m, side or width of a shape (default %(default)s)")
    parser.add_argument("--speed", type=positive, default=FollowParameters.speed, help="m/s (default %(default)s)")
    meaning = "the points of the CSV file lie in the frame odom, not before the robot"
    parser.add_argument("--in-odom", action="store_true", help=meaning)
    return parser.parse_args(given)


def points_named(path: str, size: float) -> list[Waypoint]:
    """The points of a shape or of a file. Raises PathError, OSError."""
    try:
        points = SHAPES[path](size) if path in SHAPES else read_csv(FilePath(path))
    except FileNotFoundError as error:
        raise PathError(f"{in_words(error)}; the shapes are {', '.join(SHAPES)}") from None
    route(points)
    return points


@one_message("drive_path.py", PathError, OSError)
def main() -> None:
    """Entry point of scripts/drive_path.py."""
    given = arguments(rospy.myargv()[1:])
    points = None if given.path is None else points_named(given.path, given.size)
    with running_node("drive_path") as signals:
        reason = drive(points, given, signals)
    if reason:
        sys.exit(f"drive_path.py: {reason}")
