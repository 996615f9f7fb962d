"""Converts a pad's axes and buttons to a velocity. It reads no clock: time is an argument, s of any one clock.

    v_x = scale_linear · axes[axis_linear]      while enable_button is held, else 0
    v_y = scale_lateral · axes[axis_lateral]    on legs, else 0
    ω = scale_angular · axes[axis_angular]

With enable_turbo_button held, the turbo scales hold instead. The names are those of teleop_twist_joy.

The enable button counts only after it was seen released. That release has to follow each silence of the pad, each stop
and each pause of this program by SETTLING (interruptions.py). The robot has to be permitted to drive then. A hold ends
after max_hold, whatever the stick does. The reason: a wireless receiver that has lost its pad goes on reporting its
last values, noise included.

One pad is one sender. While messages of another sender arrive within joy_timeout, nothing moves.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from robot_control.loop.roles import NO_LATERAL
from robot_control.robot.command import Command

SETTLING = 0.3
"""s after an interruption, or a silence of the pad, in which messages may still arrive that were sent before it"""
ZEROS = 1.0
"""s for which zeros are sent after a motion; then the topic is silent, so that another sender may command"""
MAX_INPUTS = 256
"""axes or buttons of a message"""


@dataclass(frozen=True)
class PadParameters:
    """As in teleop_twist_joy; indices count from 0, a button of −1 is none."""

    axis_linear: int = 1  # left stick, forward
    axis_angular: int = 0  # left stick, to the left
    axis_lateral: int = 3  # right stick, to the left
    scale_linear: float = 0.5  # m/s
    scale_angular: float = 1.0  # rad/s
    scale_lateral: float = 0.3  # m/s
    scale_linear_turbo: float = 1.0  # m/s
    scale_angular_turbo: float = 1.5  # rad/s
    scale_lateral_turbo: float = 0.5  # m/s
    enable_button: int = 4  # left shoulder
    enable_turbo_button: int = 5  # right shoulder
    deadzone: float = 0.1  # share of an axis around its middle that counts as the middle
    max_hold: float = 30.0  # s
    joy_timeout: float = 0.5  # s without an answer of the device, or a message on joy


class Pad:
    """Derives the command from the pad."""

    def __init__(self, parameters: PadParameters | None = None) -> None:
        self._given = parameters or PadParameters()
        self.legged = False  # true: the robot also moves sideways
        self._axes: tuple[float, ...] = ()
        self._buttons: tuple[int, ...] = ()
        self._answered_at = float("-inf")
        self._held_since = float("inf")
        self._sender = ""
        self._newest: dict[str, float] = {}  # time of each sender's newest message, for senders of the last joy_timeout
        self._drivable: bool | None = None
        self._armed = False  # true once the enable buttons were seen released
        self._arms_from = float("-inf")
        self._zeros_until = float("-inf")

    def start(self, now: float) -> None:
        """Sends zeros, so that the robot may be released."""
        self._zeros_until = now + ZEROS

    def receive(self, axes: Sequence[float], buttons: Sequence[int], now: float, sender: str = "") -> None:
        """Takes an answer of the device or a message of this sender: its axes, −1 … 1, and buttons, 0 or 1."""
        if len(axes) > MAX_INPUTS or len(buttons) > MAX_INPUTS:
            return
        came_back = not self.answers(now)
        self._newest = {name: self._newest[name] for name in self._senders(now)} | {sender: now}
        if sender != self._sender and not came_back:
            self._armed = False
            return
        if came_back:
            self._arms_from = max(self._arms_from, now + SETTLING)
        self._sender = sender
        self._axes, self._buttons = tuple(axes), tuple(buttons)
        self._answered_at = now
        if self._held():
            self._armed = self._armed and not came_back
            self._held_since = min(self._held_since, now)
        else:
            self._armed = len(self._newest) == 1 and now >= self._arms_from
            self._held_since = float("inf")

    def interrupt(self, now: float) -> None:
        """Ends a hold: it began before a stop, or before this program stood still (interruptions.py)."""
        self.refuse(now)
        self._arms_from = now + SETTLING

    def refuse(self, now: float) -> None:
        """Notes that the controller refuses motion until it has received a zero."""
        self._armed, self._zeros_until = False, now + ZEROS

    def permit(self, drivable: bool | None) -> None:  # noqa: FBT001 (a three-valued state)
        """Sets whether the robot may drive by its safety monitor; None if there is no message of it."""
        if self._drivable is False and drivable is not False:
            self._armed = False  # the button may have been pressed during the stop
        self._drivable = drivable

    def lose(self) -> None:
        """Notes that the device is gone."""
        self._answered_at = float("-inf")

    def command(self, now: float) -> Command | None:
        """The command to send now; None: nothing is sent."""
        if self._held() and (self._drivable is False or now - self._held_since >= self._given.max_hold):
            self._armed = False
        if not (self.answers(now) and self._armed and self._held()):
            return Command() if now < self._zeros_until else None
        self._zeros_until = now + ZEROS
        given, turbo = self._given, self._pressed(self._given.enable_turbo_button)
        linear = given.scale_linear_turbo if turbo else given.scale_linear
        angular = given.scale_angular_turbo if turbo else given.scale_angular
        lateral = given.scale_lateral_turbo if turbo else given.scale_lateral
        return Command(
            linear * self._axis(given.axis_linear),
            angular * self._axis(given.axis_angular),
            lateral * self._axis(given.axis_lateral) if self.legged else 0.0,
        )

    def answers(self, now: float) -> bool:
        """True while the device answers, or messages arrive."""
        return now - self._answered_at <= self._given.joy_timeout

    def state(self, now: float) -> str:
        """The state as text."""
        if not self.answers(now):
            return "no pad answers"
        if len(self._senders(now)) > 1:
            return f"{' and '.join(self._senders(now))} publish joy: zero until one is left"
        if not self._armed:
            return "release the enable button once"
        if not self._held():
            return f"hold button {self._given.enable_button} to drive"
        sideways = not self.legged and self._axis(self._given.axis_lateral)
        return f"drives, but {NO_LATERAL}" if sideways else "drives"

    def _senders(self, now: float) -> list[str]:
        return [name for name, at in self._newest.items() if now - at <= self._given.joy_timeout]

    def _held(self) -> bool:
        return self._pressed(self._given.enable_button) or self._pressed(self._given.enable_turbo_button)

    def _pressed(self, number: int) -> bool:
        return 0 <= number < len(self._buttons) and self._buttons[number] == 1

    def _axis(self, number: int) -> float:
        value = self._axes[number] if 0 <= number < len(self._axes) else 0.0
        if not abs(value) <= 1.0:  # NaN too
            return 0.0
        zone = self._given.deadzone
        return 0.0 if abs(value) <= zone else (abs(value) - zone) / (1 - zone) * (1 if value > 0 else -1)
