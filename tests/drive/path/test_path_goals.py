"""Goals of follow_path with their real decoding: what is no path is refused with its reason."""

import io
import itertools
import math
from types import SimpleNamespace

import pytest
from genpy import Time
from geometry_msgs.msg import PoseStamped, TwistStamped
from nav_msgs.msg import Odometry
from robot_control.drive.follow_path import main as server
from robot_control.drive.follow_path.main import Server, TimedGoal
from robot_control.drive.path import run
from robot_control.drive.path.follower import STAND
from robot_control.msg import FollowPathActionGoal
from robot_control.robot import boundary as crossing
from robot_control.robot.command import Command
from support.mutants import mutants
from support.timed import timed

COUNT, NIGHTLY_COUNT = 2000, 100_000


def goal_of(places):
    message = FollowPathActionGoal()
    message.goal_id.id, message.goal.path.header.frame_id = "1", "odom"
    for x, y, yaw in places:
        pose = PoseStamped()
        pose.pose.position.x, pose.pose.position.y = x, y
        pose.pose.orientation.z, pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        message.goal.path.poses.append(pose)
    message.goal.speeds, message.goal.turn_speeds = [0.5] * len(places), [0.0] * len(places)
    return message


def wire(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class Results:
    """The action server: the reasons with which goals ended."""

    def __init__(self):
        self.reasons = []
        self.current_goal = SimpleNamespace(goal=TimedGoal())
        self.set_succeeded = self.set_aborted = self.set_preempted = lambda result, _: self.reasons.append(
            result.reason
        )

    def is_preempt_requested(self):
        return False

    def is_new_goal_available(self):
        return False

    def publish_feedback(self, feedback):
        assert math.isfinite(feedback.progress + feedback.distance + feedback.remaining_distance)


@pytest.fixture
def follow_path(monkeypatch):
    """`Server` with a robot that stands at the origin, for ten messages of odometry per goal."""
    monkeypatch.setattr(crossing, "boundary", crossing.Boundary(lambda _: None))
    monkeypatch.setattr(server, "boundary", crossing.boundary)
    monkeypatch.setattr(run.time, "sleep", lambda _: None)
    monkeypatch.setattr(server.rospy, "loginfo", lambda _: None)
    monkeypatch.setattr(server.rospy, "Time", SimpleNamespace(now=server.rospy.Time))
    monkeypatch.setattr(server, "shown", lambda *_: None)
    monkeypatch.setattr(run.rospy, "Time", server.rospy.Time)
    made = Server.__new__(Server)
    made._began, made._action, made._services = -math.inf, Results(), SimpleNamespace(drive=None)
    made._idle = SimpleNamespace(clear=lambda: None, set=lambda: None)
    made.sent = []
    made._topic = SimpleNamespace(send=lambda command, *_: made.sent.append(command))
    made._velocity = STAND, Time(), -math.inf
    made._wanted = SimpleNamespace(publish=lambda *_: None)
    made._tf = SimpleNamespace(lookup=lambda *_: (_ for _ in ()).throw(server.PathError("no tf")))
    odometry = Odometry()
    odometry.pose.pose.orientation.w = 1.0
    made._robot = SimpleNamespace(frames=("odom", "base_link"), odometry=(odometry, 1.0), masked_by="")
    made._robot.speed_limit, made._robot.drivable = math.inf, True
    made._robot.await_drivable = lambda *_: ""
    made._robot.revoked = lambda *_, **__: ""
    made._robot.against_driving = lambda _: ""
    return made


def executed(follow_path, payload):
    """The reason with which the goal of these bytes ended; both are `timed`."""
    passes = itertools.count()

    def going_on():
        odometry, at = follow_path._robot.odometry
        follow_path._robot.odometry = odometry, at + 1.0
        return next(passes) < 10

    follow_path._going_on = going_on
    timed(lambda data: follow_path._execute(TimedGoal().deserialize(data).goal), payload)
    return follow_path._action.reasons[-1]


def test_a_steered_goal_sends_the_velocities_that_are_not_older(follow_path):
    goal, velocity = goal_of([(4.0, 0.0, 0.0)]), TwistStamped()
    goal.goal.steered, velocity.twist.linear.x, velocity.twist.linear.y = True, 0.4, 0.1
    follow_path._action.current_goal.goal.header.stamp, velocity.header.stamp = Time(7, 5), Time(7, 4)
    follow_path._receive_velocity(velocity)
    assert executed(follow_path, wire(goal)) == "interrupted"
    assert set(follow_path.sent) == {Command()}
    velocity.header.stamp = Time(7, 5)
    follow_path._receive_velocity(velocity)
    assert executed(follow_path, wire(goal)) == "interrupted"
    assert Command(0.4, 0.0, 0.1) in follow_path.sent
    assert follow_path.sent[-1] == Command()


def test_a_turn_alone_and_a_path_are_driven_and_what_is_none_is_refused(follow_path):
    assert executed(follow_path, wire(goal_of([(0.0, 0.0, 1.0)]))) == "interrupted"
    assert executed(follow_path, wire(goal_of([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]))) == "interrupted"
    assert executed(follow_path, wire(goal_of([(0.0, 0.0, 0.0)]))) == "done"
    assert "beyond 1e+06" in executed(follow_path, wire(goal_of([(0.0, 0.0, 0.0), (1e155, 0.0, 0.0)])))
    wrong = goal_of([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
    wrong.goal.path.poses[1].pose.position.x = math.nan
    assert "point 1 of the path holds a number that is not finite" in executed(follow_path, wire(wrong))
    assert "0 different points" in executed(follow_path, wire(wrong)[:-1])
    assert crossing.boundary.dropped == {"robot_control/FollowPathActionGoal": 1}


@pytest.mark.parametrize("count", [COUNT, pytest.param(NIGHTLY_COUNT, marks=pytest.mark.nightly)])
def test_no_goal_ends_follow_path_or_holds_it_up(follow_path, count):
    valid = wire(goal_of([(0.0, 0.0, 0.5), (1.0, 0.0, 0.0), (1.0, 1.0, 2.0)]))
    reasons = {executed(follow_path, payload) for payload in mutants(valid, count, seed=1)}
    assert len(reasons) > 3
    assert set(crossing.boundary.dropped) == {"robot_control/FollowPathActionGoal"}
