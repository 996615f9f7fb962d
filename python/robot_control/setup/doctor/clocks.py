"""Checks of the clocks."""

import re

from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, unseen, warning
from robot_control.setup.doctor.remote_master import remote_host
from robot_control.setup.doctor.system import System

SLOW = {"hpet": 1, "acpi_pm": 2, "jiffies": 1}
"""A reading takes so many µs; the others take about 25 ns."""
SERVICES = ("chronyd", "ntpd", "systemd-timesyncd", "systemd-timesyn", "ptp4l", "phc2sys", "openntpd")


def source(system: System) -> Finding:
    """The kernel's clock source."""
    name = "sys/devices/system/clocksource/clocksource0/current_clocksource"
    current = system.seen(system.text(name), name)
    if current == "jiffies":
        return fault("jiffies: its resolution is a tick of 1 … 10 ms", "remove clocksource= from the boot arguments")
    if current in SLOW:
        offered = (system.text(name.replace("current", "available")) or "").split()
        better = next((each for each in offered if each not in SLOW), "")
        remedy = f"use {better}" if better else "check the log of the kernel: dmesg | grep -i clocksource"
        value = f"{current}: a reading takes microseconds"
        return warning(value, remedy, *([f"echo {better} | sudo tee /{name}"] if better else []))
    return ok(current)


def synchronised(system: System) -> Finding:
    """A service that keeps the clock; other machines compare their stamps with it."""
    remote = remote_host(system)
    names = {re.sub(r".*/", "", arguments[0]) for _, arguments in system.processes()}
    names |= {system.text(name) or "" for name in system.names("proc/[0-9]*/comm")}
    running = sorted(names & set(SERVICES))
    if system.path("run/systemd/timesync/synchronized").exists() or running:
        return ok("by " + (", ".join(running) or "systemd-timesyncd"))
    if remote:
        value = f"no service keeps the clock, and the master is on {remote}"
        return warning(value, "synchronise both machines", "sudo apt-get install chrony")
    if system.kind:
        return unseen(system.hidden("run/systemd/timesync"))
    return note("no service keeps the clock", "chrony, as soon as a second machine takes part")


CHECKS = (
    Check("clock_source", "each cycle reads the clock several times", source),
    Check("clock_synchronised", "commands with stamps of another machine are refused as late", synchronised),
)
