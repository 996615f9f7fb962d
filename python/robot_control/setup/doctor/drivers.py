"""Checks of the interfaces to motor drives: CAN, serial ports, USB."""

import json
import stat
from typing import Any

from robot_control.setup.doctor.finding import Check, Finding, Verdict, fault, note, ok, warning
from robot_control.setup.doctor.processor import writable
from robot_control.setup.doctor.system import System

ARPHRD_CAN = 280
MIN_QUEUE = 32
"""Frames: two cycles of eight drives with two frames each; the kernel's default is 10"""
ERROR_WARNING = 96
"""Error counter from which a CAN controller is called unreliable (ISO 11898-1)"""
MAX_LATENCY = 1
"""ms, of a serial adapter; its default is 16"""


def _can_interfaces(system: System) -> list[str]:
    names = system.names("sys/class/net/*/type")
    return [name.split("/")[4] for name in names if system.number(name) == ARPHRD_CAN]


def _link(system: System, interface: str) -> dict[str, Any]:
    """The description that `ip` prints; empty if there is none."""
    try:
        found = json.loads(system.run("ip", "-details", "-json", "link", "show", interface) or "[]")
    except ValueError:
        return {}
    return found[0] if found and isinstance(found[0], dict) else {}


def _start(interface: str) -> str:
    return f"sudo ip link set {interface} up type can bitrate 1000000 restart-ms 100"


def _bus_problem(interface: str, data: dict[str, Any]) -> Finding | None:
    """The state of the bus by its controller: ISO 11898-1."""
    state, counters = data.get("state", ""), data.get("berr_counter", {})
    again = f"sudo ip link set {interface} down && {_start(interface)}"
    if state == "BUS-OFF":
        return fault(f"{interface} is bus-off", "check bit rate, cable and terminators (60 Ω in all)", again)
    worst = max((counters.get(side, 0) for side in ("tx", "rx")), default=0)
    if state in ("ERROR-WARNING", "ERROR-PASSIVE") or worst >= ERROR_WARNING:
        value = f"{interface}: {state}, error counters tx {counters.get('tx', 0)}, rx {counters.get('rx', 0)}"
        return warning(value, "check bit rate, cable and terminators (60 Ω in all)")
    if not data.get("restart_ms"):
        return warning(f"{interface}: restart-ms 0, so it stays off after bus-off", "set restart-ms", again)
    return None


def _can_problem(system: System, interface: str) -> Finding | None:
    link = _link(system, interface)
    up = "UP" in link.get("flags", []) if link else system.text(f"sys/class/net/{interface}/operstate") == "up"
    if not up:
        return fault(f"{interface} is down", "start it with the bit rate of the drives", _start(interface))
    details = link.get("linkinfo", {})
    if details.get("info_kind") == "can" and (found := _bus_problem(interface, details.get("info_data", {}))):
        return found
    queue = system.number(f"sys/class/net/{interface}/tx_queue_len")
    if details.get("info_kind") == "can" and queue is not None and queue < MIN_QUEUE:
        command = f"sudo ip link set {interface} txqueuelen 128"
        return warning(f"{interface}: a queue of {queue} frames", "lengthen it", command)
    return None


def _drive_blocks(system: System) -> dict[str, dict[str, Any]]:
    """The blocks of the drive file; none without a file."""
    tree = system.robot.get("drive_file")
    return {key: block for key, block in tree.items() if isinstance(block, dict)} if isinstance(tree, dict) else {}


def _bus(system: System) -> tuple[str, int]:
    """Address and bit rate of the drive file; empty and 0 if they are unknown or the driver does not use CAN."""
    bus = _drive_blocks(system).get("bus")
    if system.robot.get("driver") != "can" or bus is None:
        return "", 0
    rate = bus.get("bit_rate")
    return str(bus.get("address") or ""), rate if isinstance(rate, int) else 0


def can(system: System) -> Finding:
    """The CAN interface of the drive file; without one, every interface that is there."""
    interfaces, (address, wanted) = _can_interfaces(system), _bus(system)
    used = system.robot.get("driver") == "can"
    if address.startswith("unix:"):
        return ok(f"{address}: simulated drives")
    if used and (not interfaces or (address and address not in interfaces)):
        value = f"{address or 'a CAN interface'} is absent, and robot.driver is can"
        return fault(value, "connect the adapter, or load its module")
    if not interfaces:
        return ok("none, and none is used")
    shown = [address] if address else interfaces
    problems = [found for interface in shown if (found := _can_problem(system, interface))]
    rates = {
        interface: _link(system, interface).get("linkinfo", {}).get("info_data", {}).get("bittiming", {}).get("bitrate")
        for interface in shown
    }
    if address and wanted and rates[address] not in (None, wanted):
        again = f"sudo ip link set {address} down && {_start(address).replace('1000000', str(wanted))}"
        value = f"{address} has {rates[address]} bit/s, the drive file {wanted}"
        problems.append(fault(value, "start it with the bit rate of the drives", again))
    if not problems:
        return ok(", ".join(f"{interface} {rate} bit/s" if rate else interface for interface, rate in rates.items()))
    worst = next((each for each in problems if each.verdict is Verdict.FAULT), problems[0])
    return worst if used else ok(f"{worst.value}; not used (robot.driver: {system.robot.get('driver')})")


