"""Descriptions of real robots drive as they are, without hand-written additions."""

import numpy as np
import pytest
from robot_control import ClosedLoop
from simulation.corpus import CorpusRobot, drivable_robots

from bench.drives.wheel_command import WHEEL_COMMANDS, for_drives
from simulation import corpus

pytestmark = pytest.mark.skipif(corpus.FOLDER is None, reason=corpus.ABSENT)

SPEED, YAW_RATE = 0.3, 0.5  # m/s, rad/s
RAMP = 3.0  # s, after which the motion is steady


@pytest.fixture(params=drivable_robots(), ids=lambda robot: robot.name)
def robot(request) -> CorpusRobot:
    return request.param


@pytest.fixture(params=[robot for robot in drivable_robots() if robot.skid_steer], ids=lambda robot: robot.name)
def skid_steer(request) -> CorpusRobot:
    return request.param


def make(robot: CorpusRobot, wheel_command: str = "torque") -> ClosedLoop:
    """The robot as described: its centre of gravity is where the description says, and its wheels do not slip at
    random.
    """
    params = for_drives(wheel_command, {"mujoco_plant": {"sensor_errors": "data_sheet"}})
    return ClosedLoop(urdf=robot.urdf, params=params)


def rim_speeds(loop: ClosedLoop, log, side: str) -> np.ndarray:
    """Mean rim speed [m/s] of a side's wheels, forward positive, shape (cycles,)."""
    wheels = [wheel for wheel in loop.robot["wheels"] if wheel["side"] == side]
    return np.mean([wheel["sign"] * wheel["radius"] * log[f"{wheel['joint']}_velocity"] for wheel in wheels], axis=0)


@pytest.mark.parametrize("wheel_command", WHEEL_COMMANDS)
def test_tracks_a_straight_line_and_a_turn(robot, wheel_command):
    loop = make(robot, wheel_command)
    limits = [
        0.6 * joint["velocity_limit"] * robot.truth["radius_collision"]
        for joint in loop.robot["joints"]
        if joint["role"] == "wheel" and joint["velocity_limit"] > 0
    ]
    speed = min([SPEED, *limits])
    log = loop.run(RAMP + 4.0, (speed, 0.0))
    steady = log["time"] >= RAMP
    assert log["truth_linear"][steady].mean() == pytest.approx(speed, rel=0.03)
    if robot.skid_steer:
        return
    rate = min(YAW_RATE, speed / (robot.truth["separation_wheel_centres"] / 2))
    log = make(robot, wheel_command).run(RAMP + 4.0, (0.0, rate))
    assert log["truth_angular"][steady].mean() == pytest.approx(rate, rel=0.05)


def test_a_skid_steer_turns_as_coulomb_friction_says(skid_steer):
    loop = make(skid_steer)
    log = loop.run(RAMP + 4.0, (0.0, YAW_RATE))
    steady = log["time"] >= RAMP
    difference = (rim_speeds(loop, log, "right") - rim_speeds(loop, log, "left"))[steady].mean()
    multiplier = difference / log["truth_angular"][steady].mean() / loop.robot["wheel_base"]
    assert multiplier == pytest.approx(skid_steer.truth["icr_factor_1+(L/B)^2"], rel=0.05)
