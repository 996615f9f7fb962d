#!/usr/bin/python3
"""Finds the zeros and the signs of the joints of a robot, by hand and in a known posture; see --help."""

from robot_control.setup.zero_joints.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
