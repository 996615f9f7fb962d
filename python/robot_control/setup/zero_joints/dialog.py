"""The dialogue of zero_joints.py: each joint is turned by hand, then the robot lies, and the zeros are confirmed.

With the direction s, the offset o and the gear g a drive reports q = s · motor / g + o. In a known posture the joint is
at q*, so its offset is q* − (q − o), and with the other direction q* + (q − o).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from robot_control.setup.zero_joints.drive_file import FileJoint
from robot_control.ui.table import table

MOVED = 0.1
"""rad, from which a joint was turned"""
SHARE = 0.5
"""of that turn, which no other joint may reach"""
WHOLE = 0.1
"""of a turn of the rotor, near which a change of an offset is one"""


class NotFoundError(RuntimeError):
    """No zeros were found; the message says what to correct."""


class Robot(Protocol):
    """A robot whose joints rest."""

    def angles(self) -> Sequence[float]:
        """rad, of all joints, once they are still. Raises an error if the robot moves or is released."""


class Asker(Protocol):
    """Questions of setup/terminal_dialog.py."""

    def line(self, question: str) -> str:
        """One line, as it was typed."""

    def yes(self, question: str) -> bool:
        """Asks until y or n was typed."""


@dataclass(frozen=True)
class Zeroed:
    """A joint of the robot, and what the drive file states about it."""

    name: str
    given: FileJoint
    angle: float
    """rad, in the known posture"""
    positive: str = "towards greater angles"
    """the turn that its positive direction is, in words"""

    def offset(self, reported: float, *, flips: bool) -> float:
        """rad, for the angle that was reported in the known posture; `flips`: with the other direction."""
        own = reported - self.given.offset
        return self.angle + own if flips else self.angle - own


def turned(before: Sequence[float], after: Sequence[float]) -> tuple[int, float] | None:
    """The one joint that turned, and by how much; None if none or several did."""
    moves = [new - old for old, new in zip(before, after, strict=True)]
    order = sorted(range(len(moves)), key=lambda each: -abs(moves[each]))
    most, others = order[0], order[1:]
    if abs(moves[most]) < MOVED or any(abs(moves[each]) > SHARE * abs(moves[most]) for each in others):
        return None
    return most, moves[most]


def find_zeros(joints: Sequence[Zeroed], robot: Robot, ask: Asker) -> dict[str, dict[str, float]]:
    """The offset and the direction of each joint that the user confirmed.

    Raises:
        NotFoundError: motors are exchanged, or a joint was not confirmed.
    """
    flips, wrong = [], []
    for index, joint in enumerate(joints):
        turn = _turn(joint, robot, ask)
        flips.append(turn[1] < 0)
        if turn[0] != index:
            other = joints[turn[0]].name
            wrong.append(f"{joint.name} was turned, and {other} moved")
            print(f"  {wrong[-1]}: their motors are exchanged")
        elif flips[-1]:
            print(f"  {joint.name} moved towards smaller angles: its direction becomes {-joint.given.direction}")
    if wrong:
        remedy = "exchange their keys bus and node (or motor) in the drive file, restart the driver, and begin again"
        raise NotFoundError(f"{'; '.join(wrong)}: {remedy}")
    ask.line("Put the robot into its known posture, let go of it, and press Enter.")
    return _confirmed(joints, robot.angles(), flips, ask)


def _turn(joint: Zeroed, robot: Robot, ask: Asker) -> tuple[int, float]:
    while True:
        ask.line("Let go of all joints, and press Enter.")
        before = robot.angles()
        ask.line(f"Turn only {joint.name} by hand, {joint.positive}, by 10° or more; hold it, and press Enter.")
        found = turned(before, robot.angles())
        if found is not None:
            return found
        print(f"  no joint, or more than one, turned by {MOVED:g} rad: turn only {joint.name}, and further")


def _confirmed(
    joints: Sequence[Zeroed], reported: Sequence[float], flips: Sequence[bool], ask: Asker
) -> dict[str, dict[str, float]]:
    found: dict[str, dict[str, float]] = {}
    rows: list[tuple[str, ...]] = []
    for joint, angle, flip in zip(joints, reported, flips, strict=True):
        offset = joint.offset(angle, flips=flip)
        found[joint.name] = {"offset": offset}
        if flip:
            found[joint.name]["direction"] = -joint.given.direction
        before = joint.given.offset
        numbers = (f"{joint.angle:.3f}", f"{angle:.3f}", f"{before:.4f}", f"{offset:.4f}")
        rows.append((joint.name, *numbers, _remark(joint, offset - before, flips=flip)))
    heads = ("joint, rad", "known", "reported", "offset before", "offset", "")
    print("\n".join(table([heads, *rows])))
    for joint in joints:
        if not ask.yes(f"{joint.name}: offset {found[joint.name]['offset']:.4f} rad?"):
            raise NotFoundError(f"{joint.name} was not confirmed")
    return found


def _remark(joint: Zeroed, change: float, *, flips: bool) -> str:
    if flips:
        return "other direction"
    turns = change / joint.given.turn if joint.given.turn else 0.0
    if round(turns) != 0 and abs(turns - round(turns)) < WHOLE:
        return f"{round(turns):+d} turn(s) of the rotor"
    return ""
