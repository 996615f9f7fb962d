"""Paths: their points, their pieces and the law, without a robot."""

import math
from pathlib import Path

import geometry_msgs.msg as geometry_msgs
import pytest
from robot_control.drive.drive_path.main import main
from robot_control.drive.path.follower import Follower, FollowParameters, Motion, State
from robot_control.drive.path.pieces import route, turned
from robot_control.drive.path.shapes import SHAPES
from robot_control.drive.path.waypoints import (
    PathError,
    Waypoint,
    checked,
    from_poses,
    limited,
    placed,
    read_csv,
    shortened,
)
from robot_control.robot.pose import Pose

STRAIGHT = [Waypoint(0.0, 0.0), Waypoint(4.0, 0.0)]
PERIOD = 0.02  # s


class Ideal:
    """A robot that follows its commands at once."""

    def __init__(self, x=0.0, y=0.0, yaw=0.0):
        self.pose, self.motion = Pose(x, y, yaw), Motion()

    def drive(self, command):
        self.motion = command
        yaw = self.pose.yaw + command.angular * PERIOD / 2
        self.pose = Pose(
            self.pose.x + command.linear * math.cos(yaw) * PERIOD,
            self.pose.y + command.linear * math.sin(yaw) * PERIOD,
            self.pose.yaw + command.angular * PERIOD,
        )


def drive(follower, robot, seconds, limit=math.inf):
    """The commands."""
    commands = []
    for _ in range(round(seconds / PERIOD)):
        commands.append(follower.step(robot.pose, robot.motion, limit))
        robot.drive(commands[-1])
    return commands


def test_gaps_in_the_odometry_are_no_motion_in_vain():
    """A machine with other work lets the program wait for 0.3 s again and again; the robot keeps its last command."""
    robot, follower = Ideal(), Follower(route(SHAPES["square"](0.5)))
    while not follower.over:
        drive(follower, robot, 0.5)
        if follower.over:
            break
        for _ in range(14):
            robot.drive(robot.motion)
        robot.drive(follower.step(robot.pose, robot.motion, elapsed=15 * PERIOD))
    assert follower.state is State.DONE, follower.reason


def test_stamps_of_a_machine_that_stands_still_are_no_motion_in_vain():
    """In every fifth step the simulated machine waits for 70 ms: the stamp is late, and the robot moves by a step."""
    robot, follower = Ideal(), Follower(route(SHAPES["square"](1.0)))
    steps = 0
    while not follower.over:
        steps += 1
        robot.drive(follower.step(robot.pose, robot.motion, elapsed=PERIOD + (0.07 if steps % 5 == 0 else 0.0)))
    assert follower.state is State.DONE, follower.reason


def test_the_way_back_of_what_a_robot_strayed_in_its_turns_is_no_motion_in_vain():
    """A robot on legs walks out of each corner while it turns, and its odometry says so."""
    side = SHAPES["square"](0.5)
    robot, follower = Ideal(), Follower(route([*side, *side[1:], *side[1:]]))
    while not follower.over:
        command = follower.step(robot.pose, robot.motion)
        strays = follower.state is State.TURNING and command.angular != 0
        robot.drive(Motion(-0.04, command.angular) if strays else command)
    assert follower.state is State.DONE, follower.reason


def refusal(points):
    with pytest.raises(PathError) as error:
        route(points)
    return str(error.value)


def test_one_point_is_no_path():
    assert refusal([Waypoint(1.0, 2.0)]) == "the path has 1 different points: it needs two at least"
    assert "1 different" in refusal([Waypoint(1.0, 2.0)] * 5)
    assert "0 different" in refusal([])


def test_one_point_with_a_heading_is_a_turn_on_the_spot():
    robot, follower = Ideal(0.1, 0.0), Follower(route([Waypoint(0.0, 0.0, yaw=math.pi / 2, turn_speed=0.5)]))
    assert follower.progress == 0.0
    commands = drive(follower, robot, 6.0)
    assert (follower.state, follower.progress, follower.remaining) == (State.DONE, 1.0, 0.0)
    assert robot.pose.yaw == pytest.approx(math.pi / 2, abs=0.01)
    assert (robot.pose.x, max(each.angular for each in commands)) == (0.1, 0.5)
    far = Follower(route([Waypoint(2.0, 0.0, yaw=1.0)]))
    far.step(Pose(0.0, 0.0, 0.0), Motion())
    assert "begins 2.00 m from the robot" in far.reason


