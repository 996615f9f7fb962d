"""Our requests to a RoboClaw, and the simulated one, against the maker's own library (PyPI basicmicro)."""

import contextlib
import subprocess
import time
from pathlib import Path

import pytest
from support.pypi_package import imported

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/robot_control/tests/drivers/roboclaw_peer"
ADDRESS = 0x80
QPPS = 1.2 * 30 * 1000 / (2 * 3.141592653589793)
"""counts per s, of roboclaw_peer.cpp"""


@pytest.fixture
def library():
    return imported("basicmicro", "serial")


class Listener:
    """A port that keeps what is written and acknowledges each byte."""

    is_open = True

    def __init__(self):
        self.written = b""

    def write(self, data):
        self.written += bytes(data)
        return len(data)

    def read(self, count):
        return b"\xff" * count

    def flushInput(self):  # noqa: N802 (pyserial's name)
        pass


REQUESTS = {
    14: lambda master: master.SetTimeout(ADDRESS, 0.1),
    15: lambda master: master.GetTimeout(ADDRESS),
    21: lambda master: master.ReadVersion(ADDRESS),
    24: lambda master: master.ReadMainBatteryVoltage(ADDRESS),
    34: lambda master: master.DutyM1M2(ADDRESS, 0, 0),
    37: lambda master: master.SpeedM1M2(ADDRESS, 1000, -2000),
    55: lambda master: master.ReadM1VelocityPID(ADDRESS),
    56: lambda master: master.ReadM2VelocityPID(ADDRESS),
    78: lambda master: master.GetEncoders(ADDRESS),
    82: lambda master: master.ReadTemp(ADDRESS),
    90: lambda master: master.ReadError(ADDRESS),
}


def test_our_requests_are_the_bytes_of_the_makers_library(library):
    lines = subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout.splitlines()
    ours = {int(number): bytes.fromhex(data) for number, data in (line.split() for line in lines)}
    assert sorted(ours) == sorted(REQUESTS)
    for number, request in REQUESTS.items():
        master = library.Basicmicro("none", 38400, retries=1)
        master._port, master._connected = Listener(), True  # the library opens ttys alone
        with contextlib.suppress(library.exceptions.PacketTimeoutError):  # nothing answers a request that reads
            request(master)
        assert master._port.written == ours[number], number


def speeds_of(board):
    board.stdin.write("\n")
    board.stdin.flush()
    return [float(word) for word in board.stdout.readline().split()]


def test_the_makers_library_drives_our_simulated_board(library, tmp_path):
    path = tmp_path / "roboclaw"
    board = subprocess.Popen([PROGRAM, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        assert board.stdout.readline() == "ready\n"
        with library.Basicmicro(str(path), 38400, timeout=0.5) as master:
            assert master.ReadVersion(ADDRESS)[1].startswith("USB Roboclaw")
            assert master.ReadM1VelocityPID(ADDRESS) == (True, 1, 1, 0, int(QPPS))
            assert master.ReadM2VelocityPID(ADDRESS)[4] == int(QPPS)
            assert master.SetTimeout(ADDRESS, 0.1)
            assert master.GetTimeout(ADDRESS) == (True, 0.1)
            assert master.ReadMainBatteryVoltage(ADDRESS)[:2] == (True, 242)
            assert master.ReadTemp(ADDRESS)[:2] == (True, 355)
            assert master.ReadError(ADDRESS)[:2] == (True, 0)
            before = master.GetEncoders(ADDRESS)
            for _ in range(40):
                assert master.SpeedM1M2(ADDRESS, 1000, -2000)
                time.sleep(0.02)
            assert speeds_of(board) == pytest.approx([1000, -2000], rel=0.05)
            after = master.GetEncoders(ADDRESS)
            assert after[1] > before[1] + 100
            assert after[2] - 2**32 < -200, "counts below zero"
            time.sleep(1.0)
            assert speeds_of(board) == pytest.approx([0, 0], abs=10), "its timeout of 100 ms"
    finally:
        board.stdin.close()
        board.wait(10)
