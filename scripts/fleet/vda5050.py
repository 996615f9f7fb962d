#!/usr/bin/python3
"""Lets a fleet's master command the robot over VDA 5050; see --help."""

from robot_control.common.program import run
from robot_control.fleet.main import main

if __name__ == "__main__":
    run(main)
