"""follow_path.py's ROS side: the action follow_path."""

from __future__ import annotations

import argparse
import math
import threading
import time
from collections.abc import Callable

import actionlib
import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Path

import robot_control.msg as messages
from robot_control.drive.path.follower import STAND, Follower, FollowParameters, Motion, State
from robot_control.drive.path.frames import Tf, located
from robot_control.drive.path.pieces import route
from robot_control.drive.path.robot import SOURCE, Robot
from robot_control.drive.path.run import Drive, PauseServices, points_of, shown
from robot_control.drive.path.steered import Steered
from robot_control.drive.path.waypoints import PathError, checked, limited, shortened
from robot_control.robot.boundary import boundary, guard_action, subscribe, unsealed
from robot_control.robot.command import Command
from robot_control.robot.command_topic import CommandTopic
from robot_control.robot.interruptions import GAP, requested_at
from robot_control.robot.pose import FARTHEST
from robot_control.robot.ros_node import running_node
from robot_control.robot.topic_sender import Signals

NAME = "follow_path"
FEEDBACK_PERIOD = 0.2
"""s; a change of the state is sent at once"""
END = 2.0
"""s for the goal that is driven when the program is ended"""
POLL_PERIOD = 0.05
"""s between two looks of the main thread"""
NUMBERS = ("x", "y", "z", "w", "speed", "speeds", "turn_speeds", "begin_at")
"""fields of a goal whose numbers are checked when it begins: the result says which one is wrong"""
UNSTAMPED = f"a goal without goal_id.stamp counts as sent {GAP:g} s before it arrived"


class TimedGoal(unsealed(messages.FollowPathActionGoal, NUMBERS)):  # type: ignore[misc]
    """A goal that notes its time of request: a long one takes seconds to be read, and actionlib stamps one without
    time. One that cannot be read replaces the present goal and is refused, for it has no path.
    """

    stamped = False
    requested = math.inf
    """s, monotonic"""

    def deserialize(self, buffer: bytes) -> TimedGoal:
        """Called by rospy with the bytes of one message."""
        arrived = time.monotonic()
        super().deserialize(buffer)
        stamp, now = self.goal_id.stamp.to_sec(), time.monotonic()
        self.stamped = stamp > 0
        sent = now - (rospy.Time.now().to_sec() - stamp) if stamp else None
        self.requested = requested_at(arrived, sent)
        return self


class TimedAction(messages.FollowPathAction):  # type: ignore[misc]
    """The action follow_path with such goals."""

    def __init__(self) -> None:
        super().__init__()
        self.action_goal = TimedGoal()


