"""A run that is healthy by construction, for tests that break one thing each."""

import numpy as np
from robot_control.loop.signal_names import mask_of

LINEAR, ANGULAR = 0.5, 0.2  # m/s, rad/s
BEGIN, SECONDS = 300, 8.0  # cycle of the first request; how long it is repeated
PERIOD = 0.001  # s
RAMP = 0.5  # s, at 1 m/s²
END = BEGIN + round(SECONDS / PERIOD)  # cycle of the zero
CYCLES = END + 1000
NO_COMMAND = mask_of("GateReason", "no_command")


def integrate(linear, angular):
    """x, y, yaw of a body that moves with these speeds; midpoint rule, 3·10⁻⁹ m off an exact arc after 8 s."""
    yaw = np.concatenate(([0.0], np.cumsum(angular[:-1] * PERIOD)))
    middle = yaw + angular * PERIOD / 2
    x = np.concatenate(([0.0], np.cumsum((linear * np.cos(middle) * PERIOD)[:-1])))
    y = np.concatenate(([0.0], np.cumsum((linear * np.sin(middle) * PERIOD)[:-1])))
    return x, y, yaw


def with_truth(log, linear, angular):
    """The same log with another motion of the body and of the estimate."""
    log = dict(log)
    log["truth_linear"], log["truth_angular"] = linear, angular
    log["truth_x"], log["truth_y"], log["truth_yaw"] = integrate(linear, angular)
    for name in ("linear", "angular", "x", "y", "yaw"):
        log[f"estimate_{name}"] = log[f"truth_{name}"].copy()
    return log


def healthy_run():
    """Rests, ramps to the command, keeps it for `SECONDS`, ramps to rest; truth follows two cycles later."""
    cycle = np.arange(CYCLES, dtype=float)
    shape = np.clip((cycle - BEGIN) * PERIOD / RAMP, 0, 1) - np.clip((cycle - END) * PERIOD / RAMP, 0, 1)
    asked = ((cycle >= BEGIN) & (cycle < END)).astype(float)
    zero = np.zeros(CYCLES)
    log = {
        "run": zero,
        "cycle": cycle,
        "time": cycle * PERIOD,
        "requested_linear": LINEAR * asked,
        "requested_angular": ANGULAR * asked,
        "limited_linear": LINEAR * shape,
        "limited_angular": ANGULAR * shape,
        "left_wheel_joint_effort": 0.2 * shape,
        "left_wheel_joint_effort_command": 0.2 * shape,
        "right_wheel_joint_effort": 0.3 * shape,
        "right_wheel_joint_effort_command": 0.3 * shape,
        "gate_verdict": np.where(cycle < 1, 0.0, 1.0),
        "gate_reasons": np.where(cycle < 1, 1.0, 0.0),
        "held": zero,
        "missed": zero,
        "late_permits": zero,
        "supervisor_state": np.where(cycle < 2, 0.0, np.where(cycle < BEGIN, 1.0, 2.0)),
        "permit_causes": zero,
        "stamp_ns": 5e12 + cycle * 1e6,
        "driver_woke_ns": np.full(CYCLES, 4_000.0),
        "command_published_ns": np.full(CYCLES, 11_000.0),
        "permit_published_ns": np.full(CYCLES, 9_000.0),
        "overruns": zero,
        "slipped_ns": zero,
    }
    delayed = np.concatenate(([0.0, 0.0], shape[:-2]))
    return with_truth({name: values.copy() for name, values in log.items()}, LINEAR * delayed, ANGULAR * delayed)


def brake_at(log, cycle, reasons=NO_COMMAND):
    """A gate that braked in `cycle`, for want of a command unless set otherwise."""
    log["gate_verdict"][cycle] = 0
    log["gate_reasons"][cycle] = reasons
    log["missed"][cycle:] += 1
