"""A recorded run in place of a robot: the same page shows it, and nothing can be commanded there.

The header and the index of the bag are read first, so that the page opens at once; the rows follow in a thread.
"""

import math
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rosbag

from robot_control._robot_control import BagError, NoTraceError, TraceError, read_run_header
from robot_control.data.footfalls import BEARS, FEET
from robot_control.data.run_log import FloatArray, LogError, kind_in
from robot_control.files.files import utf8
from robot_control.loop import signal_names as names
from robot_control.robot.diagnosis.state import Cause, Facts, Safety
from robot_control.robot.services import Answer
from robot_control.watch.console.authority import Authority, Page, RefusedError
from robot_control.watch.console.navigation import NoGridError
from robot_control.watch.console.replay.maps import Maps
from robot_control.watch.console.replay.playback import Playback
from robot_control.watch.console.replay.rows import (
    CONTACT,
    COVARIANCE,
    FEET_BITS,
    MARK_CAUSES,
    MARK_TIMES,
    POSE,
    RATE,
    SLOPE,
    SPEEDS,
    STATE,
    TRUTH,
    contacts_of,
)
from robot_control.watch.console.settings import Settings
from robot_control.watch.console.view import Values, rounded, state_of
from robot_control.watch.scene import Trail

REFUSAL = "a recording is shown: nothing can be commanded"
PROGRAM = "from robot_control.watch.console.replay.rows import main; main()"


class Refusing:
    """Calls of a robot that is not there."""

    def forget(self, page: Page) -> None:
        """No page has asked for anything."""

    def make(self, _page: Page, _name: str, _given: Mapping[str, Any]) -> str:
        """Raises RefusedError."""
        raise RefusedError(REFUSAL)

    def confirm_reset(self, _page: Page, _key: str) -> None:
        """Raises RefusedError."""
        raise RefusedError(REFUSAL)


