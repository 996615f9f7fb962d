"""identify.py's ROS side: reads the robot's parameters, drives the plan, stops whenever something is not as planned."""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import rosgraph
import rospy

from robot_control import ParameterError, RobotError
from robot_control.closed_loop import leaves
from robot_control.excitation import Excitation, NoRoomError
from robot_control.excitation_watch import Pose, hindrance, interruption, moves
from robot_control.identification_rows import UnfitError
from robot_control.identify import Options, Settings, evaluate, parse_options, plan
from robot_control.identify_log import RecordingError, recording
from robot_control.identify_robot import RunningRobot
from robot_control.run_log import FloatArray, LogError, read_log
from robot_control.share import share_file
from robot_control.topic_sender import Signals, ended_by_signals
from robot_control.tuning_proposal import NoGainsError
from robot_control.why_facts import COMMAND_TOPICS, nodes_of, senders_of
from robot_control.why_node import Master

PERIOD = 0.05
"""s between two commands: 25 are lost before the default cmd_vel_timeout"""
PATIENCE = 5.0
"""s to hear everybody; each node reports once per second"""
CONTROLLER = "diff_drive_controller"


class RefusedError(RuntimeError):
    """It cannot be begun, or had to end; the message says why."""


REFUSALS = (
    RefusedError,
    NoRoomError,
    UnfitError,
    NoGainsError,
    RecordingError,
    LogError,
    ParameterError,
    RobotError,
    OSError,
    ValueError,
)


def main() -> None:
    """Entry point of scripts/identify.py: exit code 0 with a YAML written, else 1 with one message."""
    options = parse_options(rospy.myargv(sys.argv)[1:])
    try:
        if options.log is not None:
            _fit(dict(read_log(options.log)), _settings_of_files(options), options, f"log {options.log.name}")
        else:
            with _running() as settings:
                with ended_by_signals() as signals:
                    log = _drive(settings, options, signals)
                _fit(log, settings, options, "driven")
    except REFUSALS as error:
        sys.exit(f"identify.py: {error}")


def _fit(log: dict[str, FloatArray], settings: Settings, options: Options, source: str) -> None:
    outcome = evaluate(log, settings, options.mass, source)
    print(outcome.table)
    for sentence in outcome.warnings:
        print(f"! {sentence}")
    options.output.write_text(outcome.yaml)
    print(f"wrote {options.output}: rosparam load it, then start {CONTROLLER} anew")


def _settings_of_files(options: Options) -> Settings:
    path = str(options.params or share_file("config/robot_params.yaml"))
    return Settings(path, () if options.urdf is None else (("robot.urdf", str(options.urdf.absolute())),))


@contextmanager
def _running() -> Iterator[Settings]:
    """The running controller's parameters: file, server, robot_description, as the nodes read them."""
    if not rosgraph.is_master_online():
        raise RefusedError(
            f"no ROS master at {rosgraph.get_master_uri()}: start the robot (roslaunch robot_control sim.launch), "
            "or fit a log with --log"
        )
    rospy.init_node("identify", anonymous=True)
    if rospy.get_param("/use_sim_time", default=False):
        raise RefusedError(
            "the robot runs in simulated time, where a wall-clock second is many: use clock wall, or fit the log of a "
            "command_script with --log"
        )
    path = rospy.get_param(f"{CONTROLLER}/config", share_file("config/robot_params.yaml"))
    own = {key: value for key, value in rospy.get_param(CONTROLLER, {}).items() if key not in ("config", "urdf")}
    values = [*leaves({"robot": rospy.get_param("robot", {})}), *leaves({CONTROLLER: own})]
    described = rospy.get_param("robot_description", "")
    with tempfile.TemporaryDirectory(prefix="identify-") as folder:
        if described and "robot.urdf" not in dict(values):
            (Path(folder) / "robot.urdf").write_text(described)
            values.append(("robot.urdf", str(Path(folder) / "robot.urdf")))
        yield Settings(path, tuple(values))


def _drive(settings: Settings, options: Options, signals: Signals) -> dict[str, FloatArray]:
    excitation = plan(settings, options)
    robot = RunningRobot()
    senders, telemetry = _others(robot, signals)
    look = robot.look(senders)
    reason = hindrance(look)
    if reason:
        raise RefusedError(f"{reason}. Nothing was driven")
    running = ""
    if telemetry:
        _wait(lambda: any(name in robot.logs for name in telemetry), signals)
        running = next((robot.logs[name] for name in telemetry if name in robot.logs), "")
        if not running:
            raise RefusedError(f"{telemetry[0]} runs, but does not say where it writes; end it. Nothing was driven")
    with recording(running, settings.path, signals.going_on) as log:
        print(
            f"driving {excitation.seconds:.0f} s: up to {excitation.linear:.2f} m/s, {excitation.reach:.2f} m ahead "
            f"and back, then turns on the spot, up to {excitation.angular:.2f} rad/s. Ctrl-C stops",
            flush=True,
        )
        _follow(robot, excitation, signals)
        return log.read()


def _others(robot: RunningRobot, signals: Signals) -> tuple[tuple[str, ...], list[str]]:
    """Who else may send commands, and which telemetry runs; waits until the robot was heard."""
    _wait(lambda: robot.listened_to() and robot.look().pose is not None and bool(robot.look().state), signals)
    state = Master(rospy.get_name()).state()
    if state is None:
        raise RefusedError("the ROS master does not answer. Nothing was driven")
    if not robot.listened_to():
        raise RefusedError(f"nobody listens on {rospy.resolve_name('cmd_vel')}: does {CONTROLLER} run?")
    senders = senders_of(state[0], map(rospy.resolve_name, COMMAND_TOPICS), rospy.get_name())
    return senders, sorted(nodes_of(state) & {rospy.resolve_name("telemetry")})


def _wait(condition: Callable[[], bool], signals: Signals) -> None:
    """Until it holds, at most PATIENCE."""
    end = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < end and signals.going_on():
        time.sleep(0.02)


def _follow(robot: RunningRobot, excitation: Excitation, signals: Signals) -> None:
    """Sends the plan; whatever happens, a zero is the last thing sent."""
    start = robot.look().pose or Pose(0.0, 0.0, 0.0)  # hindrance has seen one
    unanswered = 0.0  # s
    try:
        for move in excitation.moves:
            begin = now = time.monotonic()
            while now - begin < move.seconds:
                look = robot.look()
                unanswered = 0.0 if moves(look) else unanswered
                reason = (
                    interruption(look, start, excitation.reach, unanswered) if signals.going_on() else "interrupted"
                )
                if reason:
                    raise RefusedError(f"{reason}. A zero was sent, nothing is written")
                robot.send(move.linear, move.angular)
                time.sleep(min(PERIOD, begin + move.seconds - now))
                last, now = now, time.monotonic()
                unanswered += now - last if move.linear != 0 or move.angular != 0 else 0.0
    finally:
        robot.send(0, 0)
