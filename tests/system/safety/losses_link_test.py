"""The link of a remote teleop is cut while the robot drives: two networks, a cable between them. Needs root."""

import signal
import subprocess
import time
import unittest

import rospy
from robot_control.msg import SafetyStatus
from system.losses_support import FAST, Link, Master, enter_network_of_own
from system.system_support import LIMIT, Robot, wait_for

HEARTBEAT_TIMEOUT = 0.5
"""s"""
COMMAND_TIMEOUT = 1.25
"""s: cmd_vel_timeout."""
RAMP = 1.0
"""s from 1 m/s at max_linear_acceleration."""


def await_end(program: subprocess.Popen[bytes]) -> None:
    """Waits for the end of an interrupted program; rospy may hang at its end while TCP repairs the link."""
    try:
        program.wait(LIMIT / 3)
    except subprocess.TimeoutExpired:
        program.kill()
        program.wait()


REFUSED = ""
try:
    enter_network_of_own()
except OSError as error:
    REFUSED = f"no network namespace is granted ({error.strerror})"
else:
    LINK, MASTER = Link(), Master(Link.HERE)


@unittest.skipIf(REFUSED, REFUSED)
class LossesLinkTest(unittest.TestCase):
    @classmethod
    def tearDownClass(cls) -> None:
        rospy.signal_shutdown("done")  # asks the master, whose address goes with the link
        LINK.end()
        MASTER.kill()

    def setUp(self) -> None:
        LINK.plug(True)
        self.teleop: list[subprocess.Popen[bytes]] = []
        self.robot = Robot()

    def tearDown(self) -> None:
        # Senders end in order: the master announces a dying sender to the next controller, which may then miss another
        # one.
        LINK.plug(True)
        for program in self.teleop:
            program.send_signal(signal.SIGCONT)
            program.send_signal(signal.SIGINT)
        for program in self.teleop:
            await_end(program)
        self.robot.end()

    def drive_remotely(self, heartbeat_timeout: float) -> None:
        """Teleop sends twenty times a second, from the other network."""
        rospy.set_param("/safety_monitor/heartbeat_timeout", heartbeat_timeout)
        self.robot.start()
        wait_for("the end of INIT", lambda: self.robot.state != SafetyStatus.INIT)
        self.publish("/heartbeat", "std_msgs/Empty")
        self.publish_commands()
        self.await_full_speed()

    def await_full_speed(self) -> None:
        end = time.monotonic() + LIMIT
        while not self.robot.speed > FAST:
            self.assertLess(time.monotonic(), end, f"not at full speed; {self.robot.status}")
            # Stops that a stalling machine latched are released; commands from before a stop count no more.
            if self.robot.state == SafetyStatus.STOPPED:
                self.pause_and_release()
                self.restart_commands()
            time.sleep(0.02)

    def publish(self, *arguments: str) -> None:
        self.teleop.append(LINK.run_there("rostopic", "pub", "-r", "20", *arguments))

    def publish_commands(self) -> None:
        self.publish("/cmd_vel", "geometry_msgs/Twist", "{linear: {x: 1.0}}")

    def pause_and_release(self) -> None:
        commands = self.teleop[-1]
        commands.send_signal(signal.SIGSTOP)
        wait_for("a release", lambda: bool(self.robot.call("e_stop_reset").success))
        commands.send_signal(signal.SIGCONT)

    def restart_commands(self) -> None:
        commands = self.teleop.pop()
        commands.send_signal(signal.SIGINT)
        await_end(commands)
        self.publish_commands()

    def cut(self) -> float:
        """Cuts the link; returns the seconds until the robot stands."""
        began = time.monotonic()
        LINK.plug(False)
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01)
        return time.monotonic() - began

    def test_without_a_heartbeat_the_stop_latches(self) -> None:
        self.drive_remotely(HEARTBEAT_TIMEOUT)
        seconds = self.cut()
        print(f"  standstill {seconds:.2f} s after the cut, heartbeat_timeout {HEARTBEAT_TIMEOUT} s")
        self.assertIn("heartbeat_lost", self.robot.causes)
        self.assertLess(seconds, 10 * (HEARTBEAT_TIMEOUT + RAMP))
        LINK.plug(True)
        time.sleep(2.0)  # TCP sends again; teleop never stopped requesting
        self.assertLess(abs(self.robot.speed), 0.01)
        self.assertEqual(self.robot.state, SafetyStatus.STOPPED)
        self.pause_and_release()
        end = time.monotonic() + 1.0
        while time.monotonic() < end:  # it goes on with the requests from before the stop
            self.assertLess(abs(self.robot.speed), 0.01)
            time.sleep(0.02)
        self.restart_commands()
        self.await_full_speed()

    def test_without_commands_the_robot_ramps_to_rest(self) -> None:
        self.drive_remotely(0.0)
        seconds = self.cut()
        print(f"  standstill {seconds:.2f} s after the cut, cmd_vel_timeout {COMMAND_TIMEOUT} s")
        self.assertGreater(seconds, COMMAND_TIMEOUT - 0.1, "it came to rest for another reason")
        self.assertLess(seconds, 10 * (COMMAND_TIMEOUT + RAMP))
        self.assertNotIn("heartbeat_lost", self.robot.causes)
