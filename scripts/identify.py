#!/usr/bin/python3
"""Measures a robot's wheels by driving it, and proposes feed-forward and gains; see --help."""

from robot_control.common.program import run
from robot_control.identify.main import main

if __name__ == "__main__":
    run(main)
