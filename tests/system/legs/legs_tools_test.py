"""The programs that drive a robot on wheels drive the quadbot: by a path, a goal, keys, a pad and a page."""

import math
import tempfile
import time
import unittest
from pathlib import Path

import actionlib
import roslib.packages
import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from robot_control.fleet.master import Master
from robot_control.msg import FollowPathAction, FollowPathGoal
from robot_control.robot.pose import Pose, pose_of
from system import rosunit_results
from system.fake_pad import ENABLE, FakePad
from system.legs.legs_support import LegsTestCase
from system.pseudo_terminal import PseudoTerminal
from system.system_support import LIMIT, Program, again_after_a_stall, wait_for

from bench.console.browser import Browser, missing
from bench.console.process import Console
from bench.fleet import broker
from bench.fleet.messages import order

rosunit_results.record()

CROSS_TRACK = 0.1
"""m, admitted on legs"""
SIDE = 0.5
"""m, of the square"""


def beside_square(start: Pose, place: tuple[float, float]) -> float:
    """m of a place from the square that begins at `start` and turns left."""
    dx, dy = place[0] - start.x, place[1] - start.y
    x = dx * math.cos(start.yaw) + dy * math.sin(start.yaw)
    y = dy * math.cos(start.yaw) - dx * math.sin(start.yaw)
    edges = (abs(x), abs(x - SIDE), abs(y), abs(y - SIDE))
    outside = math.hypot(max(0.0, -x, x - SIDE), max(0.0, -y, y - SIDE))
    return outside or min(edges)


