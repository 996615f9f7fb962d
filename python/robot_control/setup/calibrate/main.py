"""The ROS side of calibrate.py asks, drives, follows the wheels, and stops whenever something is not as planned."""

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import rospy

from robot_control._robot_control import describe as describe_robot
from robot_control.files.files import one_message
from robot_control.files.output_files import check_outputs
from robot_control.loop.roles import CONTROLLER, ESTIMATOR
from robot_control.robot.pose import FloatArray, Pose
from robot_control.robot.running_robot import RefusedError, await_all, master_state, other_senders, running_settings
from robot_control.robot.topic_sender import Signals, ended_by_signals
from robot_control.settings.block import Settings
from robot_control.setup.calibrate import evaluation, law
from robot_control.setup.calibrate.moves import Move, Pilot, square, straight
from robot_control.setup.calibrate.robot import CalibratedRobot
from robot_control.setup.excitation_watch import hindrance, ignored, moves, unattended
from robot_control.setup.terminal_dialog import Answer, NoAnswerError, Questions

PERIOD = 0.05
"""s between two commands: 25 are lost before the default cmd_vel_timeout"""
SILENCE = 1.0
"""s without wheel_odom, which comes 50 times a second"""
MAX_HOP = 0.3
"""m between two messages of wheel_odom; a larger step is a reset or another run: 15 m/s at 50 Hz"""
MIN_DISTANCE = 0.3
"""m; half of the shortest drive, and more than a robot creeps"""
STANDSTILL = 0.5
"""s of standing before a pose is read: the body has stopped rocking"""
MARKS = (
    "Mark on the floor where the middle between the wheels stands, and which way the robot points (a string along the "
    "axle, and one ahead). Each run begins where the robot stands: set it back whenever the path is no longer free."
)
REFUSALS = (RefusedError, NoAnswerError, OSError, ValueError)


Objection = Callable[[Any], str]
"""Why an answer is none that can be; empty if it can"""


@dataclass
class Drive:
    """One measurement: its moves, and the area in which they may happen."""

    what: str
    moves: Sequence[Move]
    ahead: float  # m beyond the start
    left: float  # m
    right: float  # m

    def astray(self, start: Pose, here: Pose) -> str:
        """Why the robot may not be here; empty if it may."""
        ahead, left = here.seen_from(start)
        beside = evaluation.margin(self.ahead)
        if -beside <= ahead <= self.ahead + beside and -self.right - beside <= left <= self.left + beside:
            return ""
        return f"the robot is {ahead:.2f} m ahead and {left:.2f} m to the left of its start, off its path"


