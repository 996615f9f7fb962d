#!/usr/bin/python3
"""Turns the black box of a robot, the last minute before a crash, into a run.bag; see --help."""

from robot_control.data.blackbox.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
