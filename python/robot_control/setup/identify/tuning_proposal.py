"""What was identified → feed-forward and gains of the `diff_drive_controller` block, with the margins they have.

The feed-forward follows from the inertias that the wheels show, J_straight and J_turning. They determine mass and yaw
inertia once the wheel's own inertia J is known (src/control/wheeled/wheel_loops/feed_forward.h, with its symbols):

    mass = 2h·(J_straight − J)/r²      yaw_inertia = (J_turning − J)·h·b·b'/(2r²)

J cannot be seen on the ground. A robot that was weighed gives it: J = J_straight − mass·r²/(2h). Otherwise J is
its nominal value; a rotor that the parameters omit then counts as mass, with the same motion.

wheel_loop_gains.h derives the gains of that robot. They are proposed if they bear one cycle more than the measured
delay with a gain margin of two, also on a lifted wheel. Otherwise the largest kp·s, ki·s² with this property are
proposed; s scales the bandwidth of the loop.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from robot_control.setup.identify.fit import Identification
from robot_control.setup.identify.wheel_law import Base, Wheel
from robot_control.setup.identify.wheel_margins import Loop, Margins, gain_margin, margins

RESERVE = 1
"""Cycles of delay beyond the measured one at which proposed gains are stable"""
GAIN_MARGIN = 2.0
"""The usual 6 dB"""
STEP = 2**-0.25
"""Step of the search for slower gains."""
STEPS = 32
"""Steps down to 1/256 of kp, which is slower than any robot needs"""
LIGHTEST = 0.9
"""Largest share of the smaller inertia on the ground that is attributed to the wheel itself."""


class NoGainsError(ValueError):
    """No gains are stable at the delay; the message names it."""


@dataclass(frozen=True)
class Proposal:
    """The parameters to write, and their margins."""

    feed_forward: dict[str, float]  # keys of the map feed_forward
    before: Loop
    after: Loop
    margins_before: Margins  # behind the measured delay, driving the measured robot
    margins_after: Margins
    derived_bear: bool  # true if the derived gains are proposed
    weighed: bool

    def overlay(self) -> dict[str, Any]:
        """The keys of the `diff_drive_controller` block."""
        gains = {f"pid_{name}": getattr(self.after, name) for name in ("kp", "ki", "kd")}
        return {"feed_forward": self.feed_forward, **gains}


def base_of(robot: Mapping[str, Any]) -> Base:
    """`robot` as ClosedLoop.robot gives it."""
    wheels = (
        Wheel(wheel["joint"], -1 if wheel["side"] == "left" else 1, wheel["sign"], wheel["radius"])
        for wheel in robot["wheels"]
    )
    return Base(tuple(wheels), robot["wheel_base"], robot["effective_wheel_base"])


def feed_forward(found: Identification, base: Base, lifted: float, mass: float | None) -> dict[str, float]:
    """`lifted`: kg·m², the nominal inertia of the wheel; `mass`: kg, weighed, or None.

    Raises:
        ValueError: the weighed mass alone is more than the wheels feel.
    """
    h, r = base.wheels_beside, base.radius
    straight, turning = found.mean("straight").value, found.mean("turning").value
    if mass is not None:
        lifted = straight - mass * r**2 / (2 * h)
        if lifted <= 0:
            what = f"--mass {mass:g} kg: the wheels measure at most {2 * h * straight / r**2:.4g} kg"
            raise ValueError(f"{what}. Check the mass, or check that wheel_radius is right")
    lifted = min(lifted, LIGHTEST * straight, LIGHTEST * turning)
    return {
        "mass": 2 * h * (straight - lifted) / r**2 if mass is None else mass,
        "yaw_inertia": (turning - lifted) * h * base.wheel_base * base.effective_wheel_base / (2 * r**2),
        "wheel_inertia": lifted,
        "wheel_damping": max(0.0, found.mean("damping").value),
        "wheel_friction": max(0.0, found.mean("friction").value),
    }


def loop_of(loops: Sequence[Mapping[str, Any]], found: Identification, lifted: float) -> Loop:
    """The gains of `loops` (_robot_control.wheel_loops) on the measured robot; the fastest if the wheels differ."""
    quickest = max(loops, key=lambda loop: loop["kp"] / loop["model_inertia"])
    straight, turning = found.mean("straight").value, found.mean("turning").value
    shared = {name: quickest[name] for name in ("kp", "ki", "kd", "model_inertia", "bandwidth", "period")}
    inertias = (lifted, turning, straight, 2 * straight - lifted)
    return Loop(**shared, inertias=inertias, damping=max(0.0, found.mean("damping").value))


def propose(
    found: Identification,
    forward: dict[str, float],
    now: Sequence[Mapping[str, Any]],
    derived: Sequence[Mapping[str, Any]],
    *,
    weighed: bool,
) -> Proposal:
    """`now`: the loops as they are set; `derived`: as derived from the robot with `forward`.

    Raises:
        NoGainsError: none bear the measured delay.
    """
    delay = round(found.delay.value)
    before = loop_of(now, found, forward["wheel_inertia"])
    after = loop_of(derived, found, forward["wheel_inertia"])
    # All wheels share one pid_kp, the smallest that any of them requires.
    after = replace(after, kp=min(loop["kp"] for loop in derived), ki=min(loop["ki"] for loop in derived))
    for step in range(STEPS):
        part = STEP**step
        loop = after.scaled(part, part**2)
        if loop.radius(delay + RESERVE) < 1 and gain_margin(loop, delay) >= GAIN_MARGIN:
            break
    else:
        what = f"the torque is {delay} cycles late, {delay * found.period * 1000:.3g} ms beyond the bus"
        raise NoGainsError(f"{what}: no gains are stable with it. Check the drive for a delay; no file is written")
    loop = replace(loop, kp=_rounded(loop.kp), ki=_rounded(loop.ki))
    feed_forward = {name: _rounded(value) for name, value in forward.items()}
    margins_before = margins(before, delay)
    margins_after = margins(loop, delay)
    return Proposal(feed_forward, before, loop, margins_before, margins_after, derived_bear=step == 0, weighed=weighed)


def _rounded(value: float) -> float:
    """Four digits, which is more than any measurement holds."""
    return 0.0 if value == 0 else round(value, 3 - math.floor(math.log10(abs(value))))
