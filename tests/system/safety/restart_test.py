"""Any node may be killed with -9 and started again while the others run."""

import subprocess
import sys
import time

import rospy
from robot_control.msg import SafetyStatus
from system.system_support import (
    CONTROLLER,
    LIMIT,
    LOOP,
    MONITOR,
    RobotTestCase,
    again_after_a_stall,
    wait_for,
)

SENDER = """
import sys
import rospy
from geometry_msgs.msg import Twist

rospy.init_node("sender")
message = Twist()
message.linear.x = 0.4
for line in sys.stdin:  # open: a connection; close: it; send: motion until the next line
    if line.strip() == "open":
        publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
    elif line.strip() == "close":
        publisher.unregister()
    else:
        publisher.publish(message)
"""


class Sender:
    """A node /sender on cmd_vel, a process of its own."""

    def __init__(self) -> None:
        self.process = subprocess.Popen([sys.executable, "-c", SENDER], stdin=subprocess.PIPE, text=True, bufsize=1)
        self.say("open")

    def say(self, what: str) -> None:
        """open: a connection; close: it; send: one message of 0.4 m/s."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{what}\n")

    def end(self) -> None:
        """In order."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait(LIMIT)


class RestartTest(RobotTestCase):
    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def expect_latched(self, cause: str) -> None:
        """STOPPED for this cause, however often a motion is requested; after a reset the robot drives."""
        robot = self.robot
        wait_for(
            cause,
            lambda: robot.state == SafetyStatus.STOPPED and cause in robot.causes,
            every=lambda: robot.send(0.5, 0.2),
        )
        wait_for("standstill", lambda: abs(robot.speed) < 0.01, every=lambda: robot.send(0.5, 0.2))
        robot.release()
        robot.drive_until("0.5 m/s after the reset", robot.driving)

    def sender_that_drives(self) -> Sender:
        self.robot.await_rest()
        sender = Sender()
        self.addCleanup(sender.end)
        wait_for("motion", lambda: self.robot.speed > 0.3, every=lambda: self.send(sender))
        return sender

    def send(self, sender: Sender) -> None:
        sender.say("send")
        time.sleep(0.05)

    def expect_refusal(self, sender: Sender) -> None:
        """It is named, and moves nothing; restarted it drives."""
        before = self.robot.distance

        def send() -> None:
            self.send(sender)
            self.assertAlmostEqual(self.robot.distance, before, delta=0.01)

        wait_for("its name", lambda: "/sender" in self.robot.revoked, every=send)
        sender.end()
        self.sender_that_drives()

    @again_after_a_stall
    def test_a_sender_that_slept_over_the_restart_of_the_controller_moves_nothing(self) -> None:
        sender = self.sender_that_drives()
        self.robot.nodes[CONTROLLER].kill()
        wait_for("controller_lost", lambda: "controller_lost" in self.robot.causes)
        self.robot.start(CONTROLLER)
        self.robot.release()
        self.expect_refusal(sender)

    @again_after_a_stall
    def test_a_sender_that_slept_over_the_restart_of_all_nodes_moves_nothing(self) -> None:
        sender = self.sender_that_drives()
        for name in LOOP:
            self.robot.nodes[name].end()
        self.robot.status = self.robot.odom = None
        self.robot.start()
        self.robot.await_ready()
        wait_for("READY", lambda: self.robot.state == SafetyStatus.READY)
        self.expect_refusal(sender)

    @again_after_a_stall
    def test_a_sender_that_opens_its_connection_again_owes_its_zero(self) -> None:
        sender = self.sender_that_drives()
        self.robot.call("e_stop_trigger")
        sender.say("close")
        self.robot.release()
        sender.say("open")
        self.expect_refusal(sender)

    def test_a_level_of_e_stop_outlives_the_monitor_until_its_publisher_says_false(self) -> None:
        robot = self.robot
        robot.send_e_stop(True)
        wait_for("the stop", lambda: "e_stop_topic" in robot.causes)
        robot.nodes[MONITOR].kill()
        robot.status = None
        robot.start(MONITOR)
        wait_for("safety_status", lambda: robot.status is not None and robot.status.run > 1)
        another = ["rostopic", "pub", "-1", "e_stop", "std_msgs/Bool", "false"]
        subprocess.run(another, check=True, capture_output=True)
        refused = robot.call("e_stop_reset")
        self.assertFalse(refused.success)
        self.assertIn(f"{rospy.get_name()} (has published nothing since safety_monitor was restarted)", refused.message)
        robot.send_e_stop(False)
        self.expect_latched("e_stop_topic")
