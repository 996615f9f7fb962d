"""state_estimator publishes odometry and sets its pose on request."""

import math

import numpy as np
import rospy
from nav_msgs.msg import Odometry
from robot_control.robot.pose import rotation, yaw_of
from robot_control.srv import InjectFault, SetOdometry, SetOdometryResponse
from sensor_msgs.msg import BatteryState, Imu
from system.system_support import DRIVER, ESTIMATOR, LIMIT, Latest, RobotTestCase, wait_for


class OdometryTest(RobotTestCase):
    parameters = ((f"/{DRIVER}/battery_voltage", 24.0),)

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.wheels, cls.imu = Latest("wheel_odom", Odometry), Latest("imu/data", Imu)
        rospy.wait_for_service("set_odometry", LIMIT)

    def setUp(self) -> None:
        super().setUp()
        self.robot.reports.clear()
        wait_for("a standing robot", lambda: "standstill" in self.robot.reports[ESTIMATOR].values.get("flags", ""))

    def inject(self, component: str, kind: str) -> None:
        answer = rospy.ServiceProxy(f"{DRIVER}/inject_fault", InjectFault)(component, kind)
        self.assertTrue(answer.success, answer.message)

    def set_odometry(self, x: float, y: float, yaw: float) -> SetOdometryResponse:
        return rospy.ServiceProxy("set_odometry", SetOdometry)(x, y, yaw)

    def at(self, x: float, y: float, yaw: float) -> bool:
        """True if the newest odometry is within 1 mm and 0.06°, which a standing robot may still learn of its last
        centimetre.
        """
        pose = self.robot.pose
        return math.hypot(pose.x - x, pose.y - y) < 0.001 and abs(math.remainder(pose.yaw - yaw, 2 * math.pi)) < 0.001

    def test_the_battery_is_published_as_measured(self) -> None:
        message = rospy.wait_for_message("battery_state", BatteryState, LIMIT)
        self.assertAlmostEqual(message.voltage, 24.0, delta=2.0)
        self.assertTrue(math.isnan(message.percentage))

    def test_the_pose_is_what_it_is_set_to(self) -> None:
        answer = self.set_odometry(1.5, -2.5, 0.5 + 4 * math.pi)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("1.5 m, -2.5 m, 0.5", answer.message)
        wait_for("that pose", lambda: self.at(1.5, -2.5, 0.5))
        self.assertLess(self.robot.odom.pose.covariance[0], 1e-6)
        self.robot.drive_until("motion from there", self.robot.driving, angular=0.0)
        self.robot.await_rest()
        heading = math.atan2(self.robot.pose.y + 2.5, self.robot.pose.x - 1.5)
        self.assertAlmostEqual(heading, 0.5, delta=0.05)
        self.assertTrue(self.robot.call("reset_odometry").success)
        wait_for("the origin", lambda: self.at(0, 0, 0))

    def test_the_wheels_alone_say_nearly_the_same(self) -> None:
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        wait_for("the wheels' speed", lambda: self.wheels.count and self.wheels.message.twist.twist.linear.x > 0.3)
        wheels = self.wheels.message
        self.assertEqual((wheels.header.frame_id, wheels.child_frame_id), ("odom", "base_link"))
        self.assertEqual(set(wheels.pose.covariance), {0.0}, "unknown")

    def test_the_imu_knows_up_and_north_is_that_of_the_odometry(self) -> None:
        self.assertTrue(self.set_odometry(0, 0, 1.0).success)
        wait_for("that heading", lambda: self.at(0, 0, 1.0))
        wait_for("the IMU's", lambda: self.imu.count and abs(yaw_of(self.imu.message.orientation) - 1.0) < 0.02)
        imu = self.imu.message
        self.assertEqual(imu.header.frame_id, "imu_link")
        acceleration = imu.linear_acceleration
        q = imu.orientation
        felt = rotation((q.x, q.y, q.z, q.w)) @ [acceleration.x, acceleration.y, acceleration.z]
        # The plant's bias of 0.2 m/s² and a sample's noise of 0.05 m/s².
        np.testing.assert_allclose(felt, [0, 0, 9.81], atol=0.8)
        orientation = np.diag(np.reshape(imu.orientation_covariance, (3, 3)))
        self.assertTrue((orientation[:2] > 0).all(), orientation)
        self.assertLess(orientation[2], 1e-6, "the heading was set")
        for covariance in (imu.angular_velocity_covariance, imu.linear_acceleration_covariance):
            self.assertTrue((np.diag(np.reshape(covariance, (3, 3))) > 0).all(), covariance)

    def test_without_a_gyro_no_orientation_is_made_up_and_diagnostics_says_so(self) -> None:
        wait_for("imu/data", lambda: self.imu.count > 0)
        self.inject("gyro", "off")
        try:
            wait_for(
                "the warning", lambda: "yaw is computed from the wheels only" in self.robot.reports[ESTIMATOR].message
            )
            count = self.imu.count
            odom = self.robot.odom_count
            wait_for("odometry all the same", lambda: self.robot.odom_count > odom + 20)
            self.assertEqual(self.imu.count, count)
        finally:
            self.inject("gyro", "ok")
        wait_for("imu/data again", lambda: self.imu.count > count)
        wait_for("no warning", lambda: "wheels alone" not in self.robot.reports[ESTIMATOR].message)
