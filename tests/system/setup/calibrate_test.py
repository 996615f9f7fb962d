"""calibrate.py beside a running robot: it measures, writes, and stops on request."""

import contextlib
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import rospy
import yaml
from system.system_support import (
    DRIVER,
    ESTIMATOR,
    Program,
    RobotTestCase,
    again_after_a_stall,
    nightly,
    wait_for,
)

HIDDEN = {"left_radius_error": 0.012, "right_radius_error": 0.004, "wheel_base_error": 0.02}
SHORT = ("--truth", "--yes", "--distance=1", "--repeats=1", "--side=1", "--runs=1", "--speed=0.5", "--turn-speed=1.2")


class CalibrateTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        for name, value in HIDDEN.items():
            rospy.set_param(f"{DRIVER}/{name}", value)
        super().setUpClass()

    @classmethod
    def tearDownClass(cls) -> None:
        super().tearDownClass()
        for name in HIDDEN:
            rospy.delete_param(f"{DRIVER}/{name}")

    def setUp(self) -> None:
        super().setUp()
        folder = tempfile.TemporaryDirectory(prefix="calibrate-test-")
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name) / "calibrated.yaml"

    @contextlib.contextmanager
    def started(self, *arguments: str) -> Iterator[Program]:
        with self.robot.silence():
            program = Program("calibrate.py", f"--out={self.out}", *arguments)
            try:
                yield program
            finally:
                program.end()

    def refused(self, *arguments: str) -> str:
        before = self.robot.joints.position
        with self.started(*arguments) as program:
            self.assertEqual(program.wait(60.0), 1, program.output)
            turned = max(abs(now - then) for now, then in zip(self.robot.joints.position, before, strict=True))
            self.assertLess(turned, 0.05, f"rad, no motion:\n{program.output}")
            self.assertFalse(self.out.exists())
            return program.output

    def measured(self) -> str:
        with self.started(*SHORT) as program:
            self.assertEqual(program.wait(150.0), 0, program.output)
            return program.output

    @nightly
    @again_after_a_stall
    def test_measures_the_hidden_wheels_and_writes_what_the_nodes_take(self) -> None:
        words = self.measured()
        for part in ("It needs 1.625 m ahead", "square 1 of 1, clockwise", "largest mean return error", "wrote"):
            self.assertIn(part, words)
        overlay = yaml.safe_load(self.out.read_text())
        # The fit itself is judged in virtual time, on 4 m.
        self.assertAlmostEqual(overlay["robot"]["wheel_radius"], 0.1008, delta=0.0003)
        self.assertAlmostEqual(overlay["robot"]["wheel_base"], 0.51, delta=0.004)
        self.assertAlmostEqual(overlay["state_estimator"]["radius_ratio"], 1.004 / 1.012, delta=0.002)

        subprocess.run(["rosparam", "load", str(self.out)], check=True)
        self.addCleanup(rospy.delete_param, "robot/wheel_radius")
        self.addCleanup(rospy.delete_param, "robot/wheel_base")
        self.addCleanup(rospy.delete_param, ESTIMATOR)
        self.robot.end()
        self.robot.start()
        self.robot.await_ready()
        self.assertIn("robot/wheel_radius", self.robot.nodes[ESTIMATOR].output)
        self.assertIn("radius_ratio", self.robot.nodes[ESTIMATOR].output)
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def test_ctrl_c_stops_the_robot(self) -> None:
        with self.started(*SHORT) as program:
            wait_for("motion", lambda: abs(self.robot.speed) > 0.1)
            program.send_signal(signal.SIGINT)
            self.assertEqual(program.wait(), 1, program.output)
            self.assertIn("interrupted", program.output)
            wait_for("rest", lambda: abs(self.robot.speed) < 0.01)
        self.assertFalse(self.out.exists())

    def test_asks_first_and_does_nothing_without_an_answer(self) -> None:
        words = self.refused("--truth")
        self.assertIn("The robot drives by itself and does not detect obstacles", words)
        self.assertIn("there is no terminal", words)