def test_a_number_without_sense_is_refused_with_its_point():
    assert refusal([*STRAIGHT, Waypoint(1e155, 0.0)]) == "point 2 of the path holds a number beyond 1e+06"
    assert "beyond 1e+06" in refusal([*STRAIGHT, Waypoint(1.0, 1.0, speed=1e200)])


@pytest.mark.parametrize("wrong", [Waypoint(math.nan, 0.0), Waypoint(0.0, math.inf), Waypoint(1.0, 1.0, math.nan)])
def test_a_number_that_is_not_finite_is_refused_with_its_point(wrong):
    assert refusal([*STRAIGHT, wrong]) == "point 2 of the path holds a number that is not finite"


def test_a_speed_that_is_not_above_zero_is_refused():
    assert "speed of -1 m/s" in refusal([Waypoint(0.0, 0.0, speed=-1.0), Waypoint(1.0, 0.0)])


def test_a_jump_in_a_dense_path_is_refused_and_long_sides_are_none():
    dense = [Waypoint(0.05 * n + (3.0 if n > 20 else 0.0), 0.0) for n in range(40)]
    assert refusal(dense) == "the path jumps by 3.05 m after point 20, where its points are 0.05 m apart"
    route(SHAPES["square"](40.0))


def test_too_many_points_are_refused():
    assert "more than 100000" in refusal([Waypoint(0.01 * n, 0.0) for n in range(100_001)])


def test_repeated_points_are_one_and_the_last_yaw_counts():
    kept = checked([Waypoint(0.0, 0.0), Waypoint(0.0, 0.0), Waypoint(1.0, 0.0), Waypoint(1.0, 0.0, yaw=1.0)])
    assert [(point.x, point.yaw) for point in kept] == [(0.0, None), (1.0, 1.0)]


def test_a_csv_file(tmp_path):
    path = tmp_path / "path.csv"
    path.write_text("x,y,yaw,speed\n0,0,,0.2\n1, 0.5,0.1,\n")
    assert read_csv(path) == [Waypoint(0.0, 0.0, speed=0.2), Waypoint(1.0, 0.5, yaw=0.1)]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("0,0\n1,0\n", "first line must be x,y"),
        ("", "first line must be x,y"),
        ("x,y,z\n0,0,0\n", "'x, y, z'"),
        ("x,y\n0,0\n1,one\n", "path.csv:3: not a point"),
        ("x,y\n0\n", "path.csv:2: not a point"),
        ("x,y\n0,0,0\n", "path.csv:2: not a point"),
        ("x,y\n0,0\n1," + "1" * 131073 + "\n", "path.csv: is not a CSV: field larger than field limit"),
        ("x,y" + "y" * 131073, "path.csv: is not a CSV: field larger than field limit"),
    ],
)
def test_a_csv_file_that_is_none_is_refused_with_its_line(tmp_path, text, words):
    path = tmp_path / "path.csv"
    path.write_text(text)
    with pytest.raises(PathError) as error:
        list(map(vars, read_csv(path)))
    assert words in str(error.value)


def test_what_is_no_text_is_refused(tmp_path):
    path = tmp_path / "path.csv"
    path.write_bytes(bytes(range(128, 256)))
    with pytest.raises(PathError, match="first line must be x,y"):
        read_csv(path)
    with pytest.raises(PathError, match="is a device; only a regular file is read"):
        read_csv(Path("/dev/zero"))


def test_a_file_that_is_not_there_is_named_beside_the_shapes(monkeypatch, tmp_path):
    monkeypatch.setattr("sys.argv", ["drive_path.py", str(tmp_path / "sqare")])
    with pytest.raises(SystemExit) as error:
        main()
    assert error.value.code == (
        f"drive_path.py: {tmp_path / 'sqare'}: file not found; the shapes are square, circle, eight"
    )


NO_ORIENTATION, LEFT = (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))


def pose_at(x, orientation):
    return geometry_msgs.Pose(geometry_msgs.Point(x, 0.0, 0.0), geometry_msgs.Quaternion(*orientation))


