"""A robot on legs behind the simulated low level of a Go1 or Go2.

It stands up, walks as requested, and folds at each loss.
"""

import os
from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.loop.signal_names import mask_of

QUADRUPEDS = Path(os.environ.get("ROBOT_QUADRUPEDS", Path(__file__).parents[4] / "shared/quadrupeds"))
SPEED = 0.5  # m/s
RISE = 3.0  # s, from the request until it walks evenly
WALK = 6.0  # s
STANDING = 0.01  # m/s
TILT = 0.6  # rad, from which it would fall over
LATEST = {
    ("line", "cut"): 0.02,
    ("robot", "off"): 0.02,
    ("robot", "encrypted"): 0.02,
    ("robot", "frozen"): 0.02,
    ("robot", "other_robot"): 0.02,
    ("motor", "hot"): 0.3,
    ("robot", "low_battery"): 0.3,
}
"""s, from the loss until the driver reports it"""


BRIDGE = [("off", 0.024), ("other_commands", 0.01), ("second_writer", 0.01), ("asked", 0.01)]
"""faults of the bridge before a Go2, and s until the driver reports them"""


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


def expect_a_stop_upright(driver, component, kind, latest):
    loop = loop_of("quadbot", 500, driver)
    loop.run(1.0)
    loop.run(RISE, (SPEED, 0.0))
    loop.inject_fault(component, kind)
    stop = loop.run(4.0, (SPEED, 0.0))
    fault = (stop["permit_causes"].astype(np.uint64) & np.uint64(mask_of("StopCause", "driver_fault"))) != 0
    assert fault.any()
    assert np.argmax(fault) <= latest * 500
    assert np.abs(stop["truth_linear"][-500:]).max() < STANDING
    assert stop["truth_tilt"].max() < TILT


@pytest.mark.parametrize(("component", "kind"), LATEST)
def test_each_loss_stops_it_upright(component, kind):
    expect_a_stop_upright("unitree_legged", component, kind, LATEST[component, kind])


@pytest.mark.parametrize(("kind", "latest"), BRIDGE)
def test_each_loss_of_the_bridge_stops_it_upright(kind, latest):
    expect_a_stop_upright("unitree_go", "bridge", kind, latest)


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
