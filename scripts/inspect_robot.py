#!/usr/bin/python3
"""Says what is understood of a robot description: inspect_robot.py FILE [--picture OUT.png] [--mjcf OUT.xml]."""

from robot_control.common.program import run
from robot_control.inspect.main import main

run(main)
