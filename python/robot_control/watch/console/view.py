"""Messages of the robot → what the page shows; plain values for JSON, in which a number that is not finite is null."""

import dataclasses
import math
import time
from typing import Any

from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry, Path
from sensor_msgs.msg import JointState

from robot_control.files.json_values import finite
from robot_control.msg import DriveState, FollowPathActionFeedback, LegState, RobotStatus
from robot_control.robot.boundary import Latest, subscribe
from robot_control.robot.command import Command
from robot_control.robot.diagnosis.diagnosis import judge, missing_nodes
from robot_control.robot.diagnosis.listener import speeds_of
from robot_control.robot.diagnosis.state import Facts
from robot_control.robot.pose import pose_of
from robot_control.robot.view import SILENCES
from robot_control.watch.console.navigation import NavigationView
from robot_control.watch.scene import Trail

MAX_PATH = 2000
"""Points of a wanted path that are sent; a longer path is thinned evenly."""
PROGRESS = ("state", "reason", "progress", "remaining_distance", "cross_track_error")

Values = dict[str, Any]


class View:
    """The newest messages of the robot."""

    def __init__(self) -> None:
        self.trail = Trail()
        self._topics = {
            "odom": Latest("odom", Odometry),
            "limited": Latest("cmd_vel_out", TwistStamped),
            "truth": Latest("ground_truth/odom", Odometry),
            "joints": Latest("joint_states", JointState),
            "drive": Latest("drive_state", DriveState),
            "legs": Latest("leg_state", LegState),
            "feedback": Latest("follow_path/feedback", FollowPathActionFeedback),
        }
        self.navigation = NavigationView(self._topics["odom"])
        self.wanted: tuple[float, Values] = -math.inf, {}
        """when the path wanted was received, s, monotonic, and the path"""
        subscribe("path_wanted", Path, self._receive_wanted, queue_size=1)
        self._status = Latest("robot_status", RobotStatus)

    def revoked(self, node: str) -> bool:
        """True if the controller refuses what the node requested before a stop."""
        states = [self._topics[name].fresh(time.monotonic(), SILENCES["drive_state"]) for name in ("drive", "legs")]
        return any(state is not None and node in state.revoked for state in states)

    def pose(self) -> tuple[float, float, float] | None:
        """x, y [m], yaw [rad] in odom."""
        odometry = self._topics["odom"].message
        return None if odometry is None else _pose(odometry)

    def _receive_wanted(self, message: Path) -> None:
        poses = message.poses[:: max(1, math.ceil(len(message.poses) / MAX_PATH))]
        points = [(each.pose.position.x, each.pose.position.y) for each in poses]
        values = rounded({"type": "wanted", "frame": message.header.frame_id, "points": points})
        self.wanted = time.monotonic(), values

    def fast(self, asked: Command | None) -> Values:
        """The values of a frame; `asked` is the last command of this console."""
        now = time.monotonic()
        newest = {name: topic.message for name, topic in self._topics.items()}
        odometry, truth, joints, drive, legs = (newest[name] for name in ("odom", "truth", "joints", "drive", "legs"))
        values: Values = {
            "type": "fast",
            "ages": {name: topic.age(now) for name, topic in self._topics.items()},
            "asked": None if asked is None else [asked.linear, asked.angular, asked.lateral],
            "limited": None if newest["limited"] is None else speeds_of(newest["limited"].twist),
            "joints": {} if joints is None else dict(zip(joints.name, joints.position, strict=False)),
        }
        if odometry is not None:
            pose, covariance = _pose(odometry), odometry.pose.covariance
            self.trail.add(pose[0], pose[1])
            values |= {"pose": pose, "measured": speeds_of(odometry.twist.twist)}
            values["covariance"] = (covariance[0], covariance[1], covariance[7])
        if truth is not None:
            values |= {"truth": _pose(truth), "true": speeds_of(truth.twist.twist)}
        if drive is not None:
            rows = zip(drive.name, drive.error, drive.effort, strict=False)
            values["driven"] = [{"name": name, "error": error, "effort": effort} for name, error, effort in rows]
        if legs is not None:
            values["legs"] = legs_of(legs)
            values["driven"] = [
                {"name": name, "error": wanted - actual, "effort": effort}
                for name, wanted, actual, effort in zip(legs.name, legs.wanted, legs.actual, legs.effort, strict=False)
            ]
        return rounded(values)

    def slow(self, facts: Facts) -> Values:
        """The values that change rarely: state, causes, remedies, senders."""
        answer, safety, estimator = judge(facts), facts.received(), facts.kind.estimator
        drive, legs = (self._topics[name].message for name in ("drive", "legs"))
        feedback, revoked, status = self._topics["feedback"], drive or legs, self._status.message
        way = None if feedback.message is None else feedback.message.feedback
        progress = {} if way is None else {name: getattr(way, name) for name in PROGRESS}
        return rounded(
            {
                "type": "slow",
                "master": facts.master_answers,
                "verdict": answer.verdict.value,
                "headline": answer.headline,
                "actions": answer.actions,
                "commands": answer.commands,
                "missing": missing_nodes(facts),
                "nodes": {node: facts.there(node) for node in facts.loop},
                "senders": facts.commanders(),
                "limits": list(facts.reasons(facts.controller, "command").values()),
                "odometry": [text for of in ("slip", "estimate") for text in facts.reasons(estimator, of).values()],
                "faults": facts.value(facts.driver, "injected"),
                "components": facts.kind.fault_components,
                "kinds": facts.kind.fault_kinds,
                "simulated": bool(facts.kind.fault_components) and facts.there(facts.driver),
                "paused": facts.value(facts.driver, "driver_state") == "paused",
                "safety": None if safety is None else dataclasses.asdict(safety),
                "sources": [] if drive is None else drive.sources,
                "revoked": [] if revoked is None else revoked.revoked,
                "legged": facts.kind.legged,
                "data_return": "" if status is None else status.data_return,
                "navigation": self.navigation.values(),
                "goal": facts.value("navigate", "goal"),
                "path": {"age": feedback.age(time.monotonic()), **progress},
            }
        )


def _pose(odometry: Odometry) -> tuple[float, float, float]:
    pose = pose_of(odometry)
    return pose.x, pose.y, pose.yaw


def legs_of(message: LegState) -> Values:
    """Posture, gait and feet."""
    feet = zip(message.foot, message.bears, message.load, strict=False)
    return {
        "posture": message.posture,
        "gait": message.gait,
        "chosen": message.chosen_gait,
        "gaits": list(message.gaits),
        "feet": [{"name": name, "bears": bool(bears), "load": load} for name, bears, load in feet],
    }


def rounded(values: Values) -> Values:
    """The same with null for numbers that are not finite, and five decimals."""
    return {key: finite(value, digits=5) for key, value in values.items()}
