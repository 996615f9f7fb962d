"""Motion control for mobile robots: the closed loop in one process, and what the scripts are made of."""

from typing import Any

__all__ = ["ClosedLoop", "DriverError", "ParameterError", "RobotError"]


def __getattr__(name: str) -> Any:
    """Loads the compiled loop when it is asked for: the ROS scripts do without it."""
    if name == "ClosedLoop":
        from robot_control.closed_loop import ClosedLoop

        return ClosedLoop
    if name in __all__:
        from robot_control import _robot_control

        return getattr(_robot_control, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
