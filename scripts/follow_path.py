#!/usr/bin/python3
"""Drives the robot along the paths of the action follow_path; see --help."""

from robot_control.common.program import run
from robot_control.path.server import main

if __name__ == "__main__":
    run(main)
