"""The closed loop on the MuJoCo plant, in virtual time."""

import math

import numpy as np
import pytest
from robot_control import ClosedLoop, DriverError, ParameterError, RobotError
from robot_control.installed_files import share_file
from robot_control.loop.signal_names import mask_of, number_of

COMMAND = (0.5, 0.2)  # m/s, rad/s: the article's
SLOPE = share_file("urdf/scenes/slope_5deg.xml")

STOPPED = number_of("SupervisorState", "STOPPED")
BRAKE, PASSED, RAMP = (number_of("GateVerdict", name) for name in ("brake", "passed", "ramp"))
HEARTBEAT_LOST = mask_of("StopCause", "heartbeat_lost")


def path_length(log):
    return float(np.sum(np.hypot(np.diff(log["truth_x"]), np.diff(log["truth_y"]))))


def moved(log, start=0):
    """Largest distance [m] from the pose of row `start`."""
    return float(
        np.max(np.hypot(log["truth_x"][start:] - log["truth_x"][start], log["truth_y"][start:] - log["truth_y"][start]))
    )


def drive(loop, seconds, command=COMMAND):
    return loop.run(seconds, command)


@pytest.fixture
def loop():
    return ClosedLoop()


COMMANDS = [(0.5, 0.2), (-0.5, 0.2), (0.0, 1.0), (0.8, -0.5)]  # m/s, rad/s


def driven_after_a_rest(loop, command):
    drive(loop, 1.0, (0.0, 0.0))  # at rest the gyro's bias is learned
    return drive(loop, 15.0, command)


@pytest.mark.parametrize("command", COMMANDS)
def test_estimates_the_position_within_one_percent_of_the_distance(loop, command):
    log = driven_after_a_rest(loop, command)
    error = math.hypot(log["estimate_x"][-1] - log["truth_x"][-1], log["estimate_y"][-1] - log["truth_y"][-1])
    rim = 0.25 * np.sum(np.abs(np.diff(np.unwrap(log["truth_yaw"]))))  # way of a rim in a spin
    assert error < 0.01 * max(path_length(log), rim)


@pytest.mark.parametrize("command", COMMANDS)
def test_estimates_the_heading_where_the_gyro_is_on_time(command):
    """The field's gyro is late by 50 ms, in which a spin of 1 rad/s turns by 0.05 rad."""
    log = driven_after_a_rest(ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}), command)
    assert abs(math.remainder(log["estimate_yaw"][-1] - log["truth_yaw"][-1], 2 * math.pi)) < 0.01


@pytest.mark.parametrize(("action", "part"), [("coast", 1), ("damp", math.exp(-1))])
def test_a_stop_action_without_a_brake_leaves_this_part_of_the_speed_after_half_a_second(action, part):
    """The wheels' own inertia and friction change it by some percent."""
    loop = ClosedLoop({"robot": {"fail_action": action}})
    before = drive(loop, 3, (0.5, 0))["truth_linear"][-1]
    loop.e_stop()
    assert drive(loop, 0.5, (0.5, 0))["truth_linear"][-1] == pytest.approx(part * before, rel=0.1)


def test_drives_again_after_a_reset_at_rest_without_a_jump(loop):
    drive(loop, 2.0)
    loop.e_stop()
    loop.run(3.0, (0.0, 0.0))
    loop.e_stop_reset()
    rest = loop.run(0.5, (0.0, 0.0))
    assert rest["supervisor_state"][-1] != STOPPED
    assert moved(rest) < 1e-4
    log = drive(loop, 3.0)
    assert np.max(np.diff(log["truth_linear"])) < 2.0 * loop.period  # twice max_linear_acceleration
    assert log["truth_linear"][-1] == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize(("scene", "command"), [(None, (0.5, 0.2)), (SLOPE, (-0.5, 0.0))])
def test_stands_within_a_millimetre_for_a_minute(scene, command):
    """The limit holds from the first cycle of standstill, with the hand-over between drive and brake."""
    loop = ClosedLoop(scene=scene)
    drive(loop, 2.0, command)
    log = loop.run(62.0, (0.0, 0.0))
    wheels = np.abs(log["left_wheel_joint_velocity"]) + np.abs(log["right_wheel_joint_velocity"])
    start = int(np.argmax((log["limited_linear"] == 0) & (log["limited_angular"] == 0) & (wheels < 0.02)))
    assert 0 < start < 2000
    assert moved(log, start) < 1e-3


def test_a_lost_heartbeat_ramps_then_brakes():
    loop = ClosedLoop({"safety_monitor": {"heartbeat_timeout": 0.5}})
    for _ in range(20):
        loop.heartbeat()
        drive(loop, 0.1)
    log = drive(loop, 3.0)
    verdicts = log["gate_verdict"]
    ramp = int(np.argmax(verdicts == RAMP))
    assert ramp * loop.period == pytest.approx(0.5, abs=0.11)
    assert np.all(verdicts[ramp : ramp + 300] == RAMP), "category 1: down under supervision"
    assert verdicts[-1] == BRAKE
    assert int(log["permit_causes"][-1]) & HEARTBEAT_LOST
    assert abs(log["truth_linear"][-1]) < 1e-3


def test_a_new_run_after_a_reset_at_speed_has_the_bits_of_the_first(loop):
    first = drive(loop, 2.0)
    assert first["truth_linear"][-1] > 0.4
    loop.inject_fault("right_motor", "off")
    loop.step(10)
    loop.command(1.0, 0.0)  # this command is dropped
    loop.reset()
    assert loop.cycle == 0
    second = drive(loop, 2.0)
    assert np.all(second["run"] == 1)
    for name in first.keys() - {"run"}:
        assert first[name].tobytes() == second[name].tobytes(), name


