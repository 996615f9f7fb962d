"""The steps of first_steps.py, in their order: what a person does, what is measured, and what the person confirms."""

import json
import math
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import rospy
from roslib.packages import find_node

from robot_control.loop.roles import DRIVER
from robot_control.robot.ros_master import living
from robot_control.setup.description import Description
from robot_control.setup.first_steps import checks
from robot_control.setup.first_steps.checks import StepError
from robot_control.setup.first_steps.robot import WatchedRobot
from robot_control.setup.foot_motions import foot_motions
from robot_control.setup.terminal_dialog import Questions

GRAVITY = 9.81
"""m/s²"""
TURN = 0.15
"""rad, by which each joint moves"""
TURN_TIME, FOLD_TIME = 0.5, 1.5
"""s for that, and for one leg to fold"""
PATIENCE = 60.0
"""s to press or release the emergency stop"""
LET_GO = 1.0
"""s after which joints rest"""
ZEROS = "find zeros, signs and exchanged motors with zero_joints.py"
CRAWL, TROT, WALK = 0.1, 0.2, 3.0
"""m/s, m/s, s"""


@dataclass(frozen=True)
class Context:
    """The robot, the person, and values of the robot that the steps use."""

    robot: WatchedRobot
    ask: Questions
    parameters: dict[str, Any]
    """with the block `robot` of the running robot"""
    urdf: str
    """path"""
    model: Description

    @property
    def share(self) -> float:
        """N, a quarter of the weight."""
        return float(self.model["mass"]) * GRAVITY / 4

    def confirm(self, question: str, remedy: str = "begin again once you can type y") -> None:
        """Raises StepError unless the person types y."""
        checks.require(self.ask.yes(f"  {question}"), f"you typed n to: {question} Remedy: {remedy}")

    def release(self) -> None:
        """Ends a stop, if the person agrees."""
        if self.robot.stopped:
            self.confirm(
                f"The robot is stopped: {'; '.join(self.robot.safety.sentences)}. Hands off the legs. Release it now?"
            )
            self.robot.reset()
        self.robot.require_release()


def _hang(at: Context) -> None:
    at.ask.line("  Hang the robot up, or put its trunk on a stand, level. All feet hang free. Press Enter.")
    checks.hung(at.robot.loads, at.share)
    checks.level(*at.robot.tilt)


def _doctor(at: Context) -> None:
    simulated = {"driver": "mujoco"} if living(rospy.resolve_name(DRIVER)) else {}  # its drives are on no bus
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
        json.dump({"robot": at.parameters["robot"] | simulated}, file)
        file.flush()
        program = find_node("robot_control", "doctor.py")[0]
        done = subprocess.run([program, "--json", "--params", file.name], capture_output=True, text=True, check=False)
    try:
        findings = json.loads(done.stdout)["checks"]
    except ValueError:
        raise StepError(f"doctor.py does not work: {done.stderr}") from None
    checks.green(findings)
    print(f"  {len(findings)} lines without a fault, green: {', '.join(checks.GREEN)}")


def _battery(at: Context) -> None:
    safety, voltage = at.robot.safety, at.robot.voltage
    checks.charged([*safety.warnings, *safety.causes], voltage)
    measured = "The voltage of the battery is not measured" if voltage is None else f"The battery has {voltage:.1f} V"
    at.confirm(f"{measured}. Is it at least half full?")


def _e_stop(at: Context) -> None:
    at.release()
    print(f"  Take the emergency stop into your hand, and press it within {PATIENCE:g} s.")
    at.robot.wait(lambda: at.robot.safety.first_cause, PATIENCE)
    checks.pressed(at.robot.safety.first_cause)
    print(f"  {at.robot.safety.first_cause} is latched. Release the emergency stop within {PATIENCE:g} s.")
    free = at.robot.wait(lambda: not at.robot.safety.active, PATIENCE)
    checks.require(free, f"{', '.join(at.robot.safety.active)} is still active after {PATIENCE:g} s: release it")
    at.robot.reset()


