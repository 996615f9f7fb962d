"""Finds what is wrong with a recording before anything is estimated from it, in sentences that name the remedy."""

import math
from dataclasses import dataclass, field

import numpy as np

from robot_control.data.estimate import mounting
from robot_control.data.estimate.clock import TurnFit, fit_turning
from robot_control.data.estimate.samples import FloatArray, InputError, Robot, Samples
from robot_control.data.estimate.streams import Streams, streams_of

IN_G = (0.8, 1.25)
"""norm of an accelerometer at rest that measures in g"""
SCALE = 0.12
"""share by which the accelerometer's norm at rest may differ from gravity; a vacuum robot's is 4 % low"""
NO_GRAVITY = 0.5  # m/s²
MAX_BIAS = math.radians(5)
"""rad/s of a gyro at rest; the data sheets of MEMS gyros allow less"""
BASES = (0.75, 1.35)
"""wheel base by the turning over the given one; tyres and floor explain no more"""
DEGREES_INSTEAD = (0.4, 3.0)
"""the same ratio if the gyro were in °/s; skid steers reach 2.4"""
CLEAR = 0.8
"""share of the wheels' turning that the gyro must explain before a conclusion is drawn"""
OFFSET, OFFSET_DEVIATION = 0.005, 0.02
"""s: the smallest offset of the clocks that is corrected, and its largest standard deviation"""
FEWEST = 10
"""number of samples from which their distance can be judged"""
MIN_APART, MAX_APART = 2e-5, 2.0
"""s between samples of one sensor; a robot's sensors are sampled neither at 50 kHz nor once in two seconds"""
COUNTS = 20
"""number of different whole numbers from which they are counts, not angles"""


@dataclass
class Findings:
    """The results of the checks."""

    warnings: list[str] = field(default_factory=list)
    offset: float | None = None  # s, delay of the IMU's stamps against the wheels'; None if none needs correction


def check_angles(samples: Samples) -> None:
    """Checks angles that were given without a unit.

    Raises:
        InputError: they are counts.
    """
    known = [table[~np.isnan(table)] for table in (samples.left, samples.right)]
    if all(table.size and np.all(table == np.round(table)) and np.unique(table).size >= COUNTS for table in known):
        what = "left and right are whole numbers: counts of an encoder, not radians"
        raise InputError(f"{what}. Set the counts per turn of the wheel, including the gear: --counts-per-turn N")


def check(samples: Samples, robot: Robot) -> Findings:
    """Checks a recording whose wheel angles are in rad.

    Raises:
        InputError: a wheel has no angles, the times are in another unit, the accelerometer is in g, the gyro in °/s.
    """
    _check_time(samples)
    for side, angles in (("left", samples.left), ("right", samples.right)):
        if not samples.own_log and not np.isfinite(angles).any():
            raise InputError(f"the {side} wheel has no angle in this recording: check its column or its joint")
    streams = streams_of(samples, robot)
    findings = Findings()
    gravity = mounting.gravity_of(streams)
    up = streams.base_from_imu[2]
    if gravity is not None and _check_gravity(streams, gravity, findings):
        up = gravity / np.linalg.norm(gravity)
    if streams.gyro_time.size:
        _check_rest(streams, findings)
        turning = fit_turning(streams.wheel_time, streams.left, streams.right, streams.gyro_time, streams.gyro @ up)
        if turning is not None:
            _check_turning(streams, turning, findings)
    return findings


def _check_time(samples: Samples) -> None:
    if samples.own_log or samples.time_ns.size < FEWEST:
        return
    tables = (table for table in (samples.left, samples.gyro) if table is not None)
    present = (~np.isnan(table.reshape(len(table), -1)).any(axis=1) for table in tables)
    for time_ns in (samples.time_ns[rows] for rows in present if rows.sum() >= FEWEST):
        apart = 1e-9 * float(np.median(np.diff(time_ns)))
        if not MIN_APART <= apart <= MAX_APART:
            raise InputError(
                f"half of a sensor's samples are less than {apart:.3g} s apart; expected is {MIN_APART:g} to "
                f"{MAX_APART:g} s. Check the unit of the times (of a CSV: --time-unit, default s)"
            )


