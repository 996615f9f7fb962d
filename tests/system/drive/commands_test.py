"""Commands with stamps, from a sender that slept and from clocks that jump."""

import os
import tempfile
import time
from pathlib import Path

import rospy
from geometry_msgs.msg import TwistStamped
from system.commands_support import StampedSender
from system.losses_support import JumpingClock
from system.system_support import CONTROLLER, Program, RobotTestCase, wait_for

HOUR = 3600.0
"""s"""
JUMPS = (HOUR, -HOUR, 0.0, 0.5, -0.5, 86400.0)
"""s from the true time."""
SPELL = 0.5
"""s between two jumps."""
STANDING = 0.01
"""m/s"""
MOVED = 0.05
"""m/s: a robot that obeyed an old command of 0.5 m/s is faster after 0.1 s, and the rest of a ramp is slower."""


class CommandsTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.clock = JumpingClock(os.environ["JUMPING_CLOCK_LIBRARY"], Path(tempfile.mkdtemp()) / "offset")
        with cls.clock.worn():
            super().setUpClass()
        cls.sender = StampedSender(cls.robot)

    def setUp(self) -> None:
        super().setUp()
        wait_for("a subscriber", self.sender.connected)

    def tearDown(self) -> None:
        self.clock.jump(0.0)

    @property
    def log(self) -> str:
        return self.robot.nodes[CONTROLLER].output

    def drive_stamped(self) -> None:
        """Stops that a stalling machine latches are released on the way."""

        def send_and_release() -> None:
            self.sender.send_aged(0.5, 0.0)
            if self.robot.stalled:
                self.robot.release()

        wait_for("0.5 m/s", self.robot.driving, every=send_and_release)

    def test_a_sender_that_slept_over_a_stop_and_its_reset_moves_nothing_before_its_zero(self) -> None:
        self.drive_stamped()
        self.assertTrue(self.robot.call("e_stop_trigger").success)
        wait_for("the stop", lambda: "e_stop_service" in self.robot.causes)
        self.robot.release()
        message = TwistStamped()
        message.twist.linear.x = 0.5
        sleeper = self.sender.publisher

        def refused() -> bool:
            self.assertLess(abs(self.robot.speed), STANDING)
            return rospy.get_name() in self.robot.revoked and "revoked" in self.sender.reasons

        wait_for("the refusal", refused, every=lambda: sleeper.publish(message))
        wait_for(
            "the count",
            lambda: int(self.sender.report.values["commands_of_revoked_senders"]) > 0,
            every=lambda: sleeper.publish(message),
        )
        self.assertIn(f"motion of {rospy.get_name()} is refused", self.log)
        self.assertIn(f"{rospy.get_name()}: publish zero", self.why())
        sleeper.publish(TwistStamped())
        self.drive_stamped()

    def why(self) -> str:
        program = Program("why.py", "--once")
        program.wait()
        return program.output

    def test_commands_older_than_the_timeout_are_refused_and_every_report_gives_the_reason(self) -> None:
        def send() -> None:
            self.sender.send_aged(0.5, 2.0)

        def reported() -> bool:
            return "stale" in self.sender.reasons and "stale" in self.sender.report.values.get("reasons", "")

        self.drive_stamped()
        wait_for("standstill", lambda: abs(self.robot.speed) < STANDING, every=send)
        wait_for("the reason", reported, every=send)
        self.assertIn("the last message's time stamp is older", self.sender.report.message)
        self.assertGreater(int(self.sender.report.values["commands_stale"]), 0)
        words = "s old by its stamp, more than cmd_vel_timeout (1.25 s)"
        self.assertEqual(self.log.count(words), 1, "one warning for a series")
        self.assertLess(abs(self.robot.speed), MOVED)
        self.drive_stamped()

    def test_a_common_clock_that_jumps_changes_no_motion(self) -> None:
        # Messages under way at a jump are refused; the earlier command stays valid.
        self.drive_stamped()
        slowest = self.slowest_over_jumps()
        if self.robot.stalled:
            self.drive_stamped()
            slowest = self.slowest_over_jumps()
        self.assertGreater(slowest, 0.4)

    def slowest_over_jumps(self) -> float:
        """m/s, smallest speed while the clocks of sender and robot jump together."""
        slowest = self.robot.speed
        for jump in JUMPS:
            self.clock.jump(jump)
            end = time.monotonic() + SPELL
            while time.monotonic() < end:
                self.sender.send_aged(0.5, -jump)
                slowest = min(slowest, self.robot.speed)
                time.sleep(0.01)
        self.clock.jump(0.0)
        return slowest
