#!/usr/bin/python3
"""Drives the robot with the keyboard of a terminal, also over ssh and in tmux; see --help."""

from robot_control.drive.teleop.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
