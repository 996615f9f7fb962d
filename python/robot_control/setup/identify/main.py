"""identify.py's ROS side: reads the robot's parameters, drives the plan, stops whenever something is not as planned."""

import argparse
import time

import rospy

from robot_control.data.run_log import FloatArray, kind_in, read_run
from robot_control.files.files import one_message
from robot_control.files.output_files import check_outputs
from robot_control.loop.roles import CONTROLLER, refuse_legs
from robot_control.robot.diagnosis.facts import nodes_of
from robot_control.robot.pose import Pose
from robot_control.robot.running_robot import RefusedError, await_all, master_state, other_senders, running_settings
from robot_control.robot.topic_sender import Signals, ended_by_signals
from robot_control.settings.block import Settings
from robot_control.settings.parameter_layers import layered
from robot_control.setup.excitation_watch import hindrance, interruption, moves
from robot_control.setup.identify.evaluation import evaluate, parse_options, plan
from robot_control.setup.identify.excitation import Excitation
from robot_control.setup.moving_robot import RunningRobot
from robot_control.setup.recorded_log import RecordingError, recording

PERIOD = 0.05
"""s between two commands: 25 are lost before the default cmd_vel_timeout"""
NO_MASTER = "or fit a log with --log"
SIMULATED_TIME = "or fit the log of a command_script with --log"
REFUSALS = (RefusedError, RecordingError, OSError, ValueError)


@one_message("identify.py", *REFUSALS)
def main() -> None:
    """Entry point of scripts/identify.py: exit code 0 with a YAML written, else 1 with one message."""
    options = parse_options(rospy.myargv()[1:])
    check_outputs([options.output], [options.log, options.params, options.urdf])
    if options.log is not None:
        run = read_run(options.log)
        refuse_legs(kind_in(run.header), "identify.py")
        _fit(run.columns, _settings_of_files(options), options, f"log {options.log.name}")
        return
    with running_settings("identify", CONTROLLER, NO_MASTER, SIMULATED_TIME) as settings:
        with ended_by_signals() as signals:
            log = _drive(settings, options, signals)
        _fit(log, settings, options, "driven")


def _fit(log: dict[str, FloatArray], settings: Settings, options: argparse.Namespace, source: str) -> None:
    restart = f"start {CONTROLLER} again, then rosservice call e_stop_reset: a restart while the robot runs is a stop"
    evaluate(log, settings, options.mass, source).deliver(options.output, restart)


def _settings_of_files(options: argparse.Namespace) -> Settings:
    path, values = layered(options.params, None if options.urdf is None else options.urdf.absolute())
    return Settings(path, tuple(values))


def _drive(settings: Settings, options: argparse.Namespace, signals: Signals) -> dict[str, FloatArray]:
    excitation = plan(settings, options)
    robot = RunningRobot()
    senders, telemetry = _others(robot, signals)
    observed = robot.observe(senders)
    reason = hindrance(observed)
    if reason:
        raise RefusedError(f"{reason}. The robot was not driven")
    running = None
    if telemetry:
        await_all(lambda: any(name in robot.logs for name in telemetry), signals)
        running = next((robot.logs[name] for name in telemetry if name in robot.logs), None)
        if running is None:
            raise RefusedError(f"{telemetry[0]} runs, but does not report its file; stop it. The robot was not driven")
    with recording(running, settings.path, signals.going_on) as log:
        print(
            f"driving {excitation.seconds:.0f} s: up to {excitation.linear:.2f} m/s, {excitation.reach:.2f} m ahead "
            f"and back, then turns on the spot, up to {excitation.angular:.2f} rad/s. Ctrl-C stops"
        )
        _follow(robot, excitation, signals)
        return log.read()


def _others(robot: RunningRobot, signals: Signals) -> tuple[tuple[str, ...], list[str]]:
    """Other nodes that may send commands, and the telemetry that runs; waits for the first report of the robot."""
    await_all(lambda: robot.has_receiver() and robot.reports(), signals)
    state = master_state()
    if not robot.has_receiver():
        raise RefusedError(f"no node subscribes to {rospy.resolve_name('cmd_vel')}: does {CONTROLLER} run?")
    return other_senders(state), sorted(nodes_of(state) & {rospy.resolve_name("telemetry")})


def _follow(robot: RunningRobot, excitation: Excitation, signals: Signals) -> None:
    """Sends the plan; whatever happens, a zero is the last thing sent."""
    start = robot.observe().pose or Pose(0.0, 0.0, 0.0)  # hindrance has seen one
    unanswered = 0.0  # s
    try:
        for move in excitation.moves:
            begin = now = time.monotonic()
            while now - begin < move.seconds:
                observed = robot.observe()
                unanswered = 0.0 if moves(observed) else unanswered
                reason = (
                    interruption(observed, start, excitation.reach, unanswered) if signals.going_on() else "interrupted"
                )
                if reason:
                    raise RefusedError(f"{reason}. A zero was sent, no file is written")
                robot.send(move.linear, move.angular)
                time.sleep(min(PERIOD, begin + move.seconds - now))
                last, now = now, time.monotonic()
                unanswered += now - last if move.linear != 0 or move.angular != 0 else 0.0
    finally:
        robot.send(0, 0)
