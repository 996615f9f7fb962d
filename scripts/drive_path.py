#!/usr/bin/python3
"""Drives the robot along a square, a circle, an eight or a path of a CSV file; see --help."""

from robot_control.common.program import run
from robot_control.path.main import main

if __name__ == "__main__":
    run(main)
