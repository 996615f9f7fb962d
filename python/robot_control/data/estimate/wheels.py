"""Converts another program's odometry into wheel angles."""

import numpy as np

from robot_control.data.estimate.samples import FloatArray, Robot, Stream
from robot_control.robot.pose import arcs_between

STILL = 1e-6
"""m, rad: a pose that stays so close to its first value was never filled in"""


def wheel_angles(odometry: Stream, robot: Robot, source: str | None) -> tuple[FloatArray, str]:
    """Angles (n, 2) [rad] of the left and the right wheel, as their joints would report them, and the source in words.

    base_link moves by `forward` [m] and `turn` [rad] in a step. The left and right wheels then travel forward − turn ·
    axle_y ∓ turn · base / 2. Between two poses with the chord c, forward is
    c · (turn/2) / sin(turn/2). Its sign is that of c along the mean heading. A twist gives both by its trapezoid.

    Args:
        odometry: columns x, y [m], yaw [rad], linear [m/s], angular [rad/s], increasing in time.
        robot: its wheel base and radii, which must be those that the odometry was computed with.
        source: "pose", "twist", or None: the pose where it ever moves.
    """
    x, y, yaw, linear, angular = odometry.values.T
    yaw = np.unwrap(yaw)
    moved = np.ptp(x) > STILL or np.ptp(y) > STILL or np.ptp(yaw) > STILL
    used = source or ("pose" if moved else "twist")
    if used == "pose":
        forward, turn = arcs_between(x, y, yaw)
    else:
        dt = np.diff(odometry.time_ns) / 1e9
        forward = (linear[:-1] + linear[1:]) / 2 * dt
        turn = (angular[:-1] + angular[1:]) / 2 * dt
    return np.column_stack([_angle(robot, side, forward, turn) for side in ("left", "right")]), used


def _angle(robot: Robot, side: str, forward: FloatArray, turn: FloatArray) -> FloatArray:
    wheels = [wheel for wheel in robot["wheels"] if wheel["side"] == side]
    axle_y = float(np.mean([wheel["centre"][1] for wheel in robot["wheels"]]))
    radius = float(np.mean([wheel["radius"] for wheel in wheels]))
    out = (-1 if side == "left" else 1) * robot["effective_wheel_base"] / 2
    travel = np.concatenate([[0.0], np.cumsum(forward - turn * axle_y + turn * out)])
    return np.asarray(travel * wheels[0]["sign"] / radius)
