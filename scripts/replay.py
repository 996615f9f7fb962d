#!/usr/bin/python3
"""Runs the laws of a log again and compares every bit of what they gave; see --help."""

from robot_control.data.replay.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
