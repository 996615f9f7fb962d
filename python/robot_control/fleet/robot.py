"""The robot behind its topics: facts from messages, legs as goals of follow_path, map → odom."""

import math
import time
from typing import Any

import actionlib
import rospy
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from geometry_msgs.msg import Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from tf2_msgs.msg import TFMessage

from robot_control.drive.path.frames import Tf
from robot_control.drive.path.run import path_of, placed_pose
from robot_control.drive.path.waypoints import PathError, Waypoint
from robot_control.files.files import printable
from robot_control.fleet.client import DONE, DRIVING, ENDED, Progress
from robot_control.fleet.custom import Actions
from robot_control.fleet.settings import CustomAction, Settings
from robot_control.fleet.v2.leg import PathPoint
from robot_control.fleet.v2.messages import Error
from robot_control.fleet.v2.state import Facts
from robot_control.msg import FollowPathAction, FollowPathFeedback, FollowPathGoal, SafetyStatus
from robot_control.robot.boundary import guard_action, unsealed
from robot_control.robot.diagnosis.diagnosis import MOVING
from robot_control.robot.diagnosis.state import SILENCE
from robot_control.robot.pose import Pose, pose_of, turned
from robot_control.robot.safety_states import DRIVABLE, STOPPED
from robot_control.robot.safety_watch import CATCH_UP, LATE
from robot_control.robot.view import View

MAP = "map"
ACTION = "follow_path"
RESUME = CustomAction(service=f"{ACTION}/resume", timeout=5.0)
"""stopPause for a path that is held at the robot"""
POSE_JUMP = 0.5
"""m, rad beyond the measured motion: odometry was set, and map → odom does not hold any more"""
MAX_ERRORS = 20
"""of each kind of errors in a state; the monitor has fewer causes"""
SPEED_CHANGE = 1.0
"""m/s², rad/s² by which the robot may have been faster between two messages than at both"""


