"""Messages of the robot → what the page shows; plain values for JSON, in which a number that is not finite is null."""

import dataclasses
import math
import time
from typing import Any

from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry, Path
from sensor_msgs.msg import BatteryState, JointState

from robot_control.files.json_values import finite
from robot_control.msg import DriveState, FollowPathActionFeedback, LegState, RobotStatus
from robot_control.robot.boundary import Latest, boundary, subscribe
from robot_control.robot.diagnosis.diagnosis import MOVING, judge, missing_nodes
from robot_control.robot.diagnosis.listener import speeds_of
from robot_control.robot.diagnosis.state import Facts, Speeds
from robot_control.robot.pose import pose_of, rotation, rpy
from robot_control.robot.view import SILENCES
from robot_control.watch.console.navigation import NavigationView
from robot_control.watch.console.requests import Requests
from robot_control.watch.scene import Trail

MAX_PATH = 2000
"""Points of a wanted path that are sent; a longer path is thinned evenly."""
SILENCE = 1.0
"""s after which the values of a topic are no longer shown: what is dead is a gap"""
BROKEN = 10.0
"""s for which a source is named of which a message was dropped"""
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
            "battery": Latest("battery_state", BatteryState),
        }
        self._requests = Requests()
        self._asked: tuple[Speeds, str] | None = None
        self._dropped: dict[str, tuple[int, float]] = {}  # source → messages dropped, and when the last one was
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

    def fast(self) -> Values:
        """The values of a frame; what a silent topic said last is not among them."""
        now = time.monotonic()
        newest = {name: topic.newest for name, topic in self._topics.items()}
        fresh: Values = {name: message if now - at < SILENCE else None for name, (message, at) in newest.items()}
        odometry, truth, joints, drive, legs = (fresh[name] for name in ("odom", "truth", "joints", "drive", "legs"))
        listed = drive is not None and bool(drive.sources)
        self._asked = self._requests.in_force(drive.commander if listed else None)
        values: Values = {
            "type": "fast",
            "ages": {name: None if message is None else round(now - at, 2) for name, (message, at) in newest.items()},
            "asked": None if self._asked is None else self._asked[0],
            "limited": None if fresh["limited"] is None else speeds_of(fresh["limited"].twist),
            "joints": {} if joints is None else dict(zip(joints.name, joints.position, strict=False)),
        }
        if odometry is not None:
            pose, covariance = six_of(odometry), odometry.pose.covariance
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
        estimator = facts.kind.estimator
        now, asked = time.monotonic(), self._asked
        moves = asked is not None and max(map(abs, asked[0])) > MOVING
        battery = self._topics["battery"].fresh(now, BROKEN)
        drive, legs = (self._topics[name].message for name in ("drive", "legs"))
        feedback, revoked, status = self._topics["feedback"], drive or legs, self._status.message
        way = None if feedback.message is None else feedback.message.feedback
        progress = {} if way is None else {name: getattr(way, name) for name in PROGRESS}
        return rounded(
            {
                **state_of(facts),
                "nodes": {node: facts.there(node) for node in facts.loop},
                "asked_by": "" if asked is None else asked[1],
                "limits": list(facts.reasons(facts.controller, "command").values()) if moves else [],
                "broken": self._broken(now),
                "battery": None if battery is None else (battery.percentage, battery.voltage),
                "odometry": [text for of in ("slip", "estimate") for text in facts.reasons(estimator, of).values()],
                "faults": facts.value(facts.driver, "injected"),
                "components": facts.kind.fault_components,
                "kinds": facts.kind.fault_kinds,
                "simulated": bool(facts.kind.fault_components) and facts.there(facts.driver),
                "paused": facts.value(facts.driver, "driver_state") == "paused",
                "sources": [] if drive is None else drive.sources,
                "revoked": [] if revoked is None else revoked.revoked,
                "data_return": "" if status is None else status.data_return,
                "navigation": self.navigation.values(),
                "goal": facts.value("navigate", "goal"),
                "path": {"age": feedback.age(now), **progress},
            }
        )

    def _broken(self, now: float) -> dict[str, int]:
        """Source → number of its messages that could not be used, where the last one was lately."""
        for source, count in dict(boundary.dropped).items():
            if self._dropped.get(source, (0, 0.0))[0] != count:
                self._dropped[source] = count, now
        return {source: count for source, (count, at) in self._dropped.items() if now - at < BROKEN}


def state_of(facts: Facts) -> Values:
    """The answer of why.py, in its parts for the operator and for the integrator, and the state of the monitor."""
    answer, safety = judge(facts), facts.received()
    return {
        "type": "slow",
        "master": facts.master_answers,
        "verdict": answer.verdict.value,
        "headline": answer.headline,
        "sentence": answer.sentence,
        "steps": answer.steps,
        "integrator": answer.integrator,
        "commands": answer.commands,
        "missing": missing_nodes(facts),
        "senders": facts.commanders(),
        "safety": None if safety is None else dataclasses.asdict(safety),
        "legged": facts.kind.legged,
    }


def _pose(odometry: Odometry) -> tuple[float, float, float]:
    pose = pose_of(odometry)
    return pose.x, pose.y, pose.yaw


def six_of(odometry: Odometry) -> tuple[float, ...]:
    """x, y, z [m], roll, pitch, yaw [rad]."""
    at, q = odometry.pose.pose.position, odometry.pose.pose.orientation
    return at.x, at.y, at.z, *rpy(rotation((q.x, q.y, q.z, q.w)))


def legs_of(message: LegState) -> Values:
    """Posture, gait, ground and feet."""
    names = ("name", "bears", "load", "met_riser", "reaching")
    feet = zip(message.foot, message.bears, message.load, message.met_riser, message.reaching, strict=False)
    return {
        "slope": (message.slope_ahead, message.slope_left),
        "posture": message.posture,
        "gait": message.gait,
        "chosen": message.chosen_gait,
        "gaits": list(message.gaits),
        "feet": [dict(zip(names, foot, strict=True)) for foot in feet],
    }


def rounded(values: Values) -> Values:
    """The same with null for numbers that are not finite, and five decimals."""
    return {key: finite(value, digits=5) for key, value in values.items()}
