#!/usr/bin/python3
"""Records every topic of the interface table with rosbag: record.py FOLDER."""

from robot_control.data.record.main import main
from robot_control.ui.program import run

run(main)
