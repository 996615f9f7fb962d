"""Limits and gains changed while the robot drives, on the MuJoCo plant."""

import numpy as np
import pytest
from robot_control import ClosedLoop, ParameterError
from robot_control.loop.signal_names import number_of

COMMAND = (0.5, 0.2)  # m/s, rad/s
STOPPED = number_of("SupervisorState", "STOPPED")
EFFORTS = ("left_wheel_joint_effort_command", "right_wheel_joint_effort_command")

DATA_SHEET = {"mujoco_plant": {"sensor_errors": "data_sheet"}}  # torques are compared to a thousandth


@pytest.fixture
def loop():
    return ClosedLoop(DATA_SHEET)


def test_the_log_shows_from_which_cycle_on_which_values_held(loop):
    before = loop.run(1.0, COMMAND)
    loop.set_parameters({"max_linear_speed": 0.4, "pid_kp": 1.0})
    after = loop.run(1.0, COMMAND)
    assert np.all(before["tuning"] == 0)
    assert np.all(after["tuning"] == 1)
    assert after["cycle"][0] == before["cycle"][-1] + 1
    for name, old, new in (("max_linear_speed", 1.0, 0.4), ("left_wheel_joint_pid_kp", 2.0, 1.0)):
        assert before[name] == pytest.approx(old), name
        assert np.all(after[name] == new), name
    # A gain that is left out stays derived: ki is kp²/(3·J_straight), from the new kp.
    ratio = after["right_wheel_joint_pid_ki"][0] / before["right_wheel_joint_pid_ki"][0]
    assert ratio == pytest.approx(0.25, rel=0.1)
    assert loop.units["max_linear_speed"] == "m/s"


@pytest.mark.parametrize(
    ("values", "jump"),
    [
        # N·m. The integrator changes in one cycle by (20 − 5) N·m/rad · 0.3 rad/s · 1 ms.
        ({"pid_kp": 1.0, "pid_ki": 5.0, "pid_kd": 0.001}, 5e-3),
        # Without the hand-over 2 kg · 1 m/s² · 0.1 m/2 = 0.1, of which 1 % decays in the first cycle.
        ({"feed_forward": {"mass": 14.0, "wheel_friction": 0.05}, "pid_kp": 2, "pid_ki": 20}, 2e-3),
        # The same sample has another weight: half of the effect of an encoder's count, kp · 0.06 rad/s.
        ({"tracking_bandwidth": 15}, 0.06),
    ],
    ids=["gains", "feed_forward", "bandwidth"],
)
def test_the_torque_of_the_next_cycle_does_not_jump(values, jump):
    tuned, left = ClosedLoop(DATA_SHEET), ClosedLoop(DATA_SHEET)
    for loop in (tuned, left):
        loop.run(0.4, (1.0, 0.5))  # in the middle of the ramp: error and integral are not zero
    tuned.set_parameters(values)
    one, two = tuned.step(), left.step()
    for name in EFFORTS:
        assert one[name] == pytest.approx(two[name], abs=jump), name
    log = tuned.run(3.0, (1.0, 0.5))
    assert np.all(log["supervisor_state"] != STOPPED)
    assert log["truth_linear"][-500:].mean() == pytest.approx(1.0, rel=0.01)


def test_a_lowered_speed_is_returned_to_within_deceleration_and_jerk(loop):
    loop.run(3.0, (1.0, 0.0))
    loop.set_parameters({"max_linear_speed": 0.5})
    log = loop.run(1.5, (1.0, 0.0))
    deceleration = -np.diff(log["limited_linear"]) / loop.period
    assert deceleration.max() == pytest.approx(1.0, abs=1e-9)  # as the acceleration
    assert np.abs(np.diff(deceleration)).max() / loop.period < 10.0 * (1 + 1e-6)
    assert log["limited_linear"][-1] == 0.5
    assert log["truth_linear"][-1] == pytest.approx(0.5, rel=0.02)


@pytest.mark.parametrize(
    "values", [{}, {"pid_kp": "1}\n---\n{"}, {"pid_kp": None}, {"a: 1, pid_kp": 1}, {"pid_kp": {}}]
)
def test_what_is_no_set_of_values_is_refused(loop, values):
    with pytest.raises(ParameterError, match="refused"):
        loop.set_parameters(values)


def test_the_fastest_speeds_that_are_accepted_cause_no_stop(loop):
    values = {"max_linear_speed": 1.2, "max_angular_speed": 2.0}
    loop.set_parameters(values)
    log = loop.run(5.0, tuple(values.values()))
    assert log["limited_linear"][-1] == 1.2
    assert np.all(log["supervisor_state"] != STOPPED)
    with pytest.raises(ParameterError, match="safety_monitor"):
        loop.set_parameters({"max_linear_speed": 1.3})


def test_a_set_outlasts_a_reset_of_the_robot_but_not_a_new_loop(loop):
    loop.set_parameters({"max_linear_speed": 0.3})
    loop.reset()
    assert loop.run(2.0, COMMAND)["limited_linear"].max() == pytest.approx(0.3, abs=1e-12)
    loop.reset(seed=0)
    assert loop.step()["max_linear_speed"] == 1.0
