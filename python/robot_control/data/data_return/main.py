"""The command line of data_return.py."""

import argparse
import sys
from pathlib import Path

import rospy

from robot_control.data.data_return.fetch import verify
from robot_control.data.data_return.node import Node, lower_priority
from robot_control.data.data_return.plan import progress
from robot_control.data.data_return.queue_file import QueueError, QueueFile
from robot_control.data.data_return.remote import RemoteError, require_rclone
from robot_control.data.data_return.settings import RCLONE_CONFIG, Settings, read_settings
from robot_control.files.files import escaped, fit_for_message, given_path, one_message
from robot_control.installed_files import share_file
from robot_control.robot.ros_node import running_node
from robot_control.settings.files import SettingsError


def main() -> int:
    """Entry point of scripts/data_return.py."""
    given = _parser().parse_args([each for each in rospy.myargv()[1:] if each])
    with one_message("data_return.py", SettingsError, QueueError, RemoteError, OSError):
        if given.command in ("fetch", "verify"):
            return 0 if verify(given.source, given.rclone_config, getattr(given, "out", None)) else 1
        settings = read_settings(Path(share_file("config/data_return.yaml")), *([given.config] if given.config else []))
        if given.command == "status":
            _print_status(QueueFile(settings.queue))
        else:
            _run(settings)
    return 0


def _run(settings: Settings) -> None:
    require_rclone()
    queue = QueueFile(settings.queue)
    queue.lock()
    if queue.damage:
        print(f"data_return.py: {fit_for_message(queue.damage)}: all is compared with the far side", file=sys.stderr)
    queue.save()  # a queue that cannot be written is a message before anything runs
    lower_priority()
    with running_node("data_return") as signals:
        Node(settings, queue, signals).run()


def _print_status(queue: QueueFile) -> None:
    if queue.damage:
        raise QueueError(queue.damage)
    for each in queue.entries.values():
        state = "returned" if each.returned else f"{100 * len(each.parts) // each.count} %"
        print(escaped(f"{state:>8}  {each.size / 1e6:9.1f} MB  {each.path}"))
    print(escaped(progress(list(queue.entries.values()), "")))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="data_return.py",
        description="Brings finished runs, incidents and reports to a remote of rclone's, in parts that are verified "
        "there, and puts them together on the other side.",
        epilog="run and status take --config FILE, which is overrides the installed config/data_return.yaml",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    for name, text in (("run", "the node on the robot: sends"), ("status", "what waits and what has returned")):
        command = commands.add_parser(name, help=text, description=text)
        meaning = "YAML file, overrides the installed config/data_return.yaml"
        command.add_argument("--config", type=given_path, help=meaning)
    for name, text in (
        ("verify", "checks every part that robots have sent; exit code 1: there is a gap"),
        ("fetch", "verify, and puts each file together that is whole"),
    ):
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("source", metavar="FAR_SIDE", help="a folder, or as far_side: factory:robots")
        command.add_argument("--rclone-config", default=RCLONE_CONFIG, metavar="FILE", help="default: %(default)s")
        if name == "fetch":
            command.add_argument("out", type=given_path, metavar="OUT", help="folder for the files")
    return parser
