"""When this process began: that is when what it is started for was requested, however late its first line runs."""

import os
import time
from pathlib import Path

START_TIME = 22
"""field of /proc/PID/stat (proc(5)): clock ticks after the start of the machine"""


def process_began() -> float:
    """s, monotonic; the end of the tick of 0.01 s in which it began."""
    after_name = Path("/proc/self/stat").read_text().rpartition(")")[2].split()  # from the third field on
    ticks = int(after_name[START_TIME - 3]) + 1
    age = time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK")
    return time.monotonic() - age
