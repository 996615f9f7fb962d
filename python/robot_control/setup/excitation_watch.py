"""Decides before every command whether a robot that is being identified may go on; no ROS in here."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from robot_control.loop.roles import ESTIMATOR, MONITOR
from robot_control.robot.pose import Pose
from robot_control.robot.safety_states import DRIVABLE

SILENCE = 1.0
"""s without odometry or safety_status; each comes at least once per second, so a silent robot is not supervised"""
MARGIN = 0.1
"""m around the planned path: tracking, odometry and a late command"""
ANSWER = 2.0
"""s of requested motion after which a robot that stands has refused it"""
STANDING = 0.01
"""m/s and rad/s; a fifth of the slowest move"""


@dataclass(frozen=True)
class Observation:
    """The robot's present state; None stands for a message that was never received."""

    pose: Pose | None = None
    linear: float = 0.0  # m/s
    angular: float = 0.0  # rad/s
    pose_age: float = math.inf  # s
    state: str = ""  # of SafetyStatus; empty: never received
    status_age: float = math.inf  # s
    sentences: Sequence[str] = ()  # reasons why it is stopped
    missing: Sequence[str] = ()
    speed_limit: float = math.inf  # m/s
    senders: Sequence[str] = ()  # others on cmd_vel
    revoked: str = ""  # why what was requested does not begin, or go on


def moves(observed: Observation) -> bool:
    """True if it moves by odometry."""
    return abs(observed.linear) > STANDING or abs(observed.angular) > STANDING


def hindrance(observed: Observation) -> str:
    """Why the plan cannot begin; empty if it can."""
    if not observed.state:
        return f"no safety_status: does {MONITOR} run? Start the robot (roslaunch robot_control sim.launch) first"
    if observed.pose is None:
        return f"no odometry: does {ESTIMATOR} run? Start the robot first"
    if observed.senders:
        return f"{', '.join(observed.senders)} may also send on cmd_vel, and two senders would compete. Stop it first"
    if moves(observed):
        return f"the robot moves ({observed.linear:.2f} m/s, {observed.angular:.2f} rad/s); wait until it stands still"
    if math.isfinite(observed.speed_limit):
        what = f"the speed is limited to {observed.speed_limit:.2g} m/s by warnings or `clearance`"
        return f"{what}; the robot does not drive as planned. Check: rosrun robot_control why.py"
    return _stopped(observed)


def interruption(observed: Observation, start: Pose, reach: float, unanswered: float) -> str:
    """Why the plan must end now; empty if it goes on.

    Args:
        observed: now.
        start: where it began.
        reach: m, the plan's.
        unanswered: s of motion asked for since it moved last.
    """
    return unattended(observed) or _astray(observed, start, reach, unanswered)


def unattended(observed: Observation) -> str:
    """Why no robot may drive on, wherever it is; empty if it may."""
    return _unwatched(observed) or _stopped(observed)


def ignored(unanswered: float) -> str:
    """Why the plan must end after `unanswered` s of requested motion without any; empty if it goes on."""
    if unanswered <= ANSWER:
        return ""
    return (
        f"motion was requested for {unanswered:.0f} s, but the robot does not move; check: rosrun robot_control why.py"
    )


def _unwatched(observed: Observation) -> str:
    if observed.pose is None or observed.pose_age > SILENCE:
        return f"no odometry for {SILENCE:g} s: the position of the robot is unknown"
    if observed.status_age > SILENCE + 1.0:  # published once per second where nothing changes
        return f"no safety_status for {SILENCE + 1.0:g} s: {MONITOR} has ended, or its link is down"
    return ""


def _astray(observed: Observation, start: Pose, reach: float, unanswered: float) -> str:
    if observed.pose is None:
        return ""
    ahead, left = observed.pose.seen_from(start)
    if not (-MARGIN <= ahead <= reach + MARGIN and abs(left) <= MARGIN):
        what = f"the robot is {ahead:.2f} m ahead and {left:.2f} m to the left of its start"
        return f"{what}, beyond the plan's {reach:.2f} m ± {MARGIN:g} m"
    return ignored(unanswered)


def _stopped(observed: Observation) -> str:
    if observed.state in DRIVABLE:
        return observed.revoked and f"{observed.revoked}: start again"
    why = "; ".join(observed.sentences) or (
        f"waiting: {', '.join(observed.missing)}" if observed.missing else "no cause is reported"
    )
    remedy = "apply the remedy" if observed.state == "INIT" else "remove the cause, then rosservice call e_stop_reset"
    return f"the robot is {observed.state}: {why}; {remedy}"
