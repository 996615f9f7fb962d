"""The laser in simulated time: the plant publishes every scan, and each has the bits of ClosedLoop in that cycle."""

import unittest

import numpy as np
import rospy
from robot_control import ClosedLoop
from robot_control.srv import Step
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool
from system.navigation.navigation_support import share
from system.system_support import CONTROLLER, DRIVER, ESTIMATOR, LIMIT, MONITOR, Robot, wait_for

CYCLES, EVERY = 3001, 100
"""Cycles that are stepped at once, faster than real time; those between two scans."""


class ScanLockstepTest(unittest.TestCase):
    def test_the_same_bits_in_every_scan(self) -> None:
        scene = str(share("urdf/scenes/crowd.xml"))
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/robot/clock", "lockstep")
        rospy.set_param("/mujoco_plant", {"scene": scene, "laser": {"rate": 10}})
        scans: list[LaserScan] = []
        subscriber = rospy.Subscriber("scan", LaserScan, scans.append)
        robot = Robot()
        self.addCleanup(robot.end)
        robot.start(DRIVER)
        rospy.wait_for_service(f"{DRIVER}/set_pause", LIMIT)
        rospy.ServiceProxy(f"{DRIVER}/set_pause", SetBool)(True)
        wait_for("the topic scan", lambda: subscriber.get_num_connections() > 0)
        robot.start(ESTIMATOR, CONTROLLER, MONITOR)
        answer = rospy.ServiceProxy(f"{DRIVER}/step", Step)(CYCLES)
        self.assertTrue(answer.success, answer.message)
        wait_for("every scan", lambda: len(scans) == CYCLES // EVERY + 1)
        loop = ClosedLoop({"mujoco_plant": {"laser": {"rate": 10}}}, scene=scene)
        for message in scans:
            loop.step(1 if loop.cycle == 0 else EVERY)
            expected = loop.scan()
            self.assertEqual(message.header.stamp.to_nsec() - scans[0].header.stamp.to_nsec(), expected["stamp_ns"])
            self.assertEqual(np.float32(message.ranges).tobytes(), expected["ranges"].tobytes())
