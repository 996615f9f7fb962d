"""The shipped senders in virtual time: their laws, combined as in their programs, one `step` per pass.

Each begins at its first pass, or at `began` [s] before it. Its `step` gets `now` [s], the messages of safety_status
since the last pass, and its own input. It returns the command that it sends, or None. A suspended program is one whose
`step` is not called.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from robot_control.drive.keys.key_map import ARROWS
from robot_control.drive.keys.keyboard import Decoder
from robot_control.drive.keys.operator import Limits, Operator
from robot_control.drive.pad_law import Pad
from robot_control.drive.path.follower import Follower, Motion
from robot_control.drive.path.pieces import route
from robot_control.drive.path.waypoints import Waypoint
from robot_control.drive.send_cmd.release import Phase, Release
from robot_control.drive.teleop.backlog import Backlog
from robot_control.robot.command import Command
from robot_control.robot.interruptions import Interruptions, Status, requested_at
from robot_control.robot.pose import Pose

CHOSEN, LIMITS = Command(0.5, 1.0), Limits(1.0, 2.0, reverse=1.0)


class _Watch:
    """The evaluation of safety_status that all senders share."""

    def __init__(self, now: float, began: float | None = None) -> None:
        self.interruptions = Interruptions(now, began)
        self._seen = 0

    def interrupted(self, now: float, statuses: Sequence[Status], *, waited: bool = False) -> bool:
        self.interruptions.step(now, statuses, waited=waited)
        new, self._seen = self.interruptions.count > self._seen, self.interruptions.count
        return new

    @property
    def drivable(self) -> bool | None:
        status = self.interruptions.status
        return None if status is None else status.drivable


class TeleopSender:
    """teleop.py; its input: bytes of the terminal."""

    def __init__(self, now: float) -> None:
        self._watch, self._decoder, self._backlog = _Watch(now), Decoder(), Backlog(now)
        self._operator = Operator(ARROWS, CHOSEN, LIMITS)
        self._operator.start(now)

    def step(self, now: float, statuses: Sequence[Status], data: bytes) -> Command | None:
        """One pass."""
        late = self._backlog.late(data, now)
        if self._watch.interrupted(now, statuses):
            self._operator.interrupt(now)
        for key in [*self._decoder.feed(data, now), *self._decoder.flush(now)]:
            self._operator.key(key, now, late=late)
        self._operator.permit(self._watch.drivable, now)
        return self._operator.command(now)


class PadSender:
    """pad.py; its input: axes, buttons and sender of each message."""

    def __init__(self, now: float) -> None:
        self._watch, self._pad = _Watch(now), Pad()
        self._pad.start(now)

    def step(
        self, now: float, statuses: Sequence[Status], messages: Sequence[tuple[Sequence[float], Sequence[int], str]]
    ) -> Command | None:
        """One pass."""
        for axes, buttons, sender in messages:
            self._pad.receive(axes, buttons, now, sender)
        if self._watch.interrupted(now, statuses):
            self._pad.interrupt(now)
        self._pad.permit(self._watch.drivable)
        return self._pad.command(now)


class PathSender:
    """drive_path.py, or one goal of follow_path.py: requested at construction, driven once it is planned."""

    def __init__(self, now: float, watch: _Watch | None = None, requested: float | None = None) -> None:
        """`requested`: s when, where that is not `now`; without a `watch` the process began then."""
        self._watch, self._requested = watch or _Watch(now, requested), now if requested is None else requested
        self._follower: Follower | None = None
        self._odometry_at = now
        self._driving = False
        self.reason = ""  # why it ended

    def plan(self, waypoints: Sequence[Waypoint]) -> None:
        """Takes the plan when it comes."""
        self._follower = Follower(route(waypoints))

    def step(self, now: float, statuses: Sequence[Status], odometry: tuple[Pose, Motion] | None) -> Command | None:
        """One pass; none is needed while it plans."""
        self._watch.interrupted(now, statuses, waited=not self._driving)
        stopped = self._watch.interruptions.status is not None and self._watch.interruptions.status.stopped
        self.reason = (
            self.reason or self._watch.interruptions.revoked(self._requested) or ("stopped" if stopped else "")
        )
        if self.reason or self._follower is None or not self._watch.drivable or odometry is None:
            return Command()
        self._driving = True
        elapsed, self._odometry_at = now - self._odometry_at, now
        motion = self._follower.step(*odometry, elapsed=min(elapsed, 0.5))
        self.reason = self._follower.reason
        return Command(motion.linear, motion.angular)


class GoalSender:
    """follow_path.py; its further input: goals, each with the stated time of sending, or None."""

    def __init__(self, now: float) -> None:
        self._watch = _Watch(now)
        self._path: PathSender | None = None

    def step(
        self,
        now: float,
        statuses: Sequence[Status],
        odometry: tuple[Pose, Motion],
        goals: Sequence[tuple[Sequence[Waypoint], float | None]],
    ) -> Command | None:
        """One pass; the newest goal counts."""
        self._watch.interrupted(now, statuses)
        for waypoints, sent in goals:
            self._path = PathSender(now, self._watch, requested_at(now, sent))
            self._path.plan(waypoints)
        return None if self._path is None else self._path.step(now, (), odometry)


class CommandSender:
    """send_cmd.py; it has no input."""

    def __init__(self, now: float, began: float | None = None) -> None:
        self._release = Release(now, began)
        self._due = -math.inf

    def step(self, now: float, statuses: Sequence[Status], _input: object = None) -> Command | None:
        """One pass; it sends once per period, and at once on a change."""
        phase = self._release.phase
        self._release.step(now, statuses)
        if self._release.phase is Phase.RELEASED or (self._release.phase is phase and now < self._due):
            return None
        self._due = now + 0.2
        return CHOSEN if self._release.phase is Phase.SENDING else Command()
