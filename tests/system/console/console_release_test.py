"""Every way to let go of the robot, really done in a browser, 20 times; once each stands in console_test.py."""

from system.console.console_support import ConsoleTestCase

TRIALS = 20


class ConsoleReleaseTest(ConsoleTestCase):
    def test_every_way_to_let_go_is_zero_in_time_20_times(self) -> None:
        for trial in range(TRIALS):
            print(f"trial {trial + 1} of {TRIALS}")
            self.lets_go_of_what_the_page_notices()
            self.lets_go_when_something_falls_silent()
            self.lets_go_when_something_ends()
