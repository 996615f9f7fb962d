"""A broker on a free port of the loopback, and a link to it that can be cut."""

from __future__ import annotations

import getpass
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

from bench.console.process import free_port

MOSQUITTO = "/usr/sbin/mosquitto"
LIMIT = 10.0
"""s until it listens"""


def missing() -> str:
    """The remedy, if a package is not installed; else empty."""
    try:
        import jsonschema  # noqa: F401
        import paho.mqtt.client  # noqa: F401
    except ImportError:
        return "needs Debian's python3-paho-mqtt and python3-jsonschema: scripts/setup --fleet"
    return "" if shutil.which(MOSQUITTO) else "needs Debian's mosquitto: scripts/setup --fleet"


class Broker:
    """mosquitto, without persistence: what is retained ends with it."""

    def __init__(self, folder: Path) -> None:
        self.port = free_port()
        self._config = folder / "mosquitto.conf"
        self._process: subprocess.Popen[bytes] | None = None
        self.configure("allow_anonymous true")

    def configure(self, *lines: str) -> None:
        """Starts it (again) with these lines of its configuration."""
        self.kill()
        user = getpass.getuser()  # one of its own could not read the keys
        head = [f"listener {self.port} 127.0.0.1", "persistence false", f"user {user}"]
        self._config.write_text("\n".join([*head, *lines, ""]))
        self.start()

    def start(self) -> None:
        """Listens when this returns."""
        command = [MOSQUITTO, "-c", str(self._config)]
        self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.02)
        raise RuntimeError(f"{MOSQUITTO} does not listen on port {self.port}")

    @property
    def running(self) -> bool:
        """False after `kill`."""
        return self._process is not None and self._process.poll() is None

    def kill(self) -> None:
        """SIGKILL."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    def stall(self, *, go_on: bool = False) -> None:
        """SIGSTOP, or SIGCONT."""
        if self._process is not None and self.running:
            self._process.send_signal(signal.SIGCONT if go_on else signal.SIGSTOP)

    def end(self) -> None:
        """For good."""
        self.stall(go_on=True)
        self.kill()
