"""The node's state estimator over recorded data: the very same C++ class, without ROS.

est = Estimator(wheel_radius=0.1, wheel_base=0.5, imu_position=(0.05, 0.0, 0.06))
out = est.process(time, left_position, right_position, gyro, accel)
out["x"], out["y"], out["yaw"], out["pose_covariance"]  # numpy, a row per sample
"""

from __future__ import annotations  # help() shows the names of the types

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robot_control._robot_control import OfflineEstimator, signal_names
from robot_control.files.files import utf8
from robot_control.loop.roles import ESTIMATOR
from robot_control.settings.parameter_layers import layered, leaves

FloatArray = NDArray[np.float64]
Estimate = dict[str, NDArray[Any]]


def _bits(kind: str) -> dict[str, int]:
    return {name: 1 << number for number, (name, *_) in enumerate(signal_names[kind])}


SENSORS: tuple[str, ...] = tuple(signal_names["SensorIndex"])
"""Columns of `confidence`, `nis` and `rejected`. The contacts are pseudo-measurements of the ground: wheels do not
slide sideways, and the robot neither sinks nor flies."""

FLAGS: dict[str, int] = _bits("StateFlag")
"""Name → bit of `flags`: valid, slip, standstill, …; their meaning stands in src/signals/names.h."""

SLIP_REASONS: dict[str, int] = _bits("SlipReason")
"""Name → bit of `slip`."""

DEGRADED_REASONS: dict[str, int] = _bits("DegradedReason")
"""Name → bit of `degraded`."""

_STAMP_ROUNDING = 1e-9  # s: text and ROS stamps hold nanoseconds
_FARTHEST, _MAX_TURNED = 1e6, 1e6  # m, rad: largest values that the node's service set_odometry accepts
_QUATERNION_TOLERANCE = 1e-3  # of the norm: four decimals, as people write them


