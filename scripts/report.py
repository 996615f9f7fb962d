#!/usr/bin/python3
"""One page and a verdict of a log: report.py run.bag."""

from robot_control.data.report.main import main
from robot_control.ui.program import run

run(main)
