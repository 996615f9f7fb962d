"""The console while master and console are killed: its emergency stop works, or says that it does not."""

from __future__ import annotations

import asyncio
import importlib.util

import rospy
from robot_control.robot.ros_master import Master as RunningMaster
from system.console.console_pages import DrivingPage, answer, driving_page, until
from system.losses_support import Master
from system.system_support import RobotTestCase, again_after_a_stall, wait_for

from bench.console.process import Console

MASTER = Master()
SPEED = 0.3
"""m/s"""


class ConsoleMasterTest(RobotTestCase):
    restarted = False

    def setUp(self) -> None:
        if importlib.util.find_spec("aiohttp") is None:
            self.skipTest("no aiohttp: scripts/setup --console")
        if self.restarted:  # the master knows neither this program nor the robot
            RunningMaster(rospy.get_name()).register_again()
            self.robot.end()
            self.robot.start()
        self.robot.await_ready()
        type(self).restarted = True
        self.console = Console()
        self.addCleanup(self.console.end)

    @again_after_a_stall
    def test_after_a_restart_of_the_master_the_page_drives_on_and_its_emergency_stop_stops(self) -> None:
        async def drives(page: DrivingPage) -> None:
            MASTER.kill()
            MASTER.start()
            forgotten = "the ROS master was restarted"
            await until("the words", lambda: forgotten in page.authority["against"]["reset_odometry"])
            self.assertNotIn("No node", page.newest["slow"]["headline"])
            self.assertEqual((page.ended, page.authority["commander"]), (0, page.authority["you"]))
            await page.drive(SPEED)
            code, said, _ = await asyncio.to_thread(answer, self.console, "/api/e_stop", {}, cookie)
            self.assertEqual((code, said["confirmed"]), (200, True), said)
            await until("standstill", lambda: abs(self.robot.speed) < 0.01)
            self.assertIn("e_stop_topic", self.robot.causes)

        async def whole() -> None:
            async with driving_page(self.console, cookie, SPEED) as page:
                await drives(page)

        _, cookie = self.console.log_in()
        asyncio.run(whole())

    def test_a_console_that_was_killed_and_knows_no_robot_says_that_its_stop_reached_nobody(self) -> None:
        MASTER.kill()
        MASTER.start()
        self.console.kill()
        self.console.start()
        _, cookie = self.console.log_in()
        code, said, _ = answer(self.console, "/api/e_stop", {}, cookie)
        self.assertEqual((code, said["confirmed"]), (200, False), said)
        self.assertIn("no node receives the topic e_stop", said["text"])
        self.assertIn("Press the button on the robot", said["text"])
        wait_for("no stop of the robot", lambda: "e_stop_service" not in self.robot.causes)
