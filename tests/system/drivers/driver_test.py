"""The program `driver` loses its drives, its IMU, or its life."""

import signal
import time

import rospy
from robot_control.msg import SafetyStatus
from sensor_msgs.msg import Imu
from std_msgs.msg import Header
from system.drivers.driver_support import LEFT, STANDING, DriverTestCase
from system.system_support import again_after_a_stall, nightly

LOSSES = (("bus", "off"), (LEFT, "off"), (LEFT, "reset"), (LEFT, "encoder"), (LEFT, "released"))
STOPPED = (SafetyStatus.STOPPED, SafetyStatus.FAULT)


class DriverTest(DriverTestCase):
    @again_after_a_stall
    def test_it_awaits_the_imu_of_another_node_and_drives_with_it(self) -> None:
        self.robot.nodes["driver"].end()
        rospy.set_param("robot/imu", "topic")
        self.addCleanup(rospy.delete_param, "robot/imu")
        self.start_devices()
        self.robot.start("driver")
        self.wait_for("what it awaits", lambda: "imu/input" in self.robot.nodes["driver"].output)
        publisher = rospy.Publisher("imu/input", Imu, queue_size=1)
        sample = Imu(header=Header(frame_id="imu_link"))
        sample.linear_acceleration.z = 9.81
        timer = rospy.Timer(rospy.Duration(0.01), lambda _: publisher.publish(sample))
        self.addCleanup(timer.shutdown)
        self.robot.await_ready()
        timer.shutdown()
        self.wait_for("its loss", lambda: "imu_lost" in self.robot.status.warnings)

    @again_after_a_stall
    def test_a_drive_that_goes_off_stops_the_robot_until_it_is_back_and_reset(self) -> None:
        self.start_devices()
        self.robot.await_ready()
        self.drive()
        self.inject("off")
        self.await_stop()
        answer = self.robot.call("e_stop_reset")
        self.assertFalse(answer.success)
        self.assertIn("persists: the driver reports a fault", answer.message)
        self.inject("ok")
        self.release()
        self.drive()

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
                    self.wait_for(
                        "the stop", lambda: self.robot.state in STOPPED, every=lambda: self.robot.send(0.5, 0.2)
                    )
                    driver.kill()
                    self.robot.start("driver")
                    self.release()

    @again_after_a_stall
    def test_after_the_death_of_the_driver_the_drives_coast_until_a_new_one_brakes_and_is_released(self) -> None:
        self.start_devices()
        self.robot.await_ready()
        self.drive()
        self.robot.nodes["driver"].kill()
        self.wait_for("the loss", lambda: "driver_lost" in self.robot.causes, every=lambda: self.robot.send(0.5, 0.2))
        time.sleep(0.5)  # until the watchdogs of the drives expire, they keep their last torque
        speed = self.true_speed
        time.sleep(1.0)
        self.assertTrue(0.1 < self.true_speed < speed + 0.05, f"{self.true_speed} m/s, {speed} m/s before")
        self.robot.start("driver")
        self.wait_for("rest", lambda: abs(self.true_speed) < STANDING, every=lambda: self.robot.send(0.5, 0.2))
        self.release()
        self.drive()
