#!/usr/bin/python3
"""Leads through the first contact with a real robot on legs, and records a bag; see --help."""

from robot_control.setup.first_steps.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
