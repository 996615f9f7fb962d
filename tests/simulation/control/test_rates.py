"""Any rate of the loop: what holds at each of them, and what a slow loop does as its node says at the start."""

import numpy as np
import pytest
from robot_control import ClosedLoop, ParameterError
from robot_control.installed_files import share_file
from robot_control.loop.signal_names import causes_in, mask_of, number_of

from bench.legs import urdfs

RATES = (20, 50, 100, 333, 2000)
"""Hz"""
SLOPE = share_file("urdf/scenes/slope_5deg.xml")
QUADBOT, *OTHERS = urdfs()
ON_LEGS = [QUADBOT, *(pytest.param(urdf, marks=pytest.mark.nightly) for urdf in OTHERS)]
BRAKE = number_of("GateVerdict", "brake")
E_STOP = mask_of("StopCause", "e_stop_service")

at_every_rate = pytest.mark.parametrize("rate", RATES)


def loop_at(rate, plant=None, **given):
    errors = {"sensor_errors": "data_sheet", **(plant or {})}
    return ClosedLoop({"robot": {"rate": rate}, "mujoco_plant": errors}, **given)


def stopped(log):
    return log["permit_causes"].astype(np.uint64) != 0


def seconds_until(rows, log):
    assert rows.any()
    return log["time"][np.argmax(rows)] - log["time"][0]


@at_every_rate
def test_the_shipped_parameters_drive(rate):
    log = ClosedLoop({"robot": {"rate": rate}}).run(6.0, (0.5, 0.0))
    assert not stopped(log).any()
    assert log["truth_linear"][-1] == pytest.approx(0.5, rel=0.03)


@at_every_rate
def test_follows_the_commanded_speed_knows_its_place_and_notices_a_silent_sender_in_seconds(rate):
    loop = loop_at(rate)
    loop.run(2.0, (0.0, 0.0))
    log = loop.run(12.0, (0.5, 0.0))
    assert np.mean(log["truth_linear"][log["time"] > 4.0]) == pytest.approx(0.5, rel=0.01)
    assert not stopped(log).any()
    error = np.hypot(*(log[f"estimate_{name}"][-1] - log[f"truth_{name}"][-1] for name in ("x", "y")))
    assert error < 0.01 * np.hypot(np.ptp(log["truth_x"]), np.ptp(log["truth_y"]))
    log = loop.run(3.0)
    rest = seconds_until(np.abs(log["truth_linear"]) < 0.01, log)
    assert rest == pytest.approx(1.65, abs=0.05 + 2.0 / rate), "cmd_vel_timeout and the emergency ramp"


@at_every_rate
def test_turns_within_the_time_in_which_the_loops_correct(rate):
    """The friction of a turn is not in the plan; below 100 Hz the integrator finds it in the time of the note."""
    settled = {20: 20.0, 50: 6.0}.get(rate, 3.0)
    log = loop_at(rate).run(settled + 5.0, (0.5, 0.2))
    turn = np.mean(log["truth_angular"][log["time"] > settled])
    assert turn == pytest.approx(0.2, rel=0.2 if rate == 20 else 0.01)


@at_every_rate
def test_bears_steps_in_both_directions(rate):
    log = loop_at(rate).run(12.0, lambda t: (0.8 * np.sign(np.sin(t)), 1.5 * np.sign(np.cos(1.3 * t))))
    assert not stopped(log).any()
    assert np.abs(log["truth_linear"]).max() < 0.9


@at_every_rate
def test_an_emergency_stop_brakes_in_the_next_cycle_but_one(rate):
    loop = loop_at(rate)
    loop.run(4.0, (1.0, 0.0))
    loop.e_stop()
    log = loop.run(3.0, (1.0, 0.0))
    assert np.argmax(log["gate_verdict"] == BRAKE) <= 2
    assert log["truth_x"][-1] - log["truth_x"][0] < 0.16 + 3.0 / rate
    assert abs(log["truth_linear"][-1]) < 1e-6


@at_every_rate
def test_holds_on_a_slope_and_drives_up(rate):
    loop = loop_at(rate, scene=SLOPE)
    rest = loop.run(4.0, (0.0, 0.0))
    assert np.abs(rest["truth_x"] - rest["truth_x"][0]).max() < 1e-3
    up = loop.run(8.0, (0.5, 0.0))
    assert up["truth_linear"][-1] == pytest.approx(0.5, rel=0.01)
    assert not stopped(up).any()


