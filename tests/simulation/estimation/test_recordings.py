"""The odometry on drives of real robots, and on a synthetic one with the same sensor errors.

Each recording is compared with its simple odometry (bench/odometry/recordings.py), and the outdoor one with the path of
its camera. The synthetic drive is compared with the truth.
"""

from pathlib import Path

import numpy as np
import pytest
from robot_control import Estimator
from robot_control.loop.estimator import FLAGS

from bench.odometry.field_drive import Errors, field_drive, load
from bench.odometry.recordings import (
    ABSENT,
    NAMES,
    Recording,
    aligned_rms,
    recording,
    recordings_folder,
    simple_path,
    without_beginning,
)

MADE = Path(__file__).with_name("field_drive.npz")

# m from the simple odometry: at the end, on the way
BOUNDS = {
    "skid_steer_a": (0.6, 0.6),
    "skid_steer_b": (0.6, 0.6),
    "skid_steer_c": (1.0, 1.0),
    "skid_steer_d": (1.0, 1.0),
    "vacuum_a": (0.05, 0.1),
    "vacuum_b": (0.05, 0.1),
    "vacuum_c": (0.05, 0.1),
    "vehicle": (6.0, 6.0),
    "vehicle_mirrored_x": (6.0, 6.0),
}
SLIP = 0.05  # share of the drive that may be called slip
CAMERA = 1.05  # RMS over that of the simple odometry
WITHIN = 0.85  # share of the time within three deviations
LITTLE = 0.002  # share of the distance; smaller errors do not count
CONTRADICTED = {"skid_steer_c": 5.5}  # °, of the heading after wheels and gyro contradicted each other; 5 elsewhere
DEVIATION = 0.03  # share of the distance, at the end of the indoor drives

needs_recordings = pytest.mark.skipif(recordings_folder() is None, reason=ABSENT)


class Drive:
    """A recording and its estimate."""

    def __init__(self, drive: Recording, *, self_calibration: bool = True) -> None:
        self.drive = drive
        given = drive.geometry()
        given["params"] = {**given.get("params", {}), "state_estimator": {"self_calibration": self_calibration}}
        self.out = Estimator(**given).process(*drive.samples())
        self.path = np.column_stack([self.out["x"], self.out["y"]])
        self.simple = simple_path(drive)
        self.away = np.hypot(*(self.path - self.simple[:, :2]).T)
        moved = ~np.isnan(drive.left)
        self.distance = np.abs(np.diff(drive.radius * (drive.left + drive.right)[moved] / 2)).sum()

    def share(self, flag: str) -> float:
        """Share of the time after the first rest with this flag."""
        steps = np.diff(self.drive.time, prepend=self.drive.time[0])
        on = (self.out["flags"] & FLAGS[flag]) != 0
        return float(steps[on].sum() / (self.drive.time[-1] - self.drive.rest))

    def deviation(self) -> np.ndarray:
        """m, standard deviation of the position."""
        return np.sqrt(np.maximum(0, self.out["pose_covariance"][:, 0, 0] + self.out["pose_covariance"][:, 1, 1]))


@pytest.fixture(scope="module")
def drives():
    kept: dict[str, Drive] = {}

    def get(name: str) -> Drive:
        if name not in kept:
            kept[name] = Drive(recording(name))
        return kept[name]

    return get


@needs_recordings
@pytest.mark.parametrize("name", BOUNDS)
def test_a_real_drive_ends_where_the_simple_odometry_does(drives, name):
    drive = drives(name)
    at_the_end, on_the_way = BOUNDS[name]
    assert drive.away[-1] <= at_the_end
    assert drive.away.max() <= on_the_way


@needs_recordings
@pytest.mark.parametrize("name", BOUNDS)
def test_a_floor_that_shakes_the_robot_is_not_called_slip(drives, name):
    assert drives(name).share("slip") <= SLIP


@needs_recordings
@pytest.mark.parametrize("name", NAMES)
def test_a_real_drive_ends_within_a_percent_of_the_simple_odometry(drives, name):
    drive = drives(name)
    assert drive.away[-1] <= 0.15 + 0.01 * drive.distance


@needs_recordings
@pytest.mark.parametrize("name", NAMES)
def test_the_heading_is_as_sure_as_the_bias_of_the_first_rest(drives, name):
    """A gyro whose bias no rest has shown is off by 3 °/s."""
    drive = drives(name)
    rest, time = drive.drive.rest, drive.drive.time
    rate = drive.drive.gyro[time < rest - min(0.5, rest / 4), 2]
    rate = rate[~np.isnan(rate)]
    bias = np.std(rate) / np.sqrt(rate.size) if rest > 1 else 0.05
    deviation = np.rad2deg(np.sqrt(drive.out["pose_covariance"][-1, 5, 5]))
    assert deviation <= CONTRADICTED.get(name, 5) + 2 * np.rad2deg(bias * (time[-1] - rest))


@needs_recordings
@pytest.mark.parametrize("name", ["husky_ice", "husky_snow", "husky_asphalt"])
def test_speeds_in_coarse_steps_are_not_called_slip(drives, name):
    assert drives(name).share("slip") <= 0.02


@needs_recordings
@pytest.mark.parametrize("name", ["outdoor_skid_steer", "outdoor_skid_steer_imu_b", "warthog_grass"])
def test_self_calibration_harms_no_drive_with_a_truth(drives, name):
    drive, without = drives(name), Drive(recording(name), self_calibration=False)
    time, *truth = drive.drive.truth.T[:3]
    seen = time < drive.drive.time[-1]

    def rms(path: np.ndarray) -> float:
        at = np.column_stack([np.interp(time[seen], drive.drive.time, path[:, axis]) for axis in (0, 1)])
        return aligned_rms(at, np.column_stack(truth)[seen])

    assert rms(drive.path) <= 1.05 * rms(without.path)
    assert rms(drive.path) <= 1.05 * rms(drive.simple)


