#!/usr/bin/python3
"""Brings runs, incidents and reports to a far side, and puts them together there; see --help."""

from robot_control.common.program import run
from robot_control.data_return.main import main

if __name__ == "__main__":
    run(main)
