"""inspect_robot.py reports how a robot description is understood."""

import argparse
import json
import sys

from robot_control._robot_control import DriverError, ParameterError, RobotError
from robot_control.files.files import escaped, fit_for_message, given_path, one_message, write_text
from robot_control.files.output_files import check_outputs
from robot_control.setup.description import Description, describe, mjcf, stand
from robot_control.setup.inspect.report import report
from robot_control.ui.picture_file import check_picture

REFUSALS = (DriverError, ParameterError, RobotError)
REFUSED = "inspect_robot.py: refused"


def main(arguments: list[str] | None = None) -> None:
    """Prints the report. If a loop refuses the robot, the loop's sentence comes first, and the exit code is 1."""
    options = _parser().parse_args(arguments)

    refused = ""
    with one_message("inspect_robot.py", DriverError, OSError, ValueError):
        check_outputs([options.mjcf, options.picture], [options.file, options.params])
        if options.picture is not None:
            check_picture(options.picture)
        with one_message(REFUSED, *REFUSALS):
            robot = describe(options.file, options.params)
        try:
            robot["standing"] = stand(options.file, options.params)
        except REFUSALS as error:
            robot["refused"] = refused = fit_for_message(str(error))
            print(f"{REFUSED}: {refused}", file=sys.stderr)
        if options.mjcf is not None:
            write_text(options.mjcf, mjcf(options.file, options.params))
        if options.picture is not None:
            from robot_control.setup.inspect.picture import draw_robot

            draw_robot(robot, options.picture)
    print(_json(robot) if options.json else report(robot))
    for written in (options.mjcf, options.picture):
        if written is not None:
            print(escaped(f"wrote {written}"), file=sys.stderr)
    if refused:
        sys.exit(1)


def _parser() -> argparse.ArgumentParser:
    what = "Reports how a robot description is understood: wheels, sides, sizes, masses, and all assumptions"
    parser = argparse.ArgumentParser(prog="inspect_robot.py", description=f"{what}, repaired or ignored.")
    parser.add_argument("file", type=given_path, help="URDF, or .xacro")
    meaning = "parameter file; its robot: block lies over the URDF"
    parser.add_argument("--params", type=given_path, metavar="YAML", help=meaning)
    parser.add_argument("--json", action="store_true", help="the same as JSON")
    parser.add_argument("--mjcf", type=given_path, metavar="OUT.xml", help="write the model that MuJoCo simulates")
    parser.add_argument(
        "--picture", type=given_path, metavar="OUT.png", help="draw the robot, one on legs lying and standing"
    )
    return parser


def _json(robot: Description) -> str:
    """The robot as JSON, without the corners of meshes."""
    shapes = [
        {key: value for key, value in shape.items() if key not in ("points", "triangles")} for shape in robot["shapes"]
    ]
    return json.dumps(robot | {"shapes": shapes}, indent=2, ensure_ascii=False)
