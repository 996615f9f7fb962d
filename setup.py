"""Called by catkin alone: where the importable packages lie."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import find_packages, setup

packages = find_packages("python")
data = {"robot_control": ["py.typed", "*.pyi"], "robot_control.watch.console": ["page/*"]}
data |= {"robot_control.fleet.v2": ["schemas/*"], "robot_control.ui": ["*.mplstyle"]}
setup(**generate_distutils_setup(packages=packages, package_dir={"": "python"}, package_data=data))
