"""pad.py as a process with a pad of this machine: held, released, unplugged and plugged in again while it drives.

The kernel of a test machine has no uinput, so the library is a fake one (tests/support/fake_evdev). The case of a real
device in test_pad.py compares its interface with the real one's.
"""

import time

import rospy
from geometry_msgs.msg import TwistStamped
from system.fake_pad import ENABLE, FakePad
from system.system_support import RobotTestCase, again_after_a_stall, wait_for

FORWARD = 0
"""value of 0 to 255: the kernel counts down"""


class PadTest(RobotTestCase):
    def setUp(self) -> None:
        super().setUp()
        self.device = FakePad(self)
        self.plug = self.device.plug
        self.sent: list[float] = []
        subscriber = rospy.Subscriber("cmd_vel_stamped", TwistStamped, lambda m: self.sent.append(m.twist.linear.x))
        self.addCleanup(subscriber.unregister)
        self.pad = self.device.program("_scale_linear:=0.3")

    def await_words(self, words: str) -> None:
        wait_for(f"{words}: {self.pad.output}", lambda: words in self.pad.output)

    def drive(self) -> None:
        before = self.pad.output.count("hold button 4")
        self.plug()
        wait_for("a pad with nothing held", lambda: self.pad.output.count("hold button 4") > before)
        self.plug(ENABLE, forward=FORWARD)
        wait_for("0.3 m/s", lambda: self.robot.speed > 0.27)

    @again_after_a_stall
    def test_a_release_stops_the_robot(self) -> None:
        self.drive()
        self.plug(forward=FORWARD)
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01)
        self.assertEqual(self.sent[-1], 0.0)

    @again_after_a_stall
    def test_an_unplugged_pad_stops_the_robot_and_has_to_be_released_when_it_comes_back(self) -> None:
        self.drive()
        began = time.monotonic()
        self.device.device.unlink()
        wait_for("standstill", lambda: abs(self.robot.speed) < 0.01)
        print(f"at rest {time.monotonic() - began:.2f} s after the pad was unplugged")
        self.assertEqual(self.sent[-1], 0.0)
        self.await_words("Fake pad is gone: zero")
        self.plug(ENABLE, forward=FORWARD)
        self.await_words("release the enable button once")
        time.sleep(1.0)
        self.assertLess(abs(self.robot.speed), 0.01)
        self.drive()

    @again_after_a_stall
    def test_a_pad_that_was_released_just_before_a_stop_drives_after_its_reset(self) -> None:
        self.drive()
        self.plug(forward=FORWARD)
        time.sleep(1.1)  # longer than zeros are sent, shorter than cmd_vel_timeout
        self.robot.call("e_stop_trigger")
        self.robot.release()
        time.sleep(0.5)  # pad.py sees the release, and then the button
        self.plug(ENABLE, forward=FORWARD)
        wait_for("0.3 m/s", lambda: self.robot.speed > 0.27)
