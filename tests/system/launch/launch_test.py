"""sim.launch: a run that ends by itself, its log, its bag, a namespace of its own."""

import os
import re
import signal
import tempfile
import time
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosbag
import rosgraph
import rospy
from robot_control.data.record.main import TOPICS
from robot_control.data.run_log import read_log
from robot_control.msg import RobotKind, SafetyStatus
from system.launch_support import LAUNCH_LIMIT, Launch
from system.system_support import ESTIMATOR, MONITOR, Latest, Robot, refusal, repository, wait_for
from tf2_msgs.msg import TFMessage

COMMANDS = {"cmd_vel", "cmd_vel_stamped", "joy_vel", "key_vel", "console_vel", "path_vel", "pause"}
OF_OTHER_NODES = {
    "e_stop",
    "heartbeat",
    "clearance",
    "joy",
    "imu/input",
    "path_wanted",
    "view/markers",
    "view/path_driven",
}
OF_LEGS = {"body_pose", "foot_target", "joint_trajectory", "leg_state"}
OF_NAVIGATION = {
    "scan",
    "guard_state",
    "map",
    "map_metadata",
    "localization_state",
    "amcl_pose",
    "particlecloud",
    "initialpose",
    "follow_path/velocity",
}
SILENT = COMMANDS | OF_OTHER_NODES | OF_LEGS | OF_NAVIGATION | {"battery_state", "tf_static", "/clock", "/rosout"}
"""Topics on which there may be no messages. The robot has no battery, no transform is static, and /clock belongs to
lockstep. The nodes may have logged all messages before the recorder came."""


def received_by_recorder(namespace: str) -> set[str]:
    """Topics of which the recorder has had messages; rosbag adds a number to its name."""
    master = rosgraph.Master("/launch_test")
    try:
        _, subscribers, _ = master.getSystemState()
        prefix = rosgraph.names.ns_join(namespace, "record_")
        recorder = next(name for _, names in subscribers for name in names if name.startswith(prefix))
        # roscpp answers with the bare statistics: publications first, then subscriptions.
        subscriptions = ServerProxy(master.lookupNode(recorder)).getBusStats("/launch_test")[1]
    except (StopIteration, rosgraph.MasterException, OSError):
        return set()  # the recorder is not there yet
    return {topic for topic, links in subscriptions if any(link[2] > 0 for link in links)}


class LaunchTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name, "not", "there", "yet")
        self.bus = f"launch{os.getpid()}.{time.monotonic_ns()}"
        self.addCleanup(self.remove_what_stays)

    def remove_what_stays(self) -> None:
        """Removes parameters and shared memory, which outlive a launch."""
        for name in ("/robot", "/mujoco_plant"):
            if rospy.has_param(name):
                rospy.delete_param(name)
        for path in Path("/dev/shm").glob(f"robot_control.*.{self.bus}.*"):
            path.unlink(missing_ok=True)

    def launch(self, *arguments: str) -> Launch:
        launch = Launch("telemetry:=true", f"out:={self.out}", f"bus:={self.bus}", *arguments)
        self.addCleanup(launch.end)
        return launch

    def run_lockstep(self, cycles: int, *arguments: str) -> list[str]:
        """Runs a launch that ends by itself, with a row for every cycle; returns the names of the log's columns."""
        script = self.out.parents[2] / "script.csv"
        script.write_text("cycle,linear,angular\n0,0.5,0.2\n1000,0.5,0.2\n")
        launch = self.launch("clock:=lockstep", f"cycles:={cycles}", f"command_script:={script}", *arguments)
        self.assertEqual(launch.wait(), 0, launch.output)
        for alarm in ("REQUIRED process", "has died", " overrides "):
            self.assertNotIn(alarm, launch.output)
        self.assertIn(f"the run has ended after {cycles} cycles", launch.output)
        log = read_log(self.out / "run.bag")
        self.assertEqual(log["cycle"].size, cycles, launch.output)
        return list(log)

    def record(self, namespace: str) -> set[str]:
        """Topics in the bag of a launch that ran until the recorder had received all that is published."""
        ns = [f"__ns:={namespace}"] if namespace else []
        launch = self.launch("clock:=wall", "record:=true", *ns)
        published = {rosgraph.names.ns_join(f"/{namespace}", topic) for topic in set(TOPICS) - SILENT}

        def received() -> bool:
            self.assertTrue(launch.running, launch.output)
            return published <= received_by_recorder(f"/{namespace}")

        wait_for("a message of every topic at the recorder", received, LAUNCH_LIMIT)
        launch.end()
        bags = [path for path in (self.out / namespace).glob("*.bag") if path.name != "run.bag"]  # that is the log
        self.assertEqual(len(bags), 1, launch.output)
        with rosbag.Bag(str(bags[0])) as bag:
            topics = set(bag.get_type_and_topic_info().topics)
        self.assertLessEqual(published, topics)
        return topics

    def test_ends_by_itself_with_every_row_and_keeps_an_earlier_log(self) -> None:
        self.run_lockstep(3000)
        first = (self.out / "run.bag").read_bytes()
        self.run_lockstep(200)
        self.assertEqual((self.out / "run.1.bag").read_bytes(), first)

        # Both outlive the launch; a message of either refers to the other.
        self.assertEqual((rospy.get_param("/use_sim_time"), rospy.get_param("/robot/clock")), (True, "lockstep"))
        rospy.set_param("/use_sim_time", False)
        self.assertIn("`rosparam delete /robot/clock`", refusal(MONITOR))

    def test_no_argument_of_a_launch_outlives_it_and_paths_count_from_the_caller(self) -> None:
        folder = self.out.parents[2]
        (folder / "two_lines.yaml").write_text(
            "diff_drive_controller: {max_linear_speed: 0.4}\ntelemetry: {record: always}\n"
        )
        (folder / "stop.csv").write_text("cycle,linear,angular\n0,0,0\n")
        given = ["scene:=slope_5deg", "seed:=7", "params:=two_lines.yaml", "command_script:=stop.csv"]
        first = Launch("clock:=lockstep", "cycles:=200", "telemetry:=true", "out:=rel", *given, folder=folder)
        self.addCleanup(first.end)
        self.assertEqual(first.wait(), 0, first.output)
        self.assertTrue((folder / "rel" / "run.bag").is_file(), first.output)
        self.assertTrue(rospy.get_param("/mujoco_plant/scene").endswith("/slope_5deg.xml"))
        for name, given in (("robot/command_script", "stop.csv"), ("safety_monitor/config", "two_lines.yaml")):
            self.assertEqual(rospy.get_param(name), str(folder / given), "resolved for every other reader")

        second = Launch("clock:=lockstep", "cycles:=200", without="HOME")
        self.addCleanup(second.end)
        self.assertEqual(second.wait(), 0, second.output)
        plant = rospy.get_param("/mujoco_plant")
        self.assertEqual(set(plant), {"config", "cycles", "scene", "seed", "laser", "terrain"})
        self.assertEqual(
            [plant[key] for key in ("scene", "seed", "laser", "terrain")], ["", "", {"rate": ""}, {"kind": ""}]
        )
        self.assertEqual([rospy.get_param(f"/robot/{name}") for name in ("urdf", "command_script", "bus")], [""] * 3)
        self.assertTrue(rospy.get_param("/diff_drive_controller/config").endswith("/robot_params.yaml"))

    def test_a_robot_that_is_refused_is_refused_once_and_ends_the_launch(self) -> None:
        urdf = self.out.parents[2] / "refused.urdf"
        shipped = repository() / "urdf"
        for text, reason in (  # all nodes refuse the first one, its controller alone the second
            ((shipped / "diffbot.urdf").read_text().replace('"continuous"', '"fixed"'), "no drive wheels found"),
            (re.sub(r'effort="[0-9.]+"', 'effort="3"', (shipped / "quadbot.urdf").read_text()), "half of the weight"),
        ):
            urdf.write_text(text)
            launch = Launch(f"urdf:={urdf}", f"bus:={self.bus}")
            self.addCleanup(launch.end)
            launch.wait()
            self.assertEqual(launch.output.count(reason), 1, launch.output)
            for alarm in ("REQUIRED process", "has died", "Traceback"):
                self.assertNotIn(alarm, launch.output)
            self.assertIn(reason, rospy.get_param("/start_refused"))

    def test_the_kind_is_found_and_a_stop_belongs_to_its_robot(self) -> None:
        urdf = self.out.parents[2] / "dog.urdf"
        urdf.write_text((repository() / "urdf" / "quadbot.urdf").read_text())
        robot, kind = Robot("robot4"), Latest("/robot4/robot_kind", RobotKind)
        rospy.set_param("/robot4/robot_description", "<robot name='left over'/>")
        dog = Launch(f"urdf:={urdf}", "ns:=robot4", f"bus:={self.bus}")
        self.addCleanup(dog.end)
        wait_for("its kind", lambda: kind.message and "leg_controller" in kind.message.nodes)
        wait_for("the loop", lambda: robot.state in {SafetyStatus.READY, SafetyStatus.INIT})
        robot.call("e_stop_trigger")
        wait_for("the stop", lambda: robot.state == SafetyStatus.STOPPED)
        dog.end()
        for unwanted in ("robot_description", "log: "):  # it was typed; no log is written without `telemetry`
            self.assertNotIn(unwanted, dog.output)
        rospy.delete_param("/robot4/robot_description")
        robot.status = None
        self.addCleanup(Launch("ns:=robot4", f"bus:={self.bus}").end)
        wait_for("its status", lambda: robot.status is not None)
        wait_for("the end of INIT", lambda: robot.state != SafetyStatus.INIT, every=lambda: robot.send(0, 0))
        self.assertNotIn("e_stop_service", robot.causes)

    def test_drives_the_urdf_it_is_given(self) -> None:
        urdf = self.out.parents[2] / "other.urdf"
        urdf.write_text((repository() / "urdf" / "diffbot.urdf").read_text().replace("left_wheel_joint", "port_joint"))
        self.assertIn("port_joint_velocity", self.run_lockstep(200, f"urdf:={urdf}"))

    def test_records_every_topic_that_has_messages(self) -> None:
        topics = self.record("")
        self.assertLessEqual({"/odom", "/tf", "/joint_states", "/cmd_vel_out", "/imu/data_raw"}, topics)
        self.assertTrue((self.out / "run.bag").is_file())

    def test_second_robot_logs_and_records_in_a_folder_of_its_own(self) -> None:
        topics = self.record("robot2")
        self.assertLessEqual({"/robot2/odom", "/robot2/tf", "/diagnostics"}, topics)
        self.assertNotIn("/odom", topics)
        self.assertTrue((self.out / "robot2" / "run.bag").is_file())
        self.assertFalse((self.out / "run.bag").exists())

    def test_in_a_namespace_by_argument_a_killed_node_is_started_again(self) -> None:
        urdf = self.out.parents[2] / "free.urdf"
        world = '<link name="world"/><joint name="free" type="floating"><parent link="world"/><child link="base_link"/>'
        shipped = (repository() / "urdf" / "diffbot.urdf").read_text()
        urdf.write_text(shipped.replace("</robot>", world + "</joint></robot>"))
        launch = Launch("ns:=robot3", "respawn:=true", f"bus:={self.bus}", f"urdf:={urdf}")
        self.addCleanup(launch.end)
        robot = Robot("robot3")
        robot.await_ready()
        parents: dict[str, str] = {}
        for topic in ("tf", "tf_static"):
            rospy.Subscriber(
                f"/robot3/{topic}",
                TFMessage,
                lambda m: parents.update({t.child_frame_id: t.header.frame_id for t in m.transforms}),
            )
        wait_for("transforms of the robot", lambda: {"base_link", "imu_link", "left_wheel_link"} <= set(parents))
        self.assertEqual(parents["base_link"], "odom")
        self.assertNotIn("world", parents.values())
        name = f"/robot3/{ESTIMATOR}"
        first = pid_of(name)
        os.kill(first, signal.SIGKILL)
        wait_for("another process", lambda: pid_of(name) not in {0, first})
        wait_for("the latched stop", lambda: robot.state == SafetyStatus.STOPPED)
        robot.release()
        robot.drive_until("0.5 m/s", robot.driving)
        self.assertTrue(launch.running, launch.output)


def pid_of(node: str) -> int:
    """Process id of a node; 0 if there is none."""
    try:
        return int(ServerProxy(rosgraph.Master("/launch_test").lookupNode(node)).getPid("/launch_test")[2])
    except (rosgraph.MasterException, OSError):
        return 0
