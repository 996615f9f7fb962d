#!/usr/bin/python3
"""What must not start does not, and says why; what runs is not disturbed."""

import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
import yaml
from system_support import (
    CONTROLLER,
    LOOP,
    MONITOR,
    PLANT,
    Program,
    init_test_node,
    repository,
    running_robot,
    wait_for,
)


def refusal(name: str, *arguments: str) -> str:
    """Starts a node that must refuse; what it says."""
    program = Program(name, *arguments)
    try:
        code = program.wait()
    finally:
        program.end()
    assert code == 1, f"{name} ended with {code}, not 1:\n{program.output}"
    return program.output


class StartTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        init_test_node("start_test")

    def test_refuses_bad_parameters_all_at_once(self) -> None:
        folder = repository() / "config"
        tree = yaml.safe_load((folder / "robot_params.yaml").read_text())
        tree["robot"]["urdf"] = str(folder / tree["robot"]["urdf"])
        tree["mujoco_plant"]["scene"] = str(folder / tree["mujoco_plant"]["scene"])
        del tree["robot"]["rate"]
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

    def test_refuses_an_unknown_key_on_the_parameter_server(self) -> None:
        output = refusal(CONTROLLER, "_pid_kq:=2.0")
        self.assertIn("pid_kq", output)
        self.assertIn("/diff_drive_controller/pid_kq", output, "where it stands")
        self.forget(CONTROLLER)

    def test_refuses_simulated_time_left_over(self) -> None:
        rospy.set_param("/use_sim_time", True)
        try:
            self.assertIn("/use_sim_time", refusal(MONITOR))
        finally:
            rospy.set_param("/use_sim_time", False)

    def test_refuses_lockstep_without_simulated_time(self) -> None:
        rospy.set_param("robot/clock", "lockstep")
        try:
            self.assertIn("/use_sim_time", refusal(MONITOR))
        finally:
            rospy.delete_param("robot")

    def test_refuses_a_robot_without_wheels_and_a_scene_that_does_not_compile(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            urdf, scene = Path(name, "box.urdf"), Path(name, "scene.xml")
            inertia = "<mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
            urdf.write_text(f"<robot name='box'><link name='base_link'><inertial>{inertia}</inertial></link></robot>")
            scene.write_text("<mujoco><worldbody><geom type='nonsense'/></worldbody></mujoco>")
            self.assertIn("left_wheel_joint", refusal(PLANT, f"_urdf:={urdf}"))
            self.forget(PLANT)
            self.assertIn("nonsense", refusal(PLANT, f"_scene:={scene}"))
            self.forget(PLANT)

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

    def test_waiting_node_names_whom_it_waits_for(self) -> None:
        program = Program(CONTROLLER)
        try:
            wait_for("the names", lambda: "waiting for mujoco_plant, state_estimator, safety_monitor" in program.output)
        finally:
            objects = program.shared_memory()
            program.end()
        for path in objects:
            path.unlink(missing_ok=True)

    def forget(self, *names: str) -> None:
        """Private parameters outlive their nodes."""
        for name in names:
            if rospy.has_param(name):
                rospy.delete_param(name)


if __name__ == "__main__":
    rostest.rosrun("robot_control", "start", StartTest)