class Replay:
    """A run.bag. Raises LogError or OSError if it is none."""

    live = False
    available: set[str] | None = None

    def __init__(self, path: Path, settings: Settings) -> None:
        try:
            self._header = read_run_header(utf8(path))
            with rosbag.Bag(str(path), skip_index=True) as bag:  # the list of chunks, not the index of each
                length = bag.get_end_time() - bag.get_start_time()
        except (BagError, NoTraceError, TraceError, rosbag.ROSBagException) as error:
            raise LogError(f"{path}: {error}") from None
        self.authority = Authority(settings)
        self.said: list[str] = []
        self.kind, self._joints = kind_in(self._header), list(self._header["joints"])
        self.view, self.calls, self.navigation = self, Refusing(), self
        self._contacts = contacts_of(self._header)
        self.trail = Trail()
        self.wanted: tuple[float, Values] = -math.inf, {}
        self._playback = Playback(length)
        self._time: FloatArray = np.zeros(0)
        self._rows: dict[str, FloatArray] = {}
        self._marks: list[Values] = []
        self._maps: Maps | None = None
        self._problem = ""
        threading.Thread(target=self._load, args=(path,), daemon=True).start()

    # of a Backend

    def step(self) -> None:
        """A recording needs no pass."""

    def reset(self) -> None:
        """Raises RefusedError."""
        raise RefusedError(REFUSAL)

    async def e_stop(self) -> Answer:
        """Raises RefusedError."""
        raise RefusedError(REFUSAL)

    def description(self) -> str:
        """The URDF of the recorded robot."""
        return str(self._header["urdf"])

    def play(self, at: float, speed: float) -> None:
        """Goes on from there, s, at this speed."""
        self._playback.play(at, speed, time.monotonic())

    def grid(self, name: str) -> Values:
        """The map that was known at the place that is shown. Raises NoGridError."""
        if self._maps is None:
            raise NoGridError(f"the recording holds no {name}")
        return self._maps.grid(name, self._playback.at(time.monotonic()))

    def authority_of(self, page: Page) -> Values:
        """The values of a page: it watches."""
        trips = page.dead_man.round_trips
        link = {"last": trips.last(), "p95": trips.percentile95(time.monotonic())}
        return rounded(
            {
                **self.authority.seen_by(page),
                "against": {},
                "dead_man": "",
                "link": link | {"gaps": 0, "late": 0, "replayed": 0, "cap": 0.0},
                "chosen": (0.0, 0.0, 0.0),
                "limits": (0.0, 0.0, 0.0),
                "heartbeat": False,
            }
        )

    def fast(self) -> Values:
        """The values of the row that is shown now."""
        values: Values = {"type": "fast", "ages": {}, "joints": {}}
        row = self._row()
        if row is None:
            return values
        of = self._number
        values |= {
            "asked": self._speeds("requested", row),
            "limited": self._speeds("limited", row),
            "joints": {joint: of(f"{joint}_position", row) for joint in self._joints},
            "driven": [
                {"name": joint, "error": self._error(joint, row), "effort": of(f"{joint}_effort", row)}
                for joint in self._joints
            ],
        }
        pose = [of(f"estimate_{axis}", row) for axis in POSE]
        if math.isfinite(pose[0]):
            values |= {"pose": [0.0 if math.isnan(each) else each for each in pose]}
            values["measured"] = self._speeds("estimate", row)
            values["covariance"] = [of(name, row) for name in COVARIANCE]
        if math.isfinite(of("truth_x", row)):
            values |= {"truth": [of(name, row) for name in TRUTH], "true": self._speeds("truth", row)}
        if self._contacts:
            values["legs"] = self._legs(row)
        return rounded(values)

    def slow(self) -> Values:
        """State and causes of the row that is shown now, and the time line."""
        row, at = self._row(), self._playback.at(time.monotonic())
        facts = Facts(master="", kind=self.kind, safety=None if row is None else self._safety(row))
        speeds = None if row is None else self._speeds("estimate", row)
        if speeds is not None:
            facts = Facts(master="", kind=self.kind, safety=facts.safety, measured=(speeds[0], speeds[1], speeds[2]))
        loading = self._problem or ("" if self._rows else "the recording is being read")
        replay = {"at": at, "length": self._playback.length, "speed": self._playback.speed, "marks": self._marks}
        return rounded(
            {
                **state_of(facts),
                "nodes": {},
                "asked_by": "",
                "limits": [],
                "broken": {},
                "battery": None if row is None else (math.nan, self._number("battery_voltage", row)),
                "odometry": [],
                "faults": "",
                "components": (),
                "kinds": (),
                "simulated": False,
                "paused": False,
                "sources": [],
                "revoked": [],
                "data_return": "",
                "navigation": {"grids": {}} if self._maps is None else self._maps.values(at),
                "goal": "",
                "path": {"age": None},
                "replay": {**replay, "loading": loading},
            }
        )

    # rows

    def _load(self, path: Path) -> None:
        with tempfile.TemporaryDirectory(prefix="console-replay-") as folder:
            command = [sys.executable, "-c", PROGRAM, str(path.resolve()), f"{folder}/rows.npz"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                self._problem = f"the recording cannot be read: {(done.stderr.strip().splitlines() or [''])[-1][:500]}"
                return
            with np.load(f"{folder}/rows.npz") as read:
                rows = {name: read[name] for name in read.files}
        stops = zip(rows.pop(MARK_TIMES), rows.pop(MARK_CAUSES), strict=True)
        self._marks = [
            {"at": float(at), "sentence": names.bits_in("StopCause", int(causes))[0].sentence} for at, causes in stops
        ]
        self._maps = Maps(rows)
        self._time = rows["time"]
        self._playback.length = float(self._time[-1])
        for x, y in zip(rows["estimate_x"][::10], rows["estimate_y"][::10], strict=True):
            if math.isfinite(x):
                self.trail.add(float(x), float(y))
        self._rows = rows

    def _row(self) -> int | None:
        if not self._rows:
            return None
        at = self._playback.at(time.monotonic())
        return max(0, int(np.searchsorted(self._time, at, side="right")) - 1)

    def _number(self, name: str, row: int) -> float:
        column = self._rows.get(name)
        return math.nan if column is None else float(column[row])

    def _speeds(self, of: str, row: int) -> list[float] | None:
        found = [self._number(f"{of}_{axis}", row) for axis in SPEEDS]
        return None if math.isnan(found[0]) else [0.0 if math.isnan(each) else each for each in found]

    def _error(self, joint: str, row: int) -> float:
        return self._number(f"{joint}_velocity_command", row) - self._number(f"{joint}_velocity_measured", row)

    def _legs(self, row: int) -> Values:
        """Posture, feet and ground; which gait a robot walks, its log names by a number of its own."""
        phase, feet = self._number("legged_phase", row), []
        slope = [self._number(name, row) for name in SLOPE]
        for leg, (foot, contact) in enumerate(zip(FEET, self._contacts, strict=False)):
            probability, load = (self._number(f"{contact}_{what}", row) for what in CONTACT)
            met_riser, reaching = (self._number(name, row) // 2**leg % 2 == 1 for name in FEET_BITS)
            found = {"name": foot, "bears": probability > BEARS, "load": load}
            feet.append(found | {"met_riser": met_riser, "reaching": reaching})
        posture = "" if math.isnan(phase) else names.states("LegPhase")[int(phase)]
        return {"posture": posture, "gait": "", "chosen": "auto", "gaits": [], "feet": feet, "slope": slope}

    def _safety(self, row: int) -> Safety | None:
        state, causes, active = (self._number(name, row) for name in STATE[:3])
        if math.isnan(state) or math.isnan(causes):
            return None
        name = names.states("SupervisorState")[int(state)]
        first = self._number("evidence_cause", row)
        came = int(first).bit_length() - 1 if first > 0 else -1
        found = []
        for number in range(int(causes).bit_length()):
            if not int(causes) >> number & 1:
                continue
            bit = names.bit("StopCause", number)
            value, limit = self._number("evidence_value", row), self._number("evidence_limit", row)
            detail = f"{value:.4g} {bit.unit}, limit {limit:.4g} {bit.unit}" if number == came and bit.unit else ""
            is_active = not math.isnan(active) and bool(int(active) >> number & 1)
            found.append(Cause(bit.name, bit.sentence, bit.remedy, "integrator", detail, number == came, is_active))
        began = next((mark["at"] for mark in reversed(self._marks) if mark["at"] <= self._time[row] + 1 / RATE), 0.0)
        return Safety(name, "", held=float(self._time[row]) - began, causes=tuple(found))