def _damping(at: Context) -> None:
    checks.require(at.robot.stop(), "the robot is not stopped after e_stop_trigger: check the safety monitor (why.py)")
    at.ask.line("  The robot brakes. Move each leg slowly by hand, then let go of all legs. Press Enter.")
    before = at.robot.newest("joint_states").position
    at.robot.wait(lambda: False, LET_GO)
    checks.yielded(max(map(abs, _turns(at, before))) / LET_GO)
    at.confirm("Did each joint yield, and resist more when it was moved faster?", "check the damping of the drive file")


def _joints(at: Context) -> None:
    at.release()
    at.robot.take("lying")
    checks.hung(at.robot.loads, at.share)
    state = at.robot.newest("joint_states")
    middle = {each["name"]: (each["lower"] + each["upper"]) / 2 for each in at.model["joints"]}
    small = [math.copysign(TURN, middle[name] - angle) for name, angle in zip(state.name, state.position, strict=True)]
    words = foot_motions(at.urdf, state.position, state.name, small)
    for index, (name, ordered) in enumerate(zip(state.name, small, strict=True)):
        before = at.robot.newest("joint_states").position
        at.robot.turn({name: before[index] + ordered}, TURN_TIME)
        turns = _turns(at, before)
        checks.moved(state.name, index, ordered, turns)
        at.confirm(f"{name} turned by {turns[index]:+.2f} rad, {words[index]}. Did you see that?", ZEROS)
    at.confirm("All legs fold now, as the robot lies. Ready?")
    for leg in at.model["legs"]:
        at.robot.turn(dict(zip(leg["joints"], leg["lying"], strict=True)), FOLD_TIME)
    at.confirm("All legs are folded alike, left mirrored to right. Is that so?", ZEROS)


def _turns(at: Context, before: Sequence[float]) -> list[float]:
    return [new - old for new, old in zip(at.robot.newest("joint_states").position, before, strict=True)]


def _lie(at: Context) -> None:
    at.ask.line("  Lower the robot onto a level floor, 2 m free in front of it. Hold the emergency stop. Press Enter.")
    at.release()
    at.robot.take("lying")
    checks.level(*at.robot.tilt)
    at.confirm("It lies on its belly, the legs beside it. Is that so?")


def _stand(at: Context) -> None:
    at.release()
    at.confirm("The robot stands up now. Ready?")
    at.robot.take("standing")
    checks.stood(at.robot.loads, at.share)
    checks.level(*at.robot.tilt)


def _walk(gait: str, speed: float) -> Callable[[Context], None]:
    def step(at: Context) -> None:
        at.release()
        at.confirm(f"The robot walks ahead now, {gait} at {speed:g} m/s, {speed * (WALK + 2):.1f} m. Ready?")
        at.robot.take("standing")
        used, mean = at.robot.walk(gait, speed, WALK)
        checks.walked(gait, used, speed, mean)
        print(f"  {mean:.3f} m/s")

    return step


def _lower(at: Context) -> None:
    at.release()
    at.robot.take("lying")


STEPS: dict[str, tuple[str, Callable[[Context], None]]] = {
    "hang": ("the robot hangs, no foot carries load, the body is level", _hang),
    "doctor": ("doctor.py finds no fault on this computer", _doctor),
    "battery": ("the battery is at least half full", _battery),
    "e_stop": ("the emergency stop in your hand latches a stop", _e_stop),
    "damping": ("the braked joints yield to a hand, and resist", _damping),
    "joints": ("only the ordered joint moves, by the right angle, in the right direction", _joints),
    "lie": ("the robot lies on the floor", _lie),
    "stand": ("it stands on four feet, level", _stand),
    "crawl": ("it walks slowly, one foot after the other", _walk("crawl", CRAWL)),
    "trot": ("it trots slowly", _walk("trot", TROT)),
    "lower": ("it lies down again", _lower),
}
"""Name of each step: what it shows, and how."""
