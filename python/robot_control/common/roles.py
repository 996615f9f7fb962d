"""The programs of the loop, by role (signals/roles.h). A program names its node and its block of parameters alike."""

from robot_control._robot_control import signal_names

DRIVER, ESTIMATOR, CONTROLLER, MONITOR, TELEMETRY = (program for _, program in signal_names["Role"])
LOOP = (DRIVER, ESTIMATOR, CONTROLLER, MONITOR)
HARDWARE_DRIVER = "driver"
"""The program of every driver but the simulator's."""
