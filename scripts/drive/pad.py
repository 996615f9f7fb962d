#!/usr/bin/python3
"""Drives the robot with a game pad, at this machine or on the topic joy; see --help."""

from robot_control.drive.pad.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