class Estimator:
    """Estimates the path of a robot from the measurements of its wheels and its IMU.

    Args:
        params: path of a YAML file, or a nested dict laid over the installed `config/robot_params.yaml`, as
            `ClosedLoop` takes them; the block `state_estimator` holds noises, switches, what is known of the wheels,
            and a `calibration_file` that is read as the node reads it.
        urdf: path of the robot description; overrides `robot.urdf`.
        wheel_radius: m, every wheel. With `urdf` it overrides the URDF's.
        wheel_base: m, between the left and the right wheels. With `urdf` it overrides the URDF's. Without `urdf`,
            wheel_radius and wheel_base together are the robot: two wheels, base_link in the middle of their axle, and
            perhaps others behind them: at the start a turn is taken to scatter as a skid steer's, and before the first
            rest its wheels do not show the gyro's bias.
        imu_position: (x, y, z) of the IMU in base_link, m; overrides the URDF's.
        imu_orientation: of the IMU in base_link: (roll, pitch, yaw) in rad, turned about the fixed axes x, y, z in
            this order as in a URDF, or a quaternion (x, y, z, w); by their number, three or four. Overrides the
            URDF's.
        encoder_counts: of one turn of a wheel, gear included, all edges counted; sets
            `state_estimator.encoder_noise` to 2π / encoder_counts / √12 rad. None: that parameter holds, 4096 counts
            unless set. An encoder that is coarser than its parameter looks like slip.
        period: s between two samples, from which the tracking loops are set up. None: the median of the
            times of the first `process`.

    Raises:
        ParameterError: every missing, unknown, mistyped or out-of-range value at once.
        RobotError: the robot description cannot be driven.
        ValueError: wheel_radius without wheel_base, or numbers that are none.

    The frames are those of REP 103 and 105: base_link has x forward, y left, z up; `odom` begins at the robot's first
    sample. Same arguments and calls give the same bits. A node that is given the same samples in the same cycles gives
    the same bits, too.
    """

    def __init__(
        self,
        params: str | PathLike[str] | Mapping[str, Any] | None = None,
        urdf: str | PathLike[str] | None = None,
        *,
        wheel_radius: float | None = None,
        wheel_base: float | None = None,
        imu_position: Sequence[float] | FloatArray | None = None,
        imu_orientation: Sequence[float] | FloatArray | None = None,
        encoder_counts: float | None = None,
        period: float | None = None,
    ) -> None:
        path, values = layered(params, urdf)
        if urdf is None and (wheel_radius is None) != (wheel_base is None):
            one, other = ("wheel_base", "wheel_radius") if wheel_radius is None else ("wheel_radius", "wheel_base")
            raise ValueError(f"{one} without {other}: give both, or the urdf whose value {one} replaces")
        given: dict[str, Any] = {"wheel_radius": wheel_radius, "wheel_base": wheel_base}
        if imu_position is not None:
            given["imu_position"] = _vector("imu_position", imu_position, (3,)).tolist()
        if imu_orientation is not None:
            given["imu_orientation"] = _roll_pitch_yaw(imu_orientation)
        if encoder_counts is not None:
            if not (np.isfinite(encoder_counts) and encoder_counts > 0):
                raise ValueError(f"encoder_counts is {encoder_counts}; it must be above 0 counts per turn of a wheel")
            values.append((f"{ESTIMATOR}.encoder_noise", repr(2 * np.pi / encoder_counts / np.sqrt(12))))
        values += leaves({"robot": {name: value for name, value in given.items() if value is not None}})
        if period is not None and not (np.isfinite(period) and period > 0):
            raise ValueError(f"period is {period}; it must be above 0 s")
        self._estimator = OfflineEstimator(path, values, two_wheels=urdf is None and wheel_radius is not None)
        self._period = None if period is None else float(period)
        self._begun = False
        self._pose: list[float] | None = None  # of the next row

    def reset(self) -> None:
        """Forgets all samples: the next `process` begins a new run, its pose at zero, at any time."""
        self._begun = False
        self._pose = None

    def reset_odometry(self) -> None:
        """Zeroes pose and covariance in the first row of the next `process`, as the node's service does. Speeds,
        biases, calibration and distance stay.
        """
        self.set_odometry(0.0, 0.0, 0.0)

    def set_odometry(self, x: float, y: float, yaw: float) -> None:
        """Sets the pose x [m], y [m], yaw [rad] in the first row of the next `process`, as the node's service does. Its
        covariance becomes zero; all else stays.

        Raises:
            ValueError: a number that is none, or beyond 1000 km or 10⁶ rad; then nothing has changed.
        """
        for name, value, bound, unit in (
            ("x", x, _FARTHEST, "m"),
            ("y", y, _FARTHEST, "m"),
            ("yaw", yaw, _MAX_TURNED, "rad"),
        ):
            if not abs(value) <= bound:
                raise ValueError(f"{name} is {value}; it must be a number of -{bound:g} … {bound:g} {unit}")
        self._pose = [float(x), float(y), float(yaw)]

    def process(
        self,
        time: ArrayLike,
        left_position: ArrayLike,
        right_position: ArrayLike,
        gyro: ArrayLike | None = None,
        accel: ArrayLike | None = None,
        *,
        covariance: bool = True,
        every: int = 1,
    ) -> Estimate:
        """Estimates the state at every sample time. A second call continues where the first one ended.

        Rates may differ and be irregular: one row per time at which anything was measured, NaN where a sample is
        absent.

        Args:
            time: shape (N,), s, finite and strictly increasing, from one call to the next, too.
            left_position: shape (N,), rad, angle of the left wheel as its joint reports it: growing as its URDF axis
                says; without URDF, forwards. Shape (N, k): of the k wheels of that side, front to back.
            right_position: as left_position.
            gyro: shape (N, 3), rad/s, in the IMU's own axes. None: there is none.
            accel: shape (N, 3), m/s², specific force in the IMU's own axes (+9.81 upwards at rest). None: none.
            covariance: False leaves out the three matrices, which are most of the memory.
            every: n ≥ 1: only the first of every n rows comes out, and the last; all of them are used.

        Returns:
            Arrays of M rows, M = N with every=1:
                time (M,) s
                x, y, z (M,) m; roll, pitch, yaw (M,) rad; quaternion (M, 4) x y z w: base_link in odom
                attitude (M, 4): as quaternion, with roll and pitch even where the pose is kept planar
                linear (M, 3) m/s; angular (M, 3) rad/s: of base_link, in its own axes
                pose_covariance (M, 6, 6): x y z [m], rotation about x y z [rad], odom axes
                twist_covariance (M, 6, 6): linear [m/s], angular [rad/s], base axes
                attitude_covariance (M, 3, 3): rad², about odom axes
                gyro_bias, gyro_bias_deviation (M, 3) rad/s; accelerometer_bias (M, 3) m/s²: IMU axes
                radius_ratio, radius_ratio_deviation (M,): right over left radius, relative to the given ones
                wheel_base_factor, wheel_base_deviation (M,): effective over given wheel base
                distance (M,) m, travelled
                wheel_x, wheel_y (M,) m, wheel_yaw (M,) rad, wheel_linear m/s, wheel_angular rad/s: by wheels alone
                confidence (M, 6): 0 (not used) … 1 (agrees); nis (M, 6): normalised innovation squared, ideal 1;
                rejected (M, 6): comparisons not used so far; columns: SENSORS
                degraded (M,): bits of DEGRADED_REASONS: what the pose does without;
                residual_level (M,): wheels against accelerometer, over what the sensors' noise explains; 0: not known
                flags (M,): bits of FLAGS; slip (M,): bits of SLIP_REASONS. A row without an angle of a side says so:
                no_left_encoder, no_right_encoder, bad_sample; whether that matters yet says valid
                valid (M,): bool, pose and twist may be used
            Deviations are standard deviations.

        Raises:
            ValueError: a wrong shape or length, no rows, something that is no number, a time that is not finite or
                does not increase; then nothing has changed.
            RuntimeError: another thread is inside this method.
        """
        stamps = _numbers("time", time)
        if stamps.ndim != 1 or stamps.size == 0:
            raise ValueError(f"time has the shape {stamps.shape}; it must be (N,) with at least one row")
        count = stamps.size
        left = self._positions("left_position", left_position, count, "left")
        right = self._positions("right_position", right_position, count, "right")
        rates = _axes("gyro", gyro, count)
        forces = _axes("accel", accel, count)
        if not isinstance(every, int | np.integer) or isinstance(every, bool) or every < 1:
            raise ValueError(f"every is {every!r}; it must be a whole number of at least 1")
        _check_increasing(stamps, self._estimator.last_time if self._begun else None)
        rounding = max(_STAMP_ROUNDING, 2 * float(np.spacing(np.max(np.abs(stamps)))))

        if not self._begun:
            self._estimator.begin(self._period or self._median_period(stamps, rounding))
            self._begun = True
        options = {"rounding": rounding, "every": int(every), "covariance": bool(covariance)}
        out: Estimate = self._estimator.process(stamps, left, right, rates, forces, pose=self._pose, **options)
        self._pose = None
        out["valid"] = (out["flags"] & FLAGS["valid"]) != 0
        return out

    def save_calibration(self, path: str | PathLike[str]) -> None:
        """Writes the calibration of wheels and gyro so far to the file format of `state_estimator.calibration_file`.

        Raises:
            RuntimeError: nothing was learned, or beyond what a robot can be.
            OSError: it cannot be written.
        """
        self._estimator.save_calibration(utf8(path))

    @property
    def period(self) -> float:
        """s, as given, or as the first `process` found it."""
        return self._period or float(self._estimator.period)

    @property
    def robot(self) -> dict[str, Any]:
        """The robot as it was understood, SI units, base axes: `wheels` (each `joint`, `side`, `sign`, `centre`,
        `radius`), `wheel_base`, `wheel_base_multiplier`, `effective_wheel_base`, `imu` (`link`, `position`,
        `orientation` x y z w), `base_link`, `name`, `source`.
        """
        return self._estimator.robot

    def _median_period(self, stamps: FloatArray, rounding: float) -> float:
        """The median step; where rounded stamps cannot be distinguished from those of robot.rate, its exact period."""
        nominal = float(self._estimator.loop_period)
        if stamps.size < 2:
            return nominal
        median = float(np.median(np.diff(stamps)))
        return nominal if abs(median - nominal) <= rounding else median

    def _positions(self, name: str, given: ArrayLike, count: int, side: str) -> FloatArray:
        wheels = sum(wheel["side"] == side for wheel in self.robot["wheels"])
        values = _numbers(name, given)
        if values.shape not in {(count,), (count, wheels)}:
            more = f" or ({count}, {wheels}), a column per {side} wheel" if wheels > 1 else ""
            raise ValueError(f"{name} has the shape {values.shape}; with {count} times it must be ({count},){more}")
        return values.reshape(count, -1)


