"""set_parameter_map between the same two cycles: four nodes and the loop in one process give the same numbers."""

import contextlib
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
from robot_control import ClosedLoop
from robot_control.data.run_log import LogError, read_log
from robot_control.srv import SetParameters, Step
from std_srvs.srv import SetBool
from system.system_support import (
    CONTROLLER,
    DRIVER,
    ESTIMATOR,
    LIMIT,
    MONITOR,
    Program,
    Robot,
    wait_for,
)

CYCLES = 600
"""Cycles between two sets: at 0.5 m/s after the first."""
SETS = (
    {"pid_kp": 1.5, "pid_kd": 0.001, "max_linear_speed": 0.4},
    {"feed_forward": {"mass": 13.0}, "max_linear_jerk": 4.0, "keep_curvature": False},
)
REQUESTS = (
    "{pid_kp: 1.5, pid_kd: 0.001, max_linear_speed: 0.4}",
    "{feed_forward: {mass: 13.0}, max_linear_jerk: 4.0, keep_curvature: false}",
)


class SetParametersLockstepTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.log = Path(folder.name, "run.bag")
        self.script = Path(folder.name, "commands.csv")
        self.script.write_text("cycle,linear,angular\n1,0.5,0.2\n1000,0.5,0.2\n")
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/robot", {"clock": "lockstep", "command_script": str(self.script), "wait_for_telemetry": True})
        self.telemetry = Program("telemetry", f"_directory:={folder.name}", "_record:=always")
        self.addCleanup(self.telemetry.end)
        self.robot = Robot()
        self.addCleanup(self.robot.end)

    def call(self, service: str, form: type, *arguments: object) -> None:
        rospy.wait_for_service(service, LIMIT)
        answer = rospy.ServiceProxy(service, form)(*arguments)
        self.assertTrue(answer.success, answer.message)

    def step(self) -> None:
        self.call(f"{DRIVER}/step", Step, CYCLES)

    def rows(self) -> int:
        with contextlib.suppress(LogError, OSError):  # it has just begun
            return read_log(self.log, ["cycle"])["cycle"].size
        return 0

    def test_the_same_numbers_in_every_cycle(self) -> None:
        self.robot.start(DRIVER)
        self.call(f"{DRIVER}/set_pause", SetBool, True)  # cycle 0 waits for the others
        self.robot.start(ESTIMATOR, CONTROLLER, MONITOR)
        rospy.wait_for_service("e_stop_reset", LIMIT)
        rospy.wait_for_service(f"{CONTROLLER}/set_parameter_map", LIMIT)
        self.step()
        for request in REQUESTS:
            self.call(f"{CONTROLLER}/set_parameter_map", SetParameters, request)
            self.step()
        wait_for("every row", lambda: self.rows() >= 3 * CYCLES)
        self.telemetry.end()

        loop = ClosedLoop(params={"robot": {"command_script": str(self.script)}})
        loop.log_into(self.log.parent / "loop")
        loop.step(CYCLES)
        for values in SETS:
            loop.set_parameters(values)
            loop.step(CYCLES)
        loop.end_log()
        expected = read_log(self.log.parent / "loop" / "run.bag")
        for name, values in read_log(self.log).items():
            np.testing.assert_array_equal(values, expected[name], err_msg=name)
        self.assertEqual(set(expected["tuning"]), {0.0, 1.0, 2.0})