@dataclass
class Wizard:
    """One dialogue."""

    robot: CalibratedRobot
    options: argparse.Namespace
    wheels: law.Wheels
    signals: Signals
    questions: Questions
    senders: tuple[str, ...] = ()
    lengths: list[float] = field(default_factory=list)
    places: list[tuple[float, float]] = field(default_factory=list)

    def run(self) -> tuple[list[law.Straight], list[law.Square]]:
        """All measurements."""
        options = self.options
        self.lengths, self.places = list(options.measured), list(options.returned)
        print(evaluation.space(options))
        self._permission("Is the path free, and a hand at the emergency stop?")
        straights: list[law.Straight] = []
        squares: list[law.Square] = []
        if options.distance > 0:
            drive = Drive("straight drive", straight(options.distance), options.distance, 0.0, 0.0)
            straights = [self._straight(drive, number) for number in range(options.repeats)]
        if options.side > 0:
            for clockwise in (True, False):
                squares += [self._square(number, clockwise=clockwise) for number in range(options.runs)]
        return straights, squares

    def _straight(self, drive: Drive, number: int) -> law.Straight:
        path, truth = self._driven(drive, f"straight drive {number + 1} of {self.options.repeats}")
        by_wheels = float(np.linalg.norm(law.replay(path, self.wheels, law.Truth())[-1, :2]))
        objection = partial(evaluation.implausible_distance, by_wheels=by_wheels)
        question = f"m between the two marks, by tape (the wheels measured {by_wheels:.3f}):"
        return law.Straight(path, self._answer(math.hypot(*truth), self.lengths, question, float, objection))

    def _answer(
        self, truth: Answer, given: list[Answer], question: str, read: Callable[[str], Answer], objection: Objection
    ) -> Answer:
        """The reading of the tape: the truth of a simulation, the next one that was given, or a person's answer."""
        if not self.options.truth:
            return given.pop(0) if given else self.questions.value(question, read, objection)
        self._refuse(objection(truth))
        return truth

    def _square(self, number: int, *, clockwise: bool) -> law.Square:
        side = self.options.side
        left, right = (0.0, side) if clockwise else (side, 0.0)
        direction = "clockwise" if clockwise else "counter-clockwise"
        drive = Drive("square", square(side, clockwise=clockwise), side, left, right)
        path, truth = self._driven(drive, f"square {number + 1} of {self.options.runs}, {direction}")
        question = "x,y: m of the second mark ahead of and to the left of the first:"
        objection = partial(evaluation.implausible_return, side=side)
        measured = self._answer(truth, self.places, question, evaluation.place, objection)
        return law.Square(path, measured, clockwise)

    def _driven(self, drive: Drive, title: str) -> tuple[FloatArray, tuple[float, float]]:
        """The path by wheel odometry, and the true end of the middle of the wheels (in simulation; else zero)."""
        if not self.options.truth:
            print(MARKS)
        self._permission(f"{title}: ready?")
        print(title)
        self._rest()
        begin = self._truth()
        self.robot.begin()
        if self.options.manual:
            self.questions.line("Drive it now, and back to rest; then press Enter.")
        else:
            self._follow(drive)
        self._rest()
        path = self.robot.path()
        hops = np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1)
        if hops.sum() < MIN_DISTANCE:
            raise RefusedError(f"{title}: the wheels have not turned")
        if hops.max() > MAX_HOP:
            why = f"{title}: wheel_odom jumped by {hops.max():.2f} m: check whether the odometry or the robot was reset"
            raise RefusedError(why)
        if begin is None:
            return path, (0.0, 0.0)
        end = self._truth() or begin
        poses = law.of_axle(np.array([[begin.x, begin.y, begin.yaw], [end.x, end.y, end.yaw]]), self.wheels.axle)
        return path, Pose(*poses[1]).seen_from(Pose(*poses[0]))

    def _truth(self) -> Pose | None:
        if not self.options.truth:
            return None
        await_all(lambda: self.robot.truth is not None, self.signals)
        if self.robot.truth is None:
            raise RefusedError("--truth: ground_truth/odom has no publisher; only a simulated robot has one")
        return self.robot.truth

    def _follow(self, drive: Drive) -> None:
        """Drives the measurement; the last message is a zero, whatever happens."""
        robot, pilot = self.robot, Pilot(drive.moves, self.options.speed, self.options.turn_speed)
        start = robot.observe().pose or Pose(0.0, 0.0, 0.0)  # hindrance has seen one
        received, received_at = robot.received, time.monotonic()
        unanswered, last = 0.0, time.monotonic()
        try:
            while not pilot.done:
                now, observed = time.monotonic(), robot.observe()
                if robot.received != received:
                    received, received_at = robot.received, now
                reason = "" if self.signals.going_on() else "interrupted"
                reason = reason or unattended(observed) or ignored(unanswered)
                reason = reason or (drive.astray(start, observed.pose) if observed.pose else "")
                if now - received_at > SILENCE:
                    reason = reason or f"no wheel_odom for {SILENCE:g} s: does {ESTIMATOR} run?"
                self._refuse(reason)
                linear, angular = pilot.command(robot.wheels or start, now)
                robot.send(linear, angular)
                asked = linear != 0 or angular != 0
                unanswered = unanswered + now - last if asked and not moves(observed) else 0.0
                last = now
                time.sleep(PERIOD)
        finally:
            robot.send(0, 0)

    def _rest(self) -> None:
        """Waits until the robot stands."""
        end = time.monotonic() + 20 * STANDSTILL
        since = time.monotonic()
        while time.monotonic() - since < STANDSTILL:
            self._refuse("" if self.signals.going_on() else "interrupted")
            if moves(self.robot.observe()):
                since = time.monotonic()
            if time.monotonic() > end:
                raise RefusedError("the robot does not come to rest")
            time.sleep(PERIOD)

    def _permission(self, question: str) -> None:
        if not self.options.yes:
            if not self.questions.yes(question):
                raise RefusedError("as you say. No file is written")
            self.robot.requested = time.monotonic()
        reason = "" if self.options.manual else hindrance(self.robot.observe(self.senders))
        if reason:
            raise RefusedError(f"{reason}. No file is written")

    @staticmethod
    def _refuse(reason: str) -> None:
        if reason:
            raise RefusedError(f"{reason}. No file is written")


@one_message("calibrate.py", *REFUSALS)
def main() -> None:
    """Entry point of scripts/calibrate.py: exit code 0 with a YAML written, else 1 with one message."""
    options = evaluation.parse_options(rospy.myargv()[1:])
    check_outputs([options.out])
    with running_settings("calibrate", ESTIMATOR, *OTHERWISE) as settings:
        with ended_by_signals() as signals:
            robot, straights, squares = _measured(settings, options, signals)
        outcome = evaluation.evaluate(robot, straights, squares, options.side)
    outcome.deliver(options.out, "then restart every node")


OTHERWISE = ("and let the robot stand where it may drive", "as a tape measure does")


def _measured(
    settings: Settings, options: argparse.Namespace, signals: Signals
) -> tuple[dict[str, object], list[law.Straight], list[law.Square]]:
    described = describe_robot(settings.path, settings.values)
    robot = CalibratedRobot(sends=not options.manual)
    await_all(lambda: robot.received > 0 and robot.reports() and (options.manual or robot.has_receiver()), signals)
    senders = () if options.manual else other_senders(master_state())
    if robot.received == 0:
        raise RefusedError(f"no wheel_odom: does {ESTIMATOR} run? Start the robot first")
    if not options.manual and not robot.has_receiver():
        raise RefusedError(f"no node subscribes to {rospy.resolve_name('cmd_vel')}: does {CONTROLLER} run?")
    questions = Questions(signals.going_on)
    wizard = Wizard(robot, options, evaluation.wheels_of(described), signals, questions, senders)
    straights, squares = wizard.run()
    return described, straights, squares
