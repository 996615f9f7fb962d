"""The other side: verifies what robots have sent, and puts the files together.

A name from outside is a component of a path: none of them leads out of the folder in which the files are put together.
"""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator, Mapping, Set
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path, PurePosixPath

from robot_control.common.files import NewFiles, escaped, given_path
from robot_control.data_return.parts import MANIFEST, MAX_FILE, GapError, put_together, read_manifest
from robot_control.data_return.remote import PLACE, Rclone, RemoteError, listed, require_rclone


def verify(source: str, rclone_config: str, out: Path | None) -> bool:
    """One line per folder; files that are whole are written below `out`, if it is given. True: all are whole.

    Raises:
        RemoteError, OSError: nothing can be read.
    """
    local = given_path(source)
    place = _Folder(local) if local.is_dir() else _OnRemote(source, rclone_config)
    whole = gaps = 0
    for folder, sizes in sorted(place.folders().items()):
        try:
            names = _names(folder or PurePosixPath(source.rpartition(":")[2]).name)
            if MANIFEST not in sizes:
                raise GapError(f"no {MANIFEST}, {len(sizes)} parts: it is being sent, or was deleted on the robot")
            with place.copied(folder, sizes) as copy:
                name = _one(copy, out.joinpath(*names) if out else None)
            whole += 1
            print(escaped(f"whole: {folder or '.'} ({name})"))
        except (GapError, RemoteError, OSError) as error:
            gaps += 1
            print(escaped(f"gap:   {folder or '.'}: {error}"))
    print(f"{whole} files are whole, {gaps} are not")
    return gaps == 0


def _names(path: str) -> list[str]:
    """The components of a path from outside. Raises GapError: one of them is no name, or names another folder."""
    names = path.split("/")
    if any(name in ("", ".", "..") or "\0" in name or not _is_for_files(name) for name in names):
        raise GapError("its path has a part that is no name")
    return names


def _is_for_files(name: str) -> bool:
    try:
        os.fsencode(name)
    except UnicodeEncodeError:  # half of a surrogate pair, as JSON may have it
        return False
    return True


def _one(copy: Path, out: Path | None) -> str:
    """Verifies a folder, and writes its file as `out`. Returns its name on the robot. Raises GapError, OSError."""
    if out is None:
        return str(put_together(lambda name: _content(copy / name), None)["name"])
    out.parent.mkdir(parents=True, exist_ok=True)
    with NewFiles() as files:
        partial = files.name(out)
        with partial.open("wb") as file:
            content = put_together(lambda name: _content(copy / name), file)
        os.utime(partial, ns=(content["mtime_ns"], content["mtime_ns"]))
    return str(content["name"])


def _content(path: Path) -> bytes:
    """Raises OSError, and GapError: it is no file, or longer than a part may be."""
    file = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    with open(file, "rb") as opened:  # noqa: PTH123 (of a descriptor)
        status = os.fstat(file)
        if not stat.S_ISREG(status.st_mode) or status.st_size > MAX_FILE:
            raise GapError(f"{path.name} is no file of at most {MAX_FILE} bytes")
        return opened.read(MAX_FILE + 1)


class _Folder:
    """Of this machine."""

    def __init__(self, root: Path) -> None:
        self._root = root

    def folders(self) -> dict[str, dict[str, int]]:
        """Paths of the folders with files in them, below the root; the files' sizes are not needed."""
        found = {os.path.relpath(folder, self._root): files for folder, _, files in os.walk(self._root) if files}
        return {"" if folder == "." else folder: dict.fromkeys(files, 0) for folder, files in found.items()}

    def copied(self, folder: str, _sizes: Mapping[str, int]) -> AbstractContextManager[Path]:
        """The folder itself."""
        return nullcontext(self._root / folder)


class _OnRemote:
    """Of rclone's."""

    def __init__(self, source: str, rclone_config: str) -> None:
        require_rclone()
        self._rclone = Rclone(source, rclone_config)

    def folders(self) -> dict[str, dict[str, int]]:
        """Paths of the folders with files in them, below the source, and the sizes of their files."""
        found = dict[str, dict[str, int]]()
        answer = self._rclone.run("lsjson", "--recursive", "--files-only", "--no-modtime", f"{PLACE}:")
        for path, file in listed(answer, "Path").items():
            folder, _, name = path.rpartition("/")
            found.setdefault(folder, {})[name] = file.size
        return found

    @contextmanager
    def copied(self, folder: str, sizes: Mapping[str, int]) -> Iterator[Path]:
        """A copy of the files that the manifest names, none of them longer than a part may be."""
        with tempfile.TemporaryDirectory(prefix="data-return-") as name:
            copy = Path(name)
            self._copy(folder, {MANIFEST}, sizes, copy)
            if (copy / MANIFEST).exists():
                names = {part.name for part in read_manifest(_content(copy / MANIFEST))["parts"]}
                self._copy(folder, names, sizes, copy)
            yield copy

    def _copy(self, folder: str, names: Set[str], sizes: Mapping[str, int], copy: Path) -> None:
        chosen = [name for name in names & sizes.keys() if sizes[name] <= MAX_FILE]
        with tempfile.NamedTemporaryFile("w", prefix="data-return-") as file:
            file.write("\n".join(chosen))
            file.flush()
            words = ("copy", "--files-from-raw", file.name, "--no-traverse", f"{PLACE}:{folder}", str(copy))
            self._rclone.run(*words, size=sum(sizes[name] for name in chosen))
