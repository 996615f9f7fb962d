"""Optional packages of PyPI, in environments of their own beside Debian's."""

import sys
from pathlib import Path

from robot_control._robot_control import project_folder


def use_packages(section: str) -> None:
    """Makes the packages importable that `scripts/setup --SECTION` has installed, if there are any."""
    packages = Path(project_folder, "build", section, "lib")
    for path in map(str, packages.glob("python3.*/site-packages")):
        if path not in sys.path:
            sys.path.append(path)
