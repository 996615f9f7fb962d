"""data_return.py beside robot_status.py: it sends at rest alone, with the lowest priority, and says how far it is."""

import os
import tempfile
import unittest
from pathlib import Path

import rospy
import yaml
from robot_control.data.data_return.fetch import verify
from robot_control.msg import RobotStatus
from system.system_support import Program, Robot, wait_for

from bench.data_return.server import missing

PATIENCE = 240.0
"""s; the sender runs only where no other program would"""


@unittest.skipIf(missing(), missing())
class DataReturnTest(unittest.TestCase):
    def test_it_sends_at_rest_and_says_so(self) -> None:
        reports: list[RobotStatus] = []
        rospy.Subscriber("robot_status", RobotStatus, reports.append)
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in ("logs", "far"):
            (folder / name).mkdir()
        settings = {"far_side": f"{folder}/far", "folder": f"{folder}/logs", "only_at_rest": True}
        (folder / "my.yaml").write_text(yaml.safe_dump(settings))
        status = Program("robot_status.py")
        self.addCleanup(status.end)
        sender = Program("data_return.py", "run", "--config", f"{folder}/my.yaml")
        self.addCleanup(sender.end)
        wait_for("a sender", lambda: bool(reports) and reports[-1].data_return != "", PATIENCE)
        robot = Robot()
        self.addCleanup(robot.end)
        robot.start()
        robot.await_ready()
        robot.drive_until("automatic", lambda: reports[-1].mode == "automatic")
        run = folder / "logs/run.1.bag"
        run.write_bytes(bytes(5_000_000))
        os.utime(run, (1e9, 1e9))

        def waits() -> bool:
            return "only at rest, and the robot is commanded" in reports[-1].data_return

        robot.drive_until("the wait", waits)
        self.assertEqual(list((folder / "far").iterdir()), [])
        self.assertEqual(os.sched_getscheduler(sender.pid), os.SCHED_IDLE)
        self.assertEqual(os.getpriority(os.PRIO_PROCESS, sender.pid), 19)
        wait_for("the return", lambda: reports[-1].data_return == "all 1 files are on the far side", PATIENCE)
        self.assertTrue(verify(f"{folder}/far", "", None))
        # The robot was ready to drive before its first rest has shown the gyro's bias.
        wait_for("no problem", lambda: reports[-1].problems == [])
        run.unlink()
        (folder / "far").rename(folder / "gone")
        (folder / "far").write_text("no folder")
        other = folder / "logs/run.2.bag"
        other.write_bytes(b"rows")
        os.utime(other, (1e9, 1e9))
        problem = "data_return: run.2.bag: "
        wait_for("the problem", lambda: any(each.startswith(problem) for each in reports[-1].problems), PATIENCE)
        self.assertTrue(other.exists())
