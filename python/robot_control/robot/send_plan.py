"""The commands that send_cmd.py sends, and their times; no ROS in here."""

import argparse
import math
from dataclasses import dataclass

LOCKSTEP = (
    "Paced by the wall clock: in lockstep, where many simulated seconds pass between two sends, every command times "
    "out. Give that run a command_script instead."
)
START = (
    "Sends zeros until safety_status is READY or DRIVE, then the command. During a stop, it sends zeros until the "
    "robot is released, and ends with exit code 1; motion needs a new start."
)
ZERO_PERIOD = 0.2
"""s between two zeros, at most"""


@dataclass(frozen=True)
class SendPlan:
    """A constant velocity command, repeated."""

    linear: float = 0.5  # m/s, forward
    angular: float = 0.2  # rad/s, to the left
    period: float = 0.5  # s, between two sends
    count: int | None = None  # sends; None: until interrupted
    lateral: float = 0.0  # m/s, to the left

    def sends_left(self, sent: int) -> bool:
        """True if another command has to be sent after `sent`."""
        return self.count is None or sent < self.count

    @property
    def zero_period(self) -> float:
        """s between two zeros."""
        return min(self.period, ZERO_PERIOD)

    def describe(self, sent: int) -> str:
        """One line for the log."""
        lateral = f"{self.lateral:g} m/s to the left, " if self.lateral else ""
        return f"cmd_vel {sent}: {self.linear:g} m/s, {lateral}{self.angular:g} rad/s"


def positive(text: str) -> float:
    """argparse type: a finite number above zero."""
    value = float(text)
    if not (math.isfinite(value) and value > 0):
        raise argparse.ArgumentTypeError(f"{text} is not a number above zero")
    return value


def number_of_sends(text: str) -> int:
    """argparse type: a whole number above zero."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not a whole number above zero")
    return value


def parse_plan(arguments: list[str]) -> SendPlan:
    """Reads the command line (without the program's name); ends the program on a wrong one.

    NaN and infinity are allowed as a velocity: the controller refuses them, and that can be seen with this tool.
    """
    about = f"Repeats one velocity command on cmd_vel. {START}"
    parser = argparse.ArgumentParser(prog="send_cmd.py", description=about, epilog=LOCKSTEP)
    parser.add_argument("--linear", type=float, default=SendPlan.linear, help="m/s (default %(default)s)")
    meaning = "m/s to the left, robots on legs (default %(default)s)"
    parser.add_argument("--lateral", type=float, default=SendPlan.lateral, help=meaning)
    parser.add_argument("--angular", type=float, default=SendPlan.angular, help="rad/s (default %(default)s)")
    meaning = "s between sends (default %(default)s)"
    parser.add_argument("--period", type=positive, default=SendPlan.period, help=meaning)
    end = parser.add_mutually_exclusive_group()
    end.add_argument("--count", type=number_of_sends, help="end after so many sends")
    end.add_argument("--seconds", type=positive, help="end after so many seconds")
    given = parser.parse_args(arguments)
    count = given.count
    if given.seconds is not None:
        count = max(1, math.ceil(given.seconds / given.period))
    return SendPlan(given.linear, given.angular, given.period, count, given.lateral)
