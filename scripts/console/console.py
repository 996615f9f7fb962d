#!/usr/bin/python3
"""Shows and drives the robot in a browser; see --help."""

from robot_control.common.program import run
from robot_control.console.main import main

if __name__ == "__main__":
    run(main)
