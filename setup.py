"""Called by catkin alone: where the importable packages lie."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_namespace_packages, setup

# Folders of data as well, which setuptools else wants to be named. It reads [project] of pyproject.toml.
packages = find_namespace_packages("python", include=["robot_control*"], exclude=["*.__pycache__"])
data = {"robot_control": ["py.typed", "*.pyi"], "robot_control.watch.console": ["page/*"]}
data |= {"robot_control.fleet.v2": ["schemas/*"], "robot_control.ui": ["*.mplstyle"]}
data |= {"robot_control.watch.words": ["*.yaml"]}
setup(**generate_distutils_setup(packages=packages, package_dir={"": "python"}, package_data=data))
