"""Checks of interrupts and timers."""

import re

from robot_control.setup.doctor.finding import Check, Finding, note, ok, warning
from robot_control.setup.doctor.system import CAP_SYS_NICE, System, cores_of

MAX_RATE = 10_000
"""Interrupts of devices per second: ten per cycle at 1 kHz"""
MIN_RATE = 1.0
"""Interrupts of one device per second on an isolated core; those of the start of the machine do not matter"""
MAX_SLACK = 100_000
"""ns; 50,000 is the kernel's own"""


def _devices(system: System) -> dict[str, tuple[list[int], str]]:
    """Number of an interrupt → counts per core, and its device; those of the processor itself have letters."""
    lines = (system.text("proc/interrupts") or "").splitlines()
    cores = [int(name[3:]) for name in lines[0].split() if name[3:].isdigit()] if lines else []
    found = {}
    for line in lines[1:]:
        number, _, rest = line.strip().partition(":")
        fields = rest.split()
        if number.isdigit() and len(fields) > len(cores):
            counts = [0] * (max(cores, default=0) + 1)
            for core, text in zip(cores, fields, strict=False):
                counts[core] = int(text)
            found[number] = counts, fields[-1]
    return found


def steering(system: System) -> Finding:
    """Interrupts of devices on the loop's core, if it is isolated."""
    core = system.core
    devices = system.seen(_devices(system) or None, "proc/interrupts")
    if core is None:
        return ok("robot.core is -1: not pinned")
    some = MIN_RATE * (system.uptime or 0.0)
    here = []
    for number, (counts, device) in devices.items():
        effective = system.text(f"proc/irq/{number}/effective_affinity_list")
        if core in cores_of(effective) and core < len(counts) and counts[core] > some:
            here.append((number, device))
    if core in cores_of(system.text("sys/devices/system/cpu/isolated")) and here:
        others = sorted(set(range(len(next(iter(devices.values()))[0]))) - {core})
        listed = ",".join(map(str, others))
        return warning(
            "on the isolated core: " + ", ".join(f"{number} {device}" for number, device in here[:4]),
            "steer them to other cores; at the start of the machine by irqaffinity= and isolcpus=managed_irq,domain,N",
            *(f"echo {listed} | sudo tee /proc/irq/{number}/smp_affinity_list" for number, _ in here),
        )
    total = sum(counts[core] for counts, _ in devices.values() if core < len(counts))
    rate = total / system.uptime if system.uptime else 0.0
    value = f"{rate:.0f}/s from devices on core {core} since the start of the computer"
    if rate > MAX_RATE:
        return warning(value, "steer them to other cores, or set robot.core to another one (docs/realtime.md)")
    return ok(value)


def storm(system: System) -> Finding:
    """The kernel counts interrupts that no driver handled; it switches such a line off in the end."""
    for name in system.names("proc/irq/[0-9]*/spurious"):
        found = re.search(r"unhandled (\d+)", system.text(name) or "")
        if found and int(found[1]) > 1000:
            number = name.split("/")[3]
            return warning(f"{found[1]} unhandled of interrupt {number}", "find its device in /proc/interrupts")
    return ok("no unhandled ones")


def slack(system: System) -> Finding:
    """A thread without real-time priority may be woken later by this time."""
    value = system.seen(system.number("proc/self/timerslack_ns"), "proc/self/timerslack_ns")
    if value <= MAX_SLACK:
        return ok(f"{value / 1000:.0f} µs")
    if system.may(CAP_SYS_NICE) or (system.limit("Max realtime priority") or 0) > 0:
        return note(f"{value / 1000:.0f} µs", "TimerSlackNSec=50000 in the service; real-time threads have none")
    return warning(f"{value / 1000:.0f} µs", "TimerSlackNSec=50000 in the service, or grant SCHED_FIFO")


CHECKS = (
    Check("interrupts", "an interrupt on the loop's core delays the loop whatever its priority", steering),
    Check("unhandled_interrupts", "a line without a driver interrupts again and again", storm),
    Check("timer_slack", "the wake-up of an ordinary thread may be delayed by so much", slack),
)
