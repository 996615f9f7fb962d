"""Judges whether an estimate can be relied on, and which sensors it did not use."""

import math

import numpy as np

from robot_control.data.estimate.samples import IntArray, Samples
from robot_control.loop.estimator import FLAGS, Estimate

MAX_YAW_DEVIATION = math.radians(10)
MAX_SLIP = 0.2  # of the distance
UNUSED = 0.05  # of the time
USED_BY = {"gyro": "no_gyro", "accelerometer": "no_accelerometer"}
"""sensor → the flag that says that it was not used"""


class Trust:
    """Gathers the data for the judgement, block by block."""

    def __init__(self) -> None:
        self._slipped = 0.0  # m
        self._without = dict.fromkeys(USED_BY, 0.0)  # s
        self._before: tuple[float, float] | None = None  # s, m
        self._restarts: list[float] = []  # s
        self._duration = 0.0  # s
        self._distance = 0.0  # m
        self._yaw_deviation = 0.0  # rad

    def add(self, _time_ns: IntArray, estimate: Estimate) -> None:
        """Adds rows; each counts for the time and the way since the one before."""
        time, distance = self._before or (float(estimate["time"][0]), float(estimate["distance"][0]))
        steps = np.diff(estimate["time"], prepend=time)
        ways = np.diff(estimate["distance"], prepend=distance)
        flags = estimate["flags"]
        self._slipped += float(ways[flags & FLAGS["slip"] != 0].sum())
        for sensor, flag in USED_BY.items():
            self._without[sensor] += float(steps[flags & FLAGS[flag] != 0].sum())
        self._restarts += estimate["time"][flags & FLAGS["encoder_restarted"] != 0].tolist()
        self._duration += float(steps.sum())
        self._distance += float(ways.sum())
        self._yaw_deviation = math.sqrt(max(0.0, float(estimate["pose_covariance"][-1, 5, 5])))
        self._before = float(estimate["time"][-1]), float(estimate["distance"][-1])

    def doubts(self, samples: Samples) -> list[str]:
        """Reasons to doubt the estimate, a sentence each; empty if there are none."""
        found = []
        if self._yaw_deviation > MAX_YAW_DEVIATION:
            found.append(f"not to be trusted: the last yaw is known to ± {math.degrees(self._yaw_deviation):.0f}°")
        if self._distance > 0 and self._slipped > MAX_SLIP * self._distance:
            what = f"not to be trusted: slip on {100 * self._slipped / self._distance:.0f} % of the distance is rare"
            found.append(f"{what}; check clocks, units, mounting and vibration of the IMU")
        if self._restarts:
            when = ", ".join(f"{time:.3f} s" for time in self._restarts[:3])
            found.append(f"an encoder restarted after {when}: the travel meanwhile is lost")
        rates = samples.rates()
        for sensor, seconds in self._without.items():
            if sensor in rates and self._duration > 0 and seconds > UNUSED * self._duration:
                found.append(
                    f"the {sensor} was not used during {100 * seconds / self._duration:.0f} % of the time: its samples "
                    f"come at {rates[sensor]:.3g} Hz; too slow, missing or impossible ones are left out"
                )
        return found
