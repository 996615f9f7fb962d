"""A program that must not start refuses with a reason, and does not disturb running ones."""

import os
import socket
import subprocess
import tempfile
import unittest
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import rospy
import yaml
from geometry_msgs.msg import Twist, TwistStamped
from robot_control.msg import SafetyStatus
from std_msgs.msg import Float64MultiArray
from system.system_support import (
    CONTROLLER,
    DRIVER,
    ESTIMATOR,
    LOOP,
    MONITOR,
    Program,
    refusal,
    repository,
    running_robot,
    wait_for,
)


def unprivileged() -> list[str]:
    """A prefix that runs a command without real-time privileges; skips the test if there is none."""
    prefix = ["prlimit", "--rtprio=0:0", "--memlock=65536:65536"]
    if os.geteuid() == 0:
        prefix += ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--inh-caps=-all"]
    look = [*prefix, "test", "-r", str(repository() / "config" / "robot_params.yaml")]
    answer = subprocess.run(look, capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        raise unittest.SkipTest(f"no unprivileged user can be had that reads the package: {answer.stderr or look}")
    status = subprocess.run([*prefix, "cat", "/proc/self/status"], capture_output=True, text=True, check=True).stdout
    if int(status.partition("CapEff:")[2].split()[0], 16) != 0:
        raise unittest.SkipTest("this user's programs keep capabilities, and with them the privileges")
    return prefix


@contextmanager
def parameter(name: str, value: object) -> Iterator[None]:
    """Sets a parameter on the server for the block."""
    rospy.set_param(name, value)
    try:
        yield
    finally:
        rospy.delete_param(name)


def free_port() -> int:
    """A loopback port where no process listens."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class StartTest(unittest.TestCase):
    def test_prints_its_usage_or_refuses_an_argument_without_a_master(self) -> None:
        environment = {"ROS_MASTER_URI": f"http://127.0.0.1:{free_port()}"}
        programs = [*LOOP, "telemetry"]
        with tempfile.TemporaryDirectory() as folder:
            for name in programs:
                program = Program(name, "--help", environment=environment, prefix=["env", "-C", folder])
                self.assertEqual(program.wait(), 0, program.output)
                self.assertIn(f"usage: rosrun robot_control {name} ", program.output)
                for argument in ("--verbose", "surplus"):
                    said = refusal(name, argument, environment=environment, prefix=["env", "-C", folder])
                    self.assertIn(f"argument '{argument}' is unknown", said)
            self.assertEqual(list(Path(folder).iterdir()), [], "a node that does not start writes nothing")

    def test_refuses_bad_parameters_all_at_once(self) -> None:
        folder = repository() / "config"
        tree = yaml.safe_load((folder / "robot_params.yaml").read_text())
        tree["robot"]["urdf"] = str(folder / tree["robot"]["urdf"])
        tree["mujoco_plant"]["scene"] = str(folder / tree["mujoco_plant"]["scene"])
        tree["robot"]["rate"] = 9
        tree["diff_drive_controller"]["pid_kp"] = float("nan")
        tree["diff_drive_controller"]["max_linear_sped"] = 1.0
        tree["safety_monitor"]["loss_cycles"] = -3
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            yaml.safe_dump(tree, file)
            file.flush()
            for name in LOOP:
                output = refusal(name, f"_config:={file.name}")
                for path in ("robot.rate", "pid_kp", "max_linear_sped", "loss_cycles"):
                    self.assertIn(path, output, name)
        self.forget(*LOOP)

    def test_refuses_paths_that_are_no_regular_files_and_too_few_descriptors(self) -> None:
        for argument in ("_config:=/dev/zero", "_urdf:=/dev/zero", "_scene:=/dev/zero"):
            self.assertIn("is a device; only a regular file is read", refusal(DRIVER, argument))
            self.forget(DRIVER)
        for name in LOOP:
            for files in (8, 32):
                said = refusal(name, prefix=["prlimit", f"--nofile={files}:{files}"])
                self.assertIn(f"only {files} files may be open at a time", said)
                self.assertIn("remedy: `ulimit -n 1024`", said)

    def test_refusal_shows_the_overrides_in_force(self) -> None:
        output = refusal(DRIVER, "_urdf:=/nonexistent.urdf")
        self.assertIn("/mujoco_plant/urdf", output, "where it stands")
        self.assertIn("/nonexistent.urdf", output)
        self.forget(DRIVER)

    def test_refuses_without_the_real_time_that_is_required(self) -> None:
        # They are refused at once: no other node runs.
        prefix = unprivileged()
        with parameter("robot/realtime", "required"), tempfile.TemporaryDirectory() as home:
            Path(home).chmod(0o777)
            output = refusal(MONITOR, prefix=prefix, environment={"ROS_HOME": home})
        self.assertIn("realtime: required, but", output)
        self.assertIn("memory is not locked", output)
        self.assertIn("SCHED_FIFO", output)
        self.assertIn("rtprio 99", output, "the remedy")

    def test_refuses_simulated_time_left_over(self) -> None:
        rospy.set_param("/use_sim_time", True)
        try:
            self.assertIn("/use_sim_time", refusal(MONITOR))
        finally:
            rospy.set_param("/use_sim_time", False)

    def test_second_instance_is_refused_and_the_first_drives_on(self) -> None:
        with running_robot() as robot:
            for name in LOOP:
                robot.drive_until("0.5 m/s", robot.driving)
                second = Program(name)
                wait_for(
                    f"the refusal of a second {name}",
                    lambda second=second: not second.running,
                    every=lambda: robot.send(0.5, 0.2),
                )
                self.assertEqual(second.wait(), 1, second.output)
                self.assertTrue(robot.nodes[name].running)
                count = robot.odom_count
                robot.drive_until(
                    "0.5 m/s still", lambda count=count: robot.driving() and robot.odom_count > count + 10
                )
            renamed = Program(CONTROLLER, "__name:=second_controller")
            self.assertEqual(renamed.wait(), 1, "another name is no other controller")

    def test_ends_with_0_on_sigint(self) -> None:
        with running_robot() as robot:
            for node in robot.nodes.values():
                self.assertEqual(node.end(), 0, node.output)

    def test_a_command_before_the_loop_runs_is_dropped_and_that_is_said_once(self) -> None:
        program = Program(CONTROLLER)
        try:
            sender = rospy.Publisher("cmd_vel", Twist, queue_size=1)
            complaint = f"a command of {rospy.get_name()} arrived before the loop runs and is ignored"
            wait_for("a line", lambda: complaint in program.output, every=lambda: sender.publish(Twist()))
            for _ in range(20):
                sender.publish(Twist())
                rospy.sleep(0.01)
            self.assertEqual(program.output.count(complaint), 1)
        finally:
            objects = program.shared_memory()
            program.end()
        for path in objects:
            path.unlink(missing_ok=True)

    def test_waits_for_the_master_and_says_so_once(self) -> None:
        port = free_port()
        with tempfile.TemporaryDirectory() as logs:
            environment = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_LOG_DIR": logs}
            program = Program(MONITOR, environment=environment)
            master = None
            objects: set[Path] = set()
            try:
                notice = f"waiting for the ROS master at {environment['ROS_MASTER_URI']}"
                wait_for("the notice", lambda: notice in program.output)
                master = subprocess.Popen(
                    ["rosmaster", "--core", "-p", str(port)],
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    env={**os.environ, **environment},
                )
                wait_for("its start", lambda: "waiting for mujoco_plant" in program.output)
                objects = program.shared_memory()
                self.assertEqual(program.output.count(notice), 1, program.output)
            finally:
                program.end()
                if master is not None:
                    master.terminate()
                    master.wait()
                for path in objects:
                    path.unlink(missing_ok=True)

    def test_waiting_for_a_master_ends_on_sigint(self) -> None:
        program = Program(MONITOR, environment={"ROS_MASTER_URI": f"http://127.0.0.1:{free_port()}"})
        try:
            wait_for("the notice", lambda: "waiting for the ROS master" in program.output)
        finally:
            code = program.end()
        self.assertEqual(code, 0, program.output)

    def test_publishes_nothing_of_an_earlier_session_as_fresh(self) -> None:
        # The controller ends first, so its last command drives; then the monitor latches its loss.
        with running_robot() as robot:
            robot.drive_until("0.5 m/s", robot.driving)
            robot.nodes[CONTROLLER].end()
            wait_for("controller_lost", lambda: "controller_lost" in robot.causes)
            for name in LOOP:
                robot.nodes[name].end()
            run = robot.status.run
            robot.status = robot.odom = None

            wheels: list[float] = []
            limited: list[float] = []
            reported: list[SafetyStatus] = []
            subscribers = [
                rospy.Subscriber("joint_commands", Float64MultiArray, lambda m: wheels.extend(m.data)),
                rospy.Subscriber("cmd_vel_out", TwistStamped, lambda m: limited.append(m.twist.linear.x)),
                rospy.Subscriber("safety_status", SafetyStatus, reported.append),
            ]
            robot.start(MONITOR)
            absent = {DRIVER, ESTIMATOR, CONTROLLER}
            wait_for("the names of the missing nodes", lambda: reported and set(reported[-1].missing) == absent)
            robot.start(CONTROLLER)
            wait_for("the controller's wait", lambda: "waiting for mujoco_plant" in robot.nodes[CONTROLLER].output)
            for status in reported:  # the latch outlives its processes
                self.assertEqual((status.state, status.causes), (SafetyStatus.STOPPED, ["controller_lost"]), status)
            self.assertIn("latched since before this start: controller_lost", robot.nodes[MONITOR].output)
            self.assertEqual((wheels, limited), ([], []), "nothing has been commanded")
            answer = robot.call("e_stop_trigger")  # without a single sensor frame
            self.assertTrue(answer.success, answer.message)
            wait_for("the stop", lambda: "e_stop_service" in robot.causes)

            robot.start(DRIVER, ESTIMATOR)
            robot.await_ready()
            self.assertNotEqual(robot.status.run, run)
            wait_for("50 commands", lambda: len(limited) > 50 and len(wheels) > 100)
            for subscriber in subscribers:
                subscriber.unregister()
            # The channel held 0.5 m/s, 4.5 and 5.5 rad/s.
            self.assertLess(max(map(abs, limited)), 0.01)
            self.assertLess(max(map(abs, wheels)), 0.1)
            self.assertNotIn("left 0.45 m/s", robot.nodes[CONTROLLER].output)

    def forget(self, *names: str) -> None:
        """Private parameters outlive their nodes."""
        for name in names:
            if rospy.has_param(name):
                rospy.delete_param(name)
