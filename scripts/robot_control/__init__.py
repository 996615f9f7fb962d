"""Motion control for mobile robots: the closed loop in one process, its estimator for recorded data, and what the
scripts are made of.
"""

from typing import Any

__all__ = ["ClosedLoop", "DriverError", "Estimator", "ParameterError", "RobotError"]


def __getattr__(name: str) -> Any:
    """Loads the compiled loop when it is asked for: the ROS scripts do without it."""
    if name == "ClosedLoop":
        from robot_control.closed_loop import ClosedLoop

        return ClosedLoop
    if name == "Estimator":
        from robot_control.offline_estimator import Estimator

        return Estimator
    if name in __all__:
        from robot_control import _robot_control

        return getattr(_robot_control, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
