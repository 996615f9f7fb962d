"""The remote through rclone, which neither resumes nor writes atomically: every call says what it has left there."""

import contextlib
import hashlib
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_control.data.data_return.settings import Settings
from robot_control.files.files import given_path, printable
from robot_control.settings.files import redacted

POLL = 0.2
"""s between two checks whether a call has to end"""
SILENCE = 20
"""s without a byte after which a connection counts as lost"""
SLOWEST = 20e3
"""bytes/s; a link that is slower is no good one"""
HASHES = ("sha256", "sha1", "md5")
"""that a remote may compute of a file; the first one is compared"""
NOT_FOUND = (3, 4)
"""exit codes of rclone: a folder, a file"""
PLACE = "robot_control_place"
"""name of rclone's alias for the place of all calls, for a command line is shown to every user of the machine"""

REASONS = (
    (r"didn't find section in config", "this remote is not in rclone's configuration: rclone config shows all"),
    (r"directory not found", "folder not found"),
    (r"certificate has expired", "its certificate has expired: renew it there"),
    (r"x509|certificate", "its certificate is not trusted: set ca_file"),
    (r"knownhosts|host key", "its host key is unknown: check known_hosts_file of rclone's configuration"),
    (
        r"unable to authenticate|\b401\b|unauthorized|invalid ?credentials|SignatureDoesNotMatch|InvalidAccessKeyId",
        "it refuses user or password: rclone config",
    ),
    (
        r"no space left|\b507\b|insufficient storage|quota|\b405\b|SSH_FX_FAILURE",
        "it cannot write; check its disk space",
    ),
    (r"permission denied|\b403\b|forbidden|read-?only", "no permission to write there"),
    (
        r"connection re|no such host|i/o timeout|unreachable|no route|deadline exceeded|broken pipe|connection lost|"
        r"\bEOF\b|couldn't connect|handshake|\b50[234]\b|server misbehaving|closed network",
        "it does not answer",
    ),
)
"""what rclone writes, and what it means"""


class RemoteError(RuntimeError):
    """A call failed; the message says why and what helps."""


class InterruptedCallError(RuntimeError):
    """A call was ended, because nothing may be sent now."""


@dataclass(frozen=True)
class RemoteFile:
    """A file of a remote; kind of hash and hash are empty where it computes none."""

    size: int
    kind: str = ""
    digest: str = ""

    def holds(self, data: bytes) -> bool:
        """By its hash, else by its size."""
        own = hashlib.new(self.kind, data, usedforsecurity=False).hexdigest() if self.kind else ""
        return (self.size, self.digest) == (len(data), own)


def require_rclone() -> None:
    """Raises RemoteError: it is missing."""
    if shutil.which("rclone") is None:
        raise RemoteError("needs Debian's rclone: scripts/setup --data-return")


