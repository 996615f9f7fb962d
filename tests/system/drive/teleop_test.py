"""teleop.py in a pseudo-terminal, beside a running robot: keys move it, and every end of the keys stops it."""

import math
import signal
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np
import roslib.packages
import rospy
from robot_control.data.run_log import read_log
from robot_control.drive.keys.operator import RESET_PAUSE
from std_msgs.msg import Empty
from system.pseudo_terminal import PseudoTerminal
from system.system_support import Program, RobotTestCase, nightly, wait_for

PRESSES = 11
LATENCY = 0.3
"""s, median; ten times what is promised, and the machine is busy"""


class TeleopTest(RobotTestCase):
    def setUp(self) -> None:
        self.robot.await_ready()
        self.terminal = self.started()

    def started(self, *arguments: str) -> PseudoTerminal:
        """Starts it and waits until it shows that the robot may move."""
        self.robot.await_rest()
        terminal = PseudoTerminal([roslib.packages.find_node("robot_control", "teleop.py")[0], *arguments])
        self.addCleanup(terminal.end)
        wait_for("its screen", lambda: "Ready: hold a key" in terminal.screen, every=self.robot.release_after_a_stall)
        return terminal

    def drive(self) -> None:
        """Holds w until the robot drives, and again after each stop of a stalling machine."""
        end = time.monotonic() + 60.0
        while not self.robot.driving():
            self.assertLess(time.monotonic(), end, self.terminal.screen)
            self.robot.release_after_a_stall()
            self.terminal.hold("w", 5.0, until=lambda: self.robot.driving() or bool(self.robot.causes))
            if not self.robot.driving():
                time.sleep(1.0)  # a key that was held during a stop counts after its release

    def await_rest(self) -> None:
        """Waits for rest without sending anything."""
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01)

    def test_a_held_key_drives_and_its_release_stops(self) -> None:
        self.drive()
        self.assertIn("DRIVE", self.terminal.screen)
        self.await_rest()
        wait_for(
            "its words", lambda: "no command is sent on /cmd_vel_stamped" in " ".join(self.terminal.screen.split())
        )

    def test_a_reported_release_stops(self) -> None:
        self.terminal.type("\x1b[?0u")
        wait_for("the request for releases", lambda: b"\x1b[>15u" in self.terminal.written)
        end = time.monotonic() + 30.0
        pressed = -math.inf
        while not self.robot.driving():
            self.assertLess(time.monotonic(), end)
            if time.monotonic() > pressed + 5.0:  # a key held over a pause of teleop.py has to be released first
                pressed = time.monotonic()
                self.terminal.type("\x1b[119;1:3u\x1b[119;1:1u")
            time.sleep(0.03)
            self.terminal.type("\x1b[119;1:2u")
        self.terminal.type("\x1b[119;1:3u")
        wait_for("zero", lambda: "requested             0.00" in self.terminal.screen, limit=10.0)
        self.await_rest()

    def test_the_e_stop_latches_and_a_reset_takes_two_keys(self) -> None:
        self.drive()
        self.terminal.type("!")
        wait_for("the stop", lambda: "e_stop_service" in self.robot.causes)
        self.await_rest()
        wait_for("its cause on the screen", lambda: "an emergency stop was requested" in self.terminal.screen)
        self.terminal.type("y")
        wait_for("the release by two keys", lambda: not self.robot.causes, every=self.request_reset)
        wait_for("the answer", lambda: "reset accepted" in self.terminal.screen)

    def request_reset(self) -> None:
        """Requests a reset, which is refused until the robot stands."""
        self.terminal.type("r")
        wait_for("the question or its answer", lambda: "reset?" in self.terminal.screen)
        time.sleep(RESET_PAUSE)
        self.terminal.type("y")
        wait_for("the answer", lambda: "reset?" not in self.terminal.screen)
        time.sleep(0.3)

    def test_a_hang_up_stops(self) -> None:
        self.drive()
        self.terminal.close()
        self.await_rest()
        self.assertNotEqual(self.terminal.wait(), 0)

    def test_a_key_that_is_held_while_it_is_suspended_over_a_stop_moves_nothing_until_its_release(self) -> None:
        self.drive()
        self.terminal.send_signal(signal.SIGSTOP)
        self.robot.call("e_stop_trigger")
        wait_for("the stop", lambda: "e_stop_service" in self.robot.causes, every=lambda: self.terminal.type("w"))
        self.robot.release()
        self.terminal.hold("w", 1.0)
        self.terminal.send_signal(signal.SIGCONT)
        before = self.robot.distance
        self.terminal.hold("w", 2.0, delay=0.03)
        self.assertAlmostEqual(self.robot.distance, before, delta=0.01)
        time.sleep(1.0)
        self.drive()

    def test_ctrl_c_ends_it_and_the_terminal_is_as_before(self) -> None:
        self.drive()
        self.terminal.type("\x03")
        self.assertEqual(self.terminal.wait(), 0, self.terminal.written[-2000:])
        self.await_rest()
        self.assertEqual(self.terminal.settings(), self.terminal.before)
        self.assertNotIn(b"Traceback", self.terminal.written)

    def test_it_publishes_heartbeat(self) -> None:
        beats: list[Empty] = []
        subscriber = rospy.Subscriber("heartbeat", Empty, beats.append)
        self.addCleanup(subscriber.unregister)
        wait_for("heartbeats", lambda: len(beats) > 5)

    @nightly
    def test_from_a_key_to_the_wheels_torque(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            telemetry = Program("telemetry", f"_directory:={folder}", "_record:=always")
            try:
                wait_for("the log", lambda: any(Path(folder).rglob("run.bag")))
                typed: list[int] = []
                end = time.monotonic() + 90.0
                while len(typed) < PRESSES:
                    self.assertLess(time.monotonic(), end, self.terminal.screen)
                    at = time.monotonic_ns()
                    self.terminal.type("w")
                    time.sleep(2.5)
                    if not self.robot.release_after_a_stall():
                        typed.append(at)
            finally:
                telemetry.end()
            log = read_log(next(Path(folder).rglob("run.bag")))
        torque = (log["requested_linear"] > 0) & (np.abs(log["left_wheel_joint_effort_command"]) > 0.01)
        stamps = log["stamp_ns"][torque]
        delays = [stamps[stamps > at][0] - at for at in typed]
        median = 1e-6 * statistics.median(delays)
        print(f"key to wheel torque: median {median:.1f} ms, worst {1e-6 * max(delays):.1f} ms of {len(delays)}")
        self.assertLess(median, 1000 * LATENCY)
