#!/usr/bin/python3
"""Adds, lists and removes the users of console.py; see --help."""

from robot_control.ui.program import run
from robot_control.watch.console.accounts import main

if __name__ == "__main__":
    run(main)
