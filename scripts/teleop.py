#!/usr/bin/python3
"""Drives the robot with the keyboard of a terminal, also over ssh and in tmux; see --help."""

from robot_control.common.program import run
from robot_control.teleop.main import main

if __name__ == "__main__":
    run(main)
