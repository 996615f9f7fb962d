"""Robots whose drives close the loops of their wheels' speeds (robot.wheel_command: velocity), in virtual time."""

import numpy as np
import pytest
from robot_control import ClosedLoop, DriverError
from robot_control.installed_files import share_file

from bench.drives.drive_figures import response_time
from bench.drives.wheel_command import for_drives
from bench.robot_corpus import DIFFBOT

SPEED = 0.5
"""m/s"""


def velocity_loop(**plant):
    return ClosedLoop({"robot": {"wheel_command": "velocity"}, "mujoco_plant": {"drive": "velocity", **plant}})


@pytest.mark.parametrize("gain", [0.5, 1.0, 1.5])
@pytest.mark.parametrize("delay", [0, 20])
def test_a_drive_that_takes_no_torque_hardly_overshoots_a_ramp(gain, delay):
    plant = {"drive_feed_forward": False, "drive_gain": gain, "actuator_delay": delay}
    robot = {"wheel_response_time": response_time(DIFFBOT, plant)}
    loop = ClosedLoop(for_drives("velocity", {"robot": robot, "mujoco_plant": plant}))
    log = loop.run(seconds=4.0, command=lambda t: (1.0 if t >= 0.5 else 0, 0))
    assert log["truth_linear"].max() <= 1.005


@pytest.mark.parametrize("gain", [0.5, 1.5])
@pytest.mark.parametrize("delay", [0, 20])
def test_the_robot_drives_and_stops_as_requested(gain, delay):
    log = velocity_loop(drive_gain=gain, actuator_delay=delay).run(
        seconds=6.0, command=lambda t: (SPEED if 0.5 <= t < 4 else 0, 0)
    )
    speed, time = log["truth_linear"], log["time"]
    steady = (time > 2) & (time < 4)
    assert np.sqrt(np.mean((speed[steady] - SPEED) ** 2)) <= 0.03 * SPEED
    assert speed.max() <= 1.02 * SPEED
    assert abs(speed[-1]) < 1e-3
    assert not log["permit_causes"].any()


@pytest.mark.parametrize(
    ("drives", "driver"),
    [("board", "board"), ("odrive", "can"), ("cia402", "can"), ("vesc", "can"), ("roboclaw", "roboclaw")],
)
def test_devices_with_a_speed_loop_of_their_own_drive_and_stop(drives, driver):
    loop = ClosedLoop(
        {"robot": {"wheel_command": "velocity", "driver": driver}}, drives=share_file(f"config/drives/{drives}.yaml")
    )
    log = loop.run(seconds=6.0, command=lambda t: (SPEED if 0.5 <= t < 4 else 0, 0.2 if 0.5 <= t < 4 else 0))
    speed, time = log["truth_linear"], log["time"]
    steady = (time > 2) & (time < 4)
    assert np.sqrt(np.mean((speed[steady] - SPEED) ** 2)) <= 0.03 * SPEED
    assert abs(speed[-1]) < 1e-3
    assert not log["permit_causes"].any()


@pytest.mark.parametrize(
    ("drives", "driver", "takes"), [("odrive", "can", True), ("vesc", "can", False), ("board", "board", False)]
)
def test_the_speed_leads_the_plan_of_drives_that_take_no_torque(drives, driver, takes):
    loop = ClosedLoop(
        {"robot": {"wheel_command": "velocity", "driver": driver}}, drives=share_file(f"config/drives/{drives}.yaml")
    )
    loop.run(seconds=3.0, command=(0, 0))
    log = loop.run(seconds=0.3, command=(SPEED, 0))
    ordered = log["left_wheel_joint_velocity_command"] * loop.robot["wheels"][0]["radius"]
    assert np.allclose(ordered, log["limited_linear"]) == takes


def test_a_roboclaw_is_refused_where_torques_are_commanded():
    with pytest.raises(DriverError, match="commands of torques"):
        ClosedLoop({"robot": {"driver": "roboclaw"}}, drives=share_file("config/drives/roboclaw.yaml")).run(seconds=0.1)


def test_a_torque_that_is_not_measured_is_not_invented():
    log = velocity_loop().run(seconds=1.0, command=(SPEED, 0.2))
    assert np.isnan(log["left_wheel_joint_effort"]).all()
    assert np.isnan(log["right_wheel_joint_effort"]).all()


@pytest.mark.parametrize("fault", ["left_motor stuck", "left_motor wrong", "left_encoder wrong", "left_encoder stuck"])
def test_a_wheel_that_fails_stops_the_robot(fault):
    loop = velocity_loop()
    loop.run(seconds=2.0, command=(SPEED, 0))
    loop.inject_fault(*fault.split())
    log = loop.run(seconds=1.0, command=(SPEED, 0))
    assert log["permit_causes"].any()


@pytest.mark.parametrize(
    ("params", "words"),
    [
        ({"robot": {"wheel_command": "velocity"}}, "speeds that the drives control themselves"),
        ({"mujoco_plant": {"drive": "velocity"}}, "commands of torques"),
    ],
)
def test_drives_without_the_commanded_mode_are_refused(params, words):
    with pytest.raises(DriverError, match=words):
        ClosedLoop(params).run(seconds=0.1)
