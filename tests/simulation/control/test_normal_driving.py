"""A robot that drives normally is not stopped, and not warned."""

import pytest
from robot_control import ClosedLoop
from simulation.corpus import ABSENT as NO_CORPUS
from simulation.corpus import FOLDER

from bench.drives import turning_drive
from bench.drives.normal_driving import Drive, all_drives, bench, carry_out
from bench.odometry.recordings import ABSENT, recordings_folder
from bench.robot_corpus import DIFFBOT, SCENES

ONE_MINUTE, TWO_MINUTES, TEN_MINUTES = 1 / 120, 1 / 60, 1 / 12  # shares of the two hours


@pytest.mark.parametrize("share", [TWO_MINUTES, pytest.param(TEN_MINUTES, marks=pytest.mark.nightly)])
def test_a_share_of_all_scenes_robots_and_rates_without_a_false_stop(share):
    lines = []
    result, fine = bench(share, lines.append)
    assert fine, "\n".join(lines)
    figures = {row["name"]: row["value"] for row in result["rows"]}
    assert figures["distance"] / figures["simulated"] > 0.5, "km/h: it hardly moved"


@pytest.mark.parametrize("share", [ONE_MINUTE, pytest.param(TEN_MINUTES, marks=pytest.mark.nightly)])
def test_nor_with_sensors_that_err_as_in_the_field(share):
    lines = []
    assert bench(share, lines.append, errors="field")[1], "\n".join(lines)


@pytest.mark.nightly
@pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)
def test_nor_with_vibrations_as_they_were_recorded():
    lines = []
    assert bench(TEN_MINUTES, lines.append, errors="recorded")[1], "\n".join(lines)


def test_all_of_it_takes_an_hour_and_a_half_of_the_own_robot():
    own = [drive for drive in all_drives(1.0) if drive.robot == DIFFBOT]
    assert sum(drive.seconds for drive in own) >= 1.5 * 3600
    assert {drive.scene for drive in own} == set(SCENES)


@pytest.mark.parametrize("scene", ["flat", "bumps"])
def test_a_drive_is_the_same_each_time(scene):
    drive = Drive(DIFFBOT, scene, 1000, 5.0, 1)
    assert carry_out(drive) == carry_out(drive)


# Its targets lie where the gate's taper begins, and its joints damp so much that an integrator unwinds for seconds.
@pytest.mark.skipif(FOLDER is None, reason=NO_CORPUS)
@pytest.mark.parametrize("seed", [5014, 5026])
def test_wheels_that_the_gate_clamped_stand_when_they_are_to(seed):
    driven = carry_out(Drive("diffbot_ros2control", "flat", 500, 20.0, seed))
    assert (driven.causes, driven.warnings) == ([], [])


# Its inner wheel nearly stands and holds its side with 0.8 of its torque limit while the other one goes around it.
@pytest.mark.skipif(FOLDER is None, reason=NO_CORPUS)
@pytest.mark.parametrize("seed", [42, 52])
def test_a_wheel_that_stands_while_a_curve_begins_is_not_stalled(seed):
    turning = turning_drive.carry_out("create_2", seed)
    assert (turning.causes, turning.warnings) == ((), ())


@pytest.mark.parametrize(("ground", "slides"), [(0.02, True), (1.0, False)])
def test_tyres_slide_by_truth_where_the_ground_is_slippery(ground, slides):
    loop = ClosedLoop({"mujoco_plant": {"ground_friction": ground}})
    log = loop.run(1.0, (0.0, 2.0))
    assert turning_drive.slides(loop, log) == slides
