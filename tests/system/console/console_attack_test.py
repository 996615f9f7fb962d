"""PendingConnections, watchers and hostile pages: nothing that they send moves the robot, or ends the server."""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import json
import os
import socket
import urllib.error
import urllib.request
from collections.abc import Awaitable, Callable
from typing import Any

import rospy
from geometry_msgs.msg import PoseArray, TwistStamped
from nav_msgs.msg import OccupancyGrid, Path
from robot_control.msg import FollowPathActionFeedback, LegState, RobotKind
from sensor_msgs.msg import LaserScan
from system.console.console_pages import DrivingPage, NoRedirect, answer, driving_page, socket_of
from system.system_support import Program, RobotTestCase, again_after_a_stall, truncated_messages, wait_for

from bench.console.process import Console

DRIVE = {"type": "drive", "number": 1, "sent": 1.0, "held": True, "linear": 1.0, "angular": 0.0, "lateral": 0.0}
SHOWN = {
    "map": OccupancyGrid,
    "costmap": OccupancyGrid,
    "scan": LaserScan,
    "particlecloud": PoseArray,
    "path_wanted": Path,
    "leg_state": LegState,
    "robot_kind": RobotKind,
    "follow_path/feedback": FollowPathActionFeedback,
}
"""Topics of the page to which this test may publish beside the robot"""
PASSWORD, SPEED = "long enough", 0.3
HALVES, LOGINS = (6500, 200) if os.environ.get("ROBOT_CONTROL_NIGHTLY") else (1000, 25)
"""of a watcher"""
TAKE = {"type": "take", "force": False}


def status(address: str, data: bytes | None = None, **headers: str) -> int:
    """The HTTP status of a request."""
    request = urllib.request.Request(address, data=data, headers={k.replace("_", "-"): v for k, v in headers.items()})
    try:
        with urllib.request.build_opener(NoRedirect).open(request, timeout=10) as found:
            return int(found.status)
    except urllib.error.HTTPError as error:
        return int(error.code)


