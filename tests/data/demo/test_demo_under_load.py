"""scripts/demo, built, on a machine whose processors have twenty times more to do than they can."""

import os
import socket
import subprocess
import sys
import time

import numpy as np
import pytest
from robot_control.data.run_log import read_log

RUNS, LOAD = 20, 40
SLOWER = 10.0
"""times the duration on the machine as it was, at most"""
MOTION = ("cycle", "truth_x", "truth_y", "truth_yaw", "estimate_x", "left_wheel_joint_effort", "gate_verdict")
BUSY = "while True: pass"


def demo(folder):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    environment = {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    command = [sys.executable, "-m", "robot_control.data.demo.main", "--seconds", "2", "--out", str(folder)]
    began = time.monotonic()
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return time.monotonic() - began, read_log(folder / "run.bag", MOTION)


@pytest.mark.nightly
def test_a_busy_machine_makes_the_demo_slower_and_changes_no_row_of_motion(tmp_path):
    idle, rows = demo(tmp_path / "idle")
    busy = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(LOAD)]
    try:
        for run in range(RUNS):
            took, found = demo(tmp_path / "busy")
            print(f"run {run}: {took:.0f} s, {took / idle:.1f} times {idle:.0f} s")
            assert took <= SLOWER * idle
            for name in MOTION:
                np.testing.assert_array_equal(found[name], rows[name], err_msg=name)
    finally:
        for each in busy:
            each.kill()
            each.wait()
