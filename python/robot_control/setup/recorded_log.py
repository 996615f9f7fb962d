"""The log of every cycle of a running robot, written by its telemetry, else by one that is started here."""

import contextlib
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import rospy
from std_srvs.srv import SetBool

from robot_control.data.run_log import FloatArray, LogError, read_log, read_run
from robot_control.ui.child import Child

NODE = "identify_telemetry"
START_LIMIT = 20.0
"""s until the first row is in the file; 1 s on an idle machine"""
END_LIMIT = 10.0
"""s for an orderly end after SIGINT"""
SETTLE = 4.0
"""s after the last command; a chunk of run.bag is written 2 s after its begin at the latest"""


class RecordingError(RuntimeError):
    """There is no log; the message names the reason."""


@dataclass(frozen=True)
class RunningTelemetry:
    """The telemetry as the robot reports it."""

    node: str
    path: str
    """Path of run.bag."""
    records: bool
    """True if run.bag holds the present cycles."""


class Recording:
    """Rows of the run.bag of a telemetry from a moment on; which records all of them until they are read."""

    def __init__(self, path: Path, telemetry: str, *, records: bool) -> None:
        """`telemetry` is the node; `records`: it was recording before and shall go on.

        Raises:
            RecordingError: it does not record.
        """
        self.path = path
        self._records = records
        self._record = rospy.ServiceProxy(f"{telemetry}/record", SetBool)
        self._switch(on=True)
        self._begin = rospy.get_time()

    def read(self) -> dict[str, FloatArray]:
        """The columns of the rows that were written since the begin.

        Raises:
            LogError: nothing.
        """
        time.sleep(SETTLE)
        log = read_run(self.path)
        wanted = log.ros_time >= self._begin
        rows = {name: values[wanted] for name, values in log.columns.items()}
        if not rows["cycle"].size:
            raise LogError(f"{self.path}: no rows since {self._begin:.3f}")
        return rows

    def end(self) -> None:
        """Restores the telemetry's recording as it was."""
        if not self._records:
            with contextlib.suppress(RecordingError):
                self._switch(on=False)

    def _switch(self, *, on: bool) -> None:
        try:
            answer = self._record(on)
        except rospy.ServiceException as error:
            raise RecordingError(f"{self._record.resolved_name} does not answer: {error}") from None
        if not answer.success:
            raise RecordingError(f"{self._record.resolved_name}: {answer.message}")


@contextlib.contextmanager
def recording(running: RunningTelemetry | None, config: str, going_on: Callable[[], bool]) -> Iterator[Recording]:
    """Rows of `running`, a telemetry that runs already; None: starts one with the parameter file `config`.

    Raises:
        RecordingError: no rows come.
    """
    if running is not None:
        path = Path(running.path)
        if not path.is_file():
            raise RecordingError(f"telemetry writes {path}, which is not on this machine: run identify.py there")
        log = Recording(path, running.node, records=running.records)
        try:
            yield log
        finally:
            log.end()
        return
    folder = Path(tempfile.mkdtemp(prefix="identify-"))
    telemetry = Child(_command(folder, config), folder / "telemetry.txt")
    try:
        path = _first_rows(folder, telemetry, going_on)
        yield Recording(path, rospy.resolve_name(NODE), records=True)
    finally:
        telemetry.end(END_LIMIT)
        with contextlib.suppress(KeyError, rospy.ROSException, OSError):  # private parameters outlive their node
            rospy.delete_param(NODE)
        shutil.rmtree(folder, ignore_errors=True)


def _command(folder: Path, config: str) -> list[str]:
    telemetry = ["rosrun", "robot_control", "telemetry", f"__name:={NODE}", f"__ns:={rospy.get_namespace()}"]
    return [*telemetry, f"_directory:={folder}", f"_config:={config}", "_record:=always"]


def _first_rows(folder: Path, telemetry: Child, going_on: Callable[[], bool]) -> Path:
    deadline = time.monotonic() + START_LIMIT
    while time.monotonic() < deadline and telemetry.running and going_on():
        # A namespace has a folder of its own in it.
        for path in folder.rglob("run.bag"):
            with contextlib.suppress(LogError):  # it has no rows yet
                read_log(path, ["cycle"])
                return path
        time.sleep(0.1)
    said = telemetry.output.read_text(errors="replace").strip().splitlines()
    raise RecordingError("no rows from telemetry: " + (said[-1] if said else f"nothing within {START_LIMIT:g} s"))
