"""A .xacro file on standard output as the URDF it stands for: python3 -m robot_control.expand_xacro FILE.

PyPI's xacro asks ROS 2's package index for `$(find PACKAGE)`, through the module `ament_index_python.packages`. Here
that module is ours: rospkg answers, then the folders above the file.
"""

import sys
import xml.parsers.expat  # noqa: F401  (xacro 2.1 uses it without importing it)
from pathlib import Path
from types import ModuleType

NOT_INSTALLED = 69  # EX_UNAVAILABLE of sysexits.h


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
    """Lets `$(find …)` ask `package_folder`."""
    packages = ModuleType("ament_index_python.packages")
    packages.get_package_share_directory = lambda name: package_folder(name, file)  # type: ignore[attr-defined]
    sys.modules["ament_index_python"] = ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = packages


def main() -> None:
    """Exits with xacro's own code, or with NOT_INSTALLED."""
    try:
        import xacro
    except ImportError:
        sys.exit(NOT_INSTALLED)
    answer_find(Path(sys.argv[1]))
    xacro.main()


if __name__ == "__main__":
    main()
