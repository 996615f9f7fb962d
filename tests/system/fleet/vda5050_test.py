"""vda5050.py on a running robot behind a broker: orders, a broker that is killed, a client that is killed."""

import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import rospy
import yaml
from robot_control.fleet.master import Master
from std_msgs.msg import Bool
from std_srvs.srv import Trigger, TriggerResponse
from system.system_support import Program, RobotTestCase, again_after_a_stall, wait_for

from bench.fleet.broker import Broker, missing
from bench.fleet.messages import action, order

KEEP_ALIVE = 5
"""s; the shortest one"""


@unittest.skipIf(missing(), missing())
class Vda5050Test(RobotTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        cls.broker = Broker(Path(cls.folder.name))
        cls.config = Path(cls.folder.name) / "fleet.yaml"
        values = {"port": cls.broker.port, "keep_alive": KEEP_ALIVE, "memory_file": f"{cls.folder.name}/memory.json"}
        values["actions"] = {"horn": {"topic": "horn", "seconds": 0.5}, "lift": {"service": "lift", "timeout": 5}}
        values["actions"]["siren"] = {"topic": "siren", "seconds": 3600}
        cls.config.write_text(yaml.safe_dump(values))
        cls.follower = Program("follow_path.py")
        cls.client = Program("vda5050.py", "--config", str(cls.config))
        cls.begin_master()
        cls.count = 0

    @classmethod
    def begin_master(cls) -> None:
        cls.master = Master("127.0.0.1", cls.broker.port, "uagv/v2/robot_control/r1")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.master.end()
        cls.client.end()
        cls.follower.end()
        cls.broker.end()
        super().tearDownClass()
        cls.folder.cleanup()

    def setUp(self) -> None:
        super().setUp()
        self.listen("ONLINE", lambda: self.master.last.get("connection", {}).get("connectionState") == "ONLINE")
        self.master.act("cancelOrder")
        self.master.act("stopPause")
        self.listen("no order", lambda: "state" in self.master.last and not self.state["nodeStates"])
        placed = self.master.act("initPosition", x=0.0, y=0.0, theta=0.0, mapId="hall")
        self.listen("initPosition", lambda: self.status(placed) == "FINISHED")

    @property
    def state(self) -> dict[str, Any]:
        return self.master.last["state"]

    def status(self, action_id: str) -> str:
        return {each["actionId"]: each["actionStatus"] for each in self.state["actionStates"]}.get(action_id, "")

    def listen(self, what: str, condition: Callable[[], bool], limit: float = 30.0) -> None:
        """Takes messages until the condition holds."""
        end = time.monotonic() + limit
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"not within {limit:g} s: {what}; {self.master.last}; {self.client.output}")
            for _ in self.master.messages(0.05):
                pass

    def send(self, places: list[tuple[float, ...]], released: int | None = None, **options: Any) -> None:
        if not options.get("update"):
            type(self).count += 1
        message = order(places, released, name=f"o{self.count}", **options)
        self.master.send("order", {key: message[key] for key in ("orderId", "orderUpdateId", "nodes", "edges")})

    def reached(self, node: str) -> Callable[[], bool]:
        return lambda: (self.state["orderId"], self.state["lastNodeId"]) == (f"o{self.count}", node)

    @again_after_a_stall
    def test_an_order_is_driven_and_extended_without_a_stop(self) -> None:
        begin = self.robot.pose
        self.send([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], 2, maxSpeed=0.4)
        self.listen("newBaseRequest", lambda: self.state["newBaseRequest"] and self.robot.speed > 0.38)
        self.send([(1.0, 0.0), (2.0, 0.0)], update=1, first=1, maxSpeed=0.4)
        slowest = 1.0
        while not self.reached("n1")():
            self.listen("a message", lambda: True)
            for _ in self.master.messages(0.02):
                pass
            slowest = min(slowest, self.robot.speed)
        self.assertGreater(slowest, 0.36)
        self.listen("the end", lambda: self.reached("n2")() and not self.state["driving"])
        self.assertAlmostEqual(self.robot.pose.seen_from(begin)[0], 2.0, delta=0.02)
        self.assertEqual(self.state["errors"], [])

    @again_after_a_stall
    def test_actions_of_a_node_are_topics_services_and_a_trigger(self) -> None:
        heard: list[bool] = []
        horn = rospy.Subscriber("horn", Bool, lambda message: heard.append(message.data))
        lift = rospy.Service("lift", Trigger, lambda _: TriggerResponse(success=True, message="is up"))
        kinds = (("horn", "SOFT"), ("lift", "HARD"), ("waitForTrigger", "HARD"))
        actions = [action(kind, f"{kind}{time.monotonic()}", blocking) for kind, blocking in kinds]
        self.send([(0.0, 0.0), (0.5, 0.0)], actions={2: actions})
        names = [each["actionId"] for each in actions]
        self.listen("waitForTrigger", lambda: self.status(names[2]) == "RUNNING")
        self.assertEqual([self.status(name) for name in names[:2]], ["FINISHED", "FINISHED"])
        self.assertEqual(heard[-2:], [True, False])
        results = {each["actionId"]: each.get("resultDescription") for each in self.state["actionStates"]}
        self.assertEqual(results[names[1]], "is up")
        self.assertTrue(rospy.ServiceProxy("vda5050/trigger", Trigger)().success)
        self.listen("the end", lambda: self.status(names[2]) == "FINISHED")
        horn.unregister()
        lift.shutdown()

    @again_after_a_stall
    def test_a_killed_broker_lets_the_base_end_and_the_state_is_told_at_once(self) -> None:
        begin = self.robot.pose
        self.send([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], 2)
        wait_for("motion", lambda: self.robot.speed > 0.3)
        self.broker.kill()
        wait_for("the end of the base", lambda: self.robot.pose.seen_from(begin)[0] > 0.98)
        self.robot.await_rest()
        self.assertAlmostEqual(self.robot.pose.seen_from(begin)[0], 1.0, delta=0.02)
        self.master.end()
        self.broker.start()
        self.begin_master()
        self.listen("ONLINE", lambda: {"connection", "state"} <= set(self.master.last))
        self.assertEqual(self.master.last["connection"]["connectionState"], "ONLINE")
        self.assertEqual((self.state["lastNodeId"], len(self.state["nodeStates"])), ("n1", 1))

    @again_after_a_stall
    def test_a_killed_client_is_told_by_the_will_and_stands_paused_when_it_is_back(self) -> None:
        self.send([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])
        wait_for("motion", lambda: self.robot.speed > 0.3)
        number = self.state["headerId"]
        self.client.kill()
        self.listen("the will", lambda: self.master.last["connection"]["connectionState"] == "CONNECTIONBROKEN", 5.0)
        type(self).client = Program("vda5050.py", "--config", str(self.config))
        self.listen("ONLINE", lambda: self.master.last["connection"]["connectionState"] == "ONLINE")
        self.listen("a state", lambda: self.state["headerId"] > number and self.state["paused"])
        self.robot.await_rest()
        self.assertEqual((self.state["orderId"], self.state["lastNodeId"]), (f"o{self.count}", "n0"))
        rospy.ServiceProxy("vda5050/resume", Trigger)()
        self.listen("the end", lambda: self.reached("n2")() and not self.state["nodeStates"])

    @again_after_a_stall
    def test_what_an_action_holds_true_ends_with_a_killed_client(self) -> None:
        heard: list[bool] = []
        horn = rospy.Subscriber("siren", Bool, lambda message: heard.append(message.data))
        self.master.act("siren")
        self.listen("true", lambda: heard[-1:] == [True])
        number = self.state["headerId"]
        self.client.kill()
        wait_for("false", lambda: heard[-1:] == [False])
        type(self).client = Program("vda5050.py", "--config", str(self.config))
        self.listen("a state", lambda: self.state["headerId"] > number + 500)  # they are reserved by the thousand
        horn.unregister()

    @again_after_a_stall
    def test_after_a_stop_and_its_reset_the_order_waits_for_stop_pause(self) -> None:
        self.send([(0.0, 0.0), (2.0, 0.0)])
        wait_for("motion", lambda: self.robot.speed > 0.3)
        rospy.ServiceProxy("e_stop_trigger", Trigger)()
        self.listen("eStop", lambda: self.state["safetyState"]["eStop"] == "MANUAL" and self.state["paused"])
        self.assertIn("FATAL", [error["errorLevel"] for error in self.state["errors"]])
        self.robot.await_rest()
        wait_for("the reset", lambda: rospy.ServiceProxy("e_stop_reset", Trigger)().success)
        self.listen("no eStop", lambda: self.state["safetyState"]["eStop"] == "NONE")
        time.sleep(1.0)
        self.assertTrue(self.robot.rests())
        self.listen("the way on", self.go_on)
        self.listen("the end", self.reached("n1"))

    def go_on(self) -> bool:
        """stopPause until it is taken: zero first lasts for a moment."""
        asked = self.master.act("stopPause")
        end = time.monotonic() + 1.0
        while time.monotonic() < end and not self.status(asked):
            for _ in self.master.messages(0.05):
                pass
        return self.status(asked) == "FINISHED"
