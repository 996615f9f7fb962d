"""A robot on legs behind the simulated low level of a Go1 or Go2.

It stands up and walks as requested; test_walk_losses.py has its losses.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file

QUADRUPEDS = Path(os.environ.get("ROBOT_QUADRUPEDS", Path(__file__).parents[4] / "shared/quadrupeds"))
SPEED = 0.5  # m/s
RISE = 3.0  # s, from the request until it walks evenly
WALK = 6.0  # s


def loop_of(robot, rate, driver="unitree_legged", seed=1):
    """The robot behind the drives of a Go1 or Go2."""
    values = {"robot": {"driver": driver, "rate": rate}}
    if robot == "quadbot":
        drives = share_file(f"config/drives/{driver}.yaml")
        return ClosedLoop(values, seed=seed, urdf=share_file("urdf/quadbot.urdf"), drives=drives)
    urdf = QUADRUPEDS / robot / "robot.urdf"
    if not urdf.exists():
        pytest.skip(f"{urdf} is not here: ROBOT_QUADRUPEDS names the folder of other robots")
    return ClosedLoop(values, seed=seed, urdf=str(urdf), drives=share_file(f"config/robots/{robot}.yaml"))


def distance(log, source):
    """m, from the first cycle to the last one."""
    return np.hypot(*(log[f"{source}_{axis}"][-1] - log[f"{source}_{axis}"][0] for axis in "xy"))


@pytest.mark.parametrize(
    ("robot", "driver"),
    [("quadbot", "unitree_legged"), ("go1", "unitree_legged"), ("quadbot", "unitree_go"), ("go2", "unitree_go")],
)
@pytest.mark.parametrize("rate", [500, 1000])
def test_it_stands_up_and_walks_as_requested(robot, driver, rate):
    loop = loop_of(robot, rate, driver)
    loop.run(1.0)
    loop.run(RISE, (SPEED, 0.0))
    walk = loop.run(WALK, (SPEED, 0.0))
    assert not walk["permit_causes"].any()
    assert walk["truth_linear"].mean() == pytest.approx(SPEED, rel=0.03)
    assert distance(walk, "estimate") == pytest.approx(distance(walk, "truth"), rel=0.01)


@pytest.mark.parametrize("kind", ["lossy", "late", "disturbed"])
def test_lost_and_late_datagrams_do_not_stop_it(kind):
    loop = loop_of("quadbot", 500)
    loop.inject_fault("line", kind)
    loop.run(1.0)
    loop.run(RISE, (SPEED, 0.0))
    walk = loop.run(WALK, (SPEED, 0.0))
    assert not walk["permit_causes"].any()
    assert walk["truth_linear"].mean() == pytest.approx(SPEED, rel=0.03)
    assert distance(walk, "estimate") == pytest.approx(distance(walk, "truth"), rel=0.015)
