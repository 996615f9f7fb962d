#!/usr/bin/python3
"""The services of a simulated machine, called as a user of ROS calls them."""

import math
import time

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from robot_control.msg import SafetyStatus
from robot_control.srv import InjectFault, Step
from std_srvs.srv import SetBool, Trigger
from system_support import DRIVER, LIMIT, SEND_PERIOD, RobotTestCase, wait_for


class ServicesTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.truth: Odometry | None = None
        cls.plant: dict[str, str] = {}
        cls.plant_message = ""
        rospy.Subscriber("ground_truth/odom", Odometry, cls.receive_truth)
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls.receive_diagnostics)
        for name in ("set_pause", "step", "reset", "inject_fault"):
            rospy.wait_for_service(f"{DRIVER}/{name}", LIMIT)

    @classmethod
    def receive_truth(cls, message: Odometry) -> None:
        cls.truth = message

    @classmethod
    def receive_diagnostics(cls, message: DiagnosticArray) -> None:
        for status in message.status:
            if status.name == DRIVER:
                cls.plant_message = status.message
                cls.plant = {pair.key: pair.value for pair in status.values}

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
        self.plant.clear()
        wait_for("diagnostics of the plant", lambda: "cycle" in self.plant)
        return int(self.plant["cycle"])

    def test_paused_the_robot_stands_and_so_does_its_time(self) -> None:
        self.set_pause(True)
        time.sleep(0.3)  # earlier messages arrive
        truth, odom = self.truth, self.robot.odom
        time.sleep(1.5)  # far longer than the 20 periods after which a silent driver is lost
        self.assertIs(self.truth, truth)
        self.assertIs(self.robot.odom, odom)
        wait_for("word of it", lambda: self.plant_message == "paused")
        self.assertEqual(self.plant["driver_state"], "paused")
        self.assertGreater(float(self.plant["real_time_factor"]), 0)
        self.assertIn("paused", self.robot.call("e_stop_reset").message)
        self.set_pause(False)
        wait_for("odometry", lambda: self.robot.odom is not odom)
        self.assertNotIn("driver_lost", self.robot.causes)
        wait_for("stamps of now", lambda: abs(rospy.get_time() - self.robot.odom.header.stamp.to_sec()) < 1.0)
        self.robot.drive_until("0.5 m/s again", self.robot.driving)

    def test_a_command_of_a_pause_moves_nothing_after_it(self) -> None:
        self.robot.await_rest()
        self.set_pause(True)
        wait_for("word of it", lambda: self.plant_message == "paused")
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
        wait_for("truth of it", lambda: math.hypot(*self.position(self.truth)) < 0.01)
        self.assertLess(abs(self.robot.speed), 0.05)
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s in it", self.robot.driving)

    def test_a_reset_releases_no_stop(self) -> None:
        run = self.robot.status.run
        self.assertTrue(self.robot.call("e_stop_trigger").success)
        wait_for("the stop", lambda: "e_stop_service" in self.robot.causes)
        self.reset()
        wait_for("a new run", lambda: self.robot.status.run not in (0, run))
        self.assertEqual(self.robot.state, SafetyStatus.STOPPED)
        self.assertIn("e_stop_service", self.robot.causes)
        self.robot.release()

    def test_a_paused_robot_is_reset_and_stepped_from_cycle_zero(self) -> None:
        self.set_pause(True)
        self.reset()
        self.assertTrue(self.step(3)[0])
        self.assertEqual(self.cycle(), 2)

    def test_an_injected_fault_is_seen_and_heals(self) -> None:
        self.assertTrue(self.inject("e_stop_button", "off")[0])
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01, every=lambda: self.robot.send(0.5, 0.2))
        wait_for("its name", lambda: "e_stop_button off" in self.plant.get("injected", ""))
        self.assertTrue(self.inject("e_stop_button", "ok")[0])
        wait_for("nothing injected", lambda: self.plant["injected"] == "none")
        self.robot.release()

    def test_an_unknown_fault_is_refused_with_the_list(self) -> None:
        for words, known in ((("left_wing", "off"), "right_motor"), (("gyro", "broken"), "intermittent")):
            success, message = self.inject(*words)
            self.assertFalse(success)
            self.assertIn(known, message)

    def test_the_fault_of_a_node_is_refused_with_the_remedy(self) -> None:
        for node in ("controller", "estimator", "monitor"):
            success, message = self.inject(node, "off")
            self.assertFalse(success)
            self.assertIn("kill -STOP", message)

    @staticmethod
    def position(message: Odometry) -> tuple[float, float]:
        return message.pose.pose.position.x, message.pose.pose.position.y


if __name__ == "__main__":
    rostest.rosrun("robot_control", "services", ServicesTest)
