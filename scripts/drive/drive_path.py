#!/usr/bin/python3
"""Drives the robot along a square, a circle, an eight or a path of a CSV file; see --help."""

from robot_control.drive.drive_path.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
