#!/usr/bin/python3
"""Drives the robot along the paths of the action follow_path; see --help."""

from robot_control.drive.follow_path.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
