"""The estimated pose of a robot that a wall blocks while its wheels spin."""

import numpy as np
import pytest

from bench.drives.sensor_errors import plant_parameters
from bench.odometry.errors import draw_errors
from bench.odometry.program import Program
from bench.odometry.recording import record
from bench.odometry.scenarios import Trial
from bench.odometry.slip import SAFETY
from bench.odometry.tested_estimator import estimate
from bench.odometry.truth import truth_of

SCENE = (
    '<mujoco model="wall"><worldbody><geom name="floor" type="plane" size="50 50 1" friction="0.3 0.005 0.0001"/>'
    '<geom name="ahead" type="plane" size="1 9 1" pos="3.2 0 1" zaxis="-1 0 0" friction="0.5 0.005 0.0001"/>'
    '<site name="start" pos="0 0 0"/></worldbody></mujoco>'
)


@pytest.mark.parametrize("seed", range(3))
def test_wheels_that_spin_against_a_wall_for_five_seconds_are_named_and_widen_the_ellipse(seed):
    program = Program()
    program.stand(3.0)
    program.ramp(0.5, 0.0, 0.5)
    program.drive(0.5, 0.0, 10.7)
    program.stand(2.0)
    errors = draw_errors(seed)
    params = {"mujoco_plant": {**plant_parameters("data_sheet"), **errors.plant()}, "safety_monitor": SAFETY}
    drive = record(Trial("slip", seed, errors, seed, params, program.commands, SCENE))
    truth, ours = truth_of(drive), estimate(drive)
    rolled = 0.1 * (drive.left[-1] - drive.left[0])
    assert rolled - truth.odom.x[-1] > 2.3, "raw"
    off = ours.path.x[-1] - truth.odom.x[-1]
    assert abs(off) <= 3 * np.sqrt(ours.pose_covariance[-1, 0, 0])
    assert ours.slip.any()
