"""identify.py beside a running robot: it measures, writes, and stops on request."""

import contextlib
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import rospy
import yaml
from system.system_support import (
    CONTROLLER,
    DRIVER,
    Program,
    RobotTestCase,
    again_after_a_stall,
    nightly,
    wait_for,
)

FRICTION = 0.1  # N·m, hidden in the plant
BEGINNING = 60.0
"""s; before it drives, identify.py loads numpy, reads all parameters and starts a telemetry of its own."""


class IdentifyTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.set_param(f"{DRIVER}/motor_friction", FRICTION)
        rospy.set_param(f"{DRIVER}/payload", 3.0)
        super().setUpClass()

    def setUp(self) -> None:
        super().setUp()
        folder = tempfile.TemporaryDirectory(prefix="identify-test-")
        self.addCleanup(folder.cleanup)
        self.output = Path(folder.name) / "identified.yaml"

    @contextlib.contextmanager
    def started(self, *arguments: str) -> Iterator[Program]:
        program = Program("identify.py", f"--output={self.output}", *arguments)
        try:
            with self.robot.silence():
                yield program
        finally:
            program.end()

    def refused(self, *arguments: str) -> str:
        """The message with which it refuses to begin."""
        start = self.robot.distance
        with self.started(*arguments) as program:
            self.assertEqual(program.wait(BEGINNING), 1, program.output)
            self.assertLess(abs(self.robot.distance - start), 0.005, "no motion")
            self.assertFalse(self.output.exists())
            return program.output

    def measured(self) -> str:
        """Runs it to its end; returns what it printed."""
        with self.started("--repeats=1") as program:
            self.assertEqual(program.wait(120.0), 0, program.output)
            return program.output

    @again_after_a_stall
    def test_measures_the_robot_and_writes_what_its_controller_takes(self) -> None:
        start = self.robot.distance
        words = self.measured()
        self.assertIn("inertia straight", words)
        forward = yaml.safe_load(self.output.read_text())["diff_drive_controller"]["feed_forward"]
        # The fit itself is judged in virtual time; a wrong column, sign or unit would appear here.
        self.assertAlmostEqual(forward["wheel_friction"], FRICTION, delta=0.2 * FRICTION)
        self.assertAlmostEqual(forward["mass"], 15.0, delta=0.2 * 15.0)
        self.assertLess(abs(self.robot.distance - start), 0.2, "it ends where it began")
        self.assertFalse(rospy.has_param("identify_telemetry"), "nothing of its own is left on the server")

        subprocess.run(["rosparam", "load", str(self.output)], check=True)
        self.addCleanup(rospy.delete_param, CONTROLLER)
        self.robot.restart(CONTROLLER)
        self.robot.release()
        line = "feed_forward/mass"
        wait_for("the override in its log", lambda: line in self.robot.nodes[CONTROLLER].output)
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    @nightly
    @again_after_a_stall
    def test_reads_the_log_of_a_telemetry_that_runs_already(self) -> None:
        telemetry = Program("telemetry", f"_directory:={self.output.parent}", "_record:=request")
        self.addCleanup(rospy.delete_param, "telemetry")
        self.addCleanup(telemetry.end)
        wait_for("its log", lambda: self.output.with_name("run.bag").exists())
        self.measured()
        self.assertTrue(telemetry.running)
        forward = yaml.safe_load(self.output.read_text())["diff_drive_controller"]["feed_forward"]
        self.assertAlmostEqual(forward["wheel_friction"], FRICTION, delta=0.2 * FRICTION)

    @contextlib.contextmanager
    def in_motion(self) -> Iterator[Program]:
        """A block in which it drives."""
        with self.started() as program:

            def moves() -> bool:
                self.assertTrue(program.running, program.output)
                return abs(self.robot.speed) > 0.1

            wait_for("motion", moves, limit=BEGINNING)
            yield program

    @again_after_a_stall
    def test_an_e_stop_ends_it_with_its_cause(self) -> None:
        with self.in_motion() as program:
            self.addCleanup(self.robot.send_e_stop, False)
            self.robot.send_e_stop(True)
            self.assertEqual(program.wait(), 1, program.output)
            self.assertIn("the robot is STOP", program.output)
            self.assertIn("e_stop_reset", program.output)
        self.assertFalse(self.output.exists())
        self.robot.send_e_stop(False)
        wait_for("the release of the topic", lambda: not self.robot.status.active)
        self.robot.release()

    @again_after_a_stall
    def test_ctrl_c_stops_the_robot(self) -> None:
        with self.in_motion() as program:
            program.send_signal(signal.SIGINT)
            self.assertEqual(program.wait(), 1, program.output)
            self.assertIn("interrupted", program.output)
            # This is well before cmd_vel_timeout ends, which would stop it, too: the zero has arrived.
            wait_for("rest", lambda: abs(self.robot.speed) < 0.01)
        self.assertFalse(self.output.exists())

    def test_refuses_beside_another_sender(self) -> None:
        sender = Program("send_cmd.py", "--linear=0", "--angular=0")
        self.addCleanup(sender.end)
        wait_for("the sender", lambda: "cmd_vel 1" in sender.output)
        self.assertIn("/send_cmd may also send on cmd_vel", self.refused())
