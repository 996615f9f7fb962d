"""The laser of the simulated robot, in the closed loop and in the scenes for it."""

import math
from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file

from bench.navigation.tour import drive, new_loop


def scans(seed):
    loop = new_loop("room", seed)
    loop.run(1.0, (0.0, 0.0))
    seen = []
    for _ in range(5):
        loop.run(0.1, (0.3, 0.2))
        seen.append(loop.scan()["ranges"])
    return np.array(seen)


def test_the_same_seed_gives_the_same_bits():
    first = scans(3)
    assert first.tobytes() == scans(3).tobytes()
    assert first.tobytes() != scans(4).tobytes()


def test_a_scan_is_of_the_last_cycle():
    loop = new_loop("room", 0)
    log = loop.run(0.1, (0.0, 0.0))
    assert loop.scan()["cycle"] == loop.cycle - 1 == round(log["time"][-1] / loop.period)
    assert loop.scan()["stamp_ns"] == round(log["time"][-1] * 1e9)


def test_without_a_laser_it_says_what_to_set():
    loop = ClosedLoop()
    loop.step()
    with pytest.raises(ValueError, match=r"there is no laser: set laser\.rate"):
        loop.scan()


def test_a_robot_without_a_laser_gets_one_where_the_parameters_say_so(tmp_path):
    urdf = tmp_path / "bare.urdf"
    urdf.write_text(Path(share_file("urdf/diffbot.urdf")).read_text().replace("laser_link", "mast"))
    params = {"mujoco_plant": {"laser": {"rate": 10}}}
    with pytest.raises(RuntimeError, match=r"no link \"laser_link\".*robot\.simulated_laser: true"):
        ClosedLoop(params, urdf=str(urdf))
    loop = ClosedLoop({**params, "robot": {"simulated_laser": True}}, urdf=str(urdf))
    loop.step()
    assert len(loop.scan()["ranges"]) == 360


def test_a_robot_that_drives_sees_the_wall_ahead_come_nearer():
    """In `room` the end of the corridor is 10 m ahead of the start, less half of the wall."""
    sights = list(drive(new_loop("room", 0, {"sensor_errors": "ideal"}), ((2.0, 0.0),)))
    for sight in sights[::20]:
        ahead = sight.scan["ranges"][len(sight.scan["ranges"]) // 2]
        if math.isfinite(ahead):  # no drop-out
            assert ahead == pytest.approx(10 - 0.05 - 0.05 - sight.truth[0], abs=0.05)  # 5 σ


def test_a_body_on_a_path_moves_in_the_loop():
    """In `crowd` the first cart starts 4.2 m to the right of the start and drives towards it with 0.4 m/s."""
    loop = new_loop("crowd", 0, {"sensor_errors": "ideal"})
    nearest = []
    for _ in range(2):
        loop.run(2.5, (0.0, 0.0))
        ranges = loop.scan()["ranges"]
        ahead_right = ranges[90:180]  # from -90 degrees to 0
        nearest.append(float(np.min(ahead_right)))
    assert nearest[0] - nearest[1] > 0.5
