#!/usr/bin/python3
"""Shows and drives the robot in a browser; see --help."""

from robot_control.ui.program import run
from robot_control.watch.console.main import main

if __name__ == "__main__":
    run(main)
