"""Four nodes and a telemetry run as processes on the wall clock, on a drive with emergency stops and resets. Nodes are
killed, stopped, restarted and tuned at random moments. The log is then computed again, bit by bit.

scripts/bench processes --first 17 --runs 1
scripts/bench processes --robot quadbot
"""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from robot_control._robot_control import replay_log
from robot_control.data.replay.recorded_setup import recorded_setup
from robot_control.loop.roles import CONTROLLER, LOOP, TELEMETRY

from bench.log_bench import row
from bench.participants import START_LIMIT, await_log, command, remove_shared_memory
from bench.robot_corpus import DIFFBOT
from bench.rows import Result, Say

ALL_RUNS = 20
EVENTS = 12  # of each run
MAX_PAUSE = 1.0  # s, before each
MAX_STOP = 0.3  # s, of a node that gets SIGSTOP
MIN_COMPARED = 500  # rows of each law
ACTS = ("kill", "stop", "tune")
LAP = 4000  # cycles: a drive, an emergency stop in every other lap, rest, a reset


class Nodes:
    """The nodes as processes of rc_participant."""

    def __init__(self, programs: Path, folder: Path, robot: str) -> None:
        signal.signal(signal.SIGUSR1, signal.SIG_IGN)  # the nodes inherit it until they install their own handler
        settings = {"telemetry.black_box": 0}
        nodes = (*LOOP, TELEMETRY)
        self._commands = {node: command(programs, node, bus(), folder, settings, robot=robot) for node in nodes}
        self._running = {node: self._begin(node) for node in self._commands}

    def act(self, what: str, node: str, seconds: float) -> None:
        """Acts on a node; a stopped node stays so for `seconds`."""
        if what == "tune":
            self._running[CONTROLLER].send_signal(signal.SIGUSR1)
        elif what == "stop":
            self._running[node].send_signal(signal.SIGSTOP)
            time.sleep(seconds)
            self._running[node].send_signal(signal.SIGCONT)
        else:
            self._running[node].kill()
            self._running[node].wait()
            self._running[node] = self._begin(node)

    def end(self) -> None:
        """Ends all nodes, telemetry last. Raises RuntimeError if one had ended by itself."""
        ended = [name for name, node in self._running.items() if node.poll() is not None]
        for node in self._running.values():
            node.send_signal(signal.SIGINT)
            node.wait(START_LIMIT)
        if ended:
            raise RuntimeError(f"{', '.join(ended)} ended by itself")

    def kill(self) -> None:
        """Kills all processes that still run."""
        for node in self._running.values():
            node.kill()
            node.wait()

    def _begin(self, node: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(self._commands[node], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def bench(first: int, runs: int, programs: Path, say: Say, robot: str = DIFFBOT) -> Result:
    """The table of `runs` from seed `first` on, and whether every compared row is the same."""
    compared = missed = failed = 0
    for seed in range(first, first + runs):
        try:
            laws, different_rows = replayed_run(seed, programs, say, robot)
        except RuntimeError as error:
            failed += 1
            say(f"seed {seed}: {error}")
            continue
        compared += sum(law["compared"] for law in laws)
        missed += sum(law["not_compared"] for law in laws)
        failed += different_rows > 0 or any(law["different"] or law["compared"] < MIN_COMPARED for law in laws)
    rows = [
        row("runs", runs, "", 0),
        row("runs not exact", failed, "", 0),
        row("rows compared", compared, "", 0),
        row("rows not compared", missed, "", 0),
    ]
    return {"bench": "processes", "rows": rows}, failed == 0


def bus() -> str:
    """Name of the bus of all runs."""
    return f"processes-{os.getpid()}"


def replayed_run(seed: int, programs: Path, say: Say, robot: str = DIFFBOT) -> tuple[list[dict[str, int]], int]:
    """Counts of each law, and the number of rows with a different field; `say` receives what differs or is not
    compared.

    Raises:
        RuntimeError: a node ended by itself, or the log cannot be replayed.
    """
    random = np.random.default_rng(seed)
    with tempfile.TemporaryDirectory(prefix="processes-") as name:
        folder = Path(name)
        (folder / "script.csv").write_text(script(60 * LAP))
        nodes = Nodes(programs, folder, robot)
        try:
            await_log(folder / "run.bag", LAP)
            for _ in range(EVENTS):
                time.sleep(random.uniform(0, MAX_PAUSE))
                nodes.act(random.choice(ACTS), random.choice(LOOP), random.uniform(0, MAX_STOP))
            time.sleep(MAX_PAUSE)
            nodes.end()
        finally:
            nodes.kill()
            remove_shared_memory(bus())
        log = folder / "run.bag"
        report = replay_log(str(log), recorded_setup(log, folder).layers(), None)
    for sentence in (*report["differences"][:5], *report["gaps"]):
        say(f"seed {seed}: {sentence}")
    return list(report["laws"].values()), report["different_rows"] + len(report["header"])


def script(cycles: int) -> str:
    """Laps of a drive, an emergency stop in every other one, rest and a reset."""
    rows = ["cycle,linear,angular,event"]
    for begin in range(0, cycles, LAP):
        rows += [f"{begin + k},0,0," for k in (1, 100)]
        rows += [f"{begin + k},0.8,0.3," for k in range(200, 2400, 200)]
        rows += [f"{begin + 2400},,,e_stop"] if begin % (2 * LAP) else []
        rows += [f"{begin + k},0,0," for k in range(2450, 3800, 200)]
        rows += [f"{begin + 3800},,,e_stop_reset"]
    return "\n".join(rows) + "\n"
