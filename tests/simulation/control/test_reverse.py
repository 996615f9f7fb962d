"""A robot that may reverse only slowly does so."""

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control._robot_control import ParameterError

REVERSE = {
    "min_linear_speed": -0.2,
    "max_linear_acceleration_reverse": 0.4,
    "max_linear_deceleration_reverse": 0.5,
}
DATA_SHEET = {"sensor_errors": "data_sheet"}  # speeds are compared to some per cent


def reversed_from_rest(loop):
    loop.run(1.0, (0.0, 0.0))
    return loop.run(2.0, (-1.0, 0.0))


def test_reverses_with_its_own_speed_and_acceleration_and_forwards_as_before():
    loop = ClosedLoop({"diff_drive_controller": REVERSE, "mujoco_plant": DATA_SHEET})
    back = reversed_from_rest(loop)
    assert back["limited_linear"].min() == -0.2
    assert np.abs(np.diff(back["limited_linear"])).max() / loop.period == pytest.approx(0.4, rel=1e-6)
    assert back["truth_linear"].min() == pytest.approx(-0.2, rel=0.02)
    assert loop.run(3.0, (1.0, 0.0))["truth_linear"][-1] == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize("silence", [False, True])
def test_stops_in_reverse_where_its_limits_predict(silence):
    loop = ClosedLoop({"diff_drive_controller": REVERSE, "mujoco_plant": DATA_SHEET})
    reversed_from_rest(loop)
    log = loop.run(3.0, None if silence else (0.0, 0.0))
    start = int(np.flatnonzero(log["limited_linear"] != -0.2)[0])
    distance = log["truth_x"][start] - log["truth_x"][-1]
    assert distance == pytest.approx(loop.stop_distance(-0.2, emergency=silence), abs=0.003)
    if not silence:
        assert loop.stop_distance(-0.2) > 1.4 * loop.stop_distance(0.2)


def test_reverse_is_set_while_driving():
    loop = ClosedLoop({"mujoco_plant": DATA_SHEET})
    reversed_from_rest(loop)
    loop.set_parameters(REVERSE)
    log = loop.run(3.0, (-1.0, 0.0))
    assert log["truth_linear"][-1] == pytest.approx(-0.2, rel=0.02)
    assert log["min_linear_speed"][-1] == -0.2
    assert np.diff(log["limited_linear"]).max() / loop.period <= 0.5 * (1 + 1e-6)


def test_an_emergency_is_never_weaker_than_a_stop_in_reverse():
    loop = ClosedLoop({"mujoco_plant": DATA_SHEET})
    with pytest.raises(ParameterError, match="max_linear_deceleration_reverse"):
        loop.set_parameters({"max_linear_deceleration_reverse": 3.0, "max_linear_emergency_deceleration": 2.0})
