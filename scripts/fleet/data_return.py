#!/usr/bin/python3
"""Brings runs, incidents and reports to a far side, and puts them together there; see --help."""

from robot_control.data.data_return.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