def test_a_path_message_without_orientations_is_driven_along_itself():
    points = from_poses([pose_at(0.0, NO_ORIENTATION), pose_at(1.0, LEFT)])
    assert points == [Waypoint(0.0, 0.0), Waypoint(1.0, 0.0, yaw=pytest.approx(math.pi / 2))]
    thrice = from_poses([pose_at(0.0, (3 * part for part in LEFT))])
    assert thrice[0].yaw == pytest.approx(math.pi / 2)


def test_an_orientation_that_is_not_finite_is_refused():
    points = from_poses([pose_at(0.0, (math.nan,) * 4), pose_at(1.0, NO_ORIENTATION)])
    assert "not finite" in refusal(points)


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("size", [0.5, 4.0])
def test_a_shape_is_as_wide_as_its_size_and_ends_as_it_begins(name, size):
    points = SHAPES[name](size)
    first, last = route(points).pieces[0].first_heading, route(points).end_heading
    assert (points[0].x, points[0].y, points[-1].x, points[-1].y) == (0.0, 0.0, 0.0, 0.0)
    assert abs(first) < 0.05
    assert last == 0.0
    width = max(point.y for point in points) - min(point.y for point in points)
    assert width == pytest.approx(size, rel=0.01)


def test_a_path_is_cut_at_corners_alone():
    assert len(route(SHAPES["square"](1.0)).pieces) == 4
    assert len(route(SHAPES["circle"](1.0)).pieces) == 1
    assert len(route(SHAPES["eight"](1.0)).pieces) == 1


def test_a_segment_is_driven_backwards_where_its_poses_point_against_it():
    there_and_back = [Waypoint(0.0, 0.0, 0.0), Waypoint(1.0, 0.0, 0.0), Waypoint(0.0, 0.0, 0.0)]
    assert [piece.sign for piece in route(there_and_back).pieces] == [1, -1]
    assert route(there_and_back).pieces[1].first_heading == pytest.approx(0.0)
    assert [piece.sign for piece in route([Waypoint(0.0, 0.0), Waypoint(1.0, 0.0)]).pieces] == [1]


@pytest.mark.parametrize("yaw", [1.5, -1.5])
def test_poses_across_a_segment_do_not_turn_it_round(yaw):
    assert route([Waypoint(0.0, 0.0, yaw), Waypoint(1.0, 0.0, yaw)]).pieces[0].sign == 1


def test_a_placed_path_begins_at_the_pose():
    points = placed([Waypoint(0.0, 0.0), Waypoint(1.0, 0.0, yaw=0.5)], Pose(2.0, 3.0, math.pi / 2))
    assert (points[0].x, points[0].y) == (2.0, 3.0)
    assert (points[1].x, points[1].y, points[1].yaw) == pytest.approx((2.0, 4.0, 0.5 + math.pi / 2))


def test_a_path_that_is_begun_farther_along_is_its_rest():
    points = [Waypoint(0.0, 0.0, speed=0.2), Waypoint(1.0, 0.0), Waypoint(1.0, 2.0, yaw=1.0)]
    assert shortened(points, 0.0) == points
    assert shortened(points, 0.25) == [Waypoint(0.25, 0.0, speed=0.2), *points[1:]]
    assert shortened(points, 1.5) == [Waypoint(1.0, 0.5, speed=0.2), points[2]]


def test_a_part_that_is_begun_farther_along_stays_one_that_is_driven_backwards():
    there_and_back = [Waypoint(0.0, 0.0, 0.0), Waypoint(1.0, 0.0, 0.0), Waypoint(0.0, 0.0, 0.0)]
    assert [piece.sign for piece in route(shortened(there_and_back, 1.5)).pieces] == [-1]


@pytest.mark.parametrize("begin_at", [-0.1, 4.0, math.nan, math.inf])
def test_a_path_is_not_begun_beyond_its_ends(begin_at):
    with pytest.raises(PathError) as error:
        shortened(STRAIGHT, begin_at)
    assert f"begin_at is {begin_at:g} m" in str(error.value)
    assert "4.00 m" in str(error.value)


