#!/usr/bin/python3
"""Drives the robot with a game pad, at this machine or on the topic joy; see --help."""

from robot_control.common.program import run
from robot_control.pad.main import main

if __name__ == "__main__":
    run(main)
