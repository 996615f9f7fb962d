"""The usual odometries, with which the estimator is compared, in the plane of the ground.

    raw wheels         Δs = (r Δφ_r + r Δφ_l)/2      Δθ = (r Δφ_r − r Δφ_l)/b      r, b as the robot is described
    calibrated wheels  the same with the true radii r_l, r_r and the true base: what a perfect calibration could reach
    gyro, no bias      Δs of raw wheels,             Δθ = ∫ ω dt
    simple odometry    Δs of raw wheels,             Δθ = ∫ (ω − b̂) dt, 0 while it stands;   b̂ from standstills

ω is the gyro's rate about base z, integrated by trapezoids; position by chords, x += Δs cos(θ + Δθ/2), whose error
goes with Δθ³ and vanishes at 1 kHz (Borenstein, Everett & Feng, "Where am I?", 1996, section 1.3.1).

b̂ is a scalar Kalman filter with the true noise densities σ, s of the gyro (sensor_errors.h) and the true prior:

    while it moves                             P += s² Δt
    after T s of standstill, ω̄ its mean        K = P/(P + σ²/T)    b̂ += K (ω̄ − b̂)    P −= K P

The robot stands if neither wheel moves by more than a count for STILL seconds and the gyro's mean is under 0.01 rad/s.
The first and last STILL seconds of a standstill are not used, because it may still rock.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bench.odometry.errors import GYRO_BIAS
from bench.odometry.recording import Recording
from bench.odometry.truth import Array, Track

STILL = 0.1  # s
COUNT = 2 * np.pi / 4096 * 1.01  # rad, of the plant's encoders
QUIET = 0.01  # rad/s
GYRO_NOISE, GYRO_WALK = 2.44e-4, 8.7e-6  # rad/s/√Hz, rad/s/√s: those of the plant


def raw_wheels(recording: Recording) -> Track:
    """The path by the numbers of the description."""
    radius, base = recording.nominal["wheel_radius"], recording.nominal["wheel_base"]
    return _wheels(recording, radius, radius, base)


def calibrated_wheels(recording: Recording) -> Track:
    """The path by the true numbers."""
    radius, base = recording.nominal["wheel_radius"], recording.nominal["wheel_base"]
    errors = recording.errors
    return _wheels(
        recording,
        radius * (1 + errors.left_radius),
        radius * (1 + errors.right_radius),
        base * (1 + errors.wheel_base),
    )


def gyro_without_bias(recording: Recording) -> Track:
    """Distance by raw wheels, heading by the gyro as it is."""
    return _sampled(recording, _distance(recording), _integrated(recording, recording.gyro[:, 2]))


def simple_odometry(recording: Recording) -> Track:
    """Distance by raw wheels, heading by the gyro less the bias learned at standstill."""
    still = standing(recording)
    rate = recording.gyro[:, 2] - bias(recording, still)
    return _sampled(recording, _distance(recording), _integrated(recording, np.where(still, 0.0, rate)))


def bias_of_first_rest(recording: Recording, rest: float) -> Track:
    """Distance by raw wheels, heading by the gyro less its mean in the first `rest` s; 0: less nothing."""
    rate, rows = recording.gyro[:, 2], round(rest / _period(recording))
    edge = round(STILL / _period(recording))
    bias_then = float(rate[edge : rows - edge].mean()) if rows > 2 * edge else 0.0
    turning = np.where(np.arange(len(rate)) < rows, 0.0, rate - bias_then)
    return _sampled(recording, _distance(recording), _integrated(recording, turning))


def standing(recording: Recording) -> NDArray[np.bool_]:
    """(N,): true in cycles at rest."""
    window = round(STILL / _period(recording))
    quiet = np.abs(_mean_before(recording.gyro[:, 2], window)) < QUIET
    for angle in (recording.left, recording.right):
        quiet[window:] &= np.abs(angle[window:] - angle[:-window]) < COUNT
    quiet[:window] = False
    return quiet


def bias(recording: Recording, still: NDArray[np.bool_]) -> Array:
    """(N,) rad/s: the estimated bias of the gyro about z, renewed after each standstill."""
    period = _period(recording)
    edge = round(STILL / period)
    estimate, variance, last = 0.0, GYRO_BIAS**2, 0
    biases = np.zeros(len(still))
    bounds = np.flatnonzero(np.diff(still.astype(np.int8), prepend=0, append=0))
    for begin, end in zip(bounds[::2], bounds[1::2], strict=True):
        biases[last:end] = estimate
        if end - begin <= 2 * edge:
            last = end
            continue
        samples = recording.gyro[begin + edge : end - edge, 2]
        variance += GYRO_WALK**2 * (end - last) * period
        gain = variance / (variance + GYRO_NOISE**2 / (len(samples) * period))
        estimate += gain * (samples.mean() - estimate)
        variance -= gain * variance
        last = end
    biases[last:] = estimate
    return biases


METHODS = {
    "raw wheels": raw_wheels,
    "calibrated wheels": calibrated_wheels,
    "gyro, no bias": gyro_without_bias,
    "simple odometry": simple_odometry,
}


def _period(recording: Recording) -> float:
    return float(recording.time[1] - recording.time[0])


def _wheels(recording: Recording, left_radius: float, right_radius: float, base: float) -> Track:
    left = left_radius * (recording.left - recording.left[0])
    right = right_radius * (recording.right - recording.right[0])
    return _sampled(recording, (left + right) / 2, (right - left) / base)


def _distance(recording: Recording) -> Array:
    radius = recording.nominal["wheel_radius"]
    distance: Array = radius * (recording.left - recording.left[0] + recording.right - recording.right[0]) / 2
    return distance


def _integrated(recording: Recording, rate: Array) -> Array:
    turns = (rate[1:] + rate[:-1]) / 2 * np.diff(recording.time)
    return np.concatenate([[0.0], np.cumsum(turns)])


def _sampled(recording: Recording, distance: Array, yaw: Array) -> Track:
    """Poses at the truth rows from distance and heading of each cycle."""
    step, heading = np.diff(distance), (yaw[1:] + yaw[:-1]) / 2
    x = np.concatenate([[0.0], np.cumsum(step * np.cos(heading))])
    y = np.concatenate([[0.0], np.cumsum(step * np.sin(heading))])
    return Track(x[recording.index], y[recording.index], yaw[recording.index])


def _mean_before(values: Array, window: int) -> Array:
    total = np.concatenate([np.zeros(1), np.cumsum(values)])
    mean = np.zeros(len(values))
    mean[window - 1 :] = (total[window:] - total[:-window]) / window
    return mean
