#!/usr/bin/python3
"""Runs the cases of NAME_test.py: run_cases.py NAME… Several files share one robot, whose start costs more than most of
their cases.
"""

import contextlib
import importlib
import sys
import unittest
from collections.abc import Iterable, Iterator
from pathlib import Path

import rospy
import rostest
from system.legs.legs_support import LegsTestCase
from system.system_support import Robot, RobotTestCase

NAMES = [argument for argument in sys.argv[1:] if argument.isidentifier()]
HERE = Path(__file__).parent


def cases(name: str) -> dict[str, type[unittest.TestCase]]:
    """The test classes of NAME_test.py."""
    (path,) = HERE.rglob(f"{name}_test.py")
    module = importlib.import_module(f"system.{path.parent.name}.{path.stem}")
    found = {each for each in vars(module).values() if isinstance(each, type) and each.__module__ == module.__name__}
    return {each.__name__: each for each in found if issubclass(each, unittest.TestCase)}


@contextlib.contextmanager
def shared_robot(classes: Iterable[type[unittest.TestCase]]) -> Iterator[None]:
    """A block in which these classes have one robot, with the parameters of all."""
    LegsTestCase.shared = True
    RobotTestCase.shared = robot = Robot()
    for each in classes:
        for name, value in each.parameters if issubclass(each, RobotTestCase) else ():
            rospy.set_param(name, value)
    try:
        yield
    finally:
        robot.end()
        LegsTestCase.end_launch()


def main() -> None:
    """Entry point; the classes become those of this module, where rostest looks for them."""
    classes = {name: each for file in NAMES for name, each in cases(file).items()}
    globals().update(classes)
    rospy.init_node(f"{NAMES[0]}_test", anonymous=True, disable_signals=True)  # SIGINT stays with unittest
    with shared_robot(classes.values()) if len(NAMES) > 1 else contextlib.nullcontext():
        rostest.rosrun("robot_control", f"{'_'.join(NAMES)}_test", "__main__")


if __name__ == "__main__":
    main()
