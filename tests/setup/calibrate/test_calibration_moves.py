"""Tests calibrate.py's pilot on a robot that follows its commands exactly, but late."""

import math

import numpy as np
import pytest
from robot_control.robot.pose import Pose
from robot_control.setup.calibrate.moves import CREEP, Pilot, square, straight

PERIOD = 0.05  # s
DELAY = 2  # periods


def drive(moves, start=None, speed=0.3, turn_speed=0.6):
    """Poses of a unicycle that obeys DELAY periods late; the commands."""
    pilot = Pilot(moves, speed, turn_speed)
    pose = start or Pose(0.0, 0.0, 0.0)
    poses, commands = [pose], []
    late = [(0.0, 0.0)] * DELAY
    for tick in range(20_000):
        if pilot.done:
            return np.array([(p.x, p.y, p.yaw) for p in poses]), np.array(commands)
        commands.append(pilot.command(pose, tick * PERIOD))
        late.append(commands[-1])
        v, w = late.pop(0)
        middle = pose.yaw + w * PERIOD / 2
        yaw = math.remainder(pose.yaw + w * PERIOD, 2 * math.pi)
        pose = Pose(pose.x + v * PERIOD * math.cos(middle), pose.y + v * PERIOD * math.sin(middle), yaw)
        poses.append(pose)
    raise AssertionError("it never ends")


def test_drives_a_line_to_its_end_and_stops():
    poses, commands = drive(straight(2.0))
    assert poses[-1, 0] == pytest.approx(2.0, abs=CREEP * PERIOD * (DELAY + 2))
    assert abs(poses[-1, 1]) < 1e-9
    assert commands[:, 0].max() == 0.3
    assert tuple(commands[-1]) == (0.0, 0.0)


def test_begins_wherever_it_stands():
    poses, _ = drive(straight(1.0), Pose(3.0, -2.0, 2.0))
    ahead = Pose(*poses[-1]).seen_from(Pose(3.0, -2.0, 2.0))
    assert ahead == pytest.approx((1.0, 0.0), abs=0.005)


@pytest.mark.parametrize("clockwise", [True, False])
def test_closes_a_square_on_the_named_side(clockwise):
    poses, commands = drive(square(1.5, clockwise=clockwise))
    assert np.linalg.norm(poses[-1, :2]) < 0.02
    assert abs(poses[-1, 2]) < math.radians(1.0)
    assert poses[:, 0].max() == pytest.approx(1.5, abs=0.02)
    far = poses[:, 1].min() if clockwise else poses[:, 1].max()
    assert abs(far) == pytest.approx(1.5, abs=0.02)
    assert np.abs(commands[:, 1]).max() == 0.6
    assert (commands[:, 0] >= 0).all()


def test_returns_to_the_line_when_pushed_aside():
    pilot = Pilot(straight(3.0), 0.3, 0.6)
    pilot.command(Pose(0.0, 0.0, 0.0), 0.0)
    assert pilot.command(Pose(1.0, 0.1, 0.0), 0.1)[1] < 0
    assert pilot.command(Pose(1.0, -0.1, 0.0), 0.2)[1] > 0
    assert pilot.command(Pose(1.0, 0.0, 0.1), 0.3)[1] < 0
