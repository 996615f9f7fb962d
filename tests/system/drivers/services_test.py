"""The services of a simulated machine, called as a user of ROS calls them."""

import time

import rospy
from nav_msgs.msg import Odometry
from robot_control.srv import InjectFault
from std_srvs.srv import SetBool
from system.system_support import DRIVER, LIMIT, Latest, Report, RobotTestCase, wait_for


class ServicesTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.truth = Latest("ground_truth/odom", Odometry)
        for name in ("set_pause", "inject_fault"):
            rospy.wait_for_service(f"{DRIVER}/{name}", LIMIT)

    @property
    def plant(self) -> Report:
        return self.robot.reports[DRIVER]

    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def tearDown(self) -> None:
        self.set_pause(False)

    def set_pause(self, pause: bool) -> None:
        answer = rospy.ServiceProxy(f"{DRIVER}/set_pause", SetBool)(pause)
        self.assertTrue(answer.success, answer.message)

    def inject(self, component: str, kind: str) -> None:
        answer = rospy.ServiceProxy(f"{DRIVER}/inject_fault", InjectFault)(component, kind)
        self.assertTrue(answer.success, answer.message)

    def test_paused_the_robot_stands_and_so_does_its_time(self) -> None:
        self.set_pause(True)
        time.sleep(0.3)  # earlier messages arrive
        truth, odom = self.truth.message, self.robot.odom
        time.sleep(1.5)  # far longer than the 20 periods after which a silent driver is lost
        self.assertIs(self.truth.message, truth)
        self.assertIs(self.robot.odom, odom)
        wait_for("word of it", lambda: self.plant.message == "paused")
        self.assertEqual(self.plant.values["driver_state"], "paused")
        self.assertGreater(float(self.plant.values["real_time_factor"]), 0)
        self.assertIn("paused", self.robot.call("e_stop_reset").message)
        self.set_pause(False)
        wait_for("odometry", lambda: self.robot.odom is not odom)
        self.assertNotIn("driver_lost", self.robot.causes)
        wait_for("stamps of now", lambda: abs(rospy.get_time() - self.robot.odom.header.stamp.to_sec()) < 1.0)
        self.robot.drive_until("0.5 m/s again", self.robot.driving)

    def test_an_injected_fault_is_seen_and_heals(self) -> None:
        self.inject("e_stop_button", "off")
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01, every=lambda: self.robot.send(0.5, 0.2))
        wait_for("its name", lambda: "e_stop_button off" in self.plant.values.get("injected", ""))
        self.inject("e_stop_button", "ok")
        wait_for("nothing injected", lambda: self.plant.values["injected"] == "none")
        self.robot.release()
