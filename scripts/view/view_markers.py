#!/usr/bin/python3
"""Shows in RViz, beside model and odometry: wheel forces, safety state, reasons, the path driven; see --help."""

from robot_control.ui.program import run
from robot_control.watch.view.main import main

if __name__ == "__main__":
    run(main)
