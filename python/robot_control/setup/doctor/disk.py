"""Checks of the disk, of quotas, and of shared memory that was left behind."""

import os
import shlex
from pathlib import Path

from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, unseen, warning
from robot_control.setup.doctor.programs import NODES
from robot_control.setup.doctor.system import System

LITTLE, TOO_LITTLE = 2e9, 100e6
"""bytes: a log takes 0.6 MB/s (docs/log.md), so 2 GB are an hour"""
SHARED_NEEDED = 32e6
"""bytes: the channels of one robot take 14 MB"""
SHARED_LEFT = 64e6
"""bytes: the channels of four robots"""


def _log_folder(system: System) -> str:
    home = system.environment.get("HOME", "/root")
    return system.environment.get("ROS_HOME") or f"{home}/.ros"


def _free(system: System, folder: str) -> float | None:
    """Free bytes of the file system of the folder, or of the next one above that is there."""
    path = Path(folder)
    while not system.path(str(path)).exists() and path != path.parent:
        path = path.parent
    lines = (system.run("df", "-Pk", str(path)) or "").splitlines()
    try:
        return 1024.0 * int(lines[1].split()[3])
    except (IndexError, ValueError):
        return None


def log_space(system: System) -> Finding:
    """Free space where telemetry writes by default."""
    folder = _log_folder(system)
    free = _free(system, folder)
    if free is None:
        return unseen(f"df does not answer for {folder}")
    value = f"{free / 1e9:.1f} GB free for {folder}"
    if free < TOO_LITTLE:
        return fault(value, "remove logs (rosclean purge), or choose another folder: out:=DIR", "rosclean purge")
    if free < LITTLE:
        return warning(value, "remove logs (rosclean purge), or choose another folder: out:=DIR", "rosclean purge")
    return ok(value)


def log_rights(system: System) -> Finding:
    """The folder of the logs must be the user's."""
    folder = _log_folder(system)
    if not system.live:
        return unseen("not visible in a recorded folder")
    if Path(folder).exists() and not os.access(folder, os.W_OK | os.X_OK):
        command = f'sudo chown -R "$USER" {shlex.quote(folder)}'
        return fault(f"{folder} is not writable", "correct its owner, or set ROS_HOME", command)
    return ok(folder)


def quota(system: System) -> Finding:
    """The quotas of this user; the program `quota` marks those that are exceeded by an asterisk."""
    listed = system.run("quota", "-w")
    if not listed:
        return ok("none is in force, or quota is not installed")
    over = [line.split()[0] for line in listed.splitlines() if len(line.split()) > 1 and "*" in line]
    if over:
        return fault(f"exceeded on {', '.join(over)}", "remove files, or ask for a larger quota")
    return ok("not exceeded")


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:  # its robot has just ended
        return 0


def shared_memory(system: System) -> Finding:
    """Shared memory of robots, and the space that is left for it."""
    if not system.path("dev/shm").is_dir():
        remedy = "mount a tmpfs there: without it no node starts"
        return fault("/dev/shm is absent", remedy, "sudo mount -t tmpfs tmpfs /dev/shm")
    size = sum(map(_size, map(system.path, system.names("dev/shm/robot_control.*"))))
    running = any(Path(arguments[0]).name in NODES for _, arguments in system.processes())
    free = _free(system, "/dev/shm")
    value = f"{size / 1e6:.0f} MB of robots" + ("" if free is None else f", {free / 1e6:.0f} MB free")
    if free is not None and free < SHARED_NEEDED:
        remedy = "remove old files, or enlarge it (docker run --shm-size=256m)"
        return fault(value, remedy, "sudo mount -o remount,size=256m /dev/shm")
    if size > SHARED_LEFT and not running:
        return warning(f"{value}, and no node runs", "remove what is left behind", "rm /dev/shm/robot_control.*")
    if size > SHARED_LEFT:
        return note(value, "when no node runs: rm /dev/shm/robot_control.*")
    return ok(value)


CHECKS = (
    Check("log_space", "a full disk ends the log", log_space),
    Check("log_rights", "telemetry writes there as this user", log_rights),
    Check("quota", "a quota ends the log although the disk is not full", quota),
    Check("shared_memory", "the channels of the loop lie there", shared_memory),
)
