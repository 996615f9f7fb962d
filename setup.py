"""Called by catkin alone: where the importable package lies."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["robot_control"], package_dir={"": "scripts"}))
