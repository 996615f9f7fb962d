#!/usr/bin/python3
"""Any node may be killed with -9 and started again while the others run."""

import itertools
import signal
import subprocess
import sys
import time

import rospy
import rostest
from nav_msgs.msg import Odometry
from robot_control.msg import SafetyStatus
from sensor_msgs.msg import JointState
from system.system_support import (
    CONTROLLER,
    DRIVER,
    ESTIMATOR,
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

    def test_estimator_continues_where_it_was(self) -> None:
        self.robot.drive_until("0.3 m", lambda: self.robot.distance > 0.3)
        self.robot.nodes[ESTIMATOR].kill()
        wait_for("estimator_lost", lambda: "estimator_lost" in self.robot.causes)
        wait_for("its name", lambda: ESTIMATOR in self.robot.status.missing)
        before, count = self.robot.distance, self.robot.odom_count
        self.robot.start(ESTIMATOR)
        wait_for("odometry", lambda: self.robot.odom_count > count)
        # It stopped from 0.5 m/s meanwhile: less than 0.2 m with the brake. A jump to zero would be 0.3 m.
        self.assertLess(abs(self.robot.distance - before), 0.2)
        self.expect_latched("estimator_lost")

    def test_stamps_follow_the_time_that_a_stopped_plant_lets_slip(self) -> None:
        robot = self.robot
        stamps: dict[str, list[float]] = {"odom": [], "joint_states": []}
        subscribers = [
            rospy.Subscriber("odom", Odometry, lambda m: stamps["odom"].append(m.header.stamp.to_sec())),
            rospy.Subscriber(
                "joint_states", JointState, lambda m: stamps["joint_states"].append(m.header.stamp.to_sec())
            ),
        ]
        wait_for("messages before", lambda: all(stamps.values()))
        plant = robot.nodes[DRIVER]
        plant.send_signal(signal.SIGSTOP)
        try:
            time.sleep(3.0)  # time that slips
            wait_for("driver_lost", lambda: "driver_lost" in robot.causes)
        finally:
            plant.send_signal(signal.SIGCONT)
        self.expect_latched("driver_lost")
        wait_for("stamps of now", lambda: abs(rospy.get_time() - robot.odom.header.stamp.to_sec()) < 1.0)
        for subscriber in subscribers:
            subscriber.unregister()
        for name, times in stamps.items():
            self.assertGreater(min(b - a for a, b in itertools.pairwise(times)), 0, f"{name}: stamps grow")

    def test_a_latch_outlives_plant_and_monitor(self) -> None:
        robot = self.robot
        for order, number in (((DRIVER, MONITOR), signal.SIGKILL), ((MONITOR, DRIVER), signal.SIGTERM)):
            robot.call("e_stop_trigger")
            wait_for("the stop", lambda: "e_stop_service" in robot.causes)
            for name in order:
                robot.nodes[name].send_signal(number)
                robot.nodes[name].wait()
            robot.status = None
            robot.start(*order)
            wait_for("safety_status", lambda: robot.status is not None and robot.status.run > 1)
            self.expect_latched("e_stop_service")

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
        self.assertIn(f"{rospy.get_name()} (has sent nothing since safety_monitor was restarted)", refused.message)
        robot.send_e_stop(False)
        self.expect_latched("e_stop_topic")

    def test_a_start_beside_a_living_sender_waits_for_a_zero_request(self) -> None:
        robot = self.robot
        for name in LOOP:
            robot.nodes[name].end()
        robot.status = None
        robot.start()
        wait_for(
            "a robot that waits for a zero request",
            lambda: robot.status is not None and robot.status.awaiting_zero_request,
            every=lambda: robot.send(0.5, 0.2),
        )
        end = time.monotonic() + 2.0  # longer than cmd_vel_timeout
        while time.monotonic() < end:
            robot.send(0.5, 0.2)
            self.assertEqual(robot.state, SafetyStatus.INIT)
            self.assertLess(abs(robot.speed), 0.01)
            time.sleep(0.02)
        wait_for("READY", lambda: robot.state == SafetyStatus.READY, every=lambda: robot.send(0, 0))
        robot.drive_until("0.5 m/s", robot.driving)


if __name__ == "__main__":
    rostest.rosrun("robot_control", "restart", RestartTest)
