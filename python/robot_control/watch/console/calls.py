"""The calls of a page: services, paths and the simulation. CALLS lists what each call needs."""

import io
import secrets
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped
from std_srvs.srv import SetBool, Trigger

from robot_control.drive.path.run import path_of, placed_pose
from robot_control.drive.path.shapes import SHAPES
from robot_control.drive.path.waypoints import PathError, Waypoint, checked, placed, read_csv_text
from robot_control.files.files import printable
from robot_control.loop.roles import Kind
from robot_control.msg import FollowPathActionGoal
from robot_control.robot.pose import Pose
from robot_control.robot.robot_kind import ROLES, running_kind
from robot_control.settings.files import in_range
from robot_control.srv import InjectFault, SetGait, SetOdometry, SetParameters, SetPosture, Step
from robot_control.watch.console.authority import Authority, Page, RefusedError, Role
from robot_control.watch.console.messages import SPEED, Fields, MessageError, check_fields, flag, text

RESET_PAUSE, RESET_WINDOW = 0.5, 10.0
"""s; the second step of a reset follows the first one no sooner and no later"""
FOLLOW = "follow_path"

METRES, RADIANS = in_range(-1e6, 1e6), in_range(-7.0, 7.0)
PLACE = {"x": METRES, "y": METRES, "yaw": RADIANS}
NAVIGATE, LOCALIZATION = "clear_costmaps", "global_localization"
"""Services that only these nodes have"""
BY_HAND = (0.25, 0.25, 0.07)
"""m², m², rad² of a pose that was set on the map, as RViz's"""


def _points(value: Any) -> bool:  # noqa: ANN401 (JSON)
    if not isinstance(value, list) or not 2 <= len(value) <= 1000:
        return False
    return all(isinstance(point, list) and len(point) == 2 and all(map(METRES, point)) for point in value)


@dataclass(frozen=True)
class Call:
    """One request that a page may make."""

    service: str = ""  # service without which the call cannot work, below a node or a role; empty: none
    kind: type | None = None  # type of that service if the call is a plain call of it, with the fields as arguments
    fields: Fields = field(default_factory=dict)
    role: Role = Role.OPERATE


CALLS: Mapping[str, Call] = {
    "reset_asked": Call("e_stop_reset"),
    "reset": Call("e_stop_reset", fields={"key": text(32)}),
    "set_posture": Call("set_posture", SetPosture, {"posture": text(16)}),
    "set_gait": Call("set_gait", SetGait, {"gait": text(16)}),
    "reset_odometry": Call("reset_odometry", Trigger),
    "set_odometry": Call("set_odometry", SetOdometry, PLACE),
    "set_parameters": Call("controller/set_parameter_map", SetParameters, {"parameters": text(8192)}, Role.MAINTAIN),
    "path_points": Call(f"{FOLLOW}/pause", fields={"points": _points, "speed": SPEED}),
    "path_shape": Call(f"{FOLLOW}/pause", fields={"shape": text(16), "size": in_range(0.1, 100.0), "speed": SPEED}),
    "path_csv": Call(f"{FOLLOW}/pause", fields={"text": text(60_000), "speed": SPEED}),
    "path_pause": Call(f"{FOLLOW}/pause", Trigger),
    "path_resume": Call(f"{FOLLOW}/resume", Trigger),
    "path_cancel": Call(f"{FOLLOW}/pause"),
    "goal": Call(NAVIGATE, fields=PLACE),
    "goal_cancel": Call(NAVIGATE),
    "place": Call(LOCALIZATION, fields=PLACE),
    "pause": Call("driver/set_pause", SetBool, {"on": flag}, Role.MAINTAIN),
    "step": Call("driver/step", Step, {"cycles": in_range(1, 10_000, int)}, Role.MAINTAIN),
    "simulation_reset": Call("driver/reset", Trigger, role=Role.MAINTAIN),
    "inject_fault": Call("driver/inject_fault", InjectFault, {"component": text(64), "kind": text(32)}, Role.MAINTAIN),
}


def service_of(call: Call, kind: Kind) -> str:
    """The relative name of the call's service on a robot of this kind."""
    node, slash, name = call.service.partition("/")
    return f"{kind.node(node) if node in ROLES else node}{slash}{name}"


def check_call(name: str, arguments: Mapping[str, Any]) -> None:
    """Raises MessageError unless it is a call with its arguments."""
    if name not in CALLS:
        raise MessageError(f"call: {printable(name)} is unknown")
    check_fields(name, arguments, CALLS[name].fields)


