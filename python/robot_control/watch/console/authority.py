"""The authority to command: which page has it, and with which command.

It reads no clock: time is an argument, s.

At most one page commands. It takes the command where it is free. It gives it back, hands it over, or loses it by its
end. A page of the role `maintain` may take it away. Every change ends the motion, for both pages.

    v = share · chosen speed · min(1, speed cap of the link / hypot(chosen linear, chosen lateral speed))

The same factor holds for all axes, so the curve stays. On wheels the lateral speed is zero.
"""

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from robot_control.drive.keys.operator import ZEROS, Limits
from robot_control.drive.pad_law import PadParameters
from robot_control.robot.command import Command
from robot_control.watch.console.dead_man import DeadMan, Drive
from robot_control.watch.console.settings import Settings

CHOSEN = Command(PadParameters.scale_linear, PadParameters.scale_angular, PadParameters.scale_lateral)
"""Chosen speeds of a new page"""


class Role(IntEnum):
    """The rights of a user; each role includes the lower ones."""

    WATCH = 0
    OPERATE = 1
    MAINTAIN = 2

    def __str__(self) -> str:
        return self.name.lower()


class RefusedError(Exception):
    """The page may not do that; the message says why."""


@dataclass(eq=False)
class Page:
    """One connected page."""

    number: int
    user: str  # its name
    role: Role
    dead_man: DeadMan
    chosen: Command = CHOSEN
    heartbeat: bool = False
    cap: float = 0.0  # m/s, of its link

    def __str__(self) -> str:
        return f"{self.user} (page {self.number})"


class Authority:
    """All pages, and the one that has the authority to command."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self.pages: dict[int, Page] = {}
        self.commander: Page | None = None
        self._last_number = 0
        self._zeros_until = self._rests_until = -math.inf
        self._drivable: bool | None = None

    def join(self, user: str, role: Role) -> Page:
        """Adds a page."""
        self._last_number += 1
        page = Page(self._last_number, user, role, DeadMan(self._settings))
        self.pages[page.number] = page
        return page

    def leave(self, page: Page, now: float) -> None:
        """Removes a page that has ended, in whatever way."""
        if self.commander is page:
            self._give(None, now, "the page has ended")
        self.pages.pop(page.number, None)

    def seen_by(self, page: Page) -> dict[str, Any]:
        """The values that a page shows of itself and of the others."""
        return {
            "type": "authority",
            "you": page.number,
            "role": str(page.role),
            "commander": None if self.commander is None else self.commander.number,
            "pages": [
                {"number": each.number, "name": each.user, "role": str(each.role)} for each in self.pages.values()
            ],
        }

    def take(self, page: Page, now: float, *, force: bool = False) -> None:
        """Takes the command; `force`: from another page. Raises RefusedError."""
        if page.role < Role.OPERATE:
            raise RefusedError("the role watch does not drive")
        if self.commander is page:
            return
        if self.commander is not None and not (force and page.role >= Role.MAINTAIN):
            raise RefusedError(f"{self.commander} has control; only the role maintain can take it")
        self._give(page, now, f"{page} has taken control")

    def hand_over(self, page: Page, to: int, now: float) -> None:
        """Hands the command over. Raises RefusedError."""
        self.require(page)
        other = self.pages.get(to)
        if other is None or other.role < Role.OPERATE:
            raise RefusedError(f"there is no page {to} that may drive")
        self._give(other, now, f"control was handed over to {other}")

    def give_back(self, page: Page, now: float) -> None:
        """Ends the command. Raises RefusedError."""
        self.require(page)
        self._give(None, now, "control was released")

    def require(self, page: Page) -> None:
        """Raises RefusedError unless the page commands."""
        if self.commander is not page:
            raise RefusedError(f"{self.commander or 'no page'} has control: take control first")

    def receive(self, page: Page, drive: Drive, now: float) -> None:
        """Receives the state of a page; without the command it moves nothing. Raises RefusedError."""
        if self.commander is page:
            page.dead_man.receive(drive, now)
        elif drive.held:
            raise RefusedError("this page does not have control: take control first")

    def interrupt(self, now: float, why: str) -> None:
        """Ends the motion after a stop, or after a pause of this program (interruptions.py)."""
        for page in self.pages.values():
            page.dead_man.interrupt(now, why)

    def permit(self, drivable: bool | None, *, legged: bool = False) -> None:  # noqa: FBT001 (a three-valued state)
        """Sets whether the robot may drive by its safety monitor; None if there is no message of it. `legged`: it also
        moves sideways.
        """
        if drivable:
            self._rests_until = -math.inf
        self._drivable = drivable
        for page in self.pages.values():
            page.dead_man.pad.legged = legged
            page.dead_man.pad.permit(drivable)

    def refuse(self, now: float) -> None:
        """Notes that the controller refuses motion until it has received a zero."""
        for page in self.pages.values():
            page.dead_man.pad.refuse(now)
        self._zeros_until = now + ZEROS

    def rest(self, until: float) -> None:
        """Sends zeros until then, s, and until the robot may drive. A reset waits for one that arrives after the last
        late cycle. Silence has to last for cmd_vel_timeout without such a cycle (safety/latch/motion_release.h).
        """
        if not self._drivable:
            self._rests_until = until

    def command(self, limits: Limits, now: float) -> tuple[Command | None, float]:
        """The command to send now, or None if nothing is sent; and its age, s."""
        for each in self.pages.values():
            each.cap = each.dead_man.cap.step(each.dead_man.round_trips.percentile95(now), now)
        page = self.commander
        share = None if page is None else page.dead_man.share(now)
        if page is None or share is None or share == Command():
            nothing = share is None and now >= max(self._zeros_until, self._rests_until)
            return None if nothing else Command(), 0.0
        self._zeros_until = now + ZEROS
        linear, angular = min(page.chosen.linear, limits.linear), min(page.chosen.angular, limits.angular)
        lateral = min(page.chosen.lateral, limits.lateral)
        fastest = math.hypot(linear, lateral)
        factor = min(1.0, page.cap / fastest) if fastest > 0 else 0.0
        command = Command(
            max(share.linear * linear * factor, -limits.reverse),
            share.angular * angular * factor,
            share.lateral * lateral * factor,
        )
        return command, max(0.0, now - page.dead_man.stamp)

    def _give(self, page: Page | None, now: float, why: str) -> None:
        for each in (self.commander, page):
            if each is not None:
                each.dead_man.interrupt(now, why)
        self.commander = page
        self._zeros_until = now + ZEROS
