#!/usr/bin/python3
"""A broker for trials of fleet.launch: mosquitto on the loopback, port 1883."""

import os

from robot_control.ui.program import run


def main() -> None:
    """Becomes the broker."""
    os.execv("/usr/sbin/mosquitto", ["mosquitto", "-p", "1883"])


run(main)
