"""Identification finds the hidden properties of the MuJoCo plant, and its proposals drive better."""

from functools import cache

import numpy as np
import pytest
import yaml
from robot_control import ClosedLoop
from robot_control._robot_control import wheel_loops
from robot_control.installed_files import share_file
from robot_control.settings.block import Settings
from robot_control.setup.identify.evaluation import evaluate, parse_options, plan
from robot_control.setup.identify.fit import identify
from robot_control.setup.identify.report import ground_friction
from robot_control.setup.identify.tuning_proposal import base_of
from simulation.corpus import ABSENT, FOLDER
from simulation.skid_steer import write_skid_steer

from bench.robot_corpus import DIFFBOT, urdf_of

PARAMS = share_file("config/robot_params.yaml")
ERRORS = {"sensor_errors": "data_sheet"}  # identification promises its accuracy for sensors that are on time
TOLERANCE = 0.05  # what identification promises
DELAYED = {"pid_kp": 1.0, "pid_ki": 5.0}  # stable with 10 cycles of delay on the ground (wheel_loop_gains.h)
FRICTION_SHARE = 0.02  # share of the effort limit, dry, and as much viscous at 0.5 m/s, as in a good gear motor
OPTIONS = parse_options([])
CORPUS = [
    pytest.param(name, marks=[pytest.mark.nightly, pytest.mark.skipif(FOLDER is None, reason=ABSENT)])
    for name in ("kobuki", "p3dx_mario", "dingo_d")
]


def settings_of(robot, controller):
    values = [("robot.urdf", urdf_of(robot))]
    return Settings(PARAMS, (*values, *((f"diff_drive_controller.{key}", repr(v)) for key, v in controller.items())))


def hidden_in(robot):
    """A load of a quarter of the robot, friction, and a rotor, none of which the URDF knows."""
    wheel = wheel_loops(PARAMS, [("robot.urdf", urdf_of(robot))])[0]
    friction = FRICTION_SHARE * wheel["effort_limit"]
    return {
        "payload": 0.25 * ClosedLoop(urdf=urdf_of(robot)).robot["mass"],
        "motor_friction": friction,
        "motor_damping": friction / (0.5 / wheel["radius"]),
        "rotor_inertia": 0.2 * wheel["lifted"],
    }


def excited(robot, hidden, controller=None):
    """The log of the excitation, and its settings; several cases judge one excitation."""
    return _excited(
        robot, tuple((name, value) for name, value in hidden.items() if value), tuple((controller or {}).items())
    )


@cache
def _excited(robot, hidden, controller):
    hidden, controller = dict(hidden), dict(controller)
    settings = settings_of(robot, controller)
    excitation = plan(settings, OPTIONS)
    loop = ClosedLoop(
        {"mujoco_plant": {**ERRORS, **hidden}, "diff_drive_controller": controller}, seed=1, urdf=urdf_of(robot)
    )
    loop.run(1.0, (0.0, 0.0))
    begin = loop.time
    return loop.run(excitation.seconds + 0.5, lambda time: excitation.command(time - begin)), settings, excitation


def true_straight(robot, hidden):
    """kg·m² of a wheel in straight motion: from the URDF, with rotor and payload."""
    wheel = wheel_loops(PARAMS, [("robot.urdf", urdf_of(robot))])[0]
    load = hidden.get("payload", 0) * wheel["radius"] ** 2 / (2 * wheel["wheels_beside"])
    return wheel["straight"] + hidden.get("rotor_inertia", 0) + load


@pytest.mark.parametrize("robot", [DIFFBOT, *CORPUS])
def test_finds_hidden_inertia_and_friction_within_five_percent(robot):
    hidden = hidden_in(robot)
    log, _, excitation = excited(robot, hidden)
    for side in identify(log, base_of(ClosedLoop(urdf=urdf_of(robot)).robot)).sides:
        assert side.straight.value == pytest.approx(true_straight(robot, hidden), rel=TOLERANCE)
        assert side.friction.value == pytest.approx(hidden["motor_friction"], rel=TOLERANCE)
        assert side.damping.value == pytest.approx(hidden["motor_damping"], rel=TOLERANCE)
    # The plan ends at its begin, and stays in its space.
    assert np.hypot(log["truth_x"][-1], log["truth_y"][-1]) < 0.02
    assert log["truth_x"].max() < excitation.reach + 0.02 < OPTIONS.space


@pytest.mark.parametrize("ground", [pytest.param(0.5, marks=pytest.mark.nightly), 1.0])
def test_finds_the_friction_of_the_ground_under_a_skid_steer(ground, tmp_path):
    settings = Settings(PARAMS, (("robot.urdf", write_skid_steer(tmp_path)),))
    excitation = plan(settings, OPTIONS)
    loop = ClosedLoop({"mujoco_plant": {**ERRORS, "ground_friction": ground}}, urdf=write_skid_steer(tmp_path))
    loop.run(1.0, (0.0, 0.0))
    begin = loop.time
    log = loop.run(excitation.seconds + 0.5, lambda time: excitation.command(time - begin))
    found = ground_friction(identify(log, base_of(loop.robot)), wheel_loops(settings.path, settings.values))
    assert found is not None
    assert found.value == pytest.approx(ground, rel=TOLERANCE)
    assert "ground friction  " in evaluate(log, settings, None, "test").table


