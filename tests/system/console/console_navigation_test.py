"""The console's map in a browser: the place of the robot, a goal and its cancel, each by a press and a drag."""

import math
import tempfile
import unittest
from pathlib import Path

import rospy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robot_control._navigation import write_map
from robot_control.drive.path.frames import Tf
from robot_control.drive.path.waypoints import PathError
from robot_control.msg import LocalizationState
from robot_control.robot.pose import Pose, yaw_of
from system.console.console_support import ConsoleTestCase
from system.navigation.navigation_support import missing, missing_mrpt, share
from system.system_support import Latest, Program, again_after_a_stall, wait_for

from bench.console.browser import Browser
from bench.navigation.scene_map import read_scene, true_map

CLICKED = 0.05
"""m on the map: some pixels of 4 mm, from above"""
SAME = 0.001
"""m; the page's numbers are rounded"""
AT_GOAL = CLICKED + 0.05 + 0.05
"""m in odometry: the click, the end of a path, and what localization corrects on the way"""
REASON = missing_mrpt() or missing()


@unittest.skipIf(REASON, REASON)
class ConsoleNavigationTest(ConsoleTestCase):
    map = Pose(0.0, 0.0, 0.0)

    @classmethod
    def setUpClass(cls) -> None:
        scene = share("urdf/scenes/room.xml")
        rospy.set_param("/mujoco_plant/scene", str(scene))
        rospy.set_param("/mujoco_plant/laser/rate", 10)
        rospy.set_param("/localization/map", str(Path(tempfile.mkdtemp(), "room.yaml")))
        write_map(rospy.get_param("/localization/map"), true_map(read_scene(scene)))
        super().setUpClass()
        names = ("state_publisher.py", "follow_path.py", "navigate")
        cls.programs = [Program(name) for name in names]
        cls.goal = Latest("move_base_simple/goal", PoseStamped)
        cls.place = Latest("initialpose", PoseWithCovarianceStamped)
        cls.tf = Tf()

    @classmethod
    def tearDownClass(cls) -> None:
        for program in reversed(cls.programs):
            program.end()
        super().tearDownClass()

    def setUp(self) -> None:
        """Each attempt begins without a place; the page keeps where it saw the map last."""
        super().setUp()
        self.addCleanup(Program("localization").end)
        self.state = Latest("localization_state", LocalizationState)

    def stroke(self, browser: Browser, button: str, ahead: float) -> None:
        """Presses the button, then the map so far ahead of the robot, and drags along x."""
        browser.click(button)
        drawing = "return document.getElementById('view').classList.contains('drawing')"
        wait_for("a map to press on", lambda: browser.run(drawing))
        here = self.robot.pose
        begin, end = (browser.pixel(here.x + way, here.y) for way in (ahead, ahead + 0.4))
        for kind, (x, y), held in (("mousePressed", begin, 1), ("mouseMoved", end, 1), ("mouseReleased", end, 0)):
            event = {"type": kind, "x": x, "y": y, "button": "left", "buttons": held, "clickCount": 1}
            browser.driver.execute_cdp_cmd("Input.dispatchMouseEvent", event)

    def knows_the_map(self, browser: Browser) -> bool:
        """True if the page has the map where tf has it now."""
        try:
            type(self).map = self.tf.lookup("odom", "map").pose
        except PathError:
            return True  # before the first place odometry and map are the same
        script = "const [done] = arguments; import('/map.js').then((m) => done(m.onMap([0, 0], [1, 0])))"
        seen = browser.driver.execute_async_script(script)
        return seen is not None and math.dist((seen["x"], seen["y"]), Pose(0, 0, 0).seen_from(self.map)) < SAME

    def click(self, browser: Browser, button: str, topic: Latest, ahead: float) -> float:
        """Strokes that far ahead of the robot, which looks along x; the heading of the place that comes."""
        wait_for("the map on the page", lambda: self.knows_the_map(browser))
        here, before = self.robot.pose, topic.count
        self.stroke(browser, button, ahead)
        self.waits_for(browser, "what was clicked", lambda: topic.count > before)
        pose = topic.message.pose if isinstance(topic.message, PoseStamped) else topic.message.pose.pose
        wanted = Pose(here.x + ahead, here.y, 0.0).seen_from(self.map)
        off = math.dist((pose.position.x, pose.position.y), wanted)
        print(f"{button}: {1000 * off:.0f} mm beside the place; the map is at {self.map}")
        self.assertLess(off, CLICKED)
        return yaw_of(pose.orientation)

    @again_after_a_stall
    def test_place_goal_and_cancel_do_what_the_pointer_says(self) -> None:
        browser = self.browser()
        browser.screen(1300, 900)
        browser.open(self.address)
        self.await_link(browser)
        browser.tab("map")
        wait_for("the place's button", lambda: not browser.run("return document.getElementById('set-place').title"))
        start = self.robot.pose
        wait_for("a robot without a place", lambda: self.state.message is not None)
        self.assertEqual(self.state.message.state, "no pose")
        self.assertLess(abs(self.click(browser, "set-place", self.place, 0.0)), 0.2)
        self.waits_for(browser, "a place", lambda: self.state.message.state == "localized")

        self.click(browser, "set-goal", self.goal, 1.0)
        self.waits_for(browser, "motion", lambda: self.robot.pose.x - start.x > 0.1)
        browser.run("document.querySelector('[data-call=goal_cancel]').click()")
        self.robot.await_rest()
        self.assertIn("the goal was cancelled", browser.text("messages"))
        self.assertLess(self.robot.pose.x - start.x, 0.8)

        here = self.robot.pose
        self.stroke(browser, "set-goal", 0.5)
        self.waits_for(browser, "the goal", lambda: abs(self.robot.pose.x - here.x - 0.5) < AT_GOAL)
        self.robot.await_rest()
