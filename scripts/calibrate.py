#!/usr/bin/python3
"""Measures wheel radius, wheel base and the ratio of the radii by tape: a wizard; see --help."""

from robot_control.setup.calibrate.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
