"""The machine as the checks see it: files below a root, the environment, outputs of programs, parameters of the robot.

A root other than / is a folder recorded from a machine. Its environment is the file proc/self/environ in it. The
output of a program is the file commands/PROGRAM_ARGUMENTS…, with `_` for blanks and slashes.
"""

import os
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

T = TypeVar("T")

PROGRAM_TIMEOUT = 1.0
"""s, for the answer of a program; the whole report may take 3 s"""
DEFAULTS: Mapping[str, Any] = {"core": 0, "realtime": "preferred", "driver": "mujoco", "rate": 1000}
"""Keys of the block `robot:` that are not in the file, or if it cannot be read."""
MAX_CORES = 4096
CAP_IPC_LOCK, CAP_SYS_NICE = 14, 23
"""Bits of CapEff, capabilities(7)"""


class HiddenError(Exception):
    """A property that this machine does not show; the message says so."""


@dataclass(frozen=True, eq=False)
class System:
    """One machine, live or recorded."""

    root: Path = Path("/")
    robot: Mapping[str, Any] = field(default_factory=lambda: DEFAULTS)
    """The block `robot:` of the parameters; `drive_file` in it is the tree of the drive file."""

    @property
    def live(self) -> bool:
        """True for the machine on which this program runs."""
        return self.root == Path("/")

    @cached_property
    def environment(self) -> Mapping[str, str]:
        """The environment of this terminal."""
        if self.live:
            return os.environ
        entries = (self.text("proc/self/environ") or "").split("\0")
        return dict(entry.split("=", 1) for entry in entries if "=" in entry)

    def path(self, name: str) -> Path:
        """A file of the machine; `name` may begin with a slash."""
        return self.root / name.lstrip("/")

    def text(self, name: str) -> str | None:
        """The text of a file without blanks at its ends; None if it cannot be read."""
        try:
            if not self.path(name).is_file():  # reading a FIFO would wait
                return None
            return self.path(name).read_text(errors="replace").strip()
        except (OSError, ValueError):
            return None

    def number(self, name: str) -> int | None:
        """The first integer of a file; None if there is none."""
        found = re.match(r"-?\d+", self.text(name) or "")
        return int(found[0]) if found else None

    def names(self, pattern: str) -> list[str]:
        """The files that match, absolute within the machine and sorted."""
        try:
            return sorted(f"/{path.relative_to(self.root)}" for path in self.root.glob(pattern.lstrip("/")))
        except OSError:
            return []

    def run(self, *command: str) -> str | None:
        """The output of a program; None if it is missing, fails or does not answer."""
        if not self.live:
            return self.text("commands/" + "_".join(command).replace("/", "_"))
        if shutil.which(command[0], path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin") is None:
            return None
        searched = {**os.environ, "PATH": f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin", "LC_ALL": "C"}
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=PROGRAM_TIMEOUT, check=False, env=searched
            )
        except (OSError, subprocess.TimeoutExpired):
            return None
        return done.stdout.strip() if done.returncode == 0 else None

    @cached_property
    def kind(self) -> str:
        """The words for what hides properties of the hardware; "" on a bare machine."""
        if self.in_container:
            return "this container"
        hypervisor = re.search(r"^flags\s*:.*\bhypervisor\b", self.text("proc/cpuinfo") or "", re.MULTILINE)
        return "this virtual machine" if hypervisor or self.text("sys/hypervisor/type") else ""

    @cached_property
    def in_container(self) -> bool:
        """True in a container of Docker, Podman or systemd."""
        marks = (".dockerenv", "run/.containerenv", "run/systemd/container")
        return any(self.path(mark).exists() for mark in marks)

    def hidden(self, name: str) -> str:
        """The value of a property whose file is absent."""
        return f"not visible in {self.kind}" if self.kind else f"not visible: /{name.lstrip('/')} is absent"

    def seen(self, value: T | None, name: str) -> T:
        """The value, of the file `name`. Raises HiddenError where there is none."""
        if value is None:
            raise HiddenError(self.hidden(name))
        return value

    @property
    def core(self) -> int | None:
        """The core on which the loop runs; None: any."""
        core = self.robot.get("core", 0)
        if isinstance(core, bool) or not isinstance(core, int):
            raise ValueError(f"robot.core is {core!r}, not the number of a core: the nodes refuse it")
        return core if core >= 0 else None

    def status(self, key: str) -> str:
        """A line of /proc/self/status, such as CapEff; "" if it is absent."""
        found = re.search(rf"^{key}:\s*(.*)$", self.text("proc/self/status") or "", re.MULTILINE)
        return found[1].strip() if found else ""

    def may(self, capability: int) -> bool:
        """True if this terminal has the capability."""
        mask = self.status("CapEff")
        return bool(mask and int(mask, 16) >> capability & 1)

    def limit(self, name: str) -> float | None:
        """A soft limit of /proc/self/limits, raised as far as the hard limit allows; infinite if unlimited."""
        found = re.search(rf"^{name}\s+(\S+)\s+(\S+)", self.text("proc/self/limits") or "", re.MULTILINE)
        if found is None:
            return None
        return float("inf") if "unlimited" in found.groups() else float(max(int(found[1]), int(found[2])))

    def processes(self) -> Iterator[tuple[int, list[str]]]:
        """Number and arguments of every process that shows them; kernel threads have none."""
        for name in self.names("proc/[0-9]*/cmdline"):
            arguments = (self.text(name) or "").split("\0")
            if arguments[0]:
                yield int(name.split("/")[2]), arguments

    @cached_property
    def uptime(self) -> float | None:
        """s since the start of the computer."""
        found = re.match(r"[\d.]+", self.text("proc/uptime") or "")
        return float(found[0]) if found else None


def cores_of(text: str | None) -> set[int]:
    """The cores of a list of the kernel, such as 0-3,8."""
    cores: set[int] = set()  # at most MAX_CORES
    for part in (text or "").split(","):
        if found := re.fullmatch(r"\s*(\d+)(?:-(\d+))?\s*", part):
            cores |= set(range(int(found[1]), min(int(found[2] or found[1]) + 1, MAX_CORES)))
    return cores
