"""first_steps.py: the steps in their order, the bag and the summary."""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

import rospy
from roslib.packages import find_node

from robot_control.files.files import given_path, one_message
from robot_control.robot.ros_master import require_master
from robot_control.robot.ros_node import begin_node
from robot_control.robot.running_robot import RefusedError, master_state, other_senders
from robot_control.robot.server_values import described_robot
from robot_control.robot.topic_sender import ended_by_signals
from robot_control.setup.description import describe
from robot_control.setup.first_steps.checks import StepError
from robot_control.setup.first_steps.robot import WatchedRobot
from robot_control.setup.first_steps.steps import STEPS, Context
from robot_control.setup.terminal_dialog import NoAnswerError, Questions
from robot_control.ui.child import Child, children
from robot_control.ui.table import table

RECORDING = 10.0
"""s until the recorder has opened its bag"""
STOPPED = "The robot is stopped, until rosservice call e_stop_reset."
NOT_STOPPED = "THE STOP WAS NOT CONFIRMED: press the emergency stop."


def parse_options(arguments: Sequence[str]) -> argparse.Namespace:
    """Reads the command line (without the program's name); ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="first_steps.py",
        description="Leads through the first contact with a robot on legs that runs, step by step, and records a bag. "
        "Ends at the first step that fails. At its end, also by Ctrl-C, the robot is stopped until e_stop_reset.",
    )
    parser.add_argument("--list", action="store_true", help="shows the steps and ends")
    parser.add_argument("--from", dest="begin", choices=STEPS, default="hang", help="first step (default %(default)s)")
    parser.add_argument("--out", type=given_path, default="first_steps", help="folder of the bag (default %(default)s)")
    return parser.parse_args(arguments)


def _recorder(folder: Path) -> Child:
    folder.mkdir(parents=True, exist_ok=True)
    program = find_node("robot_control", "record.py")[0]
    return Child([program, str(folder), f"__ns:={rospy.get_namespace()}"], folder / "record.log")


def _bags(folder: Path, began: float) -> list[Path]:
    return [path for path in folder.rglob("*.bag*") if path.stat().st_mtime >= began]


@one_message("first_steps.py", RefusedError, StepError, OSError, ValueError)
def main() -> None:
    """Entry point of scripts/first_steps.py: exit code 0 if all steps passed, else 1 with one message."""
    options = parse_options(rospy.myargv()[1:])
    if options.list:
        print("\n".join(table([(name, shows) for name, (shows, _) in STEPS.items()])))
        return
    require_master()
    begin_node("first_steps", anonymous=True)
    steps = list(STEPS)[list(STEPS).index(options.begin) :]
    began, results = time.time(), dict.fromkeys(steps, "not done")
    with ended_by_signals() as signals, children() as started:
        robot = WatchedRobot(signals)
        if others := other_senders(master_state()):
            raise RefusedError(f"{', '.join(others)} may also command the robot: end it, or run rosnode cleanup")
        started.append(_recorder(options.out))
        if not robot.wait(lambda: _bags(options.out, began), RECORDING):
            raise RefusedError(f"no bag is recorded: read {options.out}/record.log")
        print("Ctrl-C stops the robot and ends.")
        with described_robot() as (parameters, urdf):
            context = Context(robot, Questions(signals.going_on), parameters, urdf, describe(urdf, parameters))
            try:
                step, why = take(steps, context, results)
            finally:
                stopped = robot.stop()
                print(f"\n{STOPPED if stopped else NOT_STOPPED}")
    print("\n".join(table([("step", "result"), *results.items()])))
    print(f"bag: {next(iter(_bags(options.out, began)), f'none in {options.out}, read record.log there')}")
    if why:
        raise StepError(f"{step}: {why}. To continue: rosrun robot_control first_steps.py --from {step}")


def take(steps: Sequence[str], context: Context, results: dict[str, str]) -> tuple[str, str]:
    """Takes the steps and writes their results; returns the last one, and why it failed, or ""."""
    for number, step in enumerate(steps, 1):
        print(f"step {number} of {len(steps)}, {step}: {STEPS[step][0]}")
        try:
            STEPS[step][1](context)
        except (StepError, NoAnswerError) as error:
            results[step] = "failed"
            return step, str(error)
        results[step] = "passed"
    return steps[-1], ""