@needs_recordings
@pytest.mark.parametrize("name", ["skid_steer_a", "skid_steer_b"])
def test_the_covariance_of_a_real_drive_is_honest_and_not_inflated(drives, name):
    drive = drives(name)
    deviation = drive.deviation()
    assert np.mean(drive.away <= 3 * deviation + 1e-3) >= WITHIN
    assert deviation[-1] <= DEVIATION * drive.distance


@needs_recordings
@pytest.mark.parametrize("name", ["outdoor_skid_steer", "outdoor_skid_steer_imu_b"])
def test_outdoors_it_is_as_near_to_the_camera_as_the_simple_odometry(drives, name):
    drive = drives(name)
    time, *camera = drive.drive.truth.T

    def rms(path: np.ndarray) -> float:
        seen = np.column_stack([np.interp(time, drive.drive.time, path[:, axis]) for axis in (0, 1)])
        return aligned_rms(seen, np.column_stack(camera))

    assert rms(drive.path) <= CAMERA * rms(drive.simple)


@needs_recordings
@pytest.mark.parametrize("begin", [15.0, 32.0, 50.0])
@pytest.mark.parametrize("name", ["skid_steer_a", "skid_steer_b", "skid_steer_c", "skid_steer_d", "vehicle"])
def test_a_real_drive_that_begins_in_motion_is_no_worse_than_the_simple_odometry(name, begin):
    """The reference is the simple odometry of the whole drive, which knows the gyro's bias from an earlier rest."""
    whole = recording(name)
    drive = Drive(without_beginning(whole, begin))
    first = whole.time.size - drive.drive.time.size
    reference = simple_path(whole)[first:]
    back = np.exp(-1j * reference[0, 2])
    along = ((reference[:, 0] - reference[0, 0]) + 1j * (reference[:, 1] - reference[0, 1])) * back
    reference = np.column_stack([along.real, along.imag])
    ours, simple = drive.path - reference, drive.simple[:, :2] - reference
    late = 0.2  # m: stamps 0.1 s late at 0.9 m/s, at the beginning and now

    def rms(errors: np.ndarray) -> float:
        return float(np.sqrt(np.mean(np.sum(errors**2, axis=1))))

    assert rms(ours) <= 1.05 * rms(simple) + late
    assert np.hypot(*ours[-1]) <= 1.05 * np.hypot(*simple[-1]) + late
    covariance = drive.out["pose_covariance"][:, :2, :2] + late**2 / 4 * np.eye(2)
    nees = np.einsum("ni,nij,nj->n", ours, np.linalg.inv(covariance), ours)
    assert np.mean(nees[drive.drive.time > 1] < 5.99) >= 0.9


def error_at_the_end(drive: Drive, path: np.ndarray) -> float:
    truth = drive.drive.truth
    until = truth[:, 0] < drive.drive.time[-1]
    return float(np.hypot(*(path[-1, :2] - truth[until][-1, 1:])))


def test_a_drive_with_the_errors_of_real_sensors_is_as_good_as_the_simple_odometry():
    """The errors are late and jittering stamps, an accelerometer that shakes by forty times its data sheet, and slip of
    5 mm per √m.
    """
    drive = Drive(load(MADE))
    assert error_at_the_end(drive, drive.path) <= 1.15 * error_at_the_end(drive, drive.simple)
    assert drive.share("slip") <= SLIP
    truth = drive.drive.truth
    path = np.column_stack([np.interp(truth[:, 0], drive.drive.time, drive.path[:, axis]) for axis in (0, 1)])
    deviation = np.interp(truth[:, 0], drive.drive.time, drive.deviation())
    away = np.hypot(*(path - truth[:, 1:]).T)
    moved = truth[:, 0] > drive.drive.rest + 2
    assert np.mean(away[moved] <= 3 * deviation[moved] + 0.1) >= WITHIN  # 0.1 m: stamps 0.07 s late at 0.9 m/s


@pytest.mark.parametrize("seed", [5, 10, 15])
def test_a_start_in_motion_is_the_simple_odometry_until_the_first_rest(seed):
    """At first the gyro's bias is taken as zero, as in the simple odometry; later as that which a rest of a second
    shows.
    """
    drive = Drive(field_drive(Errors(rest=0.0, bias=(0.0, 0.0, 0.0)), seed))
    moving = drive.drive.time < 29  # its first stop comes at 30 s
    assert drive.away[moving].max() <= 0.02 * drive.distance  # the clock offset and the slopes of the tilt
    assert error_at_the_end(drive, drive.path) <= 0.02 * drive.distance
    off = np.remainder(drive.out["yaw"] - drive.simple[:, 2] + np.pi, 2 * np.pi) - np.pi
    assert np.mean(np.abs(off) <= 3 * np.sqrt(drive.out["pose_covariance"][:, 5, 5]) + 1e-3) >= WITHIN


def test_good_sensors_are_not_degraded():
    good = Errors(
        jitter=0,
        offset=0,
        accelerometer=1.7e-3,
        slow=5e-3,
        gyro=2.44e-4,
        slip=8e-5,
        counts=4096,
        imu_rate=1e3,
        wheel_rate=1e3,
    )
    drive = Drive(field_drive(good, seed=1, duration=30.0))
    assert drive.share("degraded") == 0
    assert drive.share("slip") == 0
