"""`one_sender: true`: while two nodes send commands the robot obeys neither."""

import rospy
from system.commands_support import StampedSender
from system.system_support import CONTROLLER, LIMIT, Program, RobotTestCase, wait_for


class OneSenderTest(RobotTestCase):
    parameters = (("/diff_drive_controller/one_sender", True),)

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.sender = StampedSender(cls.robot)

    def test_two_stop_it_and_one_drives_on_without_a_reset(self) -> None:
        self.robot.drive_until("0.5 m/s", self.robot.driving)
        other = Program("send_cmd.py", "--seconds", str(LIMIT))
        try:
            wait_for("the reason", lambda: "many_senders" in self.sender.reasons, every=self.send)
            wait_for("standstill", lambda: abs(self.robot.speed) < 0.01, every=self.send)
            words = f"2 nodes send commands: {rospy.get_name()}, /send_cmd; refused while one of them requests motion"
            self.assertIn(words, self.robot.nodes[CONTROLLER].output)
            wait_for(
                "diagnostics",
                lambda: (
                    "more than one node sends commands" in self.sender.report.message
                    and int(self.sender.report.values["commands_of_too_many_senders"]) > 0
                ),
                every=self.send,
            )
        finally:
            other.end()
        self.robot.drive_until("0.5 m/s again", self.robot.driving)
        self.assertNotIn("many_senders", self.sender.reasons)

    def send(self) -> None:
        self.robot.send(0.5, 0.0)
