"""The other side: verifies what robots have sent, and puts the files together.

A name from outside is a component of a path: none of them leads out of the folder in which the files are put together.
"""

import os
import stat
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path, PurePosixPath

from robot_control.data.data_return.parts import MANIFEST, MAX_FILE, GapError, put_together, read_manifest
from robot_control.data.data_return.remote import Remote, RemoteError, require_rclone
from robot_control.data.data_return.settings import Settings
from robot_control.files.files import NewFiles, escaped, given_path


def verify(source: str, rclone_config: str, out: Path | None) -> bool:
    """One line per folder; files that are whole are written below `out`, if it is given. True: all are whole.

    Raises:
        RemoteError, OSError: nothing can be read.
    """
    local, remote = given_path(source), None
    if local.is_dir():  # the sizes are seen when the files are read
        files = (Path(folder, name) for folder, _, names in os.walk(local) for name in names)
        sizes_by_path = {str(path.relative_to(local)): 0 for path in files}
    else:
        require_rclone()
        remote = Remote(Settings(rclone_config=rclone_config), place=source)
        sizes_by_path = {path: file.size for path, file in remote.all_files().items()}
    gaps, folders = 0, dict[str, dict[str, int]]()
    for path, size in sizes_by_path.items():
        folder, _, name = path.rpartition("/")
        folders.setdefault(folder, {})[name] = size
    for folder, sizes in sorted(folders.items()):
        try:
            names = _names(folder or PurePosixPath(source.rpartition(":")[2]).name)
            if MANIFEST not in sizes:
                raise GapError(f"no {MANIFEST}, {len(sizes)} parts: it is being sent, or was deleted on the robot")
            with _copied(remote, folder, sizes) if remote else nullcontext(local / folder) as copy:
                name = _one(copy, out.joinpath(*names) if out else None)
            print(escaped(f"whole: {folder or '.'} ({name})"))
        except (GapError, RemoteError, OSError) as error:
            gaps += 1
            print(escaped(f"gap:   {folder or '.'}: {error}"))
    print(f"{len(folders) - gaps} files are complete, {gaps} are not")
    return gaps == 0


def _names(path: str) -> list[str]:
    """The components of a path from outside. Raises GapError: one of them is no name, or names another folder."""
    names = path.split("/")
    with suppress(UnicodeEncodeError):  # half of a surrogate pair, as JSON may have it
        if not {"", ".", ".."} & set(names) and b"\0" not in os.fsencode(path):
            return names
    raise GapError("its path has an invalid part")


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
            raise GapError(f"{path.name} is not a file of at most {MAX_FILE} bytes")
        return opened.read(MAX_FILE + 1)


@contextmanager
def _copied(remote: Remote, folder: str, sizes: Mapping[str, int]) -> Iterator[Path]:
    """A copy of the files that the manifest of a folder names, none of them longer than a part may be."""
    with tempfile.TemporaryDirectory(prefix="data-return-") as name:
        copy = Path(name)
        short = {name: size for name, size in sizes.items() if size <= MAX_FILE}
        remote.copy(folder, {MANIFEST: sizes[MANIFEST]} if MANIFEST in short else {}, copy)
        parts = {part.name for part in read_manifest(_content(copy / MANIFEST))["parts"]}
        remote.copy(folder, {name: size for name, size in short.items() if name in parts}, copy)
        yield copy