class ConsoleAttackTest(RobotTestCase):
    console: Console
    awaited = ""
    """the message that `until` waits for"""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.here = importlib.util.find_spec("aiohttp") is not None
        try:
            if cls.here:
                cls.console = Console()
                _, cls.cookie = cls.console.log_in()
        except AssertionError:
            cls.robot.end()
            raise

    @classmethod
    def tearDownClass(cls) -> None:
        if cls.here:
            cls.console.end()
        super().tearDownClass()

    def setUp(self) -> None:
        if not self.here:
            self.skipTest("no aiohttp: scripts/setup --console")
        self.robot.await_ready()
        self.moved = 0
        subscriber = rospy.Subscriber("cmd_vel_stamped", TwistStamped, self._receive, tcp_nodelay=True)
        self.addCleanup(subscriber.unregister)

    def _receive(self, message: TwistStamped) -> None:
        self.moved += bool(message.twist.linear.x or message.twist.angular.z)

    def alive(self, console: Console | None = None) -> None:
        """The server answers, and the robot stood."""
        console = console or self.console
        self.assertEqual(status(f"{console.origin}/login"), 200)
        self.assertEqual(self.moved, 0)

    def page(self, cookie: str = "", console: Console | None = None) -> contextlib.AbstractAsyncContextManager[Any]:
        return socket_of(console or self.console, cookie or self.cookie)

    def run_page(
        self, play: Callable[[Any], Awaitable[None]], cookie: str = "", console: Console | None = None
    ) -> None:
        async def whole() -> None:
            async with self.page(cookie, console) as page:
                await asyncio.wait_for(play(page), 60)

        try:
            asyncio.run(whole())
        except TimeoutError:
            self.fail(f"not done within 60 s; the last message that was waited for: {self.awaited}")

    async def until(self, page: Any, kind: str, text: str = "") -> dict[str, Any]:
        """The next message of this type; pings are answered."""
        self.awaited = f"{kind} {text}"
        while True:
            message = json.loads((await page.receive()).data)
            if message["type"] == "ping":
                await page.send_json({"type": "pong", "name": message["name"]})
            elif message["type"] == kind and text in json.dumps(message):
                return message

    def is_closed_after(self, messages: list[str] | list[bytes]) -> None:
        """The server closes a page that sends these."""

        async def play(page: Any) -> None:
            with contextlib.suppress(ConnectionError):
                for message in messages:
                    await (page.send_str(message) if isinstance(message, str) else page.send_bytes(message))
            while not page.closed:
                await page.receive()

        self.run_page(play)

    # requests

    def test_without_a_login_nothing_but_the_login_is_served(self) -> None:
        origin = self.console.origin
        for path in (
            "/ws",
            "/api/model",
            "/api/runs",
            "/api/doctor",
            "/api/mesh/0",
            "/index.html",
            "/main.js",
            "/lib/three/build/three.module.js",
        ):
            self.assertIn(status(origin + path), (401, 403), path)
            self.assertEqual(status(origin + path, Cookie="console=guess", Origin=origin), 401, path)
        self.assertEqual(status(f"{origin}/api/e_stop", b"", Origin=origin), 401)
        self.assertEqual(status(f"{origin}/"), 302)
        self.assertEqual(status(f"{origin}/?token=guess"), 403)
        self.assertEqual(status(f"{origin}/?token=%ff%00"), 403)
        self.alive()

    def test_other_hosts_and_origins_are_refused(self) -> None:
        origin = self.console.origin
        for host in ("evil.example", f"evil.example:{self.console.port}", "127.0.0.1", ""):
            self.assertIn(status(f"{origin}/", Cookie=self.cookie, Host=host), (400, 421), host)
        for path in ("/api/e_stop", "/api/logout", "/api/login"):
            for other in ("http://evil.example", "null", origin.replace("http", "https"), ""):
                self.assertEqual(status(origin + path, b"{}", Cookie=self.cookie, Origin=other), 403)
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Cookie": self.cookie}
        for other in ({}, {"Origin": "http://evil.example"}, {"Origin": "null"}):
            self.assertEqual(status(f"{origin}/ws", **upgrade, **other), 403)
        form = {"Content_Type": "application/x-www-form-urlencoded", "Origin": origin, "Cookie": self.cookie}
        self.assertEqual(status(f"{origin}/api/login", b"name=a&password=b", **form), 415)
        self.alive()

    def test_no_path_leads_out_of_the_lists(self) -> None:
        origin, own = self.console.origin, {"Cookie": self.cookie}
        outside = ("../main.py", "..%2fmain.py", "%2e%2e/%2e%2e/settings.py", "/etc/passwd", "%00", "a" * 4000)
        for prefix in ("/", "/lib/", "/lib/three/", "/api/mesh/", "/api/runs/"):
            for path in outside:
                end = "/file" if prefix == "/api/runs/" else ""
                self.assertIn(status(f"{origin}{prefix}{path}{end}", **own), (400, 404), prefix + path)
        self.alive()

    def test_cookies_are_out_of_reach_of_scripts_and_of_other_sites(self) -> None:
        with urllib.request.build_opener(NoRedirect).open(f"{self.console.origin}/login") as found:
            policy = found.headers["Content-Security-Policy"]
        self.assertIn("default-src 'none'; script-src 'self'; style-src 'self'", policy)
        with self.assertRaises(urllib.error.HTTPError) as redirect:
            urllib.request.build_opener(NoRedirect).open(self.console.address)
        self.assertIn("HttpOnly; Path=/; SameSite=Strict", redirect.exception.headers["Set-Cookie"])

    # messages

    def test_malformed_messages_close_the_page_and_nothing_else(self) -> None:
        malformed = ["{", "[" * 60000, '{"type": 1}', "null", '{"type":"drive"}'] * 5
        for data in (malformed, ["x" * 70_000], [b"\0" * 100]):
            self.is_closed_after(data)
        self.alive()

    def test_a_flood_closes_its_page(self) -> None:
        self.is_closed_after([json.dumps({**DRIVE, "number": number}) for number in range(5000)])
        self.alive()

    def test_two_operators_do_not_command_together_and_a_confirmed_reset_needs_its_key(self) -> None:
        async def whole() -> None:
            async with self.page() as first, self.page() as second:
                await first.send_json(TAKE)
                await self.until(first, "authority", '"commander": ')
                await second.send_json(TAKE)
                await self.until(second, "said", "has control")
                await second.send_json(DRIVE)
                await self.until(second, "said", "does not have control")
                call = {"type": "call", "number": 1, "name": "reset", "arguments": {"key": "0" * 16}}
                await first.send_json(call)
                self.assertFalse((await self.until(first, "answer"))["accepted"])
                await second.send_json({**call, "name": "reset_odometry", "arguments": {}})
                self.assertIn("take control", (await self.until(second, "answer"))["text"])

        asyncio.run(asyncio.wait_for(whole(), 60))
        self.alive()

    # what an operator may do

    def test_calls_reach_the_robot_and_a_refusal_says_why(self) -> None:
        async def call(page: Any, name: str, **arguments: Any) -> tuple[bool, str]:
            await page.send_json({"type": "call", "number": 7, "name": name, "arguments": arguments})
            answer = await self.until(page, "answer")
            return answer["accepted"], answer["text"]

        async def play(page: Any) -> None:
            self.assertEqual(await call(page, "reset_odometry"), (False, "take control first"))
            await page.send_json(TAKE)
            while (authority := await self.until(page, "authority"))["commander"] != authority["you"] or authority[
                "against"
            ]["step"]:
                pass
            self.assertTrue((await call(page, "set_odometry", x=1.0, y=2.0, yaw=0.5))[0])
            while abs((await self.until(page, "fast"))["pose"][1] - 2.0) > 0.1:
                pass
            self.assertTrue((await call(page, "reset_odometry"))[0])
            self.assertTrue((await call(page, "set_parameters", parameters="{max_linear_speed: 0.8}"))[0])
            accepted, why = await call(page, "set_parameters", parameters="{max_linear_speed: -1}")
            self.assertEqual((accepted, "max_linear_speed" in why), (False, True))
            self.assertTrue((await call(page, "pause", on=True))[0])
            self.assertTrue((await call(page, "step", cycles=5))[0])
            self.assertTrue((await call(page, "pause", on=False))[0])
            accepted, why = await call(page, "inject_fault", component="gyro", kind="none such")
            self.assertEqual((accepted, "none such" in why), (False, True))
            self.assertEqual(
                await call(page, "path_shape", shape="square", size=1.0, speed=0.3),
                (False, "follow_path.py does not run"),
            )
            follow = Program("follow_path.py")
            self.addCleanup(follow.end)
            while (await self.until(page, "authority"))["against"]["path_shape"]:
                pass
            accepted, why = await call(page, "path_csv", text="x,z\n0,0\n", speed=0.3)
            self.assertEqual((accepted, "the first line must be x,y" in why), (False, True))
            self.robot.await_ready()
            self.assertTrue((await call(page, "path_shape", shape="circle", size=1.0, speed=0.3))[0])
            await self.until(page, "slow", '"state": "driving"')
            self.assertTrue((await call(page, "path_cancel"))[0])
            await asyncio.to_thread(wait_for, "standstill", lambda: abs(self.robot.speed) < 0.01)

        self.run_page(play)
        self.assertEqual(status(f"{self.console.origin}/login"), 200)

    def test_truncated_messages_on_what_is_shown_end_nothing(self) -> None:
        async def play(page: Any) -> None:
            await self.until(page, "fast")
            with contextlib.ExitStack() as stack:
                await asyncio.to_thread(stack.enter_context, truncated_messages(SHOWN))
                self.assertEqual((await self.until(page, "slow"))["safety"]["state"], "READY")
                await self.until(page, "fast")
                _, said, _ = await asyncio.to_thread(answer, self.console, "/api/e_stop", {}, self.cookie)
                self.assertTrue(said["confirmed"], said)
                await self.until(page, "slow", '"state": "STOPPED"')

        self.run_page(play)
        self.robot.release()
        self.assertIn("an input is ignored", self.console.output)
        self.alive()

    # connections

    def test_a_thousand_idle_connections_and_slow_ones_keep_nobody_out(self) -> None:
        async def play(page: Any) -> None:
            idle = []
            for number in range(1000):
                one = socket.create_connection(("127.0.0.1", self.console.port))
                one.sendall(b"GET / HTTP/1.1\r\nHost: " if number % 2 else b"")
                idle.append(one)
            await self.until(page, "fast")
            self.assertEqual(status(f"{self.console.origin}/login"), 200)
            stop = status(f"{self.console.origin}/api/e_stop", b"", Cookie=self.cookie, Origin=self.console.origin)
            self.assertEqual(stop, 200)
            await self.until(page, "slow", '"state": "STOPPED"')
            for one in idle:
                one.close()

        self.run_page(play)
        self.robot.release()
        self.alive()

    def test_a_page_beyond_the_twentieth_ends_the_oldest_of_its_user(self) -> None:
        async def whole() -> None:
            async with contextlib.AsyncExitStack() as stack:
                pages = [await stack.enter_async_context(self.page()) for _ in range(21)]
                last = await pages[0].receive()
                while last.type.name != "CLOSE":
                    last = await pages[0].receive()
                self.assertEqual(last.data, 4409)
                self.assertTrue(await self.until(pages[20], "authority"))

        asyncio.run(whole())
        self.alive()

    def test_a_reader_that_stalls_is_skipped_and_sees_nothing_old(self) -> None:
        async def play(page: Any) -> None:
            await self.until(page, "fast")
            await asyncio.sleep(4.0)  # aiohttp reads ahead; pings stay unanswered
            count = 0
            with contextlib.suppress(asyncio.TimeoutError):
                while True:
                    message = await asyncio.wait_for(page.receive(), 0.01)
                    count += '"fast"' in str(message.data)
            self.assertLess(count, 3.0 * 20)

        self.run_page(play)
        self.alive()

    # users

    def users(self, **roles: str) -> tuple[Console, dict[str, str]]:
        """A console with these users, who all have the same password, and their cookies."""
        console = Console("__name:=console_with_users", users=roles)
        self.addCleanup(console.end)
        logins = {name: {"link": link, "password": PASSWORD} for name, link in console.links.items()}
        return console, {name: answer(console, "/api/login", login)[2] for name, login in logins.items()}

    @again_after_a_stall
    def test_the_page_that_drives_is_not_disturbed_by_what_a_watcher_does(self) -> None:
        console, cookies = self.users(olga="operate", wanda="watch", max="maintain")

        async def attack(page: DrivingPage) -> None:
            await asyncio.to_thread(asyncio.run, self.half_connections(console, cookies["wanda"], HALVES))
            for _ in range(LOGINS):
                login = {"name": "wanda", "password": PASSWORD}
                code, _, cookie = await asyncio.to_thread(answer, console, "/api/login", login)
                self.assertEqual(code, 200)
            async with contextlib.AsyncExitStack() as stack:
                for _ in range(20):
                    await stack.enter_async_context(socket_of(console, cookie))
                other = await stack.enter_async_context(socket_of(console, cookies["max"]))
                pages = (await self.until(other, "authority"))["pages"]
                self.assertIn("max", [each["name"] for each in pages])
                self.assertLessEqual(len(pages), 21)
            self.assertEqual((page.ended, page.authority["commander"]), (0, page.authority["you"]))
            print(f"gaps of the link that drives: {page.authority['link']['gaps']}")
            await page.drive(SPEED)
            code, said, _ = await asyncio.to_thread(answer, console, "/api/e_stop", {}, cookie)
            self.assertTrue(said["confirmed"], said)

        async def whole() -> None:
            async with driving_page(console, cookies["olga"], SPEED) as page:
                await attack(page)

        asyncio.run(whole())
        self.robot.release()

    async def half_connections(self, console: Console, cookie: str, count: int) -> None:
        """Requests of a WebSocket without its headers; none of them leaves a page."""
        from aiohttp import ClientSession

        own = {"Origin": console.origin, "Cookie": cookie}
        async with ClientSession() as session:
            for _ in range(count // 50):
                requests = [session.get(f"{console.origin}/ws", headers=own) for _ in range(50)]
                codes = [each.status for each in await asyncio.gather(*requests)]
                self.assertEqual(set(codes), {400})
            async with socket_of(console, cookie) as page:
                self.assertLessEqual(len((await self.until(page, "authority"))["pages"]), 2)

    def test_watchers_watch_and_links_and_logouts_end(self) -> None:
        console = Console("__name:=console_with_users", users={"wanda": "watch"})
        link = console.links["wanda"]
        self.addCleanup(console.end)
        origin = console.origin
        own = {"Origin": origin, "Content_Type": "application/json"}

        def post(path: str, body: dict[str, str], **headers: str) -> int:
            return status(f"{origin}/api/{path}", json.dumps(body).encode(), **own, **headers)

        self.assertEqual(status(f"{origin}/?token=guess"), 302)
        self.assertEqual(post("login", {"link": "wrong", "password": "long enough"}), 403)
        self.assertEqual(post("login", {"link": link, "password": "short"}), 403)
        cookie = answer(console, "/api/login", {"link": link, "password": PASSWORD})[2]
        self.assertEqual(post("login", {"link": link, "password": "another one"}), 403, "a link is good once")

        async def watch(page: Any) -> None:
            await page.send_json({"type": "take", "force": True})
            await self.until(page, "said", "watch does not drive")
            for _ in range(5):
                await page.send_json(DRIVE)
            await self.until(page, "said", "does not have control")
            await page.send_json({"type": "call", "number": 1, "name": "step", "arguments": {"cycles": 1}})
            self.assertIn("needs the role maintain", (await self.until(page, "answer"))["text"])
            self.assertEqual(
                await asyncio.to_thread(status, f"{origin}/api/logout", b"{}", Cookie=cookie, Origin=origin), 200
            )
            last = await page.receive()
            while last.type.name != "CLOSE":
                last = await page.receive()
            self.assertEqual(last.data, 4401)

        self.assertEqual(status(f"{origin}/api/doctor", Cookie=cookie), 403, "watch")
        self.run_page(watch, cookie, console)
        self.assertEqual(status(f"{origin}/api/runs", Cookie=cookie), 401)
        tries = [post("login", {"name": "wanda", "password": f"guess number {n}"}) for n in range(6)]
        self.assertEqual(tries, [403] * 5 + [429])
        self.assertEqual(post("login", {"name": "wanda", "password": PASSWORD}), 429)
        wait_for("the journal", lambda: "has logged out" in console.journal)
        self.assertIn("too many attempts", console.journal)
        self.alive(console)
