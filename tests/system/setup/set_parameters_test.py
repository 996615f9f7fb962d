"""diff_drive_controller/set_parameter_map and set_parameters (dynamic_reconfigure), called while the robot drives."""

import re
import subprocess
import tempfile
from pathlib import Path

import rospy
import yaml
from dynamic_reconfigure.client import Client
from robot_control._robot_control import BagError, TraceError, read_run_header
from robot_control.msg import SafetyStatus
from robot_control.srv import SetParameters
from system.system_support import CONTROLLER, LIMIT, Program, RobotTestCase, wait_for

SERVICE = f"/{CONTROLLER}/set_parameter_map"
START = "{max_linear_speed: 1.0, cmd_vel_timeout: 1.25}"
"""The tests begin with these values, whatever an earlier test left on the parameter server."""


class SetParametersTest(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        cls.telemetry = Program("telemetry", f"_directory:={cls.folder.name}", "_record:=always", "_split_time:=2")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.telemetry.end()
        rospy.delete_param(CONTROLLER)
        super().tearDownClass()
        cls.folder.cleanup()

    def setUp(self) -> None:
        rospy.wait_for_service(SERVICE, LIMIT)
        self.robot.await_ready()
        self.accept(START)
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def accept(self, parameters: str) -> int:
        """The number of the set."""
        answer = rospy.ServiceProxy(SERVICE, SetParameters)(parameters)
        self.assertTrue(answer.success, answer.message)
        return int(re.match(r"set (\d+): ", answer.message)[1])

    def test_a_set_is_taken_while_the_robot_drives_on(self) -> None:
        number = self.accept("{max_linear_speed: 0.3, pid_kp: 1.5, feed_forward: {mass: 12.5}}")
        self.robot.drive_until("0.3 m/s", lambda: 0.2 < self.robot.speed < 0.32)
        self.assertEqual(rospy.get_param(f"{CONTROLLER}/max_linear_speed"), 0.3)
        self.assertEqual(rospy.get_param(f"{CONTROLLER}/feed_forward/mass"), 12.5)
        reported = f"set_parameters: set {number}: max_linear_speed from 1 to 0.3, pid_kp from"
        wait_for("a line of it", lambda: reported in self.robot.nodes[CONTROLLER].output)

    def test_the_next_file_of_the_log_begins_with_the_values_in_force(self) -> None:
        self.accept("{max_linear_jerk: 9.5, feed_forward: {mass: 13.5}}")
        wait_for("a file that begins with them", lambda: self.header_holds(9.5, 13.5))

    def header_holds(self, jerk: float, mass: float) -> bool:
        try:
            header = read_run_header(str(Path(self.folder.name, "run.bag")))
        except (BagError, TraceError):  # the file has just begun
            return False
        controller = yaml.safe_load(header["parameters"])[CONTROLLER]
        mass_there = controller.get("feed_forward", {}).get("mass")
        return (controller.get("max_linear_jerk"), mass_there) == (jerk, mass)

    def test_the_command_line_of_the_manual_works(self) -> None:
        command = ["rosservice", "call", SERVICE, "parameters: '{max_linear_speed: 0.5}'"]
        answer = subprocess.run(command, capture_output=True, text=True, timeout=2 * LIMIT, check=False)
        self.assertIn("success: True", answer.stdout, answer.stderr)
        self.assertEqual(rospy.get_param(f"{CONTROLLER}/max_linear_speed"), 0.5)

    def test_a_controller_that_is_started_again_keeps_the_set(self) -> None:
        self.accept("{max_linear_speed: 0.3, keep_curvature: false}")
        self.robot.nodes[CONTROLLER].kill()
        wait_for("the stop", lambda: self.robot.state == SafetyStatus.STOPPED)
        self.robot.start(CONTROLLER)
        rospy.wait_for_service(SERVICE, LIMIT)
        self.robot.release()
        output = self.robot.nodes[CONTROLLER].output
        self.assertIn(f"/{CONTROLLER}/max_linear_speed = 0.3 overrides {CONTROLLER}.max_linear_speed", output)
        self.assertIn(f"/{CONTROLLER}/keep_curvature = false overrides", output)
        self.robot.drive_until("0.3 m/s", lambda: 0.2 < self.robot.speed < 0.32)
        self.assertEqual(self.accept("{keep_curvature: true}"), 1)

    def dynparam(self, *arguments: str) -> str:
        command = ["rosrun", "dynamic_reconfigure", "dynparam", *arguments]
        answer = subprocess.run(command, capture_output=True, text=True, timeout=2 * LIMIT, check=False)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        return answer.stdout

    def test_dynparam_lists_gets_and_sets(self) -> None:
        self.assertIn(f"/{CONTROLLER}", self.dynparam("list").split())
        self.assertIn("'max_linear_speed': 1.0", self.dynparam("get", CONTROLLER))
        self.dynparam("set", CONTROLLER, "max_linear_speed", "0.3")
        self.robot.drive_until("0.3 m/s", lambda: 0.2 < self.robot.speed < 0.32)
        self.assertEqual(rospy.get_param(f"{CONTROLLER}/max_linear_speed"), 0.3)
        self.dynparam("set", CONTROLLER, "{'max_linear_speed': 0.4, 'feed_forward_mass': 12.5}")
        self.assertIn("'max_linear_speed': 0.4", self.dynparam("get", CONTROLLER))
        self.assertEqual(rospy.get_param(f"{CONTROLLER}/feed_forward/mass"), 12.5)

    def test_the_client_of_dynamic_reconfigure_sees_every_set(self) -> None:
        seen: list[dict[str, object]] = []
        client = Client(CONTROLLER, timeout=LIMIT, config_callback=seen.append)
        self.addCleanup(client.close)
        ranges = {entry["name"]: entry for entry in client.get_parameter_descriptions(timeout=LIMIT)}
        self.assertEqual(ranges["max_linear_speed"]["max"], 50.0)
        self.assertEqual(ranges["keep_curvature"]["type"], "bool")
        answer = client.update_configuration({"max_linear_speed": 0.6, "keep_curvature": False})
        self.assertEqual((answer["max_linear_speed"], answer["keep_curvature"]), (0.6, False))
        self.accept("{max_linear_speed: 0.7, keep_curvature: true}")  # a set of another client
        wait_for("an update", lambda: bool(seen) and seen[-1]["max_linear_speed"] == 0.7)

    def test_a_refusal_answers_what_is_in_force_and_warns(self) -> None:
        client = Client(CONTROLLER, timeout=LIMIT)
        self.addCleanup(client.close)
        before = client.get_configuration(timeout=LIMIT)
        answer = client.update_configuration({"max_linear_speed": 0.2, "pid_kp": 900.0})
        self.assertEqual(answer["max_linear_speed"], 1.0)
        self.assertEqual(answer["pid_kp"], before["pid_kp"])
        wait_for("a line of it", lambda: "unstable" in self.robot.nodes[CONTROLLER].output)
