"""A program makes more connections than the nodes have descriptors: the robot drives on, and e_stop_trigger works."""

import contextlib
import os
import selectors
import socket
import time
import xmlrpc.client
from collections.abc import Iterator

import rospy
from robot_control.msg import SafetyStatus
from system.system_support import DRIVER, MONITOR, RobotTestCase, wait_for

from bench import hostile

DESCRIPTORS = 256
"""Limit of each node; the usual 1024 would only make the test longer."""

SETTLE = 2.0
"""s, at most, for making the connections."""


@contextlib.contextmanager
def connections(target: hostile.Target, port: int, count: int, data: bytes = b"") -> Iterator[None]:
    """Opens `count` connections at once, which send `data` and then nothing. A connection that the node's listen queue
    refuses is tried again.
    """
    with contextlib.ExitStack() as stack:
        waiting = [stack.enter_context(socket.socket()) for _ in range(count)]
        for client in waiting:
            client.setblocking(False)
            client.connect_ex((target.host, port))
        looking = stack.enter_context(selectors.DefaultSelector())
        for client in waiting:
            looking.register(client, selectors.EVENT_WRITE)
        end = time.monotonic() + SETTLE
        while looking.get_map() and time.monotonic() < end:
            for key, _ in looking.select(0.1):
                looking.unregister(key.fileobj)
                with contextlib.suppress(OSError):  # the node may have closed this one
                    os.write(key.fd, data)
        yield


class DescriptorsTest(RobotTestCase):
    prefix = ("prlimit", f"--nofile={DESCRIPTORS}:{DESCRIPTORS}")

    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.drive_until("0.5 m/s", self.robot.driving)

    def drive_on(self) -> None:
        """Drives for two seconds: the nodes check their channels ten times a second."""
        end = rospy.get_time() + 2.0
        wait_for("the end", lambda: rospy.get_time() > end, every=lambda: self.robot.send(0.5, 0.2))
        self.robot.drive_until("0.5 m/s still", self.robot.driving)
        self.assertEqual([name for name, node in self.robot.nodes.items() if not node.running], [])

    def stop(self) -> None:
        answer = self.robot.call("e_stop_trigger")
        self.assertTrue(answer.success, answer.message)
        wait_for("the stop", lambda: self.robot.state == SafetyStatus.STOPPED)
        self.robot.release()

    def test_idle_connections_take_nothing_that_is_needed(self) -> None:
        with contextlib.ExitStack() as stack:
            for name in (DRIVER, MONITOR):
                target = hostile.find_target(name)
                stack.enter_context(connections(target, target.tcpros, DESCRIPTORS + 50))
            self.drive_on()
            self.stop()
        log = self.robot.nodes[MONITOR]
        wait_for("a line of it", lambda: "too many open files" in log.output)

    def test_nor_do_subscribers_that_never_read(self) -> None:
        target = hostile.find_target(MONITOR)
        header = {"callerid": "/idle", "topic": "/safety_status", "type": "*", "md5sum": "*"}
        with connections(target, target.tcpros, DESCRIPTORS + 50, hostile.header(header)):
            self.drive_on()
            self.stop()

    def test_nor_do_publishers_that_never_answer(self) -> None:
        target = hostile.find_target(MONITOR)
        node = xmlrpc.client.ServerProxy(f"http://{target.host}:{target.xmlrpc}")
        with socket.create_server((target.host, 0), backlog=1000) as mute:
            uri = f"http://{target.host}:{mute.getsockname()[1]}"
            node.publisherUpdate("/master", "/e_stop", [f"{uri}/{i}" for i in range(DESCRIPTORS + 50)])
            self.drive_on()
            self.stop()
        node.publisherUpdate("/master", "/e_stop", [rospy.get_node_uri()])

    def test_nor_do_idle_connections_to_the_port_of_xml_rpc(self) -> None:
        with contextlib.ExitStack() as stack:
            for name in (DRIVER, MONITOR):
                target = hostile.find_target(name)
                stack.enter_context(connections(target, target.xmlrpc, DESCRIPTORS + 50))
            self.drive_on()
            self.stop()
