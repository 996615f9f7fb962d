"""The witness of tests/system detects that this machine, here the witness alone, stood still, and when."""

import signal
import time

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
