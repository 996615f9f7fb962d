"""A list of command sources, on a running robot: priority, timeout, lock; teleop.py and drive_path.py find theirs."""

import itertools
import math
import signal
import time
from dataclasses import astuple

import roslib.packages
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Path as PathMessage
from robot_control.msg import DriveState, SafetyStatus
from sensor_msgs.msg import Joy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from system.fake_pad import FakePad
from system.pseudo_terminal import PseudoTerminal
from system.system_support import (
    LISTED_SOURCES,
    Latest,
    NoBool,
    Program,
    RobotTestCase,
    again_after_a_stall,
    wait_for,
)


class CommandSourcesTest(RobotTestCase):
    parameters = (LISTED_SOURCES,)

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.latest = Latest("drive_state", DriveState)
        cls.key = rospy.Publisher("key_vel", TwistStamped, queue_size=1, tcp_nodelay=True)
        cls.pause = rospy.Publisher("pause", Bool, queue_size=1, tcp_nodelay=True)

    @property
    def state(self) -> DriveState:
        return self.latest.message or DriveState()

    def setUp(self) -> None:
        super().setUp()
        self.sent = 0.0

    def send_key(self, linear: float) -> None:
        if time.monotonic() - self.sent < 0.1:
            return
        self.sent = time.monotonic()
        message = TwistStamped()
        message.twist.linear.x = linear
        self.key.publish(message)

    def send_both(self) -> None:
        self.robot.send(0.5, 0.0)
        self.send_key(-0.3)

    def commander(self, name: str) -> bool:
        return bool(self.state.commander == name)

    def await_motion(self, path: Program) -> None:
        end = time.monotonic() + 30.0
        while self.robot.speed < 0.2:
            self.assertLess(time.monotonic(), end, f"{path.output}\n{self.state}")
            time.sleep(0.02)

    def test_a_higher_source_takes_over_and_gives_back_when_it_is_silent(self) -> None:
        self.robot.drive_until("0.5 m/s by cmd_vel", self.robot.driving, angular=0.0)
        self.assertEqual(self.state.commander, "cmd_vel")
        wait_for("reverse by key_vel", lambda: self.robot.speed < -0.2, every=self.send_both)
        self.assertIn("cmd_vel: masked by key_vel", self.state.sources)
        wait_for("cmd_vel again", self.robot.driving, every=lambda: self.robot.send(0.5, 0.0))

    def test_a_lock_stops_it_and_its_end_lets_it_go_on(self) -> None:
        malformed = rospy.Publisher("pause", NoBool, queue_size=1)
        wait_for("a subscriber", lambda: malformed.get_num_connections() > 0)
        for publisher, message in ((self.pause, Bool(True)), (malformed, NoBool())):
            self.robot.drive_until("0.5 m/s", self.robot.driving, angular=0.0)
            publisher.publish(message)
            try:
                wait_for("standstill", lambda: abs(self.robot.speed) < 0.01, every=lambda: self.robot.send(0.5, 0.0))
                self.assertIn("cmd_vel: locked by pause", self.state.sources)
            finally:
                self.pause.publish(Bool(False))

    def test_a_reset_is_refused_while_a_revoked_source_requests_motion_and_names_its_sender(self) -> None:
        def send() -> None:
            self.robot.send(0.5, 0.0)
            self.send_key(0.0)

        self.robot.drive_until("0.5 m/s", self.robot.driving, angular=0.0)
        self.robot.call("e_stop_trigger")
        wait_for("cmd_vel is revoked", lambda: "cmd_vel: revoked" in self.state.sources, every=send)
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01, every=send)
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            send()
            answer = self.robot.call("e_stop_reset")
            self.assertFalse(answer.success)
            time.sleep(0.02)
        self.assertIn(rospy.get_name(), answer.message)
        self.robot.release()

    def test_cmd_vel_stamped_is_no_source_of_this_list(self) -> None:
        publisher = rospy.Publisher("cmd_vel_stamped", TwistStamped, queue_size=1)
        time.sleep(1.0)
        self.assertEqual(publisher.get_num_connections(), 0)

    def test_teleop_commands_as_key_vel(self) -> None:
        terminal = PseudoTerminal([roslib.packages.find_node("robot_control", "teleop.py")[0]])
        self.addCleanup(terminal.end)
        wait_for("its screen", lambda: "Ready: hold a key" in terminal.screen)
        wait_for("key_vel", lambda: self.commander("key_vel"), every=lambda: terminal.type("w"))
        wait_for(
            "its topic on the screen", lambda: "sent on /key_vel" in terminal.screen, every=lambda: terminal.type("w")
        )

    @again_after_a_stall
    def test_a_pad_on_joy_commands_while_it_is_held_and_its_silence_stops(self) -> None:
        pad = Program("pad.py", "--joy", "_scale_linear:=0.3")
        self.addCleanup(pad.end)
        joy = rospy.Publisher("joy", Joy, queue_size=1)
        wait_for("pad.py", lambda: joy.get_num_connections() > 0)
        released, held = Joy(axes=[0, 1], buttons=[0] * 6), Joy(axes=[0, 1], buttons=[0, 0, 0, 0, 1, 0])
        wait_for("its words", lambda: "hold button 4" in pad.output, every=lambda: joy.publish(released))
        wait_for("0.3 m/s", lambda: self.robot.speed > 0.25, every=lambda: joy.publish(held))
        self.assertTrue(self.commander("joy_vel"))
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01)
        wait_for("its words", lambda: "no pad answers" in pad.output)

    @again_after_a_stall
    def test_a_path_that_is_masked_pauses_until_resume_and_reaches_its_end(self) -> None:
        path = Program("drive_path.py", "circle", "--size", "1")
        self.addCleanup(path.end)
        wait_for("path_vel", lambda: self.commander("path_vel"))
        self.await_motion(path)
        words = "paused: path_vel is masked by key_vel"
        wait_for(words, lambda: words in path.output, every=lambda: self.send_key(0.0))
        wait_for("silence of key_vel", lambda: self.commander("path_vel"))
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01)
        self.assertTrue(path.running)
        self.assertTrue(rospy.ServiceProxy("/drive_path/resume", Trigger)().success)
        self.assertEqual(path.wait(), 0, path.output)
        self.assertIn("done; at most", path.output)

    def test_a_path_message_is_driven_and_one_of_another_frame_is_refused(self) -> None:
        plan = rospy.Publisher("plan", PathMessage, queue_size=1, latch=True)
        for frame, code in (("map", 1), ("odom", 0)):
            message = PathMessage()
            message.header.frame_id = frame
            x, y, yaw = astuple(self.robot.pose)
            for ahead in (0.0, 0.2, 0.4):
                pose = PoseStamped()
                pose.pose.position.x, pose.pose.position.y = x + ahead * math.cos(yaw), y + ahead * math.sin(yaw)
                message.poses.append(pose)
            plan.publish(message)
            path = Program("drive_path.py", "--topic", "plan")
            self.addCleanup(path.end)
            self.assertEqual(path.wait(), code, path.output)
            self.assertIn("done; at most" if code == 0 else "tf does not connect", path.output)

    def test_what_was_started_before_a_stop_but_suspended_before_its_first_line_moves_nothing(self) -> None:
        def stop() -> None:
            self.robot.call("e_stop_trigger")
            self.robot.release()

        def restart() -> None:
            self.robot.call("mujoco_plant/reset")
            wait_for("the restart", lambda: self.robot.state == SafetyStatus.INIT)
            time.sleep(0.2)  # the odometry begins again

        programs = (("drive_path.py", "square"), ("send_cmd.py", "--angular=0"))
        for (name, argument), end_permission in itertools.product(programs, (stop, restart)):
            program = Program(name, argument)
            program.send_signal(signal.SIGSTOP)
            self.addCleanup(program.end)
            time.sleep(0.05)  # a process knows its own beginning to 10 ms
            end_permission()
            before = self.robot.distance
            program.send_signal(signal.SIGCONT)
            self.assertEqual(program.wait(), 1, program.output)
            self.assertIn("the robot was stopped and released", program.output)
            self.assertAlmostEqual(self.robot.distance, before, delta=0.01)

    def test_two_publishers_of_joy_move_nothing(self) -> None:
        pad = Program("pad.py", "--joy", "_scale_linear:=0.3")
        self.addCleanup(pad.end)
        idle = FakePad(self)
        idle.plug()
        idle.program("__name:=idle")
        joy = rospy.Publisher("joy", Joy, queue_size=1)
        held = Joy(axes=[0, 1], buttons=[0, 0, 0, 0, 1, 0])
        words = "publish joy: zero until one is left"
        wait_for(f"{words}: {pad.output}", lambda: words in pad.output, every=lambda: joy.publish(held))
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            joy.publish(held)
            time.sleep(0.02)
        self.assertTrue(self.robot.rests())

    def test_ctrl_c_ends_a_path_with_zero(self) -> None:
        path = Program("drive_path.py", "square")
        self.addCleanup(path.end)
        self.await_motion(path)
        last: list[float] = []
        subscriber = rospy.Subscriber("path_vel", TwistStamped, lambda message: last.append(message.twist.linear.x))
        self.addCleanup(subscriber.unregister)
        wait_for("its commands", lambda: len(last) > 3)
        path.send_signal(signal.SIGINT)
        self.assertEqual(path.wait(), 1)
        self.assertEqual(last[-1], 0.0)
