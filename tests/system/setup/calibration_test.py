"""The calibration of state_estimator survives its end, and no other values replace it."""

import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import rospy
import yaml
from system.system_support import DRIVER, ESTIMATOR, RobotTestCase, refusal, wait_for

LEFT = 0.02
"""Relative error of the left radius, hidden in the plant: the ratio is 1/1.02"""


class CalibrationTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(tempfile.mkdtemp(prefix="calibration-test-"))
        cls.file = cls.folder / "learned.yaml"
        rospy.set_param(f"{DRIVER}/left_radius_error", LEFT)
        rospy.set_param(f"{DRIVER}/sensor_errors", "data_sheet")  # only the storage is judged, not the accuracy
        rospy.set_param(f"{ESTIMATOR}/calibration_file", str(cls.file))
        super().setUpClass()

    @classmethod
    def tearDownClass(cls) -> None:
        super().tearDownClass()
        rospy.delete_param(f"{DRIVER}/left_radius_error")
        rospy.delete_param(f"{DRIVER}/sensor_errors")
        rospy.delete_param(f"{ESTIMATOR}/calibration_file")
        shutil.rmtree(cls.folder)

    def reported(self, name: str) -> float:
        return float(self.robot.reports[ESTIMATOR].values.get(name, "nan"))

    def kept(self) -> dict[str, float]:
        return dict(yaml.safe_load(self.file.read_text())["calibration"])

    def await_known_gyro(self) -> None:
        """Stands until the bias is learned: at one speed it looks like unequal wheels, and neither is learned."""
        self.robot.await_rest()
        wait_for(
            "a rest in which the gyro's bias is learned",
            lambda: self.reported("gyro_bias_z_deviation_deg_s") < 0.1,
            every=lambda: self.robot.send(0, 0),
        )

    def wander(self, known: Callable[[], bool]) -> None:
        """Drives straight on and in curves by turns: one curve hardly separates unequal wheels from a wrong base."""
        for angular in (0.0, 0.8, 0.0, -0.8) * 10:
            end = time.monotonic() + 2.0
            self.robot.drive_until("two seconds", lambda end=end: time.monotonic() > end, angular=angular)
            if known():
                return
        raise AssertionError(f"learned too little: {self.robot.reports[ESTIMATOR]}")

    def start_estimator(self) -> None:
        self.robot.reports.clear()
        self.robot.start(ESTIMATOR)
        wait_for("its diagnostics", lambda: "radius_ratio" in self.robot.reports[ESTIMATOR].values)

    def test_what_was_learned_goes_on_after_a_restart_and_a_broken_file_refuses_it(self) -> None:
        self.assertFalse(self.file.exists())
        self.await_known_gyro()
        self.wander(lambda: self.reported("radius_ratio_deviation") < 0.002)
        self.robot.await_rest()
        self.assertEqual(self.robot.nodes[ESTIMATOR].end(), 0)
        kept = self.kept()
        self.assertAlmostEqual(kept["radius_ratio"], 1 / (1 + LEFT), delta=0.008)
        self.assertEqual(list(self.folder.iterdir()), [self.file], "no temporary file is left")

        self.robot.end()  # the shared memory with the last state is gone as well, so only the file remembers
        self.robot.start()
        self.robot.await_ready()
        self.assertIn("calibration of", self.robot.nodes[ESTIMATOR].output)
        wait_for("its diagnostics", lambda: abs(self.reported("radius_ratio") - kept["radius_ratio"]) < 0.001)
        self.assertLess(self.reported("radius_ratio_deviation"), 0.003)

        self.assertEqual(self.robot.nodes[ESTIMATOR].end(), 0)
        whole = self.file.read_text()
        self.file.write_text(whole.replace("wheel_base: 0.5", "wheel_base: 0.6"))
        words = refusal(ESTIMATOR)
        for part in (
            str(self.file),
            "calibration.wheel_base = 0.6",
            "0.5 holds here",
            "delete it to restart the calibration",
        ):
            self.assertIn(part, words)
        self.file.write_text(whole[: len(whole) // 2])
        self.assertIn("missing", refusal(ESTIMATOR))
        self.file.unlink()
        self.start_estimator()
        self.robot.release()
