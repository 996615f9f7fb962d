#!/usr/bin/python3
"""The program `driver` before simulated ODrives of another process, on a bus between them: the frames are all it has."""

import math
import tempfile
import time
import unittest
from pathlib import Path

import rospy
import rostest
import yaml
from nav_msgs.msg import Odometry
from robot_control.msg import SafetyStatus
from robot_control.srv import InjectFault
from system_support import (
    CONTROLLER,
    ESTIMATOR,
    MONITOR,
    Program,
    Robot,
    again_after_a_stall,
    init_test_node,
    repository,
    wait_for,
)

LEFT = "left_wheel_joint"
STANDING = 0.01
"""m/s"""


class DriverTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        init_test_node(cls.__name__)
        folder = tempfile.TemporaryDirectory(prefix="driver-test-")
        cls.addClassCleanup(folder.cleanup)
        drives = yaml.safe_load((repository() / "config" / "drives" / "odrive.yaml").read_text())
        drives["bus"]["address"] = f"unix:{folder.name}"
        file = Path(folder.name, "drives.yaml")
        file.write_text(yaml.safe_dump(drives))
        for name, value in {"driver": "can", "drives": str(file)}.items():
            rospy.set_param(f"robot/{name}", value)
            cls.addClassCleanup(rospy.delete_param, f"robot/{name}")

    def setUp(self) -> None:
        self.true_speed = math.nan
        subscriber = rospy.Subscriber("ground_truth/odom", Odometry, self.receive_truth)
        self.addCleanup(subscriber.unregister)
        self.robot = Robot()
        self.addCleanup(self.robot.end)
        self.robot.start("driver", ESTIMATOR, CONTROLLER, MONITOR)

    def missing(self) -> list[str]:
        return [] if self.robot.status is None else self.robot.status.missing

    def receive_truth(self, message: Odometry) -> None:
        self.true_speed = message.twist.twist.linear.x

    def start_devices(self) -> Program:
        devices = Program("device_simulator")
        self.addCleanup(devices.end)
        return devices

    def inject(self, kind: str) -> None:
        rospy.wait_for_service("device_simulator/inject_fault")
        answer = rospy.ServiceProxy("device_simulator/inject_fault", InjectFault)(LEFT, kind)
        self.assertTrue(answer.success, answer.message)

    def drive(self) -> None:
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        wait_for("the true speed", lambda: self.true_speed > 0.4, every=lambda: self.robot.send(0.5, 0.2))

    def await_stop(self) -> None:
        wait_for("the stop", lambda: "driver_fault" in self.robot.causes, every=lambda: self.robot.send(0.5, 0.2))

    @again_after_a_stall
    def test_it_awaits_its_drives_without_motion_and_drives_when_they_are_there(self) -> None:
        wait_for("what it awaits", lambda: "machine is starting" in " ".join(self.missing()))
        self.assertEqual(self.robot.state, SafetyStatus.INIT)
        self.assertIn(LEFT, self.robot.nodes["driver"].output)
        self.start_devices()
        self.robot.await_ready()
        self.drive()

    @again_after_a_stall
    def test_a_drive_that_goes_off_stops_the_robot_until_it_is_back_and_reset(self) -> None:
        self.start_devices()
        self.robot.await_ready()
        self.drive()
        self.inject("off")
        self.await_stop()
        wait_for("rest", lambda: abs(self.true_speed) < STANDING, every=lambda: self.robot.send(0.5, 0.2))
        self.assertFalse(self.robot.call("e_stop_reset").success)
        self.inject("ok")
        self.release()
        self.drive()

    def release(self) -> None:
        """The first reset clears the drives; one after they are ready is accepted."""
        wait_for(
            "an accepted reset",
            lambda: bool(self.robot.call("e_stop_reset").success),
            every=lambda: self.robot.send(0.0, 0.0),
        )

    @again_after_a_stall
    def test_after_the_death_of_the_driver_the_drives_coast_until_a_new_one_brakes_and_is_released(self) -> None:
        self.start_devices()
        self.robot.await_ready()
        self.drive()
        self.robot.nodes["driver"].kill()
        wait_for("the loss", lambda: "driver_lost" in self.robot.causes, every=lambda: self.robot.send(0.5, 0.2))
        speed = self.true_speed
        time.sleep(1.0)
        self.assertTrue(0.1 < self.true_speed < speed + 0.05, f"{self.true_speed} m/s, {speed} m/s before")
        self.robot.start("driver")
        wait_for("rest", lambda: abs(self.true_speed) < STANDING, every=lambda: self.robot.send(0.5, 0.2))
        self.release()
        self.drive()


if __name__ == "__main__":
    rostest.rosrun("robot_control", "driver", DriverTest)
