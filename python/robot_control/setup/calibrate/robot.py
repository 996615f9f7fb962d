"""calibrate.py sees a running robot as identify.py does, and adds the wheels' path and the simulated truth."""

import numpy as np
from nav_msgs.msg import Odometry

from robot_control.robot.boundary import Latest, subscribe
from robot_control.robot.pose import FloatArray, Pose, pose_of
from robot_control.setup.moving_robot import RunningRobot


class CalibratedRobot(RunningRobot):
    """Receives wheel_odom as well."""

    def __init__(self, *, sends: bool = True) -> None:
        super().__init__(sends=sends)
        self.received = 0  # messages on wheel_odom
        self._path: list[tuple[float, float, float]] = []
        self._truth = Latest("ground_truth/odom", Odometry)
        subscribe("wheel_odom", Odometry, self._receive_wheels, queue_size=100, tcp_nodelay=True)

    def begin(self) -> None:
        """Begins a new path."""
        del self._path[:-1]

    def path(self) -> FloatArray:
        """(n, 3) m, m, rad: base by wheel odometry since `begin`."""
        return np.array(self._path[:])

    @property
    def wheels(self) -> Pose | None:
        """The present pose by wheel odometry."""
        return Pose(*self._path[-1]) if self._path else None

    @property
    def truth(self) -> Pose | None:
        """The true pose in simulation; None if it is not published."""
        return None if self._truth.message is None else pose_of(self._truth.message)

    def _receive_wheels(self, message: Odometry) -> None:
        pose = pose_of(message)
        self._path.append((pose.x, pose.y, pose.yaw))
        self.received += 1
