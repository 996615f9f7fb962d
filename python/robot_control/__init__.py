"""Motion control for mobile robots: the closed loop in one process, its estimator for recorded data, and what the
scripts are made of.
"""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robot_control._robot_control import DriverError, ParameterError, RobotError
    from robot_control.loop.closed_loop import ClosedLoop
    from robot_control.loop.closed_loops import ClosedLoops
    from robot_control.loop.estimator import Estimator

__all__ = ["ClosedLoop", "ClosedLoops", "DriverError", "Estimator", "ParameterError", "RobotError"]


def __getattr__(name: str) -> Any:
    """Loads the compiled loop when it is asked for: the ROS scripts do without it."""
    try:
        return _load(name)
    except ModuleNotFoundError as error:
        if error.name != "robot_control._robot_control":
            raise
        raise ImportError(_without_its_compiled_part()) from error


def _without_its_compiled_part() -> str:
    here = Path(__file__).resolve().parent
    built = sorted(here.glob("_robot_control.*.so"))
    if built:
        return (
            f"robot_control.{built[0].name} in {here} is not for this Python {sys.version_info[0]}."
            f"{sys.version_info[1]}, {sys.executable}: call /usr/bin/python3, for which ROS is built"
        )
    what = f"the compiled part of robot_control is not in {here}: build it"
    return f"{what} (scripts/demo or colcon build in the checkout), then `source install/setup.bash` in this terminal"


def _load(name: str) -> Any:
    if name == "ClosedLoop":
        from robot_control.loop.closed_loop import ClosedLoop

        return ClosedLoop
    if name == "ClosedLoops":
        from robot_control.loop.closed_loops import ClosedLoops

        return ClosedLoops
    if name == "Estimator":
        from robot_control.loop.estimator import Estimator

        return Estimator
    if name in __all__:
        from robot_control import _robot_control

        return getattr(_robot_control, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
