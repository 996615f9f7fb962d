#!/usr/bin/python3
"""Runs the laws of a log again and compares every bit of what they gave; see --help."""

from robot_control.common.program import run
from robot_control.replay.main import main

if __name__ == "__main__":
    run(main)
