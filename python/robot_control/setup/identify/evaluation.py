"""identify.py without ROS: its command line, and the steps from a log to a table and a YAML."""

import argparse
import math
from pathlib import Path

from robot_control._robot_control import controller_parameters, derived_wheel_loops, wheel_loops
from robot_control._robot_control import describe as describe_robot
from robot_control.data.run_log import Log
from robot_control.files.files import given_path
from robot_control.loop.roles import CONTROLLER
from robot_control.robot.send_plan import number_of_sends, positive
from robot_control.settings.block import Settings
from robot_control.setup.identify.excitation import AxisLimits, Excitation, plan_excitation
from robot_control.setup.identify.fit import identify
from robot_control.setup.identify.report import to_table, warnings
from robot_control.setup.identify.tuning_proposal import base_of, feed_forward, propose
from robot_control.setup.overlay import Outcome, to_yaml

RIM_RESERVE = 0.9
"""Share of a joint's velocity limit; nearer to it the gate reduces the torque."""


def parse_options(arguments: list[str]) -> argparse.Namespace:
    """Reads the command line (without the program's name); ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="identify.py",
        description="Drives ramps and turns on the spot, measures inertia, friction and delay of the wheels, and "
        f"writes feed-forward and gains for {CONTROLLER}.",
    )
    parser.add_argument("--space", type=positive, default=1.0, help="m free ahead of the robot (default %(default)s)")
    parser.add_argument("--max-speed", type=positive, default=0.5, help="m/s, of robot and rims (default %(default)s)")
    parser.add_argument("--repeats", type=number_of_sends, default=2, help="times all moves (default %(default)s)")
    parser.add_argument("--mass", type=positive, help="kg of the robot as it drives, if it was weighed")
    parser.add_argument("--output", type=given_path, default=Path("identified.yaml"), help="(default %(default)s)")
    parser.add_argument("--log", type=given_path, help="run.bag to fit; nothing is driven")
    parser.add_argument("--params", type=given_path, help="parameter file of the log; default: the installed one")
    parser.add_argument("--urdf", type=given_path, help="robot of the log; default: from the parameters")
    given = parser.parse_args(arguments)
    for name in ("params", "urdf"):
        if getattr(given, name) is not None and given.log is None:
            parser.error(f"--{name} needs --log: a running robot reports this itself")
    return given


def plan(settings: Settings, options: argparse.Namespace) -> Excitation:
    """The moves for the robot and limits of `settings`.

    Raises:
        ParameterError, RobotError: of the parameters.
        NoRoomError: the space is too small.
    """
    limits = controller_parameters(settings.path, settings.values)
    loops = wheel_loops(settings.path, settings.values)
    rims = (RIM_RESERVE * loop["velocity_limit"] * loop["radius"] for loop in loops if loop["velocity_limit"] > 0)
    slowest_rim = min(rims, default=math.inf)
    return plan_excitation(
        AxisLimits(**limits["linear"]),
        AxisLimits(**limits["angular"]),
        wheel_base=base_of(describe_robot(settings.path, settings.values)).effective_wheel_base,
        space=options.space,
        max_speed=min(options.max_speed, slowest_rim),
        repeats=options.repeats,
    )


def evaluate(log: Log, settings: Settings, mass: float | None, source: str) -> Outcome:
    """Fits and proposes; `source` names the log in the YAML.

    Raises:
        UnfitError, NoGainsError, ValueError: what the log or the mass does not allow.
        ParameterError, RobotError: of the parameters.
    """
    robot = describe_robot(settings.path, settings.values)
    base = base_of(robot)
    now = wheel_loops(settings.path, settings.values)
    found = identify(log, base)
    forward = feed_forward(found, base, now[0]["lifted"], mass)
    overlaid = [(f"{CONTROLLER}.feed_forward.{key}", repr(value)) for key, value in forward.items()]
    derived = derived_wheel_loops(settings.path, [*settings.values, *overlaid])
    proposal = propose(found, forward, now, derived, weighed=mass is not None)
    table = to_table(found, proposal, robot, now)
    said = warnings(found, proposal)
    head = [
        f"Measured on {robot['name']} by identify.py, {found.seconds:.0f} s of motion, {source}.",
        f"Load it and restart {CONTROLLER}: rosparam load FILE",
        "",
        *table.splitlines(),
        *(f"! {sentence}" for sentence in said),
    ]
    return Outcome(table, said, to_yaml(head, {CONTROLLER: proposal.overlay()}))
