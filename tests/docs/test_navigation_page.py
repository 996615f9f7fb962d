"""The commands of docs/navigation.md are followed, from an empty map to a goal; a program drives as a hand would."""

import importlib.util
import re

import pytest
from language import cpp_texts
from pages import ROOT, blocks
from terminal import Terminal, until

MRPT = importlib.util.find_spec("robot_control._mrpt")
HAND = """
import rospy
from bench.navigation.tour import command_to
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from robot_control.robot.pose import pose_of
rospy.init_node("hand")
commands, seen = rospy.Publisher("cmd_vel", Twist, queue_size=1), [rospy.wait_for_message("odom", Odometry, 5)]
rospy.Subscriber("odom", Odometry, lambda message: seen.__setitem__(0, message), queue_size=1)
for corner in ((6.8, 0.0), (6.8, 1.6)):
    while True:
        pose = pose_of(seen[0])
        command = command_to((pose.x, pose.y, pose.yaw), corner)
        twist = Twist()
        twist.linear.x, twist.angular.z = command or (0.0, 0.0)
        commands.publish(twist)
        if command is None:
            break
        rospy.sleep(0.05)
"""
"""Drives from the start into the room of the goal; corners in m."""
LOCALIZED = """
import rospy
from robot_control.msg import LocalizationState
rospy.init_node("reader")
while rospy.wait_for_message("localization_state", LocalizationState, 30).state != "localized": pass
"""
END = """
import math, rospy
from move_base_msgs.msg import MoveBaseActionResult
from nav_msgs.msg import Odometry
rospy.init_node("reader")
end = rospy.wait_for_message("move_base/result", MoveBaseActionResult, 55)
at = rospy.wait_for_message("odom", Odometry, 5).pose.pose.position
print(end.status.text, at)
assert end.status.text == "reached" and math.hypot(at.x - 6.8, at.y - 2.0) < 0.2
"""


def test_each_message_of_the_page_is_one_of_the_program():
    page = (ROOT / "docs" / "navigation.md").read_text()
    rows = page.split("| message begins with |")[1].split("\n\n")[0].splitlines()[2:]
    messages = [code for row in rows for code in re.findall(r"`([^`]+)`", row.split("|")[1])]
    sources = [path for folder in ("navigation", "ros/navigation") for path in (ROOT / "src" / folder).rglob("*.cpp")]
    texts = [text for path in sources for _, text in cpp_texts(path.read_text())]
    assert len(messages) >= len(rows)
    assert [message for message in messages if not any(text.startswith(message) for text in texts)] == []


@pytest.mark.nightly
@pytest.mark.skipif(MRPT is None, reason="slam was built without MRPT: scripts/setup --navigation")
def test_the_page_of_navigation_is_followed_from_an_empty_map_to_a_goal(tmp_path):
    _install, house, hand, save, again, goal = next(
        block.commands() for block in blocks(ROOT / "docs" / "navigation.md") if "scene:=room" in block.text
    )
    assert hand == "rosrun robot_control teleop.py"
    terminal = Terminal(tmp_path)
    terminal.environment["PYTHONPATH"] = f"{ROOT}:{terminal.environment['PYTHONPATH']}"
    try:
        terminal.run(house)
        until(lambda: "/save_map" in terminal.registered(), "slam", terminal.launch)
        terminal.run_python(LOCALIZED)
        # Until the robot is ready, a sender that requests motion keeps it under the brake.
        until(lambda: "ready: send cmd_vel" in terminal.launch.text(), "ready", terminal.launch)
        terminal.run_python(HAND)
        terminal.run(save)
        assert {path.name for path in tmp_path.glob("house.*")} == {"house.yaml", "house.pgm"}
        terminal.run(again)
        until(lambda: {"/load_map", "/navigate/get_loggers"} <= terminal.registered(), "localization", terminal.launch)
        terminal.run_python(LOCALIZED)
        terminal.run(goal)
        terminal.run_python(END)
    except AssertionError as error:
        raise AssertionError(f"{error}\n{terminal.launch.text()}") from None
    finally:
        terminal.close()
