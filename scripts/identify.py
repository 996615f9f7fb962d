#!/usr/bin/python3
"""Measures a robot's wheels by driving it, and proposes feed-forward and gains; see --help."""

from robot_control.setup.identify.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
