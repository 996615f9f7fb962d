"""Prints a .xacro file on standard output as the URDF for which it stands:
`python3 -m robot_control.setup.expand_xacro FILE`.

A comment after it, `xacro macros: …`, names the macros that were called, because the expanded text does not.

PyPI's xacro resolves `$(find PACKAGE)` by ROS 2's package index, through the module `ament_index_python.packages`. This
module replaces it: rospkg answers first, then the folders above the file.

A .xacro file is a program: xacro evaluates what stands in `${…}` and `$(eval …)` as Python. Only expressions of values
are admitted here. The process reads files and writes its output. As far as the kernel permits that, it has no network,
changes no file and starts no program.
"""

import ast
import io
import resource
import sys
import xml.parsers.expat  # noqa: F401  (xacro 2.1 uses it without importing it)
from collections.abc import Sequence
from contextlib import redirect_stderr
from pathlib import Path
from types import ModuleType
from typing import IO

from robot_control.files.confinement import confine, limit
from robot_control.files.files import check_input

MAX_INCLUDED = 64 << 20  # bytes
NOT_INSTALLED = 69  # EX_UNAVAILABLE of sysexits.h
MAX_MEMORY = 2 << 30  # bytes; macros that call each other without end reach it
ADMITTED = (
    *(ast.Expression, ast.Constant, ast.Name, ast.Load, ast.Store, ast.Attribute, ast.Subscript, ast.Slice),
    *(ast.Call, ast.keyword, ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp, ast.List, ast.Tuple, ast.Dict),
    *(ast.ListComp, ast.comprehension, ast.JoinedStr, ast.FormattedValue),
    *(ast.operator, ast.unaryop, ast.boolop, ast.cmpop),
)
"""Parts of an expression of values"""
LEADS_FURTHER = {"type", "vars", "mro", "format", "format_map"}
"""Names that lead from a value to its class, and from there to everything"""
LFS_POINTER = b"version https://git-lfs.github.com/spec/"


def package_folder(package: str, file: Path) -> str:
    """Folder of a package.

    Raises:
        LookupError: neither rospkg knows it nor does it lie above the file.
    """
    import rospkg

    try:
        return str(rospkg.RosPack().get_path(package))
    except rospkg.ResourceNotFound:
        for folder in file.resolve().parents:
            if folder.name == package and (folder / "package.xml").is_file():
                return str(folder)
            if (folder / package / "package.xml").is_file():
                return str(folder / package)
    searched = ":".join(rospkg.get_ros_paths()) or "which is not set"
    raise LookupError(f"no package {package} in ROS_PACKAGE_PATH ({searched}), nor above the file")


def answer_find(file: Path) -> None:
    """Lets xacro resolve `$(find …)` by `package_folder`."""
    packages = ModuleType("ament_index_python.packages")
    packages.get_package_share_directory = lambda name: package_folder(name, file)  # type: ignore[attr-defined]
    sys.modules["ament_index_python"] = ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = packages


def note_macros(called: set[str]) -> None:
    """Lets xacro add the name of every macro that it calls."""
    import xacro

    resolve = xacro.resolve_macro

    def resolved(name: str, *tables: object) -> object:
        called.add(name)
        return resolve(name, *tables)

    xacro.resolve_macro = resolved


def require_values(expression: str) -> None:
    """Refuses an expression that could do anything but compute values.

    Raises:
        ValueError: it names the part.
    """
    for node in ast.walk(ast.parse(expression.strip(), mode="eval")):
        name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
        hidden = name.startswith("_" if isinstance(node, ast.Attribute) else "__")
        if not isinstance(node, ADMITTED) or hidden or name in LEADS_FURTHER:
            what = name or type(node).__name__
            raise ValueError(f"{what} is refused in an expression: a robot description only computes values")


def admit_values_alone() -> None:
    """Lets xacro evaluate only what `require_values` admits. An expression in `$(eval …)` can call no function."""
    import xacro

    evaluate = xacro.safe_eval

    def checked(expression: str, *tables: object) -> object:
        require_values(expression)
        return evaluate(expression, *tables)

    xacro.safe_eval = checked


def open_text(name: str, mode: str = "r") -> IO[str]:
    """Replaces `open` in the module xacro: an included file may be no device and no file without end.

    Raises:
        InputFileError, OSError: it names the file.
    """
    if mode == "r":
        check_input(Path(name), MAX_INCLUDED)
    file: IO[str] = Path(name).open(mode)  # noqa: SIM115 (xacro closes it)
    return file


def circle(names: Sequence[str]) -> str:
    """The first ring in what stands within each other, as "a → b → a"; empty where there is none."""
    for end, name in enumerate(names):
        if name in names[:end]:
            return " → ".join(names[names.index(name) : end + 1])
    return ""


def foreign(file: str) -> str:
    """The kind of a file that is no XML text; empty if it may be one."""
    if not Path(file).is_file():
        return ""  # a FIFO would wait for its writer
    try:
        with Path(file).open("rb") as opened:
            start = opened.read(len(LFS_POINTER))
    except OSError:
        return ""
    if start == LFS_POINTER:
        return "it is a git-LFS pointer, not the file itself; fetch it: git lfs pull"
    if start[:2] in (b"\xff\xfe", b"\xfe\xff") or b"\0" in start[:4]:
        return "it is UTF-16, not UTF-8; save it as UTF-8: iconv -f UTF-16 -t UTF-8"
    return ""


def better_reason(said: str, files: Sequence[str], macros: Sequence[str]) -> str:
    """The reason of a failure if xacro's own message does not name it, or is too long; empty otherwise.

    Args:
        said: what xacro wrote.
        files: the files that it was in, each included by the one before.
        macros: likewise the macros.
    """
    if files and (what := foreign(files[-1])):
        return f"{files[-1]}: {what}"
    if "amplification" in said:
        return "its <!ENTITY …> definitions refer to each other without end: replace them with their text"
    if "recursion" not in said:
        return ""
    if ring := circle([Path(file).name for file in files]):
        return f"cycle of included files: {ring}"
    if ring := circle(macros):
        return f"cycle of macro calls: {ring}"
    return ""


def main() -> None:
    """Exits with xacro's own code, or with NOT_INSTALLED."""
    limit(resource.RLIMIT_AS, MAX_MEMORY)
    try:
        import xacro
    except ImportError:
        sys.exit(NOT_INSTALLED)
    admit_values_alone()
    confine()
    answer_find(Path(sys.argv[1]))
    xacro.open = open_text
    called: set[str] = set()
    note_macros(called)
    said = io.StringIO()
    try:
        with redirect_stderr(said):
            xacro.main()
    except SystemExit:
        macros = [macro.body.getAttribute("name") for macro in xacro.macrostack or []]
        sys.stderr.write(better_reason(said.getvalue(), xacro.filestack or [], macros) or said.getvalue())
        raise
    if called:
        print("<!-- xacro macros: " + " ".join(sorted(called)).replace("--", "- -") + " -->")


if __name__ == "__main__":
    main()