@pytest.mark.parametrize("angle", [0.0, 3.0, math.pi, -3.0, 7.0, -math.pi])
def test_turned_is_the_same_angle_above_minus_pi(angle):
    assert -math.pi < turned(angle) <= math.pi
    assert math.cos(turned(angle) - angle) == pytest.approx(1.0)


@pytest.mark.parametrize("name", SHAPES)
def test_an_ideal_robot_reaches_the_end_of_every_shape(name):
    follower, robot = Follower(route(SHAPES[name](2.0))), Ideal()
    drive(follower, robot, 90.0)
    assert follower.state is State.DONE
    assert follower.progress == 1.0
    assert follower.worst_cross_track_error < 0.03
    assert math.hypot(robot.pose.x, robot.pose.y) < 0.02
    assert abs(turned(robot.pose.yaw)) < math.radians(2)


def test_an_offset_is_driven_out():
    follower, robot = Follower(route(STRAIGHT)), Ideal(y=0.2)
    drive(follower, robot, 7.0)
    assert abs(robot.pose.y) < 0.01


def test_no_command_exceeds_speed_yaw_rate_and_limit():
    given = FollowParameters(speed=0.7)
    commands = drive(Follower(route(SHAPES["eight"](1.5)), given), Ideal(), 60.0)
    assert max(abs(command.linear) for command in commands) <= 0.7
    assert max(abs(command.angular) for command in commands) <= given.max_angular_speed + 1e-9
    commands = drive(Follower(route(STRAIGHT)), Ideal(), 5.0, limit=0.1)
    assert max(abs(command.linear) for command in commands) == 0.1


@pytest.mark.parametrize("sign", [1, -1])
def test_where_nothing_may_drive_the_command_says_where_the_path_goes(sign):
    path = [Waypoint(0.0, 0.0, 0.0), Waypoint(1.0 * sign, 0.0, 0.0)]
    commands = drive(Follower(route(path)), Ideal(), 1.0, limit=0.0)
    assert {command.linear for command in commands} == {sign * FollowParameters.slowest}


def test_a_speed_of_the_path_holds_from_its_point_on():
    points = [Waypoint(0.0, 0.0, speed=0.2), Waypoint(1.0, 0.0, speed=0.4), Waypoint(4.0, 0.0)]
    follower, robot = Follower(route(points)), Ideal()
    assert max(command.linear for command in drive(follower, robot, 4.9)) == 0.2
    assert max(command.linear for command in drive(follower, robot, 4.0)) == 0.4


def test_ten_thousand_points_are_followed_like_few():
    points = [Waypoint(0.0004 * n, 0.0) for n in range(10_001)]
    follower, robot = Follower(route(points)), Ideal()
    drive(follower, robot, 12.0)
    assert follower.state is State.DONE
    assert follower.distance == pytest.approx(4.0)


def test_a_paused_path_stands_and_goes_on_after_resume_alone():
    follower, robot = Follower(route(STRAIGHT)), Ideal()
    drive(follower, robot, 2.0)
    follower.pause()
    assert set(drive(follower, robot, 2.0)) == {Motion()}
    assert follower.state is State.PAUSED
    follower.resume()
    drive(follower, robot, 12.0)
    assert follower.state is State.DONE


def test_a_robot_off_the_path_ends_it_with_a_reason_and_zero():
    follower, robot = Follower(route(STRAIGHT)), Ideal()
    drive(follower, robot, 2.0)
    for aside in (0.08, 0.16, 0.24, 0.32):
        robot.pose = Pose(robot.pose.x, aside, 0.0)
        command = follower.step(robot.pose, robot.motion)
    assert command == Motion()
    assert (follower.state, follower.reason) == (State.FAILED, "0.32 m off the path, more than 0.3 m")
    follower.resume()
    assert follower.over


def test_a_path_that_begins_elsewhere_is_not_begun():
    follower, robot = Follower(route(STRAIGHT)), Ideal(x=-2.0)
    assert drive(follower, robot, 0.1)[0] == Motion()
    assert follower.reason == "the path begins 2.00 m from the robot, more than 0.5 m"


def test_odometry_that_is_not_finite_ends_it():
    follower = Follower(route(STRAIGHT))
    assert follower.step(Pose(math.nan, 0.0, 0.0), Motion()) == Motion()
    assert "not finite" in follower.reason


