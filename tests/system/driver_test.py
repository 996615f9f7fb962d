#!/usr/bin/python3
"""The program `driver` before simulated ODrives of another process. It knows them by their frames alone."""

import math
import signal
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
from sensor_msgs.msg import Imu
from std_msgs.msg import Header
from system_support import (
    CONTROLLER,
    ESTIMATOR,
    MONITOR,
    Program,
    Robot,
    again_after_a_stall,
    init_test_node,
    nightly,
    repository,
    wait_for,
)

LEFT = "left_wheel_joint"
STANDING = 0.01
"""m/s"""
LOSSES = (("bus", "off"), (LEFT, "off"), (LEFT, "reset"), (LEFT, "encoder"), (LEFT, "released"))
STOPPED = (SafetyStatus.STOPPED, SafetyStatus.FAULT)


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

    def inject(self, kind: str, component: str = LEFT) -> None:
        rospy.wait_for_service("device_simulator/inject_fault")
        answer = rospy.ServiceProxy("device_simulator/inject_fault", InjectFault)(component, kind)
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
    def test_it_awaits_the_imu_of_another_node_and_drives_with_it(self) -> None:
        self.robot.nodes["driver"].end()
        rospy.set_param("robot/imu", "topic")
        self.addCleanup(rospy.delete_param, "robot/imu")
        self.start_devices()
        self.robot.start("driver")
        wait_for("what it awaits", lambda: "imu/input" in self.robot.nodes["driver"].output)
        publisher = rospy.Publisher("imu/input", Imu, queue_size=1)
        sample = Imu(header=Header(frame_id="imu_link"))
        sample.linear_acceleration.z = 9.81
        timer = rospy.Timer(rospy.Duration(0.01), lambda _: publisher.publish(sample))
        self.addCleanup(timer.shutdown)
        self.robot.await_ready()
        timer.shutdown()
        wait_for("its loss", lambda: "imu_lost" in self.robot.status.warnings)

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

    @nightly
    @again_after_a_stall
    def test_each_loss_stops_the_robot_ten_times(self) -> None:
        self.start_devices()
        self.robot.await_ready()
        for _ in range(10):
            for component, kind in LOSSES:
                with self.subTest(component=component, kind=kind):
                    self.drive()
                    self.inject(kind, component)
                    self.await_stop()
                    self.inject("ok", component)
                    self.release()
            for number in (signal.SIGKILL, signal.SIGSTOP, signal.SIGSEGV):
                with self.subTest(signal=number):
                    self.drive()
                    driver = self.robot.nodes["driver"]
                    driver.send_signal(number)
                    wait_for("the stop", lambda: self.robot.state in STOPPED, every=lambda: self.robot.send(0.5, 0.2))
                    driver.kill()
                    self.robot.start("driver")
                    self.release()

    @again_after_a_stall
    def test_after_the_death_of_the_driver_the_drives_coast_until_a_new_one_brakes_and_is_released(self) -> None:
        self.start_devices()
        self.robot.await_ready()
        self.drive()
        self.robot.nodes["driver"].kill()
        wait_for("the loss", lambda: "driver_lost" in self.robot.causes, every=lambda: self.robot.send(0.5, 0.2))
        time.sleep(0.5)  # until the watchdogs of the drives expire, they keep their last torque
        speed = self.true_speed
        time.sleep(1.0)
        self.assertTrue(0.1 < self.true_speed < speed + 0.05, f"{self.true_speed} m/s, {speed} m/s before")
        self.robot.start("driver")
        wait_for("rest", lambda: abs(self.true_speed) < STANDING, every=lambda: self.robot.send(0.5, 0.2))
        self.release()
        self.drive()


if __name__ == "__main__":
    rostest.rosrun("robot_control", "driver", DriverTest)