class Remote:
    """The folder `place` of a remote, by default that of this robot.

    Neither the command lines of rclone nor an error show the passwords that `place` may hold. `reason_to_wait` says
    during a call why it has to end; empty: it goes on.
    """

    def __init__(self, settings: Settings, reason_to_wait: Callable[[], str] = lambda: "", place: str = "") -> None:
        self._reason_to_wait, place = reason_to_wait, place or settings.destination
        self._shown = redacted(place)
        self._slowest = min(SLOWEST, settings.bandwidth * 0.5e6) if settings.bandwidth else SLOWEST
        self._command = ["setpriv", "--pdeathsig", "KILL", "rclone", "--retries", "1", "--low-level-retries", "1"]
        self._command += ["--transfers", "1", "--checkers", "1", "--timeout", f"{SILENCE}s"]
        self._command += ["--contimeout", f"{SILENCE}s", "--config", str(given_path(settings.rclone_config))]
        if settings.bandwidth:
            self._command += ["--bwlimit", f"{settings.bandwidth * 1e6:.0f}b"]
        if settings.ca_file:
            self._command += ["--ca-cert", str(given_path(settings.ca_file))]
        alias = f"RCLONE_CONFIG_{PLACE.upper()}"
        self._environment = {**os.environ, "GOMAXPROCS": "1", f"{alias}_TYPE": "alias", f"{alias}_REMOTE": place}

    def put(self, source: Path, target: str) -> None:
        """Copies the files of a folder. One with the same hash (without hashes: size) that is there already stays.

        The caller verifies them: a copy that verifies by itself deletes a whole file where the link is cut meanwhile.
        """
        size = sum(each.stat().st_size for each in source.iterdir())
        options = ("--checksum", "--ignore-checksum", "--no-traverse")
        self._rclone("copy", *options, str(source), f"{PLACE}:{target}", size=size)

    def copy(self, folder: str, sizes: Mapping[str, int], out: Path) -> None:
        """Copies these files of a folder into a local one."""
        with tempfile.NamedTemporaryFile("w", prefix="data-return-") as file:
            file.write("\n".join(sizes))
            file.flush()
            words = ("copy", "--files-from-raw", file.name, "--no-traverse", f"{PLACE}:{folder}", str(out))
            self._rclone(*words, size=sum(sizes.values()))

    def files(self, target: str, names: Sequence[str] = (), size: int = 0) -> dict[str, RemoteFile]:
        """The files of a folder whose files have `size` bytes together, or those of them that are named."""
        chosen = [word for name in names for word in ("--include", f"/{name}")]
        words = ("lsjson", "--hash", "--files-only", "--no-modtime", *chosen, f"{PLACE}:{target}")
        return listed(self._rclone(*words, size=size, missing=b"[]"))

    def all_files(self) -> dict[str, RemoteFile]:
        """All files by their paths, without hashes."""
        return listed(self._rclone("lsjson", "--recursive", "--files-only", "--no-modtime", f"{PLACE}:"), "Path")

    def read(self, name: str, size: int) -> bytes:
        """The content of a file that should have this size; of a longer one not more than one byte more."""
        return self._rclone("cat", "--count", str(size + 1), f"{PLACE}:{name}", size=size)

    def remove(self, name: str) -> None:
        """A file that has different content than was sent."""
        self._rclone("deletefile", f"{PLACE}:{name}")

    def used(self) -> int:
        """Bytes of all files."""
        return int(json.loads(self._rclone("size", "--json", f"{PLACE}:", missing=b'{"bytes": 0}'))["bytes"])

    def _rclone(self, *words: str, size: int = 0, missing: bytes | None = None) -> bytes:
        end = time.monotonic() + 3 * SILENCE + size / self._slowest
        quiet, pipe = subprocess.DEVNULL, subprocess.PIPE
        command = [*self._command, *words]
        with subprocess.Popen(command, stdin=quiet, stdout=pipe, stderr=pipe, env=self._environment) as process:
            try:
                while True:
                    with contextlib.suppress(subprocess.TimeoutExpired):
                        out, problem = process.communicate(timeout=POLL)
                        break
                    if why := self._reason_to_wait():
                        raise InterruptedCallError(why)
                    if time.monotonic() > end:
                        raise RemoteError(f"{self._shown}: the link is slower than {self._slowest:.0f} bytes/s")
            finally:
                process.kill()
        if process.returncode in NOT_FOUND and missing is not None:
            return missing
        if process.returncode:
            why = reason(problem.decode(errors="replace"))
            hidden = self._shown.endswith("…") and why.startswith("rclone: ")
            raise RemoteError(f"{self._shown}: {'rclone failed' if hidden else why}")
        return out


def listed(answer: bytes, name: str = "Name") -> dict[str, RemoteFile]:
    """The files of rclone's list, by their `name`. Raises RemoteError: it is none."""
    try:
        files = {}
        for each in json.loads(answer):
            if (type(each[name]), type(each["Size"])) != (str, int):
                raise ValueError("a file without name and size")
            files[each[name]] = RemoteFile(each["Size"], *_hash(each.get("Hashes") or {}))
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise RemoteError(f"rclone gives no list of files: {printable(str(error))}") from None
    return files


def _hash(known: dict[str, Any]) -> tuple[str, str]:
    return next(((kind, known[kind].lower()) for kind in HASHES if known.get(kind)), ("", ""))


def reason(problem: str) -> str:
    """One sentence for what stopped rclone, out of its output."""
    for pattern, meaning in REASONS:
        if re.search(pattern, problem, re.IGNORECASE):
            return meaning
    lines = [line for line in problem.splitlines() if line.strip()]
    return f"rclone: {printable(re.sub(r'^[0-9/]+ [0-9:]+ ', '', lines[-1]))}" if lines else "rclone failed"
