#!/usr/bin/python3
"""Records every topic of the interface table with rosbag: record.py FOLDER."""

from robot_control.common.program import run
from robot_control.record.main import main

run(main)
