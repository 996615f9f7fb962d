"""Messages of the robot → what the page shows; plain values for JSON, in which a number that is not finite is null."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from typing import Any

from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry, Path
from sensor_msgs.msg import JointState

from robot_control.common.command import Command
from robot_control.common.roles import CONTROLLER, DRIVER, ESTIMATOR, LOOP
from robot_control.console.topics import Latest
from robot_control.msg import DriveState, FollowPathActionFeedback
from robot_control.path.robot import pose_of
from robot_control.view.scene import Trail
from robot_control.why.diagnosis import Facts, judge, missing_nodes

MAX_PATH = 2000
"""points of a wanted path that are sent; of a longer one every n-th"""

Values = dict[str, Any]


class View:
    """All that is known of the robot."""

    def __init__(self) -> None:
        self.trail = Trail()
        self._topics = {
            "odom": Latest("odom", Odometry),
            "limited": Latest("cmd_vel_out", TwistStamped),
            "truth": Latest("ground_truth/odom", Odometry),
            "joints": Latest("joint_states", JointState),
            "drive": Latest("drive_state", DriveState),
            "feedback": Latest("follow_path/feedback", FollowPathActionFeedback),
        }
        self._wanted = Latest("path_wanted", Path)

    @property
    def drive_state(self) -> DriveState | None:
        """The newest one."""
        message: DriveState | None = self._topics["drive"].message
        return message

    @property
    def drive_is_fresh(self) -> bool:
        """True if the newest drive_state is no older than a second."""
        return time.monotonic() - self._topics["drive"].received_at < 1.0

    def pose(self) -> tuple[float, float, float] | None:
        """x, y [m], yaw [rad] in odom."""
        odometry = self._topics["odom"].message
        return None if odometry is None else _pose(odometry)

    def wanted(self) -> tuple[float, Values]:
        """When the wanted path was received, and the path."""
        message = self._wanted.message
        points = [] if message is None else [(each.pose.position.x, each.pose.position.y) for each in message.poses]
        step = max(1, math.ceil(len(points) / MAX_PATH))
        frame = "" if message is None else message.header.frame_id
        return self._wanted.received_at, {"type": "wanted", "frame": frame, "points": finite(points[::step])}

    def fast(self, asked: Command | None) -> Values:
        """The values of every frame; `asked` by this console."""
        now = time.monotonic()
        odometry, truth, joints, limited = (self._topics[n].message for n in ("odom", "truth", "joints", "limited"))
        values: Values = {
            "type": "fast",
            "ages": {name: topic.age(now) for name, topic in self._topics.items()},
            "asked": None if asked is None else [asked.linear, asked.angular],
            "limited": None if limited is None else [limited.twist.linear.x, limited.twist.angular.z],
            "joints": {} if joints is None else dict(zip(joints.name, joints.position, strict=False)),
        }
        if odometry is not None:
            pose, covariance, twist = _pose(odometry), odometry.pose.covariance, odometry.twist.twist
            self.trail.add(pose[0], pose[1])
            values |= {"pose": pose, "measured": (twist.linear.x, twist.angular.z)}
            values["covariance"] = (covariance[0], covariance[1], covariance[7])
            values["attitude"] = _quaternion(odometry)
        if truth is not None:
            values |= {"truth": _pose(truth), "true": (truth.twist.twist.linear.x, truth.twist.twist.angular.z)}
        drive = self.drive_state
        if drive is not None:
            rows = zip(drive.name, drive.wanted, drive.actual, drive.error, drive.effort, strict=False)
            values["wheels"] = [
                dict(zip(("name", "wanted", "actual", "error", "effort"), r, strict=True)) for r in rows
            ]
        return _finite_map(values)

    def slow(self, facts: Facts) -> Values:
        """The values that change now and then: state, causes, remedies, who commands."""
        answer, safety, now = judge(facts), facts.received(), time.monotonic()
        drive, feedback = self.drive_state, self._topics["feedback"].message
        values: Values = {
            "type": "slow",
            "namespace": facts.namespace,
            "master": facts.master if facts.master_answers else "",
            "verdict": answer.verdict.value,
            "headline": answer.headline,
            "actions": answer.actions,
            "commands": answer.commands,
            "missing": missing_nodes(facts),
            "nodes": {node: facts.there(node) for node in LOOP},
            "senders": facts.commanders(),
            "reasons": list(facts.reasons(CONTROLLER, "command").values()),
            "estimate": [*facts.reasons(ESTIMATOR, "slip").values(), *facts.reasons(ESTIMATOR, "estimate").values()],
            "faults": facts.value(DRIVER, "injected"),
            "simulated": facts.there(DRIVER),
            "paused": facts.value(DRIVER, "driver_state") == "paused",
            "safety": None if safety is None else _safety(safety),
            "sources": [] if drive is None else list(drive.sources),
            "revoked": [] if drive is None else list(drive.revoked),
            "path": None if feedback is None else _progress(feedback, self._topics["feedback"].age(now)),
        }
        return _finite_map(values)


def _safety(safety: Any) -> Values:  # noqa: ANN401 (diagnosis.Safety)
    names = ("sentence", "detail", "remedy", "actor", "first", "active")
    return {
        "state": safety.state,
        "permit": safety.permit,
        "held": safety.held,
        "age": safety.age,
        "causes": [{name: getattr(cause, name) for name in names} for cause in safety.causes],
        "warnings": safety.warnings,
        "speed_limit": safety.speed_limit,
        "refusal": safety.refusal,
    }


def _progress(message: FollowPathActionFeedback, age: float | None) -> Values:
    names = ("state", "reason", "progress", "distance", "remaining_distance", "cross_track_error")
    return {"age": age, **{name: getattr(message.feedback, name) for name in names}}


def _pose(odometry: Odometry) -> tuple[float, float, float]:
    pose = pose_of(odometry)
    return pose.x, pose.y, pose.yaw


def _quaternion(odometry: Odometry) -> tuple[float, float, float, float]:
    orientation = odometry.pose.pose.orientation
    return orientation.x, orientation.y, orientation.z, orientation.w


def finite(value: Any) -> Any:  # noqa: ANN401 (any value of JSON)
    """The same with null for numbers that are not finite, and five decimals."""
    if isinstance(value, float):
        return round(value, 5) if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(each) for key, each in value.items()}
    if isinstance(value, str) or not isinstance(value, Iterable):
        return value
    return [finite(each) for each in value]


def _finite_map(values: Values) -> Values:
    checked: Values = finite(values)
    return checked