class Server:
    """One goal at a time; the newest counts."""

    def __init__(self, signals: Signals) -> None:
        self._signals, self._began = signals, time.monotonic()
        self._robot, self._topic, self._tf = Robot(attended=True), CommandTopic(SOURCE), Tf()
        self._services = PauseServices()
        self._velocity = (STAND, rospy.Time(), -math.inf)  # the newest one, its stamp, and s, monotonic, of its arrival
        subscribe("follow_path/velocity", TwistStamped, self._receive_velocity, queue_size=1, tcp_nodelay=True)
        self._wanted = rospy.Publisher("path_wanted", Path, queue_size=1, latch=True)
        self._idle = threading.Event()
        self._idle.set()
        guard_action(NAME, cancel=unsealed(GoalID))
        self._action = actionlib.SimpleActionServer(NAME, TimedAction, self._execute, auto_start=False)
        boundary.stops(self._stop)
        self._action.start()

    def attend(self) -> None:
        """Notes a gap in which goals may have waited; it is called in every pass, whether a goal is driven or not."""
        self._robot.watch.interrupted()

    def await_end(self) -> None:
        """Waits after a signal for the end of the goal that is driven."""
        self._idle.wait(END)

    def _stop(self) -> None:
        if drive := self._services.drive:
            drive.follower.fail("invalid input, named in the log of follow_path. Start the path again")
        self._topic.send(Command())

    def _receive_velocity(self, message: TwistStamped) -> None:
        linear, angular = message.twist.linear, message.twist.angular
        self._velocity = Motion(linear.x, angular.z, linear.y), message.header.stamp, time.monotonic()

    def _velocities(self, sent: rospy.Time) -> Callable[[], tuple[Motion, float]]:
        """The velocities of a goal that begins now; those from before `sent` do not count."""
        begun = time.monotonic()

        def newest() -> tuple[Motion, float]:
            motion, stamp, at = self._velocity
            return (motion, time.monotonic() - at) if stamp >= sent else (STAND, time.monotonic() - begun)

        return newest

    def _going_on(self) -> bool:
        return self._signals.going_on() and not self._action.is_preempt_requested()

    def _execute(self, goal: messages.FollowPathGoal) -> None:
        self._idle.clear()
        result = messages.FollowPathResult(reason="invalid goal, named in the log of follow_path")
        with boundary.crossing(NAME):
            try:
                result.reason = self._drive(goal, result)
            except PathError as error:
                result.reason = str(error)
        self._services.drive = None
        replaced = self._action.is_new_goal_available()
        if result.reason or not replaced:
            self._topic.send(Command())
        self._conclude(result, replaced=replaced)
        self._idle.set()

    def _conclude(self, result: messages.FollowPathResult, *, replaced: bool) -> None:
        if result.reason == "done":
            conclude = self._action.set_succeeded
        elif replaced or self._action.is_preempt_requested():
            result.reason = "replaced by a newer goal" if replaced else "cancelled"
            conclude = self._action.set_preempted
        else:
            result.reason = result.reason or "interrupted"
            conclude = self._action.set_aborted
        rospy.loginfo(f"{result.reason}; {result.distance:.2f} m along the path")
        conclude(result, result.reason)

    def _drive(self, goal: messages.FollowPathGoal, result: messages.FollowPathResult) -> str:
        """Why the path ended. Raises PathError: the goal cannot be driven."""
        if not 0 <= goal.speed <= FARTHEST:
            raise PathError(f"speed is {goal.speed:g} m/s: it must be a number from zero on; zero is the default")
        message = self._action.current_goal.goal
        points = limited(points_of(goal.path), goal.speeds, goal.turn_speeds)
        points = shortened(checked(points), goal.begin_at)
        result.distance = goal.begin_at
        refusal = self._refusal(message)
        if refusal:
            unknown = self._robot.drivable and not message.stamped
            return f"{refusal} ({UNSTAMPED})" if unknown else refusal
        points, frame = located(points, goal.path.header.frame_id, self._robot.frames, self._tf)
        speed = goal.speed or FollowParameters.speed
        follower = (
            Steered(route(points), self._velocities(message.header.stamp))
            if goal.steered
            else Follower(route(points), FollowParameters(speed=speed, scale_error=frame.scale_error))
        )
        self._wanted.publish(shown(points, frame.name))
        drive = Drive(self._robot, self._topic, follower, frame, message.requested)
        self._services.drive = drive
        reporter = Reporter(self._action, drive, goal.begin_at)
        drive.run(self._going_on, reporter.poll)
        result.distance = goal.begin_at + follower.distance
        result.worst_cross_track_error = follower.worst_cross_track_error
        return "done" if follower.state is State.DONE else follower.reason

    def _refusal(self, message: TimedGoal) -> str:
        """Why the goal does not begin; empty if it does. This program knows of no stop before its own begin."""
        if message.requested < self._began:
            return "it was requested before follow_path began. Start the path again"
        said = -math.inf

        def awaits_permit() -> bool:
            nonlocal said
            if time.monotonic() - said >= FEEDBACK_PERIOD:
                said = time.monotonic()
                self._action.publish_feedback(
                    messages.FollowPathFeedback(state="waiting", reason="for the permit to drive")
                )
            return self._going_on()

        return self._robot.await_drivable(self._topic, awaits_permit, message.requested)


class Reporter:
    """The feedback of one goal."""

    def __init__(self, action: actionlib.SimpleActionServer, drive: Drive, begin_at: float) -> None:
        self._action, self._drive, self._begin_at = action, drive, begin_at
        self._sent_at, self._said = -math.inf, State.PAUSED

    def poll(self) -> None:
        """Sends the feedback if it is due."""
        now, follower = time.monotonic(), self._drive.follower
        if follower.state is self._said and now - self._sent_at < FEEDBACK_PERIOD:
            return
        self._sent_at, self._said = now, follower.state
        distance = self._begin_at + follower.distance
        self._action.publish_feedback(
            messages.FollowPathFeedback(
                state=follower.state.name.lower(),
                reason=self._drive.paused_by,
                progress=follower.progress if not distance else distance / (distance + follower.remaining),
                distance=distance,
                remaining_distance=follower.remaining,
                cross_track_error=follower.cross_track_error,
                heading_error=follower.heading_error,
            )
        )


def main() -> None:
    """Entry point of scripts/follow_path.py."""
    argparse.ArgumentParser(
        prog="follow_path.py",
        description="Serves the action follow_path (robot_control/FollowPath.action): drives the robot along the path "
        "of a goal. Commands go to path_vel where the robot has a list of command sources, else to cmd_vel_stamped. "
        "Services: follow_path/pause, follow_path/resume.",
    ).parse_args(rospy.myargv()[1:])
    with running_node(NAME) as signals:
        server = Server(signals)
        while signals.going_on():
            server.attend()
            time.sleep(POLL_PERIOD)
        server.await_end()
