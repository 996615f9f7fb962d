"""A drive that obeys the law of wheel_law.py exactly, for tests that break one thing each."""

import numpy as np
from robot_control.setup.identify.wheel_law import Base, Wheel

PERIOD = 0.001  # s
RADIUS, WHEEL_BASE = 0.1, 0.5  # m
STRAIGHT, TURNING = 0.08, 0.05  # kg·m²
DAMPING, FRICTION = 0.02, 0.1  # N·m·s/rad, N·m
BASE = Base((Wheel("left", -1, 1.0, RADIUS), Wheel("right", 1, -1.0, RADIUS)), WHEEL_BASE, WHEEL_BASE)
BUS = 2  # rows from a command to the sample of its torque
JERK_ROWS = 100  # a ramp's corners, 0.1 s
RAMP, CRUISE, PAUSE = 400, 600, 200  # rows


def move():
    """0 → 1 → 0, with round corners; ends in rest."""
    corners = [0, 0, 1, 1, 0, 0]
    at = np.cumsum([0, PAUSE, RAMP, CRUISE, RAMP, PAUSE])
    box = np.ones(JERK_ROWS) / JERK_ROWS
    raw = np.interp(np.arange(at[-1]), at, corners)
    return np.convolve(raw, np.convolve(box, box), mode="same")


def plan(straight=True, turns=True):
    """rad/s of both wheels, forward positive, (rows, 2)."""
    linear, angular = [], []
    for speed in (1.5, 3.0, 5.0):
        for sign in (1, -1):
            if straight:
                linear.append(sign * speed * move())
                angular.append(0 * move())
            if turns:
                linear.append(0 * move())
                angular.append(sign * speed * move())
    v, w = np.concatenate(linear), np.concatenate(angular)
    return np.stack([v - w, v + w], axis=1)


def drive(wanted=None, delay=0, echo=False, counts=0):
    """The log of wheels that follow `wanted` exactly, `delay` rows later than the bus.

    `echo`: the drive reports a command at once, and executes it `delay` rows later. `counts`: of the encoders per turn;
    0: exact.
    """
    wanted = plan() if wanted is None else wanted
    rows = len(wanted)
    speed = wanted  # at the samples
    angle = np.concatenate([np.zeros((1, 2)), np.cumsum((speed[1:] + speed[:-1]) / 2 * PERIOD, axis=0)])
    middle = np.concatenate([speed[:1], (speed[1:] + speed[:-1]) / 2])  # over [t_k-1, t_k), as the torque is
    acceleration = np.concatenate([np.zeros((1, 2)), np.diff(speed, axis=0) / PERIOD])
    together, apart = acceleration.mean(axis=1), (acceleration[:, 1] - acceleration[:, 0]) / 2
    effort = np.stack([STRAIGHT * together - TURNING * apart, STRAIGHT * together + TURNING * apart], axis=1)
    effort += DAMPING * middle + FRICTION * np.sign(middle)
    command = np.roll(effort, -BUS - delay, axis=0)
    if echo:
        effort = np.roll(command, BUS, axis=0)
    if counts:
        angle = np.floor(angle * counts / (2 * np.pi)) * 2 * np.pi / counts
    zero = np.zeros(rows)
    log = {
        "run": zero,
        "cycle": np.arange(rows, dtype=float),
        "time": np.arange(rows) * PERIOD,
        "gate_verdict": np.ones(rows),
        "gate_reasons": zero,
        "command_reasons": zero,
        "estimate_flags": np.ones(rows),
        "permit_causes": zero,
        "requests_received": np.ones(rows),
    }
    for i, wheel in enumerate(BASE.wheels):
        columns = {
            "position": angle,
            "effort": effort,
            "effort_command": command,
            "velocity_command": np.roll(wanted, -BUS - delay, axis=0),
        }
        for name, values in columns.items():
            log[f"{wheel.joint}_{name}"] = wheel.sign * values[:, i]
        log[f"{wheel.joint}_mode"] = np.ones(rows)
    return {name: values.copy() for name, values in log.items()}
