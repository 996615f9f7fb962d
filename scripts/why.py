#!/usr/bin/python3
"""Answers "why does it not move?" in one screen, live; see --help."""

from robot_control.ui.program import run
from robot_control.watch.why.main import main

if __name__ == "__main__":
    run(main)