def _not_ready(system: System, value: str, remedy: str, *commands: str) -> Finding:
    """The simulation uses no adapter, so one that is not ready is no more than a note."""
    simulated = system.robot.get("driver", "mujoco") == "mujoco"
    return (note if simulated else warning)(value, remedy, *commands)


def silence(system: System) -> Finding:
    """The reaction of the drives to missing orders, as the drive file states it: no driver runs yet that could read it.

    A drive whose watchdog the driver sets or reads needs no statement.
    """
    blocks = _drive_blocks(system)
    if (path := system.robot.get("drives")) and not blocks:
        return warning(f"the drive file {path} cannot be read", "set robot.drives to a drive file")
    of_all = blocks.pop("every_joint", {})
    joints = [of_all | block for name, block in blocks.items() if name != "bus"] or [of_all]
    stated = {str(joint["on_silence"]) for joint in joints if "on_silence" in joint}
    accepted = any(joint.get("accept_unknown_watchdog") and "on_silence" not in joint for joint in joints)
    if "keeps" in stated:
        value = "the motors keep their last order for ever when this computer is silent"
        return note(value, "use an emergency stop that cuts the supply of the motors")
    if "unknown" in stated or accepted:
        value = "what the drives do when this computer is silent is unknown to the drive file"
        return note(value, "find it out with the robot on a stand, and state it as on_silence")
    unstated = "no drive file states a reaction: a driver that can neither set nor read it refuses to start"
    return ok(f"the drive file states: {', '.join(sorted(stated))}" if stated else unstated)


def serial_latency(system: System) -> Finding:
    """The latency timer of USB serial adapters (FTDI)."""
    names = system.names("sys/bus/usb-serial/devices/*/latency_timer")
    slow = [(name, value) for name in names if (value := system.number(name) or 0) > MAX_LATENCY]
    if not names:
        return ok("no serial adapter has one")
    if not slow:
        return ok(f"{MAX_LATENCY} ms")
    return _not_ready(
        system,
        ", ".join(f"{name.split('/')[5]} {value} ms" for name, value in slow),
        "shorten it, for good by a udev rule with ATTR{latency_timer}",
        *(f"echo {MAX_LATENCY} | sudo tee {name}" for name, _ in slow),
    )


def _usb_device(system: System, name: str) -> str:
    """The USB device (1-2) behind a device of another class; "" if there is none."""
    try:
        path = system.path(name).resolve()
    except OSError:
        return ""
    for parent in (path, *path.parents):
        if (parent / "power/control").exists() and (parent / "idVendor").exists():
            return "/" + str(parent.relative_to(system.root.resolve()))
    return ""


def autosuspend(system: System) -> Finding:
    """The power control of USB devices with a serial port or a CAN interface."""
    ends = [*system.names("sys/class/tty/tty[UA]*/device"), *system.names("sys/class/net/can*/device")]
    devices = sorted({device for name in ends if (device := _usb_device(system, name))})
    asleep = [device for device in devices if system.text(f"{device}/power/control") == "auto"]
    if not asleep:
        return ok("no USB adapter is suspended" if devices else "no USB adapter with a serial port or CAN")
    return _not_ready(
        system,
        "may be suspended: " + ", ".join(device.rsplit("/", 1)[1] for device in asleep),
        "keep it awake, for good by a udev rule with ATTR{power/control}",
        *(f"echo on | sudo tee {device}/power/control" for device in asleep),
    )


def device_files(system: System) -> Finding:
    """The rights of the user of this terminal to serial ports."""
    ports = system.names("dev/ttyUSB[0-9]*") + system.names("dev/ttyACM[0-9]*")
    system.seen(system.status("Uid") or None, "proc/self/status")
    closed = [port for port in ports if not writable(system, port)]
    if not closed:
        return ok(", ".join(ports) or "no serial port")
    mode = stat.filemode(system.path(closed[0]).stat().st_mode)
    return _not_ready(
        system,
        f"{closed[0]} is not yours ({mode})",
        "join its group, then log in again",
        'sudo usermod -aG dialout "$USER"',
    )


CHECKS = (
    Check("can", "commands and samples of the drives go over this bus", can),
    Check("silence", "a program that ends leaves the drives to their own reaction", silence),
    Check("serial_latency", "an adapter holds received bytes back for so long", serial_latency),
    Check("usb_autosuspend", "a suspended adapter needs milliseconds to wake up", autosuspend),
    Check("device_files", "the driver opens its port as this user", device_files),
)
