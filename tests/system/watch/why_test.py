"""why.py answers beside a running robot, and beside none."""

import signal
import socket
import time

from system.system_support import LIMIT, LOOP, Program, RobotTestCase, wait_for


def answer(*arguments: str, **environment: str) -> tuple[int, str]:
    """Exit code and text of `why.py --once`."""
    program = Program("why.py", "--once", *arguments, environment=environment)
    try:
        return program.wait(), program.output
    finally:
        program.end()


class WhyTest(RobotTestCase):
    def setUp(self) -> None:
        self.robot.await_ready()

    def request(self, linear: float, angular: float) -> None:
        """Requests motion of a robot that no stall of this machine has stopped."""
        self.robot.release_after_a_stall()
        self.robot.send(linear, angular)

    def ask_until(self, words: str, named: str = "") -> tuple[int, str]:
        """The answer that begins with `words` and holds `named`; a node's report is up to a second old."""
        last = (0, "")

        def found() -> bool:
            nonlocal last
            last = answer()
            return last[1].startswith(words) and named in last[1]

        try:
            wait_for(words, found, every=lambda: self.request(0.5, 0.2))
        except AssertionError as error:
            raise AssertionError(f"{error}\n{last[1]}") from error
        return last

    def await_silence(self, program: Program) -> None:
        """Waits until there is nothing new for 12 frames, after all changes of a stop were reported."""
        said, since = "", time.monotonic()

        def silent() -> bool:
            nonlocal said, since
            if program.output != said:
                said, since = program.output, time.monotonic()
            return time.monotonic() - since > 3.0

        wait_for("silence", silent)

    def test_without_a_master_it_says_so(self) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            uri = f"http://127.0.0.1:{free.getsockname()[1]}"
        code, words = answer(ROS_MASTER_URI=uri)
        self.assertEqual(code, 1)
        self.assertTrue(words.startswith(f"No ROS master answers at {uri}."), words)
        self.assertIn("roslaunch robot_control sim.launch", words)

    def test_where_no_robot_is_it_says_where_one_is(self) -> None:
        code, words = answer("__ns:=nowhere")
        self.assertEqual(code, 1)
        self.assertTrue(words.startswith("No node of the robot runs in /nowhere."), words)
        self.assertIn("why.py __ns:=/\n", words)

    def test_a_driving_robot_moves_and_its_sender_is_named(self) -> None:
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        sender = Program("send_cmd.py", "--seconds", str(LIMIT))
        try:
            code, words = self.ask_until("Moving: ", named="/send_cmd")
            self.assertEqual(code, 0, words)
            for node in LOOP:
                self.assertIn(node, words)
        finally:
            sender.end()

    def test_a_stop_is_answered_with_its_cause_and_what_to_do(self) -> None:
        self.robot.send_e_stop(True)
        wait_for("the stop", lambda: "e_stop_topic" in self.robot.causes)
        code, words = answer()
        self.assertEqual(code, 1)
        self.assertTrue(words.startswith("Stopped: "), words)
        self.assertIn("an emergency stop is requested on the topic e_stop", words)
        self.assertIn("operator: release it where it was requested", words)
        self.assertIn("$ rosservice call /e_stop_reset", words)
        self.robot.send_e_stop(False)
        self.robot.release()

    def test_live_and_not_on_a_terminal_it_prints_what_changes_and_nothing_else(self) -> None:
        self.robot.await_rest()
        program = Program("why.py")
        try:
            wait_for("its first answer", lambda: "Ready: " in program.output, every=lambda: self.request(0, 0))
            self.robot.send_e_stop(True)
            wait_for("its second answer", lambda: "\nStopped: " in program.output)
            wait_for("the gate's word", lambda: "gate       brake" in program.output)
            self.await_silence(program)
            program.send_signal(signal.SIGINT)
            self.assertEqual(program.wait(), 0)
            self.assertNotIn("Traceback", program.output)
            self.assertNotIn("\x1b", program.output)
        finally:
            program.end()
            self.robot.send_e_stop(False)
            self.robot.release()
