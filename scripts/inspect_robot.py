#!/usr/bin/python3
"""Says what is understood of a robot description: inspect_robot.py FILE [--picture OUT.png] [--mjcf OUT.xml]."""

from robot_control.setup.inspect.main import main
from robot_control.ui.program import run

run(main)
