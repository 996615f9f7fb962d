#!/usr/bin/python3
"""Every way to let go of the robot, really done in a browser, 20 times; once each stands in console_test.py."""

import rostest
from console_support import ConsoleTestCase
from system_support import again_after_a_stall

TRIALS = 20


class ConsoleReleaseTest(ConsoleTestCase):
    def test_every_way_to_let_go_is_zero_in_time_20_times(self) -> None:
        for trial in range(TRIALS):
            print(f"trial {trial + 1} of {TRIALS}")
            self.once()

    @again_after_a_stall
    def once(self) -> None:
        browser = self.browser()
        self.open(browser)
        self.each_way(browser)


if __name__ == "__main__":
    rostest.rosrun("robot_control", "console_release", ConsoleReleaseTest)
