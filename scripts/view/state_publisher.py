#!/usr/bin/python3
"""Publishes the transforms inside the robot as soon as there is a robot_description."""

import signal

signal.signal(signal.SIGINT, signal.SIG_DFL)  # until rospy takes it: roslaunch may end at once what it began

from robot_control.ui.program import run  # noqa: E402
from robot_control.watch.view.state_publisher import main  # noqa: E402

if __name__ == "__main__":
    run(main)
