#!/usr/bin/python3
"""Publishes the robot's state for a host on one topic; see --help."""

import signal

signal.signal(signal.SIGINT, signal.SIG_DFL)  # until rospy takes it: roslaunch may end at once what it began

from robot_control.ui.program import run  # noqa: E402
from robot_control.watch.status.main import main  # noqa: E402

if __name__ == "__main__":
    run(main)
