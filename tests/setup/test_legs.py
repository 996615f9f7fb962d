"""Robots on legs in Python: kinematics, and what inspect_robot.py says of them."""

import numpy as np
import pytest
from robot_control import ClosedLoop, RobotError
from robot_control.installed_files import share_file
from robot_control.legs import forward, inverse, jacobian
from robot_control.setup.description import describe, mjcf, stand
from robot_control.setup.inspect.report import report

QUADBOT = share_file("urdf/quadbot.urdf")
ANGLES = np.array([0.1, 0.8, -1.6, -0.1, 0.7, -1.5, 0.2, 0.9, -1.4, 0.0, 0.6, -1.2])


def test_inverse_leads_back_to_the_angles():
    angles, reach = inverse(QUADBOT, forward(QUADBOT, ANGLES))
    assert reach == ["reached"] * 4
    np.testing.assert_allclose(angles, ANGLES, atol=1e-12)


def test_jacobian_is_the_derivative_of_forward():
    columns = jacobian(QUADBOT, ANGLES)
    step = 1e-6
    for joint in range(12):
        moved = ANGLES + step * (np.arange(12) == joint)
        difference = (forward(QUADBOT, moved) - forward(QUADBOT, ANGLES)) / step
        expected = np.zeros((4, 3))
        expected[joint // 3] = columns[joint // 3][:, joint % 3]
        np.testing.assert_allclose(difference, expected, atol=1e-6)


def test_a_foot_out_of_reach_is_named():
    feet = forward(QUADBOT, ANGLES)
    feet[2] += [0, 0, -1]
    assert inverse(QUADBOT, feet)[1] == ["reached", "reached", "beyond reach", "reached"]


@pytest.mark.parametrize("angles", [np.zeros(11), np.full(12, np.nan)])
def test_angles_of_another_shape_and_not_finite_ones_are_refused(angles):
    with pytest.raises(ValueError, match="angles must"):
        forward(QUADBOT, angles)


def test_a_robot_on_wheels_has_no_legs():
    with pytest.raises(RobotError, match="legs found"):
        forward(share_file("urdf/diffbot.urdf"), ANGLES)


def test_a_quadruped_is_reported_with_its_legs():
    robot = describe(QUADBOT)
    robot["standing"] = stand(QUADBOT)
    text = report(robot)
    assert "front left   front_left_hip_joint, front_left_thigh_joint, front_left_knee_joint" in text
    assert "lies               leaning 0.00°" in text
    assert [leg["place"] for leg in robot["legs"]] == ["front_left", "front_right", "rear_left", "rear_right"]


def test_its_simulated_model_keeps_its_joints():
    assert mjcf(QUADBOT).count("_joint") >= 12


def test_a_closed_loop_on_legs_moves_its_joints_while_it_lies_and_stands_up():
    loop = ClosedLoop(urdf=QUADBOT, params={"mujoco_plant": {"sensor_errors": "ideal"}})
    knee = "front_left_knee_joint"
    lying = loop.step(300)
    folded = lying[f"{knee}_position"][-1]
    names = [joint["name"] for joint in loop.robot["joints"]]
    resting = loop.step()
    place = [resting[f"{name}_position"][-1] for name in names]
    for _ in range(10):
        place[0] += 0.02  # swings the leg outwards, away from the ground
        loop.joint_targets(place)
        loop.step(50)
    loop.joint_targets(place)
    assert loop.step(200)[f"{names[0]}_position"][-1] == pytest.approx(place[0], abs=0.01)
    for _ in range(3):
        loop.set_posture("standing")
        stands = loop.step(1000)
        standing = stands[f"{knee}_position"][-1]
    assert standing > folded + 0.5
    assert stands["truth_z"][-1] > lying["truth_z"][-1] + 0.2
    assert max(abs(stands[f"truth_{name}"][-1]) for name in ("lateral", "vertical")) < 1e-3
    loads = [values[-1] for name, values in stands.items() if name.endswith("_truth_normal_force")]
    slips = [values[-1] for name, values in stands.items() if name.endswith("_truth_slip")]
    assert sum(loads) == pytest.approx(9.81 * loop.robot["mass"], rel=0.01)
    assert len(loads) == len(slips) == 4
    assert max(slips) < 1e-3
    for _ in range(5):
        loop.body_pose(height=-0.03)
        lower = loop.step(200)[f"{knee}_position"][-1]
    assert folded + 0.5 < lower < standing - 0.1


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda loop: loop.set_posture("sitting"), "unknown posture 'sitting'; set one of lying, standing"),
        (lambda loop: loop.foot_target("tail"), "unknown foot 'tail'; set one of front_left, front_right"),
        (lambda loop: loop.joint_targets([0.0] * 11), r"positions must have the shape \(12,\)"),
    ],
)
def test_an_unknown_word_and_another_number_of_joints_are_refused(call, words):
    with pytest.raises(ValueError, match=words):
        call(ClosedLoop(urdf=QUADBOT))
