#!/usr/bin/python3
"""One page and a verdict of a log: report.py run.bag."""

from robot_control.common.program import run
from robot_control.report.main import main

run(main)
