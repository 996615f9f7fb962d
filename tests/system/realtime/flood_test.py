"""A flood on every input of the robot harms no deadline.

Quiet and flooded spells alternate on one drive. The log gives the 99th percentile of the time from the driver's wake-up
to the published command for each spell. The median of the ratios of neighbours is judged, because this machine is
shared.
"""

import os
import signal
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from robot_control.data.run_log import read_log
from system.losses_support import FAST, FULL_SPEED
from system.system_support import Program, RobotTestCase, wait_for

RATE = 10_000
"""Messages per second and topic."""
SPELL = 1.5
"""s; 1500 cycles, so that 15 lie above the 99th percentile."""
PAIRS = 6
SETTLE = 0.2
"""s after a change that belong to no spell."""
WORST_RATIO = 2.0
ATTEMPTS = 3
"""Attempts until a ratio is good: another load on this machine disturbs flood and quiet spells, but not always evenly.
"""


def stolen() -> float:
    """s that the hypervisor took from this machine since it began (proc(5), field 8 of cpu)."""
    return int(Path("/proc/stat").read_text().splitlines()[0].split()[8]) / os.sysconf("SC_CLK_TCK")


class FloodTest(RobotTestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.robot.await_ready()
        self.telemetry = Program("telemetry", f"_directory:={self.folder}", "_record:=always")
        wait_for("a log", (self.folder / "run.bag").exists)
        self.drive()
        self.flood = subprocess.Popen([os.environ["FLOOD"], str(RATE)], stdout=subprocess.PIPE, text=True)
        time.sleep(2.0)  # it connects

    def tearDown(self) -> None:
        self.flood.kill()
        self.flood.wait()
        self.telemetry.end()

    def drive(self) -> None:
        self.robot.drive_until("1 m/s", lambda: self.robot.speed > FAST, FULL_SPEED, 0.0)

    def spell(self, flooded: bool) -> tuple[float, float]:
        """Begin and end on CLOCK_MONOTONIC, s; the robot is commanded meanwhile."""
        self.flood.send_signal(signal.SIGCONT if flooded else signal.SIGSTOP)
        begin = time.monotonic() + SETTLE
        end = begin + SPELL
        while time.monotonic() < end:
            self.robot.send(FULL_SPEED, 0.0)
            time.sleep(0.02)
        if self.robot.stalled:
            self.drive()
        self.assertEqual(self.robot.causes, set())
        return begin, end

    def measure(self) -> list[float]:
        """Ratios of p99, pair by pair."""
        stolen_before = stolen()
        spells = [(self.spell(False), self.spell(True)) for _ in range(PAIRS)]
        self.flood.send_signal(signal.SIGSTOP)
        time.sleep(2.5)  # the log is handed on
        log = read_log(self.folder / "run.bag")
        due = (log["stamp_ns"] + log["slipped_ns"]) * 1e-9
        latency = (log["command_published_ns"] - log["driver_woke_ns"]) * 1e-3

        def p99(spell: tuple[float, float]) -> float:
            inside = latency[(due >= spell[0]) & (due < spell[1])]
            inside = inside[np.isfinite(inside)]
            self.assertGreater(len(inside), 500, "cycles in a spell")
            return float(np.percentile(inside, 99))

        pairs = [(p99(quiet), p99(flooded)) for quiet, flooded in spells]
        print(
            f"  p99 quiet / flooded, µs: {', '.join(f'{q:.0f}/{f:.0f}' for q, f in pairs)};"
            f" {stolen() - stolen_before:.2f} s stolen"
        )
        return [flooded / quiet for quiet, flooded in pairs]

    def test_10_khz_on_every_input_harm_no_deadline(self) -> None:
        ratio = np.inf
        for _ in range(ATTEMPTS):
            ratio = statistics.median(self.measure())
            print(f"  median ratio {ratio:.2f}")
            if ratio <= WORST_RATIO:
                break
        self.flood.send_signal(signal.SIGCONT)
        self.flood.send_signal(signal.SIGINT)
        sent, _ = self.flood.communicate(timeout=30)
        print(f"  sent while it ran: {', '.join(sent.split(chr(10)))}")
        self.assertIn("clearance", sent)
        self.assertLessEqual(ratio, WORST_RATIO)
        self.assertTrue(all(node.running for node in self.robot.nodes.values()))