def test_finds_the_turning_inertia_that_a_payload_at_the_rim_adds():
    """A kilogram 0.2 m ahead adds 0.04 kg·m² of yaw inertia, 2r²/(b·b') of it at the wheels."""
    without, with_load = (
        identify(excited(DIFFBOT, hidden)[0], base_of(ClosedLoop().robot)).mean("turning").value
        for hidden in ({}, {"payload": 2.0, "payload_x": 0.2, "payload_y": 0.2})
    )
    robot = ClosedLoop().robot
    wheel = robot["wheels"][0]
    middle = wheel["centre"][0]
    lever = 2 * wheel["radius"] ** 2 / (robot["wheel_base"] * robot["effective_wheel_base"])
    added = 2.0 * ((0.2 - middle) ** 2 + 0.2**2) * lever
    assert with_load - without == pytest.approx(added, rel=TOLERANCE)


@pytest.mark.parametrize(
    ("where", "cycles"),
    [
        ("actuator_delay", 6),
        ("sensor_delay", 2),
        *(
            pytest.param(where, cycles, marks=pytest.mark.nightly)
            for where, cycles in (
                ("actuator_delay", 0),
                ("actuator_delay", 2),
                ("sensor_delay", 0),
                ("sensor_delay", 6),
            )
        ),
    ],
)
def test_finds_a_hidden_delay_to_the_cycle(where, cycles):
    log, _, _ = excited(DIFFBOT, {where: cycles, "motor_friction": 0.1}, DELAYED)
    found = identify(log, base_of(ClosedLoop().robot))
    assert round(found.delay.value) == cycles
    assert found.mean("straight").value == pytest.approx(0.065, rel=TOLERANCE)


def tracking_rms(robot, hidden, controller, excitation):
    """m/s and rad/s, true against planned two cycles before, over a ramp there and back and a turn."""
    loop = ClosedLoop(
        {"mujoco_plant": {**ERRORS, **hidden}, "diff_drive_controller": controller}, seed=5, urdf=urdf_of(robot)
    )
    loop.run(1.0, (0.0, 0.0))
    v, w = excitation.linear, excitation.angular
    log = {}
    for name, command in (("linear", (v, 0.0)), ("angular", (0.0, w))):
        parts = [loop.run(2.0, command), loop.run(1.5, (0.0, 0.0))]
        error = [part[f"truth_{name}"][2:] - part[f"limited_{name}"][:-2] for part in parts]
        log[name] = float(np.sqrt(np.mean(np.concatenate(error) ** 2)))
    return log


@pytest.mark.parametrize(
    ("robot", "delay"), [(DIFFBOT, 0), (DIFFBOT, 2), *((pytest.param(*c.values, 0, marks=c.marks)) for c in CORPUS)]
)
def test_what_it_writes_is_read_and_tracks_twice_as_well(robot, delay, tmp_path):
    hidden = {**hidden_in(robot), "actuator_delay": delay}
    log, settings, excitation = excited(robot, hidden)
    file = tmp_path / "identified.yaml"
    file.write_text(evaluate(log, settings, None, "test").yaml)
    proposed = yaml.safe_load(file.read_text())["diff_drive_controller"]
    before = tracking_rms(robot, hidden, {}, excitation)
    after = tracking_rms(robot, hidden, proposed, excitation)
    assert after["linear"] < 0.5 * before["linear"]
    assert after["angular"] < 0.6 * before["angular"]


def test_gains_for_a_delay_that_the_derived_ones_do_not_tolerate_are_proposed_with_a_warning():
    hidden = {"actuator_delay": 6, "motor_friction": 0.1}
    log, settings, _ = excited(DIFFBOT, hidden, DELAYED)
    outcome = evaluate(log, settings, None, "test")
    assert any("tolerate" in sentence and "6 were measured" in sentence for sentence in outcome.warnings)
    proposed = yaml.safe_load(outcome.yaml)["diff_drive_controller"]
    assert proposed["pid_kp"] < DELAYED["pid_kp"]
    loop = ClosedLoop({"mujoco_plant": {**ERRORS, **hidden}, "diff_drive_controller": proposed})
    driven = loop.run(4.0, (0.5, 0.0))
    steady = driven["truth_linear"][driven["time"] > 2.0]
    assert np.abs(steady - 0.5).max() < 0.01, "no limit cycle"


def test_a_weighed_robot_gives_the_wheels_own_inertia():
    hidden = {"rotor_inertia": 0.005, "motor_friction": 0.1}
    log, settings, _ = excited(DIFFBOT, hidden)
    forward = yaml.safe_load(evaluate(log, settings, 12.0, "test").yaml)["diff_drive_controller"]["feed_forward"]
    assert forward["mass"] == 12.0
    # 5 % of 0.07 kg·m² straight, of which the wheel is 0.01.
    assert forward["wheel_inertia"] == pytest.approx(0.01, abs=TOLERANCE * 0.07)


def test_refuses_a_mass_that_the_wheels_do_not_feel():
    log, settings, _ = excited(DIFFBOT, {"motor_friction": 0.1})
    with pytest.raises(ValueError, match="Check the mass"):
        evaluate(log, settings, 20.0, "test")
