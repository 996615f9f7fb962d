"""The command line of export.py."""

import argparse
import sys

from robot_control._robot_control import BagError
from robot_control.data.csv_table import write_csv
from robot_control.data.export.mcap_file import write_mcap
from robot_control.data.run_log import LogError, is_bag
from robot_control.files.files import NewFiles, escaped, fit_for_message, given_path, in_words
from robot_control.files.output_files import check_outputs

EPILOG = """
--csv     the table run.csv: a row per cycle, columns with the names of msg/Trace.msg; outputs with the precision of
          float32
--mcap    every message as it is, for Foxglove; of any ROS 1 bag. Of a run.bag also odom, tf, joint_states, cmd_vel and
          the URDF. Needs PyPI's mcap
--topics  odom, tf, joint_states and cmd_vel, for `rosbag play --clock` and RViz, of the last run
"""

REFUSALS = (OSError, ValueError, RuntimeError)


def main(arguments: list[str] | None = None) -> None:
    """Entry point of scripts/export.py: exit code 0 with everything written, else 1 with one message, and nothing."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if (options.csv, options.mcap, options.topics) == (None, None, None):
        parser.error("no output: set --csv, --mcap or --topics")
    try:
        if not is_bag(options.input):
            raise LogError(f"{options.input} is not a ROS bag")
        check_outputs([options.csv, options.mcap, options.topics], [options.input])
        cuts = []
        with NewFiles() as files:
            if options.csv is not None:
                cuts.append(write_csv(options.input, files.name(options.csv)))
            if options.mcap is not None:
                cuts.append(write_mcap(options.input, files.name(options.mcap)))
            if options.topics is not None:
                from robot_control.data.export.topics import write_topics

                cuts.append(write_topics(options.input, files.name(options.topics)))
        if any(cuts):
            print(escaped(f"export.py: {options.input}: {max(cuts)}"), file=sys.stderr)
    except BagError as error:
        sys.exit(f"export.py: {fit_for_message(f'{options.input}: {error}')}")
    except REFUSALS as error:
        sys.exit(f"export.py: {fit_for_message(in_words(error))}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="export.py",
        description="Turns a log of every cycle, run.bag, into other formats.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("input", type=given_path, help="run.bag")
    parser.add_argument("--csv", type=given_path, metavar="OUT.csv")
    parser.add_argument("--mcap", type=given_path, metavar="OUT.mcap")
    parser.add_argument("--topics", type=given_path, metavar="OUT.bag")
    return parser
