#!/usr/bin/python3
"""Turns a log of every cycle, run.bag, into a CSV, an MCAP or a bag of standard topics; see --help."""

from robot_control.common.program import run
from robot_control.export.main import main

if __name__ == "__main__":
    run(main)