def against(name: str, page: Page, authority: Authority, services: set[str] | None, kind: Kind) -> str:
    """Why this page cannot make the call now; empty if it can. `services`: those of the robot, by relative name; None
    if the master does not know a robot that runs.
    """
    call = CALLS[name]
    service = service_of(call, kind)
    if page.role < call.role:
        return f"needs the role {call.role}"
    if authority.commander is not page:
        return "take control first"
    if service and services is None:
        return "the ROS master was restarted and does not know the robot: restart the nodes of the robot"
    if service and services is not None and service not in services:
        node = {NAVIGATE: "navigate", LOCALIZATION: "localization"}.get(service, service.rpartition("/")[0])
        if call.kind in {SetPosture, SetGait}:
            return "the robot has no legs, or its controller does not run"
        return f"{'follow_path.py' if node == FOLLOW else node or 'the robot'} does not run"
    return ""


class Calls:
    """Makes the calls. A call may take seconds, so each is made in a thread of its own."""

    def __init__(self, pose: Callable[[], tuple[float, float, float] | None], map_frame: Callable[[], str]) -> None:
        """`pose`: of the robot in odom; `map_frame`: empty without a map."""
        self._pose, self._map_frame = pose, map_frame
        self._goal = rospy.Publisher("move_base_simple/goal", PoseStamped, queue_size=1)
        self._ends = [rospy.Publisher(f"{name}/cancel", GoalID, queue_size=1) for name in ("navigate_to", "move_base")]
        self._initial = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        self._goals = rospy.Publisher(f"{FOLLOW}/goal", FollowPathActionGoal, queue_size=1)
        self._cancel = rospy.Publisher(f"{FOLLOW}/cancel", GoalID, queue_size=1)
        self._keys: dict[int, tuple[str, float]] = {}  # page → key of its first step of a reset, and when

    def make(self, page: Page, name: str, given: Mapping[str, Any]) -> str:
        """The answer. Raises RefusedError with the reason of a refusal."""
        call = CALLS[name]
        try:
            if call.kind is not None:
                service = rospy.ServiceProxy(service_of(call, running_kind()), call.kind)
                answer = service(*(given[field] for field in call.fields))
                if not answer.success:
                    raise RefusedError(answer.message or "refused")
                return answer.message or "done"
            if name == "reset_asked":
                key = secrets.token_hex(8)
                self._keys[page.number] = key, time.monotonic()
                return key
            if name == "path_cancel":
                self._cancel.publish(GoalID())
                return "the path was cancelled"
            if name == "goal_cancel":
                for publisher in self._ends:
                    publisher.publish(GoalID())
                return "the goal was cancelled"
            if name in ("goal", "place"):
                return self._send_place(name, given)
            return self._start(self._path(name, given), given["speed"])
        except (PathError, rospy.ServiceException, rospy.ROSException, OSError) as error:
            raise RefusedError(f"{name}: {error}") from None

    def confirm_reset(self, page: Page, key: str) -> None:
        """Checks the second step of a reset, which names the key of the first one. Raises RefusedError."""
        known, at = self._keys.pop(page.number, ("", 0.0))
        elapsed = time.monotonic() - at
        if not (known and secrets.compare_digest(known, key) and RESET_PAUSE <= elapsed <= RESET_WINDOW):
            raise RefusedError("request the reset again, check what prevents it, and confirm within 10 s")

    def forget(self, page: Page) -> None:
        """Forgets a page that has ended."""
        self._keys.pop(page.number, None)

    def _path(self, name: str, given: Mapping[str, Any]) -> list[Waypoint]:
        if name == "path_points":
            return [Waypoint(x, y) for x, y in given["points"]]
        if name == "path_csv":
            return read_csv_text("the file", io.StringIO(given["text"], newline=""))
        pose = self._pose()
        if given["shape"] not in SHAPES or pose is None:
            raise PathError("no odometry" if pose is None else f"a shape is one of {', '.join(SHAPES)}")
        return placed(SHAPES[given["shape"]](given["size"]), Pose(*pose))

    def _send_place(self, name: str, given: Mapping[str, Any]) -> str:
        frame = self._map_frame()
        if not frame:
            raise RefusedError("no map received: start navigation.launch")
        message = PoseStamped() if name == "goal" else PoseWithCovarianceStamped()
        message.header.stamp, message.header.frame_id = rospy.Time.now(), frame
        message.pose = placed_pose(**given)
        if name == "place":
            covariance = [0.0] * 36
            covariance[0], covariance[7], covariance[35] = BY_HAND
            message.pose = PoseWithCovariance(message.pose, covariance)
        (self._goal if name == "goal" else self._initial).publish(message)
        return f"sent: {given['x']:.2f} m, {given['y']:.2f} m, {given['yaw']:.2f} rad in {frame}"

    def _start(self, points: list[Waypoint], speed: float) -> str:
        message = FollowPathActionGoal()
        message.goal_id.stamp = message.header.stamp = rospy.Time.now()
        message.goal_id.id = f"console {secrets.token_hex(4)}"
        message.goal.speed = speed
        message.goal.path = path_of(checked(points), "odom")
        self._goals.publish(message)
        return f"sent: {len(message.goal.path.poses)} points"
