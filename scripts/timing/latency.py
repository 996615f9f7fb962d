#!/usr/bin/python3
"""Shows how punctual the real-time threads are, live; see --help."""

from robot_control.ui.program import run
from robot_control.watch.latency.main import main

if __name__ == "__main__":
    run(main)
