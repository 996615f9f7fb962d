#!/usr/bin/python3
"""Examines this machine and terminal for what disturbs the robot; see --help. ROS need not be sourced."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
for folder in (HERE.parent / "python", HERE.parent / "python3/dist-packages"):  # in the checkout, installed
    if (folder / "robot_control/setup/doctor").is_dir():
        sys.path.insert(0, str(folder))

from robot_control.setup.doctor.main import main  # noqa: E402
from robot_control.ui.program import run  # noqa: E402

if __name__ == "__main__":
    run(main)