class RosRobot:
    """The port of the client; its methods are called by one thread, the callbacks by rospy's."""

    def __init__(self, settings: Settings, saved: list[Any] | None) -> None:
        """`saved`: `position` of the program before; None: the position is not initialized."""
        self.progress, self._goal = Progress(), 0
        self._settings, self.actions = settings, Actions({**settings.actions, "stopPause": RESUME})
        self.begin, self.end, self.results = self.actions.begin, self.actions.end, self.actions.results
        self._odometry: Odometry | None = None
        self._feedback_at = self._called_at = -math.inf
        self._held_by = ""
        self._saved, self._run = saved, 0
        self.map_odom: list[Any] | None = None  # mapId, x, y, yaw of odom in the map, if this program sets it
        self._tf = Tf() if settings.localization else None
        self._static = rospy.Publisher("tf_static", TFMessage, queue_size=1, latch=True)
        self._view = View("odom", "safety_status", "robot_status", "battery_state", "guard_state")
        action = FollowPathAction()
        results, feedback = (unsealed(type(each)) for each in (action.action_result, action.action_feedback))
        guard_action(ACTION, status=unsealed(GoalStatusArray), result=results, feedback=feedback)
        self._client = actionlib.ActionClient(ACTION, FollowPathAction)
        self._handles: list[actionlib.ClientGoalHandle] = []  # of goals that have not ended, the present one last

    # facts

    def facts(self) -> Facts:
        """As measured now. After a late call the receiving threads first take what waits for them."""
        if time.monotonic() - self._called_at > LATE:
            time.sleep(CATCH_UP)
        self._called_at = now = time.monotonic()
        (odometry, _), (safety, _), (battery, _) = map(self._view.newest, ("odom", "safety_status", "battery_state"))
        self._follow(odometry, safety)
        fresh, speaks, status = (self._view.fresh(topic, now) for topic in ("odom", "safety_status", "robot_status"))
        if self.progress.status == DRIVING and now - self._feedback_at > SILENCE:
            self._goal += 1
            self.stop()  # one that goes on later must not drive the leg of a paused order
            self.progress = Progress(ENDED, self.progress.distance, f"{ACTION} is silent: follow_path.py has ended")
        transform = self._map_odom()
        result: dict[str, Any] = {}
        if odometry is not None and transform is not None:
            map_id, *origin = transform
            pose, in_map = pose_of(odometry), Pose(*origin)
            result["x"], result["y"] = in_map.holding(pose.x, pose.y)
            result |= {"theta": turned(pose.yaw + in_map.yaw), "map_id": map_id if fresh else ""}
        if odometry is not None:
            spread = odometry.pose.covariance[0] + odometry.pose.covariance[7]
            result["deviation"] = math.sqrt(spread) if 0 <= spread < math.inf else None
            twist = odometry.twist.twist
            result["linear"], result["angular"] = (twist.linear.x, twist.angular.z) if fresh else (0.0, 0.0)
        if battery is not None:
            charge, voltage = 100 * battery.percentage, battery.voltage
            result["battery_charge"] = min(100.0, max(0.0, charge)) if math.isfinite(charge) else None
            result["battery_voltage"] = voltage if math.isfinite(voltage) else None
            result["charging"] = battery.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
        manual = status is not None and status.mode == "manual"
        return Facts(
            **result,
            mode="MANUAL" if manual else "AUTOMATIC",
            stopped=safety is not None and safety.state_name in STOPPED,
            may_drive=safety is not None and safety.state_name in DRIVABLE,
            permit=(safety.run, safety.withdrawals) if safety is not None else (0, 0),
            silent=not fresh or not speaks,
            held_by=self._held_by,
            blocked_by=self._blocked_by(safety, now),
            errors=(
                *(_errors(safety) if safety is not None and speaks else [_silent("safetyMonitor", "safety_status")]),
                *([] if fresh else [_silent("odometry", "odom")]),
            ),
        )

    def _blocked_by(self, safety: SafetyStatus | None, now: float) -> str:
        """Why the monitor leaves the robot no speed although it may drive; empty if it does."""
        if safety is None or safety.state_name not in DRIVABLE or safety.speed_limit >= MOVING:
            return ""
        guard = self._view.fresh("guard_state", now)
        return printable(str(guard.reason if guard is not None else "")) or "clearance leaves the robot no speed"

    @property
    def position(self) -> list[Any]:
        """map → odom with the run of the robot's nodes in which it holds."""
        return [self.map_odom, self._run]

    def _map_odom(self) -> list[Any] | None:
        if self._tf is None:
            return self.map_odom
        try:
            found = self._tf.lookup(MAP, self._odom_frame)
        except PathError:
            return None
        return [self._settings.map, found.pose.x, found.pose.y, found.pose.yaw]

    @property
    def _odom_frame(self) -> str:
        return str(self._odometry.header.frame_id) if self._odometry is not None else "odom"

    def set_position(self, x: float, y: float, theta: float, map_id: str) -> str:
        """map → odom from now on; why it is refused, empty if it is not."""
        if self._tf is not None:
            return "localization provides the position"
        if self._odometry is None:
            return "there is no odometry"
        pose = pose_of(self._odometry)
        yaw = turned(theta - pose.yaw)
        dx, dy = Pose(0.0, 0.0, yaw).holding(pose.x, pose.y)
        self.map_odom = [map_id, x - dx, y - dy, yaw]
        self.publish_map()
        return ""

    def publish_map(self) -> None:
        """map → odom on tf_static, if this program sets it."""
        if self.map_odom is None or self._tf is not None:
            return
        _, x, y, yaw = self.map_odom
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = MAP, self._odom_frame
        transform.header.stamp = rospy.Time.now()
        transform.transform = Transform(Vector3(x, y, 0.0), placed_pose(x, y, yaw).orientation)
        self._static.publish(TFMessage([transform]))

    # legs

    def drive(self, points: list[PathPoint], begin_at: float) -> None:
        """Replaces the present leg without a stop."""
        self._goal, self._held_by, self._feedback_at = self._goal + 1, "", time.monotonic()
        if not self._client.wait_for_server(rospy.Duration(0.01)):
            self.progress = Progress(ENDED, begin_at, f"{ACTION} is not served: start follow_path.py")
            return
        goal = FollowPathGoal(speed=abs(points[0].speed), begin_at=begin_at)
        goal.path = path_of((Waypoint(each.x, each.y, each.yaw) for each in points), MAP)
        goal.speeds, goal.turn_speeds = [p.speed for p in points], [p.turn_speed for p in points]
        self.progress = Progress(DRIVING, begin_at)
        number = self._goal
        handle = self._client.send_goal(
            goal,
            transition_cb=lambda handle: self._transition(number, handle),
            feedback_cb=lambda _, feedback: self._feedback(number, feedback),
        )
        self._handles = [each for each in self._handles if each.get_comm_state() != CommState.DONE] + [handle]

    def stop(self) -> None:
        """Ends the present leg."""
        for handle in self._handles[-1:]:
            handle.cancel()

    def stop_all(self) -> None:
        """Ends every goal of follow_path, also one of the program that ran before this one."""
        if self._client.wait_for_server(rospy.Duration(0.01)):
            self._client.cancel_goals_at_and_before_time(rospy.Time.now())

    def _feedback(self, number: int, feedback: FollowPathFeedback) -> None:
        if number == self._goal and self.progress.status == DRIVING:
            self._feedback_at = time.monotonic()
            self._held_by = (feedback.reason or "paused at the robot") if feedback.state == "paused" else ""
            if feedback.state != "waiting":  # then it does not know the distance yet
                self.progress = Progress(DRIVING, feedback.distance)

    def _transition(self, number: int, handle: actionlib.ClientGoalHandle) -> None:
        if number != self._goal or handle.get_comm_state() != CommState.DONE:
            return
        status, result = handle.get_goal_status(), handle.get_result()
        if status == GoalStatus.LOST:
            self.stop_all()  # it may go on where only a message of its status was damaged
        self._held_by = ""
        distance = self.progress.distance if result is None else max(result.distance, 0.0)
        if status == GoalStatus.SUCCEEDED:
            self.progress = Progress(DONE, distance)
        else:
            stopped = status == GoalStatus.PREEMPTED
            why = "" if stopped else (result.reason if result is not None else "") or "follow_path refused it"
            self.progress = Progress(ENDED, distance, why)

    # messages

    def _follow(self, odometry: Odometry | None, safety: SafetyStatus | None) -> None:
        """Whether map → odom holds, by the newest messages."""
        before, self._odometry = self._odometry, odometry
        if before is not None and self._tf is None and _jumped(before, odometry):
            self.map_odom = None
            rospy.logwarn("odometry was set: the position on the map is unknown; send initPosition")
        if safety is None:
            return
        self._run = safety.run
        saved, self._saved = self._saved, None
        if saved is not None and saved[1] == safety.run:
            self.map_odom = saved[0]
            self.publish_map()


