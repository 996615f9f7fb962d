#!/usr/bin/python3
"""Commands with stamps, from clocks that jump or lie, and from more than one node; the answer on drive_state."""

import math
import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import rospy
import rostest
from commands_support import CommandDesk
from geometry_msgs.msg import TwistStamped
from losses_support import JumpingClock
from system_support import CONTROLLER, LIMIT, Program, RobotTestCase, wait_for

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
        cls.desk = CommandDesk(cls.robot)

    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.await_rest()
        wait_for("a subscriber", self.desk.connected)

    def tearDown(self) -> None:
        self.clock.jump(0.0)

    @property
    def log(self) -> str:
        return self.robot.nodes[CONTROLLER].output

    def drive_until(self, what: str, condition: Callable[[], bool], send: Callable[[], None]) -> None:
        """Calls `send` in every pass; stops that a stalling machine latches are released on the way."""

        def send_and_release() -> None:
            send()
            if self.robot.stalled:
                self.robot.release()

        wait_for(what, condition, every=send_and_release)

    def drive_stamped(self, age: float = 0.0) -> None:
        self.drive_until("0.5 m/s", self.robot.driving, lambda: self.desk.send_aged(0.5, age))

    def expect_refusal(self, age: float, words: str) -> None:
        """The robot comes to rest under commands of this age, and every report gives the reason."""
        before = self.log.count(words)
        self.drive_stamped()
        wait_for("standstill", lambda: abs(self.robot.speed) < STANDING, every=lambda: self.desk.send_aged(0.5, age))

        def reported() -> bool:
            return "stale" in self.desk.reasons and "stale" in self.desk.values.get("reasons", "")

        wait_for("the reason", reported, every=lambda: self.desk.send_aged(0.5, age))
        self.assertIn("the last message was older by its stamp", self.desk.message)
        self.assertGreater(int(self.desk.values["commands_stale"]), 0)
        # An earlier test may have caused the report less than 10 s ago: then it appears after they are over.
        wait_for(words, lambda: self.log.count(words) > before, every=lambda: self.desk.send_aged(0.5, age))
        self.assertEqual(self.log.count(words), before + 1, "one warning for a series")
        self.assertLess(abs(self.robot.speed), MOVED)

    def test_a_sender_that_slept_over_a_stop_and_its_reset_moves_nothing_before_its_zero(self) -> None:
        self.drive_stamped()
        self.assertTrue(self.robot.call("e_stop_trigger").success)
        wait_for("the stop", lambda: "e_stop_service" in self.robot.causes)
        self.robot.release()
        message = TwistStamped()
        message.twist.linear.x = 0.5
        sleeper = self.desk.publisher

        def refused() -> bool:
            self.assertLess(abs(self.robot.speed), STANDING)
            return rospy.get_name() in self.robot.revoked and "revoked" in self.desk.reasons

        wait_for("the refusal", refused, every=lambda: sleeper.publish(message))
        wait_for(
            "the count",
            lambda: int(self.desk.values["commands_of_revoked_senders"]) > 0,
            every=lambda: sleeper.publish(message),
        )
        self.assertIn(f"motion of {rospy.get_name()} is refused", self.log)
        self.assertIn(f"{rospy.get_name()}: let it send zero", self.why())
        sleeper.publish(TwistStamped())
        self.drive_stamped()

    def why(self) -> str:
        program = Program("why.py", "--once")
        program.wait()
        return program.output

    def test_a_stamped_command_drives(self) -> None:
        self.drive_stamped()
        self.drive_stamped(age=0.2)

    def test_a_stamp_of_zero_is_none(self) -> None:
        self.drive_until("0.5 m/s", self.robot.driving, lambda: self.desk.send(0.5, 0.0, rospy.Time()))

    def test_commands_older_than_the_timeout_are_refused(self) -> None:
        self.expect_refusal(2.0, "s old by its stamp, more than cmd_vel_timeout (1.25 s)")
        self.drive_stamped()

    def test_a_clock_an_hour_ahead_is_reported_once(self) -> None:
        self.expect_refusal(-HOUR, "is stamped 3600 s in the future")
        self.drive_stamped()

    def test_nan_is_refused_on_this_topic_too(self) -> None:
        self.drive_stamped()
        wait_for(
            "standstill", lambda: abs(self.robot.speed) < STANDING, every=lambda: self.desk.send_aged(math.nan, 0.0)
        )
        wait_for("the reason", lambda: "refused" in self.desk.reasons, every=lambda: self.desk.send_aged(math.nan, 0.0))
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
                self.desk.send_aged(0.5, -jump)
                slowest = min(slowest, self.robot.speed)
                time.sleep(0.01)
        self.clock.jump(0.0)
        return slowest

    def test_no_jump_brings_an_old_command_back(self) -> None:
        self.drive_stamped()
        wait_for("standstill without a sender", lambda: abs(self.robot.speed) < STANDING)
        for jump in JUMPS:
            self.clock.jump(jump)
            end = time.monotonic() + SPELL
            while time.monotonic() < end:
                self.assertLess(abs(self.robot.speed), MOVED, f"after a jump of {jump} s")
                time.sleep(0.01)

    def test_a_robot_whose_clock_jumps_alone_comes_to_rest_and_drives_on_when_it_is_right_again(self) -> None:
        self.drive_stamped()
        self.clock.jump(HOUR)
        wait_for("standstill", lambda: abs(self.robot.speed) < STANDING, every=lambda: self.desk.send_aged(0.5, 0.0))
        self.clock.jump(0.0)
        self.drive_stamped()

    def test_two_senders_are_named(self) -> None:
        self.drive_stamped()
        other = Program("send_cmd.py", "--seconds", str(LIMIT))
        try:
            names = f"{rospy.get_name()}, /send_cmd"
            self.drive_until(
                "the warning",
                lambda: f"2 nodes send commands: {names}; each message overrides the one before" in self.log,
                lambda: self.desk.send_aged(0.5, 0.0),
            )
            wait_for(
                "diagnostics",
                lambda: self.desk.values.get("senders") == names and "more than one node" in self.desk.message,
                every=lambda: self.desk.send_aged(0.5, 0.0),
            )
        finally:
            other.end()
        wait_for(
            "the end of it",
            lambda: self.desk.values.get("senders") == rospy.get_name(),
            every=lambda: self.desk.send_aged(0.5, 0.0),
        )
        # If one sender stalls for longer than it counts, that is the first end, with its own line.
        self.assertRegex(self.log, "one sender of commands is left: |no node sends commands any more")

    def test_drive_state_compares_every_wheel_with_its_target(self) -> None:
        def steady() -> bool:
            state = self.desk.drive
            return state is not None and len(state.wanted) == 2 and min(state.wanted) > 4.99 and not state.reasons

        self.drive_until("5 rad/s on both wheels", steady, lambda: self.desk.send_aged(0.5, 0.0))
        state = self.desk.drive
        assert state is not None
        self.assertEqual(state.name, ["left_wheel_joint", "right_wheel_joint"])
        for wanted, actual, error in zip(state.wanted, state.actual, state.error, strict=True):
            self.assertEqual(error, wanted - actual)
        self.assertEqual(len(state.effort), 2)

    def test_drive_state_says_which_limit_shapes_a_ramp(self) -> None:
        seen: dict[str, str] = {}

        def shaped() -> bool:
            state = self.desk.drive
            if state is not None:
                seen.update(zip(state.reasons, state.sentences, strict=True))
            return {"acceleration_limited", "jerk_limited"} <= set(seen)

        self.drive_until("both reasons", shaped, lambda: self.desk.send_aged(0.5, 0.0))
        self.assertEqual(seen["acceleration_limited"], "the acceleration limit shapes the motion")


if __name__ == "__main__":
    rostest.rosrun("robot_control", "commands", CommandsTest)
