"""A game pad of this machine, by Linux's event devices (python3-evdev, an optional package).

Axes and buttons are numbered as the kernel's joystick interface numbers them, in the order of their codes. Numbers
found with another joystick tool therefore fit. Forward and left are positive, as in ROS's joy.
"""

from typing import Any

EV_KEY, EV_ABS = 1, 3
"""linux/input-event-codes.h"""
FIRST_BUTTON = 0x120
"""BTN_JOYSTICK; codes below are those of keyboards and mice"""
GAMEPAD = 0x130
"""BTN_GAMEPAD"""
LAST_AXIS = 0x28
"""ABS_MISC; codes from here on are no axes"""
PACKAGE = "python3-evdev"


class Device:
    """The device is read as a whole at every call, so no event is missed and a lost device raises an error."""

    def __init__(self, device: Any) -> None:
        self._device = device
        able = device.capabilities()
        self._axes = sorted(code for code, _ in able.get(EV_ABS, []) if code < LAST_AXIS)
        self._buttons = sorted(code for code in able.get(EV_KEY, []) if code >= FIRST_BUTTON)

    @property
    def name(self) -> str:
        """The name that its maker gave it."""
        return str(self._device.name)

    def read(self) -> tuple[tuple[float, ...], tuple[int, ...]]:
        """Axes, −1 … 1, and buttons, 0 or 1. Raises OSError: it is gone."""
        held = set(self._device.active_keys())
        axes = tuple(_share(self._device.absinfo(code)) for code in self._axes)
        return axes, tuple(int(code in held) for code in self._buttons)


def _share(info: Any) -> float:
    """The share of an axis. The kernel counts right and down positive, joy left and up."""
    span = info.max - info.min
    return 0.0 if span <= 0 else -(2.0 * (info.value - info.min) / span - 1.0)


def is_pad(device: Any) -> bool:
    """True if it has the buttons of a game pad, or two axes and a joystick's button."""
    able = device.capabilities()
    buttons = set(able.get(EV_KEY, []))
    axes = {code for code, _ in able.get(EV_ABS, [])}
    return GAMEPAD in buttons or ({0, 1} <= axes and FIRST_BUTTON in buttons)


def open_device(path: str | None) -> Device | None:
    """The pad at `path`, or the first one; None if there is none now.

    Raises:
        ModuleNotFoundError: the package is not installed.
    """
    import evdev

    for candidate in [path] if path else sorted(evdev.list_devices()):
        try:
            device = evdev.InputDevice(candidate)
        except OSError:
            continue
        if path or is_pad(device):
            return Device(device)
    return None
