"""first_steps.py beside the simulated quadbot: on a stool all steps that need no floor, on the floor all others."""

import os
import re
import signal
import tempfile
import time
import unittest
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import rosbag
import roslib.packages
import rospy
from robot_control.msg import SafetyStatus
from robot_control.srv import InjectFault
from system.launch_support import Launch
from system.pseudo_terminal import PseudoTerminal
from system.system_support import LIMIT, LOOP_WITNESS, Latest, again_after_a_stall, wait_for

BUS = f"first_steps{os.getpid()}"
QUESTION = re.compile(r"\[y/n\]|Press Enter\.")


class Person:
    """Answers what the program asks, and presses the emergency stop when it says so."""

    def __init__(self, *arguments: str) -> None:
        path = roslib.packages.find_node("robot_control", "first_steps.py")[0]
        self.terminal = PseudoTerminal([path, *arguments])
        self._inject_fault = rospy.ServiceProxy("mujoco_plant/inject_fault", InjectFault)
        self._button = "ok"
        self._answered = 0

    @property
    def output(self) -> str:
        return self.terminal.written.decode().replace("\r", "")

    def answer(self, end: str) -> None:
        """Answers each question before `end` once."""
        asked = [match[0] for match in QUESTION.finditer(self.output.partition(end)[0])]
        for question in asked[self._answered :]:
            self.terminal.type("y\n" if question == "[y/n]" else "\n")
        self._answered = len(asked)
        button = "stuck" if "press it within" in self.output and "is latched" not in self.output else "ok"
        if button != self._button:
            self._inject_fault("e_stop_button", button)
            self._button = button

    def until(self, what: str) -> None:
        """Answers until the program prints this, and no question after it."""
        try:
            wait_for(what, lambda: what in self.output, 2 * LIMIT, every=lambda: self.answer(what))
        except AssertionError as error:
            raise AssertionError(f"{error}, in:\n{self.output}") from None


class FirstStepsTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="first-steps-")
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)
        self.safety = Latest("safety_status", SafetyStatus)
        self.began = time.monotonic()

    @contextmanager
    def quadbot(self, scene: str) -> Iterator[None]:
        launch = Launch("robot:=quadbot", f"scene:={scene}", "black_box:=false", f"bus:={BUS}")
        try:
            wait_for("permission", lambda: self.state == "READY", 2 * LIMIT)
            yield
        finally:
            launch.end()
            self.safety.message = None
            for path in Path("/dev/shm").glob(f"robot_control.*.{BUS}.*"):
                path.unlink(missing_ok=True)

    @property
    def robot(self) -> "FirstStepsTest":
        """This case: again_after_a_stall reads whether its robot is `stalled`."""
        return self

    @property
    def stalled(self) -> bool:
        """True if the witness measured a stall of the loop, which may have stopped the robot during a step."""
        return bool(LOOP_WITNESS.saw(self.began, time.monotonic()))

    @property
    def state(self) -> str:
        return self.safety.message.state_name if self.safety.message else ""

    @contextmanager
    def person(self, *arguments: str) -> Iterator[Person]:
        person = Person(f"--out={self.out}", *arguments)
        try:
            yield person
        finally:
            person.terminal.end()

    @again_after_a_stall
    def test_the_steps_in_the_air_pass_and_ctrl_c_stops_the_robot(self) -> None:
        with self.quadbot("stool"):
            with self.person() as person:
                person.until("step 2 of 11, doctor")
                judged = re.compile(r"lines without a fault|doctor\.py: (fault|warning)")  # by what this machine is
                wait_for("a judgement", lambda: judged.search(person.output), 2 * LIMIT)
                person.terminal.send_signal(signal.SIGINT)
                self.assertEqual(person.terminal.wait(), 1, person.output)
            with self.person("--from=battery") as person:
                person.until("Lower the robot")
                person.terminal.send_signal(signal.SIGINT)
                self.assertEqual(person.terminal.wait(), 1, person.output)
                self.assertRegex(person.output, r"joints +passed\nlie +failed\nstand +not done")
                self.assertIn("first_steps.py: lie: interrupted", person.output)
                wait_for("a stop", lambda: self.state == "STOPPED")
                self.assertEqual(self.safety.message.first_cause, "e_stop_service")

    @again_after_a_stall
    def test_the_steps_on_the_floor_pass_and_a_robot_that_stands_there_does_not_hang(self) -> None:
        with self.quadbot("flat"):
            with self.person() as person:
                person.until("lift it until all feet hang free")
                self.assertEqual(person.terminal.wait(), 1, person.output)
                wait_for("a stop", lambda: self.state == "STOPPED")
            with self.person("--from=lie") as person:
                person.until("bag: ")
                self.assertEqual(person.terminal.wait(), 0, person.output)
                self.assertIn("Release it now?", person.output)
                self.assertRegex(person.output, r"trot +passed\nlower +passed")
                (path,) = re.findall(r"bag: (.*\.bag)", person.output)
                with rosbag.Bag(path) as bag:
                    postures = {message.posture for _, message, _ in bag.read_messages(["/leg_state"])}
                self.assertLessEqual({"lying", "standing", "walking"}, postures)
                wait_for("a stop", lambda: self.state == "STOPPED")