@at_every_rate
def test_a_stuck_encoder_stops_the_robot(rate):
    loop = loop_at(rate)
    loop.run(3.0, (0.5, 0.0))
    loop.inject_fault("left_encoder", "stuck")
    log = loop.run(6.0, (0.5, 0.0))
    assert seconds_until(stopped(log), log) < 0.2 + 100.0 / rate
    assert np.abs(log["truth_linear"]).max() < 1.25


@at_every_rate
def test_a_quadruped_stands_leans_and_folds_or_its_rate_is_refused(rate):
    if rate < 100:
        with pytest.raises(ParameterError, match=r"a robot on legs falls below 100 Hz"):
            loop_at(rate, urdf=QUADBOT)
        return
    loop = loop_at(rate, urdf=QUADBOT)
    loop.run(0.5)
    loop.set_posture("standing")
    up = loop.run(4.0)
    loop.body_pose(height=-0.03, roll=0.1)
    pose = loop.run(3.0)
    assert not stopped(up).any()
    assert not stopped(pose).any()
    assert np.abs(up["truth_tilt"]).max() < 0.01
    assert pose["truth_tilt"][-1] == pytest.approx(0.1, abs=0.001)
    still = pose["time"] > pose["time"][-1] - 1.0
    assert np.ptp(pose["truth_tilt"][still]) < 1e-4, "no ripple"
    loop.e_stop()
    fold = loop.run(3.0)
    assert np.abs(fold["truth_tilt"]).max() < 0.15
    assert fold["permit_causes"][-1] == E_STOP


@pytest.mark.parametrize(
    ("gait", "twist"), [(None, (0.5, 0.0, 0.0)), (None, (0.3, 0.2, 0.5)), ("crawl", (0.2, 0.0, 0.0))]
)
@pytest.mark.parametrize("rate", [100, 150, 200, 300, 500, 2000])
@pytest.mark.parametrize("urdf", ON_LEGS)
def test_a_quadruped_walks(urdf, rate, gait, twist):
    loop = loop_at(rate, {"contact_sensors": False}, urdf=urdf)
    loop.run(3.0, (0.0, 0.0, 0.0))
    if gait is not None:
        loop.set_gait(gait)
    log = loop.run(6.0, twist)
    assert not stopped(log).any(), causes_in(log["permit_causes"])
    upright, steady = (log["time"] > log["time"][0] + begin for begin in (2.0, 4.0))
    assert np.abs(log["truth_tilt"][upright]).max() < 0.1
    assert np.mean(log["truth_linear"][steady]) == pytest.approx(twist[0], rel=0.07)


@pytest.mark.parametrize("rate", [100, 200, 2000])
@pytest.mark.parametrize("kind", ["off", "wrong"])
def test_a_motor_of_a_walking_quadruped_that_gives_another_torque_is_named(rate, kind):
    loop = loop_at(rate, {"contact_sensors": False}, urdf=QUADBOT)
    loop.run(5.0, (0.5, 0.0, 0.0))
    loop.inject_fault("rear_left_knee_joint_motor", kind)
    log = loop.run(2.0, (0.5, 0.0, 0.0))
    assert seconds_until(stopped(log), log) < 0.3
    assert causes_in(log["permit_causes"][: np.argmax(stopped(log)) + 1]) == ["joint_following"]


@pytest.mark.parametrize("dialect", ["odrive", "cia402"])
@at_every_rate
def test_drives_on_can_drive_and_brake(rate, dialect):
    file = share_file(f"config/drives/{dialect}.yaml")
    if rate == 2000:
        with pytest.raises(ParameterError, match=r"set robot\.rate to at most"):
            loop_at(rate, drives=file)
        return
    loop = loop_at(rate, drives=file)
    log = loop.run(8.0, (0.5, 0.0))
    assert np.mean(log["truth_linear"][log["time"] > 3.0]) == pytest.approx(0.5, rel=0.01)
    assert not stopped(log).any()
    loop.e_stop()
    log = loop.run(24.0, (0.5, 0.0))
    assert np.ptp(log["truth_x"]) < 0.05 + 22.0 / rate, "the brake's time constant, proportional to the period"
    assert abs(log["truth_linear"][-1]) < 0.005
