"""The ROS side of zero_joints.py: reports of the joints, the drive file, and the words for each turn."""

import argparse
import datetime
import math
import time
from collections.abc import Sequence
from pathlib import Path

import rosgraph
import rospy
import yaml  # type: ignore[import-untyped]
from sensor_msgs.msg import JointState

from robot_control.files.files import given_path, one_message, write_text
from robot_control.files.output_files import check_outputs
from robot_control.robot.boundary import Latest
from robot_control.robot.process_start import process_began
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.ros_master import process_of
from robot_control.robot.ros_node import begin_node
from robot_control.robot.running_robot import RefusedError, await_all
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.server_values import described_robot, server_text
from robot_control.robot.topic_sender import Signals, ended_by_signals
from robot_control.setup.foot_motions import foot_motions
from robot_control.setup.terminal_dialog import NoAnswerError, Questions
from robot_control.setup.zero_joints.dialog import NotFoundError, Zeroed, find_zeros
from robot_control.setup.zero_joints.drive_file import FileJoint, read_joints, robot_of, with_values

REST = 0.5
"""s in which no joint may move"""
STILL = 0.02
"""rad within that time; a hand that holds a joint trembles"""
PATIENCE = 20.0
"""s until the joints have to rest"""
PERIOD = 0.02
LOST = ("driver_lost", "driver_fault", "encoders_lost", "machine_not_ready")
"""causes of a stop after which the angle of a joint may be its last one"""


class RestingRobot:
    """Receives joint_states and safety_status."""

    def __init__(self, signals: Signals) -> None:
        self._signals, self._joints, self._watch = signals, Latest("joint_states", JointState), SafetyWatch()
        await_all(lambda: self._joints.message is not None and self._watch.message is not None, signals)
        if self._joints.message is None or self._watch.message is None:
            raise RefusedError("no joint_states or no safety_status came: start the robot first. Nothing was written")
        self.names = list(self._joints.message.name)

    def angles(self) -> Sequence[float]:
        """rad, once no joint has moved for REST."""
        end, begin, first = time.monotonic() + PATIENCE, time.monotonic(), self._read()
        while time.monotonic() - begin < REST:
            time.sleep(PERIOD)
            now = self._read()
            if max(abs(a - b) for a, b in zip(now, first, strict=True)) > STILL:
                begin, first = time.monotonic(), now
            if time.monotonic() > end:
                raise RefusedError("the joints do not rest. Nothing was written")
        return self._read()

    def _read(self) -> Sequence[float]:
        if not self._signals.going_on():
            raise RefusedError("interrupted. Nothing was written")
        if self._watch.drivable() is not False:
            why = "safety_status is silent" if self._watch.drivable() is None else "the robot is released"
            raise RefusedError(f"{why}: stop it (rosservice call e_stop_trigger), and begin again. Nothing was written")
        causes = [] if self._watch.message is None else self._watch.message.causes
        if lost := [cause for cause in causes if cause in LOST]:
            raise RefusedError(
                f"{', '.join(lost)}: a joint may show an old angle; mend it, call e_stop_reset, "
                "stop the robot (e_stop_trigger), and begin again. Nothing was written"
            )
        message, received_at = self._joints.newest
        if time.monotonic() - received_at > REST:
            raise RefusedError("joint_states is silent: do driver and estimator run? Nothing was written")
        angles: Sequence[float] = message.position
        return angles


def parse_options(arguments: Sequence[str]) -> argparse.Namespace:
    """Reads the command line (without the program's name); ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="zero_joints.py",
        description="Finds the zeros and the signs of the joints of a robot that was not released. A user turns each "
        "joint by hand, then the robot lies in a known posture. Writes offset and direction into the drive file.",
    )
    parser.add_argument("--drives", type=given_path, help="drive file (default: that the running robot uses)")
    parser.add_argument("--angles", type=given_path, help="YAML, joint: rad, of the posture (default: start_angle)")
    parser.add_argument("--robot", default="", help="name or serial number, which is written into the file")
    return parser.parse_args(arguments)


def known_angles(given: Sequence[FileJoint], names: Sequence[str], path: Path | None) -> list[float]:
    """rad, of the posture: of a file, else of the drive file. Raises RefusedError."""
    stated = {name: joint.start_angle for name, joint in zip(names, given, strict=True)}
    if path is not None:
        try:
            stated = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
        except yaml.YAMLError as error:
            raise RefusedError(f"{path}: this is not YAML: {error}") from None
    angles = [stated.get(name) if isinstance(stated, dict) else None for name in names]
    wrong = [name for name, angle in zip(names, angles, strict=True) if not _is_angle(angle)]
    if wrong:
        where = path or "start_angle of the drive file"
        raise RefusedError(f"{where}: no angle in rad of {', '.join(wrong)}; state it, or name a file with --angles")
    return [float(angle) for angle in angles if angle is not None]


def _is_angle(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def require_older(path: Path) -> None:
    """Refuses a file that was changed after the driver of this computer read it, or whose driver does not run here."""
    driver = rospy.resolve_name(running_kind().driver)
    try:
        age = time.monotonic() - process_began(process_of(driver) or "")
    except OSError:
        raise RefusedError(f"{driver} does not run on this computer: start the tool there") from None
    if time.time() - path.stat().st_mtime < age:
        raise RefusedError(f"{path} was changed after the driver started: restart the driver, and begin again")


@one_message("zero_joints.py", RefusedError, NoAnswerError, NotFoundError, OSError, ValueError)
def main() -> None:
    """Entry point of scripts/zero_joints.py: exit code 0 with the drive file written, else 1 with one message."""
    options = parse_options(rospy.myargv()[1:])
    if not rosgraph.is_master_online():
        raise RefusedError(f"no ROS master at {rosgraph.get_master_uri()}: start the robot first")
    begin_node("zero_joints", anonymous=True)
    with ended_by_signals() as signals:
        path = options.drives or given_path(server_text("robot/drives", "the path of a drive file"))
        if options.drives is None and not server_text("robot/drives", "the path of a drive file"):
            raise RefusedError("the running robot has no drive file (robot.drives): name one with --drives")
        check_outputs([path])
        text = path.read_text(encoding="utf-8")
        if options.robot and robot_of(text) not in ("", options.robot):
            raise RefusedError(f"{path} holds the offsets of {robot_of(text)}: copy it for {options.robot}")
        robot = RestingRobot(signals)
        given = read_joints(text, robot.names)
        require_older(path)
        with_values(text, {name: {"offset": each.offset} for name, each in zip(robot.names, given, strict=True)})
        angles = known_angles(given, robot.names, options.angles)
        with described_robot() as (_, urdf):
            words = foot_motions(urdf, angles, robot.names)
        joints = [Zeroed(*each) for each in zip(robot.names, given, angles, words, strict=True)]
        found = find_zeros(joints, robot, Questions(signals.going_on))
    if path.read_text(encoding="utf-8") != text:
        raise RefusedError(f"{path} was changed meanwhile: begin again. Nothing was written")
    date = datetime.date.today().isoformat()
    write_text(path, with_values(text, found, options.robot or robot_of(text), date))
    print(f"wrote {path}: restart the driver")
