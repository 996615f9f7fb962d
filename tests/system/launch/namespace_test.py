"""A second robot is the same nodes in a namespace; the two do not meet."""

import unittest

from system.system_support import running_robot


class NamespaceTest(unittest.TestCase):
    def test_second_robot_drives_beside_the_first(self) -> None:
        with running_robot() as first, running_robot("robot2") as second:
            second.drive_until("0.5 m/s of the second", second.driving)
            self.assertLess(first.distance, 0.05, "the first received no command")
            second.await_rest()
            before = second.distance
            first.drive_until("0.5 m/s of the first", first.driving)
            self.assertAlmostEqual(second.distance, before, delta=0.05)
            self.assertNotEqual(first.status.run, second.status.run)
