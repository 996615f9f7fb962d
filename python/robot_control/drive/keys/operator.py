"""Converts keys to a velocity command, an e-stop and a reset. It reads no clock: time is an argument.

Motion is commanded only while a key is held and the robot may drive. A robot that stopped does not move again under a
key that was held all the time: keys count after they have paused. The first key of a reset arms it for RESET_WINDOW.
The second one, at least RESET_PAUSE later, requests it.

The chosen speeds stay within the robot's limits. Until a key's first repeat the robot drives a share of them, which is
then a share of what it can drive. A held key changes them once per press.
"""

from dataclasses import dataclass
from enum import Enum, auto

from robot_control.drive.keys.dead_man import DeadMan, Held, HoldParameters
from robot_control.drive.keys.key_map import E_STOPS, KeyMap
from robot_control.drive.keys.keyboard import Event, Key
from robot_control.drive.keys.single_press import SinglePress
from robot_control.loop.roles import NO_LATERAL
from robot_control.robot.command import Command

RESET_WINDOW = 5.0
"""s"""
RESET_PAUSE = 0.2
"""s; two keys within it are one act: a paste, a macro of the keyboard, the burst of a link that had stalled"""
ZEROS = 1.0
"""s for which zeros are sent after a motion; then the topic is silent, so that another sender may command"""


class Request(Enum):
    """A request of a key other than motion."""

    E_STOP = auto()
    RESET = auto()
    END = auto()


@dataclass(frozen=True)
class Limits:
    """Limits of the robot."""

    linear: float  # m/s
    angular: float  # rad/s
    reverse: float  # m/s, backwards
    lateral: float = 0.0  # m/s, to the left and right; 0 on wheels


class Operator:
    """Derives commands and requests from the keys."""

    def __init__(self, keys: KeyMap, chosen: Command, limits: Limits, hold: HoldParameters | None = None) -> None:
        """`chosen`: the initial speeds; `limits`: the robot's."""
        self._keys = keys
        self._chosen, self._limits = chosen, limits
        self._speed_keys = SinglePress()
        self._dead_man = DeadMan(hold, keys.motions)
        self._drivable: bool | None = None
        self._e_stopped = False
        self._reset_at = float("-inf")
        self._zeros_until = float("-inf")

    def start(self, now: float) -> None:
        """Sends zeros, so that the robot may be released."""
        self._zeros_until = now + ZEROS

    def key(self, key: Key, now: float, *, late: bool = False) -> Request | None:
        """Takes a key event; `late`: this program stood still before it read it, so it may be old."""
        name = key.name
        if key.event is Event.RELEASE:
            self._dead_man.release(name)
            self._change_speeds(self._speed_keys.release(name))
            return None
        if name == "interrupt":
            return Request.END
        if name in E_STOPS:
            self._stop(now)
            self._e_stopped = True
            return Request.E_STOP
        if name in self._keys.stops:
            self._stop(now)
        elif late:
            if name in self._keys.motions:
                self._dead_man.block(name, now)
        elif name == "y" and RESET_PAUSE <= now - self._reset_at < RESET_WINDOW:
            self._reset_at = float("-inf")
            self._stop(now)
            return Request.RESET
        elif name in self._keys.motions:
            self._reset_at = float("-inf")
            if self._drivable is False or self._e_stopped:
                self._dead_man.block(name, now)
            else:
                self._dead_man.press(name, now, repeat=key.event is Event.REPEAT)
        elif name == "r" and key.event is Event.PRESS:
            self._stop(now)
            self._reset_at = now
        elif name in self._keys.speeds:
            self._change_speeds(self._speed_keys.press(name, now, repeat=key.event is Event.REPEAT))
        return None

    @property
    def chosen(self) -> Command:
        """The speeds of a held key, within the robot's limits."""
        chosen, limits = self._chosen, self._limits
        angular = min(chosen.angular, limits.angular)
        return Command(min(chosen.linear, limits.linear), angular, min(chosen.lateral, limits.lateral))

    def limit(self, limits: Limits) -> None:
        """Sets the robot's present limits."""
        self._limits = limits

    def permit(self, drivable: bool | None, now: float) -> None:  # noqa: FBT001 (a three-valued state)
        """Sets whether the robot may drive by its safety monitor; None if there is no message of it."""
        if drivable is False and self._drivable is not False:
            self.interrupt(now)
        if drivable is True and self._drivable is False:
            self._e_stopped = False
        self._drivable = drivable

    def interrupt(self, now: float) -> None:
        """Ends a hold: it began before a stop, or before this program stood still (interruptions.py)."""
        self._dead_man.end(now)
        self._reset_at = float("-inf")
        self._zeros_until = now + ZEROS

    def reset_accepted(self) -> None:
        """Takes the answer to Request.RESET."""
        self._e_stopped = False

    def command(self, now: float) -> Command | None:
        """The command to send now; None: nothing is sent."""
        self._change_speeds(self._speed_keys.due(now))
        held = self.held(now)
        if held is not None:
            self._zeros_until = now + ZEROS
            motion, chosen = self._keys.motions[held.key], self.chosen
            linear = max(motion.linear * chosen.linear, -self._limits.reverse)
            angular = motion.angular * held.share * chosen.angular
            return Command(held.share * linear, angular, motion.lateral * held.share * chosen.lateral)
        return Command() if now < self._zeros_until or self._e_stopped else None

    def held(self, now: float) -> Held | None:
        """The key that moves the robot."""
        held = self._dead_man.held(now)
        return None if self._e_stopped else held

    def message(self, now: float) -> str:
        """The program's message about itself; empty if there is none."""
        held = self.held(now)
        if self._e_stopped:
            text = "EMERGENCY STOP requested; no motion until a reset (r, then y)"
        elif held is not None and self._dead_man.ends_soon(held):
            text = f"key {held.key}: held for long; the robot stops in {held.left:.0f} s unless it is pressed again"
        elif held is not None and self._keys.motions[held.key].lateral and self._limits.lateral == 0:
            text = f"key {held.key} has no effect: {NO_LATERAL}"
        elif self._dead_man.overlong:
            text = "stopped: the key was held too long; release it, then press again"
        elif self._dead_man.blocked(now) and self._drivable is not False:
            text = "a key is held since before a stop, or a pause of this program: release it, then press again"
        else:
            text = ""
        if now - self._reset_at < RESET_WINDOW:
            text = f"reset? y within {self._reset_at + RESET_WINDOW - now:.0f} s; any motion key cancels"
        return text

    def _change_speeds(self, keys: list[str]) -> None:
        for key in keys:
            factor, chosen = self._keys.speeds[key], self.chosen
            lateral = chosen.lateral or self._chosen.lateral  # before the robot's kind is known, its limit is 0
            angular = chosen.angular * factor.angular
            self._chosen = Command(chosen.linear * factor.linear, angular, lateral * factor.linear)

    def _stop(self, now: float) -> None:
        self._dead_man.stop(now)
        self._reset_at = float("-inf")
        self._zeros_until = now + ZEROS
