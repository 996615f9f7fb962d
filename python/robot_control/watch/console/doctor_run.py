"""The result of doctor.py for the page, made on request.

Its process has the usual priority. On a loaded machine, where the findings are wanted most, one of the lowest does not
get the 0.2 s of a processor that it needs.
"""

import json
import subprocess
import sys
import threading
from typing import Any

from robot_control.watch.console.runs import RunsError

TIME = 20.0
"""s after which it is given up; 0.6 s on an idle machine"""
PROGRAM = "import sys; from robot_control.setup.doctor.main import main; sys.exit(main())"


class DoctorRun:
    """One examination of this machine at a time."""

    def __init__(self) -> None:
        self._running = threading.Lock()

    def result(self) -> list[dict[str, Any]]:
        """The findings, the worst first: name, verdict, value, why, remedy. Raises RunsError."""
        if not self._running.acquire(blocking=False):
            raise RunsError("doctor.py already runs: try again later")
        try:
            command = [sys.executable, "-c", PROGRAM, "--json"]
            done = subprocess.run(command, capture_output=True, text=True, timeout=TIME, check=False)
            checks: list[dict[str, Any]] = json.loads(done.stdout)["checks"]
        except subprocess.TimeoutExpired:
            raise RunsError(f"doctor.py was not ready within {TIME:.0f} s") from None
        except ValueError:
            raise RunsError(done.stderr.strip()[-500:] or "doctor.py printed no result") from None
        finally:
            self._running.release()
        order = ("fault", "warning", "note", "unseen", "ok")
        return sorted(checks, key=lambda check: order.index(check["verdict"]))