def _jumped(before: Odometry, after: Odometry) -> bool:
    """True if the pose moved by more than the measured speeds allow in the time between the two messages."""
    elapsed = max(0.0, after.header.stamp.to_sec() - before.header.stamp.to_sec())
    a, b, twists = pose_of(before), pose_of(after), (before.twist.twist, after.twist.twist)
    way = POSE_JUMP + elapsed * (SPEED_CHANGE * elapsed + max(abs(twist.linear.x) for twist in twists))
    turn = POSE_JUMP + elapsed * (SPEED_CHANGE * elapsed + max(abs(twist.angular.z) for twist in twists))
    return bool(math.dist((a.x, a.y), (b.x, b.y)) > way or abs(turned(b.yaw - a.yaw)) > turn)


def _silent(what: str, topic: str) -> Error:
    return Error(f"{what}Silent", f"{topic} is silent", (), "start the robot's nodes", fatal=True)


def _errors(safety: SafetyStatus) -> list[Error]:
    """Latched causes need a person at the robot; warnings and what is waited for end by themselves."""
    columns = safety.causes, safety.sentences, safety.remedies, safety.actors, safety.details
    causes = [
        Error(name, f"{sentence} {detail}".strip(), (("actor", actor),), remedy, fatal=True)
        for name, sentence, remedy, actor, detail in zip(*columns, strict=False)
    ]
    warnings = list(map(Error, safety.warnings, safety.warning_sentences))
    awaited = [Error("nodeMissing", f"{name} does not run", (), f"start {name}") for name in safety.missing]
    if safety.awaiting_zero_request:
        awaited.append(Error("awaitingZeroRequest", "no zero velocity was requested since the start"))
    return [*causes[:MAX_ERRORS], *warnings[:MAX_ERRORS], *awaited[:MAX_ERRORS]]
