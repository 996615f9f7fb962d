"""The far side through rclone, which neither resumes nor writes atomically: every call says what it has left there."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from robot_control.common.files import given_path, printable
from robot_control.data_return.settings import Settings

POLL = 0.2
"""s between two looks whether a call has to end"""
SILENCE = 20
"""s without a byte after which a connection counts as lost"""
SLOWEST = 20e3
"""bytes/s; a link that is slower is no good one"""
HASHES = ("sha256", "sha1", "md5")
"""that the far side may compute of a file; the first one is compared"""
NOT_FOUND = (3, 4)
"""exit codes of rclone: a folder, a file"""

REASONS = (
    (r"didn't find section in config", "this remote is not in rclone's configuration: rclone config shows all"),
    (r"directory not found", "there is no such folder"),
    (r"certificate has expired", "its certificate has expired: renew it there"),
    (r"x509|certificate", "its certificate is not trusted: set ca_file"),
    (r"knownhosts|host key", "its host key is not the known one: known_hosts_file of rclone's configuration"),
    (
        r"unable to authenticate|\b401\b|unauthorized|invalid ?credentials|SignatureDoesNotMatch|InvalidAccessKeyId",
        "it refuses user or password: rclone config",
    ),
    (r"no space left|\b507\b|insufficient storage|quota|\b405\b|SSH_FX_FAILURE", "it cannot write; is its disk full?"),
    (r"permission denied|\b403\b|forbidden|read-?only", "this user may not write there"),
    (
        r"connection re|no such host|i/o timeout|unreachable|no route|deadline exceeded|broken pipe|connection lost|"
        r"\bEOF\b|couldn't connect|handshake|\b50[234]\b|server misbehaving|closed network",
        "it does not answer",
    ),
)
"""what rclone writes, and what it means"""


class FarSideError(RuntimeError):
    """A call failed; the message says why and what helps."""


class InterruptedCallError(RuntimeError):
    """A call was ended, because nothing may be sent now."""


def require_rclone() -> None:
    """Raises FarSideError: it is missing."""
    if shutil.which("rclone") is None:
        raise FarSideError("needs Debian's rclone: scripts/setup --data-return")


class FarSide:
    """The folder of this robot. `waits` says during a call why it has to end; empty: it goes on."""

    def __init__(self, settings: Settings, waits: Callable[[], str] = lambda: "") -> None:
        self._at = settings.destination
        self._waits = waits
        self._slowest = min(SLOWEST, settings.bandwidth * 0.5e6) if settings.bandwidth else SLOWEST
        self._options = ["--retries", "1", "--low-level-retries", "1", "--transfers", "1", "--checkers", "1"]
        self._options += ["--timeout", f"{SILENCE}s", "--contimeout", f"{SILENCE}s", "--config"]
        self._options += [str(given_path(settings.rclone_config))]
        if settings.bandwidth:
            self._options += ["--bwlimit", f"{settings.bandwidth * 1e6:.0f}b"]
        if settings.ca_file:
            self._options += ["--ca-cert", str(given_path(settings.ca_file))]

    def put(self, source: Path, target: str) -> None:
        """Copies the files of a folder. One with the same hash (without hashes: size) that is there already stays.

        The caller verifies them: a copy that verifies by itself deletes a whole file where the link is cut meanwhile.
        """
        size = sum(each.stat().st_size for each in source.iterdir())
        self._rclone(
            "copy", "--checksum", "--ignore-checksum", "--no-traverse", str(source), f"{self._at}/{target}", size=size
        )

    def found(self, target: str, names: Sequence[str]) -> dict[str, tuple[str, str]]:
        """Kind of hash and hash of those of these files that are there; both empty where it computes none."""
        chosen = [word for name in names for word in ("--include", f"/{name}")]
        listed = json.loads(self._rclone("lsjson", "--hash", "--files-only", *chosen, f"{self._at}/{target}"))
        return {each["Name"]: _hash(each.get("Hashes") or {}) for each in listed}

    def sizes(self, target: str) -> dict[str, int]:
        """Size of all files of a folder; empty where there is none."""
        listed = self._rclone("lsjson", "--files-only", "--no-modtime", f"{self._at}/{target}", missing=b"[]")
        return {each["Name"]: int(each["Size"]) for each in json.loads(listed)}

    def read(self, name: str, size: int) -> bytes:
        """The content of a file of about this size."""
        return self._rclone("cat", f"{self._at}/{name}", size=size)

    def remove(self, name: str) -> None:
        """A file that has another content than was sent."""
        self._rclone("deletefile", f"{self._at}/{name}")

    def used(self) -> int:
        """Bytes of this robot."""
        return int(json.loads(self._rclone("size", "--json", self._at, missing=b'{"bytes": 0}'))["bytes"])

    def _rclone(self, *words: str, size: int = 0, missing: bytes | None = None) -> bytes:
        end = time.monotonic() + 3 * SILENCE + size / self._slowest
        command = ["setpriv", "--pdeathsig", "KILL", "rclone", *self._options, *words]
        environment: dict[str, Any] = {**os.environ, "GOMAXPROCS": "1"}  # one core at most
        with subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
        ) as process:
            while True:
                try:
                    out, problem = process.communicate(timeout=POLL)
                    break
                except subprocess.TimeoutExpired:
                    why = self._waits()
                    if why or time.monotonic() > end:
                        process.kill()
                        process.communicate()
                        if why:
                            raise InterruptedCallError(why) from None
                        raise FarSideError(f"{self._at}: the link is slower than {self._slowest:.0f} bytes/s") from None
        if process.returncode in NOT_FOUND and missing is not None:
            return missing
        if process.returncode:
            raise FarSideError(f"{self._at}: {reason(problem.decode(errors='replace'))}")
        return out


def _hash(known: dict[str, str]) -> tuple[str, str]:
    return next(((kind, known[kind].lower()) for kind in HASHES if known.get(kind)), ("", ""))


def reason(problem: str) -> str:
    """One sentence for what stopped rclone, out of its output."""
    for pattern, meaning in REASONS:
        if re.search(pattern, problem, re.IGNORECASE):
            return meaning
    lines = [line for line in problem.splitlines() if line.strip()]
    return f"rclone: {printable(re.sub(r'^[0-9/]+ [0-9:]+ ', '', lines[-1]))}" if lines else "rclone failed"
