"""The other side: verifies what robots have sent, and puts the files together."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from robot_control.common.files import NewFiles, escaped, given_path
from robot_control.data_return.far_side import FarSideError, reason, require_rclone
from robot_control.data_return.parts import MANIFEST, GapError, put_together


def verify(source: str, rclone_config: str, out: Path | None) -> bool:
    """One line per file; those that are whole are written below `out`, if it is given. True: all are whole.

    Raises:
        FarSideError, OSError: nothing can be read, or nothing written.
    """
    whole = gaps = 0
    folders = _folders(source, rclone_config)
    for folder in folders:
        with _local(source, folder, rclone_config) as local:
            try:
                name = _one(local, out / folder if out else None)
                whole += 1
                print(escaped(f"whole: {folder} ({name})"))
            except GapError as error:
                gaps += 1
                print(escaped(f"gap:   {folder}: {error}"))
    print(f"{whole} files are whole, {gaps} are not")
    return gaps == 0


def _one(local: Path, out: Path | None) -> str:
    """Verifies a folder, and writes its file as `out`. Returns its name on the robot. Raises GapError, OSError."""
    if out is None:
        return str(put_together(lambda name: (local / name).read_bytes(), None)["name"])
    if not (local / MANIFEST).exists():
        raise GapError(_unfinished(local))
    out.parent.mkdir(parents=True, exist_ok=True)
    with NewFiles() as files:
        partial = files.name(out)
        with partial.open("wb") as file:
            content = put_together(lambda name: (local / name).read_bytes(), file)
        os.utime(partial, ns=(content["mtime_ns"], content["mtime_ns"]))
    return str(content["name"])


def _unfinished(local: Path) -> str:
    return f"no {MANIFEST}, {sum(1 for _ in local.iterdir())} parts: it is being sent, or was deleted on the robot"


def _folders(source: str, rclone_config: str) -> list[str]:
    """Folders with files in them, below the source."""
    if (root := given_path(source)).is_dir():
        names = [str(path.relative_to(root)) for path in root.rglob("*") if path.is_file()]
    else:
        names = _rclone(rclone_config, "lsf", "--recursive", "--files-only", source).decode().splitlines()
    return sorted({str(PurePosixPath(name).parent) for name in names})


@contextmanager
def _local(source: str, folder: str, rclone_config: str) -> Iterator[Path]:
    if given_path(source).is_dir():
        yield given_path(source) / folder
        return
    with tempfile.TemporaryDirectory(prefix="data-return-") as copy:
        slash = "" if source.endswith((":", "/")) else "/"
        _rclone(rclone_config, "copy", f"{source}{slash}{folder}", copy)
        yield Path(copy)


def _rclone(config: str, *words: str) -> bytes:
    require_rclone()
    done = subprocess.run(["rclone", "--config", str(given_path(config)), *words], capture_output=True, check=False)
    if done.returncode:
        raise FarSideError(f"{words[-1]}: {reason(done.stderr.decode(errors='replace'))}")
    return done.stdout
