"""The quadbot stands up, walks and lies down behind motors in MIT mode on four CAN buses, in virtual time."""

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.data.demo.run_summary import summarize, to_table
from robot_control.installed_files import share_file

LINEAR, ANGULAR = 0.5, 0.2  # m/s, rad/s, of scripts/demo
WALK = 8.0  # s
TIMING = ("driver_woke_ns", "command_published_ns", "permit_published_ns", "slipped_ns", "overruns")
"""columns that virtual time does not have"""


def walked(drives, bus):
    """The log of a robot that rests, stands up, walks, stops and lies down, with a fault of its buses meanwhile."""
    loop = ClosedLoop(urdf=share_file("urdf/quadbot.urdf"), drives=share_file(f"config/drives/{drives}.yaml"))
    parts = [loop.run(1.0)]
    loop.inject_fault("bus", bus)
    parts += [loop.run(2.0 + WALK, (LINEAR, ANGULAR)), loop.run(2.0, (0.0, 0.0))]
    loop.set_posture("lying")
    parts.append(loop.run(4.5))
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    zero = np.zeros_like(joined["time"])
    return {**joined, "stamp_ns": 1e9 * joined["time"], **dict.fromkeys(TIMING, zero)}


@pytest.mark.parametrize(
    ("drives", "bus"),
    [(drives, bus) for drives in ("damiao", "cybergear", "ak", "moteus") for bus in ("ok", "lossy", "disturbed")],
)
def test_the_walk_is_tracked(drives, bus):
    summary = summarize(walked(drives, bus), LINEAR, ANGULAR, WALK, legged=True)
    print(to_table(summary))
    assert summary.passed
    assert " ".join(summary.postures) == "lying gathering rising standing walking standing lowering lying"