def test_an_emergency_stop_given_just_before_a_reset_is_not_lost(loop):
    drive(loop, 1.0)
    loop.e_stop()
    loop.reset()
    assert np.all(drive(loop, 0.5)["supervisor_state"] == STOPPED)


def test_paused_it_steps_and_does_not_run(loop):
    loop.set_pause(True)
    assert loop.paused
    loop.step(5)
    with pytest.raises(RuntimeError, match="set_pause"):
        loop.run(1.0)
    assert loop.cycle == 5
    loop.set_pause(False)
    loop.run(0.01)
    assert loop.cycle == 15


def test_an_injected_fault_shows_and_heals(loop):
    drive(loop, 0.5)
    loop.inject_fault("gyro", "stuck")
    stuck = drive(loop, 0.5)["gyro_z"]
    assert np.all(stuck == stuck[0])
    loop.inject_fault("gyro", "ok")
    healed = drive(loop, 0.5)["gyro_z"]
    assert len(np.unique(healed)) > 100


@pytest.mark.parametrize(("words", "known"), [(("left_wing", "off"), "left_encoder"), (("gyro", "broken"), "garbage")])
def test_refuses_an_unknown_fault_with_the_list(loop, words, known):
    with pytest.raises(ValueError, match=known):
        loop.inject_fault(*words)


def test_steps_and_runs_are_the_same_cycles(loop):
    other = ClosedLoop()
    log = drive(loop, 0.2)
    for row in range(200):
        other.command(*COMMAND)
        assert other.step(1)["truth_x"][0] == log["truth_x"][row]
    assert other.time == loop.time == pytest.approx(0.2)


def test_a_command_script_speaks_like_a_sender(tmp_path):
    script = tmp_path / "script.csv"
    rows = [f"{cycle},0.5,0.2," for cycle in range(1, 2000, 500)]
    script.write_text("cycle,linear,angular,event\n" + "\n".join(rows) + "\n2500,,,e_stop\n")
    loop = ClosedLoop({"robot": {"command_script": str(script)}})
    log = loop.run(3.0)
    assert log["truth_linear"][2400] == pytest.approx(0.5, rel=0.01)
    assert log["gate_verdict"][2501] == BRAKE
    by_hand = ClosedLoop()
    commands = by_hand.run(2.4, lambda t: COMMAND)
    assert np.array_equal(commands["truth_x"], log["truth_x"][:2400])


def test_takes_lists():
    wheels = {"left_wheel_joints": ["left_wheel_joint"], "right_wheel_joints": ("right_wheel_joint",)}
    drive(ClosedLoop({"robot": {**wheels, "centre_of_gravity": np.array([0.0, 0.0, 0.1])}}), 0.1)
    with pytest.raises(RobotError, match=r"no_such_joint"):
        ClosedLoop({"robot": {**wheels, "right_wheel_joints": ["no_such_joint"]}})


@pytest.mark.parametrize(("gains", "cycles"), [({}, 2), ({"pid_kp": 1.0, "pid_ki": 5.0}, 7)])
@pytest.mark.parametrize("where", ["actuator_delay", "sensor_delay"])
def test_gains_bear_delays(gains, cycles, where):
    """A limit cycle would use all of the 3.5 N·m."""
    plant = {"sensor_errors": "data_sheet", where: cycles}
    log = drive(ClosedLoop({"mujoco_plant": plant, "diff_drive_controller": gains}), 4.0)
    steady = log["time"] > 2.0
    assert np.mean(log["truth_linear"][steady]) == pytest.approx(0.5, rel=0.01)
    assert np.std(log["left_wheel_joint_effort"][steady]) < 0.35


def test_refuses_wrong_parameters_all_at_once():
    with pytest.raises(ParameterError) as refusal:
        ClosedLoop({"robot": {"rate": 5}, "diff_drive_controller": {"pid_pk": 1, "max_linear_speed": math.nan}})
    for word in ("robot.rate", "pid_pk", "pid_kp", "max_linear_speed"):
        assert word in str(refusal.value)


INERTIAL = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"


@pytest.mark.parametrize(
    ("what", "text", "error", "said"),
    [
        (
            "scene",
            "<mujoco><worldbody><geom type='no_such_type'/></worldbody></mujoco>",
            DriverError,
            "no_such_type|keyw",
        ),
        ("urdf", f"<robot name='r'><link name='base_link'>{INERTIAL}</link></robot>", RobotError, "no joint turns"),
        ("urdf", None, RobotError, r"given\.xml"),
    ],
)
def test_refuses_a_file_that_is_none(tmp_path, what, text, error, said):
    if text is not None:
        (tmp_path / "given.xml").write_text(text)
    with pytest.raises(error, match=said):
        ClosedLoop(**{what: tmp_path / "given.xml"})


@pytest.mark.parametrize("command", [5, (1,), (1, 2, 3, 4), lambda t: None, lambda t: "fast"])
def test_refuses_a_command_that_is_not_two_or_three_numbers(loop, command):
    with pytest.raises(TypeError, match="linear, angular"):
        loop.run(0.01, command)
    assert drive(loop, 0.01)["time"].shape == (10,), "the loop continues"


def test_refuses_to_step_inside_its_own_run(loop):
    with pytest.raises(RuntimeError, match="command function"):
        loop.run(0.01, lambda t: loop.step() and (0, 0))
    with pytest.raises(RuntimeError, match="command function"):
        loop.run(0.01, lambda t: loop.reset() or (0, 0))
