"""The witness of tests/system detects that this machine, here the witness alone, stood still, and when."""

import os
import signal
import subprocess
import sys
import time

from system import stall_witness
from system.stall_witness import StallWitness

STOPPED = 2.0
"""s"""


def test_a_stop_of_the_witness_is_seen_where_it_was_and_nowhere_else():
    before = time.monotonic()
    witness = StallWitness(STOPPED)
    time.sleep(2 * STOPPED)  # it has begun
    begin = time.monotonic()
    witness.process.send_signal(signal.SIGSTOP)
    time.sleep(STOPPED)
    witness.process.send_signal(signal.SIGCONT)
    end = time.monotonic()
    while not witness.saw(begin, end):
        assert time.monotonic() < end + 20.0
        time.sleep(0.01)
    assert not witness.saw(before - 10.0, before)  # a machine with other work may stand still after that
    witness.process.kill()
    witness.process.wait()


def test_a_witness_whose_parent_ended_before_it_began_ends_too():
    """A test that is skipped ends in a millisecond; what keeps its output open keeps ctest waiting."""
    ended = subprocess.Popen(["true"])
    ended.wait()
    program = [sys.executable, stall_witness.__file__, str(ended.pid), "2.0", "0"]
    subprocess.run([*program, str(min(os.sched_getaffinity(0)))], check=True, timeout=10)
