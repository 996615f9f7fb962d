"""When a process began. This one began when its work was requested, however late its first line runs."""

import os
import time
from pathlib import Path

START_TIME = 22
"""field of /proc/PID/stat (proc(5)): clock ticks after the start of the machine"""


def process_began(process: int | str = "self") -> float:
    """s, monotonic; the end of the tick of 0.01 s in which a process of this computer began. Raises OSError."""
    after_name = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()  # from the third field on
    ticks = int(after_name[START_TIME - 3]) + 1
    age = time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK")
    return time.monotonic() - age
