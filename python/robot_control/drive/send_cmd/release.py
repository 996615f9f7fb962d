"""Decides by safety_status when send_cmd.py may send its command; no ROS in here.

    WAITING   zeros, until the state is READY or DRIVE for the first time since this program started
    SENDING   the command, while it stays so
    STOPPED   zeros for good, which let a reset be accepted; over when the robot is released: motion needs a new start.
              So it begins where this program was started during a stop, and wherever what was requested with its start
              is revoked (interruptions.py)

Without any safety_status the command is sent provisionally after NO_MONITOR. The first status then decides as if it had
come at the start.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum, auto

from robot_control.loop.roles import MONITOR
from robot_control.robot.interruptions import Interruptions, Status
from robot_control.robot.zero_request import silent_long_enough

NO_MONITOR = 3.0
"""s without any safety_status, which comes once per second at least"""
GONE = 0.5
"""s without a publisher of safety_status after there was one"""
TIMEOUT = 2.0
"""s in which a start needs no explanation; a silent cmd_vel ends the wait for a zero sooner"""
STANDING = 0.01
"""m/s; a speed limit below it is none to drive with"""


@dataclass(frozen=True)
class Line:
    """A line for the log."""

    text: str
    warning: bool = True


class Phase(Enum):
    """The kind of message that is sent."""

    WAITING = auto()
    SENDING = auto()
    STOPPED = auto()
    RELEASED = auto()  # after STOPPED; nothing more


class Release:
    """Follows safety_status; times in s of any one clock."""

    def __init__(self, now: float, began: float | None = None) -> None:
        """`began`: s when the program did, where that is not `now`."""
        self.command_timeout = 0.0  # s, the controller's; 0: off, or not known
        self._start = self._received_at = now
        self._requested = now if began is None else began
        self._interruptions = Interruptions(now, began)
        self.phase = Phase.WAITING  # the kind of message that is sent now
        self._provisional = False
        self._silence_logged = False
        self._gone_since = math.inf
        self._waiting_for = ""
        self._say_at = math.inf
        self._no_speed = False

    def interrupt(self, now: float, why: str) -> None:
        """Ends the command: something else than the robot speaks against it."""
        self._interruptions.interrupt(now, why)

    def step(self, now: float, statuses: Sequence[Status] = (), *, connected: bool = True) -> list[Line]:
        """One look of the program, with all messages since the previous one.

        Args:
            now: s.
            statuses: in their order.
            connected: a publisher of safety_status is there.
        """
        self._interruptions.step(now)
        lines = [line for status in statuses for line in self.update(now, status)]
        if statuses:
            self._received_at = now
        return lines + self.update(now, self._interruptions.status, now - self._received_at, connected=connected)

    def update(self, now: float, status: Status | None, age: float = 0.0, *, connected: bool = True) -> list[Line]:
        """Updates the state with what is known `now`.

        Args:
            now: s.
            status: the last one; None: none came yet.
            age: s since it came.
            connected: a publisher of safety_status is there.
        """
        return list(self._look(now, status, age, connected))

    def _look(self, now: float, status: Status | None, age: float, connected: bool) -> Iterator[Line]:  # noqa: FBT001
        if status is not None:
            self._interruptions.receive(status, now)
        why = self._interruptions.revoked(self._requested)
        if why and self.phase in {Phase.WAITING, Phase.SENDING}:
            self.phase, self._provisional = Phase.STOPPED, False
            remedy = f"{status.remedy}, then " if status is not None and status.remedy else ""
            what = f"{why}. The command has no effect, zeros are sent from now on. To drive again"
            yield Line(f"{what}: {remedy}start send_cmd.py again")
        elif status is None:
            yield from self._without_monitor(now)
        else:
            yield from self._with_monitor(now, status, age, connected=connected)

    def _with_monitor(self, now: float, status: Status, age: float, *, connected: bool) -> Iterator[Line]:
        if self._provisional:
            self._provisional = False
            self.phase = Phase.WAITING
        self._gone_since = math.inf if connected else min(self._gone_since, now)
        if self.phase is Phase.WAITING:
            yield from self._wait(now, status, age)
        elif self.phase is Phase.SENDING:
            yield from self._drive(now, status, age)
        elif self.phase is Phase.STOPPED and status.drivable and connected:
            self.phase = Phase.RELEASED
            yield Line("the robot is released; this command does not begin again by itself: start send_cmd.py again")

    def _without_monitor(self, now: float) -> Iterator[Line]:
        if self.phase is not Phase.WAITING or now - self._start < NO_MONITOR:
            return
        self._provisional = True
        self.phase = Phase.SENDING
        what = f"no safety_status within {NO_MONITOR:g} s: {MONITOR} does not run, and without it the robot brakes"
        yield Line(f"{what}; the command is still sent")

    def _wait(self, now: float, status: Status, age: float) -> Iterator[Line]:
        gone = now - self._gone_since > GONE or age > NO_MONITOR
        if status.drivable and not gone:
            self.phase = Phase.SENDING
            return
        text = self._obstacle(status, gone=gone)
        if text != self._waiting_for:
            patience = TIMEOUT if status.state == "INIT" or gone else 0.0
            self._waiting_for, self._say_at = text, now + patience
        if now >= self._say_at:
            self._say_at = math.inf
            yield Line(text)

    def _obstacle(self, status: Status, *, gone: bool) -> str:
        if gone:
            return f"safety_status is silent: waits with zeros for {MONITOR}"
        if status.awaiting_zero:
            silence = silent_long_enough(self.command_timeout)
            return f"waiting for a zero velocity command; stop the other sender{silence}, or publish zero from it"
        return f"waits with zeros: {MONITOR} waits: {', '.join(status.missing) or 'the first cycles'}"

    def _drive(self, now: float, status: Status, age: float) -> Iterator[Line]:
        if now - self._gone_since > GONE:
            self.phase = Phase.STOPPED
            yield Line(
                f"{MONITOR} is gone, and without it the robot brakes: the command has no effect, zeros are sent "
                f"from now on. To drive again: start {MONITOR}, call e_stop_reset, start send_cmd.py again"
            )
            return
        if age > NO_MONITOR and not self._silence_logged:
            self._silence_logged = True
            yield Line(f"no safety_status for {NO_MONITOR:g} s: {MONITOR} may hang; then the robot brakes")
        no_speed = status.speed_limit < STANDING
        if no_speed and not self._no_speed:
            yield Line("the command has no effect now: clearance leaves the robot no speed")
        self._no_speed = no_speed
