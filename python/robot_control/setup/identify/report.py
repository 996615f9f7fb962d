"""Reports the identified wheels and the proposal: as a table, and as the YAML that is laid over the parameters."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from robot_control.setup.identify.fit import Estimate, Identification
from robot_control.setup.identify.tuning_proposal import RESERVE, Proposal
from robot_control.ui.table import table

UNLIKE = 0.2
"""Difference between the sides relative to their mean; a larger one is a defect of the machine"""


def to_table(
    found: Identification, proposal: Proposal, robot: Mapping[str, Any], now: Sequence[Mapping[str, Any]]
) -> str:
    """`robot` as ClosedLoop.robot, `now` as _robot_control.wheel_loops gives them: the nominal values."""
    nominal = now[0]
    forward, after = {name: _number(value) for name, value in proposal.feed_forward.items()}, proposal.after
    damping, friction = _measured(found.mean("damping")), _measured(found.mean("friction"))
    rows = [
        ("", "nominal", "measured", "proposed"),
        ("inertia straight, kg·m²", _number(nominal["straight"]), _measured(found.mean("straight")), ""),
        ("inertia turning, kg·m²", _number(nominal["turning"]), _measured(found.mean("turning")), ""),
        ("scrub while turning, N·m", "", _measured(found.mean("scrub")), ""),
        *_ground_friction(found, now),
        ("delay beyond the bus, cycles", "0", _measured(found.delay), ""),
        ("feed_forward.mass, kg", _number(robot["mass"]), "", forward["mass"]),
        ("feed_forward.yaw_inertia, kg·m²", _number(robot["yaw_inertia"]), "", forward["yaw_inertia"]),
        ("feed_forward.wheel_inertia, kg·m²", _number(nominal["lifted"]), "", forward["wheel_inertia"]),
        ("feed_forward.wheel_damping, N·m·s/rad", _number(nominal["damping"]), damping, forward["wheel_damping"]),
        ("feed_forward.wheel_friction, N·m", _number(nominal["friction"]), friction, forward["wheel_friction"]),
        ("pid_kp, N·m·s/rad", _number(proposal.before.kp), "", _number(after.kp)),
        ("pid_ki, N·m/rad", _number(proposal.before.ki), "", _number(after.ki)),
        ("spectral radius", f"{proposal.margins_before.radius:.4f}", "", f"{proposal.margins_after.radius:.4f}"),
        ("gain margin", f"{proposal.margins_before.gain:.3g}", "", f"{proposal.margins_after.gain:.3g}"),
        ("delay margin, cycles", str(proposal.margins_before.delay), "", str(proposal.margins_after.delay)),
    ]
    return "\n".join(table(rows))


def ground_friction(found: Identification, now: Sequence[Mapping[str, Any]]) -> Estimate | None:
    """Friction of the ground from the torque of scrubbing treads at friction 1 (machine/wheeled/scrub.h); None if none
    scrub.
    """
    at_friction_one = sum(float(wheel["scrub"]) for wheel in now) / len(now)
    scrub = found.mean("scrub")
    return Estimate(scrub.value / at_friction_one, scrub.error / at_friction_one) if at_friction_one > 0 else None


def _ground_friction(found: Identification, now: Sequence[Mapping[str, Any]]) -> Iterator[tuple[str, str, str, str]]:
    friction = ground_friction(found, now)
    if friction is not None:
        yield ("ground friction", "", _measured(friction), "found in every turn")


def warnings(found: Identification, proposal: Proposal) -> list[str]:
    """Remarks on what the user should examine, a sentence each."""
    said = []
    delay = round(found.delay.value)
    if proposal.margins_before.delay < delay + RESERVE:
        what = f"the present gains tolerate {proposal.margins_before.delay} cycles of delay, {delay} were measured"
        said.append(f"{what}: wheels that lose friction may oscillate")
    if not proposal.derived_bear:
        said.append("the gains are slower than those derived from the robot, for the delay's sake")
    if not proposal.weighed:
        said.append("a wheel's own inertia cannot be seen on the ground: set --mass KG of the weighed robot")
    left, right = found.sides
    for name in ("straight", "turning", "friction"):
        one, other = getattr(left, name), getattr(right, name)
        unlike = abs(one.value - other.value)
        mean = abs(one.value + other.value) / 2
        if unlike > UNLIKE * mean and unlike > 3 * (one.error + other.error):
            what = f"{name}: left {_measured(one)}, right {_measured(other)}"
            said.append(f"{what}: the sides differ, but one value is proposed for both. Check gears, tyres and load")
    return said


def _number(value: float) -> str:
    return f"{value:.4g}"


def _measured(estimate: Estimate) -> str:
    if not math.isfinite(estimate.value):
        return "not in the log"
    return f"{estimate.value:.4g}" + (
        f" ± {estimate.error:.1g}" if math.isfinite(estimate.error) else ", error unknown"
    )