def _check_gravity(streams: Streams, gravity: FloatArray, findings: Findings) -> bool:
    """True if the accelerometer shows the vertical."""
    size = float(np.linalg.norm(gravity))
    if size < NO_GRAVITY:
        found = f"the accelerometer shows no gravity ({size:.2g} m/s²): whatever took it out also took out the tilt"
        findings.warnings.append(f"{found}. Leave out the accelerometer, or record it unfiltered")
        return False
    if IN_G[0] < size < IN_G[1]:
        raise InputError(f"the accelerometer is in g: at rest it shows {size:.3g}. Set --accel-unit g")
    if abs(size / mounting.GRAVITY - 1) > SCALE:
        what = f"the accelerometer shows {size:.4g} m/s² at rest instead of {mounting.GRAVITY:.4g}"
        findings.warnings.append(f"{what}: check its unit and scale")
    tilt = mounting.tilt_of(gravity, streams.base_from_imu)
    candidates = mounting.fitting(streams, gravity)
    plain = [each for each in candidates if not each.mirrored]
    if tilt > mounting.OBLIQUE:
        what = f"gravity is {math.degrees(tilt):.0f}° away from the direction that follows from the IMU's mounting"
        if not plain:
            findings.warnings.append(f"{what}, and on none of its axes: measure how it is mounted (--imu-orientation)")
        elif plain[0].agreement < mounting.AGREES:
            level = min(plain, key=lambda each: abs(each.rpy[2]))
            findings.warnings.append(
                f"{what}: {level.option} has it upwards; the drive does not show where the IMU's x axis points"
            )
        else:
            findings.warnings.append(f"{what}: {plain[0].option} fits, with the forces of the drive")
        return True
    given = mounting.agreement(streams)
    best = candidates[0] if candidates else None
    if best is not None and best.agreement >= mounting.AGREES and best.agreement - given >= mounting.BETTER:
        findings.warnings.append(
            "the accelerometer's horizontal axes do not fit the drive: "
            + (
                "they are left-handed; one of them has the wrong sign"
                if best.mirrored
                else f"{best.option} fits (agreement {best.agreement:.2f}, as mounted {given:.2f})"
            )
        )
    return True


def _check_rest(streams: Streams, findings: Findings) -> None:
    rests = streams.rests()
    if not rests:
        findings.warnings.append(
            "the robot never rests in this recording: the gyro's bias and a difference of the wheels' radii "
            "have the same effect. Record a second of rest, best at the beginning"
        )
        return
    begin, end = rests[0]
    if begin > streams.wheel_time[0] + 0.1:
        findings.warnings.append(
            f"the recording starts in motion, the first rest is after {begin:.1f} s: before, no gyro bias is known"
        )
    inside = (streams.gyro_time >= begin) & (streams.gyro_time <= end)
    if not inside.any():
        return
    bias = streams.gyro[inside].mean(axis=0)
    for axis, rate in zip("xyz", bias.tolist(), strict=True):
        if abs(rate) > MAX_BIAS:
            findings.warnings.append(
                f"the gyro's {axis} axis shows {math.degrees(rate):.1f} °/s at rest: check it and its unit"
            )


def _check_turning(streams: Streams, turning: TurnFit, findings: Findings) -> None:
    if turning.explained < CLEAR:
        return
    ratio = turning.wheel_base / streams.wheel_base
    in_degrees = abs(ratio) * 180 / math.pi
    if DEGREES_INSTEAD[0] < in_degrees < DEGREES_INSTEAD[1]:
        raise InputError("the gyro is in °/s: it turns 57 times as fast as the wheels. Set --gyro-unit deg/s")
    if ratio < 0:
        frame = "its frame is left-handed or is mounted upside down (change its signs, or --imu-orientation)"
        findings.warnings.append(f"the gyro turns against the wheels: {frame}, or left and right wheels are exchanged")
    elif not BASES[0] < ratio < BASES[1]:
        what = f"by the gyro the effective wheel base is {turning.wheel_base:.3f} m, not {streams.wheel_base:.3f} m"
        findings.warnings.append(f"{what}: set it, or check radius, counts per turn and the gyro's unit")
    if turning.offset_deviation < OFFSET_DEVIATION and abs(turning.offset) > max(OFFSET, 3 * turning.offset_deviation):
        findings.offset = turning.offset