class LegsToolsTest(LegsTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.limited: TwistStamped | None = None
        cls.places: list[tuple[float, float]] = []
        cls.launch_quadbot()
        rospy.Subscriber("cmd_vel_out", TwistStamped, lambda message: setattr(cls, "limited", message))
        wait_for("a place", lambda: cls.places, 2 * LIMIT)

    @classmethod
    def receive_truth(cls, message: Odometry) -> None:
        super().receive_truth(message)
        cls.places.append((message.pose.pose.position.x, message.pose.pose.position.y))

    @again_after_a_stall
    def test_a_square_a_goal_and_a_way_sideways_are_walked(self) -> None:
        start = pose_of(self.truth)
        self.places.clear()
        square = Program("drive_path.py", "square", "--size", str(SIDE))
        self.assertEqual(square.wait(2 * LIMIT), 0, square.output)
        self.assertIn("done; at most", square.output)
        self.assertLess(max(beside_square(start, place) for place in self.places), CROSS_TRACK)

        server = Program("follow_path.py")
        self.addCleanup(server.end)
        client = actionlib.SimpleActionClient("follow_path", FollowPathAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(30.0)))
        goal = FollowPathGoal(speed=0.4)
        goal.path.header.frame_id = "base_link"
        goal.path.poses = [PoseStamped(), PoseStamped()]
        goal.path.poses[1].pose.position.x = SIDE
        self.assertEqual(client.send_goal_and_wait(goal, rospy.Duration(60.0)), GoalStatus.SUCCEEDED, server.output)
        self.assertLess(client.get_result().worst_cross_track_error, CROSS_TRACK)

        begin = self.places[-1]
        sender = Program("send_cmd.py", "--linear", "0", "--angular", "0", "--lateral", "0.3")
        self.addCleanup(sender.end)
        wait_for(
            "a way sideways at the commanded speed",
            lambda: math.dist(begin, self.places[-1]) > 0.3 and abs(self.limited.twist.linear.y - 0.3) < 0.01,
        )
        self.assertEqual(self.legs.posture, "walking")
        why = Program("why.py", "--once")
        self.assertEqual(why.wait(), 0, why.output)
        self.assertIn("Walking: ", why.output)
        self.assertIn("m/s to the left", why.output)
        sender.end()
        wait_for("standing", lambda: self.legs.posture == "standing")

    @again_after_a_stall
    @unittest.skipIf(broker.missing(), broker.missing())
    def test_an_order_of_a_fleet_is_walked(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        mosquitto, config = broker.Broker(Path(folder.name)), Path(folder.name) / "fleet.yaml"
        self.addCleanup(mosquitto.end)
        config.write_text(yaml.safe_dump({"port": mosquitto.port, "memory_file": f"{folder.name}/memory.json"}))
        follower, client = Program("follow_path.py"), Program("vda5050.py", "--config", str(config))
        self.addCleanup(follower.end)
        self.addCleanup(client.end)
        master = Master("127.0.0.1", mosquitto.port, "uagv/v2/robot_control/r1")
        self.addCleanup(master.end)

        def wait(what: str, key: str, value: object) -> None:
            end = time.monotonic() + 2 * LIMIT
            while master.last.get("state", {}).get(key) != value:
                self.assertLess(time.monotonic(), end, f"{what}: {master.last}; {client.output}")
                for _ in master.messages(0.05):
                    pass

        wait("a state", "orderId", "")
        master.act("initPosition", x=0.0, y=0.0, theta=0.0, mapId="hall", lastNodeId="here")
        wait("initPosition", "lastNodeId", "here")
        begin = pose_of(self.truth)
        message = order([(0.0, 0.0), (SIDE, 0.0)])
        master.send("order", {key: message[key] for key in ("orderId", "orderUpdateId", "nodes", "edges")})
        wait("the order", "lastNodeId", "n1")
        self.assertEqual(master.last["state"]["errors"], [])
        self.assertAlmostEqual(pose_of(self.truth).seen_from(begin)[0], SIDE, delta=CROSS_TRACK)
        wait_for("standing", lambda: self.legs.posture == "standing")

    @again_after_a_stall
    def test_a_key_and_a_pad_walk_sideways(self) -> None:
        begin = self.places[-1]
        terminal = PseudoTerminal([roslib.packages.find_node("robot_control", "teleop.py")[0]])
        self.addCleanup(terminal.end)
        wait_for("the column of legs", lambda: b"sideways m/s" in terminal.written)
        terminal.hold("j", 20.0, until=lambda: math.dist(begin, self.places[-1]) > 0.2)
        self.assertGreater(math.dist(begin, self.places[-1]), 0.2)
        wait_for("standing", lambda: self.legs.posture == "standing")

        device = FakePad(self)
        pad, plug = device.program(), device.plug
        plug()
        wait_for(f"a pad with nothing held: {pad.output}", lambda: "hold button 4" in pad.output)
        plug(ENABLE, sideways=0)
        begin = self.places[-1]
        wait_for("a way to the left", lambda: math.dist(begin, self.places[-1]) > 0.2)
        plug()
        wait_for("standing", lambda: self.legs.posture == "standing")

    @again_after_a_stall
    def test_a_page_of_the_console_walks_sideways_and_chooses_the_gait(self) -> None:
        if missing():
            self.skipTest(missing())
        console, browser = Console(), Browser(height=1000)
        self.addCleanup(console.end)
        self.addCleanup(browser.end)
        browser.open(console.address)
        wait_for("the model", lambda: browser.data("model"))
        browser.rest()
        wait_for("the kind", lambda: browser.data("legged") == "true")
        browser.command(0.3)
        browser.click("stand")
        wait_for("standing", lambda: self.legs.posture == "standing")
        browser.run("document.querySelector('[data-gait=walking_trot]').click()")
        wait_for("the gait", lambda: self.legs.chosen_gait == "walking_trot")
        begin = self.places[-1]
        browser.hold(
            "KeyJ",
            "a way to the left, and the page that shows the walk",
            lambda: (
                math.dist(begin, self.places[-1]) > 0.3
                and browser.number("asked-l") > 0.1
                and browser.text("posture") == "walking, walking_trot (chosen)"
            ),
        )
        self.assertIn("FL", browser.text("feet"))
        browser.key("KeyJ", "keyUp")
        wait_for("standing", lambda: self.legs.posture == "standing")
        browser.click("lie")
        wait_for("lying", lambda: self.legs.posture == "lying")
        self.assertEqual(browser.problems(), [])
