"""Limits and gains changed while the robot drives, on the MuJoCo plant."""

import numpy as np
import pytest
from robot_control import ClosedLoop, ParameterError
from robot_control.loop.signal_names import number_of

COMMAND = (0.5, 0.2)  # m/s, rad/s
STOPPED = number_of("SupervisorState", "STOPPED")

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
