"""Texts, wheel forces and the path driven, as RViz shows them."""

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field

from robot_control.robot.safety_states import DRIVABLE

WIDTH = 60
"""columns of the text above the robot"""
MAX_LINES = 6
STEP = 0.05
"""m between two points of the path driven"""
MAX_POINTS = 5000
"""points; beyond that, every other one is dropped"""
METRES_PER_NEWTON = 0.02
"""length of an arrow"""

Point = tuple[float, float, float]
IDLE = {"holding", "timed_out", "no_command"}
"""reasons of a robot that stands because no motion is requested (kCommandReasonNames)"""
GREEN, AMBER, RED = (0.3, 0.9, 0.4), (1.0, 0.75, 0.2), (1.0, 0.3, 0.25)


@dataclass(frozen=True)
class Wheel:
    """Place of a wheel in base axes."""

    position: Point  # m, its centre
    radius: float  # m


def force_arrows(wheels: dict[str, Wheel], names: Sequence[str], efforts: Sequence[float]) -> list[tuple[Point, Point]]:
    """Begin and end, in base axes, of the force at the ground that each wheel's torque makes."""
    arrows = []
    for name, effort in zip(names, efforts, strict=False):
        wheel = wheels.get(name)
        if wheel is None or wheel.radius <= 0 or not math.isfinite(effort):
            continue
        x, y, z = wheel.position
        begin = (x, y + math.copysign(0.05, y), z - wheel.radius + 0.02)
        arrows.append((begin, (begin[0] + METRES_PER_NEWTON * effort / wheel.radius, begin[1], begin[2])))
    return arrows


def limits_of(reasons: Sequence[str], sentences: Sequence[str]) -> list[str]:
    """Sentences about the limits of a motion; a robot without a requested motion has none."""
    return [text for name, text in zip(reasons, sentences, strict=False) if name not in IDLE]


@dataclass(frozen=True)
class Text:
    """The text above the robot."""

    text: str
    colour: tuple[float, float, float]


def status_text(
    state: str, sentences: Sequence[str], warnings: Sequence[str], reasons: Sequence[str], speed_limit: float
) -> Text:
    """Safety state with its causes, else with warnings and the reasons that limit the motion."""
    lines = [state or "no safety_status"]
    lines += [f"cause: {sentence}" for sentence in sentences] or [f"warning: {sentence}" for sentence in warnings]
    if math.isfinite(speed_limit):
        lines.append(f"limit: {speed_limit:.2f} m/s")
    if not sentences:
        lines += [f"limited: {reason}" for reason in reasons]
    wrapped = [part for line in lines for part in textwrap.wrap(line, WIDTH)]
    colour = RED if state not in DRIVABLE else AMBER if len(lines) > 1 else GREEN
    return Text("\n".join(wrapped[:MAX_LINES]), colour)


@dataclass
class Trail:
    """The path driven, bounded."""

    points: list[Point] = field(default_factory=list)
    _step: float = STEP

    def add(self, x: float, y: float) -> bool:
        """True if it grew. A jump of more than a metre (after a reset of the odometry) begins another path."""
        if self.points:
            distance = math.dist(self.points[-1][:2], (x, y))
            if distance < self._step:
                return False
            if distance > 1.0:
                self.points, self._step = [], STEP
        self.points.append((x, y, 0.0))
        if len(self.points) > MAX_POINTS:
            self.points, self._step = self.points[::2], 2 * self._step
        return True