def test_crossing_paths_do_not_confuse_where_it_is():
    """At its crossing an eight runs through the same point three times."""
    follower, robot = Follower(route(SHAPES["eight"](2.0))), Ideal()
    last = 0.0
    for _ in range(1500):
        drive(follower, robot, PERIOD)
        if follower.over:
            break
        assert last <= follower.progress + 1e-3
        assert follower.progress - last < 0.1
        last = follower.progress
    assert follower.state is State.DONE


def limits(points, speeds, turn_speeds=()):
    return route(limited(points, speeds, turn_speeds))


def test_a_slower_segment_is_entered_at_its_speed_and_a_faster_one_is_left_at_its_own():
    """Without the look ahead the robot enters the third metre at 0.5 m/s."""
    points = [Waypoint(float(x), 0.0) for x in range(5)]
    follower, robot = Follower(limits(points, [0.3, 0.5, 0.1, 0.5, 0.5])), Ideal()
    speeds = [[], [], [], []]
    for _ in range(1500):
        robot.drive(follower.step(robot.pose, robot.motion))
        speeds[min(3, int(robot.pose.x))].append(robot.motion.linear)
    assert follower.state is State.DONE
    for own, limit in zip(speeds, (0.3, 0.5, 0.1, 0.5), strict=True):
        assert max(own) == pytest.approx(limit, abs=0.01)


def test_a_turn_obeys_the_limit_of_the_segment_that_follows_and_the_last_one_that_before():
    points = [Waypoint(0.0, 0.0), Waypoint(1.0, 0.0), Waypoint(1.0, 1.0, yaw=math.pi)]
    for given, fastest in (([0.0, 0.0, 0.0], 1.0), ([0.4, 0.0, 0.0], 1.0), ([0.0, 0.4, 0.0], 0.4)):
        follower = Follower(limits(points, [0.5] * 3, given))
        turns = [abs(command.angular) for command in drive(follower, Ideal(), 30.0) if command.linear == 0.0]
        assert follower.state is State.DONE
        assert max(turns) == pytest.approx(fastest, abs=0.01)


def test_a_negative_speed_is_driven_backwards_whatever_the_orientations_are():
    points = [Waypoint(0.0, 0.0, yaw=0.0), Waypoint(1.0, 0.0, yaw=0.0), Waypoint(2.0, 0.0, yaw=0.0)]
    assert [(piece.sign, piece.length) for piece in limits(points, [0.3, -0.2, -0.2]).pieces] == [(1, 1.0), (-1, 1.0)]
    assert [piece.sign for piece in limits(points, []).pieces] == [1]


@pytest.mark.parametrize(
    ("speeds", "turns", "words"),
    [
        ([0.5], [], "speeds has 1 numbers and the path 2 poses"),
        ([], [0.5] * 3, "turn_speeds has 3 numbers"),
        ([0.5, 0.0], [], "not zero"),
        ([0.5, math.nan], [], "finite"),
        ([], [0.5, -1.0], "must be above zero"),
        ([], [0.5, math.nan], "must be above zero"),
    ],
)
def test_limits_that_fit_no_path_are_refused(speeds, turns, words):
    with pytest.raises(PathError) as error:
        limits(STRAIGHT, speeds, turns)
    assert words in str(error.value)


def test_a_path_that_begins_later_keeps_its_limits():
    points = shortened(limited([Waypoint(float(x), 0.0) for x in range(4)], [0.3] * 4, [0.0, 0.2, 0.0, 0.0]), 1.5)
    assert (points[0].speed, points[0].turn_speed) == (0.3, 0.2)


def test_an_extension_goes_on_without_a_stop():
    """A newer goal with the longer path, from where the robot is: the speed never falls below that of the edge."""
    first, robot = Follower(limits([Waypoint(0.0, 0.0), Waypoint(1.0, 0.0)], [0.5] * 2)), Ideal()
    drive(first, robot, 1.0)
    longer = limited([Waypoint(float(x), 0.0) for x in range(4)], [0.5] * 4, [])
    second = Follower(route(shortened(longer, first.distance)))
    speeds = [command.linear for command in drive(second, robot, 4.0)]
    assert min(speeds) == pytest.approx(0.5)
