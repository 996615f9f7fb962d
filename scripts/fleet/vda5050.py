#!/usr/bin/python3
"""Lets a fleet's master command the robot over VDA 5050; see --help."""

from robot_control.fleet.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
