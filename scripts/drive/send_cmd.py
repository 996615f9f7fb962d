#!/usr/bin/python3
"""Repeats one velocity command on cmd_vel: 0.5 m/s and 0.2 rad/s every 0.5 s; see --help."""

from robot_control.drive.send_cmd.main import main
from robot_control.ui.program import run

if __name__ == "__main__":
    run(main)
