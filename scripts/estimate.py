#!/usr/bin/python3
"""Says where a robot was, from a recording of its wheels and its IMU; see --help."""

from robot_control.data.estimate.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
