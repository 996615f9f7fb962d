"""Who drives normally is not stopped, and not warned."""

import pytest
from lab.drives.normal_driving import Drive, all_drives, bench, carry_out
from lab.odometry.recordings import ABSENT, recordings_folder
from lab.robot_corpus import DIFFBOT, SCENES

ONE_MINUTE, TWO_MINUTES, TEN_MINUTES = 1 / 120, 1 / 60, 1 / 12  # of the two hours


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
