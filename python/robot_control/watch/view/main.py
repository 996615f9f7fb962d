"""view_markers.py's ROS side."""

import argparse

import numpy as np
import rospy
from geometry_msgs.msg import Point, PoseStamped
from nav_msgs.msg import Odometry, Path
from visualization_msgs.msg import Marker, MarkerArray

from robot_control._robot_control import LegModel
from robot_control.msg import DriveState, LegState, SafetyStatus
from robot_control.robot.boundary import Latest, boundary, subscribe
from robot_control.robot.ros_node import running_node
from robot_control.watch.scene import Point as Place
from robot_control.watch.scene import Trail, Wheel, force_arrows, limits_of, status_text
from robot_control.watch.view.feet import Swings, in_odom, load_arrows
from robot_control.watch.view.wheels import running_robot

PERIOD = 0.1
"""s between two sets of markers"""
JOINTS = 12
"""of a robot on legs"""
SWINGS = 100
"""number of the first marker of a swing"""
ABOVE = 0.5
"""m, of the text above the robot's origin"""


class View:
    """The last of each message, drawn."""

    def __init__(self) -> None:
        self._safety, self._drive = Latest("safety_status", SafetyStatus), Latest("drive_state", DriveState)
        self._odometry = Latest("odom", Odometry)
        self._trail = Trail()
        self._wheels: dict[str, Wheel] = {}
        self._legs: LegModel | None = None
        self._leg_state: LegState | None = None
        self._swings = Swings()
        self._markers = rospy.Publisher("view/markers", MarkerArray, queue_size=1)
        self._path = rospy.Publisher("view/path_driven", Path, queue_size=1, latch=True)
        subscribe("leg_state", LegState, self._receive_legs, queue_size=1)

    def draw(self) -> None:
        """Draws nothing before the first odometry, because the markers use its frames."""
        odometry, drive = self._odometry.message, self._drive.message or DriveState()
        if odometry is None:
            return
        if not self._wheels and self._legs is None:
            self._wheels, self._legs = running_robot()
        position = odometry.pose.pose.position
        if self._trail.add(position.x, position.y):
            self._path.publish(self._path_message(odometry.header.frame_id))
        frame = odometry.child_frame_id
        markers = [self._text(frame, self._leg_state or drive)]
        arrows = force_arrows(self._wheels, drive.name, drive.effort) + self._forces_of_feet()
        for number, (begin, end) in enumerate(arrows):
            arrow = _marker(frame, number + 1, Marker.ARROW, (0.2, 0.6, 1.0))
            arrow.points = [Point(*begin), Point(*end)]
            arrow.scale.x, arrow.scale.y, arrow.scale.z = 0.02, 0.05, 0.05
            markers.append(arrow)
        for number, way in enumerate(self._swings.ways):
            if len(way) > 1:
                line = _marker(odometry.header.frame_id, SWINGS + number, Marker.LINE_STRIP, (1.0, 0.6, 0.1))
                line.points = [Point(*point) for point in way]
                line.scale.x = 0.01
                markers.append(line)
        self._markers.publish(MarkerArray(markers=markers))

    def _forces_of_feet(self) -> list[tuple[Place, Place]]:
        state = self._leg_state
        if self._legs is None or state is None or len(state.actual) != JOINTS:
            return []
        return load_arrows(np.array(self._legs.forward(np.array(state.actual))), state.bears, state.load)

    def _receive_legs(self, message: LegState) -> None:
        """Follows the swings here: a swing lasts few periods of the drawing. The joints of a brake want no place."""
        self._leg_state, odometry = message, self._odometry.message
        wanted = np.array(message.wanted)
        if self._legs is None or odometry is None or wanted.size != JOINTS or not np.isfinite(wanted).all():
            return
        places = in_odom(np.array(self._legs.forward(wanted)), odometry.pose.pose)
        self._swings.add(places, message.bears)

    def _text(self, frame: str, state: LegState | DriveState) -> Marker:
        safety = self._safety.message or SafetyStatus(speed_limit=float("inf"))
        limits = limits_of(state.reasons, state.sentences)
        said = status_text(safety.state_name, safety.sentences, safety.warning_sentences, limits, safety.speed_limit)
        text = _marker(frame, 0, Marker.TEXT_VIEW_FACING, said.colour)
        text.text = said.text
        text.pose.position.z = ABOVE
        text.scale.z = 0.09
        return text

    def _path_message(self, frame: str) -> Path:
        path = Path()
        path.header.frame_id = frame
        for x, y, z in self._trail.points:
            pose = PoseStamped(header=path.header)
            pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = x, y, z
            pose.pose.orientation.w = 1.0
            path.poses.append(pose)
        return path


def _marker(frame: str, number: int, kind: int, colour: tuple[float, float, float]) -> Marker:
    """A marker in the robot's axes; a stamp of zero stands for the robot's present place."""
    marker = Marker(id=number, type=kind, action=Marker.ADD)
    marker.header.frame_id, marker.ns = frame, "robot_control"
    marker.pose.orientation.w = 1.0
    marker.color.r, marker.color.g, marker.color.b, marker.color.a = *colour, 1.0
    marker.lifetime = rospy.Duration(1.0)
    return marker


def main() -> None:
    """Entry point of scripts/view_markers.py."""
    argparse.ArgumentParser(
        prog="view_markers.py",
        description="Publishes for RViz: forces of wheels or feet, paths of swinging feet, safety state and reasons as "
        "markers on view/markers; the path driven on view/path_driven. Started by view.launch.",
    ).parse_args(rospy.myargv()[1:])
    with running_node("view_markers") as signals:
        view = View()
        while signals.going_on():
            with boundary.crossing("what is drawn"):
                view.draw()
            rospy.rostime.wallsleep(PERIOD)
