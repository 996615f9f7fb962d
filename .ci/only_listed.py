#!/usr/bin/python3
"""Runs a command as if only the packages of the dependency list and what they depend on were installed.

    .ci/only_listed.py [--list FILE] [--section NAME]… COMMAND…

In a mount namespace of the command's own, /usr is read-only. It shows nothing of /usr/local and nothing that other
packages alone have installed. The installed packages and other processes notice nothing. Needs root and overlayfs:
exit code 125 where they are not granted, else that of the command.
"""

import argparse
import ctypes
import os
import re
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

LIST = Path(__file__).parents[1] / "scripts/shell/dependencies.txt"
STATUS = Path("/var/lib/dpkg/status")
FILES = Path("/var/lib/dpkg/info")
NEW_NAMESPACE = 0x00020000
"""CLONE_NEWNS, sched.h"""
CACHE = "/etc/ld.so.cache"
REFUSED = 125
NAME = "only_listed"
"""of the overlay in /proc/mounts"""

Package = dict[str, str]


def listed(path: Path, sections: list[str]) -> list[str]:
    """Debian packages of the list before its first section, and of these sections."""
    wanted, names = True, []
    for line in path.read_text().splitlines():
        if line.startswith("["):
            wanted = line.strip("[] ") in sections
        elif wanted and re.match(r"[a-z0-9][a-z0-9+.-]+(\s|$)", line):
            names.append(line.split()[0])
    return names


def installed() -> dict[str, Package]:
    """Packages by name, each as the fields of dpkg's status file."""
    packages = {}
    for paragraph in STATUS.read_text().split("\n\n"):
        fields = dict(re.findall(r"^([\w-]+): (.*)$", paragraph, re.MULTILINE))
        if fields.get("Status", "").endswith(" installed"):
            packages[fields["Package"]] = fields
    return packages


def names_of(relation: str) -> list[str]:
    """The alternatives of one relation: "a (>= 1) | b:any" is a, b."""
    return [re.split(r"[\s:(]", alternative.strip())[0] for alternative in relation.split("|")]


def closure(names: list[str], packages: dict[str, Package]) -> set[str]:
    """Names of the installed packages that every Debian has, of apt, of `names`, and of all that these depend on.

    Among alternatives the first installed one counts, as for apt; a name that a package provides is its name, too.

    Raises:
        LookupError: one of the names is not installed.
    """
    providers: dict[str, list[str]] = {}
    for name, fields in packages.items():
        for provided in [name, *(names_of(one)[0] for one in fields.get("Provides", "").split(",") if one)]:
            providers.setdefault(provided, []).append(name)
    if absent := [name for name in names if name not in providers]:
        raise LookupError(f"not installed: {' '.join(absent)}; scripts/setup installs what the list names")
    always = [name for name, of in packages.items() if of.get("Essential") == "yes" or of.get("Priority") == "required"]
    found: set[str] = set()
    waiting = [*always, "apt", *names]
    while waiting:
        name = waiting.pop()
        if name not in packages:
            waiting.append(providers[name][0])
        elif name not in found:
            found.add(name)
            for field in ("Depends", "Pre-Depends"):
                for relation in packages[name].get(field, "").split(","):
                    waiting += [one for one in names_of(relation) if one in providers][:1]
    return found


def paths_of(package: str, fields: Package) -> set[str]:
    """Files and folders that a package has below /usr, /bin and /lib being links into it."""
    lists = [FILES / f"{package}.list", FILES / f"{package}:{fields.get('Architecture')}.list"]
    text = next((path.read_text() for path in lists if path.exists()), "")
    paths = {re.sub(r"^/(bin|sbin|lib\w*)/", r"/usr/\1/", path) for path in text.splitlines()}
    return {path for path in paths if path.startswith("/usr/")}


def hide(paths: set[str], layer: Path) -> None:
    """Fills an overlay's upper layer: a device 0, 0 stands for a file of /usr, or a whole folder, that is not there."""
    hidden, made = "none yet", set()
    for path in sorted([*paths, "/usr/local"], key=lambda path: path.split("/")):
        if os.path.lexists(path) and not f"{path}/".startswith(f"{hidden}/"):
            hidden, mark = path, layer / path.removeprefix("/usr/")
            if mark.parent not in made:
                mark.parent.mkdir(parents=True, exist_ok=True)
                made.add(mark.parent)
            os.mknod(mark, stat.S_IFCHR)


def mount(*arguments: str) -> None:
    """Calls the program mount."""
    subprocess.run(["/bin/mount", *arguments], check=True)


def enter(paths: set[str]) -> None:
    """Moves this process into a namespace without the paths.

    Raises:
        OSError, subprocess.CalledProcessError: the machine does not grant it.
    """
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(NEW_NAMESPACE) != 0:
        raise OSError(ctypes.get_errno(), "unshare")
    mount("--make-rprivate", "/")
    while re.search(rf"^{NAME} /usr ", Path("/proc/self/mounts").read_text(), re.MULTILINE):
        subprocess.run(["/bin/umount", "--lazy", CACHE, "/usr"], check=True)  # of a call around this one
    layer = Path(tempfile.mkdtemp(prefix=f"{NAME}-"))
    mount("-t", "tmpfs", "-o", "mode=755", NAME, str(layer))
    hide(paths, layer)
    mount("-t", "overlay", "-o", f"lowerdir={layer}:/usr", NAME, "/usr")
    subprocess.run(["/bin/umount", "--lazy", str(layer)], check=True)
    layer.rmdir()
    with tempfile.NamedTemporaryFile(prefix=f"{NAME}-") as libraries:  # else the hidden ones still stand in it
        subprocess.run(["/sbin/ldconfig", "-X", "-C", libraries.name], check=True)
        mount("--bind", libraries.name, CACHE)


def main() -> None:
    """Entry point."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", type=Path, default=LIST, help="the dependency list (default: that of scripts/setup)")
    parser.add_argument("--section", action="append", default=[], help="a section of the list that counts as well")
    parser.add_argument("--package", action="append", default=[], help="a package that counts as well")
    parser.add_argument("command", nargs=argparse.REMAINDER)
    given = parser.parse_args()
    packages = installed()
    try:
        kept = closure([*listed(given.list, given.section), *given.package], packages)
        others = {path for name in packages.keys() - kept for path in paths_of(name, packages[name])}
        enter(others - {path for name in kept for path in paths_of(name, packages[name])})
    except LookupError as error:
        sys.exit(f"only_listed.py: {error}")
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"only_listed.py: {error}; run it as root, in a container with --cap-add SYS_ADMIN", file=sys.stderr)
        sys.exit(REFUSED)
    os.execvp(given.command[0], given.command)


if __name__ == "__main__":
    main()
