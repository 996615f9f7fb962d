"""Decides before every command whether a robot that is being identified may go on; no ROS in here."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from robot_control.common.roles import ESTIMATOR, MONITOR
from robot_control.safety.states import DRIVABLE

SILENCE = 1.0
"""s without odometry or safety_status; each comes at least once per second, so a silent robot is not supervised"""
MARGIN = 0.1
"""m around the planned path: tracking, odometry and a late command"""
ANSWER = 2.0
"""s of requested motion after which a robot that stands has refused it"""
STANDING = 0.01
"""m/s and rad/s; a fifth of the slowest move"""


@dataclass(frozen=True)
class Pose:
    """Pose in odom."""

    x: float  # m
    y: float  # m
    yaw: float  # rad

    def seen_from(self, start: Pose) -> tuple[float, float]:
        """m ahead of and to the left of `start`."""
        dx, dy = self.x - start.x, self.y - start.y
        cosine, sine = math.cos(start.yaw), math.sin(start.yaw)
        return cosine * dx + sine * dy, cosine * dy - sine * dx


@dataclass(frozen=True)
class Look:
    """The robot's present state; None stands for a message that was never received."""

    pose: Pose | None
    linear: float  # m/s
    angular: float  # rad/s
    pose_age: float  # s
    state: str  # of SafetyStatus; empty: never received
    status_age: float  # s
    sentences: Sequence[str]  # reasons why it is stopped
    missing: Sequence[str]
    speed_limit: float  # m/s
    senders: Sequence[str]  # others on cmd_vel
    revoked: str = ""  # why what was requested does not begin, or go on


def moves(look: Look) -> bool:
    """True if it moves by odometry."""
    return abs(look.linear) > STANDING or abs(look.angular) > STANDING


def hindrance(look: Look) -> str:
    """Why the plan cannot begin; empty if it can."""
    if not look.state:
        return f"no safety_status: does {MONITOR} run? Start the robot (roslaunch robot_control sim.launch) first"
    if look.pose is None:
        return f"no odometry: does {ESTIMATOR} run? Start the robot first"
    if look.senders:
        return f"{', '.join(look.senders)} may send on cmd_vel, too: two senders would pull at one robot. End it first"
    if moves(look):
        return f"the robot moves ({look.linear:.2f} m/s, {look.angular:.2f} rad/s); wait until it stands"
    if math.isfinite(look.speed_limit):
        return (
            f"the speed is limited to {look.speed_limit:.2g} m/s by warnings or `clearance`; rosrun robot_control "
            "why.py says by which. What is limited is not driven as planned"
        )
    return _stopped(look)


def interruption(look: Look, start: Pose, reach: float, unanswered: float) -> str:
    """Why the plan must end now; empty if it goes on.

    Args:
        look: now.
        start: where it began.
        reach: m, the plan's.
        unanswered: s of motion asked for since it moved last.
    """
    return unattended(look) or _astray(look, start, reach, unanswered)


def unattended(look: Look) -> str:
    """Why no robot may drive on, wherever it is; empty if it may."""
    return _unwatched(look) or _stopped(look)


def ignored(unanswered: float) -> str:
    """Why the plan must end after `unanswered` s of requested motion without any; empty if it goes on."""
    if unanswered <= ANSWER:
        return ""
    return f"the robot was asked to move for {unanswered:.0f} s and stands; rosrun robot_control why.py says why"


def _unwatched(look: Look) -> str:
    if look.pose is None or look.pose_age > SILENCE:
        return f"no odometry for {SILENCE:g} s: the position of the robot is unknown"
    if look.status_age > SILENCE + 1.0:  # published once per second where nothing changes
        return f"no safety_status for {SILENCE + 1.0:g} s: {MONITOR} or its link is gone"
    return ""


def _astray(look: Look, start: Pose, reach: float, unanswered: float) -> str:
    if look.pose is None:
        return ""
    ahead, left = look.pose.seen_from(start)
    if not (-MARGIN <= ahead <= reach + MARGIN and abs(left) <= MARGIN):
        return (
            f"the robot is {ahead:.2f} m ahead and {left:.2f} m to the left of its start, beyond the plan's "
            f"{reach:.2f} m ± {MARGIN:g} m"
        )
    return ignored(unanswered)


def _stopped(look: Look) -> str:
    if look.state in DRIVABLE:
        return look.revoked and f"{look.revoked}: start again"
    why = "; ".join(look.sentences) or (
        f"waiting: {', '.join(look.missing)}" if look.missing else "no cause is reported"
    )
    remedy = "do what is named" if look.state == "INIT" else "remove the cause, then rosservice call e_stop_reset"
    return f"the robot is {look.state}: {why}; {remedy}"
