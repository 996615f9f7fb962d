"""Descriptions of real robots drive as they are, without hand-written additions."""

import os

import numpy as np
import pytest
from robot_control import ClosedLoop, RobotError
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


def processor_time() -> float:
    """s, of this process and of its children that read meshes."""
    return sum(os.times()[:4])


def rim_speeds(loop: ClosedLoop, log, side: str) -> np.ndarray:
    """Mean rim speed [m/s] of a side's wheels, forward positive, shape (cycles,)."""
    wheels = [wheel for wheel in loop.robot["wheels"] if wheel["side"] == side]
    return np.mean([wheel["sign"] * wheel["radius"] * log[f"{wheel['joint']}_velocity"] for wheel in wheels], axis=0)


def test_is_understood_as_it_is_in_under_two_seconds(robot):
    began = processor_time()
    loop = make(robot)
    assert processor_time() - began < 2.0
    truth, model = robot.truth, loop.robot
    for side in ("left", "right"):
        wheels = {wheel["joint"]: wheel for wheel in model["wheels"] if wheel["side"] == side}
        assert sorted(wheels) == sorted(truth[side])
        signs = dict(zip(truth[side], truth[f"sign_{side}"], strict=True))
        assert {joint: wheel["sign"] for joint, wheel in wheels.items()} == signs
        for wheel in wheels.values():
            assert wheel["radius"] == pytest.approx(truth["radius_collision"], rel=0.01)
    assert model["wheel_base"] == pytest.approx(truth["separation_wheel_centres"], rel=0.01)
    assert model["mass"] == pytest.approx(truth["mass_declared"], rel=1e-4)
    if robot.skid_steer:
        assert model["wheel_base_multiplier"] == pytest.approx(truth["icr_factor_1+(L/B)^2"], rel=0.01)


def test_stands_still(robot):
    log = make(robot).run(30.0)
    assert np.max(np.hypot(log["truth_x"], log["truth_y"])) <= 1e-3


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


def test_a_hard_stop_from_full_speed_does_not_tip(robot):
    loop = make(robot)
    loop.run(RAMP, (10.0, 0.0))
    loop.e_stop()
    log = loop.run(3.0)
    assert np.degrees(np.max(log["truth_tilt"])) < 10
    assert abs(log["truth_linear"][-1]) < 1e-3


@pytest.mark.parametrize(("name", "reason"), [("my_bot", "wheel"), ("p3dx_amr", "fixed")])
def test_what_cannot_drive_is_refused_with_the_reason(name, reason):
    assert corpus.FOLDER is not None
    with pytest.raises(RobotError, match=reason):
        ClosedLoop(urdf=corpus.FOLDER / name / "robot.urdf")
