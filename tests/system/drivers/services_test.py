"""The services of a simulated machine, called as a user of ROS calls them."""

import math
import time

import rospy
from nav_msgs.msg import Odometry
from robot_control.msg import SafetyStatus
from robot_control.srv import InjectFault, Step
from std_srvs.srv import SetBool, Trigger
from system.system_support import DRIVER, LIMIT, SEND_PERIOD, Latest, Report, RobotTestCase, wait_for


class ServicesTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.truth = Latest("ground_truth/odom", Odometry)
        for name in ("set_pause", "step", "reset", "inject_fault"):
            rospy.wait_for_service(f"{DRIVER}/{name}", LIMIT)

    @property
    def plant(self) -> Report:
        return self.robot.reports[DRIVER]

    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def tearDown(self) -> None:
        self.set_pause(False)

    def set_pause(self, pause: bool) -> str:
        answer = rospy.ServiceProxy(f"{DRIVER}/set_pause", SetBool)(pause)
        self.assertTrue(answer.success, answer.message)
        return str(answer.message)

    def step(self, cycles: int) -> tuple[bool, str]:
        answer = rospy.ServiceProxy(f"{DRIVER}/step", Step)(cycles)
        return answer.success, answer.message

    def reset(self) -> None:
        answer = rospy.ServiceProxy(f"{DRIVER}/reset", Trigger)()
        self.assertTrue(answer.success, answer.message)

    def inject(self, component: str, kind: str) -> tuple[bool, str]:
        answer = rospy.ServiceProxy(f"{DRIVER}/inject_fault", InjectFault)(component, kind)
        return answer.success, answer.message

    def cycle(self) -> int:
        """The cycle that the plant reports, once it has reported again."""
        self.robot.reports.clear()
        wait_for("diagnostics of the plant", lambda: "cycle" in self.plant.values)
        return int(self.plant.values["cycle"])

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

    def test_a_command_of_a_pause_moves_nothing_after_it(self) -> None:
        self.robot.await_rest()
        self.set_pause(True)
        wait_for("word of it", lambda: self.plant.message == "paused")
        for _ in range(5):
            self.robot.send(0.5, 0.0)
            time.sleep(SEND_PERIOD)
        self.set_pause(False)
        wait_for("zero first", lambda: self.robot.status.awaiting_zero_request)
        self.assertLess(abs(self.robot.speed), 0.01)
        wait_for("the release by silence", lambda: self.robot.state == SafetyStatus.READY)
        self.assertLess(abs(self.robot.speed), 0.01)
        self.robot.await_rest()
        self.robot.drive_until("0.5 m/s, once it has sent zeros", self.robot.driving)

    def test_steps_exactly_as_many_cycles_as_asked_for(self) -> None:
        success, message = self.step(5)
        self.assertFalse(success)
        self.assertIn("set_pause", message)
        self.set_pause(True)
        before = self.cycle()
        self.assertTrue(self.step(7)[0])
        self.assertTrue(self.step(500)[0])
        self.assertEqual(self.cycle(), before + 507)

    def test_a_reset_at_speed_is_a_new_run_from_rest(self) -> None:
        run = self.robot.status.run
        before = self.robot.odom.header.stamp
        self.reset()
        wait_for("a new run", lambda: self.robot.status.run not in (0, run))
        wait_for("odometry of it", lambda: self.robot.odom.header.stamp > before and self.robot.distance < 0.01)
        wait_for(
            "truth of it",
            lambda: math.hypot(self.truth.message.pose.pose.position.x, self.truth.message.pose.pose.position.y) < 0.01,
        )
        self.assertLess(abs(self.robot.speed), 0.05)
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s in it", self.robot.driving)

    def test_an_injected_fault_is_seen_and_heals(self) -> None:
        self.assertTrue(self.inject("e_stop_button", "off")[0])
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01, every=lambda: self.robot.send(0.5, 0.2))
        wait_for("its name", lambda: "e_stop_button off" in self.plant.values.get("injected", ""))
        self.assertTrue(self.inject("e_stop_button", "ok")[0])
        wait_for("nothing injected", lambda: self.plant.values["injected"] == "none")
        self.robot.release()
