"""Checks of the privileges and limits of this terminal, and of memory."""

import re

from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, warning
from robot_control.setup.doctor.system import CAP_IPC_LOCK, CAP_SYS_NICE, System

MAX_PRIORITY = 83
"""The driver's; LoopPriority of loop/processes/process.h"""
MIN_FILES, ENOUGH_FILES = 64, 1024
"""A node refuses to start below the first one (rt/process_limits.h)."""
MIN_MEMORY = 400e6
"""bytes: nodes, telemetry and its black box take less than 200 MiB in all; as much again for the rest"""
GRANT = (
    "in the checkout: scripts/privileges install, then log in again; "
    "in a container: docker run --cap-add=SYS_NICE --cap-add=IPC_LOCK"
)
INSTALL = "sudo scripts/privileges install  # in the checkout of robot_control"


def _user_has_line(system: System, item: str) -> str:
    """The file in /etc/security/limits.d with a line on `item`; "" if there is none."""
    for name in ["/etc/security/limits.conf", *system.names("etc/security/limits.d/*.conf")]:
        lines = (system.text(name) or "").splitlines()
        if any(re.match(rf"\s*[^#\s]\S*\s+\S+\s+{item}\s", line + " ") for line in lines):
            return name
    return ""


def _refused(system: System, value: str, item: str) -> Finding:
    """A privilege that this terminal lacks: a fault only if the parameters require it."""
    if system.robot.get("realtime") in ("off", False):
        return ok(f"{value}; not requested (robot.realtime: off)")
    if system.robot.get("realtime") == "required":
        return fault(f"{value}, and robot.realtime is required: the nodes refuse to start", GRANT, INSTALL)
    if not system.in_container and (name := _user_has_line(system, item)):
        return warning(f"{value}, although {name} grants it", "log in again; check that the user in that file is yours")
    return note(value, GRANT, INSTALL)


def priority(system: System) -> Finding:
    """SCHED_FIFO needs RLIMIT_RTPRIO or CAP_SYS_NICE."""
    if system.may(CAP_SYS_NICE):
        return ok("CAP_SYS_NICE")
    limit = system.seen(system.limit("Max realtime priority"), "proc/self/limits")
    if limit >= MAX_PRIORITY:
        return ok(f"limit {limit:.0f}")
    if limit > 0:
        return warning(f"limit {limit:.0f}, below {MAX_PRIORITY}: the driver does not get its priority", GRANT, INSTALL)
    return _refused(system, "SCHED_FIFO is not granted", "rtprio")


def memory_lock(system: System) -> Finding:
    """Locked memory needs an unlimited RLIMIT_MEMLOCK or CAP_IPC_LOCK; a finite limit would end later mappings."""
    if system.may(CAP_IPC_LOCK):
        return ok("CAP_IPC_LOCK")
    limit = system.seen(system.limit("Max locked memory"), "proc/self/limits")
    if limit == float("inf"):
        return ok("unlimited")
    return _refused(system, f"limit {limit / 1024:.0f} KiB", "memlock")


def open_files(system: System) -> Finding:
    """Every peer of a topic takes a descriptor."""
    limit = system.seen(system.limit("Max open files"), "proc/self/limits")
    if limit < MIN_FILES:
        return fault(f"{limit:.0f}: the nodes refuse to start", "raise the limit", "ulimit -n 1024")
    if limit < ENOUGH_FILES:
        return warning(f"{limit:.0f}: connections are refused beyond", "raise the limit", "ulimit -n 1024")
    return ok(f"{limit:.0f}" if limit < float("inf") else "unlimited")


def file_size(system: System) -> Finding:
    """A log that reaches the limit ends there."""
    limit = system.seen(system.limit("Max file size"), "proc/self/limits")
    if limit == float("inf"):
        return ok("unlimited")
    return warning(f"{limit / 1e6:.0f} MB: logs end there", "remove the limit", "ulimit -f unlimited")


def _meminfo(system: System, key: str) -> float:
    found = re.search(rf"^{key}:\s+(\d+) kB", system.text("proc/meminfo") or "", re.MULTILINE)
    return 1024.0 * int(system.seen(found, "proc/meminfo")[1])


def free_memory(system: System) -> Finding:
    """Free memory of the machine, and of the control group of a container."""
    free = _meminfo(system, "MemAvailable")
    limit, used = (system.number(f"sys/fs/cgroup/memory.{name}") for name in ("max", "current"))
    if limit is not None and used is not None:
        free = min(free, limit - used)
    value = f"{free / 1e6:.0f} MB free"
    if free < MIN_MEMORY:
        return warning(value, "stop other programs, or set a larger memory limit of the container")
    return ok(value)


def swap(system: System) -> Finding:
    """A page that was swapped out is a page fault of milliseconds, unless the memory is locked."""
    total, free, all_memory = (_meminfo(system, key) for key in ("SwapTotal", "SwapFree", "MemTotal"))
    used = total - free
    if total == 0:
        return ok("none")
    value = f"{used / 1e6:.0f} of {total / 1e6:.0f} MB used"
    if system.may(CAP_IPC_LOCK) or system.limit("Max locked memory") == float("inf"):
        return ok(f"{value}; the nodes lock their memory")
    if used > 0.1 * all_memory:
        return warning(value, "let the nodes lock their memory, or switch swap off", INSTALL, "sudo swapoff -a")
    return ok(value)


CHECKS = (
    Check("realtime_priority", "without SCHED_FIFO every other program delays the loop", priority),
    Check("memory_lock", "a page fault delays a cycle by microseconds to milliseconds", memory_lock),
    Check("open_files", "each connection of a node takes a descriptor", open_files),
    Check("file_size", "a log cannot grow beyond this limit", file_size),
    Check("free_memory", "nodes that lack memory are ended by the kernel", free_memory),
    Check("swap", "a page on the disk is read while the loop waits", swap),
)
