"""roscore is killed while the robot drives: existing connections stay, and the loop never calls the master."""

import time

import rospy
from std_srvs.srv import Trigger
from system.losses_support import FAST, FULL_SPEED, KEPT, Master
from system.system_support import LOOP, RobotTestCase, wait_for

MASTER = Master()
ATTEMPTS = 3
"""Stops that a stalling machine latches are released, and the drive is repeated."""


class LossesMasterTest(RobotTestCase):
    def slowest(self) -> float:
        """m/s, smallest speed while commands go on for more than twice cmd_vel_timeout."""
        end = time.monotonic() + 3.0
        slowest = FULL_SPEED
        while time.monotonic() < end:
            self.robot.send(FULL_SPEED, 0.0)
            slowest = min(slowest, self.robot.speed)
            time.sleep(0.02)
        return slowest

    def test_a_killed_master_changes_no_motion_and_every_stop_still_works(self) -> None:
        robot = self.robot
        rospy.wait_for_service("e_stop_reset")
        reset = rospy.ServiceProxy("e_stop_reset", Trigger, persistent=True)
        reset()  # connects
        robot.drive_until("1 m/s", lambda: robot.speed > FAST, FULL_SPEED, 0.0)
        MASTER.kill()
        for _ in range(ATTEMPTS):
            slowest = self.slowest()
            if not robot.stalled:
                break
            wait_for("a release", lambda: bool(reset().success), every=lambda: robot.send(0.0, 0.0))
            wait_for("1 m/s again", lambda: robot.speed > FAST, every=lambda: robot.send(FULL_SPEED, 0.0))
        print(f"  slowest after the master's death: {slowest:.3f} m/s")
        self.assertEqual(robot.causes, set())
        self.assertGreater(slowest, KEPT)
        for name in LOOP:
            self.assertTrue(robot.nodes[name].running, name)

        robot.send_e_stop(True)
        wait_for("the stop", lambda: "e_stop_topic" in robot.causes, every=lambda: robot.send(FULL_SPEED, 0.0))
        wait_for("standstill", lambda: abs(robot.speed) < 0.01, every=lambda: robot.send(FULL_SPEED, 0.0))
        self.assertIn("e_stop", reset().message)
        robot.send_e_stop(False)
        wait_for("a release", lambda: bool(reset().success), every=lambda: robot.send(0.0, 0.0))
