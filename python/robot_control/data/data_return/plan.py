"""Decides what is sent next, when, and what may be deleted. Pure: no clock, no file, no link."""

import fnmatch
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime

from robot_control.data.data_return.settings import HOURS, Settings
from robot_control.files.files import printable

KINDS = ("incidents", "reports", "runs")
"""in the order in which they are sent; also the folders on the far side"""
INCIDENT = re.compile(r"(stop|crash)\.\d+\.bag")
CURRENT = "run.bag"
PART_BYTES = 4 << 20
"""bytes of a file in one part: what a cut of the link costs at most"""
BATCH, LARGEST_BATCH = 4, 16
"""parts for one start of rclone, which costs a connection; they are in memory meanwhile"""
BATCH_TIME = 30.0
"""s at `bandwidth`: a start of rclone and the check of a batch, when nothing is sent, last about a second"""
FIRST_WAIT, LONGEST_WAIT = 2.0, 300.0
"""s before another try, doubled after each failure"""
GB = 1e9
"""bytes"""


@dataclass(frozen=True)
class Part:
    """A part that was verified on the far side."""

    name: str
    size: int
    sha256: str


@dataclass
class Entry:
    """A finished file."""

    key: str
    """`identity` of the file, so that telemetry may rename it"""
    path: str
    """below the folder of logs, now"""
    kind: str
    size: int
    mtime_ns: int
    target: str
    """folder on the far side, below the robot's"""
    parts: dict[int, Part] = field(default_factory=dict)
    """those verified, until the file is returned"""
    returned: bool = False
    """the remote had all parts of the file, and the manifest was read back"""

    @property
    def count(self) -> int:
        """Parts of the file; an empty file has one."""
        return max(1, -(-self.size // PART_BYTES))


def identity(status: os.stat_result) -> str:
    """Inode, size and time of a file, which a new name leaves as they are."""
    return f"{status.st_ino}-{status.st_size}-{status.st_mtime_ns}"


def kind_of(name: str) -> str | None:
    """The kind of a file by its name; None: it does not return."""
    if INCIDENT.fullmatch(name):
        return "incidents"
    if name.startswith("."):  # a file that is being written
        return None
    return {"bag": "runs", "html": "reports"}.get(name.rpartition(".")[2])


def next_entry(entries: Iterable[Entry]) -> Entry | None:
    """Incidents, reports, runs; of a kind what was begun, then the oldest, which telemetry deletes first."""
    waiting = (each for each in entries if not each.returned)
    return min(waiting, default=None, key=lambda e: (KINDS.index(e.kind), not e.parts, e.mtime_ns, e.key))


def next_parts(entry: Entry, bandwidth: float) -> list[int]:
    """Numbers of the parts that are sent together at MB/s, 0 without a limit; none: the manifest is due."""
    size = min(LARGEST_BATCH, max(BATCH, int(BATCH_TIME * 1e6 * bandwidth / PART_BYTES)))
    return [number for number in range(entry.count) if number not in entry.parts][:size]


def deletable(entries: Sequence[Entry], quota: float) -> list[Entry]:
    """The oldest returned files without which all are within the quota [GB]; 0: none.

    run.bag stays: telemetry gives this name to another file whenever it begins.
    """
    excess = sum(each.size for each in entries) - quota * GB
    chosen = []
    for each in sorted(entries, key=lambda e: (e.mtime_ns, e.key)) if quota else ():
        if each.returned and excess > 0 and each.path.rpartition("/")[2] != CURRENT:
            chosen.append(each)
            excess -= each.size
    return chosen


def reason_to_wait(settings: Settings, now: datetime, mode: str = "", interfaces: Sequence[str] = ()) -> str:
    """Why nothing is sent now; empty: nothing stands against it.

    Args:
        settings: those of this robot
        now: local time
        mode: of robot_status; empty while it is silent
        interfaces: of the default routes
    """
    if settings.hours and not any(_within(each, now) for each in settings.hours):
        return f"outside of hours ({', '.join(settings.hours)})"
    if settings.only_at_rest and mode in ("", "manual", "automatic"):
        return f"only at rest, and the robot is commanded ({mode})" if mode else "robot_status is silent"
    for name in () if settings.metered else interfaces:
        if any(fnmatch.fnmatch(name, each) for each in settings.metered_interfaces):
            return f"the link {name} is metered"
    return ""


def _within(hours: str, now: datetime) -> bool:
    found = HOURS.fullmatch(hours)
    assert found  # noqa: S101 (settings.py refuses others)
    first, first_minute, last, last_minute = map(int, found.groups())
    begin, end, at = 60 * first + first_minute, 60 * last + last_minute, 60 * now.hour + now.minute
    return begin <= at < end if begin <= end else at >= begin or at < end


def wait_after(failures: int) -> float:
    """s until the next try."""
    return float(min(LONGEST_WAIT, FIRST_WAIT * 2 ** min(failures - 1, 10)))


def progress(entries: Sequence[Entry], why: str) -> str:
    """One line; `why` nothing is sent."""
    waiting = [each for each in entries if not each.returned]
    if not waiting:
        return f"all {len(entries)} files are on the far side"
    left = sum(max(0, each.size - len(each.parts) * PART_BYTES) for each in waiting)
    now = next_entry(waiting)
    sending = f"waits: {why}" if why or now is None else f"{printable(now.path)} {100 * len(now.parts) // now.count} %"
    return f"{sending}; to go: {len(waiting)} files, {left / 1e6:.1f} MB"
