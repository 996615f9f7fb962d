"""The commands of docs/navigation.md are followed, from an empty house to a goal; a path stands for the hand's drive."""

import importlib.util

import pytest
from pages import ROOT, blocks
from terminal import Terminal, until

MRPT = importlib.util.find_spec("robot_control._mrpt")
ROOMS = "x,y\n0.1,0\n6.8,0\n6.8,1.6\n"
"""m; from where the robot starts into the room of the goal"""
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


@pytest.mark.skipif(MRPT is None, reason="slam was built without MRPT: scripts/setup --navigation")
def test_the_page_of_navigation_is_followed_from_an_empty_house_to_a_goal(tmp_path):
    house, hand, save, again, goal = next(
        block.commands() for block in blocks(ROOT / "docs" / "navigation.md") if "scene:=room" in block.text
    )
    assert hand == "rosrun robot_control teleop.py"
    (tmp_path / "rooms.csv").write_text(ROOMS)
    terminal = Terminal(tmp_path)
    try:
        terminal.run(house)
        until(lambda: "/save_map" in terminal.registered(), "slam", terminal.launch)
        terminal.run_python(LOCALIZED)
        terminal.run("rosrun robot_control drive_path.py --in-odom rooms.csv")
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
