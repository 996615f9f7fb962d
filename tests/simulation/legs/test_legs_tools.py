"""The tools that drive a robot on wheels drive the quadbot, in virtual time: the demo's verdict, paths, footfalls."""

from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.data.demo.run_picture import draw_run
from robot_control.data.demo.run_summary import summarize, to_table
from robot_control.data.footfalls import FEET, footfalls_of
from robot_control.data.report.drive import Drive, mass_of
from robot_control.data.report.figures import figures
from robot_control.data.report.walking import BEARS, footfalls
from robot_control.drive.path.shapes import SHAPES
from robot_control.installed_files import share_file
from robot_control.loop.roles import LEGGED, Kind
from simulation.path_drive import driven

QUADBOT = share_file("urdf/quadbot.urdf")
LINEAR, ANGULAR = 0.5, 0.2  # m/s, rad/s, of scripts/demo
WALK = 8.0  # s
TIMING = ("driver_woke_ns", "command_published_ns", "permit_published_ns", "slipped_ns", "overruns")
"""columns that virtual time does not have"""


@pytest.fixture(scope="module")
def log():
    """It rests, stands up, walks, stops and lies down."""
    loop = ClosedLoop(urdf=QUADBOT)
    parts = [loop.run(1.0), loop.run(2.0 + WALK, (LINEAR, ANGULAR)), loop.run(2.0, (0.0, 0.0))]
    loop.set_posture("lying")
    parts.append(loop.run(4.5))
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    zero = np.zeros_like(joined["time"])
    return {**joined, "stamp_ns": 1e9 * joined["time"], **dict.fromkeys(TIMING, zero)}


def test_the_verdict_of_the_demo(log, tmp_path):
    summary = summarize(log, LINEAR, ANGULAR, WALK, legged=True)
    print(to_table(summary))
    assert summary.passed
    assert " ".join(summary.postures) == "lying gathering rising standing walking standing lowering lying"
    draw_run(log, summary, "a walk", tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 10_000


def test_a_robot_that_does_not_lie_again_fails_the_verdict(log):
    upright = {name: values[:-4500] for name, values in log.items()}
    summary = summarize(upright, LINEAR, ANGULAR, WALK, legged=True)
    assert summary.tracking.passed
    assert not summary.passed
    assert "FAILED, the robot does not lie" in " ".join(to_table(summary).split())


def test_the_feet_bear_in_turn_as_they_are_asked_to(log):
    feet = footfalls_of(log)
    assert tuple(foot.foot for foot in feet) == FEET
    walks = slice(5000, 10000)
    for foot in feet:
        assert 0.4 < foot.bears[walks].mean() < 0.6
        assert (foot.bears == foot.asked)[walks].mean() > 0.9
    assert (feet[0].bears == feet[3].bears)[walks].mean() > 0.9, "a trot moves diagonal legs together"


def test_the_report_has_the_feet_and_the_cost_of_transport(log):
    drive = Drive("walk", log, kind=Kind(LEGGED), mass=mass_of(Path(QUADBOT).read_text()))
    assert 5 < drive.mass < 50
    cost = figures(drive)["cost_of_transport"].value
    print(f"cost of transport {cost:.2f}")
    assert 0.1 < cost < 2.0, "of quadrupeds of this size; of a trotting dog about 0.3"
    found = footfalls(drive)
    assert {foot for foot, *_ in found} == {foot.replace("_", " ") for foot in FEET}
    strides = [begin for foot, begin, _, words in found if foot == "front left" and words == BEARS]
    assert len(strides) > WALK / 0.5


@pytest.mark.parametrize(("shape", "size"), [("square", 1.0), ("eight", 1.5)])
def test_a_path_is_walked_within_ten_centimetres(shape, size):
    follower, ends, true_error = driven(SHAPES[shape](size), urdf=QUADBOT)
    end = ends["truth"]
    own_error = follower.worst_cross_track_error
    print(f"{shape}: cross-track {1000 * own_error:.0f} mm, true {1000 * true_error:.0f} mm, end {end}")
    assert max(own_error, true_error) <= 0.1
    assert np.hypot(end.x, end.y) <= 0.05
