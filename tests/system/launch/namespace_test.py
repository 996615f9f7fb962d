#!/usr/bin/python3
"""A second robot is the same nodes in a namespace; the two do not meet."""

import unittest

import rostest
from system.system_support import init_test_node, running_robot


class NamespaceTest(unittest.TestCase):
    def test_second_robot_drives_beside_the_first(self) -> None:
        init_test_node("namespace_test")
        with running_robot() as first, running_robot("robot2") as second:
            second.drive_until("0.5 m/s of the second", second.driving)
            self.assertLess(first.distance, 0.05, "the first received no command")
            second.await_rest()
            before = second.distance
            first.drive_until("0.5 m/s of the first", first.driving)
            self.assertAlmostEqual(second.distance, before, delta=0.05)
            self.assertNotEqual(first.status.run, second.status.run)


if __name__ == "__main__":
    rostest.rosrun("robot_control", "namespace", NamespaceTest)
