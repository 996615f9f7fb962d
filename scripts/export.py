#!/usr/bin/python3
"""Turns a log of every cycle, run.bag, into a CSV, an MCAP or a bag of standard topics; see --help."""

from robot_control.data.export.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
