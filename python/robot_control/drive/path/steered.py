"""A path that another program drives by velocities, as navigate does. It reads no clock and needs no ROS."""

from collections.abc import Callable

from robot_control.drive.path.follower import STAND, Follower, Motion, State
from robot_control.drive.path.pieces import Route
from robot_control.robot.pose import Pose

LATE = 0.3
"""s without a velocity after which the robot stands: three periods of navigate"""
SILENCE = 1.0
"""s without one after which the path ends"""


class Steered(Follower):
    """Passes velocities on. It ends by a jump of the pose or silence, as it ends by what is no matter of the path."""

    def __init__(self, route: Route, newest: Callable[[], tuple[Motion, float]]) -> None:
        """`newest`: the newest velocity and its age in s."""
        super().__init__(route)
        self._newest = newest

    def _begin(self, pose: Pose) -> None:  # noqa: ARG002 (a steered robot may be anywhere)
        self.state = State.DRIVING

    def _follow(self, pose: Pose, measured: Motion, limit: float, moved: Motion) -> Motion:  # noqa: ARG002
        motion, age = self._newest()
        if age > SILENCE:
            self.fail(f"no velocity for {SILENCE:g} s")
        return motion if age < LATE else STAND
