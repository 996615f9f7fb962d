#!/usr/bin/python3
"""A small master for VDA 5050: sends a square, prints what comes back; see --help."""

from robot_control.fleet.master import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
