#!/usr/bin/python3
"""Says where a robot was, from a recording of its wheels and its IMU; see --help."""

from robot_control.common.program import run
from robot_control.estimate.main import main

if __name__ == "__main__":
    run(main)
