"""Recorded runs and incidents: their list, files and reports. A file is named by an id of the list, never by a path."""

import contextlib
import hashlib
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import Any

from robot_control.data.black_box import incidents_of
from robot_control.files.files import printable

MAX_RUNS = 200
REPORT_TIME = 600.0
"""s after which a report is given up"""
NICE = ("nice", "-n", "19")


class RunsError(RuntimeError):
    """There is no such file or report; the message says why."""


class Runs:
    """The logs of one folder, and those of the black box in it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._making = threading.Lock()  # one report at a time
        self._reports = tempfile.TemporaryDirectory(prefix="console-reports-")

    def list(self) -> list[dict[str, Any]]:
        """The newest first: id, name, bytes, time of day."""
        rows: list[dict[str, Any]] = []
        for key, path in self._files().items():
            with contextlib.suppress(OSError):  # it may be removed meanwhile
                status, name = path.stat(), printable(str(path.relative_to(self._folder)))
                rows.append({"id": key, "name": name, "bytes": status.st_size, "time": status.st_mtime})
        return sorted(rows, key=lambda row: -row["time"])[:MAX_RUNS]

    def file(self, key: str) -> Path:
        """The log with this id. Raises RunsError."""
        path = self._files().get(key)
        if path is None:
            raise RunsError("run not found")
        return path

    def report(self, key: str) -> Path:
        """Its report, which is made if it is not there yet; takes seconds to minutes. Raises RunsError."""
        path = self.file(key)
        page = Path(self._reports.name, f"{key}-{path.stat().st_mtime_ns}.html")
        if not self._making.acquire(blocking=False):
            raise RunsError("another report is in progress: try again later")
        try:
            if not page.exists():
                program = "import sys; from robot_control.data.report.main import main; main(sys.argv[1:])"
                command = [*NICE, sys.executable, "-c", program, str(path), "--out", str(page)]
                done = subprocess.run(command, capture_output=True, text=True, timeout=REPORT_TIME, check=False)
                if done.returncode or not page.exists():
                    raise RunsError(done.stderr.strip()[-500:] or "report.py wrote no page: scripts/setup --report")
            return page
        except subprocess.TimeoutExpired:
            raise RunsError(f"report.py was not ready within {REPORT_TIME:.0f} s") from None
        finally:
            self._making.release()

    def _files(self) -> dict[str, Path]:
        try:
            paths = [*self._folder.glob("*.bag"), *self._folder.glob("*/*.bag"), *incidents_of(self._folder)]
        except OSError:
            return {}
        files = {path for path in paths if path.is_file() and not path.is_symlink()}
        return {hashlib.sha256(os.fsencode(path)).hexdigest()[:16]: path for path in sorted(files)}
