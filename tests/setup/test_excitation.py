"""The plan stays in its space, and the program stops it when something is not as planned."""

import math

import pytest
from robot_control.robot.pose import Pose
from robot_control.setup.excitation_watch import ANSWER, MARGIN, Observation, hindrance, interruption
from robot_control.setup.identify.excitation import CRUISE, REACH, SLOWEST, AxisLimits, NoRoomError, plan_excitation

LINEAR = AxisLimits(speed=1.0, acceleration=1.0, deceleration=1.0, jerk=10.0)
ANGULAR = AxisLimits(speed=2.0, acceleration=4.0, deceleration=4.0, jerk=40.0)
PERIOD = 0.001


def planned(*, linear=LINEAR, angular=ANGULAR, wheel_base=0.5, space=1.0, max_speed=0.5, repeats=1):
    return plan_excitation(linear, angular, wheel_base=wheel_base, space=space, max_speed=max_speed, repeats=repeats)


def driven(excitation, limits, axis):
    """Way of one axis under a limiter without jerk limit, m or rad, at every millisecond."""
    speed = travel = 0.0
    ways = []
    for k in range(round(excitation.seconds / PERIOD)):
        request = excitation.command(k * PERIOD)[axis]
        speed += max(-limits.deceleration * PERIOD, min(limits.acceleration * PERIOD, request - speed))
        travel += speed * PERIOD
        ways.append(travel)
    return ways


def test_the_plan_uses_its_space_and_ends_where_it_began():
    straight = AxisLimits(1.0, 1.0, 1.0, math.inf)
    excitation = planned(linear=straight, space=0.5, max_speed=1.0)
    travel = driven(excitation, straight, 0)
    assert max(travel) == pytest.approx(excitation.reach, abs=0.005)
    assert excitation.reach == pytest.approx(REACH * 0.5)
    assert min(travel) > -0.005
    assert travel[-1] == pytest.approx(0, abs=0.005)


def test_turns_undo_each_other():
    limits = AxisLimits(2.0, 4.0, 4.0, math.inf)
    travel = driven(planned(angular=limits), limits, 1)
    assert max(travel) == pytest.approx(planned(angular=limits).turn, abs=0.01)
    assert travel[-1] == pytest.approx(0, abs=0.01)


def test_it_drives_both_ways_at_three_speeds_straight_and_turning():
    moves = planned().moves
    for axis in ("linear", "angular"):
        speeds = {round(getattr(move, axis), 6) for move in moves} - {0.0}
        assert len(speeds) == 6
        assert {-speed for speed in speeds} == speeds
    assert all(move.linear == 0 or move.angular == 0 for move in moves)


def test_no_speed_beyond_what_is_allowed():
    excitation = planned(space=100, max_speed=0.3)
    assert excitation.linear == 0.3
    assert excitation.angular == pytest.approx(2 * 0.3 / 0.5)
    assert planned(space=100, max_speed=9).linear == LINEAR.speed
    assert planned(space=100, max_speed=9).angular == ANGULAR.speed


def test_the_request_after_the_end_is_zero():
    assert planned().command(1e6) == (0.0, 0.0)


def test_refuses_a_space_that_is_too_small_and_says_which_is_enough():
    with pytest.raises(NoRoomError, match=r"--space 0.01 m") as error:
        planned(space=0.01)
    enough = float(str(error.value).split("at least ")[1].split(" m")[0])
    assert planned(space=enough).linear >= SLOWEST
    assert enough >= SLOWEST * CRUISE


def test_refuses_a_speed_that_excites_nothing():
    with pytest.raises(NoRoomError, match="--max-speed"):
        planned(max_speed=0.01)


HEALTHY = {
    "pose": Pose(1.0, 2.0, math.pi / 2),
    "linear": 0.0,
    "angular": 0.0,
    "pose_age": 0.02,
    "state": "READY",
    "status_age": 0.5,
    "sentences": (),
    "missing": (),
    "speed_limit": math.inf,
    "senders": (),
}
START = Pose(1.0, 2.0, math.pi / 2)


def observation(**broken):
    return Observation(**{**HEALTHY, **broken})


def test_a_healthy_robot_may_be_driven():
    assert hindrance(observation()) == ""
    assert interruption(observation(state="DRIVE"), START, 0.7, 0.0) == ""


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ({"state": ""}, "no safety_status"),
        ({"pose": None}, "no odometry"),
        ({"senders": ("/teleop",)}, "/teleop may also send on cmd_vel"),
        ({"linear": 0.2}, "the robot moves"),
        ({"speed_limit": 0.3}, "limited to 0.3 m/s"),
        ({"state": "STOPPED", "sentences": ("the e-stop is pressed",)}, "the e-stop is pressed; remove the cause"),
        ({"state": "INIT", "missing": ("state_estimator",)}, "waiting: state_estimator; apply the remedy"),
    ],
)
def test_says_why_it_cannot_begin(broken, said):
    assert said in hindrance(observation(**broken))


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ({"pose_age": 1.5}, "no odometry for 1 s"),
        ({"status_age": 2.5}, "no safety_status for 2 s"),
        ({"state": "STOPPED", "sentences": ("a wheel is blocked",)}, "a wheel is blocked"),
        ({"pose": Pose(1.0, 2.0 + 0.7 + 2 * MARGIN, math.pi / 2)}, "0.90 m ahead"),
        ({"pose": Pose(1.0, 2.0 - 2 * MARGIN, math.pi / 2)}, "-0.20 m ahead"),
        ({"pose": Pose(1.0 - 2 * MARGIN, 2.0, math.pi / 2)}, "0.20 m to the left"),
    ],
)
def test_stops_when_something_is_not_as_planned(broken, said):
    assert said in interruption(observation(**{"state": "DRIVE", **broken}), START, 0.7, 0.0)


def test_stops_when_the_robot_does_not_answer():
    assert "does not move; check: rosrun robot_control why.py" in interruption(observation(), START, 0.7, ANSWER + 0.1)
