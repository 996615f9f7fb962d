"""Any robot drives, however its description is given: by the plant's argument or on the parameter server."""

import tempfile
import unittest
from pathlib import Path

import rospy
from system.system_support import DRIVER, LOOP, Program, Robot, repository, wait_for

PORT, STARBOARD = "port_joint", "starboard_joint"


def other_robot() -> str:
    """diffbot with other names; its root is a base_footprint."""
    text = (repository() / "urdf" / "diffbot.urdf").read_text()
    for old, new in [("left_wheel_joint", PORT), ("right_wheel_joint", STARBOARD), ("base_link", "base_footprint")]:
        text = text.replace(old, new)
    return text


def free_robot() -> str:
    """The other robot on a floating joint, in the form in which several simulators write it."""
    world = '<link name="world"/><joint name="free" type="floating"><parent link="world"/>'
    world += '<child link="base_footprint"/><origin xyz="1 2 3"/></joint>'
    return other_robot().replace("</robot>", world + "</robot>")


class DescriptionTest(unittest.TestCase):
    def setUp(self) -> None:
        self.robot = Robot()

    def tearDown(self) -> None:
        self.robot.end()

    def await_other_robot(self) -> None:
        self.robot.await_ready()
        self.assertEqual(self.robot.joints.name[:2], [PORT, STARBOARD])
        self.assertEqual(self.robot.odom.child_frame_id, "base_footprint", "the root link: one parent for every frame")
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def test_the_plants_urdf_becomes_every_nodes_and_ends_with_it(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder, "other.urdf")
            urdf.write_text(other_robot())
            self.robot.nodes[DRIVER] = Program(DRIVER, f"_urdf:={urdf}")
            wait_for("the description", lambda: PORT in rospy.get_param("robot_description", ""))
            wait_for("its file", lambda: rospy.get_param("robot/urdf", "") == str(urdf))
            self.robot.start(*(name for name in LOOP if name != DRIVER))
            self.await_other_robot()
            self.assertIn(f"left wheels {PORT}", self.robot.nodes[DRIVER].output)
            self.robot.nodes[DRIVER].end()
        for name in ("robot_description", "robot/urdf", f"{DRIVER}/urdf"):
            self.assertFalse(rospy.has_param(name), name)

    def test_a_description_on_the_parameter_server_drives_the_plant_too(self) -> None:
        rospy.set_param("robot_description", free_robot())
        try:
            self.robot.start()
            self.await_other_robot()
            self.robot.nodes[DRIVER].end()
            self.assertEqual(rospy.get_param("robot_description"), free_robot(), "the user's, left as it was")
        finally:
            rospy.delete_param("robot_description")
