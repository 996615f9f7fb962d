"""inspect_robot.py reports how a robot description is understood."""

import argparse
import json
import sys

from robot_control._robot_control import DriverError, ParameterError
from robot_control.files.files import escaped, fit_for_message, given_path, one_message, write_text
from robot_control.files.output_files import check_outputs
from robot_control.setup.description import Description, describe, mjcf, stand
from robot_control.setup.inspect.report import report
from robot_control.ui.picture_file import check_picture


def main(arguments: list[str] | None = None) -> None:
    """Prints the report; exits with 1 and one message when the robot is refused, does not stand or cannot be driven."""
    options = _parser().parse_args(arguments)

    fallen = None
    with one_message("inspect_robot.py", DriverError, OSError, ValueError):
        check_outputs([options.mjcf, options.picture], [options.file, options.params])
        if options.picture is not None:
            check_picture(options.picture)
        robot = describe(options.file, options.params)
        if options.mjcf is not None:
            write_text(options.mjcf, mjcf(options.file, options.params))
        if options.picture is not None:
            from robot_control.setup.inspect.picture import draw_robot

            draw_robot(robot, options.picture)
        try:
            robot["standing"] = stand(options.file, options.params)
        except DriverError as error:
            fallen = f"it does not stand: {error}"
        except ParameterError as error:
            fallen = f"it cannot be driven: {error}"
    print(_json(robot) if options.json else report(robot))
    for written in (options.mjcf, options.picture):
        if written is not None:
            print(escaped(f"wrote {written}"), file=sys.stderr)
    if fallen is not None:
        sys.exit(f"inspect_robot.py: understood, but {fit_for_message(fallen)}")


def _parser() -> argparse.ArgumentParser:
    what = "Says what is understood of a robot description: wheels, sides, sizes, masses, and what was assumed"
    parser = argparse.ArgumentParser(prog="inspect_robot.py", description=f"{what}, repaired or ignored.")
    parser.add_argument("file", type=given_path, help="URDF, or .xacro")
    meaning = "parameter file; its robot: block lies over the URDF"
    parser.add_argument("--params", type=given_path, metavar="YAML", help=meaning)
    parser.add_argument("--json", action="store_true", help="the same as JSON")
    parser.add_argument("--mjcf", type=given_path, metavar="OUT.xml", help="write the model that MuJoCo simulates")
    parser.add_argument("--picture", type=given_path, metavar="OUT.png", help="draw the robot")
    return parser


def _json(robot: Description) -> str:
    """The robot as JSON, without the corners of meshes."""
    shapes = [
        {key: value for key, value in shape.items() if key not in ("points", "triangles")} for shape in robot["shapes"]
    ]
    return json.dumps(robot | {"shapes": shapes}, indent=2, ensure_ascii=False)
