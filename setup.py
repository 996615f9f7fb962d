"""Called by catkin alone: where the importable packages lie."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

PROGRAMS = (
    "calibrate",
    "demo",
    "drive",
    "estimate",
    "identify",
    "inspect",
    "pad",
    "path",
    "record",
    "teleop",
    "view",
    "why",
)
packages = ["robot_control", *(f"robot_control.{name}" for name in ("common", *PROGRAMS))]

setup(**generate_distutils_setup(packages=packages, package_dir={"": "scripts"}))