def _numbers(name: str, given: ArrayLike) -> FloatArray:
    try:
        return np.asarray(given, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is not an array of numbers: {error}") from None


def _axes(name: str, given: ArrayLike | None, count: int) -> FloatArray:
    """Shape (count, 3), or (0, 3) where there is no such sensor."""
    if given is None:
        return np.empty((0, 3))
    values = _numbers(name, given)
    if values.shape != (count, 3):
        what = f"{name} has the shape {values.shape}; with {count} times it must be ({count}, 3), in IMU axes, or None"
        raise ValueError(f"{what}. The other two axes of a gyro with one axis are 0.")
    return values


def _vector(name: str, given: Sequence[float] | FloatArray, shapes: tuple[int, ...]) -> FloatArray:
    values = _numbers(name, given)
    if values.ndim != 1 or values.size not in shapes or not np.all(np.isfinite(values)):
        wanted = " or ".join(str(size) for size in shapes)
        raise ValueError(f"{name} is {np.asarray(given).tolist()}; it must be {wanted} finite numbers")
    return values


def _roll_pitch_yaw(given: Sequence[float] | FloatArray) -> list[float]:
    """rad, converted from these or from a quaternion x, y, z, w."""
    values = _vector("imu_orientation", given, (3, 4))
    if values.size == 3:
        return [float(angle) for angle in values]
    norm = float(np.linalg.norm(values))
    if abs(norm - 1) > _QUATERNION_TOLERANCE:
        raise ValueError(f"imu_orientation is {values.tolist()}; a quaternion (x, y, z, w) must have norm 1")
    x, y, z, w = values / norm
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return [float(roll), float(pitch), float(yaw)]


def _check_increasing(stamps: FloatArray, last: float | None) -> None:
    unknown = np.flatnonzero(~np.isfinite(stamps))
    if unknown.size:
        raise ValueError(f"time[{unknown[0]}] is {stamps[unknown[0]]}; every row needs a finite time: drop the row")
    if last is not None and stamps[0] <= last:
        what = f"time[0] is {stamps[0]!r} s, not after {last!r} s, where the last process() ended"
        raise ValueError(f"{what}; call reset() to start again")
    back = np.flatnonzero(np.diff(stamps) <= 0)
    if back.size:
        row = int(back[0]) + 1
        what = f"time[{row}] is {float(stamps[row])!r} s, time[{row - 1}] is {float(stamps[row - 1])!r} s"
        raise ValueError(f"{what}; time must strictly increase: sort the rows, and merge rows with the same time")
