"""A robot whose drives are simulated by another process: `driver` knows them by their frames alone."""

import contextlib
import math
import tempfile
import unittest
from collections.abc import Callable, Iterator
from pathlib import Path

import rospy
import yaml
from nav_msgs.msg import Odometry
from robot_control.srv import InjectFault
from system.stall_witness import StallWitness
from system.system_support import (
    CONTROLLER,
    ESTIMATOR,
    MONITOR,
    STALL_CAUSES,
    Program,
    Robot,
    repository,
    wait_for,
)

LEFT = "left_wheel_joint"
STANDING = 0.01
"""m/s"""
DEVICE_STALL_CAUSES = STALL_CAUSES | {"driver_fault", "encoders_lost", "imu_lost"}
"""The drives are a process of this machine, too, which may stall."""
DEVICE_WITNESS = StallWitness(0.008, 85)
"""Their thread runs on any core. After 10 ms without a position a drive is silent (lost_after of the drive file)."""


class DriverTestCase(unittest.TestCase):
    """A test on three nodes of the loop and `driver`, with the drive file `drives`."""

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="driver-test-")
        cls.addClassCleanup(folder.cleanup)
        drives = yaml.safe_load((repository() / "config" / "drives" / "odrive.yaml").read_text())
        drives["bus"]["address"] = f"unix:{folder.name}"
        cls.drives = Path(folder.name, "drives.yaml")
        cls.drives.write_text(yaml.safe_dump(drives))
        for name, value in {"driver": "can", "drives": str(cls.drives)}.items():
            rospy.set_param(f"robot/{name}", value)
            cls.addClassCleanup(rospy.delete_param, f"robot/{name}")

    def setUp(self) -> None:
        self.true_speed = math.nan
        subscriber = rospy.Subscriber("ground_truth/odom", Odometry, self.receive_truth)
        self.addCleanup(subscriber.unregister)
        self.robot = Robot()
        self.robot.stall_causes = frozenset(DEVICE_STALL_CAUSES)
        self.robot.stall_witness = DEVICE_WITNESS
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

    def wait_for(self, what: str, condition: Callable[[], bool], every: Callable[[], object] | None = None) -> None:
        """As system_support.wait_for; its failure shows the robot."""
        with self.explained():
            wait_for(what, condition, every=every)

    @contextlib.contextmanager
    def explained(self) -> Iterator[None]:
        """Adds the state of the robot and the driver's output to a failed wait."""
        try:
            yield
        except AssertionError as error:
            driver = self.robot.nodes["driver"].output
            raise AssertionError(f"{error}; {self.true_speed} m/s\n{self.robot.status}\n--- driver\n{driver}") from None

    def drive(self) -> None:
        with self.explained():
            self.robot.drive_until("0.5 m/s", self.robot.driving)
        self.wait_for("the true speed", lambda: self.true_speed > 0.4, every=lambda: self.robot.send(0.5, 0.2))

    def await_stop(self) -> None:
        self.wait_for("the stop", lambda: "driver_fault" in self.robot.causes, every=lambda: self.robot.send(0.5, 0.2))

    def release(self) -> None:
        """The first reset clears the drives; one after they are ready is accepted."""
        self.wait_for(
            "an accepted reset",
            lambda: bool(self.robot.call("e_stop_reset").success),
            every=lambda: self.robot.send(0.0, 0.0),
        )
