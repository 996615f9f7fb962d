"""A steered path passes velocities on, stands without them, and ends by silence and by a jump of the pose."""

import math

import pytest
from robot_control.drive.path.follower import PERIOD, STAND, Motion, State
from robot_control.drive.path.pieces import route
from robot_control.drive.path.steered import LATE, SILENCE, Steered
from robot_control.drive.path.waypoints import Waypoint
from robot_control.robot.pose import Pose

REQUEST = Motion(0.4, -0.2, 0.1)


@pytest.fixture
def steered():
    """A follower far from its path; `given` holds the newest velocity and its age in s."""
    made = Steered(route([Waypoint(5.0, 0.0, 1.0)]), lambda: made.given)
    made.given = (REQUEST, 0.0)
    return made


def at(x, y=0.0):
    return Pose(x, y, 0.0)


def test_velocities_are_passed_on_until_the_goal_ends_otherwise(steered):
    for step in range(50):
        assert steered.step(at(0.01 * step), Motion(0.5)) == REQUEST
    assert steered.state is State.DRIVING


def test_a_late_velocity_is_not_driven_and_silence_ends_the_path(steered):
    assert steered.step(at(0.0), STAND) == REQUEST
    steered.given = (REQUEST, 1.01 * LATE)
    assert steered.step(at(0.0), STAND) == STAND
    assert not steered.over
    steered.given = (REQUEST, 1.01 * SILENCE)
    assert steered.step(at(0.0), STAND) == STAND
    assert steered.reason == "no velocity for 1 s"


def test_a_paused_one_stands_without_regard_to_silence_and_goes_on(steered):
    steered.step(at(0.0), STAND)
    steered.pause()
    steered.given = (REQUEST, 1e3)
    assert steered.step(at(0.0), STAND) == STAND
    steered.resume()
    steered.given = (REQUEST, 0.0)
    assert steered.step(at(0.0), STAND) == REQUEST


def test_a_jump_of_the_pose_ends_it_and_sideways_motion_is_none(steered):
    for step in range(10):
        steered.step(at(0.0, 0.3 * step), Motion(lateral=0.3), elapsed=1.0)
    assert not steered.over
    steered.step(at(0.3, 2.7), Motion(lateral=0.3), elapsed=PERIOD)
    assert "the pose jumped by 0.30 m" in steered.reason
    assert steered.step(at(0.3, 2.7), STAND) == STAND


def test_a_pose_that_is_not_finite_ends_it(steered):
    assert steered.step(at(math.nan), STAND) == STAND
    assert "not finite" in steered.reason
