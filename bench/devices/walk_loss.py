"""One loss behind the simulated drives of quadbot, which trots at `SPEED` in virtual time, and what it may do.

The loss comes at one of `PHASES` phases of a stride, while the request goes on.

    named    its stop latches and the driver's words name it; only where samples cease, encoders_lost may stop before
    upright  the body never leans by more than `LEANS`
    folds    from `FOLD_TIME` after the loss on the robot lies and rests, as in bench/faults/sequence_judge.py
    stands   where motors without a timeout lose all buses: it rests from `STAND_TIME` on
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.loop.closed_loop import Log
from robot_control.loop.drives import DRIVES
from robot_control.loop.signal_names import bits_in, mask_of

from bench.devices.loss_trial import first
from bench.faults.sequence_judge import FOLD_TIME, MEAN_TIME, STANDING_SPEED, resting_speed

SPEED = 0.5  # m/s
RISE_TIME = 3.0  # s, from the rest until it trots evenly
STRIDE = 0.5  # s, of the trot at this speed
PHASES = 20
CAN_RATE, DATAGRAM_RATE = 1000.0, 500.0  # Hz
LOSS, FAULT = 0.02, 0.3  # s until it is named: where samples cease, and what a motor or battery reports
SEEN = 0.01  # s until it is named, where the next sample or report shows it: a few cycles, no time without samples
STAND_TIME = 6.0  # s; on its springs it rocks for some seconds
LEANS = 0.6  # rad; docs/drivers.md states 0.55 after the loss of one bus
LYING = 0.1  # m above the place where it lay; one leg may hold it up
COLUMNS = ("permit_causes", "truth_tilt", "truth_z", "truth_linear", "truth_lateral")
EVERY_JOINT = "every joint"
KNEE = "front_left_knee_joint"
OF_KNEE = f"{KNEE} (node 3): fault; the drive"
ENCODERS_LOST = mask_of("StopCause", "encoders_lost")


@dataclass(frozen=True)
class Loss:
    """A loss has a fault that is injected, s until it is named, words of the driver, and the cause of its stop.

    After it the robot folds, or stands.
    """

    component: str
    fault: str
    latest: float
    words: str
    cause: str = "driver_fault"
    folds: bool = True


CAN = {
    "bus gone": Loss("bus", "off", LOSS, "is silent"),
    "cable of a leg": Loss("can0", "off", LOSS, "is silent"),
    "motor silent": Loss(KNEE, "off", LOSS, f"{OF_KNEE} is silent"),
    "motor unplugged": Loss(KNEE, "unplugged", LOSS, f"{OF_KNEE} is silent"),
    "motor restarts": Loss(KNEE, "reset", LOSS, f"{OF_KNEE} is silent"),
    "second writer": Loss("can0", "second_writer", SEEN, "commanded by another program"),
    "motor hot": Loss(KNEE, "hot", FAULT, f"{OF_KNEE} is too hot"),
    "battery empty": Loss(EVERY_JOINT, "under_voltage", FAULT, "under-voltage"),
}
UNITREE = {
    "line gone": Loss("line", "cut", LOSS, "is silent"),
    "robot off": Loss("robot", "off", LOSS, "is silent"),
    "crc wrong": Loss("robot", "encrypted", LOSS, "wrong check sum"),
    "stale tick": Loss("robot", "frozen", LOSS, "repeats its last"),
    "another robot": Loss("robot", "other_robot", SEEN, "a state of another robot"),
    "motor hot": Loss("motor", "hot", FAULT, "is too hot"),
    "battery empty": Loss("robot", "low_battery", FAULT, "low supply"),
    "e-stop of the remote": Loss("robot", "e_stop", FAULT, "", "e_stop_input"),
}
BRIDGE = {
    "bridge gone": Loss("bridge", "off", LOSS, "lost its bridge"),
    "second writer": Loss("bridge", "second_writer", SEEN, "commanded by another program"),
    "second writer sends": Loss("bridge", "other_commands", SEEN, "commanded by another program"),
    "second robot": Loss("bridge", "other_states", SEEN, "a state of another robot"),
    "motion service begins": Loss("bridge", "active", SEEN, "motion service of its maker to be released"),
    "motion service is asked": Loss("bridge", "asked", SEEN, "motion service of its maker to answer"),
}
LOSSES = {
    "damiao": CAN,
    "cybergear": CAN,
    "ak": {**CAN, "bus gone": replace(CAN["bus gone"], folds=False)},
    "moteus": CAN,
    "unitree_legged": UNITREE,
    "unitree_go": {**UNITREE, "line gone": Loss("line", "cut", LOSS, "lost its bridge"), **BRIDGE},
}


@dataclass(frozen=True)
class WalkLoss:
    """A loss of this kind at the phase `seed`/`PHASES` of a stride; motors on CAN at `can_rate`."""

    drive: str
    kind: str
    seed: int
    can_rate: float = CAN_RATE


@dataclass(frozen=True)
class WalkOutcome:
    """s until the loss was named, the greatest tilt in rad, and the rules that were broken."""

    named: float
    tilt: float
    broken: tuple[str, ...]


def walker_behind(drive: str, seed: int, can_rate: float = CAN_RATE) -> ClosedLoop:
    """Quadbot behind these drives, at the rate of its robot, or at that of the CAN buses."""
    driver = DRIVES[drive].driver
    robot = {"driver": driver, "rate": can_rate if driver == "can" else DATAGRAM_RATE}
    drives = share_file(f"config/drives/{drive}.yaml")
    return ClosedLoop({"robot": robot}, seed=seed, urdf=share_file("urdf/quadbot.urdf"), drives=drives)


def run_loss(trial: WalkLoss) -> WalkOutcome:
    """Runs one trial."""
    loss = LOSSES[trial.drive][trial.kind]
    loop = walker_behind(trial.drive, trial.seed, trial.can_rate)
    loop.run(1.0, columns=COLUMNS)
    loop.run(RISE_TIME + STRIDE * trial.seed / PHASES, (SPEED, 0.0), COLUMNS)
    joints = [joint["name"] for joint in loop.robot["joints"]]
    for component in joints if loss.component == EVERY_JOINT else [loss.component]:
        loop.inject_fault(component, loss.fault)
    log = loop.run((FOLD_TIME if loss.folds else STAND_TIME) + MEAN_TIME, (SPEED, 0.0), COLUMNS)
    causes = log["permit_causes"].astype(np.int64)
    named = first(causes & mask_of("StopCause", loss.cause) != 0)
    before = int(np.bitwise_or.reduce(causes[:named], initial=0))
    broken = tuple(broken_rules(loss, loop, log, before))
    return WalkOutcome(loop.period * named, float(log["truth_tilt"].max()), broken)


def broken_rules(loss: Loss, loop: ClosedLoop, log: Log, before: int) -> Iterator[str]:
    """Yields the rules that the loss breaks, with what was found. `before`: causes that latched before its own."""
    if before & ~(ENCODERS_LOST if loss.latest == LOSS else 0):
        yield f"named: {bits_in('StopCause', before)}"
    if loss.words not in loop.warning:
        yield f"named: {loop.warning}"
    if log["truth_tilt"].max() > LEANS:
        yield f"upright: {log['truth_tilt'].max():.2f} rad"
    speed = resting_speed(log, loop.period, {"truth_linear": 1, "truth_lateral": 1})[-1]
    height = log["truth_z"][-1]
    if speed > STANDING_SPEED or (loss.folds and height > LYING):
        yield f"{'folds' if loss.folds else 'stands'}: {speed:.2f} m/s at {height:.2f} m"
