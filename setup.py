"""Called by catkin alone: where the importable packages lie."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

PROGRAMS = (
    "blackbox",
    "calibrate",
    "console",
    "data_return",
    "demo",
    "doctor",
    "drive",
    "estimate",
    "export",
    "fleet",
    "identify",
    "inspect",
    "latency",
    "pad",
    "path",
    "record",
    "render",
    "replay",
    "report",
    "status",
    "teleop",
    "view",
    "why",
)
packages = ["robot_control", "robot_control.fleet.v2"]
packages += [*(f"robot_control.{name}" for name in ("common", "safety", *PROGRAMS))]

data = {"robot_control": ["py.typed", "*.pyi"], "robot_control.console": ["page/*"]}
data["robot_control.fleet"] = ["*.json"]
data["robot_control.fleet.v2"] = ["schemas/*"]
setup(**generate_distutils_setup(packages=packages, package_dir={"": "python"}, package_data=data))
